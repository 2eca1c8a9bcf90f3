//! Parity cases of `kernels/surface/cone_map.wgsl`.

use crate::Error;
use crate::harness::poison::POISON;
use crate::harness::poison::Poisoned;
use crate::harness::{Cases, compare};
use crate::surface::cone_map::reference::cone_map;
use crate::surface::cone_map::{ConeMapPass, RADIUS_BOUND};
use crate::surface::height_batch::HeightBatch;
use crate::surface::height_pyramid::reference::height_pyramid;
use crate::surface::height_pyramid::{HeightPyramidPass, Pyramids};
use crate::surface::map::Address;
use crate::surface::verify::{Shape, random_map};

/// The cases cover every shape, sizes around the workgroup's, batches, both address modes.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
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
                let batch = HeightBatch::new(gpu, &maps)?;
                let pyramids = Pyramids::new(gpu, &batch, address)?;
                let mut cones = pass.output(gpu, &pyramids)?;
                let output = Poisoned::new(gpu, cones.cones.len())?;
                cones.cones = output.buffer.clone();
                let jobs = [
                    pyramid_pass.prepare(gpu, &batch, &pyramids)?,
                    pass.prepare(gpu, &batch, &pyramids, &cones)?,
                ];
                gpu.run("verify", |encoder| jobs.iter().for_each(|job| job.record(encoder)))?;
                let mut expected = Vec::new();
                for map in &maps {
                    expected.extend(cone_map(map, &height_pyramid(map, address), address));
                }
                let [columns, pitch] = [cones.cells[0] as usize, cones.pitch as usize];
                let name = format!("{shape:?} {}×{} × {count}, {}", size[0], size[1], address.name());
                let comparison = output.check(gpu, |actual| {
                    let rows = actual.chunks_exact(pitch).flat_map(|row| &row[..columns]).flatten();
                    let actual: Vec<f32> = rows.copied().collect();
                    compare::relative(&actual, expected.as_flattened(), RADIUS_BOUND)
                })?;
                cases.add(name.clone(), comparison);
                if columns == pitch {
                    continue;
                }
                let padding = output.check(gpu, |actual| {
                    let rows = actual.chunks_exact(pitch).flat_map(|row| &row[columns..]).flatten();
                    let words: Vec<u32> = rows.map(|word| word.to_bits()).collect();
                    compare::exact(&words, &vec![POISON; words.len()])
                })?;
                cases.add(format!("{name}: the rows' ends"), padding);
            }
        }
    }
    Ok(())
}
