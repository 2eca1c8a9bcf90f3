//! Parity: every kernel against its twin, on the adapter at hand. Part of the product, so that a user with a
//! strange driver finds out (`relievo verify`).

pub mod animation;
pub mod baseline;
pub mod compare;
pub mod poison;
pub mod skinning;
pub mod surface;
pub mod terrain;

use serde::Serialize;

use crate::Error;
use crate::gpu::{AdapterSummary, Gpu};
use compare::Comparison;

/// A kernel's parity cases.
#[derive(Clone, Copy)]
pub struct Stem {
    /// The kernel's path below `kernels/`, without extension.
    pub name: &'static str,
    /// Runs its cases.
    pub run: fn(&mut Cases<'_>) -> Result<(), Error>,
}

/// Every kernel with its parity cases.
pub static STEMS: &[Stem] = &[
    Stem { name: "baseline/copy", run: baseline::copy::cases },
    Stem { name: "baseline/gather", run: baseline::gather::cases },
    Stem { name: "baseline/loads", run: baseline::loads::cases },
    Stem { name: "baseline/words", run: baseline::words::cases },
    Stem { name: "terrain/height", run: terrain::height::cases },
    Stem { name: "terrain/wrap", run: terrain::wrap::cases },
    Stem { name: "terrain/border", run: terrain::border::cases },
    Stem { name: "terrain/pad", run: terrain::pad::cases },
    Stem { name: "terrain/despike", run: terrain::despike::cases },
    Stem { name: "terrain/thermal", run: terrain::thermal::cases },
    Stem { name: "terrain/normals", run: terrain::normals::cases },
    Stem { name: "terrain/morph", run: terrain::morph::cases },
    Stem { name: "terrain/blend", run: terrain::blend::cases },
    Stem { name: "surface/height_pyramid", run: surface::height_pyramid::cases },
    Stem { name: "surface/cone_map", run: surface::cone_map::cases },
    Stem { name: "surface/relief", run: surface::relief::cases },
    Stem { name: "surface/tangent", run: surface::tangent::cases },
    Stem { name: "animation/place", run: animation::place::cases },
    Stem { name: "animation/phase", run: animation::phase::cases },
    Stem { name: "animation/gate", run: animation::gate::cases },
    Stem { name: "animation/budget", run: animation::budget::cases },
    Stem { name: "animation/compact", run: animation::compact::cases },
    Stem { name: "animation/decide", run: animation::decide::cases },
    Stem { name: "animation/sample", run: animation::sample::cases },
    Stem { name: "animation/concat", run: animation::concat::cases },
    Stem { name: "animation/bounds", run: animation::bounds::cases },
    Stem { name: "skinning/lod", run: skinning::lod::cases },
    Stem { name: "skinning/palette", run: skinning::palette::cases },
    Stem { name: "skinning/morph_weights", run: skinning::morph_weights::cases },
    Stem { name: "skinning/morph", run: skinning::morph::cases },
    Stem { name: "skinning/select", run: skinning::select::cases },
    Stem { name: "skinning/skin", run: skinning::skin::cases },
];

/// One case's result.
#[derive(Debug, Clone, Serialize)]
pub struct CaseResult {
    /// The kernel.
    pub stem: &'static str,
    /// What was computed.
    pub case: String,
    /// What came of it.
    #[serde(flatten)]
    pub comparison: Comparison,
}

/// Every case's result on one adapter.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The adapter.
    pub adapter: AdapterSummary,
    /// relievo's version.
    pub version: &'static str,
    /// Whether every case holds.
    pub holds: bool,
    /// The cases.
    pub cases: Vec<CaseResult>,
    /// Cases that this device cannot run.
    pub skipped: Vec<Skipped>,
}

/// A case that a device cannot run.
#[derive(Debug, Clone, Serialize)]
pub struct Skipped {
    /// The kernel.
    pub stem: &'static str,
    /// What would have been computed.
    pub case: String,
    /// Why it cannot be.
    pub reason: String,
}

/// Collects the cases of a run.
pub struct Cases<'a> {
    /// The device that is being verified.
    pub gpu: &'a Gpu,
    stem: &'static str,
    results: Vec<CaseResult>,
    skipped: Vec<Skipped>,
    progress: &'a mut dyn FnMut(&CaseResult),
}

impl Cases<'_> {
    /// Adds a case.
    pub fn add(&mut self, case: impl Into<String>, comparison: Comparison) {
        let result = CaseResult { stem: self.stem, case: case.into(), comparison };
        (self.progress)(&result);
        self.results.push(result);
    }

    /// Says that this device cannot run a case, and why. A kernel of which it can run none does not hold.
    pub fn skip(&mut self, case: impl Into<String>, reason: impl Into<String>) {
        self.skipped.push(Skipped { stem: self.stem, case: case.into(), reason: reason.into() });
    }
}

/// Whether `stem` is asked for: `only` is a stem, a part of one, or nothing.
pub fn selected(stem: &str, only: Option<&str>) -> bool {
    only.is_none_or(|only| stem.contains(only))
}

/// Runs the cases of every selected kernel; `progress` hears of each.
///
/// # Errors
/// [`crate::InputError`] when nothing is selected; what the device reports.
pub fn run(gpu: &Gpu, only: Option<&str>, progress: &mut dyn FnMut(&CaseResult)) -> Result<Report, Error> {
    let chosen: Vec<_> = STEMS.iter().filter(|stem| selected(stem.name, only)).collect();
    if chosen.is_empty() {
        let names = STEMS.iter().map(|stem| stem.name).collect::<Vec<_>>().join(", ");
        return Err(crate::InputError::new(
            "only",
            only.unwrap_or(""),
            format!("must be (part of) one of {names}"),
        )
        .into());
    }
    run_stems(gpu, chosen, progress)
}

/// Runs the cases of these kernels. One without any does not hold: nothing was proven.
///
/// # Errors
/// What the device reports.
pub fn run_stems<'a>(
    gpu: &Gpu,
    stems: impl IntoIterator<Item = &'a Stem>,
    progress: &mut dyn FnMut(&CaseResult),
) -> Result<Report, Error> {
    let (mut all, mut skipped) = (Vec::new(), Vec::new());
    for stem in stems {
        let mut cases = Cases { gpu, stem: stem.name, results: Vec::new(), skipped: Vec::new(), progress };
        (stem.run)(&mut cases)?;
        if cases.results.is_empty() {
            cases.add("no case", Comparison::failed(0, "the kernel has no parity case".to_owned()));
        }
        all.append(&mut cases.results);
        skipped.append(&mut cases.skipped);
    }
    let holds = !all.is_empty() && all.iter().all(|result| result.comparison.holds);
    Ok(Report {
        adapter: gpu.adapter().clone(),
        version: env!("CARGO_PKG_VERSION"),
        holds,
        cases: all,
        skipped,
    })
}
