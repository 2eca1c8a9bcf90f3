//! Objects: what all instances of one model or one terrain share.

use crate::Error;
use crate::gpu::Gpu;
use crate::lod::assign::AssignPass;
use crate::scene::Shares;
use crate::scene::character::Character;
use crate::scene::drawable::Drawable;
use crate::scene::instances::Instances;
use crate::scene::layout::{Layout, ObjectRange};
use crate::scene::terrain::Terrain;
use crate::shared::lod::object::SceneDraw;
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
}

/// What an object is.
#[derive(Debug)]
pub(super) enum Kind {
    Terrain(Terrain),
    Mesh,
    Character(Box<Character>),
}

impl Object {
    /// Number of levels of detail.
    pub(crate) fn levels(&self) -> usize {
        self.errors.len()
    }

    /// World units between the samples of a terrain.
    pub(super) fn spacing(&self) -> Option<f64> {
        match &self.kind {
            Kind::Terrain(terrain) => Some(terrain.spacing),
            Kind::Mesh | Kind::Character(_) => None,
        }
    }

    /// Makes room for twice as many instances.
    pub(super) fn grow(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.instances.grow(2 * self.instances.capacity());
        if let Kind::Character(character) = &mut self.kind {
            character.grow(gpu, self.instances.capacity())?;
            self.drawables = character.drawables(gpu)?;
        }
        Ok(())
    }

    /// Lets everything start afresh.
    pub(super) fn refresh(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.instances.change_all();
        if let Kind::Character(character) = &mut self.kind {
            character.grow(gpu, self.instances.capacity())?;
            self.drawables = character.drawables(gpu)?;
        }
        Ok(())
    }

    /// Prepares what depends on the layout.
    pub(super) fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        pass: &AssignPass,
        shares: Shares,
    ) -> Result<(), Error> {
        match &mut self.kind {
            Kind::Character(character) => character.fit(gpu, layout, pass, (self.range, &self.errors, shares)),
            Kind::Mesh | Kind::Terrain(_) => Ok(()),
        }
    }

    /// Number of instances that there is room for.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}
