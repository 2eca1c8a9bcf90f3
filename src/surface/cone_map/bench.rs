//! Benchmark cases of `surface/cone_map`: cone maps.

use crate::Error;
use crate::harness::{Backend, Bench, Contender};
use crate::samples::BuiltInMap;
use crate::surface::cone_map::ConeMapPass;
use crate::surface::cone_map::reference::cone_map;
use crate::surface::height_batch::HeightBatch;
use crate::surface::height_pyramid::reference::height_pyramid;
use crate::surface::height_pyramid::{HeightPyramidPass, Pyramids};
use crate::surface::map::Address;
use crate::terrain::bench::copy_of;

/// Measures maps of cobbles at two sizes, pyramid included; making a cone map is a set-up cost.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (pyramid_pass, pass) = (HeightPyramidPass::new(gpu)?, ConeMapPass::new(gpu)?);
    for edge in [256, 1024] {
        let map = BuiltInMap::Cobbles.height_map(edge)?;
        let batch = HeightBatch::new(gpu, std::slice::from_ref(&map))?;
        let pyramids = Pyramids::new(gpu, &batch, Address::Wrap)?;
        let cones = pass.output(gpu, &pyramids)?;
        let jobs =
            [pyramid_pass.prepare(gpu, &batch, &pyramids)?, pass.prepare(gpu, &batch, &pyramids, &cones)?];
        let texels = (edge * edge) as usize;
        let copied = copy_of(gpu, texels * 3 / 2)?;
        let pyramid = height_pyramid(&map, Address::Wrap);
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| jobs.iter().for_each(|job| job.record(encoder))),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::ReferenceParallel, || {
                drop(std::hint::black_box(cone_map(&map, &pyramid, Address::Wrap)));
            }),
        ];
        bench.case(format!("{edge}x{edge}"), (texels, "cell"), 12 * texels as u64, contenders)?;
    }
    Ok(())
}
