//! Cameras of views: frustum planes and allowed displacement, computed from the caller's own matrices. `docs/pixel-bounds.md`
//! derives the displacement.

use glam::{DMat3, DMat4, DVec3, DVec4, Mat4, Vec3, Vec4};

use super::LodCamera;
use crate::InputError;

/// The direction of depth in clip space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Depth {
    /// 0 at the near plane, 1 at the far plane.
    #[default]
    Forward,
    /// 1 at the near plane, 0 at the far plane or at infinity.
    Reversed,
}

/// Smallest usable length of a plane's normal, as a fraction of the length of a matrix row. The normal is the sum or difference
/// of two rows. If it is shorter, f32 rounding of the matrices decides its direction.
const LOST: f64 = 1e-4;

/// A plane that excludes nothing.
const NOWHERE: Vec4 = Vec4::W;

/// The six frustum planes of a matrix from cell space to clip space, whose depth is 0 to 1.
///
/// Each plane is a unit normal that points inwards, and a distance. The order is left, right, bottom, top, depth 0, depth 1. A
/// plane at infinity, or so far away that rounding decides its direction, becomes (0, 0, 0, 1), which excludes nothing.
pub fn planes(clip_from_cell: Mat4) -> [Vec4; 6] {
    let [x, y, z, w] = rows(&clip_from_cell.as_dmat4());
    let unit = |plane: DVec4, of: DVec4| {
        let length = plane.truncate().length();
        let unit = (plane / length).as_vec4();
        let is_kept = length > LOST * of.truncate().length() && unit.is_finite();
        if is_kept { unit } else { NOWHERE }
    };
    [unit(w + x, x), unit(w - x, x), unit(w + y, y), unit(w - y, y), unit(z, DVec4::ZERO), unit(w - z, w)]
}

fn rows(matrix: &DMat4) -> [DVec4; 4] {
    [0, 1, 2, 3].map(|row| matrix.row(row))
}

/// Eye and viewing direction of a perspective camera.
struct Perspective {
    eye: DVec3,
    ahead: DVec3,
}

impl LodCamera {
    /// A camera from the matrices of a view. `view_from_cell` maps cell space to camera space. `clip_from_view` maps camera space
    /// to clip space with depth 0 to 1.
    ///
    /// Any perspective works (also infinite, off-axis, jittered, oblique), and any parallel projection. View matrices may mirror
    /// and scale. `viewport` is width and height in pixels. `pixels` is the largest allowed displacement on the screen.
    ///
    /// # Errors
    /// [`InputError`] for:
    /// - `camera.view_from_cell` that is not finite, affine and invertible;
    /// - `camera.clip_from_view` that is not finite or collapses the picture, or whose near plane (at depth 0, or 1 if reversed)
    ///   is not ahead of the eye;
    /// - `camera.viewport` without pixels;
    /// - `quality.pixels` that is negative or not finite.
    pub fn new(
        view_from_cell: Mat4,
        clip_from_view: Mat4,
        viewport: [u32; 2],
        depth: Depth,
        pixels: f32,
    ) -> Result<Self, InputError> {
        check_view(&view_from_cell)?;
        if viewport.contains(&0) {
            let [width, height] = viewport;
            return Err(InputError::new(
                "camera.viewport",
                format!("{width} × {height}"),
                "must have pixels",
            ));
        }
        if !(0.0..f32::INFINITY).contains(&pixels) {
            return Err(InputError::new("quality.pixels", pixels, "must be finite, and not negative"));
        }
        let clip_from_cell = clip_from_view.as_dmat4() * view_from_cell.as_dmat4();
        Self::of(&clip_from_cell, viewport, depth, pixels).ok_or_else(|| refused(&clip_from_view))
    }

    /// The camera of a matrix from cell space to clip space; `None` if the matrix is not valid for a camera.
    fn of(clip_from_cell: &DMat4, viewport: [u32; 2], depth: Depth, pixels: f32) -> Option<Self> {
        let reversed = depth == Depth::Reversed;
        let [x, y, z, w] = rows(clip_from_cell);
        let perspective = perspective([x, y, w])?;
        let ahead = perspective.as_ref().map(|perspective| perspective.ahead);
        // `along` is the growth of w per unit ahead (perspective), or w itself (parallel). `across` holds pixels per unit of
        // length, perpendicular to the view direction.
        let along = if ahead.is_some() { w.truncate().length() } else { w.w };
        let across = [(x, viewport[0]), (y, viewport[1])].map(|(row, size)| {
            let row = row.truncate() * (0.5 * f64::from(size) / along);
            row - ahead.map_or(DVec3::ZERO, |ahead| row.dot(ahead) * ahead)
        });
        let focal = up(largest_singular_value(across));
        let [front, back] = if reversed { [w - z, z] } else { [z, w - z] };
        let near = match &perspective {
            Some(perspective) => near(perspective, front, back)?,
            None => 0.0,
        };
        let eye = perspective.as_ref().map_or(Vec3::ZERO, |perspective| perspective.eye.as_vec3());
        let is_right = along > 0.0 && (f32::MIN_POSITIVE..f32::INFINITY).contains(&focal) && eye.is_finite();
        is_right.then_some(Self {
            eye,
            focal,
            ahead: ahead.unwrap_or_else(|| into_depth(if reversed { -z } else { z })).as_vec3(),
            pixels,
            near: up(near),
            perspective: if perspective.is_some() { 1.0 } else { 0.0 },
            pixel_count: viewport[0] as f32 * viewport[1] as f32,
            unused: 0.0,
        })
    }
}

/// The direction in which the depth of a parallel projection grows.
fn into_depth(depth: DVec4) -> DVec3 {
    depth.truncate().normalize_or(DVec3::NEG_Z)
}

fn check_view(view_from_cell: &Mat4) -> Result<(), InputError> {
    let matrix = view_from_cell.as_dmat4();
    let axes = DMat3::from_mat4(matrix);
    let lengths = axes.x_axis.length() * axes.y_axis.length() * axes.z_axis.length();
    let is_affine = view_from_cell.row(3) == Vec4::W;
    if view_from_cell.is_finite() && is_affine && axes.determinant().abs() > 1e-9 * lengths {
        return Ok(());
    }
    let bound = "must be finite and invertible, with the last row (0, 0, 0, 1)";
    Err(InputError::new("camera.view_from_cell", view_from_cell, bound))
}

fn refused(clip_from_view: &Mat4) -> InputError {
    let bound = "must be a perspective or parallel projection to depth 0 to 1, whose near plane lies ahead of the eye, \
                 nearer than the far plane, at depth 0, or at 1 if depth is reversed";
    InputError::new("camera.clip_from_view", clip_from_view, bound)
}

/// Eye and viewing direction of a perspective matrix. `Some(None)` for a parallel projection, `None` for any other matrix.
fn perspective([x, y, w]: [DVec4; 3]) -> Option<Option<Perspective>> {
    let ahead = w.truncate();
    let sides = x.truncate().length() * y.truncate().length();
    if ahead == DVec3::ZERO {
        return (w.w > 0.0 && sides.is_finite()).then_some(None);
    }
    let matrix = DMat3::from_cols(x.truncate(), y.truncate(), ahead).transpose();
    // The comparison is false for infinities and NaN.
    let is_picture = matrix.determinant().abs() > 1e-12 * sides * ahead.length();
    let eye = matrix.inverse() * -DVec3::new(x.w, y.w, w.w);
    (is_picture && eye.is_finite()).then(|| Some(Perspective { eye, ahead: ahead.normalize() }))
}

/// Distance from the eye to the near plane; 0 if the plane is not parallel to the picture. `None` if the plane is behind the eye
/// or beyond the far plane.
fn near(perspective: &Perspective, front: DVec4, back: DVec4) -> Option<f64> {
    let Perspective { eye, ahead } = perspective;
    let normal = front.truncate();
    let forward = normal.dot(*ahead);
    if (normal - forward * *ahead).length() > 1e-4 * normal.length() {
        return Some(0.0);
    }
    // The distance at which the view axis meets the plane.
    let depth = |plane: DVec4| -plane.dot(eye.extend(1.0)) / plane.truncate().dot(*ahead);
    let near = depth(front);
    let far = depth(back);
    let is_near = forward > 0.0 && near > 0.0 && near.is_finite();
    (is_near && !(far > 0.0 && far < near)).then_some(near)
}

/// The largest singular value of a matrix of two rows.
fn largest_singular_value([a, b]: [DVec3; 2]) -> f64 {
    let (aa, bb, ab) = (a.length_squared(), b.length_squared(), a.dot(b));
    (0.5 * (aa + bb + (aa - bb).hypot(2.0 * ab))).sqrt()
}

/// The smallest `f32` that is not less than `number`.
fn up(number: f64) -> f32 {
    let rounded = number as f32;
    if f64::from(rounded) < number { rounded.next_up() } else { rounded }
}

/// Whether a matrix to clip space mirrors. If so, a triangle that is counter-clockwise in the source space, seen from outside, is
/// clockwise on the screen. The result is the sign of a determinant. In a parallel view, the third row of the determinant is the
/// depth, so depth must grow with distance.
pub fn is_mirrored(clip: &Mat4) -> bool {
    // Computed in f64, because the product of three small scales may underflow f32.
    let [right, up, depth, ahead] = [0, 1, 2, 3].map(|row| clip.row(row).truncate().as_dvec3());
    let ahead = if ahead == DVec3::ZERO { depth } else { ahead };
    right.cross(up).dot(ahead) > 0.0
}
