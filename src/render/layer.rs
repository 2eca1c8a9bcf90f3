//! What of a scene is drawn, and into which attachments.

use crate::scene::specialization::Shown;

/// What of a scene is drawn. [`Attachments`](crate::render::Attachments) says which layers a target holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layer {
    /// The colour of opaque and cut-out surfaces, with their depth.
    Color,
    /// The colour of surfaces whose materials are blended ([`Alpha::Blended`](crate::asset::material::Alpha::Blended)),
    /// which no other layer shows: tested against depth, which they do not write, and blended as the target says, or where
    /// it says nothing by their alpha (`wgpu::BlendState::ALPHA_BLENDING`). Draw it last. Instances are drawn from back to
    /// front, by the middles of their bounding spheres; those as far away in the order of objects and instances, and
    /// triangles of an instance in the order of the mesh. Each instance in view takes a draw for each of its parts.
    Transparent,
    /// Depth alone: for a prepass, in front of other layers on the same target, and for shadow maps. Reliefs write
    /// their own depth.
    Depth,
    /// What surfaces are before they are lit, with their depth, into three colours: the unit normal (w: 1), with normal
    /// maps and reliefs, in world axes, on the side that is seen; the linear colour (w: 1) of material, texture and tint;
    /// and the numbers of [`ObjectId::number`](crate::scene::ObjectId::number) and
    /// [`InstanceId::number`](crate::scene::InstanceId::number), of which `Rg16Uint` keeps the lower 16 bits. Where
    /// nothing is drawn, what the caller cleared stays; no object has the number 0.
    Surface,
    /// The motion of surfaces on the screen since the last frame, with their depth, into one colour: to the right as a
    /// fraction of the picture's width, and downwards as one of its height, so that a pixel was at its place minus this. It
    /// is the motion of what is drawn: of skinned vertices, placements and the camera, and on reliefs of the point which the
    /// ray meets. It needs [`Scene::keep_motion_history`](crate::scene::Scene::keep_motion_history).
    ///
    /// Vertices keep their identity while a character's levels of detail, and the pages of its vertices, change. What was
    /// not there in the last frame counts as if it had stood still: an instance that was spawned, and the vertices in the
    /// model's space of a character that no view saw or whose level of detail lacked them, or of all of its instances where
    /// more is seen than ever before and its memory grows; a placement that moved counts all the same. A view that was not recorded in the scene's last frame has a camera that stood still. A camera's jitter
    /// counts as motion: the difference of the last two is to be subtracted. What lay behind the last frame's eye has the
    /// velocity 0.
    Velocity,
    /// Where surfaces are, with their depth, into two colours: the position in world units, relative to the corner of the
    /// view's cell ([`Camera::cell`](crate::scene::Camera::cell); w: 1), on reliefs that of the point which the ray meets;
    /// and the same two numbers.
    Measure,
    /// What the caller's output writes ([`OutputProgram`](super::OutputProgram)), with depth.
    Own,
}

impl Layer {
    /// What the names of its entry points in shaders begin with; those of the caller's output begin with its name.
    pub(crate) fn entry(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Transparent => "transparent",
            Self::Depth => "depth",
            Self::Surface => "surface",
            Self::Velocity => "velocity",
            Self::Measure => "measure",
            Self::Own => "",
        }
    }

    /// Whether surfaces are shaded, or may be.
    pub(crate) fn is_shaded(self) -> bool {
        matches!(self, Self::Color | Self::Transparent | Self::Own)
    }

    /// What of surfaces it needs.
    pub(crate) fn shown(self) -> Shown {
        match self {
            Self::Color | Self::Transparent | Self::Own => Shown::Lit,
            Self::Surface => Shown::Surface,
            Self::Depth | Self::Velocity | Self::Measure => Shown::Place,
        }
    }
}
