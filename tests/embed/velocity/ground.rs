//! Velocities of endless terrain whose vertices morph, against the surfaces that two frames draw. No node is replaced in between: such a
//! jump, which the permitted error bounds, is no motion.

use glam::{DVec3, Mat4, Vec3, Vec4};
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, ObjectId, Quality, Scene, TerrainSource, View};

use super::{Eye, SIZE, bound, shown};
use crate::endless::{between, config, small_nodes};
use crate::frame::device;
use crate::raw::Raw;
use crate::rays::pixels_beside;

/// Samples along an edge of the square that the test looks at.
const SAMPLES: u32 = 96;
/// Column and row of the square's first sample.
const FIRST: i64 = 160;

/// A parallel camera straight above the square: each pixel's centre is a sample.
fn from_above(spacing: f32) -> Camera {
    let middle = (FIRST as f32 + 0.5 * SAMPLES as f32 - 0.5) * spacing;
    let half = 0.5 * SAMPLES as f32 * spacing;
    // East is to the right, and north is upwards.
    let turned = Mat4::from_cols(Vec4::X, Vec4::Z, -Vec4::Y, Vec4::W);
    let size = [SAMPLES; 2];
    Camera {
        view_from_cell: turned * Mat4::from_translation(-Vec3::new(middle, 1000.0, middle)),
        clip_from_view: glam::camera::rh::proj::directx::orthographic(-half, half, -half, half, 1.0, 2000.0),
        viewport: size,
        ..Camera::looking_at(Vec3::ZERO, Vec3::X, 0.8, [0.5, 100.0], size)
    }
}

/// The pictures of one frame.
struct Frame {
    velocities: Vec<[f32; 2]>,
    /// Positions in the oblique view; `None` where it shows no ground.
    positions: Vec<Option<DVec3>>,
    /// Heights of the square's samples, row by row.
    heights: Vec<f32>,
}

struct Stage {
    gpu: Gpu,
    scene: Scene,
    land: ObjectId,
    config: TerrainConfig,
    /// The oblique view, and that from above.
    views: [View; 2],
    eye: Eye,
    measures: [(Raw, Renderer); 2],
}

impl Stage {
    fn new() -> Self {
        let (gpu, config) = (device(), config());
        let mut scene = Scene::new(&gpu).expect("compiled");
        scene.keep_motion_history(true).expect("kept");
        let land = scene
            .add_terrain(&TerrainSource::endless(config.clone()).with_limits(small_nodes()))
            .expect("added");
        let view = || scene.view(Quality::pixels(4.0)).expect("a view");
        let mut views = [view(), view()];
        views[1].set(from_above(config.terrain_scale as f32)).expect("a camera");
        let eye = Eye::new(&gpu, &scene);
        let measures = [SIZE, [SAMPLES; 2]].map(|size| {
            let raw = Raw::new(&gpu, TargetFormat::measure(), size);
            let renderer = raw.renderer(&gpu, &scene);
            (raw, renderer)
        });
        Self { gpu, scene, land, config, views, eye, measures }
    }

    /// Records a frame in which a camera decides levels of detail.
    fn frame(&mut self, own: &Camera, decides: &Camera) -> Frame {
        self.views[0].set(*own).expect("a camera");
        for view in &mut self.views {
            view.set_lod_cameras(&[*decides]).expect("a camera");
        }
        let [view, above] = &mut self.views;
        let mut encoder = self.gpu.encoder("frame");
        self.scene.record(&mut encoder, &mut [&mut *view, &mut *above]).expect("recorded");
        let (scene, eye) = (&self.scene, &self.eye);
        eye.raw.pass(&mut encoder, |pass| {
            eye.renderer.draw(pass, scene, view, Layer::Velocity).expect("drawn");
        });
        for ((raw, renderer), view) in self.measures.iter().zip([&*view, &*above]) {
            raw.pass(&mut encoder, |pass| {
                renderer.draw(pass, scene, view, Layer::Measure).expect("drawn");
            });
        }
        self.gpu.queue().submit([encoder.finish()]);
        let position = |[x, y, z, w]: [f32; 4]| (w == 1.0).then(|| Vec3::new(x, y, z).as_dvec3());
        let read = |at: usize| self.measures[at].0.floats(&self.gpu, 0);
        Frame {
            velocities: eye.read(scene),
            positions: read(0).into_iter().map(position).collect(),
            heights: read(1).into_iter().map(|[_, y, ..]| y).collect(),
        }
    }

    /// Height of a frame's surface. The triangles of all levels are made of those of level 0, whose vertices are the samples.
    fn height(&self, frame: &Frame, [x, z]: [f64; 2]) -> f64 {
        between(&self.config, [x, z], |region| {
            let [column, row] = region.first.map(|at| (at - FIRST) as usize);
            let at = row * SAMPLES as usize + column;
            [at, at + 1, at + SAMPLES as usize, at + SAMPLES as usize + 1]
                .map(|at| (frame.heights[at] * 65_536.0).round() as i32)
                .to_vec()
        })
    }
}

/// The ground moves on the screen as its vertices morph: with the camera that decides levels of detail, with the camera that draws, and
/// with both.
#[test]
fn ground_that_morphs_has_its_velocity() {
    let mut stage = Stage::new();
    let middle = (FIRST as f32 + 0.5 * SAMPLES as f32) * stage.config.terrain_scale as f32;
    let ground =
        stage.scene.ground(stage.land, middle.into(), middle.into()).expect("valid").expect("ground");
    let target = Vec3::new(middle, ground.height as f32, middle);
    let reach = SAMPLES as f32 * stage.config.terrain_scale as f32;
    let looks = |aside: f32| {
        let eye = target + Vec3::new(aside, 5.0, 3.0) * reach;
        Camera::looking_at(eye, target, 0.075, [0.5 * reach, 20.0 * reach], SIZE)
    };
    let decides = |distance: f32| {
        let eye = target + Vec3::new(0.3, 0.7, -0.4) * (distance * reach);
        Camera::looking_at(eye, target, 0.9, [0.5, 10_000.0], [1280, 720])
    };
    for _ in 0..40 {
        stage.frame(&looks(1.0), &decides(8.0));
    }
    // Factors of the distances of both cameras, before and now.
    let steps = [
        ((1.0, 1.0), (8.0, 8.2)),
        ((1.0, 1.02), (8.2, 8.2)),
        ((1.02, 1.02), (8.2, 8.05)),
        ((1.02, 1.03), (8.05, 8.25)),
    ];
    for ((own_before, own_now), (before, now)) in steps {
        let [own_before, own_now] = [own_before, own_now].map(looks);
        for _ in 0..12 {
            stage.frame(&own_before, &decides(before));
        }
        let last = stage.frame(&own_before, &decides(before));
        let found = stage.frame(&own_now, &decides(now));
        let (mut seen, mut worst, mut drawn, mut largest, mut morph) =
            (0, 0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let still = before == now;
        for (at, position) in found.positions.iter().enumerate() {
            let Some(place) = *position else { continue };
            drawn = drawn.max((stage.height(&found, [place.x, place.z]) - place.y).abs());
            let was = DVec3::new(place.x, stage.height(&last, [place.x, place.z]), place.z);
            let on_screen = |place| [shown(&own_now, place), shown(&own_before, place)];
            let ([to, unmorphed], [_, from]) = (on_screen(place), on_screen(was));
            let expected = [to[0] - from[0], to[1] - from[1]];
            let off = [0, 1].map(|axis| (f64::from(found.velocities[at][axis]) - expected[axis]).abs());
            worst = worst.max(off[0].max(off[1]) / bound(expected));
            largest = largest.max(expected[0].abs().max(expected[1].abs()));
            morph = morph.max((from[1] - unmorphed[1]).abs() / bound(expected));
            seen += 1;
        }
        println!(
            "{seen} pixels, {worst} of the bound, heights off by {drawn}, at most {largest}, morph {morph} bounds"
        );
        // The ground rises by less than one in ten, and a pixel is as wide as the spacing of samples.
        let most = 1e-3 + 0.1 * pixels_beside() * stage.config.terrain_scale;
        assert!(seen == found.positions.len() && drawn < most, "{seen} pixels, heights off by {drawn}");
        assert!(worst <= 1.0, "{worst} of the bound");
        assert!(still || morph > 5.0, "the ground does not morph: {morph} bounds");
    }
}
