//! Endless terrain: what is drawn lies where the finest heights are, everywhere and at all times, and nothing is missing.

use glam::{DMat4, DVec2, DVec3};
use rayon::prelude::*;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::HeightInterpolation;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::smooth::reference::smooth;
use relievo::ops::terrain::window::Region;
use relievo::render::{Layer, Offscreen, Renderer, TargetFormat};
use relievo::scene::{
    Camera, EndlessLimits, ObjectId, Placement, Quality, Scene, TerrainConfig, TerrainSource, View,
};

use crate::harness::gpu;
use crate::raw::Raw;

/// Ground that rises and falls by some hundred units over some kilometres.
fn config() -> TerrainConfig {
    TerrainConfig {
        coarse_levels: 6,
        interpolation: HeightInterpolation::Smooth,
        ..TerrainConfig::new(65, 300.0, "endless").expect("valid")
    }
}

/// A scene of endless terrain, and the means to look at it.
struct World {
    gpu: Gpu,
    scene: Scene,
    land: ObjectId,
    view: View,
    raw: Raw,
    measure: Renderer,
}

impl World {
    fn new(config: TerrainConfig, limits: EndlessLimits, size: [u32; 2]) -> Self {
        let gpu = gpu();
        let mut scene = Scene::new(&gpu).expect("made");
        let source = TerrainSource::endless(config).with_limits(limits);
        let land = scene.add_terrain(&source).expect("added");
        let view = scene.view(Quality::pixels(1.0)).expect("made");
        let raw = Raw::new(&gpu, TargetFormat::measure(), size);
        let measure = raw.renderer(&gpu, &scene);
        Self { gpu, scene, land, view, raw, measure }
    }

    /// A camera above the ground that looks to the north, and a little down.
    fn above(&self, at: [f64; 2], height: f64) -> Camera {
        let ground = self.scene.ground(self.land, at[0], at[1]).expect("valid").expect("ground").height;
        let eye = [at[0], ground + height, at[1]];
        let target = [at[0] + 0.2, eye[1] - 0.25, at[1] - 1.0];
        Camera::looking_at_world(eye, target, 0.9, [0.5, 12_000.0], self.raw.size)
    }

    /// Records a frame, and waits for it.
    fn frame(&mut self) {
        let Self { gpu, scene, view, .. } = self;
        gpu.try_run("frame", |encoder| scene.record(encoder, &mut [view])).expect("recorded");
    }

    /// Records frames until all detail is there. Returns their number.
    fn settle(&mut self) -> usize {
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
    fn positions(&mut self, camera: &Camera) -> Vec<Option<DVec3>> {
        let Self { gpu, scene, view, raw, measure, .. } = self;
        raw.frame(scene, view, measure, &[Layer::Measure]);
        let corner = DVec3::from(Placement { cell: camera.cell, ..Placement::default() }.world());
        let place = |texel: [f32; 4]| {
            let [x, y, z, w] = texel.map(f64::from);
            (w == 1.0).then(|| corner + DVec3::new(x, y, z))
        };
        raw.floats(gpu, 0).into_iter().map(place).collect()
    }
}

/// The height of the finest triangles at a world position, computed from the definition alone.
fn truth(config: &TerrainConfig, x: f64, z: f64) -> f64 {
    let [u, v] = [x, z].map(|at| at / config.terrain_scale);
    let first = [u, v].map(|at| at.floor() as i64);
    let region = Region { first, width: 2, coarser: 0 };
    let heights = smooth(config, &Features::default(), region);
    let [a, b, c, d] = [0, 1, 2, 3].map(|at| f64::from(heights[at]) / 65_536.0);
    let [u, v] = [u - u.floor(), v - v.floor()];
    // The diagonal runs from south-west to north-east.
    if u + v <= 1.0 { a + (b - a) * u + (c - a) * v } else { d + (c - d) * (1.0 - u) + (b - d) * (1.0 - v) }
}

/// Where a camera draws a world position, in pixels.
fn pixel(camera: &Camera, at: DVec3) -> DVec2 {
    let corner = DVec3::from(Placement { cell: camera.cell, ..Placement::default() }.world());
    let clip = DMat4::from_cols_array(&camera.clip_from_view.to_cols_array().map(f64::from))
        * DMat4::from_cols_array(&camera.view_from_cell.to_cols_array().map(f64::from));
    let point = clip * (at - corner).extend(1.0);
    let size = DVec2::new(f64::from(camera.viewport[0]), f64::from(camera.viewport[1]));
    0.5 * size * DVec2::new(point.x, point.y) / point.w
}

/// How far the surface at positions that are drawn lies from the truth: the offset of each in pixels.
fn offsets(config: &TerrainConfig, camera: &Camera, drawn: &[Option<DVec3>]) -> Vec<Option<DVec2>> {
    let offset = |at: &Option<DVec3>| {
        let at = (*at)?;
        let exact = DVec3::new(at.x, truth(config, at.x, at.z), at.z);
        Some(pixel(camera, at) - pixel(camera, exact))
    };
    drawn.par_iter().map(offset).collect()
}

fn largest(offsets: &[Option<DVec2>]) -> f64 {
    offsets.iter().flatten().map(|offset| offset.length()).fold(0.0, f64::max)
}

/// Rounding of drawn positions, in pixels.
const ROUNDING: f64 = 0.01;

#[test]
fn the_ground_is_within_a_pixel_of_the_finest_heights() {
    let config = config();
    let mut world = World::new(config.clone(), EndlessLimits::default(), [192, 108]);
    // Also far from the origin, and on the other side of it.
    for (at, height) in [([10.0, 20.0], 2.0), ([-3_000.5, 700.0], 80.0), ([9.0e6, -9.5e6], 600.0)] {
        let camera = world.above(at, height);
        world.view.set(camera).expect("valid");
        let frames = world.settle();
        let drawn = world.positions(&camera);
        let found = offsets(&config, &camera, &drawn);
        let (seen, most) = (drawn.iter().flatten().count(), largest(&found));
        let nodes = world.scene.terrain_statistics(world.land).expect("endless");
        println!("{height} above: settled in {frames} frames; {seen} pixels, at most {most} px off; {nodes:?}");
        assert!(most <= 1.0 + ROUNDING && most > 0.05, "{most}");
        assert!(seen > 5_000 && nodes.nodes <= nodes.capacity, "{seen} {nodes:?}");
    }
}
