//! Endless terrain: what is drawn lies where the finest heights are, everywhere and at all times, and nothing is missing.

use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region as heights;
use relievo::ops::terrain::window::Region;
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::{
    Camera, EndlessLimits, ObjectId, Placement, Quality, Ray, SampleMask, Scene, TerrainConfig, TerrainHole,
    TerrainSource, View,
};

use crate::harness::{Difference, gpu, is_coarse};
use crate::raw::Raw;

/// Ground that rises and falls by some hundred units over some kilometres.
pub fn config() -> TerrainConfig {
    TerrainConfig {
        coarse_levels: 6,
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(65, 300.0, "endless").expect("valid")
    }
}

/// Limits for small pictures: larger nodes would be finer than their pixels.
pub fn small_nodes() -> EndlessLimits {
    EndlessLimits { nodes_per_frame: 128, node_size: 33, ..EndlessLimits::default() }
}

/// A scene of endless terrain, and the means to look at it.
pub struct World {
    pub gpu: Gpu,
    pub scene: Scene,
    pub land: ObjectId,
    pub view: View,
    raw: Raw,
    measure: Renderer,
}

impl World {
    fn new(config: TerrainConfig, limits: EndlessLimits, size: [u32; 2]) -> Self {
        Self::of(&TerrainSource::endless(config).with_limits(limits), size)
    }

    pub fn of(source: &TerrainSource, size: [u32; 2]) -> Self {
        Self::on(gpu(), source, size)
    }

    fn on(gpu: Gpu, source: &TerrainSource, size: [u32; 2]) -> Self {
        let mut scene = Scene::new(&gpu).expect("made");
        let land = scene.add_terrain(source).expect("added");
        let view = scene.view(Quality::pixels(1.0)).expect("made");
        let raw = Raw::new(&gpu, TargetFormat::measure(), size);
        let measure = raw.renderer(&gpu, &scene);
        Self { gpu, scene, land, view, raw, measure }
    }

    /// The same with another number of pixels by which the view allows the ground to be off. It is 1 at first.
    pub fn within(mut self, pixels: f32) -> Self {
        self.view.set_quality(Quality::pixels(pixels)).expect("valid");
        self
    }

    /// A camera above the ground that looks to the north, and a little down.
    pub fn above(&self, at: [f64; 2], height: f64) -> Camera {
        let ground = self.scene.ground(self.land, at[0], at[1]).expect("valid").expect("ground").height;
        let eye = [at[0], ground + height, at[1]];
        let target = [at[0] + 0.2, eye[1] - 0.25, at[1] - 1.0];
        Camera::looking_at_world(eye, target, 0.9, [0.5, 12_000.0], self.raw.size)
    }

    /// Records a frame, and waits for it.
    pub fn frame(&mut self) {
        let Self { gpu, scene, view, .. } = self;
        gpu.try_run("frame", |encoder| scene.record(encoder, &mut [view])).expect("recorded");
    }

    /// Records frames until all detail is there. Returns their number.
    pub fn settle(&mut self) -> usize {
        for frame in 1..600 {
            self.frame();
            let statistics = self.scene.terrain_statistics(self.land).expect("endless");
            if statistics.ready == 1.0 {
                return frame;
            }
        }
        panic!("{:?}", self.scene.terrain_statistics(self.land));
    }

    /// The world positions that the pixels show; `None` where the sky is.
    pub fn positions(&mut self, camera: &Camera) -> Vec<Option<DVec3>> {
        let Self { gpu, scene, view, raw, measure, .. } = self;
        raw.frame(scene, view, measure, &[Layer::Measure]);
        read_positions(raw, gpu, camera)
    }
}

/// The corner of a camera's cell in the world.
fn corner(camera: &Camera) -> DVec3 {
    Placement { cell: camera.cell, ..Placement::default() }.world()
}

/// The world positions in a target of measures; `None` where the sky is.
fn read_positions(raw: &Raw, gpu: &Gpu, camera: &Camera) -> Vec<Option<DVec3>> {
    let corner = corner(camera);
    let place = |texel: [f32; 4]| {
        let [x, y, z, w] = texel.map(f64::from);
        (w == 1.0).then(|| corner + DVec3::new(x, y, z))
    };
    raw.floats(gpu, 0).into_iter().map(place).collect()
}

/// The height of the finest triangles at a world position, computed from the definition alone.
fn truth(config: &TerrainConfig, x: f64, z: f64) -> f64 {
    between(config, [x, z], |region| heights(config, &Features::default(), region))
}

/// The height of the triangles at a world position whose corners are the heights of a region of 2 × 2 samples.
pub fn between(config: &TerrainConfig, [x, z]: [f64; 2], heights: impl Fn(Region) -> Vec<i32>) -> f64 {
    let [u, v] = [x, z].map(|at| at / config.terrain_scale);
    let first = [u, v].map(|at| at.floor() as i64);
    let heights = heights(Region { first, width: 2, coarser: 0 });
    let [a, b, c, d] = [0, 1, 2, 3].map(|at| f64::from(heights[at]) / 65_536.0);
    let [u, v] = [u - u.floor(), v - v.floor()];
    // The diagonal runs from south-west to north-east.
    if u + v <= 1.0 { a + (b - a) * u + (c - a) * v } else { d + (c - d) * (1.0 - u) + (b - d) * (1.0 - v) }
}

/// Where a camera draws a world position, in pixels.
fn pixel(camera: &Camera, at: DVec3) -> DVec2 {
    let corner = corner(camera);
    let clip = DMat4::from_cols_array(&camera.clip_from_view.to_cols_array().map(f64::from))
        * DMat4::from_cols_array(&camera.view_from_cell.to_cols_array().map(f64::from));
    let point = clip * (at - corner).extend(1.0);
    let size = DVec2::new(f64::from(camera.viewport[0]), f64::from(camera.viewport[1]));
    0.5 * size * DVec2::new(point.x, point.y) / point.w
}

/// How far the surface at positions that are drawn lies from the truth: the offset of each in pixels.
pub fn offsets(
    truth: &(impl Fn(f64, f64) -> f64 + Sync),
    camera: &Camera,
    drawn: &[Option<DVec3>],
) -> Vec<Option<DVec2>> {
    let offset = |at: &Option<DVec3>| {
        let at = (*at)?;
        let exact = DVec3::new(at.x, truth(at.x, at.z), at.z);
        Some(pixel(camera, at) - pixel(camera, exact))
    };
    drawn.par_iter().map(offset).collect()
}

/// The largest offset. Rounded coarsely, a triangle that is seen edge-on covers pixels beside it, and its surface there is far away:
/// that may befall one point in a thousand.
pub fn largest(offsets: &[Option<DVec2>]) -> f64 {
    let mut lengths: Vec<f64> = offsets.iter().flatten().map(|offset| offset.length()).collect();
    lengths.sort_unstable_by(|a, b| b.total_cmp(a));
    let spared = if is_coarse() { lengths.len() / 1000 } else { 0 };
    lengths.get(spared).copied().unwrap_or(0.0)
}

/// Rounding of drawn positions, in pixels.
pub const ROUNDING: f64 = 0.01;

/// Every `step`-th of the positions; the others are left out.
pub fn some(drawn: &[Option<DVec3>], step: usize) -> Vec<Option<DVec3>> {
    drawn.iter().enumerate().map(|(at, place)| place.filter(|_| at % step == 0)).collect()
}

/// Pixels that show the sky although the finest ground lies behind all of their corners, edges and middles. Only pixels below one that shows the ground
/// are looked at. An adapter that clips triangles at the border may leave gaps between them in the outermost columns.
pub fn holes(world: &World, camera: &Camera, drawn: &[Option<DVec3>]) -> usize {
    let [width, height] = world.raw.size;
    let is_sky = |x: u32, y: u32| drawn[(y * width + x) as usize].is_none();
    let below = |x: u32| (0..height).skip_while(move |y| is_sky(x, *y)).filter(move |y| is_sky(x, *y));
    let margin = u32::from(is_coarse());
    let suspects = (margin..width - margin).flat_map(|x| below(x).map(move |y| [x as f32, y as f32]));
    let hits = |pixel: [f32; 2]| {
        let ray = Ray { limit: 11_000.0, ..Ray::through(camera, pixel).expect("inside") };
        world.scene.pick(&ray).expect("valid").is_some()
    };
    let is_hole =
        |[x, y]: [f32; 2]| (0..9).all(|at| hits([x + 0.5 * (at % 3) as f32, y + 0.5 * (at / 3) as f32]));
    suspects.filter(|pixel| is_hole(*pixel)).count()
}

/// The distances at which rays from a point above the ground hit it; `None` for rays that hit nothing.
pub fn hits(world: &World, [x, z]: [f64; 2], height: f64) -> Vec<Option<f64>> {
    let ground = world.scene.ground(world.land, x, z).expect("valid").expect("ground").height;
    let hit = |at: i32| {
        let (turn, part) = (0.7 * f64::from(at), f64::from(at) / 120.0);
        let direction = DVec3::new(turn.cos(), 0.02 - 0.4 * part, turn.sin());
        let ray = Ray { limit: 900.0, ..Ray::new(DVec3::new(x, ground + height, z), direction) };
        world.scene.pick(&ray).expect("valid").map(|hit| hit.distance)
    };
    (0..120).map(hit).collect()
}

/// The measurements of a flight.
#[derive(Debug, Default)]
pub struct Flight {
    pub holes: usize,
    /// The largest displacement and the largest jump, in pixels, of frames with all detail and of the others.
    pub ready: [f64; 2],
    rest: [f64; 2],
    points: usize,
    pub ready_frames: usize,
    pub made: usize,
    most_made: usize,
    drawn: usize,
    triangles: u64,
    most_triangles: u64,
    record_milliseconds: f64,
}

/// How to fly.
pub struct Path {
    pub from: [f64; 2],
    pub frames: usize,
    /// Metres to fly to the north, and height above the ground at the end. The height is 2 at first.
    pub metres: f64,
    pub height: f64,
    /// Every so many frames are compared with the finest heights, at every so many pixels.
    pub every: usize,
    pub step: usize,
}

/// Flies, and looks at each frame.
pub fn flight(world: &mut World, truth: &(impl Fn(f64, f64) -> f64 + Sync), path: &Path) -> Flight {
    let Path { from, frames, metres, height, every, step } = *path;
    let mut flight = Flight::default();
    let start = world.above(from, 2.0);
    world.view.set(start).expect("valid");
    world.settle();
    world.scene.set_statistics(true).expect("counted");
    let at = |world: &World, frame: usize| {
        let part = frame as f64 / frames as f64;
        let aside = 0.2 * metres * (2.0 * part).sin();
        world.above([from[0] + aside, from[1] - metres * part], 2.0 * (0.5 * height).powf(part))
    };
    // What a frame that was compared showed at the pixels.
    let mut last: Option<Vec<Option<DVec2>>> = None;
    for frame in 0..frames {
        let camera = at(world, frame);
        if let Some(before) = last.take() {
            // The same picture with the detail of the next frame: how far the surface jumps.
            world.view.set_lod_cameras(&[camera]).expect("valid");
            let earlier = at(world, frame - 1);
            let drawn = some(&world.positions(&earlier), step);
            let is_ready = world.scene.terrain_statistics(world.land).expect("endless").ready == 1.0;
            let after = offsets(truth, &earlier, &drawn);
            let jumps = before
                .iter()
                .zip(&after)
                .filter_map(|(one, other)| Some((*one.as_ref()? - *other.as_ref()?).length()));
            let jump = jumps.fold(0.0, f64::max);
            let of = if is_ready { &mut flight.ready } else { &mut flight.rest };
            of[1] = of[1].max(jump);
            world.view.set_lod_cameras(&[]).expect("valid");
        }
        world.view.set(camera).expect("valid");
        let start = std::time::Instant::now();
        let drawn = world.positions(&camera);
        flight.record_milliseconds += start.elapsed().as_secs_f64() * 1e3;
        flight.holes += holes(world, &camera, &drawn);
        let statistics = world.scene.terrain_statistics(world.land).expect("endless");
        let is_ready = statistics.ready == 1.0;
        flight.ready_frames += usize::from(is_ready);
        (flight.made, flight.most_made) =
            (flight.made + statistics.made, flight.most_made.max(statistics.made));
        flight.drawn += statistics.drawn;
        let triangles = world.view.statistics().map_or(0, |seen| {
            seen.objects.iter().flat_map(|object| &object.levels).map(|level| level.triangles).sum()
        });
        (flight.triangles, flight.most_triangles) =
            (flight.triangles + triangles, flight.most_triangles.max(triangles));
        if frame % every == 0 {
            let drawn = some(&drawn, step);
            let found = offsets(truth, &camera, &drawn);
            flight.points += found.iter().flatten().count();
            let of = if is_ready { &mut flight.ready } else { &mut flight.rest };
            of[0] = of[0].max(largest(&found));
            last = Some(found);
        }
    }
    flight
}

#[test]
fn a_flight_has_no_holes_and_keeps_its_promise() {
    let config = config();
    let limits = EndlessLimits { nodes_per_frame: 64, ..small_nodes() };
    let mut world = World::new(config.clone(), limits, [160, 90]);
    let path = Path { from: [1.0e6, 40.0], frames: 24, metres: 400.0, height: 150.0, every: 5, step: 7 };
    let flight = flight(&mut world, &|x, z| truth(&config, x, z), &path);
    println!("{flight:?}");
    assert_eq!(flight.holes, 0);
    assert!(flight.most_made <= 64 && flight.made > 50, "{flight:?}");
    assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
    assert!(flight.ready_frames >= 16, "{flight:?}");
}

/// The same over 600 frames of 1280 × 720, at two distances from the origin. `RELIEVO_FRAMES` flies fewer frames.
#[test]
#[ignore = "takes a quarter of an hour"]
fn a_long_flight() {
    let config = TerrainConfig { coarse_levels: 8, ..config() };
    let frames = std::env::var("RELIEVO_FRAMES").map_or(600, |frames| frames.parse().expect("a number"));
    for from in [[1.0e7, -1.0e7], [1.0e6, 40.0]] {
        let limits = EndlessLimits { view_distance: Some(20_000.0), ..EndlessLimits::default() };
        let mut world = World::new(config.clone(), limits, [1280, 720]);
        let start = std::time::Instant::now();
        let path = Path { from, frames, metres: 5_000.0, height: 5_000.0, every: 20, step: 9 };
        let flight = flight(&mut world, &|x, z| truth(&config, x, z), &path);
        println!("{from:?}: {flight:?}, {:.0} s", start.elapsed().as_secs_f64());
        assert_eq!(flight.holes, 0);
        assert!(flight.most_made <= 32, "{flight:?}");
        assert!(flight.ready[0] <= 1.0 + ROUNDING && flight.ready[1] <= 1.0 + ROUNDING, "{flight:?}");
    }
}

/// A picture in colour of what the view sees.
pub fn picture(world: &mut World) -> image::RgbaImage {
    let target = Offscreen::new(&world.gpu, world.raw.size).expect("made");
    let mut renderer = Renderer::new(&world.gpu, target.format()).expect("a format");
    renderer.prepare(&world.scene).expect("compiled");
    let World { gpu, scene, view, .. } = world;
    let drawn = gpu.try_run("picture", |encoder| -> Result<(), relievo::Error> {
        scene.record(encoder, &mut [view])?;
        Ok(target.record(encoder, [1.0, 0.0, 1.0], |pass| renderer.draw(pass, scene, view, Layer::Color))?)
    });
    drawn.expect("drawn");
    target.read(gpu).expect("read")
}

/// A place that is reached from two sides, at two speeds, and at once, has one picture.
#[test]
fn a_place_looks_the_same_from_wherever_it_was_reached() {
    let (place, height) = ([2_000.0, -900.0], 30.0);
    let reached = |from: [f64; 2], frames: usize| {
        let mut world = World::new(config(), small_nodes(), [96, 54]).within(2.0);
        for frame in 0..frames {
            let part = frame as f64 / frames as f64;
            let at = [0, 1].map(|axis| from[axis] + (place[axis] - from[axis]) * part);
            let camera = world.above(at, height + 400.0 * (1.0 - part));
            world.view.set(camera).expect("valid");
            world.frame();
        }
        let camera = world.above(place, height);
        world.view.set(camera).expect("valid");
        world.settle();
        picture(&mut world)
    };
    let at_once = reached(place, 0);
    assert!(at_once == reached([-2_000.0, 4_000.0], 25), "from the south-west");
    assert!(at_once == reached([9_000.0, -3_000.0], 7), "from the east, faster");
    assert!(at_once != image::imageops::flip_horizontal(&at_once), "the comparison sees no difference");
}

/// A farther view takes as many nodes more each time that the distance doubles.
#[test]
fn nodes_grow_with_the_logarithm_of_the_distance() {
    let drawn = |coarse_levels: u32| {
        // Each further level is twice as high, so that the finer levels stay as they are.
        let scale_factor = 5.0 * f64::from(1 << coarse_levels);
        let config = TerrainConfig { coarse_levels, scale_factor, ..config() };
        let mut world = World::new(config, small_nodes(), [160, 90]);
        let camera = world.above([10.0, 10.0], 5.0);
        world.view.set(camera).expect("valid");
        world.settle();
        world.scene.terrain_statistics(world.land).expect("endless").drawn
    };
    let counts = [3, 4, 5, 6, 7].map(drawn);
    println!("{counts:?}");
    let grown: Vec<usize> = counts.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    assert!(grown[0] > 20 && grown.iter().all(|more| more <= &(3 * grown[0] / 2)), "{counts:?}");
}

#[test]
fn nodes_are_made_again_after_a_loss() {
    a_loss_leaves_no_trace(&TerrainSource::endless(config()).with_limits(small_nodes()));
}

/// A lost device and a dropped encoder leave no trace: the picture is the same as before.
pub fn a_loss_leaves_no_trace(source: &TerrainSource) {
    let mut world = World::on(crate::harness::new_gpu(), source, [64, 36]);
    let camera = world.above([40.0, -700.0], 12.0);
    world.view.set(camera).expect("valid");
    world.scene.set_statistics(true).expect("counted");
    world.frame();
    world.frame();
    let pixels = |world: &mut World| world.view.statistics().expect("counted").pixels;
    assert_eq!(pixels(&mut world), f32::INFINITY, "no bound while detail is missing");
    world.settle();
    let before = picture(&mut world);
    assert_eq!(pixels(&mut world), 1.0);
    let drawn = |world: &World| world.scene.terrain_statistics(world.land).expect("endless").drawn;
    let nodes = drawn(&world);
    // A frame somewhere else is recorded and never submitted.
    let elsewhere = world.above([9_000.0, 9_000.0], 12.0);
    world.view.set(elsewhere).expect("valid");
    let mut encoder = world.gpu.encoder("dropped");
    world.scene.record(&mut encoder, &mut [&mut world.view]).expect("recorded");
    drop(encoder);
    world.view.set(camera).expect("valid");
    world.settle();
    assert!(picture(&mut world) == before, "after a dropped encoder");
    let second = crate::frame::device();
    world.gpu.device().destroy();
    world.scene.rebuild_all(&second, &mut [&mut world.view]).expect("rebuilt");
    world.gpu = second;
    world.settle();
    assert_eq!(drawn(&world), nodes);
    assert!(picture(&mut world) == before, "after a lost device");
}

/// Triangles with a corner in a hole are left out, for the picture and for the host; a mesh can then be the cave.
#[test]
fn holes_are_left_out_and_closed_again() {
    let config = config();
    let source = TerrainSource::endless(config.clone()).with_limits(small_nodes());
    let (middle, radius) = ([24.5, -60.0], 9.25);
    let hole = TerrainHole::Circle { at: middle, radius };
    let mut world = World::of(&source.clone().with_holes(vec![hole.clone()]), [160, 120]);
    let top = truth(&config, middle[0], middle[1]) + 60.0;
    let (eye, target) = ([middle[0], top, middle[1] + 25.0], [middle[0], top - 60.0, middle[1]]);
    let camera = Camera::looking_at_world(eye, target, 0.9, [0.5, 12_000.0], world.raw.size);
    world.view.set(camera).expect("valid");
    world.settle();
    let drawn = world.positions(&camera);
    // A sample lies in the hole or not; a triangle reaches a sample's distance further at most.
    let away = |place: &DVec3| (place.x - middle[0]).hypot(place.z - middle[1]);
    let nearest = drawn.iter().flatten().map(away).fold(f64::INFINITY, f64::min);
    assert!(nearest > radius - 0.8 && nearest < radius + 1.5, "{nearest}");
    let left_out = drawn.iter().filter(|place| place.is_none()).count();
    assert!((700..6_000).contains(&left_out), "{left_out}");
    for (pixel, place) in drawn.iter().enumerate().step_by(37) {
        let [x, y] = [pixel % 160, pixel / 160].map(|at| at as f32 + 0.5);
        let hit = world.scene.pick(&Ray::through(&camera, [x, y]).expect("inside")).expect("valid");
        assert_eq!(hit.is_some(), place.is_some(), "{x} {y}");
        if let (Some(hit), Some(place)) = (hit, place) {
            assert!(hit.world().distance(*place) < 0.3, "{} {place}", hit.world());
        }
    }
    let ground = |world: &World, at: [f64; 2]| world.scene.ground(world.land, at[0], at[1]).expect("valid");
    assert_eq!(ground(&world, middle), None);
    assert!(ground(&world, [middle[0] + 11.0, middle[1]]).is_some());
    // Closed again, the picture is that of terrain without holes; opened again, it is the first one.
    let open = picture(&mut world);
    world.scene.set_terrain_holes(world.land, &[]).expect("changed");
    world.settle();
    let mut whole = World::of(&source, world.raw.size);
    whole.view.set(camera).expect("valid");
    whole.settle();
    let closed = picture(&mut world);
    assert!(closed == picture(&mut whole) && closed != open);
    assert!(ground(&world, middle).is_some());
    world.scene.set_terrain_holes(world.land, std::slice::from_ref(&hole)).expect("changed");
    world.settle();
    assert!(picture(&mut world) == open);
    // Sample by sample, the same hole is the same picture.
    let (first, size) = ([10, -80], [30_u32, 40]);
    let is_hole = |at: u32| {
        let [column, row] = [at % size[0], at / size[0]].map(|at| at as i32);
        let place =
            [first[0] + column, first[1] + row].map(|sample| f64::from(sample) * config.terrain_scale);
        (place[0] - middle[0]).hypot(place[1] - middle[1]) <= radius
    };
    let is_hole: Vec<bool> = (0..size[0] * size[1]).map(is_hole).collect();
    assert!(is_hole.contains(&true));
    let mask = TerrainHole::Samples(SampleMask::new(first, size, &is_hole).expect("valid"));
    world.scene.set_terrain_holes(world.land, &[]).expect("changed");
    world.settle();
    assert!(picture(&mut world) == closed);
    world.scene.set_terrain_holes(world.land, &[mask]).expect("changed");
    world.settle();
    assert!(picture(&mut world) == open);
    assert_eq!(ground(&world, middle), None);
    // From afar it is narrower than a pixel, and needs no finest nodes.
    let far = world.above([0.0, 3_000.0], 9_000.0);
    world.view.set(far).expect("valid");
    world.settle();
    assert_eq!(world.scene.terrain_statistics(world.land).expect("endless").levels[0], 0);
    let refused = |hole: TerrainHole| hole.validate().expect_err("refused").path;
    assert_eq!(refused(TerrainHole::Circle { at: middle, radius: 0.0 }), "radius");
    assert_eq!(refused(TerrainHole::Circle { at: [f64::NAN, 0.0], radius }), "at");
    let without = whole.scene.set_terrain_holes(whole.land, &[hole]).expect_err("refused").to_string();
    assert!(without.contains("with_holes"), "{without}");
}

/// Two views far apart in one frame, and the sun's view of one of them: each shows its place.
#[test]
fn views_far_apart_and_a_shadow_have_their_own_detail() {
    let config = config();
    let mut world = World::new(config.clone(), small_nodes(), [160, 90]);
    let (near, far) = (world.above([0.0, 0.0], 3.0), world.above([300_000.0, -80_000.0], 150.0));
    world.view.set(near).expect("valid");
    let mut other = world.scene.view(Quality::pixels(1.0)).expect("made");
    other.set(far).expect("valid");
    let mut shadow = SunShadow::new(&mut world.scene, 512).expect("made");
    for _ in 0..40 {
        let World { gpu, scene, view, .. } = &mut world;
        shadow.fit(scene, &mut [&mut *view], 60.0).expect("fits");
        let frame =
            gpu.try_run("frame", |encoder| scene.record(encoder, &mut [view, &mut other, shadow.view()]));
        frame.expect("recorded");
    }
    assert_eq!(world.scene.terrain_statistics(world.land).expect("endless").ready, 1.0);
    for (camera, is_near) in [(near, true), (far, false)] {
        let World { gpu, scene, view, raw, measure, .. } = &mut world;
        shadow.fit(scene, &mut [&mut *view], 60.0).expect("fits");
        let frame = gpu.try_run("frame", |encoder| -> Result<(), relievo::Error> {
            scene.record(encoder, &mut [view, &mut other, shadow.view()])?;
            let shown = if is_near { &*view } else { &other };
            raw.pass(encoder, |pass| measure.draw(pass, scene, shown, Layer::Measure).expect("drawn"));
            Ok(())
        });
        frame.expect("recorded");
        let drawn = read_positions(raw, gpu, &camera);
        assert_eq!(holes(&world, &camera, &drawn), 0);
        let most = largest(&offsets(&|x, z| truth(&config, x, z), &camera, &some(&drawn, 7)));
        assert!(most <= 1.0 + ROUNDING && most > 0.01, "{most}");
    }
}

/// Rays and points of the host are those of the finest triangles, whatever is drawn.
#[test]
fn the_ground_of_the_host_is_the_finest() {
    let config = config();
    let mut world = World::new(config.clone(), small_nodes(), [64, 36]);
    let camera = world.above([100.0, 100.0], 40.0);
    world.view.set(camera).expect("valid");
    world.frame();
    for (x, z) in [(0.25, 0.5), (-70_000.75, 33.125), (1.0e7 + 0.5, -1.0e7 - 0.25)] {
        let point = world.scene.ground(world.land, x, z).expect("valid").expect("ground");
        let exact = truth(&config, x, z);
        assert!((point.height - exact).abs() < 1e-6, "{} {exact}", point.height);
    }
    let mut hits = 0;
    for (at, part) in (1..40).map(|at| (at, f64::from(at) / 40.0)) {
        let turn = 7.0 * part;
        let direction = DVec3::new(turn.cos(), -0.02 - 0.4 * part, turn.sin()).normalize();
        let origin = DVec3::new(100.0, truth(&config, 100.0, 100.0) + 40.0, 100.0);
        let ray = Ray::new(origin, direction);
        let Some(hit) = world.scene.pick(&ray).expect("valid") else { continue };
        hits += 1;
        let [x, y, z] = hit.world().to_array();
        assert!((y - truth(&config, x, z)).abs() < 1e-6 * hit.distance.max(1.0), "{at}: {y}");
        // No point before the hit lies below the ground.
        for step in 1..200 {
            let before = origin + direction * hit.distance * f64::from(step) / 200.0;
            assert!(before.y >= truth(&config, before.x, before.z) - 1e-6, "{at}: {before}");
        }
    }
    assert!(hits > 30, "{hits}");
    // The bounds of finer nodes change no hit.
    let coarse = self::hits(&world, [100.0, 100.0], 40.0);
    world.settle();
    assert!(world.scene.terrain_statistics(world.land).expect("endless").levels[0] > 10);
    assert_eq!(self::hits(&world, [100.0, 100.0], 40.0), coarse);
    assert!(coarse.iter().flatten().count() > 60 && coarse.contains(&None), "{coarse:?}");
}

#[test]
fn limits_and_sources_out_of_bounds_are_refused() {
    let gpu = gpu();
    let mut scene = Scene::new(&gpu).expect("made");
    let mut refused = |source: TerrainSource| match scene.add_terrain(&source) {
        Err(relievo::Error::Input(error)) => error.path,
        other => panic!("{other:?}"),
    };
    let endless = |limits: EndlessLimits| TerrainSource::endless(config()).with_limits(limits);
    let usual = EndlessLimits::default();
    assert_eq!(refused(endless(EndlessLimits { view_distance: Some(0.0), ..usual })), "view_distance");
    assert_eq!(refused(endless(EndlessLimits { view_distance: Some(1e6), ..usual })), "view_distance");
    assert_eq!(refused(endless(EndlessLimits { view_distance: Some(f64::NAN), ..usual })), "view_distance");
    assert_eq!(refused(endless(EndlessLimits { nodes_per_frame: 15, ..usual })), "nodes_per_frame");
    assert_eq!(refused(endless(EndlessLimits { capacity: 255, ..usual })), "capacity");
    assert_eq!(refused(endless(EndlessLimits { node_size: 64, ..usual })), "node_size");
    assert_eq!(refused(endless(EndlessLimits { node_size: 513, ..usual })), "node_size");
    let small = TerrainConfig { coarse_levels: 0, ..TerrainConfig::new(17, 10.0, "small").expect("valid") };
    assert_eq!(refused(TerrainSource::endless(small)), "node_size");
    let wrapped = TerrainConfig::new(65, 10.0, "wrap")
        .map(|config| TerrainConfig { border: relievo::scene::TerrainBorder::Wrap, ..config });
    assert_eq!(refused(TerrainSource::endless(wrapped.expect("valid"))), "border");
    let mut eroded = relievo::scene::TerrainRecipe::new(config());
    eroded.despike = Some(relievo::scene::Despike { threshold: 1.0 });
    assert_eq!(refused(TerrainSource::from(eroded).with_limits(usual)), "recipe");
    // What is only for lists of patches, and only for endless terrain.
    let land = scene.add_terrain(&TerrainSource::endless(config())).expect("added");
    let patches = scene.set_patches(land, &[[0, 0]], [0.0, 1.0]).expect_err("refused").to_string();
    assert!(patches.contains("terrain = endless"), "{patches}");
    let plain = scene.add_terrain(&TerrainSource::new(TerrainConfig::new(17, 1.0, "").expect("valid")));
    let plain = scene.terrain_statistics(plain.expect("added")).expect_err("refused").to_string();
    assert!(plain.contains("TerrainSource::endless"), "{plain}");
}

#[test]
fn the_ground_is_within_a_pixel_of_the_finest_heights() {
    let config = config();
    let mut world = World::new(config.clone(), EndlessLimits::default(), [128, 72]);
    // Also far from the origin, and on the other side of it.
    for (at, height) in [([10.0, 20.0], 2.0), ([-3_000.5, 700.0], 80.0), ([9.0e6, -9.5e6], 600.0)] {
        let camera = world.above(at, height);
        world.view.set(camera).expect("valid");
        let frames = world.settle();
        let drawn = world.positions(&camera);
        let found = offsets(&|x, z| truth(&config, x, z), &camera, &some(&drawn, 3));
        let (seen, most) = (drawn.iter().flatten().count(), largest(&found));
        let nodes = world.scene.terrain_statistics(world.land).expect("endless");
        println!(
            "{height} above: settled in {frames} frames; {seen} pixels, at most {most} px off; {nodes:?}"
        );
        assert!(most <= 1.0 + ROUNDING && most > 0.05, "{most}");
        assert!(seen > 2_500 && nodes.nodes <= nodes.capacity, "{seen} {nodes:?}");
    }
}

/// With normals of twice the nodes' resolution, a coarse picture is closer to the finest one.
#[test]
fn finer_normals_show_finer_heights() {
    let shown = |pixels: f32, finer_normals: bool| {
        let config = TerrainConfig { scale_factor: 500.0, ..config() };
        let limits = EndlessLimits { finer_normals, node_size: 17, ..small_nodes() };
        let mut world = World::new(config, limits, [128, 72]).within(pixels);
        let camera = world.above([800.0, 2_000.0], 60.0);
        world.view.set(camera).expect("valid");
        world.settle();
        picture(&mut world)
    };
    let full = shown(0.25, true);
    let [plain, finer] = [false, true].map(|finer| Difference::of(&shown(2.0, finer), &full, 3));
    println!("{plain:?} {finer:?}");
    assert!(finer.outliers < 0.6 * plain.outliers && finer.flip < 0.75 * plain.flip, "{plain:?} {finer:?}");
}

/// A limit of triangles makes the terrain coarser, in the first frame that exceeds it, and the view says by how much.
#[test]
fn triangles_keep_to_their_limit() {
    let limits = EndlessLimits { node_size: 17, nodes_per_frame: 128, ..EndlessLimits::default() };
    let mut world = World::new(config(), limits, [160, 90]);
    let camera = world.above([40.0, -700.0], 12.0);
    world.view.set(camera).expect("valid");
    world.scene.set_statistics(true).expect("counted");
    world.settle();
    let drawn = |world: &mut World| {
        world.frame();
        world.frame();
        let seen = world.view.statistics().expect("counted");
        let levels = seen.objects.iter().flat_map(|object| &object.levels);
        (levels.map(|level| level.triangles).sum::<u64>(), seen.pixels)
    };
    let (all, pixels) = drawn(&mut world);
    assert!(pixels <= 1.0, "{pixels}");
    for quarters in [3, 2] {
        let limit = (all * quarters / 4) as u32;
        world.view.set_quality(Quality { triangles: Some(limit), ..Quality::default() }).expect("valid");
        let (triangles, pixels) = drawn(&mut world);
        println!("{triangles} of {limit}, within {pixels} pixels");
        assert!(triangles <= u64::from(limit) && triangles > u64::from(limit) / 2, "{triangles} of {limit}");
        assert!(pixels > 1.0, "{pixels}");
    }
    world.view.set_quality(Quality::default()).expect("valid");
    world.settle();
    assert_eq!(drawn(&mut world), (all, 1.0));
}
