//! Parity of `kernels/baseline/gather.wgsl`.

use crate::Error;
use crate::animation::crowd::Local;
use crate::animation::place::Place;
use crate::baseline::gather::GatherPass;
use crate::gpu::Buffer;
use crate::reference::baseline::{gather::gather, words::words};
use crate::verify::animation::SIZES;
use crate::verify::{Cases, compare::exact, poison::Poisoned};

/// Bones and instances around workgroup boundaries, few keys and many, every bit pattern.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = GatherPass::new(gpu)?;
    for ([bones, count], keys) in SIZES.into_iter().zip([2, 3, 60].into_iter().cycle()) {
        let places: Vec<Place> = (words([3, 4], count as u32, 1).iter())
            .map(|word| Place { key: word % (keys as u32 - 1), fraction: 0.5 })
            .collect();
        let data = words([5, 6], (12 * bones * keys) as u32, 1);
        let values: Vec<[u32; 4]> = bytemuck::cast_slice(&data).to_vec();
        let place_buffer = Buffer::from_slice(gpu, "places", &places)?;
        let value_buffer = Buffer::<[f32; 4]>::from_slice(gpu, "values", bytemuck::cast_slice(&data))?;
        let output = Poisoned::<Local>::new(gpu, bones * count)?;
        let job = pass.prepare(gpu, [bones, keys], &place_buffer, &value_buffer, &output.buffer)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        let mut expected = vec![[[0; 4]; 3]; bones * count];
        gather([bones, keys], &places, &values, &mut expected);
        let comparison = output.check(gpu, |actual| {
            exact(bytemuck::cast_slice::<_, u32>(actual), expected.as_flattened().as_flattened())
        })?;
        cases.add(format!("{bones} bones × {count}, {keys} keys"), comparison);
    }
    Ok(())
}
