//! Parity and benchmark cases of `kernels/terrain/blend.wgsl`, and with it of zones and of how textures lie on the ground.
//!
//! In the benchmark, `limit` loads the same texels and makes nothing of them.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::terrain::blend::reference::{blend, prominence, steepness, texel, tiles_of, zone_weight};
use relievo::ops::terrain::blend::{BlendBuffers, BlendPass, COLOR_BOUND, MAP_BOUND, Shading, WeightMode};
use relievo::ops::terrain::config::{Slope, TerrainConfig, Zone};
use relievo::ops::terrain::cover::{Cover, ShaderZone};
use relievo::ops::terrain::normals::reference::normals;
use relievo::ops::terrain::texture::TerrainTexture;

use crate::baseline::texels::TexelsPass;
use crate::cases::terrain::{copy_of, random_cover, random_windows, some_windows};
use crate::harness::compare::{Comparison, LeftOut, levels};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// One pixel in this many may differ: rounding changes 1 in 50, and a curve that is 1/20 of a level wrong 1 in 10.
const MOST_DIFFER: usize = 20;

/// The cases cover one to 32 zones, overlapping and apart, both weight modes, heights beyond every zone, slopes, height maps,
/// textures of every size, triplanar mapping and variation.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for weights in [WeightMode::Normalized, WeightMode::Additive] {
        for (zone_count, gap) in [(1, 0.0), (2, 50.0), (4, 0.0), (4, 9.0), (32, -1.0)] {
            for size in [[3, 1], [66, 3], [67, 2]] {
                let zones: Vec<_> = (0..zone_count).map(|zone| striped(zone, gap)).collect();
                let name = format!("{zone_count} zones {gap} apart, {weights:?}");
                compare(cases, name, &random_cover(&zones, 0), weights, size).await?;
            }
        }
        for (triplanar, variation) in [(false, 0.0), (true, 0.0), (false, 1.0), (true, 0.4)] {
            for edge_log2 in [0, 3, 9] {
                let zones: Vec<_> = (0..4).map(sloped).collect();
                let cover = Cover { triplanar, variation, ..random_cover(&zones, edge_log2) };
                let name =
                    format!("slopes, {} texels, {triplanar}, {variation}, {weights:?}", 1 << edge_log2);
                compare(cases, name, &cover, weights, [67, 2]).await?;
            }
        }
    }
    Ok(())
}

async fn compare(
    cases: &mut Cases<'_>,
    name: String,
    cover: &Cover,
    weights: WeightMode,
    [width, count]: [u32; 2],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let (heights, windows) = random_windows(gpu, [width, count], 60 << 16)?;
    let output = Poisoned::new(gpu, windows.points(1))?;
    let shading = Shading { weights, ..Shading::default() };
    let places: Vec<_> =
        (0..count as i32).map(|index| cover.place([index, -3 * index - 1], width - 2)).collect();
    let place_buffer = Buffer::from_slice(gpu, "places", &places)?;
    let buffers = BlendBuffers { windows: &windows, places: &place_buffer, pixels: &output.buffer };
    let job = BlendPass::new(gpu)?.prepare(gpu, cover, &shading, buffers)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let maps = || heights.chunks_exact((width * width) as usize).zip(&places);
    let expected: Vec<u32> =
        maps().flat_map(|(window, place)| blend(window, width as usize, cover, &shading, *place)).collect();
    // Where rounding may move the weights by too much of their sum, the bound does not hold; there are few such pixels.
    let is_left_out: Vec<bool> = maps()
        .flat_map(|(window, place)| color_errors(window, width as usize, cover, weights, *place))
        .map(|error| error > COLOR_BOUND)
        .collect();
    let left_out = is_left_out.iter().filter(|left_out| **left_out).count();
    let (of, name) = (expected.len(), format!("{width}×{width} × {count}, {name}"));
    let left_out = LeftOut { count: left_out, of, most: of / 20 };
    let compared = output
        .check(gpu, |actual| {
            let judged: Vec<u32> = (actual.iter().zip(&expected).zip(&is_left_out))
                .map(|((actual, expected), left_out)| if *left_out { *expected } else { *actual })
                .collect();
            // What was written beyond the output is judged by `output`.
            nearly_equal(&judged, &expected).leaving_out(left_out)
        })
        .await?;
    cases.add(name, compared);
    Ok(())
}

/// Bound on the difference between a device's linear colour and the reference's, for each pixel of a map
/// (`docs/rounding-bounds.md`).
fn color_errors(window: &[i32], width: usize, cover: &Cover, mode: WeightMode, place: [u32; 2]) -> Vec<f32> {
    let (_, normals) = normals(window, width, cover.terrain_scale);
    let inner = (1..width - 1).flat_map(|y| (1..width - 1).map(move |x| [x, y]));
    let error = |([x, y], normal): ([usize; 2], &[f32; 3])| {
        let fixed = window[y * width + x];
        let (height, steep) = (fixed as f32 / 65_536.0, steepness(*normal));
        let tiles = tiles_of(cover, place, [x - 1, y - 1], fixed);
        // Sums over all zones: of the widths of the intervals of weights, and of weights; each also with prominences.
        let [mut width, mut sum, mut prominent_width, mut prominent_sum] = [0.0_f32; 4];
        for map_zone in &cover.zones {
            let zone = &map_zone.zone;
            let [low, high] = weight_interval(zone, height, steep);
            let (weight, texel) = (zone_weight(zone, height, steep), texel(cover, map_zone, *normal, tiles));
            let prominence = prominence(zone, texel[3]);
            (width, sum) = (width + (high - low), sum + weight);
            prominent_width += prominence * (high - low);
            prominent_sum += prominence * weight;
        }
        let moved = if prominent_width == 0.0 { 0.0 } else { prominent_width / prominent_sum };
        match mode {
            WeightMode::Normalized => moved + 700.0 * f32::EPSILON,
            WeightMode::Additive => sum.max(1.0) * (moved + 700.0 * f32::EPSILON) + width,
        }
    };
    inner.zip(&normals).map(error).collect()
}

/// The lowest and the highest weight of a zone that rounding may give.
fn weight_interval(zone: &ShaderZone, height: f32, steep: f32) -> [f32; 2] {
    let around = |value: f32, error: f32| [value - f32::EPSILON * error, value + f32::EPSILON * error];
    let line = |[factor, offset]: [f32; 2]| {
        let product = factor * steep;
        around(product + offset, 24.0 * product.abs() + 2.0)
    };
    let range = zone.max - zone.min;
    let by_height = around(1.0 - (height - zone.max).abs() / range, 4.0 * height.abs() / range + 9.0);
    let factors = [by_height, line(zone.rise), line(zone.fall)];
    [0, 1].map(|end| factors.iter().map(|factor| factor[end].clamp(0.0, 1.0)).product())
}

/// Compares within [`MAP_BOUND`]; most pixels must be equal.
fn nearly_equal(actual: &[u32], expected: &[u32]) -> Comparison {
    let values = expected.len();
    let differ = actual.iter().zip(expected).filter(|(actual, expected)| actual != expected).count();
    if differ > 1 + values / MOST_DIFFER {
        let fault = format!("{differ} of {values} pixels differ, and 1 in {MOST_DIFFER} may");
        return Comparison::failed(values, fault);
    }
    levels(actual, expected, MAP_BOUND)
}

fn striped(zone: u32, gap: f64) -> Zone {
    let min = -20.0 + f64::from(zone) * (4.0 + gap);
    Zone::new(min, min + 4.0, None)
}

/// Zones on slopes of their own, with height maps, and with textures that repeat.
fn sloped(zone: u32) -> Zone {
    let [min, max, fade] =
        [[0.0, 30.0, 12.0], [25.0, 90.0, 1.0], [0.0, 90.0, 10.0], [40.0, 70.0, 45.0]][zone as usize];
    let low = -40.0 + 25.0 * f64::from(zone);
    Zone {
        slope: Slope { min, max, fade },
        height_blend: f64::from(zone) / 3.0,
        repeats: 1 + 5 * zone,
        ..Zone::new(low, low + 60.0, None)
    }
}

/// Measures a batch of 64 patches with four zones: textures from above alone, and all that a cover may have.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let plain = TerrainConfig::new(257, 40.0, "bench")?;
    case(bench, "257x257 batch 64, 4 zones", &plain)?;
    let rich = TerrainConfig { triplanar: true, variation: 0.5, ..plain };
    case(bench, "257x257 batch 64, 4 zones, triplanar, variation", &rich)
}

fn case(bench: &mut Bench<'_>, name: &str, config: &TerrainConfig) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (width, count) = (259_u32, 64);
    let (host, windows) = some_windows(gpu, width, count)?;
    let points = windows.points(1);
    let pixels = Buffer::new(gpu, "pixels", points)?;
    let cover = Cover::new(config, &TerrainTexture::of_zones(&config.zones)?)?;
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
    bench.case(name, points, "point", 8 * points as u64, contenders)
}
