//! Reads a primitive: vertices, triangles, influences and morph targets.

use gltf_json::Index;
use gltf_json::accessor::{Accessor, Type};
use gltf_json::material::Material as GltfMaterial;
use gltf_json::mesh::{Mode, MorphTarget as GltfTarget, Primitive, Semantic};
use gltf_json::validation::Checked;

use super::accessor::Elements;
use super::document::Document;
use super::draco::Decompressed;
use super::materials::Coordinates;
use super::tangents::{Tangents, generated, solved};
use crate::InputError;
use crate::asset::indices::check_indices;
use crate::asset::influences::{Influence, Influences, MAX_INFLUENCES};
use crate::asset::mesh::{MAX_VERTICES, Mesh, in_range, smooth_normals, unit_normal};
use crate::asset::morph::{MorphDelta, MorphTarget};
use crate::asset::skeleton::Skin;
use crate::asset::tangents::TangentMesh as Surface;

/// Number of elements charged to the budget for every vertex. They cover the data that the import adds where the file lacks it:
/// normal, tangent, texture coordinates and influence.
const LACKING: usize = 4;

/// Reader of one primitive. `path` is the primitive's path in the file.
pub(super) struct Reader<'a, 'd> {
    pub(super) document: &'a Document<'d>,
    pub(super) primitive: &'a Primitive,
    pub(super) path: String,
    /// Whether the primitive's node has no skin.
    pub(super) is_rigid: bool,
    /// Whether the import leaves out materials.
    pub(super) is_bare: bool,
    /// The decompressed primitive, if it is compressed with Draco.
    pub(super) decompressed: Option<Decompressed<'a>>,
}

impl<'d> Reader<'_, 'd> {
    /// Reads the primitive as a mesh with skin index 0, without name, material and weights. The primitive's influences must
    /// refer to the bones of `skin`. `targets` is the number of morph targets that every primitive of the file's mesh must
    /// have.
    pub(super) fn mesh(&self, skin: &Skin, targets: usize) -> Result<Mesh, InputError> {
        let path = self.named("POSITION");
        let Some(positions) = self.elements(&Semantic::Positions) else {
            return Err(InputError::new(path, "missing", "must be given"));
        };
        let positions = positions.attributes::<3>()?;
        InputError::check_most(format!("{path}.count"), positions.len(), MAX_VERTICES)?;
        in_range(&path, &positions)?;
        let vertices = positions.len();
        self.document.budget.spend(&path, LACKING * vertices)?;
        let uv = self.coordinates(vertices)?;
        let indices = self.triangles(vertices)?;
        let normals = self.normals(&positions, &indices)?;
        let tangents = self.tangents(&positions, &normals, uv.as_deref(), &indices)?;
        let copies = tangents.copied.len();
        if vertices + copies > MAX_VERTICES {
            let bound = format!("with {copies} copies for tangents must be at most {MAX_VERTICES}");
            return Err(InputError::new(format!("{path}.count"), vertices, bound));
        }
        self.document.budget.spend(&path, LACKING * copies)?;
        let influences = match self.is_rigid {
            true => Influences::rigid(vertices),
            false => self.influences(vertices, skin.bones.len())?,
        };
        let targets = self.targets(vertices, targets)?;
        let (second_uv, colors) = (self.second_coordinates(vertices)?, self.colors(vertices)?);
        let mut mesh = Mesh {
            second_uv,
            colors,
            normals,
            uv: uv.unwrap_or_else(|| vec![[0.0; 2]; vertices]),
            positions,
            double_sided: self.material().is_some_and(|material| material.double_sided),
            influences,
            targets,
            ..Mesh::default()
        };
        tangents.apply(&mut mesh);
        Ok(mesh)
    }

    /// Returns the file's tangents if it also has normals and the texture coordinates that tangents need; otherwise computes
    /// tangents.
    fn tangents(
        &self,
        positions: &[[f32; 3]],
        normals: &[[f32; 3]],
        uv: Option<&[[f32; 2]]>,
        indices: &[u32],
    ) -> Result<Tangents, InputError> {
        let vertices = positions.len();
        let given = self.attribute::<4>(&Semantic::Tangents, vertices)?;
        let of_normals = self.coordinates_of_normals(vertices)?;
        let uv = of_normals.as_deref().or(uv);
        let has_normals = self.elements(&Semantic::Normals).is_some();
        if let Some(given) = given.filter(|_| uv.is_some() && has_normals) {
            let tangents = given.into_iter().map(flipped).collect();
            return Ok(Tangents { tangents, indices: indices.to_vec(), copied: vec![] });
        }
        match uv {
            Some(uv) if !self.is_bare => generated(&Surface { positions, normals, uv, indices }),
            Some(uv) => solved(&Surface { positions, normals, uv, indices }),
            None => solved(&Surface { positions, normals, uv: &vec![[0.0; 2]; vertices], indices }),
        }
    }

    fn material(&self) -> Option<&GltfMaterial> {
        self.primitive.material.map(|material| &self.document.root.materials[material.value()])
    }

    /// Texture coordinates of the mesh: the coordinates of the base colour texture, or else of the normal map. The primitive
    /// must have these coordinates. Without either texture, the mesh has the first set, if there is one.
    fn coordinates(&self, vertices: usize) -> Result<Option<Vec<[f32; 2]>>, InputError> {
        let Some(texture) = self.coordinates_of_material() else {
            return self.attribute::<2>(&Semantic::TexCoords(0), vertices);
        };
        let path = self.named(&format!("TEXCOORD_{}", texture.set));
        let Some(mut uv) = self.attribute::<2>(&Semantic::TexCoords(texture.set), vertices)? else {
            let bound = "must be given: the material's texture is read there";
            return Err(InputError::new(path, "missing", bound));
        };
        texture.apply(&mut uv);
        in_range(&path, &uv)?;
        Ok(Some(uv))
    }

    /// Coordinates at which the material's base colour texture is sampled, or else its normal map.
    fn coordinates_of_material(&self) -> Option<Coordinates<'_>> {
        let index = self.primitive.material.filter(|_| !self.is_bare)?;
        let of_color = Coordinates::of_color(&self.document.root.materials[index.value()]);
        of_color.or_else(|| Coordinates::of_normals(self.document, index))
    }

    /// Untransformed texture coordinates from which tangents are computed: the normal map's coordinates if the primitive has
    /// them, otherwise the mesh's coordinates. `None` if the mesh itself uses exactly these coordinates.
    fn coordinates_of_normals(&self, vertices: usize) -> Result<Option<Vec<[f32; 2]>>, InputError> {
        let Some(index) = self.primitive.material.filter(|_| !self.is_bare) else { return Ok(None) };
        let of_mesh = self.coordinates_of_material();
        let (own, is_moved) = of_mesh.map_or((0, false), |of_mesh| (of_mesh.set, of_mesh.is_moved()));
        let of_normals = Coordinates::of_normals(self.document, index).map(|texture| texture.set);
        let is_there = |set: &u32| self.elements(&Semantic::TexCoords(*set)).is_some();
        let set = of_normals.filter(is_there).unwrap_or(own);
        if set == own && !is_moved {
            return Ok(None);
        }
        self.attribute::<2>(&Semantic::TexCoords(set), vertices)
    }

    /// The second set of texture coordinates: that of the first texture which is not drawn and is sampled elsewhere than the mesh's
    /// own coordinates, or else `TEXCOORD_1`. Empty if the primitive does not have it.
    fn second_coordinates(&self, vertices: usize) -> Result<Vec<[f32; 2]>, InputError> {
        if self.is_bare {
            return Ok(Vec::new());
        }
        let first = self.coordinates_of_material().map_or(0, |first| first.set);
        let texture = self.primitive.material.and_then(|index| Coordinates::second(self.document, index));
        let set = texture.as_ref().map_or(1, |texture| texture.set);
        if texture.is_none() && first == 1 {
            return Ok(Vec::new());
        }
        let mut uv = self.attribute::<2>(&Semantic::TexCoords(set), vertices)?.unwrap_or_default();
        if let Some(texture) = texture {
            texture.apply(&mut uv);
        }
        in_range(&self.named(&format!("TEXCOORD_{set}")), &uv)?;
        Ok(uv)
    }

    /// The colours of vertices; empty if there are none. Colours without alpha are opaque.
    fn colors(&self, vertices: usize) -> Result<Vec<[f32; 4]>, InputError> {
        let semantic = Semantic::Colors(0);
        let Some(elements) = self.elements(&semantic).filter(|_| !self.is_bare) else {
            return Ok(Vec::new());
        };
        let path = self.named("COLOR_0");
        match self.document.root.accessors[elements.accessor.value()].type_ {
            Checked::Valid(Type::Vec3) => {
                let colors = one_a_vertex(&path, elements.attributes::<3>()?, vertices)?;
                Ok(colors.into_iter().map(|[red, green, blue]| [red, green, blue, 1.0]).collect())
            }
            _ => one_a_vertex(&path, elements.attributes::<4>()?, vertices),
        }
    }

    fn named(&self, attribute: &str) -> String {
        format!("{}.attributes.{attribute}", self.path)
    }

    /// Reader for the elements of an attribute; `None` if the primitive lacks the attribute.
    fn elements(&self, semantic: &Semantic) -> Option<Elements<'_, 'd>> {
        let accessor = *self.primitive.attributes.get(&Checked::Valid(semantic.clone()))?;
        let compressed = self.decompressed.as_ref().map(|primitive| (primitive, semantic.to_string()));
        Some(Elements { document: self.document, accessor, compressed })
    }

    /// Reads an attribute, and checks that it has one value per vertex, in range. `None` if the primitive lacks the attribute.
    fn attribute<const N: usize>(
        &self,
        semantic: &Semantic,
        vertices: usize,
    ) -> Result<Option<Vec<[f32; N]>>, InputError> {
        let Some(elements) = self.elements(semantic) else { return Ok(None) };
        one_a_vertex(&self.named(&semantic.to_string()), elements.attributes()?, vertices).map(Some)
    }

    /// Unit normals from the file. Missing normals, and normals without a direction, are computed from the triangles.
    fn normals(&self, positions: &[[f32; 3]], indices: &[u32]) -> Result<Vec<[f32; 3]>, InputError> {
        let Some(given) = self.attribute::<3>(&Semantic::Normals, positions.len())? else {
            return Ok(smooth_normals(positions, indices));
        };
        let units: Vec<_> = given.into_iter().map(unit_normal).collect();
        if units.iter().all(Option::is_some) {
            return Ok(units.into_iter().flatten().collect());
        }
        let smooth = smooth_normals(positions, indices);
        Ok(units.into_iter().zip(smooth).map(|(unit, smooth)| unit.unwrap_or(smooth)).collect())
    }

    /// Reads the influences of each vertex from all sets of four joints and weights.
    fn influences(&self, vertices: usize, bones: usize) -> Result<Influences, InputError> {
        let mut all: Vec<Vec<Influence>> = vec![Vec::with_capacity(4); vertices];
        for set in 0.. {
            let (joints_name, weights_name) = (format!("JOINTS_{set}"), format!("WEIGHTS_{set}"));
            let (joints, weights) =
                match [Semantic::Joints(set), Semantic::Weights(set)].map(|s| self.elements(&s)) {
                    [Some(joints), Some(weights)] => (joints, weights),
                    [None, None] if set > 0 => break,
                    [joints, _] => {
                        let lacking = if joints.is_none() { joints_name } else { weights_name };
                        let bound = "must be given: meshes of nodes with a skin follow joints";
                        return Err(InputError::new(self.named(&lacking), "missing", bound));
                    }
                };
            let (joints, weights) = (joints.integers::<4>()?, weights.vectors::<4>()?);
            check_count(&self.named(&joints_name), joints.len(), vertices)?;
            check_count(&self.named(&weights_name), weights.len(), vertices)?;
            for (all, (joints, weights)) in all.iter_mut().zip(joints.iter().zip(&weights)) {
                all.extend(joints.iter().zip(weights).map(|(&bone, &weight)| Influence { bone, weight }));
            }
        }
        all.iter_mut().for_each(strongest);
        Influences::new(&self.named("WEIGHTS_0"), bones, all)
    }

    /// Returns the triangles as a list of indices, converted from lists, strips or fans. Points and lines give no triangles.
    fn triangles(&self, vertices: usize) -> Result<Vec<u32>, InputError> {
        let indices: Vec<u32> = match (&self.decompressed, self.primitive.indices) {
            (Some(decompressed), _) => decompressed.indices(),
            (None, Some(accessor)) => self.document.elements(accessor).integers::<1>()?.into_flattened(),
            (None, None) => (0..vertices as u32).collect(),
        };
        check_indices(&format!("{}.indices", self.path), &indices, vertices)?;
        // Draco data is always a triangle list, whatever the primitive's mode says.
        let mode = if self.decompressed.is_some() { Mode::Triangles } else { self.primitive.mode.unwrap() };
        // Strips and fans have about one triangle per index, so each index is charged as three elements.
        self.document.budget.spend(&self.path, 3 * indices.len())?;
        // Strips contain degenerate triangles that join their parts; these are dropped.
        let is_flat = |[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
        let corners = |at: usize| [indices[at], indices[at + 1], indices[at + 2]];
        let windows = 0..indices.len().saturating_sub(2);
        Ok(match mode {
            Mode::Triangles if !indices.len().is_multiple_of(3) => {
                let bound = "must be a multiple of 3 for triangles";
                return Err(InputError::new(format!("{}.indices.count", self.path), indices.len(), bound));
            }
            Mode::Triangles => indices,
            Mode::TriangleStrip => {
                let turned = |at: usize| match (at % 2, corners(at)) {
                    (0, triangle) => triangle,
                    (_, [a, b, c]) => [b, a, c],
                };
                windows.map(turned).filter(|triangle| !is_flat(triangle)).flatten().collect()
            }
            Mode::TriangleFan => {
                let fan = |at: usize| [indices[0], indices[at + 1], indices[at + 2]];
                windows.map(fan).filter(|triangle| !is_flat(triangle)).flatten().collect()
            }
            _ => Vec::new(),
        })
    }

    fn targets(&self, vertices: usize, expected: usize) -> Result<Vec<MorphTarget>, InputError> {
        let targets = self.primitive.targets.as_deref().unwrap_or_default();
        let (path, reason) =
            (format!("{}.targets.len", self.path), "as many as the mesh's first primitive has");
        InputError::check_same(path, targets.len(), expected, reason)?;
        targets.iter().enumerate().map(|(at, target)| self.target(vertices, at, target)).collect()
    }

    fn target(&self, vertices: usize, at: usize, target: &GltfTarget) -> Result<MorphTarget, InputError> {
        self.document.budget.spend(&format!("{}.targets[{at}]", self.path), 1 + vertices)?;
        let mut deltas = vec![MorphDelta::default(); vertices];
        let mut add = |name: &str, accessor: Option<Index<Accessor>>, set: fn(&mut MorphDelta, [f32; 3])| {
            let Some(accessor) = accessor else { return Ok(()) };
            let path = format!("{}.targets[{at}].{name}", self.path);
            let values = one_a_vertex(&path, self.document.elements(accessor).attributes()?, vertices)?;
            deltas.iter_mut().zip(values).for_each(|(delta, value)| set(delta, value));
            Ok(())
        };
        add("POSITION", target.positions, |delta, value| delta.position = value)?;
        add("NORMAL", target.normals, |delta, value| delta.normal = value)?;
        add("TANGENT", target.tangents, |delta, value| delta.tangent = value)?;
        Ok(MorphTarget::new(&deltas))
    }
}

/// Checks that there is one value per vertex, and that all values are in range.
fn one_a_vertex<const N: usize>(
    path: &str,
    values: Vec<[f32; N]>,
    vertices: usize,
) -> Result<Vec<[f32; N]>, InputError> {
    check_count(path, values.len(), vertices)?;
    in_range(path, &values)?;
    Ok(values)
}

fn check_count(path: &str, count: usize, vertices: usize) -> Result<(), InputError> {
    InputError::check_same(format!("{path}.count"), count, vertices, "one a vertex")
}

/// If a vertex has more than [`MAX_INFLUENCES`] influences, keeps the strongest.
fn strongest(all: &mut Vec<Influence>) {
    if all.iter().filter(|influence| influence.weight != 0.0).count() > MAX_INFLUENCES {
        // NaN weights sort first, so that they are kept here and refused later.
        all.sort_by(|a, b| b.weight.abs().total_cmp(&a.weight.abs()));
        all.truncate(MAX_INFLUENCES);
    }
}

/// Converts a tangent from glTF's handedness to this crate's, or back. In glTF, the bitangent points up in the image; here, it
/// points down.
pub(super) fn flipped([x, y, z, w]: [f32; 4]) -> [f32; 4] {
    [x, y, z, if w < 0.0 { 1.0 } else { -1.0 }]
}
