//! Objects: what all instances of one model or one terrain share.

use crate::Error;
use crate::gpu::{Gpu, Staged, Upload as _};
use crate::lod::assign::AssignPass;
use crate::scene::Shares;
use crate::scene::character::Character;
use crate::scene::drawable::{Drawable, MeshDrawable};
use crate::scene::instances::Instances;
use crate::scene::layout::{self, Layout, ObjectRange};
use crate::scene::layouts::SceneLayouts;
use crate::scene::terrain::Terrain;
use crate::shared::lod::object::{LodObject, OBJECT_LISTS, SceneDraw};
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::bounding_sphere::BoundingSphere;

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
    pub(super) is_shown: bool,
    /// What is drawn, part by part.
    pub(crate) drawables: Vec<Drawable>,
    /// Of each part, the draws of all lists, without instances.
    pub(super) draws: Vec<SceneDraw>,
    pub(crate) range: ObjectRange,
    /// For each drawable, the object as kernels see it, with the draws of the drawable's parts, in the layout for which it
    /// was prepared.
    pub(crate) lods: Vec<LodObject>,
    pub(super) fitted: u64,
}

/// What an object is.
#[derive(Debug)]
pub(super) enum Kind {
    Terrain(Terrain),
    Mesh,
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
            is_shown: true,
            drawables,
            draws,
            range: ObjectRange::default(),
            lods: Vec::new(),
            fitted: 0,
        }
    }

    /// World units between the samples of a terrain.
    pub(super) fn spacing(&self) -> Option<f64> {
        match &self.kind {
            Kind::Terrain(terrain) => Some(terrain.spacing),
            Kind::Mesh | Kind::Character(_) => None,
        }
    }

    /// Makes room for twice as many instances.
    pub(super) fn grow(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        self.instances.grow(2 * self.instances.capacity());
        self.refresh(gpu, layouts)
    }

    /// Lets everything start afresh.
    pub(super) fn refresh(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        self.instances.change_all();
        if let Kind::Character(character) = &mut self.kind {
            character.grow(gpu, self.instances.capacity())?;
            self.drawables = character.drawables(gpu, layouts)?;
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
        if self.fitted == layout.version {
            return Ok(());
        }
        self.fitted = layout.version;
        let mut lod = layout::lod_object(self);
        self.lods.clear();
        for drawable in &self.drawables {
            self.lods.push(lod);
            lod.first_draw += OBJECT_LISTS * drawable.parts() as u32;
        }
        for drawable in &self.drawables {
            if let Drawable::Mesh(MeshDrawable { geometry, clusters, .. }) = drawable {
                let params = MeshParams { first_instance: self.range.first, clusters: *clusters };
                staged.uniform(&geometry.params, &params)?;
            }
        }
        match &mut self.kind {
            Kind::Character(character) => {
                character.fit(gpu, layout, pass, (self.range, &self.errors, shares))
            }
            Kind::Mesh | Kind::Terrain(_) => Ok(()),
        }
    }

    /// Number of instances that there is room for.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}
