//! A sun's shadow in a view.

use glam::{DMat4, DVec3, Vec4};

use super::View;
use super::uniforms::clip_from_cell;
use crate::scene::camera::Camera;

/// A sun's shadow map, and the camera for which the map was drawn.
#[derive(Debug, Clone)]
pub(crate) struct ViewShadow {
    /// Depth texture, as seen by the sun's camera.
    pub map: wgpu::TextureView,
    /// The sun's camera: parallel, with forward depth.
    pub camera: Camera,
    /// Size of a texel of the map in world units.
    pub texel: f32,
}

impl ViewShadow {
    /// Matrix rows from positions relative to a cell's corner to shadow map coordinates: u, v and depth.
    pub(super) fn rows(&self, cell: [i32; 3]) -> [Vec4; 3] {
        // From clip space (−1 to 1, +Y up) to texture space (0 to 1, +V down).
        let half = DMat4::from_translation(DVec3::new(0.5, 0.5, 0.0))
            * DMat4::from_scale(DVec3::new(0.5, -0.5, 1.0));
        let rows = half * clip_from_cell(&self.camera, cell);
        [0, 1, 2].map(|at| rows.row(at).as_vec4())
    }
}

impl View {
    /// Applies a sun's shadow from the next recording on.
    pub(crate) fn set_shadow(&mut self, shadow: ViewShadow) {
        self.shadow = Some(shadow);
    }

    /// Removes the sun's shadow that [`SunShadow::fit`](crate::render::SunShadow::fit) applied to this view.
    pub fn clear_shadow(&mut self) {
        self.shadow = None;
    }
}
