//! Parity cases of `kernels/surface/relief.wgsl`: the functions of `wgsl/surface/` that material shaders import.

use crate::Error;
use crate::gpu::{Buffer, Gpu};
use crate::harness::Cases;
use crate::harness::compare::Comparison;
use crate::harness::compare::{Judgement, each};
use crate::harness::poison::Poisoned;
use crate::surface::map::{Address, HeightMap};
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{Hit, March, Method, Ray, ReliefPass};
use crate::surface::verify::bounds::{Judged, Source, judge};
use crate::surface::verify::{Shape, random_map, random_rays};

/// The largest fraction of a case's rays that may touch the surface within rounding ([`Judged::touches`]).
/// Which rays do follows from the rays alone. No ray may exceed its bound.
pub(crate) const TOUCHING: f64 = 0.2;

/// The cases cover every method on every shape, with odd sizes, both address modes, and numbers of rays around
/// the workgroup's.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for method in Method::ALL {
        let pass = ReliefPass::new(gpu, method)?;
        let all = Shape::ALL.into_iter().cycle();
        let counts = [1, 63, 64, 65, 1000, 2000, 2000, 2000];
        let sizes = [[1, 1], [2, 3], [5, 4], [17, 9], [64, 64], [33, 100], [129, 127], [128, 128]];
        for (case, ((size, count), shape)) in sizes.into_iter().zip(counts).zip(all).enumerate() {
            for address in [Address::Wrap, Address::Clamp] {
                let map = random_map(case as u32, size, shape)?;
                // The bound of a cone's hit includes what the binary search leaves of the last step.
                let fewest = if method == Method::Cone { 12 } else { 4 };
                let march =
                    March { address, steps: [6, 24 + case as u32], binary_steps: fewest + case as u32 };
                let rays = random_rays(case as u32, count);
                let comparison = compared(gpu, &pass, &map, method, &march, &rays)?;
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

fn compared(
    gpu: &Gpu,
    pass: &ReliefPass,
    map: &HeightMap,
    method: Method,
    march: &March,
    rays: &[Ray],
) -> Result<Comparison, Error> {
    let textures = SurfaceTextures::new(gpu, map, method, march.address)?;
    let input = Buffer::from_slice(gpu, "rays", rays)?;
    let output = Poisoned::new(gpu, rays.len())?;
    let job = pass.prepare(gpu, &textures, march, &input, &output.buffer)?;
    gpu.run("verify", |encoder| job.record(encoder))?;
    let judged = judge(map, method, march, rays, Source::Given)?;
    Ok(output.check(gpu, |actual| hits(actual, &judged, [map.width(), map.height()]))?)
}

/// Compares hits: outcomes must be equal, numbers of loads must be equal where rounding changes no branch, and
/// errors must be within each ray's own bound. At most the fraction `TOUCHING` of the rays may touch.
pub fn hits(actual: &[Hit], judged: &[Judged], size: [u32; 2]) -> Comparison {
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

fn judgement(hit: &Hit, judged: &Judged, size: [u32; 2]) -> Judgement {
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
