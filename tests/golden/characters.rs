//! Several characters in one picture, near and far: seen, as fine as the view needs, skinned and drawn together.

use glam::{Vec3, camera::rh};
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::skinning::{add_levels, poses_of};
use relievo::scene::{ObjectId, Placement, Play, Quality, Scene, View};
use relievo_samples::creature;

use crate::figure::figure;
use crate::harness::{Tolerance, check_golden, gpu};
use crate::stage::{camera, checkered, picture};

const SIZE: [u32; 2] = [176, 112];

/// Adds instances of a character at these places, each at its own time in its clip. Nothing moves.
fn add(scene: &mut Scene, model: &Model, places: &[(Vec3, f32)]) -> ObjectId {
    let object = scene.add_character(model, places.len()).expect("added");
    for (index, (at, turn)) in places.iter().enumerate() {
        let instance = scene.spawn(object, Placement::at(*at).turned(*turn)).expect("room");
        let start = f64::from((index as f32 * 0.618).fract() * model.clips[0].duration());
        scene.play(instance, &Play { start: -start, ..Play::new("0") }).expect("the clip");
    }
    object
}

fn view(scene: &Scene, target: Vec3, pixels: f32) -> View {
    let look = rh::view::look_at_mat4(Vec3::new(-1.0, 2.6, 7.0), target, Vec3::Y);
    let projection = rh::proj::directx::perspective(0.75, 176.0 / 112.0, 0.2, 100.0);
    let mut view = scene.view(Quality::pixels(pixels)).expect("a view");
    view.set(camera(look, projection, SIZE)).expect("a camera");
    view
}

/// The numbers of instances of an object that the last frame drew, level by level, and of clusters that it skinned.
fn counted(scene: &mut Scene, view: &mut View, object: ObjectId) -> (Vec<u32>, u32) {
    let seen = view.statistics().expect("arrived").clone();
    let levels = seen.objects.iter().find(|own| own.object == object).expect("counted").levels.clone();
    let own = scene.statistics().expect("arrived").characters.clone();
    let own = own.iter().find(|own| own.object == object).expect("counted");
    (levels.iter().map(|level| level.instances).collect(), own.clusters)
}

fn check(name: &str, picture: &image::RgbaImage) {
    if let Err(error) = check_golden(name, picture, Tolerance::IMAGE) {
        panic!("{error}");
    }
}

fn levelled(model: Model) -> Model {
    let mut model = checkered(model);
    let poses = poses_of(&model.clips[0]).expect("short");
    add_levels(&mut model, &[0], poses.min(16)).expect("valid");
    model
}

/// Records a frame without drawing.
fn record(gpu: &Gpu, scene: &mut Scene, view: &mut View) {
    gpu.run("frame", |encoder| scene.record(encoder, &mut [view]).expect("recorded")).expect("run");
}

#[test]
fn creatures_and_figures_in_one_picture() {
    let gpu = gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    scene.set_statistics(true).expect("room");
    let all = [levelled(creature().expect("valid")), levelled(figure())];
    let objects = [0, 1].map(|character: usize| {
        let place = |index: usize| {
            // The first row is behind the eye.
            let z = [18.0, 2.0, -3.0, -9.0, -18.0][index / 4];
            let x = (index % 4) as f32 * 2.2 - 3.9 + 1.1 * character as f32;
            (Vec3::new(x, 0.0, z), 0.4 * index as f32)
        };
        add(&mut scene, &all[character], &(0..20).map(place).collect::<Vec<_>>())
    });
    let mut view = view(&scene, Vec3::new(0.5, 0.6, -4.0), 1.0);
    let found = picture(&gpu, &mut scene, &mut view);
    for object in objects {
        let (levels, clusters) = counted(&mut scene, &mut view, object);
        let seen: u32 = levels.iter().sum();
        assert!((10..17).contains(&seen) && clusters > 0, "{levels:?}, {clusters}");
    }
    // Far creatures are coarser than near ones.
    let (levels, _) = counted(&mut scene, &mut view, objects[0]);
    assert!(levels.iter().filter(|instances| **instances > 0).count() > 2, "{levels:?}");
    // No instance moves and the camera stays: once all bones are where they belong, no creature is skinned again. The figures
    // in front turn so far in a frame that their bones are always sampled.
    (0..3).for_each(|_| record(&gpu, &mut scene, &mut view));
    assert_eq!(counted(&mut scene, &mut view, objects[0]).1, 0);
    check("skin_characters", &found);
}

/// Creatures in rows away from the eye, and some behind it, within half a pixel: what is seen is skinned, the near ones in full
/// detail, and one that moves is the only one to be skinned again.
#[test]
fn a_crowd_near_and_far() {
    let gpu = gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    scene.set_statistics(true).expect("room");
    let model = levelled(creature().expect("valid"));
    let place = |index: usize| {
        let (row, column) = (index / 6, index % 6);
        let z = [9.0, 3.0, 0.0, -5.0, -12.0, -22.0][row];
        (Vec3::new(column as f32 * 1.5 - 3.75 + 0.3 * row as f32, 0.0, z), 0.5 * index as f32)
    };
    let crowd = add(&mut scene, &model, &(0..36).map(place).collect::<Vec<_>>());
    let mut view = view(&scene, Vec3::new(0.5, 0.4, -4.0), 0.5);
    let found = picture(&gpu, &mut scene, &mut view);
    let (levels, clusters) = counted(&mut scene, &mut view, crowd);
    let (seen, each) = (levels.iter().sum::<u32>(), model.meshes[0].positions.len().div_ceil(64) as u32);
    assert!((12..34).contains(&seen) && (1..seen).contains(&levels[0]), "{levels:?}");
    assert!(clusters >= levels[0] * each && clusters < seen * each, "{clusters} of {seen} times {each}");
    (0..3).for_each(|_| record(&gpu, &mut scene, &mut view));
    assert_eq!(counted(&mut scene, &mut view, crowd).1, 0);
    let one = scene.instances(crowd).expect("there")[14];
    scene.play(one, &Play { start: -0.3, ..Play::new("0") }).expect("the clip");
    record(&gpu, &mut scene, &mut view);
    let (_, again) = counted(&mut scene, &mut view, crowd);
    assert!(again > 0 && again <= each, "{again} of {each}");
    check("skin_crowd", &found);
}
