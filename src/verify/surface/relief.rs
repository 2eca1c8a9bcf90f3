//! Parity of `kernels/surface/relief.wgsl`: the functions of `wgsl/surface/` that material shaders import.

use super::{Shape, random_map, random_rays};
use crate::Error;
use crate::gpu::{Buffer, Gpu};
use crate::reference::surface::relief::Surface;
use crate::surface::map::{Address, HeightMap};
use crate::surface::relief::{Hit, March, Method, Ray, ReliefPass};
use crate::surface::texture::SurfaceTextures;
use crate::verify::compare::Comparison;
use crate::verify::{Cases, poison::Poisoned};

/// How far the result of a ray may lie from its twin's in texels, where both take the same branches.
///
/// Positions of rays up to 40 tiles of 129 texels away carry 2⁻²³ · 5,160 < 7e-4 texels from each of two roundings;
/// the root of a patch adds what that changes the heights, at most 1 a texel, over the ray's own fall a texel, at
/// least 1/200 where the result is still counted: 0.2 texels. Steeper rays, nearly all, are far inside.
pub const TEXEL_BOUND: f64 = 0.2;

/// The share of rays that may go astray: where ray and surface touch within rounding, a device that fuses or
/// reassociates may see the other side of the branch, and then finds the next crossing. On adapters that round
/// every operation as the CPU does, none do.
pub const ASTRAY: f64 = 0.005;

/// Every method on every shape: odd sizes, both address modes, numbers of rays around the workgroup's.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for method in Method::ALL {
        let pass = ReliefPass::new(gpu, method)?;
        let all = Shape::ALL.into_iter().cycle();
        let counts = [1, 63, 64, 65, 1000, 2000, 2000, 2000];
        let sizes = [[1, 1], [2, 3], [5, 4], [17, 9], [64, 64], [33, 100], [129, 127], [128, 128]];
        for (case, ((size, count), shape)) in sizes.into_iter().zip(counts).zip(all).enumerate() {
            for address in [Address::Wrap, Address::Clamp] {
                let map = random_map(case as u32, size, shape)?;
                let march = March { address, steps: [6, 24 + case as u32], binary_steps: 4 + case as u32 };
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
    let expected = Surface::new(map, method, march.address).trace_all(method, rays, march);
    Ok(output.check(gpu, |actual| hits(actual, &expected, [map.width(), map.height()]))?)
}

/// Compares hits: the same outcome and the same loads, within [`TEXEL_BOUND`]; but for [`ASTRAY`].
pub fn hits(actual: &[Hit], expected: &[Hit], size: [u32; 2]) -> Comparison {
    if actual.len() != expected.len() || expected.is_empty() {
        let fault = format!("{} hits instead of {}", actual.len(), expected.len());
        return Comparison::failed(actual.len(), fault);
    }
    let texels = |a: &Hit, b: &Hit| {
        let [du, dv] = [0, 1].map(|i| f64::from(a.uv[i] - b.uv[i]) * f64::from(size[i]));
        du.hypot(dv)
    };
    let strays = |(a, b): &(&Hit, &Hit)| {
        // Written so that a NaN is astray.
        let near = texels(a, b) <= TEXEL_BOUND
            && (a.height - b.height).abs() <= 0.01
            && (a.parameter - b.parameter).abs() <= 0.01;
        !(near && a.samples == b.samples && a.code == b.code)
    };
    let mut astray = actual.iter().zip(expected).enumerate().filter(|(_, pair)| strays(pair)).peekable();
    let first = astray.peek().map(|(index, (actual, expected))| {
        format!("first astray is ray {index}: {actual:?} instead of {expected:?}")
    });
    let error = astray.count() as f64 / expected.len() as f64;
    let holds = error <= ASTRAY;
    let fault = first.filter(|_| !holds);
    Comparison {
        holds,
        values: expected.len(),
        error,
        bound: ASTRAY,
        unit: "of all rays astray",
        left_out: None,
        fault,
    }
}
