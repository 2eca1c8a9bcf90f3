//! Parity and benchmark cases of `kernels/baseline/texels.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::blend::BlendBuffers;
use relievo::ops::terrain::config::{TerrainConfig, Zone};
use relievo::ops::terrain::cover::Cover;
use relievo::ops::terrain::texture::TerrainTexture;

use crate::baseline::texels::TexelsPass;
use crate::baseline::texels::reference::texels;
use crate::cases::terrain::{check_exact, copy_of, random_cover, random_windows, some_windows};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover sizes around the four pixels of a thread and around blocks of rows, one zone and several, both numbers of
/// planes, and textures of two sizes that repeat.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = TexelsPass::new(gpu)?;
    for (width, count) in [(3, 1), (6, 2), (7, 3), (66, 2)] {
        for (zones, edge_log2, triplanar) in [(1, 3, false), (4, 0, true), (5, 4, true)] {
            let zone = |at: u32| Zone { repeats: 1 + 3 * at, ..Zone::new(0.0, 1.0, None) };
            let zones: Vec<_> = (0..zones).map(zone).collect();
            let cover = Cover { triplanar, ..random_cover(&zones, edge_log2) };
            let (heights, windows) = random_windows(gpu, [width, count], 60 << 16)?;
            let places: Vec<_> =
                (0..count as i32).map(|index| cover.place([index, -3 * index - 1], width - 2)).collect();
            let place_buffer = Buffer::from_slice(gpu, "places", &places)?;
            let output = Poisoned::new(gpu, windows.points(1))?;
            let buffers = BlendBuffers { windows: &windows, places: &place_buffer, pixels: &output.buffer };
            let job = pass.prepare(gpu, &cover, buffers)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let expected: Vec<u32> = (heights.chunks_exact((width * width) as usize).zip(&places))
                .flat_map(|(window, place)| texels(window, width as usize, &cover, *place))
                .collect();
            let name = format!("{width}×{width} × {count}, {} zones, {} texels", zones.len(), 1 << edge_log2);
            check_exact(cases, name, &output, &expected).await?;
        }
    }
    Ok(())
}

/// Measures a batch of 64 patches with four zones, whose textures lie on three planes: twelve texels of eight bytes a pixel.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = windows.points(1);
    let words = Buffer::new(gpu, "words", points)?;
    let config = TerrainConfig::new(257, 40.0, "bench")?;
    let cover = Cover { triplanar: true, ..Cover::new(&config, &TerrainTexture::of_zones(&config.zones)?)? };
    let places = Buffer::from_slice(gpu, "places", &vec![[0_u32; 2]; count as usize])?;
    let buffers = BlendBuffers { windows: &windows, places: &places, pixels: &words };
    let job = TexelsPass::new(gpu)?.prepare(gpu, &cover, buffers)?;
    // A copy reads half of the bytes that it moves, and writes the other half.
    let copied = copy_of(gpu, points)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::recorded(Backend::Copy, |encoder| (0..12).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            let window = &host[..(width * width) as usize];
            (0..count)
                .for_each(|_| drop(std::hint::black_box(texels(window, width as usize, &cover, [0; 2]))));
        }),
    ];
    bench.case("257x257 batch 64, 4 zones", 12 * points, "texel", 96 * points as u64, contenders)
}
