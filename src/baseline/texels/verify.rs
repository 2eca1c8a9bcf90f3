//! Parity cases of `kernels/baseline/texels.wgsl`.

use crate::Error;
use crate::baseline::texels::TexelsPass;
use crate::baseline::texels::reference::texels;
use crate::gpu::Buffer;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::blend::BlendBuffers;
use crate::terrain::config::Zone;
use crate::terrain::cover::Cover;
use crate::terrain::fields::Fields;
use crate::terrain::verify::random_heights;

/// The cases cover sizes around the four pixels of a thread and around blocks of rows, one zone and several, both numbers of
/// planes, and textures of two sizes that repeat.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = TexelsPass::new(gpu)?;
    for (width, count) in [(3, 1), (6, 2), (7, 3), (66, 2)] {
        for (zones, edge_log2, triplanar) in [(1, 3, false), (4, 0, true), (5, 4, true)] {
            let zone = |at: u32| Zone { repeats: 1 + 3 * at, ..Zone::new(0.0, 1.0, None) };
            let zones: Vec<_> = (0..zones).map(zone).collect();
            let cover = Cover { triplanar, ..Cover::random(&zones, edge_log2) };
            let heights = random_heights(width, (width * width * count) as usize, 60 << 16);
            let windows = Fields::new(gpu, "windows", width, count)?;
            windows.heights.write(gpu, &heights)?;
            let places: Vec<_> =
                (0..count as i32).map(|index| cover.place([index, -3 * index - 1], width - 2)).collect();
            let place_buffer = Buffer::from_slice(gpu, "places", &places)?;
            let output = Poisoned::new(gpu, windows.points(1))?;
            let buffers = BlendBuffers { windows: &windows, places: &place_buffer, pixels: &output.buffer };
            let job = pass.prepare(gpu, &cover, buffers)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let expected: Vec<u32> = (heights.chunks_exact((width * width) as usize).zip(&places))
                .flat_map(|(window, place)| texels(window, width as usize, &cover, *place))
                .collect();
            let name = format!("{width}×{width} × {count}, {} zones, {} texels", zones.len(), 1 << edge_log2);
            cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
        }
    }
    Ok(())
}
