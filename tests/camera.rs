//! Properties of cameras, against projections in `f64`.

use glam::camera::rh::{proj::directx, view::look_at_mat4};
use glam::{DMat4, DVec2, DVec3, DVec4, Mat4, Vec3, Vec4};
use relievo::ops::lod::{Depth, LodCamera, is_mirrored, planes};
use relievo_lab::cases::animation::Draw;
use relievo_lab::cases::lod::{look, parallel, perspective};

/// The caller's matrices.
#[derive(Debug, Clone, Copy)]
struct Matrices {
    view: Mat4,
    clip: Mat4,
    viewport: [u32; 2],
    reversed: bool,
}

impl Matrices {
    fn camera(&self, pixels: f32) -> LodCamera {
        LodCamera::new(self.view, self.clip, self.viewport, depth_of(self.reversed), pixels).expect("valid")
    }

    fn clip_from_cell(&self) -> DMat4 {
        self.clip.as_dmat4() * self.view.as_dmat4()
    }

    /// Where a point is drawn, in pixels; `None` behind the eye.
    fn pixel(&self, point: DVec3) -> Option<DVec2> {
        let clip = self.clip_from_cell() * point.extend(1.0);
        let [width, height] = self.viewport.map(|size| 0.5 * f64::from(size));
        (clip.w > 0.0).then(|| DVec2::new(width * clip.x, height * clip.y) / clip.w)
    }
}

fn depth_of(reversed: bool) -> Depth {
    if reversed { Depth::Reversed } else { Depth::Forward }
}

/// The kinds of random matrices.
const KINDS: u32 = 8;

fn random_matrices(draw: &mut Draw, kind: u32) -> Matrices {
    let eye = Vec3::from([0; 3].map(|_| 128.0 + 128.0 * draw.signed()));
    let turn = glam::Quat::from_array(draw.rotation()).normalize();
    let view = look(eye, turn * Vec3::NEG_Z);
    let (half_field, near) = (0.1 + 0.9 * draw.signed().abs(), 0.05 + draw.signed().abs());
    let viewport = [100 + draw.word() % 1900, 100 + draw.word() % 1000];
    let aspect = viewport[0] as f32 / viewport[1] as f32;
    let plain = |reversed, off| perspective(half_field, aspect, near, reversed, off);
    let (view, clip, reversed) = match kind {
        0 => (view, plain(false, 0.0), false),
        1 => (view, plain(true, 0.0), true),
        2 => (view, plain(true, draw.signed()), true),
        // Jitter is added after the projection.
        3 => (view, Mat4::from_translation(Vec3::new(1e-3, -5e-4, 0.0)) * plain(false, 0.0), false),
        // Pixels that are not square.
        4 => (view, perspective(half_field, 0.3 * aspect, near, false, 0.0), false),
        // A mirrored view, as in water, and a view in other units.
        5 => (Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * view, plain(true, 0.0), true),
        6 => (
            Mat4::from_scale(Vec3::splat(0.01)) * view,
            perspective(half_field, aspect, 0.01 * near, false, 0.0),
            false,
        ),
        _ => (view, parallel(40.0, 300.0) * Mat4::from_scale(Vec3::new(1.0 / aspect, 1.0, 1.0)), false),
    };
    Matrices { view, clip, viewport, reversed }
}

fn random_unit(draw: &mut Draw) -> DVec3 {
    glam::Quat::from_array(draw.rotation()).normalize().as_dquat() * DVec3::X
}

/// The largest displacement on screen, as a fraction of `pixels`, of points of a sphere that move by `way`.
fn largest_displacement(matrices: &Matrices, draw: &mut Draw, center: Vec3, radius: f32, way: f32) -> f64 {
    let mut largest = 0.0_f64;
    for _ in 0..400 {
        let inside = f64::from(radius) * random_unit(draw);
        let point = center.as_dvec3() + inside;
        let moved = point + f64::from(way) * random_unit(draw);
        let (Some(from), Some(to)) = (matrices.pixel(point), matrices.pixel(moved)) else {
            return f64::INFINITY;
        };
        largest = largest.max(from.distance(to));
    }
    largest
}

/// Points of random spheres move by what is allowed: none moves further than `pixels` on screen, and some of a small
/// sphere nearly so far.
#[test]
fn what_is_allowed_stays_within_the_pixels() {
    let mut draw = Draw::new(0xca3e);
    let mut allowed_some = [0; KINDS as usize];
    for round in 0..60 {
        let kind = round % KINDS;
        let matrices = random_matrices(&mut draw, kind);
        let pixels = [0.5, 1.0, 4.0][round as usize % 3];
        let camera = matrices.camera(pixels);
        for _ in 0..20 {
            let distance = 0.5 * libm::exp2f(4.0 + 4.0 * draw.signed());
            // Spheres inside the picture and a little beside it.
            let [x, y] = [0; 2].map(|_| 1.2 * f64::from(draw.signed()));
            let through = matrices.clip_from_cell().inverse() * DVec4::new(x, y, 0.5, 1.0);
            let through = (through.truncate() / through.w).as_vec3();
            let center = match camera.perspective {
                0.0 => through,
                _ => camera.eye + distance * (through - camera.eye).normalize(),
            };
            let radius = distance * libm::exp2f(-6.0 + 4.0 * draw.signed());
            let allowed = camera.allows(center, radius);
            assert!(allowed >= 0.0 && allowed.is_finite());
            if allowed == 0.0 {
                continue;
            }
            allowed_some[kind as usize] += 1;
            let most =
                largest_displacement(&matrices, &mut draw, center, radius, allowed) / f64::from(pixels);
            assert!(most <= 1.0, "{most} of the pixels: {matrices:?} {center} {radius}");
            // Square pixels near the picture, a sphere that is small beside its distance.
            let least = if kind == 4 { 0.15 } else { 0.6 };
            assert!(most > least || radius > 0.05 * distance, "only {most}: {matrices:?} {center} {radius}");
        }
    }
    assert!(allowed_some.iter().all(|some| *some > 50), "{allowed_some:?}");
}

/// Straight ahead a small sphere may be off by all that a pixel takes.
#[test]
fn a_point_ahead_uses_its_pixels() {
    let mut draw = Draw::new(0xca3f);
    for kind in (0..KINDS).filter(|kind| *kind != 4) {
        let matrices = random_matrices(&mut draw, kind);
        let camera = matrices.camera(1.0);
        let ahead =
            if camera.perspective == 0.0 { DVec3::ZERO.as_vec3() } else { camera.eye + 50.0 * camera.ahead };
        let allowed = camera.allows(ahead, 1e-3);
        let most = largest_displacement(&matrices, &mut draw, ahead, 1e-3, allowed);
        assert!((0.97..=1.0).contains(&most), "{kind}: {most}");
    }
}

#[test]
fn spheres_at_the_near_plane_and_behind() {
    let matrices = Matrices {
        view: look(Vec3::new(3.0, 2.0, 1.0), Vec3::X),
        clip: perspective(0.5, 1.0, 0.5, true, 0.0),
        viewport: [500, 500],
        reversed: true,
    };
    let camera = matrices.camera(1.0);
    assert!((camera.near - 0.5).abs() < 1e-6 && camera.eye.distance(Vec3::new(3.0, 2.0, 1.0)) < 1e-5);
    let allows =
        |ahead: f32, aside: f32, radius| camera.allows(Vec3::new(3.0 + ahead, 2.0 + aside, 1.0), radius);
    assert!(allows(1.6, 0.0, 1.0) > 0.0 && allows(1.5, 0.0, 1.0) == 0.0, "reaches the near plane");
    // A pixel takes 1/458 at a distance of 1; the point must not come nearer than the near plane by moving.
    assert_eq!(allows(0.501, 0.0, 0.0), 0.0);
    assert!(allows(0.51, 0.0, 0.0) > 0.0);
    assert_eq!(allows(0.0, 5.0, 1.0), 0.0, "beside the eye");
    assert_eq!(allows(-1.0, 0.0, 2.0), 0.0, "around the eye");
    // Behind counts as ahead, in any direction.
    for (ahead, aside) in [(-10.0, 0.0), (-6.0, 8.0), (-8.0, -6.0)] {
        assert!((allows(ahead, aside, 1.0) / allows(10.0, 0.0, 1e-6 + 1.0) - 1.0).abs() < 0.02);
    }
    assert_eq!(matrices.camera(0.0).allows(Vec3::new(13.0, 2.0, 1.0), 1.0), 0.0);
}

#[test]
fn near_planes_are_those_of_the_matrices() {
    let view = look(Vec3::new(7.0, 8.0, 9.0), Vec3::new(1.0, 1.0, -0.3));
    let near = |clip, reversed| {
        LodCamera::new(view, clip, [300, 200], depth_of(reversed), 1.0).map(|camera| camera.near)
    };
    for reversed in [false, true] {
        let found = near(perspective(0.5, 1.5, 0.25, reversed, 0.1), reversed).expect("valid");
        assert!((found - 0.25).abs() < 1e-5, "{found}");
    }
    // Infinite with forward depth, and oblique.
    let infinite = Mat4::from_cols_array_2d(&[
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, -1.0, -1.0],
        [0.0, 0.0, -0.25, 0.0],
    ]);
    assert!((near(infinite, false).expect("valid") - 0.25).abs() < 1e-5);
    let mut oblique = infinite;
    oblique.y_axis.z = 0.4;
    assert_eq!(near(oblique, false), Ok(0.0));
    // The other way round there is no near plane, or it is the far one.
    let refused = |clip, reversed| near(clip, reversed).expect_err("refused").path;
    assert_eq!(refused(infinite, true), "camera.clip_from_view");
    assert_eq!(refused(perspective(0.5, 1.5, 0.25, true, 0.0), false), "camera.clip_from_view");
    assert_eq!(refused(perspective(0.5, 1.5, 0.25, false, 0.0), true), "camera.clip_from_view");
}

#[test]
fn what_is_wrong_is_named() {
    let (view, clip) = (look(Vec3::ONE, Vec3::X), perspective(0.5, 1.0, 0.1, false, 0.0));
    let path = |view, clip, viewport, pixels| {
        LodCamera::new(view, clip, viewport, Depth::Forward, pixels).expect_err("refused").path
    };
    let size = [64, 64];
    assert_eq!(path(Mat4::NAN, clip, size, 1.0), "camera.view_from_cell");
    assert_eq!(path(clip, clip, size, 1.0), "camera.view_from_cell");
    assert_eq!(path(Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0)), clip, size, 1.0), "camera.view_from_cell");
    assert_eq!(path(view, Mat4::NAN, size, 1.0), "camera.clip_from_view");
    assert_eq!(path(view, Mat4::ZERO, size, 1.0), "camera.clip_from_view");
    assert_eq!(
        path(view, Mat4::from_scale(Vec3::new(1.0, 0.0, 1.0)) * clip, size, 1.0),
        "camera.clip_from_view"
    );
    assert_eq!(path(view, -clip, size, 1.0), "camera.clip_from_view");
    assert_eq!(path(view, Mat4::from_scale(Vec3::new(0.0, 0.0, 1.0)), size, 1.0), "camera.clip_from_view");
    assert_eq!(path(view, clip, [64, 0], 1.0), "camera.viewport");
    for pixels in [-1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(path(view, clip, size, pixels), "quality.pixels");
    }
}

/// A point is inside all planes if it is inside clip space, unless it lies where rounding decides, or beyond a plane that
/// excludes nothing.
#[test]
fn planes_hold_what_clip_space_holds() {
    let mut draw = Draw::new(0xca40);
    let mut outside = 0;
    for round in 0..200 {
        let matrices = random_matrices(&mut draw, round % KINDS);
        let planes = planes(matrices.clip * matrices.view);
        assert!(
            planes.iter().all(|plane| (plane.truncate().length() - 1.0).abs() < 1e-5 || *plane == Vec4::W)
        );
        for _ in 0..50 {
            let [x, y, z] = [0; 3].map(|_| 1.5 * f64::from(draw.signed()));
            let point = matrices.clip_from_cell().inverse() * DVec4::new(x, y, 0.5 + 0.5 * z, 1.0);
            let point = point.truncate() / point.w;
            let clip = matrices.clip_from_cell() * point.extend(1.0);
            let distance = planes
                .iter()
                .map(|plane| plane.as_dvec4().dot(point.extend(1.0)))
                .fold(f64::INFINITY, f64::min);
            let sides = [clip.w - clip.x.abs(), clip.w - clip.y.abs(), clip.z, clip.w - clip.z];
            let is_inside = sides.iter().all(|side| *side >= 0.0);
            if distance.abs() > 1e-3 * (1.0 + point.length()) {
                assert!(!is_inside || distance > 0.0, "{point} is cut off: {matrices:?}");
                // Between the sides, where only a far plane that is lost could hold it.
                let is_beside = sides[0].min(sides[1]) < -0.01 * clip.w.abs();
                assert!(!is_beside || distance < 0.0, "{point} is let in: {matrices:?}");
                outside += u32::from(is_beside);
            }
        }
    }
    assert!(outside > 1000, "{outside}");
}

#[test]
fn planes_without_a_direction_exclude_nothing() {
    let view = look(Vec3::new(100.0, 200.0, 50.0), Vec3::new(0.3, 0.2, -1.0));
    let lost = |clip: Mat4| planes(clip * view).map(|plane| plane == Vec4::W);
    let far = |near: f32, far: f32| {
        let mut clip = perspective(0.5, 1.0, near, false, 0.0);
        (clip.z_axis.z, clip.w_axis.z) = (far / (near - far), near * far / (near - far));
        clip
    };
    assert_eq!(lost(far(0.1, 100.0)), [false; 6]);
    assert_eq!(lost(far(0.1, 1e7)), [false, false, false, false, false, true]);
    assert_eq!(lost(perspective(0.5, 1.0, 0.1, true, 0.0)), [false, false, false, false, true, false]);
    assert_eq!(lost(parallel(10.0, 1e5)), [false; 6]);
    assert_eq!(planes(Mat4::NAN), [Vec4::W; 6]);
}

#[test]
fn mirror_images_are_told_from_pictures() {
    let look = look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::new(0.0, 1.0, -2.0), Vec3::Y);
    for projection in [
        directx::perspective(0.8, 1.5, 0.1, 90.0),
        directx::perspective_infinite_reverse(0.8, 1.5, 0.1),
        directx::frustum(0.3, 0.9, -0.2, 0.1, 0.5, 40.0),
        directx::orthographic(-3.0, 2.0, -1.0, 4.0, -10.0, 50.0),
    ] {
        for turn in
            [Mat4::IDENTITY, Mat4::from_rotation_x(2.0), Mat4::from_scale(Vec3::new(-1e-13, -1e-13, 2e-13))]
        {
            assert!(!is_mirrored(&(projection * look * turn)), "{projection} {turn}");
            let mirror = Mat4::from_scale(Vec3::new(1.0, 1.0, -3.0));
            assert!(is_mirrored(&(projection * look * turn * mirror)), "{projection} {turn}");
            assert!(is_mirrored(&(Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * projection * look * turn)));
        }
    }
}
