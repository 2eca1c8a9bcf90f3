//! Parity and benchmark cases of `kernels/surface/height_pyramid.wgsl`.

use relievo::Error;
use relievo::ops::surface::HeightMapBatch;
use relievo::ops::surface::height_pyramid::reference::height_pyramid;
use relievo::ops::surface::height_pyramid::{HeightPyramidPass, PyramidLayout, Pyramids};
use relievo::ops::surface::map::{Address, HeightMap};

use crate::cases::surface::{Shape, random_map};
use crate::cases::terrain::copy_of;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The cases cover sizes around every block boundary, batches, and both address modes. The padding between
/// levels must stay untouched.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = HeightPyramidPass::new(gpu)?;
    #[rustfmt::skip]
    let sizes = [
        [1, 1], [1, 2], [2, 1], [3, 3], [4, 4], [5, 3], [7, 8], [8, 9], [15, 17], [31, 31], [32, 32], [33, 32],
        [63, 65], [64, 64], [100, 1], [127, 129], [128, 256], [257, 255],
    ];
    for (case, size) in sizes.into_iter().enumerate() {
        for (address, count) in [(Address::Wrap, 1), (Address::Clamp, 3)] {
            let maps = (0..count)
                .map(|map| random_map(case as u32 * 8 + map, size, Shape::Noise))
                .collect::<Result<Vec<_>, _>>()?;
            let batch = HeightMapBatch::new(gpu, &maps)?;
            let layout = PyramidLayout::new(size, address);
            let output = Poisoned::new(gpu, layout.len() * maps.len())?;
            let pyramids = Pyramids { nodes: output.buffer.clone(), layout, address, count };
            let job = pass.prepare(gpu, &batch, &pyramids)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let expected: Vec<u32> = maps.iter().flat_map(|map| with_poison(map, &layout, address)).collect();
            let comparison = output
                .check(gpu, |actual: &[f32]| {
                    compare::exact(bytemuck::cast_slice::<f32, u32>(actual), &expected)
                })
                .await?;
            cases.add(format!("{}×{} × {count}, {}", size[0], size[1], address.name()), comparison);
        }
    }
    Ok(())
}

/// The reference pyramid as bits, with poison where no node lies.
fn with_poison(map: &HeightMap, layout: &PyramidLayout, address: Address) -> Vec<u32> {
    let pyramid = height_pyramid(map, address);
    let mut bits = vec![POISON; layout.len()];
    for level in 0..layout.levels {
        let [columns, rows] = layout.nodes(level);
        for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
            let index = layout.index(level, [x, y]);
            bits[index] = pyramid[index].to_bits();
        }
    }
    bits
}

/// Measures a batch of 64 maps: the kernel reads 4 bytes and writes 5⅓ per texel.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = HeightPyramidPass::new(gpu)?;
    for (edge, count) in [(256, 64), (512, 64), (1024, 1)] {
        let map = random_map(1, [edge, edge], Shape::Noise)?;
        let batch = HeightMapBatch::new(gpu, &vec![map.clone(); count])?;
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
        bench.case(name, texels, "texel", 4 * (texels * 7 / 3) as u64, contenders)?;
    }
    Ok(())
}
