//! Objects: the data shared by all instances of one model or one terrain.

mod device;
mod frame;
mod morph;
mod slots;

use glam::Vec3;

use crate::asset::Model;
use crate::gpu::{Gpu, PendingUploads};
use crate::lod::criterion::Criterion;
use crate::scene::character::Character;
use crate::scene::chunk::Chunk;
use crate::scene::drawable::Drawable;
use crate::scene::instances::Instances;
use crate::scene::kind::{Kind, OwnKind};
use crate::scene::layout::error_vectors;
use crate::scene::layouts::SceneLayouts;
use crate::scene::level_of_detail::LevelOfDetail;
use crate::scene::material::Looks;
use crate::scene::mesh::{self, Drawn, MeshAtRest, NOTHING};
use crate::scene::object_kind::ObjectKind;
use crate::scene::options::CharacterOptions;
use crate::scene::quality::ErrorBudget;
use crate::scene::relief::{self, Relief};
use crate::scene::terrain::{self, TerrainSource};
use crate::shared::lod::object::{LodObject, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};
pub(super) use frame::laid_out;

/// Largest number of instances of an object.
const MAX_CAPACITY: usize = 1 << 20;

/// An object of a scene.
#[derive(Debug)]
pub(crate) struct Object {
    pub(super) kind: Box<dyn ObjectKind>,
    pub(super) instances: Instances,
    /// A sphere around an instance whose bones do not move.
    pub(super) sphere: BoundingSphere,
    /// The error of each level in the model's units, ascending from 0.
    pub(super) errors: Vec<f32>,
    pub(super) mesh_fraction: f32,
    /// How its levels are chosen and change.
    pub(super) level_of_detail: LevelOfDetail,
    /// Whether any object of the scene has a rank.
    pub(super) is_ranked: bool,
    /// Budgets count its triangles in units of 2 to the power of this.
    triangle_unit: u32,
    /// Middle and half size of a box around the model.
    model_box: [Vec3; 2],
    /// LOD bias: 1 unless memory has ended.
    pub(super) lod_bias: f32,
    /// Dirty: LOD bias or visibility must be uploaded again.
    pub(super) is_retuned: bool,
    /// Dirty: the ranges of rebound drawables must be uploaded again.
    is_rebound: bool,
    /// The handle's number.
    pub(super) handle: u32,
    pub(super) is_shown: bool,
    /// Data that waits to be uploaded.
    pub(super) pending: Option<PendingUploads>,
    /// Materials of a mesh or a character.
    pub(super) looks: Option<Looks>,
    /// Draws per part and level, [`OBJECT_LEVELS`] for each part, with instance counts of 0.
    pub(super) draws: Vec<SceneDraw>,
    /// Chunks, at least one.
    pub(super) chunks: Vec<Chunk>,
    fitted: u64,
}

impl Object {
    /// A visible object.
    pub(super) fn new(
        kind: impl ObjectKind,
        (instances, sphere): (Instances, BoundingSphere),
        (errors, mesh_fraction): (Vec<f32>, f32),
        (chunks, draws): (Vec<Chunk>, Vec<SceneDraw>),
    ) -> Self {
        let model_box =
            kind.model_box().map_or([sphere.center, Vec3::splat(sphere.radius)], |[low, high]| {
                [0.5 * (low + high), 0.5 * (high - low)]
            });
        Self {
            kind: Box::new(kind),
            instances,
            sphere,
            errors,
            mesh_fraction,
            level_of_detail: LevelOfDetail::default(),
            is_ranked: false,
            triangle_unit: 0,
            model_box,
            lod_bias: 1.0,
            is_retuned: false,
            is_rebound: false,
            handle: 0,
            is_shown: true,
            pending: None,
            looks: None,
            draws,
            chunks,
            fitted: 0,
        }
    }

    /// Terrain.
    pub(super) async fn of_terrain(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        source: &TerrainSource,
    ) -> Result<Self, Error> {
        let (terrain, instances, drawn) = terrain::made(gpu, layouts, source).await?;
        let sphere = BoundingSphere { center: Vec3::ZERO, radius: 0.0 };
        Ok(Self::new(terrain, (instances, sphere), (vec![0.0], 1.0), drawn))
    }

    /// A static mesh: a model's meshes at rest.
    pub(super) fn of_mesh(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        model: &Model,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let (mut merged, sphere) = mesh::at_rest_merged(model)?;
        let looks = Looks::taken(&mut merged.model);
        looks.check_all()?;
        let drawn = whole(&instances, mesh::drawn(gpu, layouts, (&merged, &looks))?);
        let errors = mesh::errors(&merged);
        let object = Self::new(MeshAtRest(merged), (instances, sphere), (errors, 1.0), drawn);
        Ok(Self { looks: Some(looks), ..object })
    }

    /// A relief-mapped mesh.
    pub(super) fn of_relief(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        relief: &Relief,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let (sphere, drawn) = relief::drawn(gpu, layouts, relief)?;
        let drawn = whole(&instances, drawn);
        Ok(Self::new(relief.clone(), (instances, sphere), (vec![0.0], 1.0), drawn))
    }

    /// An object of a caller-defined kind.
    pub(super) fn of_kind(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        kind: Box<dyn Kind>,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let own = OwnKind::new(kind)?;
        let drawn = whole(&instances, own.drawn(gpu, layouts)?);
        let (sphere, errors) = (own.kind.bounding_sphere(), own.kind.errors().to_vec());
        Ok(Self::new(own, (instances, sphere), (errors, 1.0), drawn))
    }

    /// A character: a model with clips.
    pub(super) fn of_character(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        (model, options): (&Model, &CharacterOptions<'_>),
        capacity: usize,
        (budget, keeps_last): (ErrorBudget, bool),
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let mut merged = mesh::moving_merged(model)?;
        let looks = Looks::taken(&mut merged.model);
        looks.check_all()?;
        let character = Character::new(gpu, merged, options, (instances.capacity(), keeps_last))?;
        let drawn = (character.chunks_of_looks(gpu, layouts, &looks)?, character.draws());
        let (sphere, errors) = (character.sphere(), character.errors());
        let object = Self::new(character, (instances, sphere), (errors, budget.mesh), drawn);
        Ok(Self { looks: Some(looks), ..object })
    }

    /// The same object, with uploads that still wait.
    pub(super) fn awaiting(self, pending: Option<PendingUploads>) -> Self {
        Self { pending, ..self }
    }

    /// A chunk of the object, in kernel format.
    pub(super) fn lod_object(&self, chunk: &Chunk) -> LodObject {
        let triangles = self.triangles();
        let of = LodObject {
            first: chunk.range.first,
            instances: chunk.room(),
            levels: self.errors.len() as u32,
            first_list: chunk.range.first_list,
            first_draw: chunk.range.first_draw,
            parts: self.parts() as u32,
            metric_scale: self.lod_bias * self.error_fraction(),
            thresholds: error_vectors(&self.thresholds()).map(Into::into),
            point: self.model_box[0].into(),
            half_size: self.model_box[1].into(),
            triangles: [0, 4]
                .map(|first| std::array::from_fn(|lane| triangles.get(first + lane).copied().unwrap_or(0))),
            ..LodObject::NONE
        };
        self.level_of_detail.on_device(self.is_drawn(), self.is_ranked, of)
    }

    /// The fraction of the allowed displacement that levels may use, if they are chosen by error; else 1.
    fn error_fraction(&self) -> f32 {
        match self.level_of_detail.criterion() {
            Criterion::Error => self.mesh_fraction,
            _ => 1.0,
        }
    }

    /// Smallest metric per level at which the level is drawn or begins to morph.
    pub(super) fn thresholds(&self) -> Vec<f32> {
        self.level_of_detail.thresholds(&self.errors, &self.triangles())
    }

    /// Triangles per level.
    pub(super) fn triangles(&self) -> Vec<u32> {
        let of_level = |level: usize| {
            let draws = self.draws.chunks(OBJECT_LEVELS as usize);
            draws.map(|draws| draws[level].index_count / 3).fold(0, u32::saturating_add)
        };
        (0..self.errors.len()).map(of_level).collect()
    }

    fn rank_on_device(&self) -> u32 {
        self.level_of_detail.rank_on_device(self.is_ranked)
    }

    /// Number of parts.
    fn parts(&self) -> usize {
        self.draws.len() / OBJECT_LEVELS as usize
    }

    /// Draws of all lists of a chunk per part, with instance counts of 0.
    fn draws_of_lists(&self) -> impl Iterator<Item = SceneDraw> {
        let levels = self.errors.len();
        let lists = if self.level_of_detail.transition.fades() { 4 * levels } else { 2 * levels };
        self.draws.chunks(OBJECT_LEVELS as usize).flat_map(move |draws| {
            let draw = move |list: usize| if list < lists { draws[list / 2 % levels] } else { NOTHING };
            (0..OBJECT_LISTS as usize).map(draw)
        })
    }

    /// Sets whether motion history is kept, once the object is refreshed.
    pub(super) fn keep_last(&mut self, keeps: bool) {
        self.instances.keep_last(keeps);
        self.kind.keep_last(keeps);
    }

    /// Largest number of its draws in one view and one layer.
    pub(super) fn draws(&self) -> usize {
        let parts: usize = self.drawables().map(|drawable| drawable.part_count()).sum();
        let sides = self.instances.sides().into_iter().filter(|is_listed| *is_listed).count();
        let passes = if self.level_of_detail.transition.fades() { 2 } else { 1 };
        passes * sides * parts * self.errors.len()
    }

    /// An instance's index in the scene's instance buffers.
    pub(super) fn place(&self, index: u32) -> Option<usize> {
        Some(self.chunk_of(index)?.place(index as usize))
    }

    /// The chunk that holds an instance.
    pub(super) fn chunk_of(&self, index: u32) -> Option<&Chunk> {
        self.chunks.iter().find(|chunk| chunk.slots.contains(&(index as usize)))
    }

    /// The object as a character, if it is one.
    pub(super) fn character(&self) -> Option<&Character> {
        self.kind.downcast()
    }

    /// Mutable form of [`Object::character`].
    pub(super) fn character_mut(&mut self) -> Option<&mut Character> {
        self.kind.downcast_mut()
    }

    /// The drawables, chunk by chunk.
    pub(super) fn drawables(&self) -> impl Iterator<Item = &dyn Drawable> {
        self.chunks.iter().flat_map(|chunk| chunk.drawables.iter().map(|drawable| &**drawable))
    }

    /// Number of instances the object has room for.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}

/// One chunk with all instances.
fn whole(instances: &Instances, (drawables, draws): Drawn) -> (Vec<Chunk>, Vec<SceneDraw>) {
    (vec![Chunk::new(0..instances.capacity(), drawables)], draws)
}

/// Empty storage for at least `capacity` instances.
fn room(capacity: usize) -> Result<Instances, InputError> {
    match (1..=MAX_CAPACITY).contains(&capacity) {
        true => Ok(Instances::new(capacity)),
        false => Err(InputError::new("capacity", capacity, format!("must be in 1..={MAX_CAPACITY}"))),
    }
}
