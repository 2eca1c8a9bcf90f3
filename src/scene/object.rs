//! Objects: what all instances of one model or one terrain share.

mod device;

use std::sync::Arc;

use glam::Vec3;

use crate::asset::Model;
use crate::gpu::{Gpu, Staged, Upload as _};
use crate::lod::SelectView;
use crate::lod::assign::AssignPass;
use crate::scene::character::Character;
use crate::scene::drawable::Drawable;
use crate::scene::handles::Slots;
use crate::scene::instances::{self, Instances};
use crate::scene::layers::CharacterOptions;
use crate::scene::layout::{Layout, ObjectRange, error_vectors};
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh;
use crate::scene::order::SinglePart;
use crate::scene::quality::Shares;
use crate::scene::ray::Surface;
use crate::scene::relief::{self, Relief};
use crate::scene::statistics::view::Counted;
use crate::scene::terrain::{self, Terrain, TerrainSource};
use crate::scene::view::SeenTerrain;
use crate::shared::lod::instance::INSTANCE_CARRIES;
use crate::shared::lod::object::{LodObject, OBJECT_LISTS, SceneDraw};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::merged::Merged;
use crate::{Error, InputError};
pub(super) use device::OnDevice;
use device::{rebound, stage_params};

/// An object of a scene.
#[derive(Debug)]
pub(crate) struct Object {
    pub(super) kind: Kind,
    pub(super) instances: Instances,
    /// A sphere around an instance that moves no bone.
    pub(super) sphere: BoundingSphere,
    /// The error of each level in the model's units, ascending from 0.
    pub(super) errors: Vec<f32>,
    pub(super) mesh_fraction: f32,
    /// The factor by which its levels are coarser than the views ask for: 1 unless its vertices exceed a binding.
    pub(super) coarsening: f32,
    /// Its number among the objects of the layout.
    pub(super) number: usize,
    /// The number that its handle tells.
    pub(super) handle: u32,
    pub(super) is_shown: bool,
    /// What is drawn, part by part.
    pub(crate) drawables: Vec<Drawable>,
    /// Of each part, the draws of all lists, without instances.
    pub(super) draws: Vec<SceneDraw>,
    pub(crate) range: ObjectRange,
    /// For each drawable, the object as kernels see it, with the draws of the drawable's parts, in the layout for which it
    /// was prepared.
    pub(crate) lods: Vec<LodObject>,
    /// Its parts that are drawn instance by instance.
    pub(super) singles: Vec<SinglePart>,
    pub(super) fitted: u64,
}

/// What the host keeps of a mesh that does not move by itself.
#[derive(Debug)]
pub(super) enum MeshOnHost {
    /// Merged meshes at rest.
    Model(Box<Merged>),
    /// A mesh with relief.
    Relief(Box<Relief>),
}

impl MeshOnHost {
    /// Its triangles in full detail.
    pub fn surfaces(&self) -> Vec<Surface<'_>> {
        match self {
            Self::Model(merged) => {
                let meshes = &merged.model.meshes;
                let surface = |at: usize| Surface::of_merged(merged, at, &meshes[at].positions[..]);
                (0..meshes.len()).map(surface).collect()
            }
            Self::Relief(relief) => {
                let positions = relief.mesh.vertices.iter().map(|vertex| vertex.position).collect::<Vec<_>>();
                vec![Surface::new(positions, &relief.mesh.indices, relief.double_sided)]
            }
        }
    }
}

/// What an object is.
#[derive(Debug)]
pub(super) enum Kind {
    Terrain(Terrain),
    Mesh(MeshOnHost),
    Character(Box<Character>),
}

impl Object {
    /// An object that is shown.
    pub(super) fn new(
        kind: Kind,
        (instances, sphere): (Instances, BoundingSphere),
        (errors, mesh_fraction): (Vec<f32>, f32),
        (drawables, draws): (Vec<Drawable>, Vec<SceneDraw>),
    ) -> Self {
        Self {
            kind,
            instances,
            sphere,
            errors,
            mesh_fraction,
            coarsening: 1.0,
            number: 0,
            handle: 0,
            is_shown: true,
            drawables,
            draws,
            range: ObjectRange::default(),
            lods: Vec::new(),
            singles: Vec::new(),
            fitted: 0,
        }
    }

    /// Terrain.
    pub(super) async fn terrain(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        source: &TerrainSource,
    ) -> Result<Self, Error> {
        let (terrain, instances, drawn) = terrain::generated(gpu, layouts, source).await?;
        let sphere = BoundingSphere { center: Vec3::ZERO, radius: 0.0 };
        Ok(Self::new(Kind::Terrain(terrain), (instances, sphere), (vec![0.0], 1.0), drawn))
    }

    /// A model's meshes at rest.
    pub(super) fn mesh(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        model: &Model,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let (merged, sphere) = mesh::at_rest_merged(model)?;
        let drawn = mesh::drawn(gpu, layouts, &merged)?;
        let errors = mesh::errors(&merged);
        let kind = Kind::Mesh(MeshOnHost::Model(Box::new(merged)));
        Ok(Self::new(kind, (instances, sphere), (errors, 1.0), drawn))
    }

    /// A mesh with relief.
    pub(super) fn relief(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        relief: &Relief,
        capacity: usize,
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let (sphere, drawn) = relief::drawn(gpu, layouts, relief)?;
        let kind = Kind::Mesh(MeshOnHost::Relief(Box::new(relief.clone())));
        Ok(Self::new(kind, (instances, sphere), (vec![0.0], 1.0), drawn))
    }

    /// A model that has clips.
    pub(super) fn character(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        (model, options): (&Model, &CharacterOptions<'_>),
        capacity: usize,
        (shares, keeps_last): (Shares, bool),
    ) -> Result<Self, Error> {
        let instances = room(capacity)?;
        let merged = mesh::moving_merged(model)?;
        let character = Character::new(gpu, merged, options, (instances.capacity(), keeps_last))?;
        let drawn = (character.drawables(gpu, layouts)?, character.draws());
        let (sphere, errors) = (character.sphere(), character.errors());
        let kind = Kind::Character(Box::new(character));
        Ok(Self::new(kind, (instances, sphere), (errors, shares.mesh), drawn))
    }

    /// What views need to know of a terrain.
    pub(super) fn seen_terrain(&self) -> Option<SeenTerrain> {
        match &self.kind {
            Kind::Terrain(terrain) => Some(SeenTerrain { spacing: terrain.spacing, object: self.handle }),
            Kind::Mesh(_) | Kind::Character(_) => None,
        }
    }

    /// The object as kernels see it.
    pub(super) fn lod_object(&self) -> LodObject {
        LodObject {
            first: self.range.first,
            instances: self.instances.capacity() as u32,
            levels: self.errors.len() as u32,
            first_list: self.range.first_list,
            first_draw: self.range.first_draw,
            parts: self.draws.len() as u32 / OBJECT_LISTS,
            mesh_fraction: self.coarsening * self.mesh_fraction,
            shown: u32::from(self.is_shown),
            errors: error_vectors(&self.errors).map(Into::into),
        }
    }

    /// Sets the sphere of an instance that plays something else.
    pub(super) fn bound_again(&mut self, index: u32) {
        if let Kind::Character(character) = &self.kind {
            let sphere = character.sphere_of(index);
            self.instances.change(index, |instance| instances::bound(instance, &sphere));
        }
    }

    /// Keeps the last frame, once it is refreshed, or does no longer.
    pub(super) fn keep_last(&mut self, keeps: bool) {
        self.instances.keep_last(keeps);
        if let Kind::Character(character) = &mut self.kind {
            character.keep_last(keeps);
        }
    }

    /// Ends fades that have reached their weight.
    pub(super) fn settle(&mut self, now: f64) {
        let Kind::Character(character) = &mut self.kind else { return };
        let settled = character.settle(now);
        for index in settled {
            // What carries a mesh keeps the larger sphere until it plays something else.
            if self.instances.all()[index as usize].flags & INSTANCE_CARRIES == 0 {
                self.bound_again(index);
            }
        }
    }

    /// Provides what the views of a frame need of a character. Where a binding is too small for it, its levels of detail
    /// are coarser.
    pub(super) fn provide(
        &mut self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        views: &[SelectView],
        (staged, layout): (&mut Staged, &Layout),
    ) -> Result<(), Error> {
        let lod = LodObject { mesh_fraction: self.mesh_fraction, ..self.lod_object() };
        let Kind::Character(character) = &mut self.kind else { return Ok(()) };
        let provided = character.provide(gpu, views, &lod, self.instances.all());
        // One mesh may have got its pages before another failed to.
        if provided.as_ref().map_or(true, |(_, is_replaced)| *is_replaced) {
            self.drawables = rebound(&self.drawables, gpu, layouts, character)?;
            stage_params(staged, &self.drawables, self.range.first, self.handle)?;
        }
        let (coarsening, _) = provided?;
        if coarsening != self.coarsening {
            self.coarsening = coarsening;
            character.stage_mesh_fraction(staged, coarsening * self.mesh_fraction)?;
            staged.elements(&layout.objects, self.number, &[self.lod_object()])?;
        }
        Ok(())
    }

    /// Prepares what depends on the layout.
    pub(super) fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        (pass, shares): (&AssignPass, Shares),
        staged: &mut Staged,
    ) -> Result<(), Error> {
        if let Kind::Character(character) = &mut self.kind {
            character.fit_driven(gpu, staged)?;
        }
        if self.fitted == layout.version {
            return Ok(());
        }
        let mut lod = self.lod_object();
        self.lods.clear();
        for drawable in &self.drawables {
            self.lods.push(lod);
            lod.first_draw += OBJECT_LISTS * drawable.parts() as u32;
        }
        stage_params(staged, &self.drawables, self.range.first, self.handle)?;
        if let Kind::Character(character) = &mut self.kind {
            character.fit(gpu, layout, pass, (self.range, &self.errors, shares))?;
        }
        self.fitted = layout.version;
        Ok(())
    }

    /// Number of instances that there is room for.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}

/// Room for at least `capacity` instances.
fn room(capacity: usize) -> Result<Instances, InputError> {
    match (1..=1 << 20).contains(&capacity) {
        true => Ok(Instances::new(capacity)),
        false => Err(InputError::new("capacity", capacity, "must be in 1..=1048576")),
    }
}

/// Lays out objects, one after the other, and tells each its range. `version` is the number of the layout, and whether the
/// last frame is kept.
///
/// # Errors
/// [`crate::gpu::GpuError`].
pub(super) fn laid_out(
    gpu: &Gpu,
    objects: &mut Slots<Object>,
    (version, keeps_last): (u64, bool),
) -> Result<Layout, Error> {
    let mut range = ObjectRange::default();
    let (mut all, mut draws, mut singles) = (Vec::new(), Vec::new(), Vec::new());
    for object in objects.iter_mut() {
        object.range = range;
        object.number = all.len();
        object.coarsening = 1.0;
        let instances = object.instances.capacity() as u32;
        all.push(object.lod_object());
        draws.extend_from_slice(&object.draws);
        object.lay_out_singles(&mut singles);
        range.first += instances;
        range.first_list += 2 * object.errors.len() as u32 * instances;
        range.first_draw += object.draws.len() as u32;
    }
    let counted = Arc::new(Counted::new(objects));
    Layout::new(gpu, (&all, draws, &singles), range, (version, keeps_last, counted))
}
