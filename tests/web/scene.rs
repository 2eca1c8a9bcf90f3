//! A scene in the browser: its device is opened without blocking, and its picture equals the native one.

use std::sync::OnceLock;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

use base64::Engine as _;
use image::RgbaImage;
use relievo::gpu::Gpu;
use serde_json::Value;

use crate::harness::{Difference, Tolerance, browser, gpu};
use crate::picture::{SIZE, World};
use crate::wasm;

/// The results of one page load, which all tests of this file examine.
fn said() -> &'static Value {
    static SAID: OnceLock<Value> = OnceLock::new();
    SAID.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let start = Instant::now();
        wasm::scene(folder.path()).expect("the scene compiles for browsers");
        let built = start.elapsed().as_secs_f32();
        let read = |name: &str| std::fs::read(folder.path().join(name)).expect("written");
        let (script, program) = (read("scene.js"), read("scene_bg.wasm"));
        let files = [
            ("/", include_bytes!("scene.html").as_slice()),
            ("/scene.js", script.as_slice()),
            ("/scene_bg.wasm", program.as_slice()),
        ];
        let browser = browser::program().expect("the suite needs a browser");
        let result = browser::visit(&browser, &files, Duration::from_secs(240)).expect("a result");
        println!(
            "built in {built:.1} s, {} bytes of WebAssembly; {} s; all {:.1} s",
            program.len(),
            result["seconds"],
            start.elapsed().as_secs_f32()
        );
        result
    })
}

fn picture(name: &str) -> RgbaImage {
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let text = said[name].as_str().expect("pixels");
    let pixels = base64::prelude::BASE64_STANDARD.decode(text).expect("base64");
    RgbaImage::from_raw(SIZE[0], SIZE[1], pixels).expect("of that size")
}

/// Drives work that awaits the device.
fn driven<T>(gpu: &Gpu, work: impl Future<Output = T>) -> T {
    let mut work = std::pin::pin!(work);
    loop {
        match work.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(done) => return done,
            Poll::Pending => gpu.wait().expect("the device answers"),
        }
    }
}

fn native() -> RgbaImage {
    let gpu = gpu();
    let drawn = async { World::new(&gpu, false).await?.draw(&gpu).await };
    let pixels = driven(&gpu, drawn).expect("drawn");
    RgbaImage::from_raw(SIZE[0], SIZE[1], pixels).expect("of that size")
}

#[test]
fn a_scene_in_the_browser_equals_the_native_one_and_another_light_does_not() {
    let (native, browser, evening) = (native(), picture("day"), picture("evening"));
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("web-scene");
    std::fs::create_dir_all(&folder).expect("writable");
    for (name, picture) in [("native", &native), ("browser", &browser), ("evening", &evening)] {
        picture.save(folder.join(format!("{name}.png"))).expect("writable");
    }
    let tolerance = Tolerance::IMAGE;
    let difference = Difference::of(&browser, &native, tolerance.levels);
    println!("{difference:?}; see {}", folder.display());
    assert!(difference.within(tolerance), "{difference:?}; see {}", folder.display());
    let fault = Difference::of(&evening, &native, tolerance.levels);
    assert!(!fault.within(tolerance), "another light passes: {fault:?}");
}

/// A browser tells errors only after the call, and then to whoever asks.
#[test]
fn a_browser_tells_a_mistake_late_and_the_device_goes_on() {
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let said: Vec<&str> = (said["mistake"].as_array().expect("three lines").iter())
        .map(|line| line.as_str().expect("text"))
        .collect();
    assert_eq!((said[0], said[2]), ("nothing", "[1, 7]"));
    assert!(said[1].contains("wgpu refused a call"), "{}", said[1]);
}
