//! The interface between a scene and a renderer.

use std::any::Any;
use std::fmt::Debug;

use glam::Vec4;

use crate::Error;
use crate::gpu::{Buffer, Group, Staged};
use crate::lod::transition::Transition;
use crate::lod::{LodObject, SceneDraw};
use crate::scene::specialization::Specialization;
use crate::shared::render::scene_instances::SceneObject;

/// A drawable: triangles in parts, with one draw per part and list of instances.
pub(crate) trait Drawable: Any + Debug + wgpu::WasmNotSendSync {
    /// Number of parts.
    fn part_count(&self) -> usize;

    /// The part with index `at`.
    fn part(&self, at: usize) -> Option<Part<'_>>;

    /// Bind group 1; `None` if the view has it.
    fn group(&self) -> Option<&Group>;

    /// The triangles of all parts.
    fn indices(&self) -> &wgpu::Buffer;

    /// Stages the ranges of the instances, after a layout or its buffers changed.
    fn stage(&self, staged: &mut Staged, object: &SceneObject) -> Result<(), Error> {
        let _ = (staged, object);
        Ok(())
    }

    /// Whether its levels of detail can geomorph.
    fn can_morph(&self) -> bool {
        false
    }

    /// Sets whether levels that can geomorph do.
    fn set_morphed(&mut self, morphed: bool) {
        let _ = morphed;
    }
}

impl dyn Drawable {
    /// The parts, in the order of their draws.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        (0..self.part_count()).filter_map(|at| self.part(at))
    }

    /// The drawable as `D`, if it is one.
    pub fn downcast<D: Drawable>(&self) -> Option<&D> {
        (self as &dyn Any).downcast_ref()
    }

    /// Mutable form of `downcast`.
    pub fn downcast_mut<D: Drawable>(&mut self) -> Option<&mut D> {
        (self as &mut dyn Any).downcast_mut()
    }
}

/// A part of a drawable, with its own pipelines and draws.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Part<'a> {
    pub specialization: &'a Specialization,
    /// Bind group 2.
    pub group: &'a Group,
}

/// Object uniform of instances that are not in a layout yet.
pub(crate) const NO_OBJECT: SceneObject =
    SceneObject { first_instance: 0, number: 0, first_slot: 0, push: [Vec4::ZERO; 2] };

/// An object as a view draws it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnObject<'a> {
    /// The object's number ([`ObjectId::number`](crate::scene::ObjectId::number)).
    pub number: u32,
    /// The triangles to draw.
    pub drawable: &'a dyn Drawable,
    /// Ranges of its lists and draws, and its number of levels.
    pub lod: &'a LodObject,
    /// Whether to draw the lists of instances that are not mirrored, and the lists of mirrored ones.
    pub sides: [bool; 2],
    /// How its levels change.
    pub transition: Transition,
    /// Bind group 1, if the view has it.
    pub view_group: Option<&'a Group>,
}

/// Sorted draws: instances that are drawn one by one.
#[derive(Debug, Clone)]
pub(crate) struct SortedDraws<'a> {
    /// Indirect arguments, one draw per instance and part.
    pub draws: &'a Buffer<SceneDraw>,
    /// Instance list of each draw; each has one entry.
    pub entries: &'a Buffer<u32>,
    /// The parts, in the order in which they are drawn.
    pub parts: Vec<SortedPart<'a>>,
}

/// One part of one sorted instance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedPart<'a> {
    /// The drawable.
    pub drawable: &'a dyn Drawable,
    /// The part of the drawable.
    pub part: Part<'a>,
    /// Index of its draw.
    pub draw: u32,
    /// Whether the instance's placement mirrors.
    pub is_mirrored: bool,
    /// How the levels of its object change.
    pub transition: Transition,
}

/// A view, for a renderer.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnView<'a> {
    /// Bind group 0: [`SceneLayouts::view`](crate::scene::layouts::SceneLayouts::view).
    pub group: &'a Group,
    /// Instance indices of each list, within the object.
    pub lists: &'a Buffer<u32>,
    /// The draws.
    pub arguments: &'a Buffer<SceneDraw>,
    /// Whether the picture is a mirror image, as in `SceneView::side`.
    pub mirrors: bool,
    /// Whether depth falls with distance.
    pub reversed: bool,
    /// Whether the scene keeps motion history.
    pub keeps_last: bool,
    /// Whether shading looks surfaces up in a sun's shadow map.
    pub is_shadowed: bool,
}
