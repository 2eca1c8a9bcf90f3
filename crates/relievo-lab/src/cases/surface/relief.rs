//! Parity and benchmark cases of `kernels/surface/relief.wgsl`: the functions of `wgsl/surface/` that material shaders import.
//!
//! The benchmark measures each method, on lists of rays and in the fragment pass, against `plain` and against the same number of
//! bare texel loads.

use glam::{Mat4, Vec3, Vec4};
use relievo::asset::Light;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::surface::color::ColorTexture;
use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::mesh::SurfaceMesh;
use relievo::ops::surface::mips::Mips;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::relief::textures::SurfaceTextures;
use relievo::ops::surface::relief::{March, ReliefHit, ReliefMethod, ReliefPass, ReliefRay};
use relievo::ops::surface::{ReliefMaps, ReliefMaterial, ReliefOptions};
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, Depth, Placement, Quality, Relief, Scene, View};
use relievo::{Error, InputError};
use relievo_samples::BuiltInMap;

use crate::cases::surface::bounds::{Judged, Source, judge};
use crate::cases::surface::{Shape, bare_loads, random_map, random_rays, rays};
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The largest fraction of a case's rays that may touch the surface within rounding ([`Judged::touches`]).
/// Which rays do follows from the rays alone. No ray may exceed its bound.
pub(crate) const TOUCHING: f64 = 0.2;

/// The cases cover every method on every shape, with odd sizes, both address modes, and numbers of rays around
/// the workgroup's.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for method in ReliefMethod::ALL {
        let pass = ReliefPass::new(gpu, method)?;
        let all = Shape::ALL.into_iter().cycle();
        let counts = [1, 63, 64, 65, 1000, 2000, 2000, 2000];
        let sizes = [[1, 1], [2, 3], [5, 4], [17, 9], [64, 64], [33, 100], [129, 127], [128, 128]];
        for (case, ((size, count), shape)) in sizes.into_iter().zip(counts).zip(all).enumerate() {
            for address in [Address::Wrap, Address::Clamp] {
                let map = random_map(case as u32, size, shape)?;
                // The bound of a cone's hit includes what the binary search leaves of the last step.
                let fewest = if method == ReliefMethod::Cone { 12 } else { 4 };
                let march =
                    March { address, steps: [6, 24 + case as u32], binary_steps: fewest + case as u32 };
                let rays = random_rays(case as u32, count);
                let comparison = compared(gpu, &pass, &map, method, &march, &rays).await?;
                let name = method.name();
                cases.add(
                    format!("{name}: {shape:?} {}×{}, {}, {count} rays", size[0], size[1], address.name()),
                    comparison,
                );
            }
        }
    }
    Ok(())
}

async fn compared(
    gpu: &Gpu,
    pass: &ReliefPass,
    map: &HeightMap,
    method: ReliefMethod,
    march: &March,
    rays: &[ReliefRay],
) -> Result<Comparison, Error> {
    let textures = SurfaceTextures::new(gpu, map, method, march.address)?;
    let input = Buffer::from_slice(gpu, "rays", rays)?;
    let output = Poisoned::new(gpu, rays.len())?;
    let job = pass.prepare(gpu, &textures, march, &input, &output.buffer)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let judged = judge(map, method, march, rays, Source::Given)?;
    Ok(output.check(gpu, |actual| hits(actual, &judged, [map.width(), map.height()])).await?)
}

/// Compares hits: outcomes must be equal, numbers of loads must be equal where rounding changes no branch, and
/// errors must be within each ray's own bound. At most the fraction `TOUCHING` of the rays may touch.
pub fn hits(actual: &[ReliefHit], judged: &[Judged], size: [u32; 2]) -> Comparison {
    if actual.len() != judged.len() {
        let fault = format!("{} hits instead of {}", actual.len(), judged.len());
        return Comparison::failed(actual.len(), fault);
    }
    let judgements: Vec<_> =
        actual.iter().zip(judged).map(|(hit, judged)| judgement(hit, judged, size)).collect();
    each(&judgements, "texels", TOUCHING, |index| {
        format!("{:?} instead of {:?}", actual[index], judged[index])
    })
}

fn judgement(hit: &ReliefHit, judged: &Judged, size: [u32; 2]) -> Judgement {
    let expected = &judged.expected;
    let off = |a: f32, b: f32| (f64::from(a) - f64::from(b)).abs();
    let [du, dv] = [0, 1].map(|i| off(hit.uv[i], expected.uv[i]) * f64::from(size[i]));
    let error = du.hypot(dv);
    let ratios = [
        error / judged.texels,
        off(hit.parameter, expected.parameter) / judged.parameter,
        off(hit.height, expected.height) / judged.height,
    ];
    let is_other =
        hit.outcome_code != expected.outcome_code || (judged.is_steady && hit.samples != expected.samples);
    // Unlike `f64::max`, this keeps NaN.
    let largest = ratios.into_iter().fold(0.0, |most, ratio| if ratio <= most { most } else { ratio });
    let ratio = if is_other || ratios.iter().any(|ratio| ratio.is_nan()) { f64::INFINITY } else { largest };
    Judgement { ratio, error, touches: judged.touches() }
}

/// Texels along an edge of the map.
const TEXELS: u32 = 512;

/// Pixels along an edge of the target.
const EDGE: u32 = 1024;

/// Angle between eye and normal, in degrees.
const ANGLE: f32 = 60.0;

/// Measures cobbles at 60° with a relief depth of 0.1. The first cases trace lists of 1024² rays: `copy` makes
/// as many texel loads per ray as the method does (the case's name says how many), and nothing else. Further
/// cases draw 1024² pixels of a scene, which was recorded before: `limit` draws `plain` in the same way; the
/// reference marches but does not shade.
///
/// All kernels come before all pictures, because lavapipe's timestamps around compute work are too short once a
/// picture has been drawn.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let map = BuiltInMap::Cobbles.height_map(TEXELS)?;
    for method in ReliefMethod::ALL {
        listed(bench, &map, method)?;
    }
    #[cfg(not(target_arch = "wasm32"))]
    pictures(bench, &map)?;
    Ok(())
}

/// Measures pictures of every method.
#[cfg(not(target_arch = "wasm32"))]
fn pictures(bench: &mut Bench<'_>, map: &HeightMap) -> Result<(), Error> {
    let gpu = bench.gpu;
    let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(TEXELS)?);
    let albedo = ColorTexture::new(gpu, &albedo, Address::Wrap)?;
    let target = Offscreen::new(gpu, [EDGE, EDGE])?;
    let plain = Drawing::new(gpu, &target, map, &albedo, ReliefMethod::Plain)?;
    let (rays, march) = (rays(EDGE, towards()), March::default());
    for method in ReliefMethod::ALL {
        let drawing = Drawing::new(gpu, &target, map, &albedo, method)?;
        let surface = ReliefSurface::new(map, method, Address::Wrap);
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| drawing.record(encoder, &target)),
            Contender::recorded(Backend::Limit, |encoder| plain.record(encoder, &target)),
            Contender::host(Backend::ReferenceParallel, || {
                drop(std::hint::black_box(surface.trace_all(method, &rays, &march)));
            }),
        ];
        let pixels = (EDGE * EDGE) as usize;
        bench.case(
            format!("{EDGE}² pixels, {}", method.name()),
            pixels,
            "pixel",
            4 * pixels as u64,
            contenders,
        )?;
    }
    Ok(())
}

/// Measures one method with the compute kernel.
fn listed(bench: &mut Bench<'_>, map: &HeightMap, method: ReliefMethod) -> Result<(), Error> {
    let gpu = bench.gpu;
    let rays = rays(EDGE, towards());
    let march = March::default();
    let surface = ReliefSurface::new(map, method, Address::Wrap);
    let samples: u64 =
        (surface.trace_all(method, &rays, &march).iter()).map(|hit| u64::from(hit.samples)).sum();
    let mean = samples as f64 / rays.len() as f64;
    let textures = textures(gpu, map, method)?;
    let input = Buffer::from_slice(gpu, "rays", &rays)?;
    let hits = Buffer::new(gpu, "hits", rays.len())?;
    let job = ReliefPass::new(gpu, method)?.prepare(gpu, &textures, &march, &input, &hits)?;
    let bare = bare_loads(gpu, &textures, EDGE, samples)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &bare),
        Contender::host(Backend::ReferenceParallel, || {
            drop(std::hint::black_box(surface.trace_all(method, &rays, &march)));
        }),
    ];
    let bytes = 4 * samples + (rays.len() * (size_of::<ReliefRay>() + size_of::<ReliefHit>())) as u64;
    bench.case(format!("{}, {mean:.1} loads a ray", method.name()), rays.len(), "ray", bytes, contenders)
}

fn textures(gpu: &Gpu, map: &HeightMap, method: ReliefMethod) -> Result<SurfaceTextures, Error> {
    SurfaceTextures::new(gpu, map, method, Address::Wrap)
}

/// A scene of the square, which fills the target, recorded through a view.
#[cfg(not(target_arch = "wasm32"))]
struct Drawing {
    scene: Scene,
    view: View,
    renderer: Renderer,
}

#[cfg(not(target_arch = "wasm32"))]
impl Drawing {
    fn new(
        gpu: &Gpu,
        target: &Offscreen,
        map: &HeightMap,
        albedo: &ColorTexture,
        method: ReliefMethod,
    ) -> Result<Self, Error> {
        let textures = textures(gpu, map, method)?;
        let maps = ReliefMaps { textures: &textures, albedo, normals: None };
        let options = ReliefOptions { method, ..ReliefOptions::default() };
        let relief = Relief { options, ..Relief::of_maps(SurfaceMesh::square(1.0), maps) };
        let ReliefMaterial { light, ambient, .. } = relief.material;
        let mut scene = Scene::new(gpu)?;
        scene.set_light(Light { direction: light.into(), color: Vec3::ONE, ambient })?;
        let square = scene.add_relief(&relief, 1)?;
        scene.spawn(square, Placement::default())?;
        let mut renderer = Renderer::new(gpu, target.format())?;
        renderer.prepare(&scene)?;
        let mut view = scene.view(Quality::pixels(0.0))?;
        view.set(camera())?;
        gpu.try_run("record", |encoder| scene.record(encoder, &mut [&mut view]))?;
        let drawing = Self { scene, view, renderer };
        gpu.try_run("draw", |encoder| Ok(drawing.draw(encoder, target)?))?;
        Ok(drawing)
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder, target: &Offscreen) -> Result<(), InputError> {
        target
            .record(encoder, [0.0; 3], |pass| self.renderer.draw(pass, &self.scene, &self.view, Layer::Color))
    }

    /// Draws again what has been drawn without an error.
    fn record(&self, encoder: &mut wgpu::CommandEncoder, target: &Offscreen) {
        drop(self.draw(encoder, target));
    }
}

/// A parallel camera, aslant: the square fills the picture, and rays come from [`towards`].
fn camera() -> Camera {
    let [x, y, z] = towards();
    // Across the picture nothing changes along the rays.
    let slant = Mat4 { z_axis: Vec4::new(-x / z, y / z, 1.0, 0.0), ..Mat4::IDENTITY };
    let clip_from_view =
        Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(2.0, 2.0, -0.25)) * slant;
    let view_from_cell = Mat4::IDENTITY;
    Camera { cell: [0; 3], view_from_cell, clip_from_view, viewport: [EDGE; 2], depth: Depth::Forward }
}

/// The unit vector towards the eye, tangent space.
fn towards() -> [f32; 3] {
    let (sine, cosine) = ANGLE.to_radians().sin_cos();
    [0.0, sine, cosine]
}
