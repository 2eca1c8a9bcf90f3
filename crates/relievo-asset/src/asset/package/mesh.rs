//! One mesh of a package, with its own levels of detail.

use super::attributes::{AttributeContexts, Attributes, Written};
use super::coder::Coder;
use super::parts::MeshParts;
use super::surface::{Partners, Room, Source, Surface, SurfaceContexts, Truth};
use crate::InputError;
use crate::asset::{Mesh, MeshLevel, Skin};

/// Adaptive frequencies, shared by all meshes and levels.
pub(super) struct Contexts {
    surface: SurfaceContexts,
    attributes: AttributeContexts,
}

impl Contexts {
    pub fn new() -> Self {
        Self { surface: SurfaceContexts::new(), attributes: AttributeContexts::new() }
    }
}

/// A mesh, at the finest of its own levels that was coded so far.
pub(super) struct LeveledMesh<'a> {
    surface: Surface,
    attributes: Attributes,
    partners: Partners,
    steps: Vec<u32>,
    /// Triangles of its own levels that were coded so far, the coarsest first.
    levels: Vec<Vec<u32>>,
    /// The mesh to write; `None` when reading.
    written: Option<MeshSource<'a>>,
}

/// A mesh to write.
pub(super) struct MeshSource<'a> {
    mesh: &'a Mesh,
    truth: Option<Truth<'a>>,
    /// For each coded point, a vertex of the source.
    points: Vec<u32>,
}

impl<'a> MeshSource<'a> {
    pub fn new(mesh: &'a Mesh, source: &'a Source<'a>) -> Self {
        Self { mesh, truth: Some(Truth::new(source)), points: Vec::new() }
    }
}

impl<'a> LeveledMesh<'a> {
    /// A mesh of a package with this number of levels.
    ///
    /// # Errors
    /// [`InputError`] for parts that contradict each other.
    pub fn new(parts: &MeshParts, skins: &[Skin], levels: usize) -> Result<Self, InputError> {
        InputError::check_len("steps", parts.steps.len(), levels, "a level of the package")?;
        let own: u64 = parts.steps.iter().map(|step| u64::from(*step)).sum();
        let wanted = parts.errors.len() as u64 + 1;
        InputError::check_same("steps", own, wanted, "the number of levels of the mesh")?;
        InputError::check(parts.steps[0] > 0, "steps[0]", 0, || "must be at least 1")?;
        Ok(Self {
            surface: Surface::default(),
            attributes: Attributes::new(parts.grids, parts.bones(skins)?, parts.targets()),
            partners: parts.partners,
            steps: parts.steps.clone(),
            levels: Vec::new(),
            written: None,
        })
    }

    /// The same mesh, to write.
    pub fn writing(self, source: MeshSource<'a>) -> Self {
        Self { written: Some(source), ..self }
    }

    /// Codes the mesh's own levels in a chunk.
    ///
    /// # Errors
    /// When reading: [`InputError`] for bytes that no writer makes.
    pub fn step(
        &mut self,
        chunk: usize,
        coder: &mut impl Coder,
        contexts: &mut Contexts,
        room: &mut Room,
    ) -> Result<(), InputError> {
        for _ in 0..self.steps[chunk] {
            let mut reading = None;
            let truth = match &mut self.written {
                Some(source) => {
                    let level = source.mesh.levels.len() - self.levels.len();
                    if let Some(truth) = &mut source.truth {
                        truth.set_level(source.mesh.triangles(level as u32));
                    }
                    &mut source.truth
                }
                None => &mut reading,
            };
            let added = self.surface.level(coder, &mut contexts.surface, room, truth, self.partners)?;
            let written = match &mut self.written {
                Some(MeshSource { mesh, truth: Some(truth), points }) => {
                    let new = truth.sources[points.len()..].iter();
                    points.extend(new.map(|point| truth.source.vertex_of[*point as usize]));
                    Some(Written { mesh, points, vertices: &truth.vertex_sources })
                }
                _ => None,
            };
            let contexts = &mut contexts.attributes;
            self.attributes.level(coder, contexts, room, &self.surface, &added, written)?;
            self.levels.push(self.surface.indices());
        }
        Ok(())
    }

    /// Number of vertices that were coded so far.
    pub fn vertices(&self) -> usize {
        self.surface.point_of.len()
    }

    /// Number of triangles of the finest own level that was coded so far.
    pub fn triangles(&self) -> usize {
        self.levels.last().map_or(0, |indices| indices.len() / 3)
    }

    /// The mesh with the levels that were coded so far. `quantization` is the error of the finest level.
    ///
    /// # Errors
    /// [`InputError`] for influences that no vertex can have.
    pub fn mesh(&self, parts: &MeshParts, quantization: f32) -> Result<Mesh, InputError> {
        let mut mesh = parts.mesh();
        self.attributes.set(&self.surface, &mut mesh)?;
        let mut levels = self.levels.iter().rev();
        mesh.indices = levels.next().cloned().unwrap_or_default();
        let first = parts.errors.len() + 1 - self.levels.len();
        mesh.error = first.checked_sub(1).map_or(quantization, |level| parts.errors[level]);
        let level =
            |(indices, error): (&Vec<u32>, &f32)| MeshLevel { indices: indices.clone(), error: *error };
        mesh.levels = levels.zip(&parts.errors[first..]).map(level).collect();
        if self.partners == Partners::Known {
            mesh.partners.clone_from(&self.surface.partners);
        }
        Ok(mesh)
    }
}
