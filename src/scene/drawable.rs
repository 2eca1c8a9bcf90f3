//! What a renderer needs of the objects of a scene, and of a view.

use std::any::Any;
use std::fmt::Debug;

use crate::Error;
use crate::gpu::{Buffer, Group, Staged};
use crate::lod::{LodObject, SceneDraw};
use crate::scene::specialization::Specialization;
use crate::shared::render::scene_instances::SceneObject;

/// How an object is drawn: triangles in parts, of which each has a draw for each list of instances.
pub(crate) trait Drawable: Any + Debug + wgpu::WasmNotSendSync {
    /// Number of parts.
    fn part_count(&self) -> usize;

    /// A part by its number.
    fn part(&self, at: usize) -> Option<Part<'_>>;

    /// Bind group 1; `None` if that belongs to the view.
    fn group(&self) -> Option<&Group>;

    /// The triangles of all parts.
    fn indices(&self) -> &wgpu::Buffer;

    /// Stages where its instances lie, after a layout or its buffers changed.
    fn stage(&self, staged: &mut Staged, object: &SceneObject) -> Result<(), Error> {
        let _ = (staged, object);
        Ok(())
    }

    /// Whether its levels of detail can move into each other.
    fn can_morph(&self) -> bool {
        false
    }

    /// Sets whether levels that can move into each other do.
    fn set_morphed(&mut self, morphed: bool) {
        let _ = morphed;
    }
}

impl dyn Drawable {
    /// Its parts, in the order of their draws.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        (0..self.part_count()).filter_map(|at| self.part(at))
    }

    /// The drawable, if it is this one.
    pub fn downcast<D: Drawable>(&self) -> Option<&D> {
        (self as &dyn Any).downcast_ref()
    }

    /// As `downcast`, to be changed.
    pub fn downcast_mut<D: Drawable>(&mut self) -> Option<&mut D> {
        (self as &mut dyn Any).downcast_mut()
    }
}

/// A part of what is drawn, with pipelines and draws of its own.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    pub specialization: &'a Specialization,
    /// Bind group 2.
    pub group: &'a Group,
}

/// Where the instances of an object lie that no layout has yet.
pub(crate) const NO_OBJECT: SceneObject = SceneObject { first_instance: 0, number: 0, first_slot: 0 };

/// An object as a view draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnObject<'a> {
    /// The object's number ([`ObjectId::number`](crate::scene::ObjectId::number)).
    pub number: u32,
    /// How it is drawn.
    pub drawable: &'a dyn Drawable,
    /// Where its lists and draws lie, and its number of levels.
    pub lod: &'a LodObject,
    /// Whether the lists of instances that are not mirrored are drawn, and whether those of mirrored ones are.
    pub sides: [bool; 2],
    /// Bind group 1, if that belongs to the view.
    pub view_group: Option<&'a Group>,
}

/// Instances that are drawn one by one.
#[derive(Debug, Clone)]
pub(crate) struct SortedDraws<'a> {
    /// The draws of all of them.
    pub draws: &'a Buffer<SceneDraw>,
    /// The list of each draw, which has one entry.
    pub entries: &'a Buffer<u32>,
    /// The parts, in the order in which they are drawn.
    pub parts: Vec<SortedPart<'a>>,
}

/// A part of an instance that is drawn by itself.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedPart<'a> {
    /// What is drawn.
    pub drawable: &'a dyn Drawable,
    /// The part of it.
    pub part: Part<'a>,
    /// The index of its draw.
    pub draw: u32,
    /// Whether its placement mirrors.
    pub is_mirrored: bool,
}

/// A view as a renderer needs it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnView<'a> {
    /// Bind group 0: [`SceneLayouts::view`](crate::scene::layouts::SceneLayouts::view).
    pub group: &'a Group,
    /// The instances of each list, by their index in the object.
    pub lists: &'a Buffer<u32>,
    /// The draws.
    pub arguments: &'a Buffer<SceneDraw>,
    /// Whether the picture is a mirror image, as `SceneView::side` says.
    pub mirrors: bool,
    /// Whether depth falls with distance.
    pub reversed: bool,
    /// Whether the scene keeps its last frame.
    pub keeps_last: bool,
    /// Whether surfaces are looked up in the map of a sun's shadow.
    pub is_shadowed: bool,
}
