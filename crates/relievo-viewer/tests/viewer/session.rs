//! A session of 6,000 frames at 320 × 180, after which host and device hold as much memory as before: `make session`.

use std::sync::Arc;
use std::time::Instant;

use egui::{Key, PointerButton, vec2};
use relievo_viewer::Memory;

use crate::controls::CROWD;
use crate::driver::{Driver, creature};
use crate::inputs::SCENE;

/// Frames of the session, of one round of it, and between two measurements.
const FRAMES: usize = 6000;
const ROUND: usize = 600;
const STEP: usize = 20;

/// Largest growth of the program's own memory, and of the device's, over half of the session, as a fraction.
const MOST_HEAP: f64 = 0.002;

/// The same for the process, which includes what the driver keeps.
const MOST_HOST: f64 = 0.02;

/// Bytes of the process's memory, with what the driver keeps.
fn host() -> f64 {
    let text = std::fs::read_to_string("/proc/self/statm").expect("Linux");
    let pages: f64 = text.split(' ').nth(1).expect("resident pages").parse().expect("a number");
    4096.0 * pages
}

/// Bytes that the device's allocator has given out.
fn device(driver: &Driver) -> f64 {
    let report = driver.viewer.gpu().device().generate_allocator_report();
    report.expect("Vulkan's adapters have an allocator").total_allocated_bytes as f64
}

/// The slope of the line that fits points best, and the mean of their heights.
fn fit(points: &[(f64, f64)]) -> [f64; 2] {
    let count = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let [x, y] = [mean(&|point| point.0), mean(&|point| point.1)];
    let both = mean(&|point| (point.0 - x) * (point.1 - y));
    [both / mean(&|point| (point.0 - x).powi(2)), y]
}

/// What somebody does at a frame of a round, while characters walk.
fn act(driver: &mut Driver, frame: usize) {
    match frame {
        0 => {
            let files =
                Memory::default().with("crowd.json", CROWD.as_bytes()).with("creature.rlv", creature());
            driver.viewer.open("crowd.json", Arc::new(files));
        }
        80 | 480 => driver.key(Key::CloseBracket),
        100 | 120 => driver.key(Key::L),
        140 | 180 => driver.key(Key::B),
        200 | 260 => driver.key(Key::C),
        280 | 300 => driver.key(Key::M),
        320 | 340 => driver.key(Key::P),
        360 => {
            let middle = driver.rect("picture").center();
            driver.drag(middle, middle + vec2(30.0, 8.0), PointerButton::Primary);
        }
        380 => driver.key(Key::OpenBracket),
        420 => {
            let scene = SCENE.replace(r#", "path": null"#, "").into_bytes();
            driver.viewer.open("rocks.json", Arc::new(Memory::default().with("rocks.json", scene)));
        }
        500 | 540 => driver.resize(if frame == 500 { [400, 200] } else { [320, 180] }, 1.0),
        560 => driver.key(Key::H),
        _ => {}
    }
}

#[test]
#[ignore = "takes minutes: `make session`"]
fn six_thousand_frames_leave_no_memory_behind() {
    let mut driver = Driver::new([320, 180]);
    driver.paints_all = true;
    let start = Instant::now();
    let mut points = Vec::new();
    let (mut frame, mut done) = (0, 0);
    while frame < FRAMES {
        // Actions take some frames of their own.
        act(&mut driver, frame % ROUND);
        driver.frame();
        // Frames while something is loaded do not count: how many there are depends on the machine.
        while driver.viewer.step().is_some() {
            std::thread::sleep(std::time::Duration::from_millis(1));
            driver.frame();
            done += 1;
        }
        if frame % STEP == 0 {
            points.push([frame as f64, crate::HEAP.current_usage() as f64, host(), device(&driver)]);
        }
        (frame, done) = (frame + 1, done + 1);
    }
    let drawn = driver.shown().stage.world.scene.frames();
    println!("{done} frames in {:.0} s; the last scene drew {drawn}", start.elapsed().as_secs_f64());
    let half = &points[points.len() / 2..];
    for (at, (name, bound)) in
        [("heap", MOST_HEAP), ("host", MOST_HOST), ("device", MOST_HEAP)].into_iter().enumerate()
    {
        // Every round opens and closes the same scenes, so the means of rounds can be compared.
        let rounds: Vec<(f64, f64)> = half
            .chunks(ROUND / STEP)
            .map(|round| {
                let sum: f64 = round.iter().map(|point| point[1 + at]).sum();
                (round[0][0], sum / round.len() as f64)
            })
            .collect();
        let [slope, mean] = fit(&rounds);
        let each: Vec<String> = rounds.iter().map(|round| format!("{:.1}", round.1 / 1e6)).collect();
        let grown = slope * (FRAMES / 2) as f64;
        println!(
            "{name}: mean {:.1} MB, slope {slope:.1} bytes a frame: {:.2} % over 3,000 frames; MB in each round: {each:?}",
            mean / 1e6,
            100.0 * grown / mean
        );
        assert!(grown.abs() < bound * mean, "{name} grows by {grown} bytes of {mean}");
    }
}
