//! Builds a model from the contents of an OBJ file: one mesh for each object, group and material.

use std::collections::HashMap;

use glam::DVec3;

use super::materials::Materials;
use super::parsed::{Corner, NONE, Owner, Parsed};
use super::polygons::{MAX_CONCAVE, triangles};
use crate::InputError;
use crate::asset::gltf::Beside;
use crate::asset::gltf::tangents::{generated, solved};
use crate::asset::mesh::{MAX_VERTICES, Mesh, smooth_normals, unit_normal};
use crate::asset::skeleton::{Bone, Skeleton, Skin};
use crate::asset::tangents::TangentMesh as Surface;
use crate::asset::{Influences, Model, Transform};

/// Largest allowed number of meshes in a file.
const MAX_MESHES: usize = 1 << 16;

/// Name of the bone for faces that have no object and no group.
const UNNAMED: &str = "mesh";

/// Reads a model; `beside` reads its libraries and images. Without `beside`, there are no materials, and no vertex is
/// duplicated for its tangents.
pub(super) fn import(bytes: &[u8], beside: Option<Beside<'_>>) -> Result<Model, InputError> {
    let parsed = Parsed::new(bytes)?;
    let triangles = Triangles::new(&parsed)?;
    let parts = parsed.parts();
    let bound = || format!("must be at most {MAX_MESHES} objects, groups and materials");
    InputError::check(parts.len() <= MAX_MESHES, "OBJ", parts.len(), bound)?;
    let normals = Normals::new(&parsed, &triangles.corners);
    let mut materials = Materials::new(beside, &parsed.libraries)?;
    let mut nodes = Nodes::default();
    let mut meshes = Vec::new();
    for (owner, faces) in parts {
        let corners: Vec<Corner> = faces.into_iter().flat_map(|faces| triangles.of(faces)).copied().collect();
        if corners.is_empty() {
            continue;
        }
        let material = owner.material.as_deref().map(|name| materials.read(name)).transpose()?.flatten();
        let (name, skin) = nodes.mesh(owner);
        let mut mesh = mesh(&parsed, &normals, &corners)?;
        if let Some(material) = material {
            materials.move_coordinates(material, &mut mesh.uv)?;
        }
        let mesh = Mesh { name, skin, material, ..mesh };
        meshes.push(with_tangents(mesh, beside.is_none())?);
    }
    if meshes.is_empty() {
        let bound = "must have at least one face with three different positions";
        return Err(InputError::new("OBJ", format!("[{} faces]", parsed.faces.len()), bound));
    }
    let Nodes { bones, skins, .. } = nodes;
    Ok(Model {
        skeleton: Skeleton::of_joints(bones)?,
        skins,
        clips: Vec::new(),
        motion: None,
        meshes,
        skinned: 0,
        materials: materials.materials,
        images: materials.images.into_iter().map(crate::asset::Image::from).collect(),
    })
}

/// The triangles of all faces, in the order of the faces.
struct Triangles {
    /// Corners of the triangles, three per triangle.
    corners: Vec<Corner>,
    /// For each face, the index of its first entry in `corners`. One more entry holds the total number of corners.
    first: Vec<usize>,
}

impl Triangles {
    fn new(parsed: &Parsed) -> Result<Self, InputError> {
        let (mut corners, mut first) = (Vec::new(), Vec::with_capacity(parsed.faces.len() + 1));
        for (face, line) in parsed.faces.iter().zip(&parsed.lines) {
            first.push(corners.len());
            let positions: Vec<DVec3> = face.iter().map(|corner| position(parsed, corner)).collect();
            let Some(found) = triangles(&positions) else {
                let bound = format!("must have at most {MAX_CONCAVE} corners, or be convex");
                return Err(InputError::new(
                    format!("line {line}"),
                    format!("f [{} corners]", face.len()),
                    bound,
                ));
            };
            for triangle in found {
                let [a, b, c] = triangle.map(|place| face[place]);
                if a[0] != b[0] && b[0] != c[0] && c[0] != a[0] {
                    corners.extend([a, b, c]);
                }
            }
        }
        first.push(corners.len());
        Ok(Self { corners, first })
    }

    fn of(&self, faces: std::ops::Range<usize>) -> &[Corner] {
        &self.corners[self.first[faces.start]..self.first[faces.end]]
    }
}

fn position(parsed: &Parsed, corner: &Corner) -> DVec3 {
    DVec3::from(parsed.positions[corner[0] as usize].map(f64::from))
}

/// Normals of corners: from the file, scaled to length 1, or computed where the file has none.
struct Normals {
    given: Vec<Option<[f32; 3]>>,
    /// For each position, the smooth normal of the adjacent faces that have no normals in the file.
    smooth: Vec<[f32; 3]>,
}

impl Normals {
    fn new(parsed: &Parsed, corners: &[Corner]) -> Self {
        let given: Vec<_> = parsed.normals.iter().map(|normal| unit_normal(*normal)).collect();
        let lacks = |corner: &Corner| corner[2] == NONE || given[corner[2] as usize].is_none();
        let lacking = corners.chunks_exact(3).filter(|triangle| triangle.iter().any(lacks));
        let indices: Vec<u32> = lacking.flatten().map(|corner| corner[0]).collect();
        let smooth = match indices.is_empty() {
            true => Vec::new(),
            false => smooth_normals(&parsed.positions, &indices),
        };
        Self { given, smooth }
    }

    fn of(&self, corner: &Corner) -> [f32; 3] {
        let given = self.given.get(corner[2] as usize).copied().flatten();
        given.unwrap_or_else(|| self.smooth[corner[0] as usize])
    }
}

/// Builds a mesh from corners, three per triangle. Name, skin, material and tangents stay unset. Corners with the same indices
/// of position, texture coordinates and normal share one vertex; vertices are sorted by these indices.
fn mesh(parsed: &Parsed, normals: &Normals, corners: &[Corner]) -> Result<Mesh, InputError> {
    let mut vertices = corners.to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let bound = || format!("must be at most {MAX_VERTICES} in a mesh");
    InputError::check(vertices.len() <= MAX_VERTICES, "vertices.len", vertices.len(), bound)?;
    let vertex = |corner: &Corner| vertices.partition_point(|other| other < corner) as u32;
    let uv = |corner: &Corner| parsed.uv.get(corner[1] as usize).copied().unwrap_or_default();
    Ok(Mesh {
        indices: corners.iter().map(vertex).collect(),
        positions: vertices.iter().map(|corner| parsed.positions[corner[0] as usize]).collect(),
        normals: vertices.iter().map(|corner| normals.of(corner)).collect(),
        uv: vertices.iter().map(uv).collect(),
        influences: Influences::rigid(vertices.len()),
        ..Mesh::default()
    })
}

/// Adds tangents to a mesh. With `is_bare`, no vertex is duplicated for its tangents.
fn with_tangents(mut mesh: Mesh, is_bare: bool) -> Result<Mesh, InputError> {
    let Mesh { positions, normals, uv, indices, .. } = &mesh;
    let surface = Surface { positions, normals, uv, indices };
    let has_uv = uv.iter().any(|uv| *uv != [0.0; 2]);
    let tangents = if has_uv && !is_bare { generated(&surface)? } else { solved(&surface)? };
    if mesh.vertices() + tangents.copied.len() > MAX_VERTICES {
        let bound =
            format!("with {} copies for tangents must be at most {MAX_VERTICES}", tangents.copied.len());
        return Err(InputError::new("vertices.len", mesh.vertices(), bound));
    }
    tangents.apply(&mut mesh);
    Ok(mesh)
}

/// The bones of objects and groups; each bone has one skin.
#[derive(Default)]
struct Nodes {
    bones: Vec<Bone>,
    skins: Vec<Skin>,
    known: HashMap<(Option<String>, Option<String>), usize>,
    /// For each bone, the number of its meshes so far.
    meshes: Vec<usize>,
}

impl Nodes {
    /// Returns the name and the skin's index for the next mesh of an object and group.
    fn mesh(&mut self, owner: &Owner) -> (String, usize) {
        let node = self.node(&owner.object, &owner.group);
        self.meshes[node] += 1;
        (format!("{}_{}", self.bones[node].name, self.meshes[node] - 1), node)
    }

    fn node(&mut self, object: &Option<String>, group: &Option<String>) -> usize {
        if let Some(known) = self.known.get(&(object.clone(), group.clone())) {
            return *known;
        }
        let parent = match (object, group) {
            (Some(_), Some(_)) => Some(self.node(object, &None) as u32),
            _ => None,
        };
        let name = group.as_ref().or(object.as_ref()).map_or(UNNAMED, |name| name);
        let bone = self.bones.len();
        self.bones.push(Bone { name: name.to_owned(), parent, rest: Transform::IDENTITY });
        let inverse_binds = vec![glam::Mat4::IDENTITY.to_cols_array()];
        self.skins.push(Skin { name: name.to_owned(), bones: vec![bone as u32], inverse_binds });
        self.meshes.push(0);
        self.known.insert((object.clone(), group.clone()), bone);
        bone
    }
}
