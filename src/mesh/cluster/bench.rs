//! Benchmark cases of `mesh/cluster`: clusters of a mesh.

use super::reference::cluster;
use super::{ClusterBuffers, ClusterCounts, ClusterPass, Grid, Representative};
use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::surface::tangent::verify::torus;
use crate::terrain::bench::copy_of;

/// Measures a torus of half a million triangles. The kernel must read positions and indices (12 bytes a vertex and 12 a
/// triangle), and write what stays (16 bytes a representative, 12 a triangle).
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let torus = torus(512, 512);
    let (vertices, triangles) = (torus.positions.len(), torus.indices.len() / 3);
    let pass = ClusterPass::new(gpu)?;
    let positions = Buffer::from_slice(gpu, "positions", &torus.positions)?;
    let indices = Buffer::from_slice(gpu, "indices", &torus.indices)?;
    let representatives = Buffer::<Representative>::new(gpu, "representatives", vertices)?;
    let clustered = Buffer::new(gpu, "clustered", torus.indices.len())?;
    let counts = Buffer::<ClusterCounts>::new(gpu, "counts", 1)?;
    for cells in [32, 256] {
        let grid = Grid::around(&torus.positions, cells);
        let buffers = ClusterBuffers {
            positions: &positions,
            indices: &indices,
            representatives: &representatives,
            clustered: &clustered,
            counts: &counts,
        };
        let job = pass.prepare(gpu, &grid, [vertices as u32, triangles as u32], buffers)?;
        let expected = cluster(&torus.positions, &torus.indices, &grid)?;
        let bytes =
            12 * (vertices + triangles) + 16 * expected.representatives.len() + 4 * expected.indices.len();
        let copied = copy_of(gpu, bytes / 8)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drop(std::hint::black_box(cluster(&torus.positions, &torus.indices, &grid)));
            }),
        ];
        let case = format!("512x512 torus, {cells} cells");
        bench.case(case, (triangles, "triangle"), bytes as u64, contenders)?;
    }
    Ok(())
}
