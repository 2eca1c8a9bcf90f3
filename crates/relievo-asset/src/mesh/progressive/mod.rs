//! Progressive meshes: a mesh and its coarser levels, with all vertices in one common order (thesis B section 3.2, after
//! Hoppe, "Progressive Meshes", SIGGRAPH 1996). A level is a prefix of the vertices, and a list of triangles. Two
//! successive levels differ by a range of vertices and an [`IndexPatch`] for the list of triangles.
//!
//! Vertices are sorted by three keys. The first key is the coarsest level that has the vertex, coarse levels first. The
//! second key is the bones that the vertex follows, so that clusters of vertices follow few bones. The third key is the
//! time of the vertex's collapse, latest first. Triangles keep the mesh's order at every level.
//!
//! Every vertex has a *partner*, which replaces the vertex in the first level that lacks it.
//! [`ProgressiveMesh::morphed`] moves the vertices of a level towards their partners (thesis A section 7.5; Hoppe's geomorph).
//! At the end of this motion, the level looks like the next coarser level: every corner is at its partner, and the
//! additional triangles are degenerate.

mod order;
mod partners;
mod patch;
mod record;
mod stored;

pub use partners::{Became, partners};
pub use patch::IndexPatch;
pub use record::ChosenLevel;
pub use stored::VERSION;

use serde::{Deserialize, Serialize};

use super::simplify::Simplified;
use crate::InputError;
use crate::asset::Mesh;
use crate::hash::sha256;
use stored::Stored;

/// A mesh with its levels of detail; level 0 is the finest.
///
/// serde stores floats as their bits, so that every format keeps them exactly. Deserialization checks everything,
/// including the hashes of all levels.
///
/// ```
/// use relievo::ops::mesh::progressive::ChosenLevel;
/// use relievo::ops::mesh::{SimplifyOptions, ProgressiveMesh, Surface, simplify};
///
/// let rock = relievo_samples::rock()?.meshes.remove(0);
/// let surface =
///     Surface { poses: &[rock.positions.clone()], indices: &rock.indices, attributes: &[], stride: 0 };
/// let simplified = simplify(&surface, &SimplifyOptions::default())?;
/// let chosen = [0.5, 0.1].map(|share| {
///     let collapses = simplified.collapses_to((share * rock.indices.len() as f64 / 3.0) as usize);
///     ChosenLevel { collapses, error: simplified.collapses()[collapses - 1].error }
/// });
/// let progressive = ProgressiveMesh::new(&rock, &simplified, &chosen)?;
///
/// // A client that has the coarsest level receives a run of vertices and a patch.
/// let mut triangles = progressive.indices(2).to_vec();
/// progressive.refine(1, &mut triangles)?;
/// assert!(triangles == progressive.indices(1));
/// assert!(progressive.vertices(2) < progressive.vertices(1));
/// # Ok::<(), relievo::InputError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored", into = "Stored")]
pub struct ProgressiveMesh {
    /// The mesh in this module's vertex order, with its levels and partners.
    mesh: Mesh,
    sources: Vec<u32>,
    /// Number of vertices of each level.
    vertices: Vec<u32>,
    /// For each level except the coarsest, the difference from the next coarser level.
    patches: Vec<IndexPatch>,
    /// For each level, its SHA-256 in hexadecimal digits.
    hashes: Vec<String>,
}

impl ProgressiveMesh {
    /// Builds levels from a recorded sequence of collapses. The sequence must have been recorded for this mesh.
    /// `chosen` describes level 1 and the coarser levels. The mesh's own levels and partners are ignored.
    ///
    /// # Errors
    /// [`InputError`] in these cases: [`Mesh::validate`] refuses the mesh; the sequence belongs to another mesh; there
    /// are more than 15 levels; collapses or errors do not ascend; a level has no triangles.
    pub fn new(mesh: &Mesh, simplified: &Simplified, chosen: &[ChosenLevel]) -> Result<Self, InputError> {
        let (mesh, times) = record::levelled(mesh, simplified, chosen)?;
        Self::ordered(&mesh, &times)
    }

    /// Builds a progressive mesh from the levels and partners of a mesh ([`Mesh::levels`], [`Mesh::partners`]), for
    /// example from `relievo::ops::skinning::add_levels`. Within a level, vertices that follow the same
    /// bones keep the mesh's order.
    ///
    /// # Errors
    /// [`InputError`] in these cases: [`Mesh::validate`] refuses the mesh; the mesh has levels but no partners; a level
    /// does not result from the previous level by replacing corners by their partners.
    pub fn of_levels(mesh: &Mesh) -> Result<Self, InputError> {
        mesh.validate_alone()?;
        if mesh.partners.is_empty() && !mesh.levels.is_empty() {
            return Err(InputError::new("mesh.partners.len", 0, format!("must be {}", mesh.vertices())));
        }
        Self::ordered(mesh, &[])
    }

    /// Sorts the vertices of a mesh. `times` has, for each vertex, the number of the collapse that removed it; empty if
    /// unknown.
    fn ordered(mesh: &Mesh, times: &[u32]) -> Result<Self, InputError> {
        let sources = order::order(mesh, times);
        Self::assembled(order::permuted(mesh, &sources)?, sources)
    }

    /// Builds a progressive mesh from a mesh whose vertices are already sorted.
    fn assembled(mesh: Mesh, sources: Vec<u32>) -> Result<Self, InputError> {
        let coarsest = mesh.coarsest_levels();
        if let Some(at) = coarsest.windows(2).position(|pair| pair[0] < pair[1]) {
            let bound = "must be a vertex that no coarser level has than those before it";
            return Err(InputError::new("vertices", at + 1, bound));
        }
        let levels = mesh.levels.len() as u32 + 1;
        let count = |level: u32| coarsest.partition_point(|own| *own >= level) as u32;
        let vertices: Vec<u32> = (0..levels).map(count).collect();
        let patch = |level: u32| {
            let lists = [level, level + 1].map(|level| mesh.triangles(level));
            IndexPatch::between(lists, vertices[level as usize + 1]..vertices[level as usize], &mesh.partners)
                .ok_or_else(|| {
                    let bound = "must be those of the level before with partners in their corners";
                    let path = format!("mesh.levels[{level}].indices");
                    InputError::new(path, format!("{} triangles", lists[1].len() / 3), bound)
                })
        };
        let patches = (0..levels - 1).map(patch).collect::<Result<_, _>>()?;
        let hashes =
            (0..levels).map(|level| sha256(&mesh.level_words(level, vertices[level as usize]))).collect();
        Ok(Self { mesh, sources, vertices, patches, hashes })
    }

    /// Number of levels, including level 0: 1 to 16.
    pub fn levels(&self) -> usize {
        self.vertices.len()
    }

    /// The mesh to draw, with sorted vertices, all levels, and partners.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// For each vertex, its index in the mesh from which this one was built.
    pub fn sources(&self) -> &[u32] {
        &self.sources
    }

    /// Number of vertices of a level. They are the first vertices of the mesh.
    ///
    /// # Panics
    /// If there is no such level. The same holds for all functions that take a level and do not return a `Result`.
    pub fn vertices(&self, level: usize) -> usize {
        self.vertices[level] as usize
    }

    /// The triangles of a level, three indices each.
    pub fn indices(&self, level: usize) -> &[u32] {
        assert!(level < self.levels(), "level {level} of {}", self.levels());
        self.mesh.triangles(level as u32)
    }

    /// Error of a level, in the units in which it was given; 0 for level 0.
    pub fn error(&self, level: usize) -> f32 {
        level.checked_sub(1).map_or(0.0, |before| self.mesh.levels[before].error)
    }

    /// SHA-256 of a level, as 64 hexadecimal digits. It covers all attributes of the level's vertices, and the level's
    /// triangles. Two levels with the same hash are identical bit for bit.
    pub fn hash(&self, level: usize) -> &str {
        &self.hashes[level]
    }

    /// Difference between a level and the next coarser level.
    pub fn patch(&self, level: usize) -> &IndexPatch {
        &self.patches[level]
    }

    /// Replaces the triangles of level `level` + 1 by the triangles of `level`.
    ///
    /// # Errors
    /// [`InputError`] if `level` is the coarsest level, or if `triangles` are not the triangles of level `level` + 1.
    /// In both cases, `triangles` stays unchanged.
    pub fn refine(&self, level: usize, triangles: &mut Vec<u32>) -> Result<(), InputError> {
        *triangles = self.checked_patch(level)?.applied(triangles, &self.mesh.partners)?;
        Ok(())
    }

    /// Replaces the triangles of `level` by the triangles of level `level` + 1.
    ///
    /// # Errors
    /// [`InputError`] if `level` is the coarsest level, or if `triangles` are not the triangles of `level`. In both
    /// cases, `triangles` stays unchanged.
    pub fn coarsen(&self, level: usize, triangles: &mut Vec<u32>) -> Result<(), InputError> {
        *triangles = self.checked_patch(level)?.undone(triangles, &self.mesh.partners)?;
        Ok(())
    }

    fn checked_patch(&self, level: usize) -> Result<&IndexPatch, InputError> {
        let bound = || format!("must be below {}, that of the coarsest level", self.levels() - 1);
        self.patches.get(level).ok_or_else(|| InputError::new("level", level, bound()))
    }

    /// For each vertex of a level, its partner in the next coarser level. A vertex that the coarser level also has is
    /// its own partner. In the coarsest level, every vertex is its own partner.
    pub fn partners(&self, level: usize) -> Vec<u32> {
        let kept = self.vertices.get(level + 1).copied().unwrap_or(u32::MAX);
        let partner = |vertex: u32| if vertex < kept { vertex } else { self.mesh.partners[vertex as usize] };
        (0..self.vertices[level]).map(partner).collect()
    }

    /// Interpolates values of a level's vertices towards the next coarser level: `a · (1 − t) + b · t`, where a is the
    /// vertex's value and b is its partner's value. `values` are positions in any pose, normals or texture coordinates,
    /// at least one per vertex of the level. At t = 0 the result equals the level's values bit for bit. At t = 1 it
    /// equals the partners' values (except for the sign of 0). Influences of bones are not interpolated, so pass
    /// positions after skinning.
    ///
    /// # Errors
    /// [`InputError`] if `t` is outside 0..=1, or if there are too few values.
    pub fn morphed<const N: usize>(
        &self,
        level: usize,
        t: f32,
        values: &[[f32; N]],
    ) -> Result<Vec<[f32; N]>, InputError> {
        InputError::check_within("t", t, 0.0..=1.0)?;
        let bound = || format!("must be at least {}, one a vertex", self.vertices(level));
        InputError::check(values.len() >= self.vertices(level), "values.len", values.len(), bound)?;
        let between = |(a, partner): (&[f32; N], &u32)| {
            let b = values[*partner as usize];
            std::array::from_fn(|at| a[at] * (1.0 - t) + b[at] * t)
        };
        Ok(values.iter().zip(&self.partners(level)).map(between).collect())
    }

    /// Reads a progressive mesh from JSON written by serde_json.
    ///
    /// # Errors
    /// [`InputError`] for invalid JSON, with the location; for another [`VERSION`]; and for values that contradict each
    /// other.
    pub fn from_json(json: &[u8]) -> Result<Self, InputError> {
        let mut reader = serde_json::Deserializer::from_slice(json);
        let stored: Stored = serde_path_to_error::deserialize(&mut reader).map_err(|error| {
            InputError::new(error.path().to_string(), "JSON", format!("cannot be read: {}", error.inner()))
        })?;
        reader.end().map_err(|error| InputError::new(".", "JSON", format!("cannot be read: {error}")))?;
        stored.try_into()
    }
}
