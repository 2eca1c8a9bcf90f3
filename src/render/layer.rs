//! Layers: the data that a draw writes, and its attachments.

use crate::scene::specialization::Shown;

/// The data of a scene that a draw writes. [`Attachments`](crate::render::Attachments) says which layers a target
/// holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layer {
    /// The colour of opaque and cut-out surfaces, with their depth.
    Color,
    /// The colour of surfaces with blended materials ([`Alpha::Blended`](crate::asset::material::Alpha::Blended)),
    /// which no other layer shows. Draw it last.
    ///
    /// They are tested against depth but do not write it. They are blended as the target says; without blending in the
    /// target, by their alpha (`wgpu::BlendState::ALPHA_BLENDING`). Instances are drawn from back to front, by the
    /// centers of their bounding spheres. Equally distant ones are drawn in the order of objects and instances, and the
    /// triangles of an instance in the order of the mesh. Each instance in view takes a draw for each of its parts.
    ///
    /// Before them come the levels of detail that fade ([`Transition`](crate::scene::Transition)). Of what fades over
    /// nothing opaque ([`CrossFade`](crate::scene::Transition::CrossFade), [`Alpha`](crate::scene::Transition::Alpha)),
    /// depth is written first, so that only the nearest surface shows: the order of instances does not matter.
    Transparent,
    /// Depth alone: for shadow maps, and for a prepass before other layers on the same target. Reliefs write their own
    /// depth. What fades over nothing opaque is part of shadow maps alone, while its weight is more than a half.
    Depth,
    /// Surface attributes before lighting, with depth, in three colours (a G-buffer).
    ///
    /// - The unit normal (w: 1) in world axes, on the visible side, with normal maps and reliefs applied.
    /// - The linear colour (w: 1) of material, texture and tint.
    /// - The numbers of [`ObjectId::number`](crate::scene::ObjectId::number) and
    ///   [`InstanceId::number`](crate::scene::InstanceId::number). `Rg16Uint` keeps their lower 16 bits.
    ///
    /// Pixels without a surface keep the caller's clear value. No object has the number 0.
    Surface,
    /// Screen-space motion since the last frame, with depth, in one colour.
    ///
    /// The unit is the picture's width for x (to the right) and its height for y (downwards). A pixel's last position
    /// is its position minus this value. It is the motion of what is drawn: of skinned vertices, placements and the
    /// camera, and on reliefs of the point that the ray meets. It needs
    /// [`Scene::keep_motion_history`](crate::scene::Scene::keep_motion_history).
    ///
    /// Vertices keep their identity while a character's level of detail and vertex pages change. Anything absent from
    /// the last frame gets the velocity of a static thing:
    ///
    /// - an instance that was just spawned;
    /// - in model space, the vertices of a character that no view saw, or whose level of detail lacked them;
    /// - in model space, all instances of an object whose memory grows because more of it is visible than ever before;
    /// - the camera of a view that was not recorded in the scene's last frame.
    ///
    /// Placement motion still counts. Camera jitter counts as motion: subtract the difference of the last two jitters.
    /// Points behind the last frame's eye have velocity 0.
    Velocity,
    /// Surface positions, with depth, in two colours: the position in world units (w: 1), and the object and instance
    /// numbers as in [`Layer::Surface`].
    ///
    /// Positions are relative to the corner of the view's cell ([`Camera::cell`](crate::scene::Camera::cell)). On
    /// reliefs, the position is that of the point that the ray meets.
    Measure,
    /// Surfaces coloured by the level of detail of their instance, with depth: red for the finest, then orange, yellow, green,
    /// teal, blue, indigo, violet. For debugging.
    Levels,
    /// The colours that the caller's output writes ([`OutputProgram`](super::OutputProgram)), with depth.
    Own,
}

impl Layer {
    /// The prefix of the layer's shader entry points. Those of a caller's output begin with the output's name.
    pub(crate) fn entry(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Transparent => "transparent",
            Self::Depth => "depth",
            Self::Surface => "surface",
            Self::Velocity => "velocity",
            Self::Measure => "measure",
            Self::Levels => "levels",
            Self::Own => "",
        }
    }

    /// Whether surfaces are shaded, or may be (a caller's output may call the shading).
    pub(crate) fn is_shaded(self) -> bool {
        matches!(self, Self::Color | Self::Transparent | Self::Own)
    }

    /// The surface attributes that the layer needs.
    pub(crate) fn shown(self) -> Shown {
        match self {
            Self::Color | Self::Transparent | Self::Own => Shown::Lit,
            Self::Surface | Self::Levels => Shown::Surface,
            Self::Depth | Self::Velocity | Self::Measure => Shown::Place,
        }
    }
}
