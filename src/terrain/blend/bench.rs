//! Benchmark cases of `terrain/blend`: the colour map.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::{copy_of, some_heights};
use crate::terrain::blend::reference::blend;
use crate::terrain::blend::{BlendPass, MapZone, Shading};
use crate::terrain::fields::Fields;

/// Measures a batch of 64 patches with four zones.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let host = some_heights((width * width * count) as usize);
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &host)?;
    let points = (width as usize - 2).pow(2) * count as usize;
    let pixels = Buffer::new(gpu, "pixels", points)?;
    let zone = |i: i16| MapZone {
        color: [0.2, 0.3, 0.1 * f32::from(i)],
        min: f32::from(20 * i - 60),
        max: f32::from(20 * i - 30),
    };
    let zones = [0, 1, 2, 3].map(zone);
    let shading = Shading::default();
    let job = BlendPass::new(gpu)?.prepare(gpu, 1.0, &zones, &shading, &windows, &pixels)?;
    let copied = copy_of(gpu, points)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            let window = &host[..(width * width) as usize];
            for _ in 0..count {
                drop(std::hint::black_box(blend(window, width as usize, 1.0, &zones, &shading)));
            }
        }),
    ];
    bench.case("257x257 batch 64, 4 zones", (points, "point"), 8 * points as u64, contenders)
}
