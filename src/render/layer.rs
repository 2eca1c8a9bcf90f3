//! Layers: the kinds of data that a draw of a scene writes.

use crate::scene::specialization::Shown;

/// The kind of data that a draw of a scene writes. [`Attachments`](crate::render::Attachments) says which layers can be drawn
/// into a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Layer {
    /// The colour of opaque and cut-out surfaces, with their depth.
    Color,
    /// The colour of surfaces with blended materials ([`Alpha::Blended`](crate::asset::material::Alpha::Blended)). No other layer
    /// shows these surfaces. Draw this layer last.
    ///
    /// The surfaces are tested against depth but do not write it. They are blended as the target's format says, or by their alpha
    /// (`wgpu::BlendState::ALPHA_BLENDING`) if the format has no blending. Instances are drawn from back to front, by the centers
    /// of their bounding spheres. Equally distant instances are drawn in the order of objects and instances, and the triangles of
    /// an instance in the order of the mesh. Each instance in view takes one draw for each of its parts.
    ///
    /// Levels of detail that fade ([`Transition`](crate::scene::Transition)) are drawn before these surfaces. In two
    /// transitions, no opaque level is behind the fading levels: [`CrossFade`](crate::scene::Transition::CrossFade) and
    /// [`Alpha`](crate::scene::Transition::Alpha). The depth of these levels is written first, so that only the nearest surface
    /// shows and the order of instances does not matter.
    Transparent,
    /// Only depth, for shadow maps, and for a prepass before other layers on the same target. Reliefs write the depth of the
    /// relief instead of the depth of the mesh. A prepass leaves out instances that fade by
    /// [`CrossFade`](crate::scene::Transition::CrossFade) or [`Alpha`](crate::scene::Transition::Alpha). Shadow maps show a level
    /// of these instances while the level's weight is more than a half.
    Depth,
    /// Three colour attachments, with depth: surface attributes before lighting (a G-buffer).
    ///
    /// - The unit normal (w: 1) in world axes, on the visible side, with normal maps and reliefs applied.
    /// - The linear colour (w: 1) of material, texture and tint.
    /// - The object number ([`ObjectId::number`](crate::scene::ObjectId::number)) and the instance number
    ///   ([`InstanceId::number`](crate::scene::InstanceId::number)). `Rg16Uint` keeps the lower 16 bits of each.
    ///
    /// Pixels without a surface keep the caller's clear value. No object has the number 0.
    Surface,
    /// One colour attachment, with depth: screen-space motion since the last frame.
    ///
    /// The unit is the picture's width for x (to the right) and its height for y (downwards). A pixel's last position is its
    /// position minus this value. The value contains the motion of skinned vertices, of placements and of the camera. On reliefs,
    /// the value is the motion of the point that the ray meets. This layer needs
    /// [`Scene::keep_motion_history`](crate::scene::Scene::keep_motion_history).
    ///
    /// Vertices keep their identity while a character's level of detail and vertex pages (blocks of 64 skinned vertices) change.
    /// Anything absent from the last frame gets the velocity of a static object:
    ///
    /// - an instance that was just spawned;
    /// - the vertices of a character that no view saw, and vertices that the character's level of detail lacked (only in model
    ///   space);
    /// - all instances of an object whose memory grows because more of it is visible than ever before (only in model space);
    /// - the camera of a view that was not recorded in the scene's last frame.
    ///
    /// "Only in model space" means that the velocity still contains the motion of the placement. Camera jitter counts as motion:
    /// subtract the difference of the last two jitters. Points behind the last frame's eye have velocity 0.
    Velocity,
    /// Two colour attachments, with depth: the surface position in world units (w: 1), and the object and instance
    /// numbers as in [`Layer::Surface`].
    ///
    /// Positions are relative to the corner of the view's cell ([`Camera::cell`](crate::scene::Camera::cell)). On reliefs
    /// ([`Scene::add_relief`](crate::scene::Scene::add_relief)), the position is the point that the ray meets.
    Measure,
    /// Surfaces coloured by the level of detail of their instance, or of their node of endless terrain, with depth: red for the
    /// finest, then orange, yellow, green, teal, blue, indigo, and violet for the eighth and all coarser ones. For debugging.
    Levels,
    /// The colours that the caller's output writes ([`OutputProgram`](super::OutputProgram)), with depth.
    Own,
}

impl Layer {
    /// Prefix of the layer's shader entry points. Empty for [`Layer::Own`], whose entry points begin with the output's name.
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

    /// Whether the layer uses shading. [`Layer::Own`] counts, because a caller's output may call the shading.
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
