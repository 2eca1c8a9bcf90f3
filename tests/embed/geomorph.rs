//! Levels of detail that move into each other: no pixel changes where one level becomes the next, and in between every
//! vertex is where the host moves it.

mod measured;
mod transparent;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::mesh::ProgressiveMesh;
use relievo::ops::skinning::add_levels;
use relievo::ops::skinning::merged::merged;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, Renderer};
use relievo::scene::{
    Camera, ErrorBudget, LevelOfDetail, ObjectId, Placement, Play, Quality, Scene, TerrainSource, Transition,
    View,
};
use relievo_samples::{creature, rock};

use crate::frame::{Frame, device};

const SIZE: [u32; 2] = [160, 160];

/// Half of the height that the camera sees.
const HALF: f32 = 1.2;

/// A parallel camera, which allows the same displacement everywhere.
fn camera(size: f32) -> Camera {
    let target = Vec3::new(0.0, 0.5 * size, 0.0);
    let camera = Camera::looking_at(target + Vec3::new(4.0, 1.5, 3.0), target, 0.8, [0.05, 100.0], SIZE);
    let high = HALF * size / 1.4;
    Camera {
        clip_from_view: glam::camera::rh::proj::directx::orthographic(-high, high, -high, high, 0.5, 20.0),
        ..camera
    }
}

/// A model that stands alone in a scene.
struct Stage {
    scene: Scene,
    object: ObjectId,
    frame: Frame,
    renderer: Renderer,
    view: View,
    /// The errors of its levels 1, 2 …, in the model's units.
    errors: Vec<f32>,
    /// Pixels of a unit.
    focal: f32,
}

impl Stage {
    fn new(gpu: &Gpu, model: &Model, size: f32, transition: Transition) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        scene.set_error_budget(ErrorBudget { mesh: 1.0, bones: 0.0, influences: 0.0 }).expect("valid");
        let object = scene.add_character(model, 1).expect("added");
        let instance = scene.spawn(object, Placement::at([0.0; 3])).expect("room");
        if !model.clips.is_empty() {
            scene.play(instance, &Play::new("walk")).expect("there");
            scene.advance(0.4).expect("finite");
        }
        // Levels depend on this frame alone.
        let level_of_detail = LevelOfDetail { hysteresis: 0.0, ..transition.into() };
        scene.set_level_of_detail(object, &level_of_detail).expect("with partners");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        let mut view = scene.view(Quality::default()).expect("a view");
        view.set(camera(size)).expect("a camera");
        let errors = merged(model, 8).expect("valid").errors;
        let focal = SIZE[1] as f32 * 0.5 / (HALF * size / 1.4);
        Self { scene, object, frame, renderer, view, errors, focal }
    }

    /// The picture where so much displacement is allowed, in the model's units.
    fn draw(&mut self, allowed: f32) -> RgbaImage {
        // 0.9999 is what a camera keeps back.
        let pixels = allowed * self.focal / 0.9999;
        self.view.set_quality(Quality::pixels(pixels)).expect("valid");
        let layers = [Layer::Color, Layer::Transparent];
        self.frame.shot_of(&mut self.scene, &mut self.view, &self.renderer, &layers)
    }

    /// The displacement from which on level `level` is the one that moves into the next: 1.2 times the error of that next one.
    fn begin(&self, level: usize) -> f32 {
        1.2 * self.errors.get(level).copied().unwrap_or_else(|| 2.0 * self.errors[self.errors.len() - 1])
    }
}

/// The mean difference of two pictures, in levels of 255.
fn difference(a: &RgbaImage, b: &RgbaImage) -> f64 {
    let all = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b)));
    all.sum::<f64>() / a.as_raw().len() as f64
}

/// A closed mesh that stands still, and a skinned one in its walk.
fn models() -> [(Model, f32); 2] {
    let (mut rock, mut creature) = (rock().expect("valid"), creature().expect("valid"));
    add_levels(&mut rock, &[], 1).expect("valid");
    add_levels(&mut creature, &[0], 9).expect("valid");
    [(rock, 1.4), (creature, 2.0)]
}

#[test]
fn sixty_steps_over_all_levels_do_not_jump() {
    let gpu = device();
    for (model, size) in models() {
        let mut stage = Stage::new(&gpu, &model, size, Transition::Geomorph);
        let mut hard = Stage::new(&gpu, &model, size, Transition::Hard);
        let levels = stage.errors.len();
        assert_eq!(levels, 7);
        let steps = 60_usize.div_ceil(levels);
        let (mut last, mut largest, mut moved) = (stage.draw(0.0), 0.0_f64, 0);
        assert!(last == hard.draw(0.0), "level 0");
        for level in 0..levels {
            let [begin, end] = [level, level + 1].map(|level| stage.begin(level));
            // Just inside of the interval: the first step is beyond a change of level, of which nothing may be seen.
            let after = stage.draw(begin + 1e-4 * (end - begin));
            assert!(after == last, "level {level} begins with a jump of {}", difference(&after, &last));
            for step in 1..=steps {
                let part = (step as f32 / steps as f32).min(0.9999);
                let picture = stage.draw(begin + part * (end - begin));
                largest = largest.max(difference(&picture, &last));
                moved += usize::from(picture != last);
                last = picture;
            }
            // At its end it is what is drawn at once where the next level's error is allowed.
            let reached = hard.draw(1.0001 * hard.errors[level]);
            assert!(last == reached, "level {} is off by {}", level + 1, difference(&last, &reached));
        }
        assert!(moved > levels * steps / 2, "it does move: {moved} of {}", levels * steps);
        // What levels that change at once show in one step.
        let mut jump = 0.0_f64;
        for level in 0..levels {
            let [before, after] = [0.999, 1.001].map(|part| hard.draw(part * hard.errors[level]));
            jump = jump.max(difference(&before, &after));
        }
        assert!(jump > 2.0 * largest, "steps of {largest} against jumps of {jump}");
    }
}

/// Between levels vertices are where the host moves them.
#[test]
fn the_device_moves_vertices_as_the_host_does() {
    let gpu = device();
    let [(model, size), _] = models();
    let mut stage = Stage::new(&gpu, &model, size, Transition::Geomorph);
    let whole = merged(&model, 8).expect("valid").model;
    let progressive = ProgressiveMesh::of_levels(&whole.meshes[0]).expect("valid");
    for (level, steps) in [(0, 255), (2, 100), (5, 400), (6, 17)] {
        let [begin, end] = [level, level + 1].map(|level| stage.begin(level));
        let way = steps as f32 / 511.0;
        let found = stage.draw(begin + way * (end - begin));
        let mut still = model.clone();
        let mesh = progressive.mesh();
        let moved = |values: &[[f32; 3]]| progressive.morphed(level, way, values).expect("valid");
        let count = progressive.vertices(level);
        let mut own = mesh.clone();
        own.positions[..count].copy_from_slice(&moved(&mesh.positions));
        own.normals[..count].copy_from_slice(&moved(&mesh.normals));
        own.uv[..count].copy_from_slice(&progressive.morphed(level, way, &mesh.uv).expect("valid"));
        own.indices = progressive.indices(level).to_vec();
        (own.levels, own.partners) = (Vec::new(), Vec::new());
        still.skins.clone_from(&whole.skins);
        still.meshes = vec![own];
        let mut expected = Stage::still(&gpu, &still, size);
        let expected = expected.frame.shot(&mut expected.scene, &mut expected.view, &expected.renderer);
        let off = difference(&found, &expected);
        assert!(off < 0.02, "level {level} after {steps} steps: {off}");
        // The level that does not move is another picture.
        let unmoved = stage.draw(begin);
        assert!(difference(&unmoved, &expected) > 4.0 * off + 0.01, "level {level}");
    }
}

impl Stage {
    /// A model without levels.
    fn still(gpu: &Gpu, model: &Model, size: f32) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let object = scene.add_mesh(model, 1).expect("added");
        scene.spawn(object, Placement::at([0.0; 3])).expect("room");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        let mut view = scene.view(Quality::default()).expect("a view");
        view.set(camera(size)).expect("a camera");
        Self { scene, object, frame, renderer, view, errors: Vec::new(), focal: 0.0 }
    }
}

/// Growth, a fresh start and a change back keep what was set.
#[test]
fn what_was_set_stays_and_can_be_taken_back() {
    let gpu = device();
    let [_, (model, size)] = models();
    let mut stage = Stage::new(&gpu, &model, size, Transition::Geomorph);
    let half = 0.5 * (stage.begin(2) + stage.begin(3));
    let moved = stage.draw(half);
    // More instances than there is room for, out of sight.
    for at in 0..3 {
        let far = Placement::at([100.0 + at as f32, 0.0, 0.0]);
        stage.scene.spawn(stage.object, far).expect("room");
    }
    assert!(stage.draw(half) == moved, "after growth");
    stage.scene.refresh().expect("afresh");
    assert!(stage.draw(half) == moved, "after a fresh start");
    let found = stage.scene.level_of_detail(stage.object).expect("there");
    assert_eq!(found.transition, Transition::Geomorph);
    stage.scene.set_level_of_detail(stage.object, &Transition::Hard.into()).expect("there");
    stage.renderer.prepare(&stage.scene).expect("compiled");
    let hard = stage.draw(half);
    let mut other = Stage::new(&gpu, &model, size, Transition::Hard);
    assert!(hard == other.draw(half) && hard != moved, "at once again");
}

#[test]
fn objects_without_partners_are_refused() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let config = TerrainConfig::new(33, 6.0, "geomorph").expect("valid");
    let land = scene.add_terrain(&TerrainSource::new(config)).expect("generated");
    let bare = scene.add_mesh(&rock().expect("valid"), 1).expect("added");
    let mut model = rock().expect("valid");
    add_levels(&mut model, &[], 1).expect("valid");
    model.meshes[0].partners.clear();
    let without = scene.add_mesh(&model, 1).expect("added");
    for object in [land, bare, without] {
        let refused = scene.set_level_of_detail(object, &Transition::Geomorph.into()).expect_err("refused");
        assert!(refused.to_string().starts_with("object.levels = "), "{refused}");
        assert_eq!(
            scene.set_level_of_detail(object, &Transition::Hard.into()).map_err(|error| error.to_string()),
            Ok(())
        );
    }
}
