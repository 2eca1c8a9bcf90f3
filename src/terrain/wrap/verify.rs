//! Parity cases of `kernels/terrain/wrap.wgsl`.

use serde_json::json;

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::Cases;
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::terrain::blocks::Order;
use crate::terrain::config::{Config, Offset};
use crate::terrain::features::Features;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::verify::{config, scattered};
use crate::terrain::wrap::reference::wrap;
use crate::terrain::wrap::{WrapBuffers, WrapJob, WrapPass};

/// The cases cover every size and distribution, equal and unequal corners, features.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    in_order(cases, Order::SOFTWARE, 12)?;
    in_order(cases, Order::HARDWARE, 9)
}

/// The cases up to patches of 2^`most` + 1 samples.
fn in_order(cases: &mut Cases<'_>, order: Order, most: u32) -> Result<(), Error> {
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
            check(cases, (&pass, order), &config, &Features::default(), patches)?;
        }
    }
    for mode in [FeatureMode::Keep, FeatureMode::Additive] {
        let pass = WrapPass::with_order(cases.gpu, Offset::Signed, Some(mode), order)?;
        for (case, size) in [3, 5, 33, 65, 513].into_iter().enumerate() {
            let config =
                config(&json!({"patchSize": size, "scaleFactor": 40.0, "seed": "wrap", "border": "wrap"}))?;
            let features = scattered(&config, [2, -3], mode, 50 + case as u32)?;
            check(cases, (&pass, order), &config, &features, &[[2, -3], [3, -2], [7, 7]])?;
        }
    }
    Ok(())
}

fn check(
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
    gpu.run("verify", |encoder| job.record(encoder))?;
    let expected: Vec<i32> = patches.iter().flat_map(|&patch| wrap(config, features, patch)).collect();
    let injection = features.injection().map_or(String::new(), |mode| format!(" {mode:?} features"));
    let name =
        format!("{0}×{0} {1:?} × {count}{injection}, {2} rows", config.patch_size, config.offset, order.rows);
    cases.add(name, output.check(gpu, |actual| exact(actual, &expected))?);
    Ok(())
}
