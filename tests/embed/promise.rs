//! The promise of `Quality::pixels`: however the camera moves, nothing is drawn further from its place.

use std::path::Path;
use std::sync::LazyLock;

use glam::{Quat, Vec3};
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::skinning::bounding_sphere::BoundingSphere;
use relievo::ops::skinning::{add_levels, poses_of};
use relievo::scene::{Camera, ObjectId, Placement, Play, Quality, Scene, View};
use relievo_lab::measure::{Displacement, DisplacementMeter};

use crate::frame::device;

/// Frames of the camera's way.
const FRAMES: u32 = 240;

/// Frames that are measured; `RELIEVO_FRAMES` asks for more, up to all of them.
const MEASURED: u32 = 10;

const VIEWPORT: [u32; 2] = [960, 540];

/// The camera after a part of its way, 0 to 1: from afar, past and among the instances and away, while it turns and zooms.
fn camera(part: f32) -> Camera {
    let turn = std::f32::consts::TAU * part;
    let eye = Vec3::new(5.0 * turn.cos(), 1.6 + 0.8 * (3.0 * turn).sin(), 24.0 - 60.0 * part);
    let target = Vec3::new(2.0 * (2.0 * turn).sin(), 1.0, -12.0 + 6.0 * turn.sin());
    let field_of_view = 0.6 + 0.45 * (5.0 * turn).cos();
    Camera::looking_at(eye, target, field_of_view, [0.1, 200.0], VIEWPORT)
}

/// A scene with one model, and who measures it.
struct Stage {
    scene: Scene,
    meter: DisplacementMeter,
    view: View,
}

impl Stage {
    /// Instances of `drawn` on the camera's way and beside it, half of them mirrored and scaled unevenly. `expected` is the
    /// model with which they are compared.
    fn new(gpu: &Gpu, drawn: &Model, expected: &Model) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let object = scene.add_character(drawn, 8).expect("added");
        (0..8).for_each(|at| spawn(&mut scene, object, drawn, at));
        let mut meter = DisplacementMeter::new();
        meter.watch(&scene, object, expected).expect("the object's model");
        let view = scene.view(Quality::default()).expect("a view");
        Self { scene, meter, view }
    }

    /// Records a frame of the camera's way, without drawing.
    fn frame(&mut self, part: f32) {
        self.scene.advance(1.0 / 60.0).expect("finite");
        self.view.set(camera(part)).expect("a camera");
        let gpu = self.scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        self.scene.record(&mut encoder, &mut [&mut self.view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.device().poll(relievo::wgpu::PollType::wait_indefinitely()).expect("done");
    }

    /// Goes the camera's way in so many frames, measures so many of them, and returns their largest figures.
    fn walk(&mut self, pixels: f32, frames: u32, measured: u32) -> Displacement {
        self.view.set_quality(Quality::pixels(pixels)).expect("in range");
        let mut all: Option<Displacement> = None;
        for at in 0..frames {
            self.frame(at as f32 / frames as f32);
            if at.is_multiple_of(frames / measured.clamp(1, frames)) {
                let found = self.meter.measure(&self.scene, &self.view).expect("measured");
                all = Some(all.map_or(found, |all| all.and(found)));
            }
        }
        all.expect("a frame")
    }
}

/// Spawns instance `at`, about two units large, at its own time in its clip.
fn spawn(scene: &mut Scene, object: ObjectId, model: &Model, at: usize) {
    let sphere = BoundingSphere::in_clip(model, 0);
    let size = Vec3::splat(1.0 / sphere.radius);
    let uneven = Vec3::new(-1.4, 0.7, 1.1);
    let scale = if at.is_multiple_of(2) { size } else { uneven * size };
    let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.9 * at as f32, 0.2, -0.1 * at as f32);
    let place = Vec3::new([-3.0, 3.0, 1.2, -1.5][at % 4], 1.0, 6.0 - 8.0 * at as f32);
    let placement =
        Placement { offset: place - turn * (scale * sphere.center), turn, scale, ..Default::default() };
    let instance = scene.spawn(object, placement).expect("room");
    let clip = if at % 3 == 2 { model.clips.len() - 1 } else { 0 }.to_string();
    let play = Play { start: -0.31 * at as f64, rate: 1.0 - 0.1 * at as f32, ..Play::new(&clip) };
    scene.play(instance, &play).expect("a clip");
}

/// A model with levels of detail for the clips that are played.
fn levelled(mut model: Model, most: usize) -> Model {
    let mut clips = vec![0, model.clips.len() - 1];
    clips.dedup();
    let poses = clips.iter().map(|clip| poses_of(&model.clips[*clip]).expect("short")).max().expect("a clip");
    add_levels(&mut model, &clips, poses.min(most)).expect("valid");
    model
}

fn check(name: &str, model: &Model, measured: u32) {
    let gpu = device();
    let mut stage = Stage::new(&gpu, model, model);
    for pixels in [0.5, 1.0, 4.0] {
        let found = stage.walk(pixels, FRAMES, measured);
        println!("{name}: {found:?}");
        assert!(found.largest <= f64::from(pixels), "{name}: {found:?}");
        assert!(found.jump > 0.0 && found.jump <= 2.0 * f64::from(pixels), "{name}: {found:?}");
        assert!(1000 * found.left_out <= found.samples, "{name}: {found:?}");
        assert_eq!(found.missing, 0, "{name}: {found:?}");
        let levels = found.levels.iter().filter(|instances| **instances > 0).count();
        assert!(levels > 1 && found.levels[0] > 0, "{name}: hardly a level of detail: {found:?}");
        // Otherwise the bound would be of no use. Where no level of detail helps, bones have 0.2 of it.
        assert!(found.largest > 0.04 * f64::from(pixels), "{name}: {found:?}");
    }
}

fn measured() -> u32 {
    let asked = std::env::var("RELIEVO_FRAMES").ok().and_then(|frames| frames.parse().ok());
    asked.unwrap_or(MEASURED)
}

fn creature() -> &'static Model {
    static MODEL: LazyLock<Model> =
        LazyLock::new(|| levelled(relievo_samples::creature().expect("valid"), 16));
    &MODEL
}

#[test]
fn a_creature_is_where_it_belongs() {
    check("creature", creature(), measured());
}

/// In hundredths, under a node that is scaled by 100.
#[test]
fn a_model_in_other_units_is_where_it_belongs() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files/armature.glb");
    check("armature", &levelled(Model::from_file(&path).expect("a model"), usize::MAX), measured());
}

/// The same for files of yours: `RELIEVO_MODELS=a.glb:b.glb cargo test --test embed promise -- --ignored`.
#[test]
#[ignore = "needs files"]
fn models_are_where_they_belong() {
    let files = std::env::var_os("RELIEVO_MODELS").expect("RELIEVO_MODELS names files");
    for path in std::env::split_paths(&files) {
        let model = levelled(Model::from_file(&path).expect("a model"), usize::MAX);
        check(&path.display().to_string(), &model, measured());
    }
}

/// Levels of detail that are worse than they say, and another pose, are found.
#[test]
fn planted_faults_exceed_the_promise() {
    let gpu = device();
    let right = creature();
    let mut worse = right.clone();
    let levels = worse.meshes.iter_mut().flat_map(|mesh| &mut mesh.levels);
    levels.for_each(|level| level.error *= 0.15);
    let found = Stage::new(&gpu, &worse, &worse).walk(1.0, 24, 4);
    assert!(found.largest > 1.0, "{found:?}");
    let mut other = right.clone();
    other.clips.rotate_left(1);
    let found = Stage::new(&gpu, right, &other).walk(1.0, 2, 1);
    assert!(found.largest > 10.0, "{found:?}");
}

/// A mesh that is drawn aside of where it belongs is off by the focal length times the way, by depth.
#[test]
fn displacements_are_those_of_a_closed_form() {
    let gpu = device();
    let mut model = relievo_samples::creature().expect("valid");
    model.clips.clear();
    let way = 0.125;
    let mut moved = model.clone();
    moved.meshes.iter_mut().flat_map(|mesh| &mut mesh.positions).for_each(|position| position[0] += way);
    let mut scene = Scene::new(&gpu).expect("compiled");
    let object = scene.add_mesh(&moved, 1).expect("added");
    scene.spawn(object, Placement::default()).expect("room");
    let mut meter = DisplacementMeter::new();
    meter.watch(&scene, object, &model).expect("as many vertices");
    let mut view = scene.view(Quality::default()).expect("a view");
    let (eye, field_of_view) = (Vec3::new(0.0, 0.5, 8.0), 1.0_f32);
    let ahead = eye - Vec3::Z;
    view.set(Camera::looking_at(eye, ahead, field_of_view, [0.5, 60.0], VIEWPORT)).expect("a camera");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    let found = meter.measure(&scene, &view).expect("measured");
    let focal = 0.5 * f64::from(VIEWPORT[1]) / (0.5 * f64::from(field_of_view)).tan();
    let nearest = model.meshes.iter().flat_map(|mesh| &mesh.positions).map(|position| position[2]);
    let depth = f64::from(eye.z - nearest.fold(f32::NEG_INFINITY, f32::max));
    let expected = focal * f64::from(way) / depth;
    assert!((found.largest / expected - 1.0).abs() < 1e-4, "{found:?}, not {expected}");
    assert!((found.largest_in_world - f64::from(way)).abs() < 1e-5 && found.left_out == 0, "{found:?}");
    // Samples just behind the near plane do not count, and those of an instance that was not drawn are missing.
    let close = |ahead, near| Camera::looking_at(eye, ahead, field_of_view, [near, 60.0], VIEWPORT);
    let mut measure = |recorded: Camera, measured: Camera| {
        let mut encoder = gpu.encoder("frame");
        view.set(recorded).expect("a camera");
        scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        view.set(measured).expect("a camera");
        meter.measure(&scene, &view).expect("measured")
    };
    let near = close(ahead, depth as f32 - 0.01);
    let found = measure(near, near);
    assert!(found.left_out > 0 && found.left_out < found.samples && found.missing == 0, "{found:?}");
    let found = measure(close(eye + Vec3::Z, 0.5), close(ahead, 0.5));
    assert!(found.missing > 0 && found.missing == found.samples, "{found:?}");
}
