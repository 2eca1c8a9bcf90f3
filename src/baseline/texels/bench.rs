//! Benchmark cases of `baseline/texels`: the texel loads of a colour map of four zones, beside a copy of as many bytes.

use crate::Error;
use crate::baseline::texels::TexelsPass;
use crate::baseline::texels::reference::texels;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_windows};
use crate::terrain::blend::BlendBuffers;
use crate::terrain::config::Config;
use crate::terrain::cover::Cover;
use crate::terrain::texture::Texture;

/// Measures a batch of 64 patches with four zones, whose textures lie on three planes: twelve texels of eight bytes a pixel.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = windows.points(1);
    let words = Buffer::new(gpu, "words", points)?;
    let config = Config::new(257, 40.0, "bench")?;
    let cover = Cover { triplanar: true, ..Cover::new(&config, &Texture::of_zones(&config.zones)?)? };
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
    bench.case("257x257 batch 64, 4 zones", (12 * points, "texel"), 96 * points as u64, contenders)
}
