//! Serialized form of progressive meshes.

use serde::{Deserialize, Serialize};

use super::{IndexPatch, ProgressiveMesh};
use crate::InputError;
use crate::asset::morph::MorphDelta;
use crate::asset::{Influence, Influences, Interpolation, Mesh, MeshLevel, MorphTarget, WeightKeys};

/// Version of the serialized form.
pub const VERSION: u32 = 1;

/// The serialized form of a progressive mesh. Floats are stored as their bits. `triangles` are the triangles of the
/// coarsest level.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Stored {
    version: u32,
    name: String,
    skin: usize,
    double_sided: bool,
    material: Option<usize>,
    sources: Vec<u32>,
    positions: Vec<[u32; 3]>,
    normals: Vec<[u32; 3]>,
    tangents: Vec<[u32; 4]>,
    uv: Vec<[u32; 2]>,
    /// For each vertex, pairs of a bone and a weight (as bits).
    influences: Vec<Vec<[u32; 2]>>,
    targets: Vec<StoredTarget>,
    weights: Vec<u32>,
    weight_keys: Vec<StoredKeys>,
    /// Bits of the mesh's own error, if it has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    error: Option<u32>,
    partners: Vec<u32>,
    triangles: Vec<u32>,
    levels: Vec<StoredLevel>,
    /// The patch of each level, from level 0 to the second coarsest.
    patches: Vec<IndexPatch>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredTarget {
    vertices: Vec<u32>,
    /// For each vertex, the deltas of position, normal and tangent, as bits.
    deltas: Vec<[[u32; 3]; 3]>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredKeys {
    clip: usize,
    times: Vec<u32>,
    values: Vec<u32>,
    interpolation: StoredInterpolation,
    targets: usize,
}

#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum StoredInterpolation {
    Step,
    Linear,
    Spline,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoredLevel {
    vertices: u32,
    error: u32,
    hash: String,
}

impl From<ProgressiveMesh> for Stored {
    fn from(all: ProgressiveMesh) -> Self {
        let mesh = &all.mesh;
        let level = |level: usize| StoredLevel {
            vertices: all.vertices[level],
            error: all.error(level).to_bits(),
            hash: all.hashes[level].clone(),
        };
        let influences = |vertex: usize| {
            mesh.influences.of(vertex).iter().map(|one| [one.bone, one.weight.to_bits()]).collect()
        };
        Self {
            version: VERSION,
            name: mesh.name.clone(),
            skin: mesh.skin,
            double_sided: mesh.double_sided,
            material: mesh.material,
            sources: all.sources.clone(),
            positions: vectors(&mesh.positions),
            normals: vectors(&mesh.normals),
            tangents: vectors(&mesh.tangents),
            uv: vectors(&mesh.uv),
            influences: (0..mesh.vertices()).map(influences).collect(),
            targets: mesh.targets.iter().map(StoredTarget::from).collect(),
            weights: bits(&mesh.weights),
            weight_keys: mesh.weight_keys.iter().map(StoredKeys::from).collect(),
            error: (mesh.error > 0.0).then_some(mesh.error.to_bits()),
            partners: mesh.partners.clone(),
            triangles: all.indices(all.levels() - 1).to_vec(),
            levels: (0..all.levels()).map(level).collect(),
            patches: all.patches,
        }
    }
}

impl TryFrom<Stored> for ProgressiveMesh {
    type Error = InputError;

    fn try_from(stored: Stored) -> Result<Self, InputError> {
        if stored.version != VERSION {
            return Err(InputError::new("version", stored.version, format!("must be {VERSION}")));
        }
        let lists = stored.lists()?;
        check_sources(&stored.sources, stored.positions.len())?;
        let (levels, patches) = (stored.levels.clone(), stored.patches.clone());
        let (mesh, sources) = stored.mesh(lists)?;
        mesh.validate_alone()?;
        if mesh.partners.len() != mesh.vertices() && levels.len() > 1 {
            return Err(InputError::new("partners.len", mesh.partners.len(), "must be one a vertex"));
        }
        let all = Self::assembled(mesh, sources)?;
        for (at, level) in levels.iter().enumerate() {
            let refused = |field: &str, value: String, bound: String| {
                Err(InputError::new(format!("levels[{at}].{field}"), value, format!("must be {bound}")))
            };
            if level.vertices != all.vertices[at] {
                return refused("vertices", level.vertices.to_string(), all.vertices[at].to_string());
            }
            if level.hash != all.hashes[at] {
                return refused("hash", level.hash.clone(), format!("{}, that of the level", all.hashes[at]));
            }
        }
        match patches.iter().zip(&all.patches).position(|(stored, found)| stored != found) {
            Some(at) => {
                Err(InputError::new(format!("patches[{at}]"), "another", "must be that of the levels"))
            }
            None => Ok(all),
        }
    }
}

impl Stored {
    /// The triangles of all levels, level 0 first, rebuilt from the patches.
    fn lists(&self) -> Result<Vec<Vec<u32>>, InputError> {
        if self.levels.is_empty() || self.patches.len() != self.levels.len() - 1 {
            let bound = format!("must be {}, one less than levels", self.levels.len().saturating_sub(1));
            return Err(InputError::new("patches.len", self.patches.len(), bound));
        }
        if self.levels[0].error != 0 {
            let error = f32::from_bits(self.levels[0].error);
            return Err(InputError::new("levels[0].error", error, "must be 0, that of the mesh itself"));
        }
        let mut lists = vec![self.triangles.clone()];
        for (at, patch) in self.patches.iter().enumerate().rev() {
            let coarse = &lists[lists.len() - 1];
            let fine = patch
                .applied(coarse, &self.partners)
                .map_err(|error| error.below(&format!("patches[{at}]")))?;
            lists.push(fine);
        }
        lists.reverse();
        Ok(lists)
    }

    /// The mesh, and for each vertex its index in the source mesh.
    fn mesh(self, lists: Vec<Vec<u32>>) -> Result<(Mesh, Vec<u32>), InputError> {
        let of_vertex = |all: Vec<[u32; 2]>| {
            all.into_iter().map(|[bone, weight]| Influence { bone, weight: f32::from_bits(weight) }).collect()
        };
        let mut lists = lists.into_iter();
        let indices = lists.next().unwrap_or_default();
        let errors = self.levels[1..].iter().map(|level| f32::from_bits(level.error));
        let levels = lists.zip(errors).map(|(indices, error)| MeshLevel { indices, error }).collect();
        let keys = |(at, keys): (usize, StoredKeys)| keys.read(&format!("weight_keys[{at}]"));
        let mesh = Mesh {
            name: self.name,
            skin: self.skin,
            positions: vectors_of(&self.positions),
            normals: vectors_of(&self.normals),
            tangents: vectors_of(&self.tangents),
            uv: vectors_of(&self.uv),
            indices,
            double_sided: self.double_sided,
            material: self.material,
            influences: Influences::stored("influences", self.influences.into_iter().map(of_vertex))?,
            targets: self.targets.into_iter().map(StoredTarget::read).collect(),
            weights: floats(&self.weights),
            weight_keys: self.weight_keys.into_iter().enumerate().map(keys).collect::<Result<_, _>>()?,
            error: self.error.map_or(0.0, f32::from_bits),
            levels,
            partners: self.partners,
            ..Mesh::default()
        };
        Ok((mesh, self.sources))
    }
}

impl From<&MorphTarget> for StoredTarget {
    fn from(target: &MorphTarget) -> Self {
        let delta = |delta: &MorphDelta| {
            [delta.position, delta.normal, delta.tangent].map(|vector| vector.map(f32::to_bits))
        };
        Self { vertices: target.vertices.clone(), deltas: target.deltas.iter().map(delta).collect() }
    }
}

impl StoredTarget {
    fn read(self) -> MorphTarget {
        let delta = |delta: [[u32; 3]; 3]| {
            let [position, normal, tangent] = delta.map(|vector| vector.map(f32::from_bits));
            MorphDelta { position, normal, tangent }
        };
        MorphTarget { vertices: self.vertices, deltas: self.deltas.into_iter().map(delta).collect() }
    }
}

impl From<&(usize, WeightKeys)> for StoredKeys {
    fn from((clip, keys): &(usize, WeightKeys)) -> Self {
        let (times, values, interpolation) = keys.parts();
        let interpolation = match interpolation {
            Interpolation::Step => StoredInterpolation::Step,
            Interpolation::Linear => StoredInterpolation::Linear,
            Interpolation::CubicSpline => StoredInterpolation::Spline,
        };
        Self { clip: *clip, times: bits(times), values: bits(values), interpolation, targets: keys.targets() }
    }
}

impl StoredKeys {
    fn read(self, path: &str) -> Result<(usize, WeightKeys), InputError> {
        let interpolation = match self.interpolation {
            StoredInterpolation::Step => Interpolation::Step,
            StoredInterpolation::Linear => Interpolation::Linear,
            StoredInterpolation::Spline => Interpolation::CubicSpline,
        };
        if self.targets > self.values.len() {
            let bound = format!("must be at most {}, the number of values", self.values.len());
            return Err(InputError::new(format!("{path}.targets"), self.targets, bound));
        }
        let paths = [format!("{path}.times"), format!("{path}.values")];
        let paths = [paths[0].as_str(), paths[1].as_str()];
        let keys =
            WeightKeys::new(paths, floats(&self.times), floats(&self.values), interpolation, self.targets);
        Ok((self.clip, keys?))
    }
}

/// Checks that `sources` is a permutation of the numbers from 0 to `vertices` − 1.
fn check_sources(sources: &[u32], vertices: usize) -> Result<(), InputError> {
    InputError::check_len("sources", sources.len(), vertices, "a vertex")?;
    let mut seen = vec![false; vertices];
    for (at, source) in sources.iter().enumerate() {
        match seen.get_mut(*source as usize) {
            Some(seen) if !*seen => *seen = true,
            _ => {
                let bound = format!("must be below {vertices}, and be there once");
                return Err(InputError::new(format!("sources[{at}]"), source, bound));
            }
        }
    }
    Ok(())
}

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn floats(bits: &[u32]) -> Vec<f32> {
    bits.iter().map(|bits| f32::from_bits(*bits)).collect()
}

fn vectors<const N: usize>(values: &[[f32; N]]) -> Vec<[u32; N]> {
    values.iter().map(|value| value.map(f32::to_bits)).collect()
}

fn vectors_of<const N: usize>(bits: &[[u32; N]]) -> Vec<[f32; N]> {
    bits.iter().map(|value| value.map(f32::from_bits)).collect()
}
