//! What the cases of `kernels/terrain/height.wgsl`, `smooth.wgsl`, `wrap.wgsl` and `noise.wgsl` have in common.
//!
//! In their benchmarks, `limit` draws and stores the same number of random words; `copy` moves 4 bytes per point.

use std::hint::black_box;

use rayon::prelude::*;
use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::config::{Border, HeightGenerator, Offset, TerrainConfig};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::regions::{HeightBuffers, HeightScratch, RegionJob, RegionPass};
use relievo::ops::terrain::window::{Window, Windows};
use relievo::ops::terrain::wrap::reference::wrap;

use crate::baseline::words::WordsPass;
use crate::cases::terrain::{check_exact, copy_of, some_patches};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

pub(super) const OFFSETS: [Offset; 3] = [Offset::Signed, Offset::Positive, Offset::Gaussian];

/// Prepares the kernel of a configuration, with scratch of its own.
fn prepared(
    gpu: &Gpu,
    config: &TerrainConfig,
    features: &Features,
    windows: Windows,
    output: &Buffer<i32>,
) -> Result<RegionJob, Error> {
    let scratch = HeightScratch::new(gpu, config, windows)?;
    let mode = features.injection();
    // A point counts in every window that sees it.
    let capacity = features.len() * windows.count as usize;
    let buffers = HeightBuffers { output, scratch: &scratch };
    RegionPass::new(gpu, config, mode)?.prepare(gpu, config, windows, capacity, buffers)
}

fn reference(config: &TerrainConfig, features: &Features, window: Window) -> Vec<i32> {
    match config.border {
        Border::Seamless => region(config, features, window.region(config)),
        _ => wrap(config, features, window.patch),
    }
}

/// Compares the windows of `patches` with `apron`.
pub(super) async fn check(
    cases: &mut Cases<'_>,
    config: &TerrainConfig,
    features: &Features,
    patches: &[[i32; 2]],
    apron: u32,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let windows = Windows { count: patches.len() as u32, apron };
    let output = Poisoned::new(gpu, windows.points(config))?;
    let job = prepared(gpu, config, features, windows, &output.buffer)?;
    job.set(gpu, patches, features)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> =
        patches.iter().flat_map(|&patch| reference(config, features, Window { patch, apron })).collect();
    let (size, offset, k) = (config.patch_size, config.offset, config.coarse_levels);
    let injected =
        features.injection().map_or(String::new(), |mode| format!(" {mode:?} {} features", features.len()));
    let name = format!(
        "{size}×{size} {offset:?} k={k} apron {apron} × {} at {:?}{injected}",
        patches.len(),
        patches[0]
    );
    check_exact(cases, name, &output, &expected).await
}

/// Compares windows in which every point of a patch is injected, so that rows of windows end anywhere in a word of the index,
/// and points outside of windows see features.
pub(super) async fn check_dense(
    cases: &mut Cases<'_>,
    config: &TerrainConfig,
    patches: &[[i32; 2]],
    apron: u32,
) -> Result<(), Error> {
    let size = config.patch_size;
    let points = (0..size * size).flat_map(|i| [f64::from(i % size), f64::from(i / size), f64::from(i % 7)]);
    let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: points.collect() };
    let features = Features::new(config, &[file], FeatureMode::Additive)?;
    check(cases, config, &features, patches, apron).await
}

/// Measures a batch of `count` patches.
pub(super) fn measure_levels(
    bench: &mut Bench<'_>,
    config: &TerrainConfig,
    features: &Features,
    count: u32,
) -> Result<(), Error> {
    let gpu = bench.gpu;
    let patches = some_patches(count);
    let windows = Windows { count, apron: 0 };
    let points = windows.points(config);
    let output = Buffer::new(gpu, "heights", points)?;
    let job = prepared(gpu, config, features, windows, &output)?;
    job.set(gpu, &patches, features)?;
    let copied = copy_of(gpu, points)?;
    let words = Buffer::new(gpu, "words", points.next_multiple_of(1024))?;
    let rows = words.len() as u32 / 1024;
    let drawn = WordsPass::new(gpu)?.prepare(gpu, config.key(), [1024, rows], &words)?;
    let made = |patch: &[i32; 2]| {
        drop(black_box(reference(config, features, Window { patch: *patch, apron: 0 })));
    };
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Limit, &drawn),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || patches.iter().for_each(made)),
        Contender::host(Backend::ReferenceParallel, || patches.par_iter().for_each(made)),
    ];
    let size = config.patch_size;
    let generator = match config.generator {
        HeightGenerator::DiamondSquare => String::new(),
        generator => format!(" {generator:?}").to_lowercase(),
    };
    let valleys = if features.is_empty() { "" } else { " valleys" };
    let name = format!("{size}x{size} batch {count}{generator}{valleys}");
    bench.case(name, points, "point", 4 * points as u64, contenders)
}
