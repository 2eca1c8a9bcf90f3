//! Parity cases of `kernels/baseline/loads.wgsl`.

use crate::Error;
use crate::baseline::loads::LoadsPass;
use crate::baseline::loads::reference::loads;
use crate::harness::Cases;
use crate::harness::compare::absolute;
use crate::harness::poison::Poisoned;
use crate::surface::map::Address;
use crate::surface::relief::Method;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::verify::{Shape, random_map};

/// The cases cover sizes around the workgroup's, more threads than texels, and no loads at all.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LoadsPass::new(gpu)?;
    for (case, (size, threads, count)) in
        [([5, 3], [9, 7], 0), ([5, 3], [8, 8], 11), ([64, 64], [65, 63], 40)].into_iter().enumerate()
    {
        let map = random_map(case as u32, size, Shape::Noise)?;
        let textures = SurfaceTextures::new(gpu, &map, Method::Plain, Address::Wrap)?;
        let output = Poisoned::new(gpu, (threads[0] * threads[1]) as usize)?;
        let job = pass.prepare(gpu, &textures.heights, threads, count, &output.buffer)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let expected = loads(&map, threads, count);
        // Each addition rounds by at most 2⁻²³ of a sum that is at most `count`.
        let bound = (count * count) as f32 * f32::EPSILON;
        let comparison = output.check(gpu, |actual| absolute(actual, &expected, bound))?;
        cases.add(format!("{count} loads by {threads:?} of {size:?}"), comparison);
    }
    Ok(())
}
