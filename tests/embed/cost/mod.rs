//! What frames cost, in processor time of the process, which on a software adapter is host and device together. Programs
//! take turns, and ratios are taken round by round. The tests print tables; they are ignored because they take minutes:
//! `cargo test --test embed cost -- --ignored --nocapture --test-threads 1`.

mod clock;
mod crowd;

use std::path::Path;
use std::rc::Rc;

use relievo::asset::Model;
use relievo::gpu::Gpu;

use crate::frame::{Frame, device};
use clock::{Program, table, take_turns};
use crowd::{Crowd, SIZE, Staged};

fn creature() -> Model {
    relievo_samples::creature().expect("valid")
}

/// The creature, and the files that `RELIEVO_MODELS` names.
fn models() -> Vec<(String, Model)> {
    let files = std::env::var_os("RELIEVO_MODELS").unwrap_or_default();
    let file = |path: &Path| (path.display().to_string(), Model::from_file(path).expect("a model"));
    let files = std::env::split_paths(&files).filter(|path| path.is_file());
    [("creature".to_owned(), creature())].into_iter().chain(files.map(|path| file(&path))).collect()
}

fn staged<'a>(name: &str, mut program: Staged) -> Program<'a> {
    Program::new(name, move || program.frame())
}

/// A program that submits nothing.
fn idle<'a>(gpu: &Gpu) -> Program<'a> {
    let gpu = gpu.clone();
    Program::new("an empty submission", move || {
        gpu.queue().submit([gpu.encoder("nothing").finish()]);
        gpu.wait().expect("done");
    })
}

/// Frames in which nothing is in view, nothing moves, or everything is far.
#[test]
#[ignore = "measures"]
fn frames_with_little_to_do_cost_little() {
    let gpu = device();
    let target = Rc::new(Frame::plain(&gpu, SIZE));
    let (near, far) = (Crowd::new(creature(), 100.0), Crowd::new(creature(), 5.0));
    for draws in [true, false] {
        let program = |name: &str, program: Staged| match draws {
            true => staged(name, program.drawing(&target)),
            false => staged(name, program),
        };
        let away = near.camera(SIZE, std::f32::consts::PI);
        let mut all = [
            program("in full detail", Staged::new(&gpu, &near, 0.0)),
            program("within a pixel", Staged::new(&gpu, &near, 1.0)),
            program("nothing in view", Staged::new(&gpu, &near, 1.0).looking(away)),
            program("nothing moves", Staged::new(&gpu, &near, 1.0).still()),
            program("nothing moves, in full detail", Staged::new(&gpu, &near, 0.0).still()),
            program("everything far", Staged::new(&gpu, &far, 1.0)),
            idle(&gpu),
        ];
        take_turns(&mut all);
        println!("{}", table(if draws { "whole frames" } else { "before the drawing" }, &all));
        for frame in [2, 5] {
            assert!(all[frame].against(&all[0])[1] < 0.5, "program {frame}");
        }
    }
}

/// A second view of another size that sees the same instances.
#[test]
#[ignore = "measures"]
fn a_second_view_costs_little() {
    let gpu = device();
    let crowd = Crowd::new(creature(), 100.0);
    let small = crowd.camera([960, 540], 0.0);
    let mut all = [
        staged("one view", Staged::new(&gpu, &crowd, 1.0)),
        staged("two views", Staged::new(&gpu, &crowd, 1.0).with_view(small)),
        staged(
            "four views",
            Staged::new(&gpu, &crowd, 1.0).with_view(small).with_view(small).with_view(small),
        ),
        idle(&gpu),
    ];
    take_turns(&mut all);
    println!("{}", table("before the drawing", &all));
    let [_, ratio, _] = all[1].against(&all[0]);
    assert!(ratio <= 1.3, "{ratio}");
}

/// The shadow of the sun on a crowd and what it stands on.
#[test]
#[ignore = "measures"]
fn what_a_shadow_of_the_sun_costs() {
    let gpu = device();
    let target = Rc::new(Frame::plain(&gpu, SIZE));
    let crowd = Crowd::new(creature(), 100.0);
    let program = |name: &str, size: Option<u32>| {
        staged(name, Staged::new(&gpu, &crowd, 1.0).in_shadow(size, &crowd).drawing(&target))
    };
    let mut all = [
        program("without a shadow", None),
        program("2048 texels", Some(2048)),
        program("4096 texels", Some(4096)),
    ];
    take_turns(&mut all);
    println!("{}", table("whole frames", &all));
    assert!(all[1].against(&all[0])[1] < 3.5, "{:?}", all[1].against(&all[0]));
}

/// Level of detail saves at least three quarters of a frame.
#[test]
#[ignore = "measures"]
fn within_a_pixel_frames_are_cheaper() {
    let gpu = device();
    let target = Rc::new(Frame::plain(&gpu, SIZE));
    let mut failures = Vec::new();
    for (name, model) in models() {
        let crowd = Crowd::new(model, 100.0);
        let mut all = [
            staged("within a pixel", Staged::new(&gpu, &crowd, 1.0).drawing(&target)),
            staged("in full detail", Staged::new(&gpu, &crowd, 0.0).drawing(&target)),
            staged("within a pixel, before the drawing", Staged::new(&gpu, &crowd, 1.0)),
            staged("in full detail, before the drawing", Staged::new(&gpu, &crowd, 0.0)),
        ];
        take_turns(&mut all);
        let gain = all[1].against(&all[0]);
        println!("{}\ncheaper by {gain:.2?}", table(&name, &all));
        if gain[1] < 4.0 {
            failures.push(format!("{name}: {gain:?}"));
        }
    }
    assert!(failures.is_empty(), "{failures:?}");
}
