//! Benchmarks: every kernel beside its twin and a copy of the same bytes, in one run on the adapter at hand
//! (`relievo bench`). Figures are ratios: absolute times mean little across machines.

pub mod animation;
pub mod baseline;
mod measure;
pub mod skinning;
pub mod surface;
mod table;
pub mod terrain;

use serde::Serialize;

use crate::gpu::{Gpu, TimedBy};
use crate::{Error, InputError};

pub use measure::{Bench, Contender};
pub use table::table;

/// A kernel's benchmark cases.
#[derive(Clone, Copy)]
pub struct Stem {
    /// The kernel's path below `kernels/`, without extension.
    pub name: &'static str,
    /// Runs its cases.
    pub run: fn(&mut Bench<'_>) -> Result<(), Error>,
}

/// Every kernel with its benchmark cases.
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
    Stem { name: "surface/shade", run: surface::shade::cases },
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
    // Draws pictures: last, for the sake of lavapipe's clock (see its cases).
    Stem { name: "surface/relief", run: surface::relief::cases },
];

/// What a row measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Backend {
    /// The kernel.
    Gpu,
    /// Its twin on one thread.
    Twin,
    /// Its twin on all threads.
    TwinParallel,
    /// Straightforward structure-of-arrays code for the processor, on one thread.
    PlainSoa,
    /// A kernel that moves the same bytes.
    Copy,
    /// What cannot be avoided: see the benchmark.
    Limit,
}

impl Backend {
    /// Its name in tables and JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Twin => "twin",
            Self::TwinParallel => "twin-parallel",
            Self::PlainSoa => "plain-soa",
            Self::Copy => "copy",
            Self::Limit => "limit",
        }
    }
}

/// One measured figure.
#[derive(Debug, Clone, Serialize)]
pub struct Row {
    /// The kernel.
    pub name: &'static str,
    /// Sizes and batch.
    pub case: String,
    /// What was measured.
    pub backend: Backend,
    /// Median of the repetitions.
    pub nanoseconds: f64,
    /// The shortest.
    pub min: f64,
    /// The longest.
    pub max: f64,
    /// Time beside the kernel's (`gpu`): the median over rounds in which both took their turn. None for the kernel.
    #[serde(skip)]
    pub beside_kernel: Option<f64>,
    /// Items computed.
    pub items: u64,
    /// What an item is.
    pub item: &'static str,
    /// Bytes that must be read and written.
    pub bytes: u64,
    /// The clock.
    pub timed_by: TimedBy,
}

/// A run's figures.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// The adapter.
    pub device: String,
    /// Its driver.
    pub driver: String,
    /// The commit that was built, where known.
    pub commit: String,
    /// Threads of `twin-parallel`.
    pub threads: usize,
    /// The figures.
    pub rows: Vec<Row>,
}

/// What a kernel's benchmark would measure: its rows, set up but not measured.
///
/// # Errors
/// What the device reports.
pub fn unmeasured(gpu: &Gpu, stem: &Stem) -> Result<Vec<Row>, Error> {
    let progress = &mut |_: &Row| ();
    let mut bench = Bench::new(gpu, stem.name, progress)?.unmeasured();
    (stem.run)(&mut bench)?;
    Ok(bench.into_rows())
}

/// Runs the benchmarks of every selected kernel; `progress` hears of each row.
///
/// # Errors
/// [`InputError`] when nothing is selected; what the device reports.
pub fn run(gpu: &Gpu, only: Option<&str>, progress: &mut dyn FnMut(&Row)) -> Result<Summary, Error> {
    let chosen: Vec<_> = STEMS.iter().filter(|stem| crate::verify::selected(stem.name, only)).collect();
    if chosen.is_empty() {
        let names = STEMS.iter().map(|stem| stem.name).collect::<Vec<_>>().join(", ");
        return Err(
            InputError::new("only", only.unwrap_or(""), format!("must be (part of) one of {names}")).into()
        );
    }
    let mut rows = Vec::new();
    for stem in chosen {
        let mut bench = Bench::new(gpu, stem.name, progress)?;
        (stem.run)(&mut bench)?;
        rows.extend(bench.into_rows());
    }
    Ok(Summary {
        device: gpu.adapter().name.clone(),
        driver: gpu.adapter().driver.clone(),
        commit: option_env!("RELIEVO_COMMIT").unwrap_or("unknown").to_owned(),
        threads: rayon::current_num_threads(),
        rows,
    })
}
