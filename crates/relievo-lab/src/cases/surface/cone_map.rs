//! Parity and benchmark cases of `kernels/surface/cone_map.wgsl`.

use relievo::Error;
use relievo::ops::surface::HeightMapBatch;
use relievo::ops::surface::cone_map::reference::cone_map;
use relievo::ops::surface::cone_map::{ConeMapPass, RADIUS_BOUND};
use relievo::ops::surface::height_pyramid::reference::height_pyramid;
use relievo::ops::surface::height_pyramid::{HeightPyramidPass, Pyramids};
use relievo::ops::surface::map::Address;
use relievo_samples::BuiltInMap;

use crate::cases::surface::{Shape, random_map};
use crate::cases::terrain::copy_of;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The cases cover every shape, sizes around the workgroup's, batches, both address modes.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (pyramid_pass, pass) = (HeightPyramidPass::new(gpu)?, ConeMapPass::new(gpu)?);
    for (case, size) in
        [[1, 1], [2, 3], [7, 8], [8, 8], [9, 7], [17, 31], [64, 64], [65, 63]].into_iter().enumerate()
    {
        for shape in Shape::ALL {
            for (address, count) in [(Address::Wrap, 2), (Address::Clamp, 1)] {
                let maps = (0..count)
                    .map(|map| random_map(case as u32 * 8 + map, size, shape))
                    .collect::<Result<Vec<_>, _>>()?;
                let batch = HeightMapBatch::new(gpu, &maps)?;
                let pyramids = Pyramids::new(gpu, &batch, address)?;
                let mut cones = pass.output(gpu, &pyramids)?;
                let output = Poisoned::new(gpu, cones.cones.len())?;
                cones.cones = output.buffer.clone();
                let jobs = [
                    pyramid_pass.prepare(gpu, &batch, &pyramids)?,
                    pass.prepare(gpu, &batch, &pyramids, &cones)?,
                ];
                gpu.submit("verify", |encoder| jobs.iter().for_each(|job| job.record(encoder)))?;
                let mut expected = Vec::new();
                for map in &maps {
                    expected.extend(cone_map(map, &height_pyramid(map, address), address));
                }
                let [columns, pitch] = [cones.cells[0] as usize, cones.pitch as usize];
                let name = format!("{shape:?} {}×{} × {count}, {}", size[0], size[1], address.name());
                let comparison = output
                    .check(gpu, |actual| {
                        let rows = actual.chunks_exact(pitch).flat_map(|row| &row[..columns]).flatten();
                        let actual: Vec<f32> = rows.copied().collect();
                        compare::relative(&actual, expected.as_flattened(), RADIUS_BOUND)
                    })
                    .await?;
                cases.add(name.clone(), comparison);
                if columns == pitch {
                    continue;
                }
                let padding = output
                    .check(gpu, |actual| {
                        let rows = actual.chunks_exact(pitch).flat_map(|row| &row[columns..]).flatten();
                        let words: Vec<u32> = rows.map(|word| word.to_bits()).collect();
                        compare::exact(&words, &vec![POISON; words.len()])
                    })
                    .await?;
                cases.add(format!("{name}: the rows' ends"), padding);
            }
        }
    }
    Ok(())
}

/// Measures maps of cobbles at two sizes, pyramid included; making a cone map is a set-up cost.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (pyramid_pass, pass) = (HeightPyramidPass::new(gpu)?, ConeMapPass::new(gpu)?);
    for edge in [256, 1024] {
        let map = BuiltInMap::Cobbles.height_map(edge)?;
        let batch = HeightMapBatch::new(gpu, std::slice::from_ref(&map))?;
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
        bench.case(format!("{edge}x{edge}"), texels, "cell", 12 * texels as u64, contenders)?;
    }
    Ok(())
}
