//! Skinned meshes: vertices in bind space, their influences, triangles, and morph targets.

mod validate;

use serde::{Deserialize, Serialize};

use super::morph::{MorphTarget, WeightKeys};
use super::tangents::{self, tangents};
use crate::InputError;
use crate::asset::influences::Influences;
use crate::asset::skeleton::Skin;

pub(crate) use tangents::in_range;

/// Largest allowed number of vertices of a mesh.
pub const MAX_VERTICES: usize = 1 << 24;

/// Largest allowed absolute value of a component of positions and texture coordinates.
pub const COORDINATE_LIMIT: f32 = tangents::COORDINATE_LIMIT;

/// Largest number of levels of detail of a mesh, including level 0. Level 0 is the mesh itself; [`Mesh::levels`] holds the
/// other levels.
pub const MAX_LEVELS: usize = 16;

/// A coarser level of detail of a mesh. It uses some of the mesh's vertices.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeshLevel {
    /// Three vertex indices per triangle, into the mesh's vertices. A mesh without partners may have no triangle at a level.
    pub indices: Vec<u32>,
    /// Geometric error in the model's units, at least 0: the largest distance between the level's surface and the mesh's
    /// surface in any examined pose. `relievo::ops::skinning::MeshLevels` measures this distance at sample
    /// points. No vertex of the mesh is further than `error` from the level, and no sample point of the level is further than
    /// `error` from the mesh. Other points may be further.
    pub error: f32,
}

/// A triangle mesh that follows the bones of one skin. The default is empty.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Mesh {
    /// Name of the file's node, followed by the number of the primitive.
    pub name: String,
    /// Index of the skin in the model.
    pub skin: usize,
    /// Positions in the space of the skin's inverse bind matrices.
    pub positions: Vec<[f32; 3]>,
    /// One normal per vertex, of unit length or 0.
    pub normals: Vec<[f32; 3]>,
    /// One tangent per vertex: a unit vector along u, and a sign ±1. The bitangent, along v, is the sign times the cross
    /// product normal × tangent. The fourth component of glTF has the opposite sign.
    pub tangents: Vec<[f32; 4]>,
    /// Texture coordinates per vertex, for all textures of the material; v points down the image.
    pub uv: Vec<[f32; 2]>,
    /// Second set of texture coordinates per vertex, for textures of [`Pbr`](super::material::Pbr); empty if there is none.
    pub second_uv: Vec<[f32; 2]>,
    /// Linear colour and alpha per vertex; empty if there is none. Scenes do not draw it.
    pub colors: Vec<[f32; 4]>,
    /// Three vertex indices per triangle. After skinning in the rest pose, a triangle is counter-clockwise seen from outside. A
    /// triangle that bones mirror in the rest pose is therefore clockwise in bind space. The import reverses such triangles of
    /// the file.
    pub indices: Vec<u32>,
    /// Whether triangles are also visible from the inside.
    pub double_sided: bool,
    /// Index of the material in the model. If it is `None`, the drawing code chooses the colour.
    pub material: Option<usize>,
    /// The influences of each vertex.
    pub influences: Influences,
    /// Morph targets, which move vertices before they are skinned.
    pub targets: Vec<MorphTarget>,
    /// Default weight of each morph target, for clips that do not animate weights.
    pub weights: Vec<f32>,
    /// Animated morph weights: the index of each clip that has weight keys, and these keys.
    pub weight_keys: Vec<(usize, WeightKeys)>,
    /// Geometric error of level 0 in the model's units, at least 0: the largest distance between the mesh and its source in any
    /// examined pose. It is above 0 in a package, whose vertices are quantized. The errors of `levels` contain it.
    pub error: f32,
    /// Coarser levels of detail, starting with level 1; there are fewer than [`MAX_LEVELS`]. Level 0 is the mesh itself. Errors
    /// do not decrease from one level to the next. In a mesh with partners, each level has a triangle, and uses a subset of the
    /// previous level's vertices.
    pub levels: Vec<MeshLevel>,
    /// Partner of each vertex: the vertex that replaces it in the first level whose triangles no longer use it. The partner is
    /// normally a vertex of that level. If the level uses no vertex at the position to which a vertex collapses, the partner is
    /// another vertex that collapses to this position. A vertex of the coarsest level, and a vertex without triangles, is its
    /// own partner.
    ///
    /// Replacing the corners of a level's triangles by their partners gives the triangles of the next coarser level. The
    /// triangles keep their order, and some become degenerate. The list is empty if partners are not known.
    pub partners: Vec<u32>,
}

impl Mesh {
    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.positions.len()
    }

    /// Triangles of a level of detail, as three vertex indices each. Level 0 is the mesh itself. A number beyond the last level
    /// gives the last level.
    pub fn triangles(&self, level: u32) -> &[u32] {
        match self.levels.len().min(level as usize) {
            0 => &self.indices,
            level => &self.levels[level - 1].indices,
        }
    }

    /// Triangles of all levels, level 0 first, as three vertex indices each.
    #[doc(hidden)]
    pub fn all_triangles(&self) -> impl Iterator<Item = &[u32]> {
        (0..=self.levels.len() as u32).map(|level| self.triangles(level))
    }

    /// Whether the mesh has triangles at some level, but not at level 0: another mesh of its model has them there.
    #[doc(hidden)]
    pub fn is_of_coarse_levels(&self) -> bool {
        self.indices.is_empty() && self.levels.iter().any(|level| !level.indices.is_empty())
    }

    /// For each vertex, the index of the coarsest level whose triangles use it; 0 for a vertex without triangles.
    pub fn coarsest_levels(&self) -> Vec<u32> {
        let mut coarsest = vec![0; self.vertices()];
        for level in 1..=self.levels.len() as u32 {
            self.triangles(level).iter().for_each(|vertex| coarsest[*vertex as usize] = level);
        }
        coarsest
    }

    /// The content of a level as words, for hashes: its vertices with all attributes, and its triangles. The vertices of the level
    /// are the first `vertices` vertices of the mesh.
    pub(crate) fn level_words(&self, level: u32, vertices: u32) -> Vec<u32> {
        let count = vertices as usize;
        let mut words = vec![vertices, self.triangles(level).len() as u32];
        let mut floats = |values: &[f32]| words.extend(values.iter().map(|value| value.to_bits()));
        floats(self.positions[..count].as_flattened());
        floats(self.normals[..count].as_flattened());
        floats(self.tangents[..count].as_flattened());
        floats(self.uv[..count].as_flattened());
        floats(self.second_uv[..count.min(self.second_uv.len())].as_flattened());
        floats(self.colors[..count.min(self.colors.len())].as_flattened());
        for vertex in 0..count {
            let influences = self.influences.of(vertex);
            words.push(influences.len() as u32);
            words.extend(influences.iter().flat_map(|one| [one.bone, one.weight.to_bits()]));
        }
        for target in &self.targets {
            let moved = target.vertices.partition_point(|vertex| *vertex < vertices);
            words.push(moved as u32);
            for (vertex, delta) in target.vertices.iter().zip(&target.deltas).take(moved) {
                words.push(*vertex);
                words.extend(
                    [delta.position, delta.normal, delta.tangent].as_flattened().iter().map(|x| x.to_bits()),
                );
            }
        }
        words.extend(self.triangles(level));
        words
    }

    /// Weights of the morph targets at a time in seconds inside a clip. A clip without weight keys gives the default weights.
    pub fn weights_at(&self, clip: usize, time: f32) -> Vec<f32> {
        let keys = self.weight_keys.iter().find(|(of, _)| *of == clip);
        keys.map_or_else(|| self.weights.clone(), |(_, keys)| keys.at(time))
    }

    /// Largest absolute weight of a morph target in any clip; at least 1.
    #[doc(hidden)]
    pub fn largest_weight(&self, target: usize) -> f32 {
        let keyed = self.weight_keys.iter().map(|(_, keys)| keys.largest(target));
        keyed.fold(self.weights[target].abs().max(1.0), f32::max)
    }
}

/// Computes smooth normals, one per vertex, for a mesh without normals: the area-weighted mean of the normals of adjacent
/// triangles. A vertex without triangles gets +Z.
pub fn smooth_normals(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[f32; 3]> {
    let mut sums = vec![glam::DVec3::ZERO; positions.len()];
    let position = |index: u32| glam::DVec3::from(positions[index as usize].map(f64::from));
    for triangle in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| position(triangle[corner]));
        let area = (b - a).cross(c - a);
        triangle.iter().for_each(|index| sums[*index as usize] += area);
    }
    let unit = |sum: &glam::DVec3| sum.try_normalize().unwrap_or(glam::DVec3::Z);
    sums.iter().map(|sum| unit(sum).to_array().map(|component| component as f32)).collect()
}

/// Returns the normal scaled to length 1; `None` if it has no direction. A normal of about unit length stays unchanged, because
/// scaling would round it again.
pub(super) fn unit_normal(normal: [f32; 3]) -> Option<[f32; 3]> {
    match normal.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>().sqrt() {
        length if (length - 1.0).abs() < 1e-3 => Some(normal),
        length if length > 1e-6 => Some(normal.map(|x| (f64::from(x) / length) as f32)),
        _ => None,
    }
}

/// Computes tangents, one per vertex, for a mesh without tangents (thesis B section 4.2).
///
/// # Errors
/// [`InputError`] for coordinates out of range, and for indices of vertices that do not exist.
pub fn solved_tangents(
    positions: &[[f32; 3]],
    normals: &[[f32; 3]],
    uv: &[[f32; 2]],
    indices: &[u32],
) -> Result<Vec<[f32; 4]>, InputError> {
    tangents(&tangents::TangentMesh { positions, normals, uv, indices })
}

/// Radius of each bone: the largest distance, in the bone's space, from the bone's origin to any vertex that follows it.
/// Displacements by morph targets are included. The radius is rounded up; it is 0 for a bone that no vertex follows.
///
/// A small rotation of the bone moves no vertex further than the angle in radians × this radius × the bone's largest scale.
/// (This radius is the ρ of the `bounded` gate.) A morph target counts with its largest weight in any clip, at least 1.
/// Larger weights that a program sets by hand are not covered.
///
/// # Panics
/// If meshes do not match the skins, or skins do not match `bones` bones; see [`Mesh::validate`].
pub fn bone_radii(bones: usize, skins: &[Skin], meshes: &[Mesh]) -> Vec<f32> {
    let mut bone_radii = vec![0.0_f64; bones];
    for mesh in meshes {
        let skin = &skins[mesh.skin];
        let binds: Vec<_> = skin
            .inverse_binds
            .iter()
            .map(|bind| glam::DMat4::from_cols_array(&bind.map(f64::from)))
            .collect();
        let deltas = deltas_by_vertex(mesh);
        for (vertex, position) in mesh.positions.iter().enumerate() {
            let position = glam::DVec3::from(position.map(f64::from));
            for influence in mesh.influences.of(vertex) {
                let bind = &binds[influence.bone as usize];
                let morphed: f64 =
                    deltas[vertex].iter().map(|delta| bind.transform_vector3(*delta).length()).sum();
                let bone_radius = &mut bone_radii[skin.bones[influence.bone as usize] as usize];
                *bone_radius = bone_radius.max(bind.transform_point3(position).length() + morphed);
            }
        }
    }
    // Compensates the relative error of rounding to f32, at most 2⁻²⁴; the errors of f64 are far smaller.
    bone_radii.into_iter().map(|bone_radius| (bone_radius * (1.0 + 1e-6)) as f32).collect()
}

/// For each vertex, one displacement for each morph target that moves the vertex, at the target's largest weight.
fn deltas_by_vertex(mesh: &Mesh) -> Vec<Vec<glam::DVec3>> {
    let mut deltas = vec![Vec::new(); mesh.vertices()];
    for (index, target) in mesh.targets.iter().enumerate() {
        let weight = f64::from(mesh.largest_weight(index));
        for (vertex, delta) in target.vertices.iter().zip(&target.deltas) {
            deltas[*vertex as usize].push(weight * glam::DVec3::from(delta.position.map(f64::from)));
        }
    }
    deltas
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::influences::Influence;
    use crate::asset::morph::MorphDelta;

    /// A triangle whose last vertex follows two bones. One of these bones is bound at x = 10 and at half the size.
    pub(super) fn triangle() -> (Mesh, Vec<Skin>) {
        let bind = glam::Mat4::from_scale(glam::Vec3::splat(0.5))
            * glam::Mat4::from_translation(glam::vec3(-10.0, 0.0, 0.0));
        let skin = Skin {
            name: String::new(),
            bones: vec![3, 1],
            inverse_binds: vec![glam::Mat4::IDENTITY.to_cols_array(), bind.to_cols_array()],
        };
        let positions = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        let one = |bone| vec![Influence { bone, weight: 1.0 }];
        let both = [one(0), one(1)].concat();
        let delta = MorphDelta { position: [0.0, 0.0, 1.0], ..MorphDelta::default() };
        let mesh = Mesh {
            normals: smooth_normals(&positions, &[0, 1, 2]),
            tangents: vec![[1.0, 0.0, 0.0, 1.0]; 3],
            uv: vec![[0.0; 2]; 3],
            positions,
            indices: vec![0, 1, 2],
            influences: Influences::new("w", 2, [one(0), one(0), both]).expect("valid"),
            targets: vec![MorphTarget { vertices: vec![2], deltas: vec![delta] }],
            weights: vec![-3.0],
            ..Mesh::default()
        };
        (mesh, vec![skin])
    }

    #[test]
    fn bone_radii_are_the_farthest_vertices() {
        let (mut mesh, skins) = triangle();
        assert_eq!(mesh.validate(&skins), Ok(()));
        let radii = |mesh: &Mesh| bone_radii(5, &skins, std::slice::from_ref(mesh));
        let near = |found: f32, wanted: f32| (wanted..wanted * 1.000_002).contains(&found);
        // The weight −3 counts with its absolute value.
        let found = radii(&mesh);
        assert!(near(found[3], 2.0 + 3.0) && near(found[1], 26.0_f32.sqrt() + 1.5), "{found:?}");
        assert_eq!([found[0], found[2], found[4]], [0.0; 3]);
        mesh.weights = vec![0.0];
        assert!(near(radii(&mesh)[3], 3.0));
        let keys = WeightKeys::new(["t", "v"], vec![0.0], vec![7.0], crate::asset::Interpolation::Step, 1);
        mesh.weight_keys = vec![(0, keys.expect("valid"))];
        assert!(near(radii(&mesh)[3], 9.0));
        assert_eq!((mesh.weights_at(0, 0.5), mesh.weights_at(1, 0.5)), (vec![7.0], vec![0.0]));
    }

    #[test]
    fn normals_follow_areas() {
        let normals = smooth_normals(
            &[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 3.0], [9.0; 3]],
            &[0, 1, 2, 0, 3, 1],
        );
        assert_eq!((normals[2], normals[3], normals[4]), ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]));
        let expected = glam::vec3(0.0, 3.0, 1.0).normalize();
        assert!((glam::Vec3::from(normals[0]) - expected).length() < 1e-6);
    }
}
