//! Parity: every kernel against its CPU reference, on the current adapter (`relievo verify`). This is part of
//! the product, so that users can find out whether their driver computes correctly.

mod summary;

use serde::Serialize;

use crate::Error;
use crate::gpu::{AdapterSummary, Gpu};
use crate::harness::compare::Comparison;
use crate::harness::{CaseResult, Cases, Skipped, selected};
use crate::{animation, baseline, lod, mesh, skinning, surface, terrain};

/// The parity cases of a kernel.
#[derive(Clone, Copy)]
pub struct Stem {
    /// The kernel's path below `kernels/`, without extension.
    pub name: &'static str,
    /// Runs its cases.
    pub run: fn(&mut Cases<'_>) -> Result<(), Error>,
}

/// The parity cases of every kernel.
pub static STEMS: &[Stem] = &[
    Stem { name: "baseline/copy", run: baseline::copy::verify::cases },
    Stem { name: "baseline/gather", run: baseline::gather::verify::cases },
    Stem { name: "baseline/loads", run: baseline::loads::verify::cases },
    Stem { name: "baseline/texels", run: baseline::texels::verify::cases },
    Stem { name: "baseline/words", run: baseline::words::verify::cases },
    Stem { name: "terrain/height", run: terrain::height::verify::cases },
    Stem { name: "terrain/smooth", run: terrain::smooth::verify::cases },
    Stem { name: "terrain/wrap", run: terrain::wrap::verify::cases },
    Stem { name: "terrain/border", run: terrain::border::verify::cases },
    Stem { name: "terrain/pad", run: terrain::pad::verify::cases },
    Stem { name: "terrain/despike", run: terrain::despike::verify::cases },
    Stem { name: "terrain/thermal", run: terrain::thermal::verify::cases },
    Stem { name: "terrain/hydraulic", run: terrain::hydraulic::verify::cases },
    Stem { name: "terrain/normals", run: terrain::normals::verify::cases },
    Stem { name: "terrain/morph", run: terrain::morph::verify::cases },
    Stem { name: "terrain/blend", run: terrain::blend::verify::cases },
    Stem { name: "surface/height_pyramid", run: surface::height_pyramid::verify::cases },
    Stem { name: "surface/cone_map", run: surface::cone_map::verify::cases },
    Stem { name: "surface/relief", run: surface::relief::verify::cases },
    Stem { name: "surface/shade", run: surface::shade::verify::cases },
    Stem { name: "surface/tangent", run: surface::tangent::verify::cases },
    Stem { name: "mesh/cluster", run: mesh::cluster::verify::cases },
    Stem { name: "animation/keyframe_cursor", run: animation::keyframe_cursor::verify::cases },
    Stem { name: "animation/clip_clock", run: animation::clip_clock::verify::cases },
    Stem { name: "animation/gate", run: animation::gate::verify::cases },
    Stem { name: "animation/budget", run: animation::budget::verify::cases },
    Stem { name: "animation/drive", run: animation::drive::verify::cases },
    Stem { name: "animation/compact", run: animation::compact::verify::cases },
    Stem { name: "animation/decide", run: animation::decide::verify::cases },
    Stem { name: "animation/sample", run: animation::sample::verify::cases },
    Stem { name: "animation/local_to_model", run: animation::local_to_model::verify::cases },
    Stem { name: "animation/bounds", run: animation::bounds::verify::cases },
    Stem { name: "skinning/lod", run: skinning::lod::verify::cases },
    Stem { name: "skinning/palette", run: skinning::palette::verify::cases },
    Stem { name: "skinning/morph_weights", run: skinning::morph_weights::verify::cases },
    Stem { name: "skinning/morph", run: skinning::morph::verify::cases },
    Stem { name: "skinning/pages", run: skinning::pages::verify::cases },
    Stem { name: "skinning/select", run: skinning::select::verify::cases },
    Stem { name: "skinning/skin", run: skinning::skin::verify::cases },
    Stem { name: "lod/select", run: lod::select::verify::cases },
    Stem { name: "lod/list", run: lod::list::verify::cases },
    Stem { name: "lod/single", run: lod::single::verify::cases },
    Stem { name: "lod/assign", run: lod::assign::verify::cases },
    Stem { name: "lod/attach", run: lod::attach::verify::cases },
];

/// The results of all cases on one adapter.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The adapter.
    pub adapter: AdapterSummary,
    /// relievo's version.
    pub version: &'static str,
    /// Whether every case holds.
    pub holds: bool,
    /// The results, case by case.
    pub cases: Vec<CaseResult>,
    /// The cases that this device cannot run.
    pub skipped: Vec<Skipped>,
}

/// Runs the cases of every selected kernel, and calls `progress` with each result.
///
/// # Errors
/// [`crate::InputError`] when nothing is selected; errors of the device.
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

/// Runs the cases of the given kernels. A kernel without results does not hold, since nothing was proven.
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
