//! Benchmark cases of `terrain/height`: the sizes of B table 5.2, one patch and batches of 64. `limit` draws
//! and stores the same number of random words; `copy` moves 4 bytes per point.

use rayon::prelude::*;

use crate::Error;
use crate::baseline::words::WordsPass;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::terrain::bench::copy_of;
use crate::terrain::config::{Config, Offset};
use crate::terrain::features::{FeatureFile, Features};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::height::reference::height;
use crate::terrain::height::{HeightBatch, HeightPass};
use crate::terrain::window::Window;

/// Measures sizes 129 to 1025, and a batch with features.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    for size in [129, 257, 513, 1025] {
        for count in [1, 64] {
            case(bench, size, count, false)?;
        }
    }
    case(bench, 257, 64, true)
}

fn case(bench: &mut Bench<'_>, size: u32, count: u32, with_features: bool) -> Result<(), Error> {
    let gpu = bench.gpu;
    let config = Config::new(size, 40.0, "bench")?;
    let patches: Vec<_> = (0..count as i32).map(|i| [i % 8, i / 8]).collect();
    let features = if with_features { valleys(&config, &patches)? } else { Features::default() };
    let pass = HeightPass::new(gpu, Offset::Signed, features.injection())?;
    // Patches share edges and halos, so that a point may count in several windows.
    let batch = HeightBatch::new(gpu, &pass, &config, [count, 0], 2 * features.len())?;
    batch.set(gpu, &patches, &features)?;
    let points = (count * size * size) as usize;
    let part = points.div_ceil(batch.fields().len());
    let copied = copy_of(gpu, part)?;
    let words = Buffer::new(gpu, "words", part.next_multiple_of(1024))?;
    let rows = words.len() as u32 / 1024;
    let drawn = WordsPass::new(gpu)?.prepare(gpu, config.key(), [1024, rows], &words)?;
    let parts = batch.fields().len();
    let reference = |patch: &[i32; 2]| height(&config, &features, Window { patch: *patch, apron: 0 });
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| batch.record(encoder)),
        Contender::recorded(Backend::Limit, |encoder| (0..parts).for_each(|_| drawn.record(encoder))),
        Contender::recorded(Backend::Copy, |encoder| (0..parts).for_each(|_| copied.record(encoder))),
        Contender::host(Backend::Reference, || {
            patches.iter().for_each(|patch| drop(std::hint::black_box(reference(patch))))
        }),
        Contender::host(Backend::ReferenceParallel, || {
            patches.par_iter().for_each(|patch| drop(std::hint::black_box(reference(patch))));
        }),
    ];
    let name = format!("{size}x{size} batch {count}{}", if with_features { " valleys" } else { "" });
    bench.case(name, (points, "point"), 4 * points as u64, contenders)
}

/// A valley in the middle of every patch: every fourth sample of the patch's middle half is a feature.
fn valleys(config: &Config, patches: &[[i32; 2]]) -> Result<Features, Error> {
    let quarter = config.patch_size / 4;
    let lines = || (quarter..3 * quarter).step_by(4);
    let heights: Vec<f64> =
        lines().flat_map(|y| lines().flat_map(move |x| [f64::from(x), f64::from(y), -20.0])).collect();
    let files: Vec<_> = (patches.iter())
        .map(|patch| FeatureFile { patch_coordinates: *patch, precomputed_heights: heights.clone() })
        .collect();
    Ok(Features::new(config, &files, FeatureMode::Keep)?)
}
