//! Parity and benchmark cases of `kernels/terrain/wrap.wgsl`.
//!
//! In the benchmark, `limit` draws and stores the same number of random words; `copy` moves 4 bytes per point.

use rayon::prelude::*;
use relievo::Error;
use relievo::gpu::Buffer;
use relievo::terrain::blocks::Order;
use relievo::terrain::config::{Border, Config, Offset};
use relievo::terrain::features::Features;
use relievo::terrain::fixed::FeatureMode;
use relievo::terrain::wrap::reference::wrap;
use relievo::terrain::wrap::{WrapBuffers, WrapJob, WrapPass};
use serde_json::json;

use crate::baseline::words::WordsPass;
use crate::cases::terrain::{config, copy_of, scattered};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

/// The cases cover every size and distribution, equal and unequal corners, features.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    in_order(cases, Order::SOFTWARE, 12).await?;
    in_order(cases, Order::HARDWARE, 9).await
}

/// The cases up to patches of 2^`most` + 1 samples.
async fn in_order(cases: &mut Cases<'_>, order: Order, most: u32) -> Result<(), Error> {
    for offset in ["signed", "positive", "gaussian"] {
        let code: Offset = serde_json::from_value(json!(offset)).unwrap_or_default();
        let pass = WrapPass::with_order(cases.gpu, code, None, order)?;
        for exponent in (1..=most).filter(|exponent| *exponent <= 9 || offset == "signed") {
            let corners = if exponent % 2 == 0 { json!([1.5, -20.25, 33.3, 1e-5]) } else { json!(2.5) };
            let config = config(&json!({
                "patchSize": (1 << exponent) + 1, "scaleFactor": 40.0, "seed": "wrap", "border": "wrap",
                "offset": offset, "corners": corners,
            }))?;
            let patches: &[_] = if exponent < 10 { &[[0, 0], [-3, 7], [4, 4]] } else { &[[-1, 2]] };
            check(cases, (&pass, order), &config, &Features::default(), patches).await?;
        }
    }
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        let pass = WrapPass::with_order(cases.gpu, Offset::Signed, Some(mode), order)?;
        for (case, size) in [3, 5, 33, 65, 513].into_iter().enumerate() {
            let config =
                config(&json!({"patchSize": size, "scaleFactor": 40.0, "seed": "wrap", "border": "wrap"}))?;
            let features = scattered(&config, [2, -3], mode, 50 + case as u32)?;
            check(cases, (&pass, order), &config, &features, &[[2, -3], [3, -2], [7, 7]]).await?;
        }
    }
    Ok(())
}

async fn check(
    cases: &mut Cases<'_>,
    (pass, order): (&WrapPass, Order),
    config: &Config,
    features: &Features,
    patches: &[[i32; 2]],
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let count = patches.len() as u32;
    let output = Poisoned::new(gpu, patches.len() * (config.patch_size as usize).pow(2))?;
    let scratch = Buffer::new(gpu, "scratch", WrapJob::scratch_points(config, count))?;
    let buffers = WrapBuffers { output: &output.buffer, scratch: &scratch };
    let job = pass.prepare(gpu, config, count, features.len(), buffers)?;
    job.set(gpu, patches, features)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> = patches.iter().flat_map(|&patch| wrap(config, features, patch)).collect();
    let injection = features.injection().map_or(String::new(), |mode| format!(" {mode:?} features"));
    let name =
        format!("{0}×{0} {1:?} × {count}{injection}, {2} rows", config.patch_size, config.offset, order.rows);
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected)).await?);
    Ok(())
}

/// Measures a batch of 64 patches.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let (size, count) = (257_u32, 64_u32);
    let config = Config { border: Border::Wrap, ..Config::new(size, 40.0, "bench")? };
    let patches: Vec<_> = (0..count as i32).map(|i| [i % 8, i / 8]).collect();
    let points = (count * size * size) as usize;
    let output = Buffer::new(gpu, "heights", points)?;
    let scratch = Buffer::new(gpu, "scratch", WrapJob::scratch_points(&config, count))?;
    let buffers = WrapBuffers { output: &output, scratch: &scratch };
    let job = WrapPass::new(gpu, Offset::Signed, None)?.prepare(gpu, &config, count, 0, buffers)?;
    let features = Features::default();
    job.set(gpu, &patches, &features)?;
    let copied = copy_of(gpu, points)?;
    let words = Buffer::new(gpu, "words", points.next_multiple_of(1024))?;
    let rows = words.len() as u32 / 1024;
    let drawn = WordsPass::new(gpu)?.prepare(gpu, config.key(), [1024, rows], &words)?;
    let reference = |patch: &[i32; 2]| drop(std::hint::black_box(wrap(&config, &features, *patch)));
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Limit, &drawn),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || patches.iter().for_each(reference)),
        Contender::host(Backend::ReferenceParallel, || patches.par_iter().for_each(reference)),
    ];
    bench.case(format!("{size}x{size} batch {count}"), (points, "point"), 4 * points as u64, contenders)
}
