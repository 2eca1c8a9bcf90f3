//! What the test programs share: the adapter, goldens with blessing, and reports of failed images.

pub mod browser;
mod devices;
pub mod shader;
pub mod wasm;

pub use devices::Devices;

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use image::{DynamicImage, RgbaImage};
use relievo::gpu::{AdapterSummary, Gpu, Options, adapters};
use relievo::ops::surface::map;

/// The folder of the workspace, where `goldens/`, `docs/` and `tests/` are.
pub fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

/// A device for a test, of the suite's adapter: see [`Devices`].
pub fn gpu() -> Gpu {
    static DEVICES: Devices = Devices::new(new_gpu);
    DEVICES.of_thread()
}

/// Whether the suite's adapter rounds vertices to a sixteenth of a pixel, the coarsest step that Vulkan allows, and clips triangles
/// at the border of the picture. Others round to a 256th, and clip far outside.
pub fn is_coarse() -> bool {
    ADAPTER.get().is_some_and(|name| name.contains("SwiftShader"))
}

/// A device of the suite's adapter: for tests that lose it, or count its memory. A missing adapter is a failure, and so is one other
/// than `RELIEVO_ADAPTER` names.
pub fn new_gpu() -> Gpu {
    let gpu = Gpu::headless(&Options::default())
        .expect("the suite needs a Vulkan adapter: `make test` installs one");
    assert_adapter(gpu.adapter());
    println!("adapter: {}", gpu.adapter());
    gpu
}

/// The name of the suite's adapter, once it is known.
static ADAPTER: OnceLock<String> = OnceLock::new();

fn assert_adapter(adapter: &AdapterSummary) {
    ADAPTER.get_or_init(|| adapter.name.clone());
    if let Ok(wanted) = std::env::var("RELIEVO_ADAPTER") {
        let text = adapter.to_string().to_lowercase();
        assert!(text.contains(&wanted.to_lowercase()), "{adapter} is not the adapter `{wanted}`");
    }
}

/// The suite's adapter as another program finds it: in an instance of its own. GL is left out, as [`adapters`] leaves it out.
pub fn foreign_adapter() -> (wgpu::Instance, wgpu::Adapter) {
    let name = gpu().adapter().name.clone();
    let backends = wgpu::Backends::all() - wgpu::Backends::GL;
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let all = pollster::block_on(instance.enumerate_adapters(backends));
    let adapter = all.into_iter().find(|adapter| adapter.get_info().name == name).expect("still there");
    (instance, adapter)
}

/// A device whose storage bindings hold no more than `bytes`.
pub fn gpu_of_bindings(bytes: u64) -> Gpu {
    let (_, adapter) = foreign_adapter();
    let limits = wgpu::Limits { max_storage_buffer_binding_size: bytes, ..Default::default() };
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).expect("a device");
    Gpu::from_wgpu(device, queue)
}

/// Goldens that `relievo demo` draws: B's figures, of seamless grids, of both weight modes, and of every kind of relief.
pub const DEMO_VIEWS: &[&str] = &[
    "textured",
    "grid",
    "mountains",
    "wireframe",
    "step_1",
    "step_2",
    "step_5",
    "valley_1",
    "valley_2",
    "valley_3",
    "additive",
    "thermal",
    "uneroded",
    "eroded",
    "blend",
    "relief_bricks",
    "relief_close_plain",
    "relief_close_parallax",
    "relief_close_relief",
    "relief_text",
    "relief_posts_lost",
    "relief_posts_cone",
    "relief_cobbles",
    "relief_grazing",
    "relief_clamp",
];

/// Maps have one pixel per sample; these are the maps that fit the size of a golden.
pub const DEMO_MAPS: &[&str] = &["step_5_map", "valley_1_map"];

/// How an image may differ from its golden, and why.
#[derive(Debug, Clone, Copy)]
pub struct Tolerance {
    /// The largest difference of a channel, in levels of 255.
    pub levels: u8,
    /// The fraction of pixels that may differ by more: rasterizers may disagree about which triangle owns a
    /// pixel on an edge.
    pub outliers: f64,
    /// The largest mean FLIP.
    pub flip: f32,
}

impl Tolerance {
    /// The tolerance of drawn pictures: drivers round colours differently and disagree about pixels on edges.
    pub const IMAGE: Self = Self { levels: 3, outliers: 0.02, flip: 0.01 };

    /// The tolerance on the suite's adapter. Where it [`is_coarse`], pixels on the edges of triangles may differ by half as much again.
    pub fn here(self) -> Self {
        let factor = if is_coarse() { 1.5 } else { 1.0 };
        Self { outliers: f64::from(factor) * self.outliers, flip: factor * self.flip, ..self }
    }
}

/// The result of a comparison of images.
#[derive(Debug, Clone, Copy)]
pub struct Difference {
    /// The largest difference of a channel, in levels of 255.
    pub worst: u8,
    /// The fraction of pixels that differ by more than was permitted.
    pub outliers: f64,
    /// The mean FLIP.
    pub flip: f32,
}

impl Difference {
    /// Compares images of one size; pixels that differ by more than `levels` are outliers.
    pub fn of(actual: &RgbaImage, expected: &RgbaImage, levels: u8) -> Self {
        let distance = |(a, b): (&image::Rgba<u8>, &image::Rgba<u8>)| {
            a.0.iter().zip(b.0).map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0)
        };
        let distances: Vec<u8> = actual.pixels().zip(expected.pixels()).map(distance).collect();
        let over = distances.iter().filter(|distance| **distance > levels).count();
        Self {
            worst: distances.iter().copied().max().unwrap_or(0),
            outliers: over as f64 / distances.len().max(1) as f64,
            flip: flip(actual, expected),
        }
    }

    /// Compares an image with its golden. Beside another driver than lavapipe, FLIP leaves out pixels within one level: goldens are
    /// lavapipe's, whose sRGB differs from other drivers' in the last level of half of all pixels, which is a FLIP of 0.015.
    pub fn of_golden(actual: &RgbaImage, golden: &RgbaImage, levels: u8) -> Self {
        let own = Self::of(actual, golden, levels);
        if ADAPTER.get().is_none_or(|name| name.contains("llvmpipe")) {
            return own;
        }
        let mut seen = actual.clone();
        for (pixel, golden) in seen.pixels_mut().zip(golden.pixels()) {
            if pixel.0.iter().zip(golden.0).all(|(own, other)| own.abs_diff(other) <= 1) {
                *pixel = *golden;
            }
        }
        Self { flip: flip(&seen, golden), ..own }
    }

    /// Whether the difference is within a tolerance.
    pub fn within(&self, tolerance: Tolerance) -> bool {
        self.outliers <= tolerance.outliers && self.flip <= tolerance.flip
    }
}

fn flip(actual: &RgbaImage, expected: &RgbaImage) -> f32 {
    let convert = |image: &RgbaImage| {
        let rgb = image::DynamicImage::ImageRgba8(image.clone()).into_rgb8();
        nv_flip::FlipImageRgb8::with_data(rgb.width(), rgb.height(), rgb.as_raw())
    };
    let map = nv_flip::flip(convert(expected), convert(actual), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
    nv_flip::FlipPool::from_image(&map).mean()
}

/// Whether this run writes goldens, which only `make bless` does.
pub fn blessing() -> bool {
    blesses(std::env::var_os("RELIEVO_BLESS").as_deref())
}

/// Whether a value of `RELIEVO_BLESS` blesses: not when it is empty or 0.
pub fn blesses(value: Option<&std::ffi::OsStr>) -> bool {
    value.is_some_and(|value| !value.is_empty() && value != "0")
}

fn goldens() -> PathBuf {
    root().join("goldens")
}

/// Compares an image with its golden. Writing a golden counts as a failure, so that the run that writes one
/// never passes.
pub fn check_golden(name: &str, actual: &RgbaImage, tolerance: Tolerance) -> Result<Difference, String> {
    check_golden_in(&goldens(), name, actual, tolerance, blessing())
}

/// Reads a picture of at most 8192 × 8192 pixels. The decoders of the crate `image` are generic: `image::open` compiles them for each
/// program that calls it.
///
/// # Panics
/// If there is no such picture.
pub fn picture(path: impl AsRef<Path>) -> DynamicImage {
    map::open(path.as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// [`check_golden`] in any folder, blessing or not.
pub fn check_golden_in(
    folder: &Path,
    name: &str,
    actual: &RgbaImage,
    tolerance: Tolerance,
    bless: bool,
) -> Result<Difference, String> {
    let path = folder.join(format!("{name}.png"));
    if bless {
        actual.save(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let bytes = std::fs::metadata(&path).map(|data| data.len()).unwrap_or(0);
        return Err(match bytes {
            0..=65_536 => format!("{name}: blessed; look at it, and run `make test`"),
            _ => format!("{name}: {bytes} bytes: a golden has at most 65536"),
        });
    }
    let expected = match map::open(&path) {
        Ok(image) => image.into_rgba8(),
        Err(error) => return Err(format!("{name}: no golden ({error}); {}", report(name, actual, None))),
    };
    if expected.dimensions() != actual.dimensions() {
        let sizes = format!("{:?} instead of {:?}", actual.dimensions(), expected.dimensions());
        return Err(format!("{name}: {sizes}; {}", report(name, actual, Some(&expected))));
    }
    let tolerance = tolerance.here();
    let difference = Difference::of_golden(actual, &expected, tolerance.levels);
    if difference.within(tolerance) {
        return Ok(difference);
    }
    Err(format!("{name}: {difference:?} exceeds {tolerance:?}; {}", report(name, actual, Some(&expected))))
}

/// Writes actual, expected and difference images, and says where.
fn report(name: &str, actual: &RgbaImage, expected: Option<&RgbaImage>) -> String {
    let folder = root().join("target/image-reports");
    let write = |kind: &str, image: &RgbaImage| {
        let path = folder.join(format!("{name}.{kind}.png"));
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        image.save(&path).map_err(|error| error.to_string())?;
        Ok::<_, String>(path.display().to_string())
    };
    let mut written = vec![write("actual", actual)];
    if let Some(expected) = expected {
        written.push(write("expected", expected));
        if expected.dimensions() == actual.dimensions() {
            written.push(write("difference", &amplified(actual, expected)));
        }
    }
    let written: Vec<_> = written.into_iter().map(|path| path.unwrap_or_else(|error| error)).collect();
    format!("see {}", written.join(", "))
}

/// The difference of two images, amplified eight times.
fn amplified(actual: &RgbaImage, expected: &RgbaImage) -> RgbaImage {
    let mut image = actual.clone();
    for (pixel, expected) in image.pixels_mut().zip(expected.pixels()) {
        for (channel, expected) in pixel.0[..3].iter_mut().zip(expected.0) {
            *channel = channel.abs_diff(expected).saturating_mul(8);
        }
        pixel.0[3] = 255;
    }
    image
}

/// The list of adapters, for messages.
pub fn all_adapters() -> String {
    adapters().iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
}
