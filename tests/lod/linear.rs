//! The time of choosing levels by the number of instances.

use std::time::Instant;

use glam::Vec3;
use relievo::scene::{Camera, Criterion, LevelChoice, LevelOfDetail, Placement, Quality, Scene, SizeOf};

use crate::stage::mesh;

/// Frames that are timed.
const FRAMES: usize = 9;

/// The median time of a frame with so many instances in view, in milliseconds.
fn milliseconds(instances: usize, level_of_detail: &LevelOfDetail) -> f64 {
    let gpu = relievo_testing::gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let object = scene.add_mesh(&mesh(), instances).expect("added");
    scene.set_level_of_detail(object, level_of_detail).expect("valid");
    for at in 0..instances {
        let place = [(at % 1000) as f32 * 4.0 - 2000.0, 0.0, -30.0 - (at / 1000) as f32 * 4.0];
        scene.spawn(object, Placement::at(place)).expect("room");
    }
    let mut view = scene.view(Quality::default()).expect("a view");
    let eye = Vec3::new(0.0, 2500.0, 1500.0);
    view.set(Camera::looking_at(eye, Vec3::ZERO, 1.2, [1.0, 20_000.0], [1920, 1080])).expect("a camera");
    let mut times = Vec::new();
    for _ in 0..FRAMES + 2 {
        let start = Instant::now();
        let mut encoder = gpu.encoder("frame");
        scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        times.push(1e3 * start.elapsed().as_secs_f64());
    }
    times.drain(..2);
    times.sort_unstable_by(f64::total_cmp);
    times[times.len() / 2]
}

/// `cargo test --test lod linear -- --ignored --nocapture`
#[test]
#[ignore = "measures time"]
fn the_time_is_linear_in_instances() {
    let size = Criterion::Size { of: SizeOf::Box, below: vec![1e-2, 1e-3, 1e-4, 1e-5] };
    let by_size = LevelOfDetail { choice: LevelChoice::By(size), ..LevelOfDetail::default() };
    let plain = LevelOfDetail { hysteresis: 0.0, ..LevelOfDetail::default() };
    let all =
        [("error", plain), ("error, hysteresis", LevelOfDetail::default()), ("box, hysteresis", by_size)];
    println!("| criterion | 100,000 | 1,000,000 | ns an instance |\n|---|---:|---:|---:|");
    for (name, level_of_detail) in all {
        let [few, many] = [100_000, 1_000_000].map(|count| milliseconds(count, &level_of_detail));
        println!("| {name} | {few:.2} ms | {many:.2} ms | {:.1} |", 1e6 * (many - few) / 900_000.0);
        assert!(many < 13.0 * few, "{name}: {few} and {many} milliseconds");
    }
}
