//! Objects: the data shared by all instances of one model or one terrain.

mod device;
mod frame;
mod morph;
mod slots;

use glam::{IVec3, Vec3};

use crate::asset::Model;
use crate::gpu::{Gpu, PendingUploads};
use crate::lod::LodCamera;
use crate::lod::criterion::Criterion;
use crate::scene::arrival::Arrival;
use crate::scene::character::Character;
use crate::scene::chunk::Chunk;
use crate::scene::drawable::Drawable;
use crate::scene::instances::Instances;
use crate::scene::kind::{Kind, OwnKind};
use crate::scene::layout::error_vectors;
use crate::scene::layouts::SceneLayouts;
use crate::scene::level_of_detail::LevelOfDetail;
use crate::scene::material::Looks;
use crate::scene::mesh::{self, MeshAtRest, NOTHING};
use crate::scene::object_kind::ObjectKind;
use crate::scene::options::CharacterOptions;
use crate::scene::quality::ErrorBudget;
use crate::scene::relief::{self, Relief};
use crate::scene::terrain::{self, TerrainSource};
use crate::shared::lod::instance::{INSTANCE_ALIVE, SceneInstance};
use crate::shared::lod::object::{LodObject, OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::{Error, InputError};
pub(super) use frame::laid_out;

/// Largest number of instances of one object.
const MAX_CAPACITY: usize = 1 << 20;

/// An object of a scene.
#[derive(Debug)]
pub(crate) struct Object {
    pub(super) kind: Box<dyn ObjectKind>,
    pub(super) instances: Instances,
    /// Bounding sphere of an instance whose bones do not move, in model space.
    pub(super) sphere: BoundingSphere,
    /// The error of each level of detail in model units, ascending from 0.
    pub(super) errors: Vec<f32>,
    /// The error of the finest level in model units: that of a package's quantization.
    pub(super) finest_error: f32,
    pub(super) mesh_fraction: f32,
    /// How the object's levels of detail are chosen and change.
    pub(super) level_of_detail: LevelOfDetail,
    /// Whether any object of the scene has a rank for budgets ([`LevelOfDetail::rank`]).
    pub(super) is_ranked: bool,
    /// Budgets count the object's triangles in units of 2^`triangle_unit`.
    triangle_unit: u32,
    /// Middle and half size of a box around the model, in model space.
    pub(super) model_box: [Vec3; 2],
    /// LOD bias: factor of the allowed displacement. It is 1, or more if the device has no memory for the finer levels.
    pub(super) lod_bias: f32,
    /// Dirty: LOD bias or visibility must be uploaded again.
    pub(super) is_retuned: bool,
    /// Dirty: drawables were bound again, so their ranges must be uploaded again.
    is_rebound: bool,
    /// Number of the object's handle, which shading reads.
    pub(super) handle: u32,
    pub(super) is_visible: bool,
    /// Data of the object that still waits on the host to be uploaded.
    pub(super) pending: Option<PendingUploads>,
    /// The object that takes this one's place once its data has arrived.
    pub(super) successor: Option<Box<Object>>,
    /// How far the levels of a new model have come into use.
    pub(super) arrival: Arrival,
    /// Materials and images of a mesh or a character; `None` for other kinds.
    pub(super) looks: Option<Looks>,
    /// The draws of a chunk, [`OBJECT_LEVELS`] for each part. Their instance counts are 0.
    pub(super) draws: Vec<SceneDraw>,
    /// Chunks of instances that are drawn together, at least one.
    pub(super) chunks: Vec<Chunk>,
    fitted: u64,
}

impl Object {
    /// Creates a visible object of the given kind, with one level of detail.
    pub(super) fn new(
        kind: impl ObjectKind,
        instances: Instances,
        sphere: BoundingSphere,
        chunks: Vec<Chunk>,
        draws: Vec<SceneDraw>,
    ) -> Self {
        let model_box =
            kind.model_box().map_or([sphere.center, Vec3::splat(sphere.radius)], |[low, high]| {
                [0.5 * (low + high), 0.5 * (high - low)]
            });
        Self {
            kind: Box::new(kind),
            instances,
            sphere,
            errors: vec![0.0],
            finest_error: 0.0,
            mesh_fraction: 1.0,
            level_of_detail: LevelOfDetail::default(),
            is_ranked: false,
            triangle_unit: 0,
            model_box,
            lod_bias: 1.0,
            is_retuned: false,
            is_rebound: false,
            handle: 0,
            is_visible: true,
            pending: None,
            successor: None,
            arrival: Arrival::default(),
            looks: None,
            draws,
            chunks,
            fitted: 0,
        }
    }

    /// Creates terrain. Each patch is an instance.
    pub(super) async fn of_terrain(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        source: &TerrainSource,
    ) -> Result<Self, Error> {
        let sphere = BoundingSphere { center: Vec3::ZERO, radius: 0.0 };
        if let Some((recipe, limits)) = source.endless_recipe()? {
            let made = terrain::endless::made(gpu, layouts, source, recipe, limits)?;
            let (terrain, instances, (chunks, draws)) = made;
            return Ok(Self::new(terrain, instances, sphere, chunks, draws));
        }
        let (terrain, instances, (chunks, draws)) = terrain::made(gpu, layouts, source).await?;
        Ok(Self::new(terrain, instances, sphere, chunks, draws))
    }

    /// Creates a static mesh: all meshes of a model in the rest pose.
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
        let (drawables, draws) = mesh::drawn(gpu, layouts, &merged, &looks)?;
        let (errors, finest_error) = (mesh::errors(&merged), mesh::finest_error(&merged));
        let chunks = whole(&instances, drawables);
        let object = Self::new(MeshAtRest(merged), instances, sphere, chunks, draws);
        Ok(Self { looks: Some(looks), errors, finest_error, ..object })
    }

    /// Creates a relief-mapped mesh.
    pub(super) fn of_relief(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        relief: &Relief,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let (sphere, (drawables, draws)) = relief::drawn(gpu, layouts, relief)?;
        let chunks = whole(&instances, drawables);
        Ok(Self::new(relief.clone(), instances, sphere, chunks, draws))
    }

    /// Creates an object of a caller-defined kind.
    pub(super) fn of_kind(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        kind: Box<dyn Kind>,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let own = OwnKind::new(kind)?;
        let (drawables, draws) = own.drawn(gpu, layouts)?;
        let (sphere, errors) = (own.kind.bounding_sphere(), own.kind.errors().to_vec());
        let chunks = whole(&instances, drawables);
        Ok(Self { errors, ..Self::new(own, instances, sphere, chunks, draws) })
    }

    /// Creates a character: a model with clips.
    pub(super) fn of_character(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        model: &Model,
        options: &CharacterOptions<'_>,
        capacity: usize,
        budget: ErrorBudget,
        keeps_last: bool,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let mut merged = mesh::moving_merged(model)?;
        let looks = Looks::taken(&mut merged.model);
        looks.check_all()?;
        let finest_error = mesh::finest_error(&merged);
        let character = Character::new(gpu, merged, options, instances.capacity(), keeps_last)?;
        let (chunks, draws) = (character.chunks_of_looks(gpu, layouts, &looks)?, character.draws());
        let (sphere, errors) = (character.sphere(), character.errors());
        let object = Self::new(character, instances, sphere, chunks, draws);
        Ok(Self { looks: Some(looks), errors, mesh_fraction: budget.mesh, finest_error, ..object })
    }

    /// The same object with a queue of uploads that still wait on the host.
    pub(super) fn awaiting(self, pending: Option<PendingUploads>) -> Self {
        Self { pending, ..self }
    }

    /// A chunk of the object in the format of the kernels that select levels.
    pub(super) fn lod_object(&self, chunk: &Chunk) -> LodObject {
        self.biased_lod_object(chunk, self.lod_bias)
    }

    /// As [`Self::lod_object`], with this LOD bias instead of the object's.
    fn biased_lod_object(&self, chunk: &Chunk, lod_bias: f32) -> LodObject {
        let triangles = self.triangles();
        let of = LodObject {
            first: chunk.range.first,
            instances: chunk.room(),
            levels: self.errors.len() as u32,
            first_list: chunk.range.first_list,
            first_draw: chunk.range.first_draw,
            parts: self.parts() as u32,
            metric_scale: lod_bias * self.error_fraction(),
            thresholds: error_vectors(&self.thresholds()).map(Into::into),
            point: self.model_box[0].into(),
            half_size: self.model_box[1].into(),
            triangles: [0, 4]
                .map(|first| std::array::from_fn(|lane| triangles.get(first + lane).copied().unwrap_or(0))),
            ..LodObject::NONE
        };
        self.level_of_detail.on_device(self.is_drawn(), self.is_ranked, of)
    }

    /// The fraction of the allowed displacement that levels of detail may use. It is 1 if levels are not chosen by
    /// error.
    fn error_fraction(&self) -> f32 {
        match self.level_of_detail.criterion() {
            Criterion::Error => self.mesh_fraction,
            _ => 1.0,
        }
    }

    /// For each level of detail, the smallest metric at which the level is drawn or begins to geomorph.
    pub(super) fn thresholds(&self) -> Vec<f32> {
        let thresholds = self.level_of_detail.thresholds(&self.errors, &self.triangles());
        self.arrival.lowered(thresholds)
    }

    /// The number of triangles of each level of detail.
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

    /// Number of the object's parts, each with its own draws.
    fn parts(&self) -> usize {
        self.draws.len() / OBJECT_LEVELS as usize
    }

    /// The draws of a chunk for all of its lists, [`OBJECT_LISTS`] for each part. Their instance counts are 0.
    fn draws_of_lists(&self) -> impl Iterator<Item = SceneDraw> {
        let levels = self.errors.len();
        let lists = if self.level_of_detail.transition.fades() { 4 * levels } else { 2 * levels };
        self.draws.chunks(OBJECT_LEVELS as usize).flat_map(move |draws| {
            let draw = move |list: usize| if list < lists { draws[list / 2 % levels] } else { NOTHING };
            (0..OBJECT_LISTS as usize).map(draw)
        })
    }

    /// Sets whether motion history is kept. It takes effect when the object is refreshed.
    pub(super) fn keep_last(&mut self, keeps: bool) {
        self.instances.keep_last(keeps);
        self.kind.keep_last(keeps);
    }

    /// The largest number of draws of the object in one view and one layer.
    pub(super) fn draws(&self) -> usize {
        let parts: usize = self.drawables().map(|drawable| drawable.part_count()).sum();
        let sides = self.instances.sides().into_iter().filter(|is_listed| *is_listed).count();
        let passes = if self.level_of_detail.transition.fades() { 2 } else { 1 };
        passes * sides * parts * self.errors.len()
    }

    /// The index of an instance in the scene's instance buffers. `index` is the instance's index in the object.
    pub(super) fn place(&self, index: u32) -> Option<usize> {
        Some(self.chunk_of(index)?.place(index as usize))
    }

    /// The chunk that draws an instance.
    pub(super) fn chunk_of(&self, index: u32) -> Option<&Chunk> {
        self.chunks.iter().find(|chunk| chunk.slots.contains(&(index as usize)))
    }

    /// Upper bound of the error in pixels of instances at full detail, where it exceeds what a camera allows; otherwise 0. Camera
    /// positions are relative to the corner of `cell`.
    pub(super) fn finest_pixels(&self, cameras: &[LodCamera], cell: IVec3) -> f32 {
        let of_instance = |instance: &SceneInstance| {
            let [x, y, z, radius] = instance.bounding_sphere;
            let [along, up, across] = instance.axes();
            let center = instance.position(cell) + x * along + y * up + z * across;
            let scale = instance.largest_scale();
            let radius = scale * radius;
            let pixels = |camera: &LodCamera| {
                let (own, allowed) = (scale * self.finest_error(), camera.allows(center, radius));
                let is_within = own <= self.mesh_fraction * allowed;
                let displacement = own + (1.0 - self.mesh_fraction) * allowed;
                if is_within { 0.0 } else { camera.pixels_of(displacement, center, radius) }
            };
            cameras.iter().map(pixels).fold(0.0, f32::max)
        };
        let all = self.instances.all().iter().filter(|instance| instance.flags & INSTANCE_ALIVE != 0);
        all.map(of_instance).fold(0.0, f32::max)
    }

    /// The object as a character; `None` for other kinds.
    pub(super) fn character(&self) -> Option<&Character> {
        self.kind.downcast()
    }

    /// Mutable form of [`Object::character`].
    pub(super) fn character_mut(&mut self) -> Option<&mut Character> {
        self.kind.downcast_mut()
    }

    /// All drawables of the object, chunk by chunk.
    pub(super) fn drawables(&self) -> impl Iterator<Item = &dyn Drawable> {
        self.chunks.iter().flat_map(|chunk| chunk.drawables.iter().map(|drawable| &**drawable))
    }

    /// Number of instances for which the object has memory.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}

/// A single chunk that holds all instances.
fn whole(instances: &Instances, drawables: Vec<Box<dyn Drawable>>) -> Vec<Chunk> {
    vec![Chunk::new(0..instances.capacity(), drawables)]
}

/// Empty storage for at least `capacity` instances.
fn room(capacity: usize) -> Result<Instances, InputError> {
    match (1..=MAX_CAPACITY).contains(&capacity) {
        true => Ok(Instances::new(capacity)),
        false => Err(InputError::new("capacity", capacity, format!("must be in 1..={MAX_CAPACITY}"))),
    }
}
