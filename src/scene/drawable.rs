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

/// Triangles that are divided into parts. Each part has one draw per list of instances.
pub(crate) trait Drawable: Any + Debug + wgpu::WasmNotSendSync {
    /// Number of parts.
    fn part_count(&self) -> usize;

    /// The part with index `at`; `None` beyond the last part.
    fn part(&self, at: usize) -> Option<Part<'_>>;

    /// Bind group 1; `None` if each view has its own ([`DrawnObject::view_group`]).
    fn group(&self) -> Option<&Group>;

    /// The index buffer with the triangles of all parts.
    fn indices(&self) -> &wgpu::Buffer;

    /// Stages the uniform `object`, which holds the range of instances. Called after the layout or its buffers changed.
    fn stage(&self, staged: &mut Staged, object: &SceneObject) -> Result<(), Error> {
        let _ = (staged, object);
        Ok(())
    }

    /// Whether the drawable's levels of detail can geomorph.
    fn can_morph(&self) -> bool {
        false
    }

    /// Sets whether the levels of detail geomorph. Has no effect if they cannot.
    fn set_morphed(&mut self, morphed: bool) {
        let _ = morphed;
    }
}

impl dyn Drawable {
    /// The parts, in the order of their draws.
    pub fn parts(&self) -> impl Iterator<Item = Part<'_>> {
        (0..self.part_count()).filter_map(|at| self.part(at))
    }

    /// The drawable as type `D`; `None` if it has another type.
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

/// The uniform of an object whose instances are not in a layout yet.
pub(crate) const NO_OBJECT: SceneObject =
    SceneObject { first_instance: 0, number: 0, first_slot: 0, push: [Vec4::ZERO; 2] };

/// A drawable of an object, with the data for drawing it in one view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnObject<'a> {
    /// The object's number ([`ObjectId::number`](crate::scene::ObjectId::number)).
    pub number: u32,
    /// The triangles to draw.
    pub drawable: &'a dyn Drawable,
    /// Ranges of the object's lists and draws, and its number of levels of detail.
    pub lod: &'a LodObject,
    /// Two flags: whether to draw the instances that are not mirrored, and whether to draw the mirrored ones.
    pub sides: [bool; 2],
    /// How instances change from one level of detail to the next.
    pub transition: Transition,
    /// The object's bind group 1 in this view; `None` if the drawable has its own.
    pub view_group: Option<&'a Group>,
}

/// The draws of instances that a view draws one by one, from back to front.
#[derive(Debug, Clone)]
pub(crate) struct SortedDraws<'a> {
    /// Indirect arguments, one draw per instance and part.
    pub draws: &'a Buffer<SceneDraw>,
    /// The instance lists of the draws. Each list has one entry, because a draw has one instance.
    pub entries: &'a Buffer<u32>,
    /// The parts, in the order in which they are drawn.
    pub parts: Vec<SortedPart<'a>>,
}

/// One draw in sorted order: a part of one instance.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SortedPart<'a> {
    /// The drawable that the part belongs to.
    pub drawable: &'a dyn Drawable,
    /// The part's pipeline specialization and bind group.
    pub part: Part<'a>,
    /// Index of the part's draw in [`SortedDraws::draws`].
    pub draw: u32,
    /// Whether the instance's placement mirrors.
    pub is_mirrored: bool,
    /// How instances of the object change from one level of detail to the next.
    pub transition: Transition,
}

/// The data that a renderer needs to draw a view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DrawnView<'a> {
    /// Bind group 0: [`SceneLayouts::view`](crate::scene::layouts::SceneLayouts::view).
    pub group: &'a Group,
    /// Instance lists of all objects. An entry holds the instance's index within its object.
    pub lists: &'a Buffer<u32>,
    /// Arguments of the indirect draws of all objects.
    pub arguments: &'a Buffer<SceneDraw>,
    /// Whether the picture is a mirror image, as in `SceneView::side`.
    pub mirrors: bool,
    /// Whether depth falls with distance.
    pub reversed: bool,
    /// Whether the scene keeps motion history.
    pub keeps_last: bool,
    /// Whether shading reads a sun's shadow map.
    pub is_shadowed: bool,
}
