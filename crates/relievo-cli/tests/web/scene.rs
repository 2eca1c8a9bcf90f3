//! A scene in the browser: its device is opened without blocking, and its picture equals the native one.

use std::path::Path;
use std::sync::OnceLock;
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

use base64::Engine as _;
use half::f16;
use image::RgbaImage;
use image::imageops::{FilterType, resize};
use relievo::gpu::Gpu;
use serde_json::Value;

use crate::harness::{Difference, Tolerance, browser, gpu};
use crate::picture::{SIZE, World, mistakes};
use crate::shaders;
use relievo_testing::wasm::{Program, QUICK};

/// The results of one page load, which all tests of this file and of `delivery.rs` examine.
pub fn said() -> &'static Value {
    static SAID: OnceLock<Value> = OnceLock::new();
    SAID.get_or_init(|| {
        // The other page at the same time: this one leaves a core idle for most of its time. Its own tests tell its failures.
        std::thread::scope(|scope| {
            let other = scope.spawn(shaders::said);
            let result = visited();
            let _ = other.join();
            result
        })
    })
}

fn visited() -> Value {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let start = Instant::now();
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("web");
    let program = Program { package: "relievo-web-scene", library: "scene", profile: QUICK, target: &target };
    program.build(folder.path()).expect("the scene compiles for browsers");
    let built = start.elapsed().as_secs_f32();
    let read = |name: &str| std::fs::read(folder.path().join(name)).expect("written");
    let (script, program) = (read("scene.js"), read("scene_bg.wasm"));
    let server = crate::delivery::host().base();
    let files = [
        ("/server", server.as_bytes()),
        ("/", include_bytes!("scene.html").as_slice()),
        ("/scene.js", script.as_slice()),
        ("/scene_bg.wasm", program.as_slice()),
    ];
    let browser = browser::program().expect("the suite needs a browser");
    let result = browser::visit(&browser, &files, Duration::from_secs(600)).expect("a result");
    println!(
        "built in {built:.1} s, {} bytes of WebAssembly; {} s; all {:.1} s",
        program.len(),
        result["seconds"],
        start.elapsed().as_secs_f32()
    );
    result
}

fn picture(name: &str) -> RgbaImage {
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let text = said[name].as_str().expect("pixels");
    let pixels = base64::prelude::BASE64_STANDARD.decode(text).expect("base64");
    reduced(pixels)
}

/// Half the size, since triangles have jagged edges with one sample a pixel.
fn reduced(pixels: Vec<u8>) -> RgbaImage {
    let picture = RgbaImage::from_raw(SIZE[0], SIZE[1], pixels).expect("of that size");
    resize(&picture, SIZE[0] / 2, SIZE[1] / 2, FilterType::Triangle)
}

/// Drives work that awaits the device, and that may move to another thread meanwhile.
fn driven<T>(gpu: &Gpu, work: impl Future<Output = T> + Send) -> T {
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
    reduced(driven(&gpu, drawn).expect("drawn"))
}

fn native_of_file() -> RgbaImage {
    let gpu = gpu();
    let drawn = async { World::of_file(&gpu).await?.draw(&gpu).await };
    reduced(driven(&gpu, drawn).expect("drawn"))
}

/// The fraction of pixels with a channel beyond those of the 9 pixels around its place in the other picture, by more than
/// `levels`.
fn foreign(actual: &RgbaImage, expected: &RgbaImage, levels: u8) -> f64 {
    let (width, height) = expected.dimensions();
    let is_foreign = |x: u32, y: u32, channel: usize| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        let around =
            || rows.clone().flat_map(|y| columns.clone().map(move |x| expected.get_pixel(x, y).0[channel]));
        let (low, high) = (around().min().unwrap_or(0), around().max().unwrap_or(u8::MAX));
        !(low.saturating_sub(levels)..=high.saturating_add(levels))
            .contains(&actual.get_pixel(x, y).0[channel])
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let found = pixels.filter(|(x, y)| (0..3).any(|channel| is_foreign(*x, *y, channel))).count();
    found as f64 / f64::from(width * height)
}

/// How far pictures of two drivers may differ. A pixel beyond 3 levels lies on an edge of a triangle, a brick or a shadow,
/// which the drivers place otherwise by a fraction of a pixel: its colours are then among those around it. lavapipe and
/// SwiftShader have 0.5 % such pixels without the reduction; where both sides are SwiftShader, no pixel differs at all.
const TOLERANCE: Tolerance = Tolerance { levels: 3, outliers: 0.01, flip: 0.01 };

/// The largest fraction of pixels with colours that are not among those around them: details finer than a pixel. lavapipe
/// and SwiftShader have 0.04 % in a picture of a quarter of the pixels, and another light has 45 %.
const FOREIGN: f64 = 0.001;

#[test]
fn a_scene_in_the_browser_equals_the_native_one_and_another_light_does_not() {
    let (native, browser, evening) = (native(), picture("day"), picture("evening"));
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("web-scene");
    std::fs::create_dir_all(&folder).expect("writable");
    for (name, picture) in [("native", &native), ("browser", &browser), ("evening", &evening)] {
        picture.save(folder.join(format!("{name}.png"))).expect("writable");
    }
    let compared = |picture: &RgbaImage| {
        let difference = Difference::of(picture, &native, TOLERANCE.levels);
        (difference, foreign(picture, &native, TOLERANCE.levels))
    };
    let (difference, beyond) = compared(&browser);
    println!("{difference:?}, {beyond} foreign; see {}", folder.display());
    assert!(difference.within(TOLERANCE), "{difference:?}; see {}", folder.display());
    assert!(beyond <= FOREIGN, "{beyond} foreign; see {}", folder.display());
    let (difference, beyond) = compared(&evening);
    println!("another light: {difference:?}, {beyond} foreign");
    assert!(
        !difference.within(TOLERANCE) && beyond > FOREIGN,
        "another light passes: {difference:?}, {beyond}"
    );
}

/// Saves both pictures, compares them, and compares another scene of the page, which is refused.
fn assert_alike(name: &str, native: &RgbaImage) {
    let browser = picture(name);
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("web-scene");
    std::fs::create_dir_all(&folder).expect("writable");
    for (side, picture) in [("native", native), ("browser", &browser)] {
        picture.save(folder.join(format!("{name}-{side}.png"))).expect("writable");
    }
    let difference = Difference::of(&browser, native, TOLERANCE.levels);
    let beyond = foreign(&browser, native, TOLERANCE.levels);
    println!("{difference:?}, {beyond} foreign; see {}", folder.display());
    assert!(difference.within(TOLERANCE), "{difference:?}; see {}", folder.display());
    assert!(beyond <= FOREIGN, "{beyond} foreign; see {}", folder.display());
    let other = picture("day");
    assert!(!Difference::of(&other, native, TOLERANCE.levels).within(TOLERANCE), "another scene passes");
}

#[test]
fn the_scene_of_a_file_in_the_browser_equals_the_native_one() {
    assert_alike("file", &native_of_file());
}

#[test]
fn endless_terrain_in_the_browser_equals_the_native_one() {
    let gpu = gpu();
    let drawn = async { World::endless(&gpu).await?.draw(&gpu).await };
    assert_alike("endless", &reduced(driven(&gpu, drawn).expect("drawn")));
}

/// The meadow, after its frames.
async fn meadow(gpu: &Gpu) -> Result<(World, Vec<u8>), relievo::Error> {
    let mut world = World::meadow(gpu).await?;
    let pixels = world.draw(gpu).await?;
    Ok((world, pixels))
}

/// A kind of the caller's: grass, whose text is composed in the browser, is that which is drawn natively, with the shadows that
/// it casts and receives.
#[test]
fn a_kind_of_the_callers_in_the_browser_equals_the_native_one() {
    let gpu = gpu();
    let (_, pixels) = driven(&gpu, meadow(&gpu)).expect("drawn");
    assert_alike("kind", &reduced(pixels));
}

/// Velocities in pixels of the picture, from two 16-bit floats a pixel in units of the picture's size.
fn velocities(bytes: &[u8]) -> Vec<[f32; 2]> {
    let value = |at: &[u8]| f16::from_le_bytes([at[0], at[1]]).to_f32();
    bytes.as_chunks::<4>().0.iter().map(|pixel| [value(&pixel[..2]), value(&pixel[2..])]).collect()
}

#[test]
fn a_kind_of_the_callers_moves_in_the_browser_as_natively() {
    let gpu = gpu();
    let native = async { meadow(&gpu).await?.0.velocities(&gpu).await };
    let native = velocities(&driven(&gpu, native).expect("drawn"));
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let text = said["velocities"].as_str().expect("velocities");
    let browser = velocities(&base64::prelude::BASE64_STANDARD.decode(text).expect("base64"));
    let moves = |velocity: &[f32; 2]| velocity[0].abs().max(velocity[1].abs()) > 1e-4;
    let moving = native.iter().filter(|velocity| moves(velocity)).count();
    assert_eq!(browser.len(), native.len());
    // The drivers place edges otherwise: pixels there are of something else.
    let other = |far: f32| {
        let pairs = native.iter().zip(&browser);
        pairs.filter(|(a, b)| (0..2).any(|axis| (a[axis] - far * b[axis]).abs() > 1e-4)).count()
    };
    println!("{moving} pixels move, {} differ, {} from still ones", other(1.0), other(0.0));
    assert!(moving > 2_000 && other(1.0) < moving / 20 && other(0.0) >= moving, "{moving}, {}", other(1.0));
}

#[test]
fn a_kind_of_the_callers_is_picked_and_its_mistakes_are_told_in_the_browser() {
    let gpu = gpu();
    let native = async { meadow(&gpu).await?.0.picked() };
    let native = [driven(&gpu, native).expect("picked"), mistakes()].concat();
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let lines = said["kind_lines"].as_array().expect("lines").iter();
    let lines: Vec<&str> = lines.map(|line| line.as_str().expect("text")).collect();
    assert_eq!(lines, native);
    let hits = |object: &str| lines.iter().filter(|line| line.starts_with(object)).count();
    println!("{} of the floor, {} of the grass; {:?}", hits("1 "), hits("2 "), &lines[48..]);
    assert!(hits("2 ") > 2, "the grass is hit");
    assert!(lines[48..].len() == 3 && lines[48..].iter().all(|line| line.contains("kind:")), "{lines:?}");
}

/// Levels that were made beforehand are those that the browser would make.
#[test]
fn meshes_are_simplified_alike_in_the_browser() {
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let hashes: Vec<&str> =
        said["hashes"].as_array().expect("a list").iter().filter_map(|hash| hash.as_str()).collect();
    let native: Vec<String> = crate::alike::hashes().into_iter().chain(crate::alike::reduced()).collect();
    assert_eq!(hashes, native);
    assert!(hashes.len() == 10 && hashes.iter().all(|hash| hash.len() >= 64), "{hashes:?}");
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

/// Kernels equal their references on the browser's device too.
#[test]
fn kernels_equal_their_references_in_the_browser() {
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let all = said["parity"].as_object().expect("an operation each");
    assert_eq!(all.len(), 6);
    for (operation, result) in all {
        let lines: Vec<&str> =
            result.as_array().expect("lines").iter().filter_map(|line| line.as_str()).collect();
        let cases: u32 = lines[0].parse().expect("a number");
        println!("{operation}: {cases} cases");
        assert!(cases > 3 && lines.len() == 1, "{operation}: {lines:?}");
    }
}
