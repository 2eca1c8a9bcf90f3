//! Velocities of meshes that are attached to bones.

use glam::{DMat4, DQuat, DVec3};
use relievo::asset::Transform;
use relievo::asset::material::Alpha;
use relievo::scene::{InstanceId, Placement, Scene};

use super::characters::{animated, posed};
use super::{Scenery, camera, scene};
use crate::frame::device;
use crate::rays::{cube, matrix, model, plain};

/// From a mesh's space to the bone's; the second one mirrors.
fn offset(at: usize) -> Transform {
    let side = if at == 1 { -0.5 } else { 0.6 };
    let rotation = glam::Quat::from_rotation_y(0.5 + at as f32).to_array();
    Transform { translation: [1.3 - 2.6 * at as f32, 0.4, 0.5], rotation, scale: [side, 0.5, 0.4] }
}

fn matrix_of(transform: &Transform) -> DMat4 {
    let [scale, at] = [transform.scale, transform.translation].map(|v| DVec3::from(v.map(f64::from)));
    let turn = DQuat::from_array(transform.rotation.map(f64::from)).normalize();
    DMat4::from_scale_rotation_translation(scale, turn, at)
}

/// Where a mesh was in the last frame.
#[derive(Clone, Copy)]
enum Was {
    /// At its bone, or wherever its placement was.
    At(DMat4),
    /// Where it is.
    Here,
}

/// Frames in which a character with two meshes moves by its clip and by its placement, in one of two views: meshes are
/// attached one after the other, and the first is detached while the second stays.
#[test]
fn attached_meshes_move_with_their_bones() {
    let gpu = device();
    let (mut scene, mut view) = scene(&gpu);
    let mut other = scene.view(relievo::scene::Quality::pixels(0.0)).expect("a view");
    other.set(super::moved()).expect("a camera");
    let character = scene.add_character(&animated(), 1).expect("added");
    let solid = scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 2).expect("added");
    let place = |at: f32| Placement::at([-0.6 + at, -0.4, 0.0]).turned(0.3 + at);
    let carrier = scene.spawn(character, place(0.0)).expect("room");
    let free = [Placement::at([1.0, 1.3, -3.0]), Placement::at([-2.4, 0.9, -3.0])].map(|at| at.scaled(0.5));
    let meshes = free.map(|placement| scene.spawn(solid, placement).expect("room"));
    let eye = super::Eye::new(&gpu, &scene);
    eye.frame(&mut scene, &mut view);
    let mut was: [Was; 2] = free.map(|placement| Was::At(matrix(&placement)));
    let (mut time, mut at) = (0.0_f64, 0.0_f32);
    let attach = |scene: &mut Scene, mesh: InstanceId, at: usize| {
        scene.attach(mesh, carrier, "0", offset(at)).expect("a bone");
    };
    let mut held = [false; 2];
    for (frame, (step, way)) in
        [(0.1, 0.0), (0.2, 0.1), (0.15, 0.0), (0.0, -0.1), (0.0, 0.0), (0.2, 0.05), (0.1, 0.0), (0.1, 0.0)]
            .into_iter()
            .enumerate()
    {
        let (last_time, last_at) = (time, at);
        scene.advance(step).expect("finite");
        (time, at) = (time + f64::from(step), at + way);
        scene.move_to(carrier, place(at)).expect("there");
        match frame {
            1 => attach(&mut scene, meshes[1], 1),
            2 => attach(&mut scene, meshes[0], 0),
            5 => {
                scene.detach(meshes[1]).expect("attached");
                was[1] = Was::Here;
            }
            7 => attach(&mut scene, meshes[1], 1),
            _ => {}
        }
        match frame {
            1 | 7 => held[1] = true,
            2 => held[0] = true,
            5 => held[1] = false,
            _ => {}
        }
        let carried = |time: f64, place: &Placement| matrix(place) * posed(time);
        let mut scenery = Scenery { now: Vec::new(), to_last: Vec::new() };
        scenery.add(&cube(), carried(time, &place(at)), carried(last_time, &place(last_at)));
        for mesh in 0..2 {
            let now = match held[mesh] {
                true => carried(time, &place(at)) * matrix_of(&offset(mesh)),
                false => matrix(&free[mesh]),
            };
            let last = match was[mesh] {
                Was::At(last) => last,
                Was::Here => now,
            };
            scenery.add(&cube(), now, last);
            was[mesh] = Was::At(now);
        }
        // Another view of the frame does not change what is kept.
        let found = eye.frames(&mut scene, [&mut view, &mut other]);
        let (seen, largest) = scenery.check(&found, [&camera(), &camera()]);
        println!("frame {frame}: {seen} pixels, at most {largest}");
        assert!(seen > 400 && (largest > 0.005) == (step > 0.0 || way != 0.0), "{seen} pixels, {largest}");
    }
    // A scene that starts afresh has no last frame, and one that goes on has.
    for (step, moves) in [(0.1, false), (0.1, true), (0.0, false)] {
        if step > 0.0 && !moves {
            scene.refresh().expect("afresh");
        }
        scene.advance(step).expect("finite");
        let found = eye.frame(&mut scene, &mut view);
        let most =
            found.iter().filter(|found| found[0] != 7.0).flatten().fold(0.0_f32, |a, b| a.max(b.abs()));
        assert_eq!(most > 1e-3, moves, "{step} s: {most}");
    }
}
