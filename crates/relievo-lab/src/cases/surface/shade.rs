//! Parity and benchmark cases of `kernels/surface/shade.wgsl`: hard and soft shadow, and the depth of the relief.
//!
//! The benchmark measures lists of points against the same number of bare texel loads.

use crate::shade::reference::shade_all;
use crate::shade::shadow::light_ray;
use crate::shade::{Shade, ShadePass, ShadePoint, ShadeView};
use glam::{Mat4, Vec3, Vec4, camera};
use relievo::gpu::Buffer;
use relievo::ops::surface::ReliefMaterial;
use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::relief::reference::height::BILINEAR;
use relievo::ops::surface::relief::textures::SurfaceTextures;
use relievo::ops::surface::relief::{March, ReliefMethod, ReliefRay};
use relievo::{Error, InputError};
use relievo_samples::BuiltInMap;

use crate::cases::surface::bounds::{BLUNT, Source, ULP, judge, steepness};
use crate::cases::surface::depth::depth_off;
use crate::cases::surface::penumbra::{BIAS, Terrain, penumbra};
use crate::cases::surface::{Shape, bare_loads, random_map, rays};
use crate::cases::terrain::random_words;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The largest fraction of points that may be so close to the edge of a hard shadow that rounding decides.
pub(crate) const AT_EDGES: f64 = 0.04;

/// The largest fraction of points whose light is known no better than to [`BLUNT`]; they lie at the foot of
/// walls that are one texel thick.
pub(crate) const BLURRED: f64 = 0.1;

/// The largest fraction of points whose depth is known no better than that; they lie in the plane of the eye.
pub(crate) const AT_EYE: f64 = 0.01;

/// The cases cover every method on every shape, in both address modes, in parallel and in perspective views,
/// with numbers of points around the workgroup's.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for method in ReliefMethod::ALL {
        let pass = ShadePass::new(gpu, method)?;
        let sizes =
            [([1, 1], 1), ([5, 4], 63), ([17, 9], 64), ([33, 100], 65), ([64, 64], 1000), ([129, 127], 2000)];
        for (case, ((size, count), shape)) in
            sizes.into_iter().zip(Shape::ALL.into_iter().cycle()).enumerate()
        {
            for (address, camera) in [(Address::Wrap, perspective()), (Address::Clamp, parallel())] {
                let case = case as u32;
                let map = random_map(100 + case, size, shape)?;
                let march = March { address, steps: [8, 32], binary_steps: 16 };
                let view =
                    ShadeView { shadow_steps: 1 + 12 * case, softness: 0.1 * (1 << case) as f32, ..camera };
                let points =
                    random_points(case, count, &ReliefSurface::new(&map, method, address), method, &march);
                let textures = SurfaceTextures::new(gpu, &map, method, address)?;
                let input = Buffer::from_slice(gpu, "points", &points)?;
                let output = Poisoned::new(gpu, points.len())?;
                let job = pass.prepare(gpu, &textures, &march, &view, &input, &output.buffer)?;
                gpu.submit("verify", |encoder| job.record(encoder))?;
                let judged = judged(&map, method, &march, &view, &points)?;
                for (what, part) in PARTS {
                    let comparison = output.check(gpu, |actual| compare(actual, &judged, part)).await?;
                    let (name, [width, height]) = (method.name(), size);
                    let address = address.name();
                    cases.add(
                        format!("{name}: {what}, {shape:?} {width}×{height}, {address}, {count} points"),
                        comparison,
                    );
                }
            }
        }
    }
    Ok(())
}

/// A perspective view from above, at an angle.
pub fn perspective() -> ShadeView {
    let eye = Vec3::new(1.5, -2.0, 4.0);
    let view = camera::rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
    let projection = camera::rh::proj::directx::perspective(0.8, 1.25, 0.5, 12.0);
    ShadeView { clip_from_world: projection * view, eye: eye.extend(1.0), ..crate::shade::from_above() }
}

/// The same view in parallel projection.
pub(crate) fn parallel() -> ShadeView {
    let towards = Vec3::new(0.48, -0.6, 0.64);
    let depth = -0.1 * towards;
    let rows = [Vec4::X, Vec4::Y, depth.extend(0.5), Vec4::W];
    let clip_from_world = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    ShadeView { clip_from_world, eye: towards.extend(0.0), ..crate::shade::from_above() }
}

/// Hits of random rays, with the light overhead, at grazing angles, straight down, and from below.
pub fn random_points(
    case: u32,
    count: usize,
    surface: &ReliefSurface<'_>,
    method: ReliefMethod,
    march: &March,
) -> Vec<ShadePoint> {
    let words = random_words(case ^ 0x11917, 12 * count);
    let points = words.chunks_exact(12).map(|words| {
        let unit = |index: usize| (words[index] >> 8) as f32 / 16_777_216.0;
        let direction = |turn: usize, cosine: f32| {
            let (turn, sine) = (unit(turn) * std::f32::consts::TAU, (1.0 - cosine * cosine).max(0.0).sqrt());
            [turn.cos() * sine, turn.sin() * sine, cosine]
        };
        let scale = [0.02, 0.1, 0.3][words[0] as usize % 3];
        let plane = [1.0, 0.5, 0.0][words[1] as usize % 3];
        let ray =
            ReliefRay::new([unit(2) - 0.25, unit(3) - 0.25], direction(4, 0.1 + 0.9 * unit(5)), scale, plane);
        let cosine = match words[6] % 16 {
            0 => 1.0,
            1 => -unit(6),
            2 => 0.02 * unit(6),
            _ => unit(6),
        };
        ShadePoint {
            light: direction(7, cosine),
            scale,
            position: [8, 9, 10].map(|index| 2.0 * unit(index) - 1.0),
            world: [0.5, 2.0][words[11] as usize % 2],
            ray,
            hit: surface.trace(method, &ray, march),
        }
    });
    points.collect()
}

/// The reference's result for a point, and the tolerances for a device.
#[derive(Debug, Clone, Copy)]
pub struct JudgedShade {
    /// The reference's result.
    pub expected: Shade,
    /// Whether the light's ray ends so far above the point, or so close to it, that rounding cannot decide the
    /// hard shadow.
    pub is_certain: bool,
    /// The smallest and the largest value allowed for the soft shadow, computed independently of the reference.
    pub soft: [f64; 2],
    /// The largest error allowed for the depth.
    pub depth: f64,
}

/// Computes results and tolerances for points.
///
/// # Errors
/// As [`judge`].
pub fn judged(
    map: &HeightMap,
    method: ReliefMethod,
    march: &March,
    view: &ShadeView,
    points: &[ShadePoint],
) -> Result<Vec<JudgedShade>, InputError> {
    let surface = ReliefSurface::new(map, method, march.address);
    let shades = shade_all(&surface, method, march, view, points);
    let rays: Vec<ReliefRay> =
        points.iter().map(|point| light_ray(&point.hit, point.light, point.scale)).collect();
    let firsts = judge(map, method, march, &rays, Source::Computed)?;
    let steepness = steepness(map, march.address);
    let terrain = Terrain { map, steepness: &steepness, address: march.address };
    let all = points.iter().zip(shades).zip(firsts).map(|((point, expected), first)| {
        let limit = 1.0 - f64::from(point.hit.height) - BIAS;
        JudgedShade {
            expected,
            is_certain: (f64::from(first.expected.parameter) - limit).abs() > first.parameter + 4.0 * ULP,
            soft: penumbra(&terrain, view, point),
            depth: depth_off(view, point),
        }
    });
    Ok(all.collect())
}

/// A part of a [`Shade`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Hard shadow: 0 or 1, equal to the reference except at edges.
    Hard,
    /// Soft shadow: within its smallest and largest value.
    Soft,
    /// Depth.
    Depth,
}

/// Every part, with its name.
pub const PARTS: [(&str, Part); 3] =
    [("hard shadow", Part::Hard), ("soft shadow", Part::Soft), ("depth", Part::Depth)];

/// Compares one part of the shades.
pub fn compare(actual: &[Shade], judged: &[JudgedShade], part: Part) -> Comparison {
    if actual.len() != judged.len() {
        let fault = format!("{} shades instead of {}", actual.len(), judged.len());
        return Comparison::failed(actual.len(), fault);
    }
    let of = |(actual, judged): (&Shade, &JudgedShade)| match part {
        Part::Hard => hard(actual.hard, judged),
        Part::Soft => soft(actual.soft, judged),
        Part::Depth => within(actual.depth, judged.expected.depth, judged.depth),
    };
    let judgements: Vec<Judgement> = actual.iter().zip(judged).map(of).collect();
    let (unit, may_touch) = match part {
        Part::Hard => ("of the light", AT_EDGES),
        Part::Soft => ("of the light", BLURRED),
        Part::Depth => ("of the depth range", AT_EYE),
    };
    each(&judgements, unit, may_touch, |index| format!("{:?} instead of {:?}", actual[index], judged[index]))
}

fn hard(actual: f32, judged: &JudgedShade) -> Judgement {
    let error = f64::from((actual - judged.expected.hard).abs());
    let is_light = actual == 0.0 || actual == 1.0;
    let is_wrong = !is_light || (judged.is_certain && error != 0.0);
    Judgement::exact(!is_wrong, error, !judged.is_certain)
}

fn soft(actual: f32, judged: &JudgedShade) -> Judgement {
    let [least, most] = judged.soft;
    let judgement = within(actual, judged.expected.soft, most - least + 2.0 * ULP);
    let is_between = (least - ULP..=most + ULP).contains(&f64::from(actual));
    Judgement { ratio: if is_between { judgement.ratio } else { f64::INFINITY }, ..judgement }
}

fn within(actual: f32, expected: f32, bound: f64) -> Judgement {
    let error = (f64::from(actual) - f64::from(expected)).abs();
    // Infinite bounds belong to points in the plane of the eye, about which nothing is claimed.
    let ratio = if bound.is_infinite() { 0.0 } else { error / bound };
    Judgement { ratio, error, touches: bound > BLUNT }
}

/// Points along each edge.
const EDGE: u32 = 512;

/// Measures 512² points on cobbles of 512² texels, seen straight from above under the default light, with hard
/// shadows by `quadtree` and by `relief`. `copy` makes as many texel loads per point as both shadows together,
/// and nothing else.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let map = BuiltInMap::Cobbles.height_map(512)?;
    let (march, view) = (March::default(), crate::shade::from_above());
    for method in [ReliefMethod::Quadtree, ReliefMethod::Relief] {
        let surface = ReliefSurface::new(&map, method, Address::Wrap);
        let points = points(&surface, method, &march);
        let hard: u64 = points
            .iter()
            .map(|point| light_ray(&point.hit, point.light, point.scale))
            .map(|ray| u64::from(surface.trace(method, &ray, &march).samples))
            .sum();
        let samples = hard + points.len() as u64 * u64::from(BILINEAR * (view.shadow_steps + 1));
        let mean = samples as f64 / points.len() as f64;
        let textures = SurfaceTextures::new(gpu, &map, method, Address::Wrap)?;
        let input = Buffer::from_slice(gpu, "points", &points)?;
        let shades = Buffer::new(gpu, "shades", points.len())?;
        let job = ShadePass::new(gpu, method)?.prepare(gpu, &textures, &march, &view, &input, &shades)?;
        let bare = bare_loads(gpu, &textures, EDGE, samples)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &bare),
            Contender::host(Backend::ReferenceParallel, || {
                drop(std::hint::black_box(shade_all(&surface, method, &march, &view, &points)));
            }),
        ];
        let bytes = 4 * samples + (points.len() * (size_of::<ShadePoint>() + size_of::<Shade>())) as u64;
        let case = format!("{}, {mean:.1} loads a point", method.name());
        bench.case(case, points.len(), "point", bytes, contenders)?;
    }
    Ok(())
}

/// One point per texel.
fn points(surface: &ReliefSurface<'_>, method: ReliefMethod, march: &March) -> Vec<ShadePoint> {
    let material = ReliefMaterial::default();
    let rays = rays(EDGE, [0.0, 0.0, 1.0]);
    let hits = surface.trace_all(method, &rays, march);
    let points = rays.into_iter().zip(hits).map(|(ray, hit)| ShadePoint {
        light: material.light,
        scale: material.scale,
        position: [ray.origin[0], ray.origin[1], 0.0],
        world: 1.0,
        ray,
        hit,
    });
    points.collect()
}
