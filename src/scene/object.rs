//! Objects: what all instances of one model or one terrain share.

use crate::asset::Model;
use crate::gpu::{Gpu, GpuError};
use crate::scene::character::Character;
use crate::scene::drawable::Drawable;
use crate::scene::instances::Instances;
use crate::scene::layout::ObjectRange;
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

    /// Number of instances that there is room for.
    pub(crate) fn capacity(&self) -> usize {
        self.instances.capacity()
    }
}
