//! Parity and benchmark cases of `kernels/terrain/node_normals.wgsl`.

use std::hint::black_box;

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::node::NodeShape;
use relievo::ops::terrain::node_normals::reference::{node_normals, packed_normal};
use relievo::ops::terrain::node_normals::{NodeNormalsBuffers, NodeNormalsPass};

use crate::cases::terrain::{LIMIT, measure, random_heights};
use crate::harness::compare::absolute;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// A half of a word may be rounded to the other side: a component is off by at most 8.5e-7, which is 0.028 of a step.
const HALF_BOUND: f32 = 1.0;

/// All resolutions, sizes around workgroup boundaries, slopes from flat to the limit, and regions without a node.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = NodeNormalsPass::new(gpu)?;
    for (size, finer) in [(3, 1), (5, 2), (17, 3), (33, 1), (65, 2), (129, 1)] {
        for (limit, spacing) in [(0, 1.0), (1 << 16, 1.0), (LIMIT, 1e5), (1 << 22, 0.37)] {
            let shape = NodeShape { size, finer };
            let points = (shape.region_width() as usize).pow(2);
            let heights = random_heights(size + finer, 3 * points, limit);
            let regions = Buffer::from_slice(gpu, "regions", &heights)?;
            // The second region has no node, and the second node no region.
            let slots = [2_u32, 7, 0];
            let count = (shape.normals_width() as usize).pow(2);
            let normals = Poisoned::new(gpu, 3 * count)?;
            let mut expected = vec![POISON; 3 * count];
            for (region, slot) in heights.chunks_exact(points).zip(slots).filter(|(_, slot)| *slot < 3) {
                let own = node_normals(shape, spacing, region).into_iter().map(packed_normal);
                let to = &mut expected[slot as usize * count..][..count];
                to.iter_mut().zip(own).for_each(|(to, own)| *to = own);
            }
            let slots = Buffer::from_slice(gpu, "slots", &slots)?;
            let buffers = NodeNormalsBuffers { heights: &regions, slots: &slots, normals: &normals.buffer };
            let job = pass.prepare(gpu, shape, spacing, 3, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let name = format!("{size}×{size}, {finer} levels finer, heights to {limit}, spacing {spacing}");
            let expected = halves(&expected);
            let found = normals.check(gpu, |words| absolute(&halves(words), &expected, HALF_BOUND)).await?;
            cases.add(name, found);
        }
    }
    Ok(())
}

/// Both halves of each word, in steps.
fn halves(words: &[u32]) -> Vec<f32> {
    words.iter().flat_map(|word| [*word as u16 as i16, (*word >> 16) as u16 as i16].map(f32::from)).collect()
}

/// Measures four nodes of 65 × 65 samples from regions that are three levels finer.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu: &Gpu = bench.gpu;
    let shape = NodeShape { size: 65, finer: 3 };
    let points = (shape.region_width() as usize).pow(2);
    let heights = random_heights(1, 4 * points, 1 << 20);
    let regions = Buffer::from_slice(gpu, "regions", &heights)?;
    let slots = Buffer::from_slice(gpu, "slots", &[0_u32, 1, 2, 3])?;
    let count = (shape.normals_width() as usize).pow(2);
    let normals = Buffer::new(gpu, "normals", 4 * count)?;
    let buffers = NodeNormalsBuffers { heights: &regions, slots: &slots, normals: &normals };
    let job = NodeNormalsPass::new(gpu)?.prepare(gpu, shape, 1.0, 4, buffers)?;
    measure(
        bench,
        "65x65 3 finer batch 4",
        4 * count,
        4,
        |encoder| job.record(encoder),
        || {
            for region in heights.chunks_exact(points) {
                drop(black_box(node_normals(shape, 1.0, region)));
            }
        },
    )
}
