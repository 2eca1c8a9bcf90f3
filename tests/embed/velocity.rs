//! Velocities against places of two frames that are projected on the host in f64: of moving characters, placements and
//! cameras, and of still ones.

mod attached;
mod characters;
mod geomorph;
mod ground;

use glam::{DMat4, DVec3, Vec3};
use relievo::asset::material::Alpha;
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, Relief, Scene, View};
use relievo_samples::maps::BuiltInMap;

use crate::frame::device;
use crate::raw::Raw;
use crate::rays::{Triangle, cube, matrix, model, picture, plain, shown};
use crate::world::World;

const SIZE: [u32; 2] = [96, 64];

fn camera() -> Camera {
    Camera::looking_at(Vec3::new(2.0, 3.0, 9.0), Vec3::new(0.0, 0.3, 0.0), 0.7, [0.5, 60.0], SIZE)
}

/// A camera that stands and looks elsewhere.
fn moved() -> Camera {
    Camera::looking_at(Vec3::new(1.7, 3.2, 8.6), Vec3::new(0.2, 0.1, 0.0), 0.72, [0.5, 60.0], SIZE)
}

/// A scene that keeps its last frame, with a view.
fn scene(gpu: &Gpu) -> (Scene, View) {
    let mut scene = Scene::new(gpu).expect("compiled");
    scene.keep_motion_history(true).expect("kept");
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    view.set(camera()).expect("a camera");
    (scene, view)
}

/// A target of velocities, and a renderer for it.
struct Eye {
    raw: Raw,
    renderer: Renderer,
}

impl Eye {
    /// With what the scene needs compiled.
    fn new(gpu: &Gpu, scene: &Scene) -> Self {
        let mut raw = Raw::new(gpu, TargetFormat::velocity(), SIZE);
        raw.clear = relievo::wgpu::Color { r: 7.0, g: 7.0, b: 0.0, a: 0.0 };
        let renderer = raw.renderer(gpu, scene);
        Self { raw, renderer }
    }

    /// Records a frame, draws its velocities, and reads them; 7 where nothing is drawn.
    fn frame(&self, scene: &mut Scene, view: &mut View) -> Vec<[f32; 2]> {
        self.raw.frame(scene, view, &self.renderer, &[Layer::Depth, Layer::Velocity]);
        self.read(scene)
    }

    /// As [`Eye::frame`], of the first of the views that the frame has.
    fn frames(&self, scene: &mut Scene, views: [&mut View; 2]) -> Vec<[f32; 2]> {
        let mut encoder = scene.gpu().encoder("two views");
        let [view, other] = views;
        scene.record(&mut encoder, &mut [&mut *view, other]).expect("recorded");
        self.raw.pass(&mut encoder, |pass| {
            for layer in [Layer::Depth, Layer::Velocity] {
                self.renderer.draw(pass, scene, view, layer).expect("drawn");
            }
        });
        scene.gpu().queue().submit([encoder.finish()]);
        self.read(scene)
    }

    fn read(&self, scene: &Scene) -> Vec<[f32; 2]> {
        self.raw.floats(scene.gpu(), 0).into_iter().map(|[x, y, ..]| [x, y]).collect()
    }
}

/// By how much a velocity may be off: a half float is rounded to a neighbour, of which devices choose one, 2^-10 away at
/// most; and both places are off by some units in 2^-24 of 20 world units, which are nearer than half a picture each.
fn bound(expected: [f64; 2]) -> f64 {
    2e-5 + 0.001 * expected[0].abs().max(expected[1].abs())
}

/// What triangles look like now, and where their points were in the last frame.
struct Scenery {
    now: Vec<Triangle>,
    /// For each triangle the transform from where it is to where it was.
    to_last: Vec<DMat4>,
}

impl Scenery {
    /// Compares velocities with those of traced rays, and returns the number of pixels and the largest velocity.
    fn check(&self, found: &[[f32; 2]], cameras: [&Camera; 2]) -> (usize, f64) {
        let (mut seen, mut largest) = (0, 0.0_f64);
        for (at, pixel) in picture(&self.now, cameras[0]).into_iter().enumerate() {
            let Ok(hit) = pixel else { continue };
            let Some(hit) = hit else {
                assert_eq!(found[at], [7.0; 2], "pixel {at} shows something");
                continue;
            };
            let velocity = |place: DVec3| {
                let last = self.to_last[hit.triangle].transform_point3(place);
                let [now, last] = [shown(cameras[0], place), shown(cameras[1], last)];
                [now[0] - last[0], now[1] - last[1]]
            };
            let expected = velocity(hit.position);
            let off = [0, 1].map(|axis| {
                let slack = hit.slack(|place| velocity(place)[axis]);
                (f64::from(found[at][axis]) - expected[axis]).abs() - slack
            });
            assert!(off[0].max(off[1]) <= bound(expected), "pixel {at}: {:?}, not {expected:?}", found[at]);
            seen += 1;
            largest = largest.max(expected[0].abs().max(expected[1].abs()));
        }
        (seen, largest)
    }

    /// Adds the triangles of a model that a transform places, and another placed in the last frame.
    fn add(&mut self, corners: &[[[f32; 3]; 3]], now: DMat4, last: DMat4) {
        let is_mirrored = now.determinant() < 0.0;
        let tag = self.now.len();
        for (at, corners) in corners.iter().enumerate() {
            let [a, b, c] = corners.map(|corner| now.transform_point3(Vec3::from(corner).as_dvec3()));
            let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
            self.now.push(Triangle { corners, tag: tag + at, double_sided: false });
            self.to_last.push(last * now.inverse());
        }
    }
}

/// Placements of three cubes in two frames: one moves and turns, one grows, and one stands still.
fn steps() -> [[Placement; 3]; 2] {
    let before = [
        Placement::at([-1.7, 0.2, 0.0]).turned(0.4),
        Placement { scale: Vec3::new(-1.0, 1.5, 0.7), ..Placement::at([1.4, 0.0, -1.0]).turned(-0.8) },
        Placement::at([0.3, 0.6, -4.0]).turned(2.0),
    ];
    let after = [
        Placement::at([-1.5, 0.4, 0.2]).turned(0.55),
        Placement { scale: Vec3::new(-1.1, 1.4, 0.8), ..before[1] },
        before[2],
    ];
    [before, after]
}

/// Cubes that move, turn, grow and stand still, in view of a camera that moves too, across the border of a cell; the same
/// once more when all have stopped.
#[test]
fn placements_and_cameras_move() {
    let gpu = device();
    for (border, is_still) in [(0, false), (0, true), (3, false)] {
        let (mut scene, mut view) = scene(&gpu);
        let object =
            scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 3).expect("added");
        let [before, after] = steps();
        // A camera of another cell is at the same place.
        let elsewhere = |camera: Camera| Camera {
            cell: [border, 0, 0],
            view_from_cell: camera.view_from_cell
                * glam::Mat4::from_translation(Vec3::new(border as f32 * Placement::CELL, 0.0, 0.0)),
            ..camera
        };
        let instances = before.map(|placement| scene.spawn(object, placement).expect("room"));
        let eye = Eye::new(&gpu, &scene);
        eye.frame(&mut scene, &mut view);
        let (mut cameras, mut now) = ([camera(), camera()], before);
        if !is_still {
            for (instance, placement) in instances.iter().zip(after) {
                scene.move_to(*instance, placement).expect("there");
            }
            (cameras[0], now) = (moved(), after);
            view.set(elsewhere(moved())).expect("a camera");
        }
        let mut scenery = Scenery { now: Vec::new(), to_last: Vec::new() };
        for (now, before) in now.iter().zip(&before) {
            scenery.add(&cube(), matrix(now), matrix(before));
        }
        let found = eye.frame(&mut scene, &mut view);
        if border == 0 {
            let (seen, largest) = scenery.check(&found, cameras.each_ref());
            println!("{seen} pixels, at most {largest}");
            assert!(seen > 600 && (largest > 0.02) != is_still, "{seen} pixels, {largest}");
            let wrong = [&cameras[0], &cameras[0]];
            let is_wrong = || scenery.check(&found, wrong);
            assert!(is_still || std::panic::catch_unwind(std::panic::AssertUnwindSafe(is_wrong)).is_err());
        } else {
            // Far from the corner of the cell, f32 places are coarser.
            let near = |found: &[f32; 2]| found[0] == 7.0 || found.iter().all(|value| value.abs() < 0.1);
            assert!(found.iter().all(near), "the border of a cell counts as motion");
        }
        // Nothing moves any more.
        let still = eye.frame(&mut scene, &mut view);
        let moves = still.iter().filter(|found| found[0] != 7.0).flatten().any(|value| value.abs() > 2e-6);
        assert!(!moves, "what stands still moves");
    }
}

/// Terrain and reliefs, from the places that the layer of positions has.
#[test]
fn terrain_and_reliefs_move_with_the_camera() {
    let gpu = device();
    let mut world = World::empty(&gpu, 1);
    world.scene.keep_motion_history(true).expect("kept");
    let heights = BuiltInMap::Cobbles.height_map(64).expect("a map");
    let albedo = BuiltInMap::Cobbles.albedo(64).expect("colours");
    let mut relief = Relief::wall(2.0, heights, albedo);
    relief.material.scale = 0.2;
    let wall = world.scene.add_relief(&relief, 1).expect("added");
    let before = Placement::at([-1.0, 4.0, -4.0]).turned(0.4).scaled(7.0);
    let after = Placement::at([-0.6, 4.1, -3.7]).turned(0.6).scaled(7.3);
    let instance = world.scene.spawn(wall, before).expect("room");
    let seen_from = |x: f32| {
        Camera::looking_at(Vec3::new(x, 12.0, 16.0), Vec3::new(0.0, 2.0, -6.0), 0.9, [0.5, 400.0], SIZE)
    };
    let mut view = world.scene.view(Quality::pixels(0.0)).expect("a view");
    view.set(seen_from(3.0)).expect("a camera");
    let eye = Eye::new(&gpu, &world.scene);
    eye.frame(&mut world.scene, &mut view);
    world.scene.move_to(instance, after).expect("there");
    view.set(seen_from(3.4)).expect("a camera");
    let found = eye.frame(&mut world.scene, &mut view);
    let measure = Raw::new(&gpu, TargetFormat::measure(), SIZE);
    let renderer = measure.renderer(&gpu, &world.scene);
    measure.frame(&mut world.scene, &mut view, &renderer, &[Layer::Depth, Layer::Measure]);
    let (positions, ids) = (measure.floats(&gpu, 0), measure.words(&gpu, 1));
    let to_last = matrix(&before) * matrix(&after).inverse();
    let (mut seen, mut worst, mut largest) = ([0; 2], 0.0_f64, 0.0_f64);
    for (at, id) in ids.iter().enumerate().filter(|(_, id)| id[0] != 0) {
        let [x, y, z, _] = positions[at].map(f64::from);
        let now = DVec3::new(x, y, z);
        let is_wall = id[0] == wall.number();
        let last = if is_wall { to_last.transform_point3(now) } else { now };
        let [now, last] = [shown(&seen_from(3.4), now), shown(&seen_from(3.0), last)];
        let expected = [now[0] - last[0], now[1] - last[1]];
        let off = [0, 1].map(|axis| (f64::from(found[at][axis]) - expected[axis]).abs());
        worst = worst.max(off[0].max(off[1]) / bound(expected));
        seen[usize::from(is_wall)] += 1;
        largest = largest.max(expected[0].abs());
    }
    println!("{seen:?} pixels, {worst} of the bound");
    assert!(
        seen[0] > 1000 && seen[1] > 150 && worst <= 1.0 && largest > 0.005,
        "{seen:?} pixels, {worst} of the bound"
    );
}

/// A scene that does not keep its last frame has no velocities.
#[test]
fn velocities_need_the_last_frame() {
    let gpu = device();
    let (mut scene, mut view) = scene(&gpu);
    scene.keep_motion_history(false).expect("not kept");
    scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 1).expect("added");
    let raw = Raw::new(&gpu, TargetFormat::velocity(), SIZE);
    let renderer = raw.renderer(&gpu, &scene);
    let mut encoder = gpu.encoder("refused");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    let mut refused = None;
    raw.pass(&mut encoder, |pass| {
        refused = renderer.draw(pass, &scene, &view, Layer::Velocity).err();
    });
    let refused = refused.expect("refused");
    assert!(refused.path == "scene" && refused.bound.contains("keep_motion_history"), "{refused}");
    gpu.queue().submit([encoder.finish()]);
}
