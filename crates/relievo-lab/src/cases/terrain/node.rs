//! Parity and benchmark cases of `kernels/terrain/node.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::node::reference::node;
use relievo::ops::terrain::node::{NODE_FACTS, NodeBuffers, NodePass, NodeShape};

use crate::cases::terrain::{LIMIT, check_exact, measure, random_heights};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// The cases cover all resolutions, sizes around workgroup boundaries, heights up to the limit, and regions without a tile.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = NodePass::new(gpu)?;
    // The facts of a small node depend on few samples, so that a wrong triangle shows in them.
    let small = (1..4).flat_map(|finer| [(3, finer), (5, finer), (7, finer)]);
    for (size, finer) in
        [(3, 0), (17, 2), (33, 3), (9, 4), (65, 0), (65, 2), (129, 1)].into_iter().chain(small)
    {
        for limit in [0, 1, 1 << 16, LIMIT] {
            let shape = NodeShape { size, finer };
            let heights = random_heights(size + finer, 3 * points(shape), limit);
            let regions = Buffer::from_slice(gpu, "regions", &heights)?;
            // The second region has no tile, and the second tile no region.
            let slots = [2_u32, 7, 0];
            let tile = (shape.tile_width() as usize).pow(2);
            let tiles = Poisoned::new(gpu, 3 * tile)?;
            let mut expected_tiles = vec![POISON as i32; 3 * tile];
            let facts = Buffer::from_slice(gpu, "facts", &[0_u32; 3 * NODE_FACTS as usize])?;
            let mut expected_facts = vec![0; facts.len()];
            for (region, slot) in heights.chunks_exact(points(shape)).zip(slots).filter(|(_, slot)| *slot < 3)
            {
                let (own, found) = node(shape, region);
                let slot = slot as usize;
                expected_tiles[slot * tile..][..tile].copy_from_slice(&own);
                expected_facts[slot * NODE_FACTS as usize..][..NODE_FACTS as usize]
                    .copy_from_slice(&found.words());
            }
            let slots = Buffer::from_slice(gpu, "slots", &slots)?;
            let buffers =
                NodeBuffers { heights: &regions, slots: &slots, tiles: &tiles.buffer, facts: &facts };
            let job = pass.prepare(gpu, shape, 3, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let name = format!("{size}×{size}, {finer} levels finer, heights to {limit}");
            check_exact(cases, format!("{name}: tiles"), &tiles, &expected_tiles).await?;
            let found = facts.read(gpu).await?;
            cases.add(format!("{name}: facts"), crate::harness::compare::exact(&found, &expected_facts));
        }
    }
    Ok(())
}

/// Number of heights of a region.
fn points(shape: NodeShape) -> usize {
    (shape.region_width() as usize).pow(2)
}

/// Measures four nodes of 65 × 65 samples from regions that are three levels finer.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu: &Gpu = bench.gpu;
    let shape = NodeShape { size: 65, finer: 3 };
    let heights = random_heights(1, 4 * points(shape), 1 << 20);
    let regions = Buffer::from_slice(gpu, "regions", &heights)?;
    let slots = Buffer::from_slice(gpu, "slots", &[0_u32, 1, 2, 3])?;
    let tiles = Buffer::new(gpu, "tiles", 4 * (shape.tile_width() as usize).pow(2))?;
    let facts = Buffer::new(gpu, "facts", 4 * NODE_FACTS as usize)?;
    let buffers = NodeBuffers { heights: &regions, slots: &slots, tiles: &tiles, facts: &facts };
    let job = NodePass::new(gpu)?.prepare(gpu, shape, 4, buffers)?;
    measure(
        bench,
        "65x65 3 finer batch 4",
        heights.len(),
        4,
        |encoder| job.record(encoder),
        || {
            for region in heights.chunks_exact(points(shape)) {
                drop(black_box(node(shape, region)));
            }
        },
    )
}
