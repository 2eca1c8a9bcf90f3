//! Targets of every kind give the same picture.

use glam::Mat4;
use image::{Rgba, RgbaImage};
use relievo::render::{DepthFormat, Layer, TargetFormat};
use relievo::scene::Camera;
use relievo::wgpu;

use crate::frame::{COLOR, Frame, OTHER, STENCIL, device, reversed};
use crate::harness::{Difference, Tolerance};
use crate::raw::half;
use crate::world::{SIZE, World, camera};

/// Pictures of one adapter through different targets: all but a few pixels on edges are the same.
const SAME: Tolerance = Tolerance { levels: 1, outliers: 0.002, flip: 0.002 };

fn depth(format: wgpu::TextureFormat, reversed: bool) -> TargetFormat {
    TargetFormat { depth: Some(DepthFormat { format, reversed }), ..TargetFormat::new(COLOR) }
}

/// Depth with and without stencil, forward, reversed and infinite. A stencil stays as the program cleared it.
#[test]
fn depth_of_every_kind_hides_the_same() {
    use wgpu::TextureFormat::{Depth16Unorm, Depth24Plus, Depth24PlusStencil8, Depth32Float};
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    let mut view = world.view(1.0);
    let plain = Frame::plain(&gpu, SIZE);
    let renderer = plain.renderer(&gpu, &world.scene);
    let expected = plain.shot(&mut world.scene, &mut view, &renderer);
    assert!(coverage(&expected) > 0.5, "hardly anything is drawn");
    let usual = camera(SIZE);
    let cases = [
        (depth(Depth24Plus, false), usual),
        (depth(Depth24PlusStencil8, false), usual),
        (depth(Depth32Float, true), reversed(usual, 0.5, false)),
        (depth(Depth32Float, true), reversed(usual, 0.5, true)),
        (depth(Depth24PlusStencil8, true), reversed(usual, 0.5, true)),
        // Sixteen bits are few: more pixels on edges differ.
        (depth(Depth16Unorm, false), usual),
    ];
    for (format, camera) in cases {
        let name = format!("{:?}", format.depth);
        let tolerance =
            if name.contains("Depth16") { Tolerance { outliers: 0.02, flip: 0.01, ..SAME } } else { SAME };
        let frame = Frame::new(&gpu, format, SIZE);
        view.set(camera).expect("a camera");
        let renderer = frame.renderer(&gpu, &world.scene);
        let actual = frame.shot(&mut world.scene, &mut view, &renderer);
        let difference = Difference::of(&actual, &expected, tolerance.levels);
        println!("{name}: {difference:?}");
        assert!(difference.within(tolerance), "{name}: {difference:?}");
        let stencil = frame.stencil(&gpu);
        assert_eq!(stencil.is_some(), name.contains("Stencil"), "{name}");
        let is_kept = stencil.is_none_or(|stencil| stencil.iter().all(|texel| *texel == STENCIL));
        assert!(is_kept, "{name}: the stencil changes");
    }
}

/// A camera whose depth runs the other way than the target's is refused, where it would draw nothing or anything.
#[test]
fn depth_that_disagrees_is_refused() {
    let gpu = device();
    let mut world = World::new(&gpu, 1);
    let mut view = world.view(1.0);
    view.set(reversed(camera(SIZE), 0.5, true)).expect("a camera");
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let mut encoder = gpu.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    let mut drawn = Ok(());
    frame.pass(&mut encoder, |pass| drawn = renderer.draw(pass, &world.scene, &view, Layer::Color));
    assert!(drawn.expect_err("refused").to_string().contains("camera.depth"));
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
}

/// Four samples are nearer than one to a picture of four times the width and height, averaged. There is no ground, whose
/// textures have other mip levels in a larger picture.
#[test]
fn four_samples_smooth_edges() {
    let gpu = device();
    let mut world = World::new(&gpu, 10);
    world.scene.set_visible(world.land, false).expect("terrain");
    // Full detail: levels follow the size of the picture.
    let mut view = world.view(0.0);
    let large = SIZE.map(|edge| 4 * edge);
    view.set(camera(large)).expect("a camera");
    let frame = Frame::plain(&gpu, large);
    let renderer = frame.renderer(&gpu, &world.scene);
    let picture = frame.shot(&mut world.scene, &mut view, &renderer);
    let expected = averaged(&picture);
    view.set(camera(SIZE)).expect("a camera");
    let shot = |samples: u32, world: &mut World, view: &mut relievo::scene::View| {
        let frame = Frame::new(&gpu, TargetFormat { samples, ..TargetFormat::new(COLOR) }, SIZE);
        let renderer = frame.renderer(&gpu, &world.scene);
        frame.shot(&mut world.scene, view, &renderer)
    };
    let one = Difference::of(&shot(1, &mut world, &mut view), &expected, 3);
    let four = Difference::of(&shot(4, &mut world, &mut view), &expected, 3);
    println!("one sample {one:?}, four samples {four:?}");
    assert!(four.flip < 0.05 && four.flip < 0.75 * one.flip, "four samples {four:?}, one {one:?}");
}

/// A second attachment is left as the program cleared it.
#[test]
fn other_attachments_are_masked() {
    let gpu = device();
    let mut world = World::new(&gpu, 5);
    let mut view = world.view(1.0);
    let plain = Frame::plain(&gpu, SIZE);
    let renderer = plain.renderer(&gpu, &world.scene);
    let expected = plain.shot(&mut world.scene, &mut view, &renderer);
    let mut format = TargetFormat::new(COLOR);
    format.color.push(Some(wgpu::TextureFormat::Rgba16Float.into()));
    format.color.push(None);
    let frame = Frame::new(&gpu, format, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    assert!(frame.shot(&mut world.scene, &mut view, &renderer) == expected, "another picture");
    // Signs, exponents and fractions of half floats.
    let cleared = [(OTHER.r, 0x3400_u16), (OTHER.g, 0x3800), (OTHER.b, 0x3a00), (OTHER.a, 0x3000)];
    let cleared = cleared.map(|(value, bits)| {
        assert_eq!(value, f64::from(half(bits.to_le_bytes())));
        bits.to_le_bytes()
    });
    let other = frame.other(&gpu, 0);
    assert_eq!(other.len(), 8 * (SIZE[0] * SIZE[1]) as usize);
    let changed = other.chunks_exact(8).filter(|texel| *texel != cleared.as_flattened()).count();
    assert_eq!(changed, 0, "texels of the other attachment change");
}

/// A jittered projection, as for temporal antialiasing, moves the picture by a fraction of a pixel and changes no level.
#[test]
fn a_jittered_camera_is_a_camera() {
    let gpu = device();
    let mut world = World::new(&gpu, 5);
    let mut view = world.view(1.0);
    let usual = camera(SIZE);
    let jitter = Mat4::from_translation(glam::Vec3::new(0.9 / SIZE[0] as f32, -0.9 / SIZE[1] as f32, 0.0));
    let moved = Camera { clip_from_view: jitter * usual.clip_from_view, ..usual };
    let frame = Frame::plain(&gpu, SIZE);
    let renderer = frame.renderer(&gpu, &world.scene);
    let still = frame.shot(&mut world.scene, &mut view, &renderer);
    view.set(moved).expect("a camera");
    let jittered = frame.shot(&mut world.scene, &mut view, &renderer);
    let difference = Difference::of(&jittered, &still, 3);
    assert!(difference.outliers > 0.0 && difference.flip < 0.1, "{difference:?}");
}

/// The mean of every 4 × 4 pixels, in linear light, as samples are resolved.
fn averaged(picture: &RgbaImage) -> RgbaImage {
    RgbaImage::from_fn(picture.width() / 4, picture.height() / 4, |x, y| {
        let texels = (0..16).map(|at| picture.get_pixel(4 * x + at % 4, 4 * y + at / 4));
        let sums = texels.fold([0.0; 3], |sum: [f32; 3], texel| {
            std::array::from_fn(|channel| sum[channel] + relievo::srgb::linear(texel.0[channel]))
        });
        let [r, g, b] = sums.map(|sum| relievo::srgb::byte(sum / 16.0));
        Rgba([r, g, b, 255])
    })
}

/// The fraction of pixels that are not sky.
pub fn coverage(picture: &image::RgbaImage) -> f64 {
    let sky = picture.get_pixel(0, 0);
    picture.pixels().filter(|pixel| *pixel != sky).count() as f64
        / f64::from(picture.width() * picture.height())
}
