//! The shadow of the sun in a view.

use glam::{DMat4, DVec3, Vec4};

use super::View;
use super::uniforms::clip_from_cell;
use crate::scene::camera::Camera;

/// The map of a sun's shadow, and how it was drawn.
#[derive(Debug, Clone)]
pub(crate) struct ViewShadow {
    /// Depths from the sun's camera on.
    pub map: wgpu::TextureView,
    /// The sun's camera, parallel, with forward depth.
    pub camera: Camera,
    /// World units that a texel covers.
    pub texel: f32,
}

impl ViewShadow {
    /// The rows that turn positions relative to the corner of a cell into places in the map: u, v and depth.
    pub(super) fn rows(&self, cell: [i32; 3]) -> [Vec4; 3] {
        // From −1..1 with +Y up to 0..1 with +V down.
        let half = DMat4::from_translation(DVec3::new(0.5, 0.5, 0.0))
            * DMat4::from_scale(DVec3::new(0.5, -0.5, 1.0));
        let rows = half * clip_from_cell(&self.camera, cell);
        [0, 1, 2].map(|at| rows.row(at).as_vec4())
    }
}

impl View {
    /// Shows the scene in the shadow of a sun from the next recording on.
    pub(crate) fn set_shadow(&mut self, shadow: ViewShadow) {
        self.shadow = Some(shadow);
    }

    /// Shows the scene without the shadow of a sun again, which
    /// [`SunShadow::fit`](crate::render::SunShadow::fit) had given to the view.
    pub fn clear_shadow(&mut self) {
        self.shadow = None;
    }
}
