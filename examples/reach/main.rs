//! A creature waves, and its left hand stays on a ball that circles beside it: inverse kinematics on two bones, on top of a
//! clip. Prints where the device has the hand. `cargo run --example reach`

mod two_bones;

use glam::DVec3;
use relievo::gpu::{Gpu, Options};
use relievo::scene::{Camera, InstanceBone, Placement, Play, Quality, Scene};
use relievo_samples::creature;
use two_bones::Limb;

const ARM: [&str; 3] = ["upper_arm_left", "forearm_left", "hand_left"];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::headless(&Options::default())?;
    let mut scene = Scene::new(&gpu)?;
    let object = scene.add_character(&creature()?, 1)?;
    let waver = scene.spawn(object, Placement::at_world([100.0, 0.0, -40.0]))?;
    scene.play(waver, &Play::new("wave"))?;

    // The arm, once: its bones by index, and which of them the program drives.
    let [upper, lower, end] = ARM.map(|name| scene.bone(waver, name));
    let arm = Limb { upper: upper?, lower: lower?, end: end? };
    scene.drive(waver, &ARM[..2])?;
    scene.watch_bones(&[InstanceBone { instance: waver, bone: ARM[2] }])?;

    let mut eye = scene.view(Quality::default())?;
    let foot = scene.placement(waver)?.world();
    eye.set(Camera::looking_at_world(foot + DVec3::new(0.0, 1.5, 5.0), foot, 0.8, [0.1, 100.0], [640, 480]))?;
    for frame in 0..10 {
        scene.advance(0.1)?;
        let turn = 0.6 * f64::from(frame);
        let shoulder = scene.pose(waver)?.world(arm.upper)?;
        let ball = shoulder + DVec3::new(0.2, -0.1 + 0.1 * turn.sin(), 0.2 + 0.1 * turn.cos());

        let mut pose = scene.pose(waver)?;
        arm.reach(&mut pose, ball)?;
        let mut encoder = gpu.device().create_command_encoder(&Default::default());
        scene.record_with(&mut encoder, &mut [&mut eye], |encoder, poses| {
            poses.write(encoder, waver, arm.upper, pose.local(arm.upper)?)?;
            poses.write(encoder, waver, arm.lower, pose.local(arm.lower)?)
        })?;
        gpu.queue().submit([encoder.finish()]);
        gpu.wait()?;

        let hand = scene.watched_bones().ok_or("no frame has arrived")?.bones[0].world();
        println!("the ball at {ball:.3}, the hand {:.5} m away", hand.distance(ball));
    }
    Ok(())
}
