//! Models that are replaced by finer ones.

use std::ops::ControlFlow;
use std::sync::LazyLock;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::package::Package;
use relievo::asset::{Model, Transform};
use relievo::gpu::Gpu;
use relievo::ops::skinning::cook;
use relievo::render::Renderer;
use relievo::scene::{
    Camera, CharacterOptions, InstanceId, LayerMask, ObjectId, Pace, Placement, Play, Quality, Scene,
    Transition, View,
};

use crate::frame::{Frame, device, devices};
use crate::world::SIZE;

static ROCK: LazyLock<[Model; 3]> = LazyLock::new(|| stages("rock"));
static CREATURE: LazyLock<[Model; 3]> = LazyLock::new(|| stages("creature"));

/// The models of a package: with the coarsest level, with half of the levels, and with all.
fn stages(name: &str) -> [Model; 3] {
    let file = relievo_samples::model(name).expect("built in").into();
    let bytes = cook(&file, &mut |_| ControlFlow::Continue(())).expect("cooked").expect("not broken off");
    let mut package = Package::new(&bytes).expect("a package");
    let levels = package.header().levels.clone();
    let mut models = Vec::new();
    for (at, level) in levels.iter().enumerate() {
        package.add_level(&bytes[level.chunk.range()]).expect("sound");
        if [0, levels.len() / 2, levels.len() - 1].contains(&at) {
            models.push(package.model().expect("a model"));
        }
    }
    models.try_into().expect("three")
}

fn options() -> CharacterOptions<'static> {
    CharacterOptions { layers: vec![LayerMask::All], ..CharacterOptions::default() }
}

struct Stage {
    scene: Scene,
    view: View,
    frame: Frame,
    renderer: Renderer,
    rocks: ObjectId,
    people: ObjectId,
    instances: [InstanceId; 3],
}

impl Stage {
    fn new(gpu: &Gpu, rock: &Model, creature: &Model) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let rocks = scene.add_mesh(rock, 1).expect("a mesh");
        let people = scene.add_character_with(creature, 2, &options()).expect("a character");
        for object in [rocks, people] {
            scene.set_level_of_detail(object, &Transition::Hard.into()).expect("levels");
        }
        let spawn = |scene: &mut Scene, object, at: [f32; 3], scale| {
            scene.spawn(object, Placement::at(at).turned(0.4).scaled(scale)).expect("room")
        };
        let instances = [
            spawn(&mut scene, rocks, [-3.0, 1.0, 0.0], 1.5),
            spawn(&mut scene, people, [0.0, 0.0, 0.0], 3.0),
            spawn(&mut scene, people, [3.5, 0.0, -1.0], 3.0),
        ];
        scene.play(instances[1], &Play::new("walk")).expect("the clip");
        scene.set_tint(instances[2], [0.4, 0.6, 1.0, 1.0]).expect("a tint");
        scene.advance(1.3).expect("finite");
        let mut view = scene.view(Quality::pixels(0.5)).expect("a view");
        let eye =
            Camera::looking_at(Vec3::new(1.0, 4.0, 9.0), Vec3::new(0.0, 2.0, 0.0), 0.9, [0.5, 400.0], SIZE);
        view.set(eye).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        Self { scene, view, frame, renderer, rocks, people, instances }
    }

    fn set(&mut self, rock: &Model, creature: &Model) {
        self.scene.set_model(self.rocks, rock).expect("a mesh");
        self.scene.set_character_model(self.people, creature, &options()).expect("a character");
        self.renderer.prepare(&self.scene).expect("compiled");
    }

    fn shot(&mut self) -> RgbaImage {
        self.frame.shot(&mut self.scene, &mut self.view, &self.renderer)
    }
}

#[test]
fn a_finer_model_takes_the_place_of_a_coarser_one() {
    let gpu = device();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    let mut before = stage.shot();
    for at in 1..3 {
        stage.set(&rocks[at], &people[at]);
        let picture = stage.shot();
        assert!(
            picture == Stage::new(&gpu, &rocks[at], &people[at]).shot(),
            "not the picture of a new scene"
        );
        assert!(picture != before, "the finer model looks the same");
        before = picture;
    }
    // Handles are valid, and settings have been kept.
    let [rock, walker, _] = stage.instances;
    stage.scene.move_to(rock, Placement::at([-3.0, 2.0, 0.0])).expect("still there");
    stage.scene.play(walker, &Play::new("0")).expect("still there");
    stage.scene.despawn(walker).expect("still there");
    assert!(stage.shot() != before);
}

/// How many of the values of two pictures differ by more than 8 of 255.
fn changed(a: &RgbaImage, b: &RgbaImage) -> usize {
    a.iter().zip(b.iter()).filter(|(a, b)| a.abs_diff(**b) > 8).count()
}

/// Instances go through all levels between the old and the new model, by the object's transition.
#[test]
fn finer_levels_appear_by_the_transition_of_the_object() {
    let gpu = device();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let transitions =
        [Transition::Geomorph, Transition::Dither(Pace::Band(0.3)), Transition::Dither(Pace::Seconds(0.5))];
    for transition in transitions {
        let staged = |at: usize| {
            let mut stage = Stage::new(&gpu, &rocks[at], &people[at]);
            // People move, and bones may lie within a limit of pixels: the rock alone remains.
            stage.instances[1..].iter().for_each(|one| stage.scene.despawn(*one).expect("there"));
            stage.scene.set_statistics(true).expect("allocated");
            stage
        };
        // A model with one level has no transition.
        let tune = |stage: &mut Stage| {
            for object in [stage.rocks, stage.people] {
                stage.scene.set_level_of_detail(object, &transition.into()).expect("levels");
            }
            stage.renderer.prepare(&stage.scene).expect("compiled");
        };
        let mut stage = staged(0);
        let coarse = stage.shot();
        assert!(!stage.scene.is_refining());
        stage.set(&rocks[2], &people[2]);
        tune(&mut stage);
        assert!(stage.scene.is_refining());
        assert!(stage.shot() == coarse, "{transition:?}: the first picture is not the old one");
        let mut pictures = vec![coarse];
        let mut bounds = Vec::new();
        for _ in 0..40 {
            stage.scene.advance(1.0 / 60.0).expect("finite");
            pictures.push(stage.shot());
            bounds.push(stage.view.statistics().expect("arrived").pixels);
        }
        assert!(!stage.scene.is_refining());
        let mut whole = staged(2);
        tune(&mut whole);
        let fine = whole.shot();
        assert!(pictures.last() == Some(&fine), "{transition:?}: not the picture of a new scene");
        let pop = changed(&pictures[0], &fine);
        let largest = pictures.windows(2).map(|two| changed(&two[0], &two[1])).max().expect("some");
        let different = pictures.windows(2).filter(|two| two[0] != two[1]).count();
        println!("{transition:?}: {pop} values change, at most {largest} at once, in {different} frames");
        // A fade in time shows what the limit does not allow.
        let is_timed = matches!(transition.pace(), Some(Pace::Seconds(_)));
        assert!((is_timed || bounds[0] > 0.5) && bounds[39] == 0.5, "{bounds:?}");
        assert!(
            different >= 8 && 3 * largest < 2 * pop,
            "{transition:?}: {largest} of {pop} at once, {different}"
        );
    }
}

#[test]
fn until_all_has_arrived_the_old_model_is_drawn() {
    let gpu = device();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    let coarse = stage.shot();
    let finest = Stage::new(&gpu, &rocks[2], &people[2]).shot();
    stage.scene.set_upload_budget(Some(100_000)).expect("a number");
    stage.set(&rocks[2], &people[2]);
    let (mut coarse_frames, mut frames) = (0, 0);
    while stage.scene.waiting() > 0 {
        let picture = stage.shot();
        coarse_frames += usize::from(picture == coarse);
        frames += 1;
        assert!(frames < 200, "{} bytes wait", stage.scene.waiting());
    }
    assert!(coarse_frames > 2 && frames > 4, "{coarse_frames} of {frames}");
    assert!(stage.shot() == finest);
    // An object that grows meanwhile gets the new model with all instances.
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    stage.scene.set_upload_budget(Some(100_000)).expect("a number");
    stage.set(&rocks[2], &people[2]);
    stage.shot();
    for at in 0..5 {
        let place = Placement::at([at as f32 - 2.0, 3.0, -3.0]);
        stage.scene.spawn(stage.people, place).expect("room");
        stage.scene.spawn(stage.rocks, place).expect("room");
    }
    while stage.scene.waiting() > 0 {
        stage.shot();
    }
    let grown = stage.shot();
    let mut whole = Stage::new(&gpu, &rocks[2], &people[2]);
    for at in 0..5 {
        let place = Placement::at([at as f32 - 2.0, 3.0, -3.0]);
        whole.scene.spawn(whole.people, place).expect("room");
        whole.scene.spawn(whole.rocks, place).expect("room");
    }
    assert!(grown == whole.shot());
}

#[test]
fn attached_meshes_and_another_device_stay_with_the_new_model() {
    let [gpu, other] = devices();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let attach = |stage: &mut Stage| {
        let [rock, walker, _] = stage.instances;
        stage.scene.attach(rock, walker, "0", Transform::IDENTITY).expect("a bone");
    };
    let mut expected = Stage::new(&gpu, &rocks[2], &people[2]);
    attach(&mut expected);
    let expected = expected.shot();
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    attach(&mut stage);
    stage.shot();
    stage.set(&rocks[2], &people[2]);
    assert!(stage.shot() == expected);
    // A device is lost while a new model waits.
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    attach(&mut stage);
    stage.shot();
    stage.scene.set_upload_budget(Some(1000)).expect("a number");
    stage.set(&rocks[2], &people[2]);
    stage.shot();
    stage.scene.rebuild_all(&other, &mut [&mut stage.view, &mut stage.renderer]).expect("rebuilt");
    stage.frame = Frame::plain(&other, SIZE);
    assert!(stage.shot() == expected);
}

#[test]
fn what_views_need_follows_the_camera() {
    let gpu = device();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    let near = stage.scene.wanted(stage.rocks, &[&stage.view]).expect("a camera").expect("seen");
    let from = |z: f32, to: f32| {
        Camera::looking_at(Vec3::new(1.0, 4.0, z), Vec3::new(0.0, 2.0, to), 0.9, [0.5, 4000.0], SIZE)
    };
    stage.view.set(from(90.0, 0.0)).expect("a camera");
    let far = stage.scene.wanted(stage.rocks, &[&stage.view]).expect("a camera").expect("seen");
    assert!(far.error > 8.0 * near.error && far.area < near.area / 50.0, "{near:?} {far:?}");
    // 0.5 pixels at this distance, by the definition of a picture of 128 rows and 0.9 radians.
    let distance = (Vec3::new(1.0, 4.0, 90.0) - Vec3::new(-3.0, 1.0, 0.0)).length();
    let pixel = 2.0 * distance * (0.45_f32).tan() / SIZE[1] as f32;
    let expected = 0.5 * pixel / 1.5;
    assert!((far.error / expected - 1.0).abs() < 0.05, "{} instead of {expected}", far.error);
    stage.view.set(from(90.0, 400.0)).expect("a camera");
    assert_eq!(stage.scene.wanted(stage.rocks, &[&stage.view]).expect("a camera"), None);
    let both = stage.scene.wanted(stage.people, &[]).expect("no view");
    assert_eq!(both, None);
}

#[test]
fn models_that_do_not_follow_are_refused() {
    let gpu = device();
    let (rocks, people) = (&*ROCK, &*CREATURE);
    let mut stage = Stage::new(&gpu, &rocks[0], &people[0]);
    let refused = |result: Result<(), relievo::Error>| result.expect_err("refused").to_string();
    let error = refused(stage.scene.set_model(stage.people, &rocks[1]));
    assert!(error.starts_with("object = a character: must be a mesh"), "{error}");
    let error = refused(stage.scene.set_character_model(stage.rocks, &people[1], &options()));
    assert!(error.starts_with("object = a mesh: must be a character"), "{error}");
    let error = refused(stage.scene.set_character_model(stage.people, &rocks[1], &options()));
    assert!(error.starts_with("model.skeleton"), "{error}");
    let mut other = people[1].clone();
    other.clips.pop();
    let error = refused(stage.scene.set_character_model(stage.people, &other, &options()));
    assert!(error.starts_with("model.clips"), "{error}");
    let none = CharacterOptions::default();
    let error = refused(stage.scene.set_character_model(stage.people, &people[1], &none));
    assert!(error.starts_with("options.layers.len = 0: must be 1"), "{error}");
}
