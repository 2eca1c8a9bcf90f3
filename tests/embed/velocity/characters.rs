//! Velocities of characters: by their clips, their placements, and where they come, go and stop.

use glam::{DMat4, DQuat, DVec3, Quat, Vec3};
use relievo::asset::clip::{BoneKeys, Interpolation, Keys};
use relievo::asset::material::Alpha;
use relievo::asset::{Clip, Model};
use relievo::scene::{Camera, Placement, Quality};

use super::{Eye, SIZE, Scenery, camera, scene};
use crate::frame::device;
use crate::rays::{cube, matrix, model, plain};

/// A cube at one bone, which a clip moves, turns and stretches.
pub(super) fn animated() -> Model {
    let mut model = model(&cube(), plain([1.0; 4], Alpha::Opaque), false);
    let turn = |angle: f32| Quat::from_rotation_z(angle).to_array();
    let vector = |x: f32, y: f32| [x, y, 0.0, 0.0];
    let keys = |values: Vec<[f32; 4]>| {
        Some(Keys { interpolation: Interpolation::Linear, times: vec![0.0, 1.0, 2.0], values })
    };
    let bone = BoneKeys {
        translation: keys(vec![vector(0.0, 0.0), vector(1.0, 0.5), vector(1.0, 0.5)]),
        rotation: keys(vec![turn(0.0), turn(0.6), turn(0.6)]),
        scale: None,
    };
    model.clips = vec![Clip::new("move", &model.skeleton, &[bone], 2.0).expect("valid")];
    model
}

/// The bone's transform at a time of the clip.
pub(super) fn posed(time: f64) -> DMat4 {
    let part = time.min(1.0);
    DMat4::from_rotation_translation(DQuat::from_rotation_z(0.6 * part), DVec3::new(part, 0.5 * part, 0.0))
}

/// A character moves by its clip and by its placement, stops, and moves again.
#[test]
fn characters_move() {
    let gpu = device();
    let (mut scene, mut view) = scene(&gpu);
    let object = scene.add_character(&animated(), 2).expect("added");
    let place = |at: f32| Placement::at([-1.0 + at, 0.0, 0.0]).turned(0.3);
    let instance = scene.spawn(object, place(0.0)).expect("room");
    // A second one, so that pages and lists are no single ones.
    let other = Placement::at([3.0, 2.0, -5.0]);
    scene.spawn(object, other).expect("room");
    let eye = Eye::new(&gpu, &scene);
    eye.frame(&mut scene, &mut view);
    let (mut time, mut at) = (0.0_f64, 0.0_f32);
    // Seconds, and how far the placement moves: pose and placement, pose alone, placement alone, nothing; at the end the
    // clip stands still while the time goes on, and the last step leaves its end.
    for (step, way) in
        [(0.3, 0.2), (0.25, 0.0), (0.0, -0.1), (0.0, 0.0), (0.5, 0.0), (0.2, 0.0), (0.2, 0.0), (0.2, 0.1)]
    {
        let (last_time, last_at) = (time, at);
        scene.advance(step).expect("finite");
        time += f64::from(step);
        at += way;
        if way != 0.0 {
            scene.move_to(instance, place(at)).expect("there");
        }
        let mut scenery = Scenery { now: Vec::new(), to_last: Vec::new() };
        scenery.add(&cube(), matrix(&place(at)) * posed(time), matrix(&place(last_at)) * posed(last_time));
        scenery.add(&cube(), matrix(&other) * posed(time), matrix(&other) * posed(last_time));
        let found = eye.frame(&mut scene, &mut view);
        let (seen, largest) = scenery.check(&found, [&camera(), &camera()]);
        println!("{step} s: {seen} pixels, at most {largest}");
        let moves = way != 0.0 || last_time < 1.0 && step > 0.0;
        assert!(seen > 300 && (largest > 0.005) == moves, "{seen} pixels, {largest}");
    }
}

/// Instances that are spawned, or come back into view, do not bring another's last positions with them, and a crowd that
/// stops stands still, whatever its levels of detail.
#[test]
fn what_was_not_there_stood_still() {
    let gpu = device();
    let (mut scene, mut view) = scene(&gpu);
    let object = scene.add_character(&crate::world::model(), 40).expect("added");
    let eye = Eye::new(&gpu, &scene);
    let place = |at: usize| Placement::at([(at % 8) as f32 - 3.5, -1.0, 2.0 - (at / 8) as f32 * 3.0]);
    let mut crowd: Vec<_> = (0..20).map(|at| scene.spawn(object, place(at)).expect("room")).collect();
    let largest = |found: &[[f32; 2]]| {
        let seen = found.iter().filter(|found| found[0] != 7.0);
        seen.flatten().fold(0.0_f32, |largest, value| largest.max(value.abs()))
    };
    // Time stands still while instances come and go, and a camera looks away: nothing moves.
    for at in 0..12 {
        let instance = crowd.remove(at % 3);
        scene.despawn(instance).expect("there");
        crowd.push(scene.spawn(object, place(20 + at)).expect("room"));
        let away =
            Camera::looking_at(Vec3::new(0.0, 3.0, 9.0), Vec3::new(0.0, 3.0, 90.0), 0.7, [0.5, 60.0], SIZE);
        view.set(if at == 4 { away } else { camera() }).expect("a camera");
        // In the last frames levels of detail and fades change: what is drawn then moves by up to four pixels.
        let pixels = if at > 7 && at % 2 == 0 { 4.0 } else { 0.0 };
        view.set_quality(Quality::pixels(pixels)).expect("a number");
        let found = eye.frame(&mut scene, &mut view);
        let most = if at > 7 { 4.0 / SIZE[1] as f32 } else { 2e-6 };
        // The camera turned away and back.
        let turned = [4, 5].contains(&at);
        assert!(turned || largest(&found) <= most, "frame {at}: {}", largest(&found));
        assert!(at == 4 || found.iter().any(|found| found[0] != 7.0), "frame {at} is empty");
    }
    // They walk, and then they stop.
    view.set_quality(Quality::pixels(0.0)).expect("a number");
    eye.frame(&mut scene, &mut view);
    for (step, moves) in [(0.1, true), (0.1, true), (0.0, false), (0.0, false), (0.1, true)] {
        scene.advance(step).expect("finite");
        let most = largest(&eye.frame(&mut scene, &mut view));
        println!("{step} s: at most {most}");
        assert_eq!(most > 1e-3, moves, "{step} s: {most}");
        assert!(moves || most < 2e-6, "{most} after a stop");
    }
}
