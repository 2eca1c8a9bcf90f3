//! Benchmark cases of `terrain/blend`: the colour map. `limit` loads the same texels and makes nothing of them.

use crate::Error;
use crate::baseline::texels::TexelsPass;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_windows};
use crate::terrain::blend::reference::blend;
use crate::terrain::blend::{BlendBuffers, BlendPass, Shading};
use crate::terrain::config::Config;
use crate::terrain::cover::Cover;
use crate::terrain::texture::Texture;

/// Measures a batch of 64 patches with four zones: textures from above alone, and all that a cover may have.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let plain = Config::new(257, 40.0, "bench")?;
    case(bench, "257x257 batch 64, 4 zones", &plain)?;
    let rich = Config { triplanar: true, variation: 0.5, ..plain };
    case(bench, "257x257 batch 64, 4 zones, triplanar, variation", &rich)
}

fn case(bench: &mut Bench<'_>, name: &str, config: &Config) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = (width as usize - 2).pow(2) * count as usize;
    let pixels = Buffer::new(gpu, "pixels", points)?;
    let cover = Cover::new(config, &Texture::of_zones(&config.zones)?)?;
    let places = Buffer::from_slice(gpu, "places", &vec![[0_u32; 2]; count as usize])?;
    let shading = Shading::default();
    let buffers = BlendBuffers { windows: &windows, places: &places, pixels: &pixels };
    let job = BlendPass::new(gpu)?.prepare(gpu, &cover, &shading, buffers)?;
    let words = Buffer::new(gpu, "words", points)?;
    let loaded = TexelsPass::new(gpu)?.prepare(gpu, &cover, BlendBuffers { pixels: &words, ..buffers })?;
    let copied = copy_of(gpu, points)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Limit, &loaded),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            let window = &host[..(width * width) as usize];
            for _ in 0..count {
                drop(std::hint::black_box(blend(window, width as usize, &cover, &shading, [0; 2])));
            }
        }),
    ];
    bench.case(name, (points, "point"), 8 * points as u64, contenders)
}
