//! Uniforms of a view for kernels and shaders.

use glam::{DMat4, DVec3, IVec3, Mat4, UVec2, Vec3, Vec4};

use crate::InputError;
use crate::asset::Light;
use crate::lod::{LodCamera, SelectView, VIEW_CAMERAS};
use crate::scene::camera::Camera;
use crate::scene::placement::Placement;
use crate::scene::view::ViewShadow;
use crate::shared::render::scene_view::SceneView;

impl SceneView {
    /// The view's uniform for shaders, computed from the present and the last camera, the light, and the sun's shadow.
    pub(super) fn new(
        [camera, last]: [&Camera; 2],
        own: &LodCamera,
        light: &Light,
        shadow: Option<&ViewShadow>,
        dither_offset: UVec2,
    ) -> Self {
        let eye = match own.perspective > 0.0 {
            true => camera.eye_offset().extend(1.0),
            false => (-camera.ahead()).extend(0.0),
        };
        Self {
            clip_from_world: camera.clip_from_cell(),
            last_clip_from_world: last_clip_from_world(last, camera.cell),
            eye,
            light: light.direction.normalize().extend(light.ambient),
            light_color: light.color,
            side: if camera.is_mirrored() { -1.0 } else { 1.0 },
            cell: IVec3::from(camera.cell),
            shadow_texel: shadow.map_or(0.0, |shadow| shadow.texel),
            shadow_rows: shadow.map_or([Vec4::ZERO; 3], |shadow| shadow.rows(camera.cell)),
            dither_offset,
        }
    }

    pub(super) fn nothing() -> Self {
        let (clip_from_world, eye, light) = (Mat4::IDENTITY, Vec4::W, Vec4::Y);
        let last_clip_from_world = clip_from_world;
        Self {
            clip_from_world,
            last_clip_from_world,
            eye,
            light,
            light_color: Vec3::ONE,
            side: 1.0,
            cell: IVec3::ZERO,
            shadow_texel: 0.0,
            shadow_rows: [Vec4::ZERO; 3],
            dither_offset: UVec2::ZERO,
        }
    }
}

/// The matrix from positions relative to a cell's corner to the last frame's clip space.
fn last_clip_from_world(last: &Camera, cell: [i32; 3]) -> Mat4 {
    match last.cell == cell {
        true => last.clip_from_cell(),
        false => clip_from_cell(last, cell).as_mat4(),
    }
}

/// The matrix from positions relative to a cell's corner to the clip space of a camera.
pub(super) fn clip_from_cell(camera: &Camera, cell: [i32; 3]) -> DMat4 {
    let cells = [0, 1, 2].map(|axis| f64::from(cell[axis]) - f64::from(camera.cell[axis]));
    let moved = DMat4::from_translation(DVec3::from(cells) * f64::from(Placement::CELL));
    camera.clip_from_view.as_dmat4() * camera.view_from_cell.as_dmat4() * moved
}

impl SelectView {
    /// The uniform of a view that sees no instance.
    pub(in crate::scene) fn nothing() -> Self {
        let camera = LodCamera {
            eye: Vec3::ZERO,
            focal: 1.0,
            ahead: Vec3::NEG_Z,
            pixels: 0.0,
            near: 0.0,
            perspective: 1.0,
            pixel_count: 1.0,
            unused: 0.0,
        };
        Self {
            planes: [Vec4::NEG_W; 6],
            cameras: [camera; VIEW_CAMERAS as usize],
            cell: IVec3::ZERO,
            mask: 0,
            camera_count: 1,
            is_first: 1,
            casters: 0,
            blocks: 0,
            is_next: 0,
            seconds: 0.0,
            unused_a: 0,
            unused_b: 0,
            clip_rows: [Vec4::W; 3],
            last_clip_rows: [Vec4::W; 3],
        }
    }
}

/// Rows x, y and w of the matrix from a camera's cell to clip space. x and y are in units of half the picture's height.
pub(super) fn clip_rows(camera: &Camera) -> [Vec4; 3] {
    let clip = camera.clip_from_cell();
    let [width, height] = camera.viewport.map(|size| size as f32);
    [clip.row(0) * (width / height), clip.row(1), clip.row(3)]
}

/// A camera that decides levels of detail, in the format of kernels. Its eye is relative to the corner of `cell`, and
/// `pixels` is the largest error on the screen.
pub(super) fn lod_camera(camera: &Camera, cell: [i32; 3], pixels: f32) -> Result<LodCamera, InputError> {
    let Camera { view_from_cell, clip_from_view, viewport, depth, .. } = *camera;
    let mut own = LodCamera::new(view_from_cell, clip_from_view, viewport, depth, pixels)?;
    let cells = |axis: usize| f64::from(camera.cell[axis]) - f64::from(cell[axis]);
    let offset = glam::DVec3::from([0, 1, 2].map(cells)) * f64::from(Placement::CELL);
    own.eye = (own.eye.as_dvec3() + offset).as_vec3();
    Ok(own)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::camera::Depth;

    #[test]
    fn cameras_that_show_no_world_are_refused_by_the_callers_field() {
        let good = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 0.8, [0.1, 100.0], [64, 64]);
        assert!(lod_camera(&good, [0; 3], 1.0).is_ok());
        let refused = |camera: Camera| lod_camera(&camera, [0; 3], 1.0).expect_err("refused").path;
        let projected = Camera { view_from_cell: good.clip_from_view, ..good };
        assert_eq!(refused(projected), "camera.view_from_cell");
        let reversed = Camera { depth: Depth::Reversed, ..good };
        assert_eq!(refused(reversed), "camera.clip_from_view");
    }
}
