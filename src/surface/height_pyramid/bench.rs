//! Benchmark cases of `surface/height_pyramid`: max-mip pyramids.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::surface::height_batch::HeightBatch;
use crate::surface::height_pyramid::reference::height_pyramid;
use crate::surface::height_pyramid::{HeightPyramidPass, Pyramids};
use crate::surface::map::Address;
use crate::surface::verify::{Shape, random_map};
use crate::terrain::bench::copy_of;

/// Measures a batch of 64 maps: the kernel reads 4 bytes and writes 5⅓ per texel.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = HeightPyramidPass::new(gpu)?;
    for (edge, count) in [(256, 64), (512, 64), (1024, 1)] {
        let map = random_map(1, [edge, edge], Shape::Noise)?;
        let batch = HeightBatch::new(gpu, &vec![map.clone(); count])?;
        let pyramids = Pyramids::new(gpu, &batch, Address::Wrap)?;
        let job = pass.prepare(gpu, &batch, &pyramids)?;
        let texels = (edge * edge) as usize * count;
        // The kernel writes a third more than it reads, so the copy moves the mean of both.
        let copied = copy_of(gpu, texels * 7 / 6)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                for _ in 0..count {
                    drop(std::hint::black_box(height_pyramid(&map, Address::Wrap)));
                }
            }),
        ];
        let name = format!("{edge}x{edge} batch {count}");
        bench.case(name, (texels, "texel"), 4 * (texels * 7 / 3) as u64, contenders)?;
    }
    Ok(())
}
