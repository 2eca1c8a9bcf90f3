//! Placement of the sun's shadow map. The map covers a sphere that contains everything the cameras show. It moves only by whole
//! texels of a grid that is fixed in the world. `docs/shadows.md` explains the choice.

use glam::{DMat3, DMat4, DVec3, DVec4, Mat4, Vec3, Vec4};

use crate::InputError;
use crate::scene::{Camera, Depth, Placement};

/// The largest distance of a caster from the map's center towards the light, in map radii.
const REACH: f64 = 7.0;

/// Fraction of the map's radius that is reserved for the fade of shadows (`SHADOW_FADE` of
/// `wgsl/render/scene_shadow.wgsl`). It includes a margin of some texels.
const FADE: f64 = 0.07;

/// Number of permitted map radii per octave. The radius is rounded up to one of them, so that it stays constant under small
/// changes of the projection, such as jitter.
const STEPS: f64 = 8.0;

/// Iterations of the search for the center of a sphere.
const HALVINGS: usize = 48;

/// The eight corners of a camera's view volume up to a distance.
#[derive(Debug, Clone)]
pub(super) struct Frustum {
    /// Four corners on the near plane, then four at the far end, in camera space. In this space, the corners do not depend on
    /// the camera's position, not even in the last bit.
    corners: [[DVec3; 4]; 2],
    /// Transform from camera space to the world.
    world_from_view: DMat4,
}

impl Frustum {
    /// The view volume up to `range` units ahead of the camera, or up to the far plane if that is nearer.
    ///
    /// # Errors
    /// [`InputError`] for a range that ends before the near plane.
    pub fn new(camera: &Camera, range: f64) -> Result<Self, InputError> {
        let view_from_clip = camera.clip_from_view.as_dmat4().inverse();
        let place = |x: f64, y: f64, depth: f64| {
            let point = view_from_clip * DVec4::new(x, y, depth, 1.0);
            point.truncate() / point.w
        };
        let [near, far] = if camera.depth == Depth::Reversed { [1.0, 0.0] } else { [0.0, 1.0] };
        let ahead = (place(0.0, 0.0, 0.5) - place(0.0, 0.0, near)).normalize_or(DVec3::NEG_Z);
        // The viewing direction is the normal of the near plane, also for off-axis cameras.
        let plane = (place(1.0, 0.0, near) - place(0.0, 0.0, near))
            .cross(place(0.0, 1.0, near) - place(0.0, 0.0, near))
            .normalize_or(ahead);
        let plane = if plane.dot(ahead) < 0.0 { -plane } else { plane };
        let begin = plane.dot(place(0.0, 0.0, near));
        if range <= begin {
            // The message shows f32, because the caller passed f32.
            let bound = format!("must be beyond the near plane, {} units ahead of the camera", begin as f32);
            return Err(InputError::new("range", range as f32, bound));
        }
        // For an infinite far plane, `end` is infinite or NaN.
        let end = plane.dot(place(0.0, 0.0, far));
        let end = if end > begin { end.min(range) } else { range };
        let near = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].map(|[x, y]| {
            let from = place(x, y, near);
            let along = place(x, y, 0.5) - from;
            [from, from + along * ((end - begin) / plane.dot(along))]
        });
        let corners = [near.map(|[near, _]| near), near.map(|[_, far]| far)];
        let cell = Placement::corner(camera.cell);
        let world_from_view = DMat4::from_translation(cell) * camera.view_from_cell.as_dmat4().inverse();
        Ok(Self { corners, world_from_view })
    }
}

/// The sun's camera and its texel size.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub camera: Camera,
    pub texel: f32,
}

impl Fit {
    /// Fits a map of `size` × `size` texels around one or more view volumes, for a light from `direction`.
    pub fn new(frusta: &[Frustum], direction: Vec3, size: u32) -> Self {
        let (middle, radius) = sphere(frusta);
        let steps = (STEPS * libm::log2(radius / (1.0 - FADE))).ceil() / STEPS;
        let radius = libm::exp2(steps);
        let texel = 2.0 * radius / f64::from(size);
        let axes = axes(direction);
        let snapped = (axes.transpose() * middle / texel).round() * texel;
        Self { camera: camera(axes, snapped, radius, size), texel: texel as f32 }
    }
}

/// The sun's camera, with the map centered at `middle`. `middle` is in the coordinates of `axes`.
fn camera(axes: DMat3, middle: DVec3, radius: f64, size: u32) -> Camera {
    let edge = f64::from(Placement::CELL);
    let cell = (axes * middle / edge).floor();
    // The eye lies at the largest distance of a caster.
    let eye = middle + DVec3::Z * (REACH * radius) - axes.transpose() * (cell * edge);
    let view = DMat4::from_translation(-eye) * DMat4::from_mat3(axes.transpose());
    let far = (REACH + 1.0) * radius;
    let clip_from_view = Mat4::from_cols(
        Vec4::new((1.0 / radius) as f32, 0.0, 0.0, 0.0),
        Vec4::new(0.0, (1.0 / radius) as f32, 0.0, 0.0),
        Vec4::new(0.0, 0.0, (-1.0 / far) as f32, 0.0),
        Vec4::W,
    );
    Camera {
        // The casts saturate.
        cell: cell.to_array().map(|axis| axis as i32),
        view_from_cell: view.as_mat4(),
        clip_from_view,
        viewport: [size; 2],
        depth: Depth::Forward,
    }
}

/// The map's axes in the world: to the right, up, and towards the light.
fn axes(direction: Vec3) -> DMat3 {
    let towards = direction.as_dvec3().normalize_or(DVec3::Y);
    let helper = if towards.y.abs() > 0.99 { DVec3::Z } else { DVec3::Y };
    let right = helper.cross(towards).normalize_or(DVec3::X);
    DMat3::from_cols(right, towards.cross(right), towards)
}

/// A sphere around all corners: its center in the world, and its radius. The center lies on the line from the mean of the near
/// corners to the mean of the far corners, at the point with the smallest radius.
fn sphere(frusta: &[Frustum]) -> (DVec3, f64) {
    let first = frusta[0].world_from_view;
    let view_from_world = first.inverse();
    let of = |frustum: &Frustum, end: usize| {
        let is_first = frustum.world_from_view == first;
        let into = if is_first { DMat4::IDENTITY } else { view_from_world * frustum.world_from_view };
        frustum.corners[end].map(|corner| into.transform_point3(corner))
    };
    let [near, far] =
        [0, 1].map(|end| frusta.iter().flat_map(|frustum| of(frustum, end)).collect::<Vec<_>>());
    let middle_of = |corners: &[DVec3]| corners.iter().sum::<DVec3>() / corners.len() as f64;
    let [from, to] = [middle_of(&near), middle_of(&far)];
    let radius = |part: f64| {
        let middle = from.lerp(to, part);
        let farthest = near.iter().chain(&far).map(|corner| corner.distance_squared(middle));
        farthest.fold(0.0, f64::max).sqrt()
    };
    // The radius is a convex function of the position on this line.
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..HALVINGS {
        let [a, b] = [1.0 / 3.0, 2.0 / 3.0].map(|part| low + part * (high - low));
        if radius(a) <= radius(b) { high = b } else { low = a }
    }
    let part = 0.5 * (low + high);
    (first.transform_point3(from.lerp(to, part)), radius(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: Vec3 = Vec3::new(-0.4, 0.8, 0.6);

    fn eye(at: Vec3, look: Vec3) -> Camera {
        Camera::looking_at(at, look, 0.8, [0.1, f32::INFINITY], [320, 180])
    }

    fn fitted(cameras: &[Camera], range: f64) -> Fit {
        let frusta: Vec<Frustum> =
            cameras.iter().map(|camera| Frustum::new(camera, range).expect("beyond")).collect();
        Fit::new(&frusta, SUN, 512)
    }

    /// The position of a world point in the map, in texels.
    fn texels(fit: &Fit, place: DVec3) -> DVec3 {
        let cell = Placement::corner(fit.camera.cell);
        let clip = fit.camera.clip_from_view.as_dmat4() * fit.camera.view_from_cell.as_dmat4();
        clip.transform_point3(place - cell) * DVec3::new(256.0, 256.0, 1.0)
    }

    #[test]
    fn all_that_cameras_show_is_in_the_map_and_does_not_fade() {
        let cameras = [
            eye(Vec3::new(3.0, 4.0, 5.0), Vec3::new(9.0, 2.0, -7.0)),
            eye(Vec3::new(-30.0, 14.0, 5.0), Vec3::new(-20.0, 2.0, 6.0)).reversed(),
            Camera::looking_at(Vec3::Y, Vec3::ZERO, 1.5, [1.0, 30.0], [100, 300]),
        ];
        for shown in [&cameras[..1], &cameras[1..2], &cameras[2..], &cameras] {
            let fit = fitted(shown, 40.0);
            for camera in shown {
                for [x, y, ahead] in
                    [[-0.99, 0.99, 39.9], [0.99, 0.99, 20.0], [0.0, 0.0, 1.1], [0.9, -0.99, 29.0]]
                {
                    let [right, up] = [0, 1].map(|at| 1.0 / f64::from(camera.clip_from_view.col(at)[at]));
                    let seen = DVec3::new(x * right * ahead, y * up * ahead, -ahead);
                    let place = camera.view_from_cell.as_dmat4().inverse().transform_point3(seen);
                    let at = texels(&fit, place);
                    let most = 256.0 * 0.95;
                    let is_far = ahead > 30.0 && shown.len() == 1 && camera.viewport == [100, 300];
                    let is_in = at.x.abs() < most && at.y.abs() < most && (0.0..1.0).contains(&at.z);
                    assert!(is_in || is_far, "{at}: {x} {y} {ahead} of {}", shown.len());
                }
            }
        }
    }

    /// World points keep their sub-texel position while the camera turns and moves, near the origin and far from it.
    #[test]
    fn the_map_moves_by_whole_texels() {
        for far in [0, 3906] {
            let moved = |camera: Camera| Camera { cell: [far, 0, -far], ..camera };
            let corner = f64::from(far) * f64::from(Placement::CELL);
            let place = DVec3::new(corner + 7.25, 3.0, 1.5 - corner);
            let first = fitted(&[moved(eye(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO))], 40.0);
            let before = texels(&first, place);
            let mut steps = 0;
            for at in 1..60 {
                let t = at as f32;
                let from = Vec3::new(3.0 + 0.37 * t, 4.0 + 0.01 * t, 5.0 - 0.21 * t);
                let to = from + Vec3::new((0.1 * t).sin(), -0.1, (0.1 * t).cos());
                let fit = fitted(&[moved(eye(from, to))], 40.0);
                assert_eq!(fit.texel.to_bits(), first.texel.to_bits());
                let by = texels(&fit, place) - before;
                // The bound allows for the rounding of f32 matrices at coordinates of a few hundred units.
                let off = (by - by.round()).truncate().abs().max_element();
                assert!(off < 0.01, "{off} texels after {at} steps, {far} cells away");
                steps += usize::from(by.truncate().abs().max_element() > 0.5);
            }
            assert!(steps > 40, "the map moves with the eye: {steps}");
        }
    }

    #[test]
    fn halves_of_a_picture_have_the_map_of_the_whole() {
        let whole = eye(Vec3::new(3.0, 4.0, 5.0), Vec3::ZERO);
        let half = |side: f32| {
            let cut = Mat4::from_cols(
                Vec4::new(2.0, 0.0, 0.0, 0.0),
                Vec4::Y,
                Vec4::Z,
                Vec4::new(side, 0.0, 0.0, 1.0),
            );
            Camera { clip_from_view: cut * whole.clip_from_view, viewport: [160, 180], ..whole }
        };
        let [one, two] = [fitted(&[whole], 40.0), fitted(&[half(1.0), half(-1.0)], 40.0)];
        assert_eq!(one.camera, two.camera);
    }

    #[test]
    fn ranges_end_beyond_the_near_plane() {
        let refused =
            |range| Frustum::new(&eye(Vec3::Y, Vec3::ZERO), range).map(|_| ()).expect_err("refused").path;
        assert_eq!((refused(0.1), refused(0.05)), ("range".to_owned(), "range".to_owned()));
    }
}
