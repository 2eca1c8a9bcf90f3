//! Benchmarks: every kernel against its CPU reference and a copy of the same bytes, in one run on the current
//! adapter (`relievo bench`). Results are ratios, since absolute times mean little across machines.

use serde::Serialize;

use crate::gpu::Gpu;
use crate::{Error, InputError};

use crate::harness::{Bench, Row, selected};
use crate::{animation, baseline, lod, mesh, skinning, surface, terrain};

/// The benchmark cases of a kernel.
#[derive(Clone, Copy)]
pub struct Stem {
    /// The kernel's path below `kernels/`, without extension.
    pub name: &'static str,
    /// Runs its cases.
    pub run: fn(&mut Bench<'_>) -> Result<(), Error>,
}

/// The benchmark cases of every kernel.
pub static STEMS: &[Stem] = &[
    Stem { name: "baseline/copy", run: baseline::copy::bench::cases },
    Stem { name: "baseline/gather", run: baseline::gather::bench::cases },
    Stem { name: "baseline/loads", run: baseline::loads::bench::cases },
    Stem { name: "baseline/texels", run: baseline::texels::bench::cases },
    Stem { name: "baseline/words", run: baseline::words::bench::cases },
    Stem { name: "terrain/height", run: terrain::height::bench::cases },
    Stem { name: "terrain/smooth", run: terrain::smooth::bench::cases },
    Stem { name: "terrain/wrap", run: terrain::wrap::bench::cases },
    Stem { name: "terrain/border", run: terrain::border::bench::cases },
    Stem { name: "terrain/pad", run: terrain::pad::bench::cases },
    Stem { name: "terrain/despike", run: terrain::despike::bench::cases },
    Stem { name: "terrain/thermal", run: terrain::thermal::bench::cases },
    Stem { name: "terrain/hydraulic", run: terrain::hydraulic::bench::cases },
    Stem { name: "terrain/normals", run: terrain::normals::bench::cases },
    Stem { name: "terrain/morph", run: terrain::morph::bench::cases },
    Stem { name: "terrain/blend", run: terrain::blend::bench::cases },
    Stem { name: "surface/height_pyramid", run: surface::height_pyramid::bench::cases },
    Stem { name: "surface/cone_map", run: surface::cone_map::bench::cases },
    Stem { name: "surface/shade", run: surface::shade::bench::cases },
    Stem { name: "surface/tangent", run: surface::tangent::bench::cases },
    Stem { name: "mesh/cluster", run: mesh::cluster::bench::cases },
    Stem { name: "animation/keyframe_cursor", run: animation::keyframe_cursor::bench::cases },
    Stem { name: "animation/clip_clock", run: animation::clip_clock::bench::cases },
    Stem { name: "animation/gate", run: animation::gate::bench::cases },
    Stem { name: "animation/budget", run: animation::budget::bench::cases },
    Stem { name: "animation/drive", run: animation::drive::bench::cases },
    Stem { name: "animation/compact", run: animation::compact::bench::cases },
    Stem { name: "animation/decide", run: animation::decide::bench::cases },
    Stem { name: "animation/sample", run: animation::sample::bench::cases },
    Stem { name: "animation/local_to_model", run: animation::local_to_model::bench::cases },
    Stem { name: "animation/bounds", run: animation::bounds::bench::cases },
    Stem { name: "skinning/lod", run: skinning::lod::bench::cases },
    Stem { name: "skinning/palette", run: skinning::palette::bench::cases },
    Stem { name: "skinning/morph_weights", run: skinning::morph_weights::bench::cases },
    Stem { name: "skinning/morph", run: skinning::morph::bench::cases },
    Stem { name: "skinning/pages", run: skinning::pages::bench::cases },
    Stem { name: "skinning/select", run: skinning::select::bench::cases },
    Stem { name: "skinning/skin", run: skinning::skin::bench::cases },
    Stem { name: "lod/select", run: lod::select::bench::cases },
    Stem { name: "lod/list", run: lod::list::bench::cases },
    Stem { name: "lod/single", run: lod::single::bench::cases },
    Stem { name: "lod/assign", run: lod::assign::bench::cases },
    Stem { name: "lod/attach", run: lod::attach::bench::cases },
    // It draws pictures, so it comes last: afterwards lavapipe's timestamps are too short (see its cases).
    Stem { name: "surface/relief", run: surface::relief::bench::cases },
];

/// The results of a run.
#[derive(Debug, Clone, Serialize)]
pub struct Summary {
    /// The adapter.
    pub device: String,
    /// Its driver.
    pub driver: String,
    /// The commit of the build, if known.
    pub commit: String,
    /// Number of threads of `reference-parallel`.
    pub threads: usize,
    /// The results.
    pub rows: Vec<Row>,
}

/// Sets up a kernel's benchmark without measuring, and returns its rows.
///
/// # Errors
/// What the device reports.
pub fn unmeasured(gpu: &Gpu, stem: &Stem) -> Result<Vec<Row>, Error> {
    let progress = &mut |_: &Row| ();
    let mut bench = Bench::new(gpu, stem.name, progress)?.unmeasured();
    (stem.run)(&mut bench)?;
    Ok(bench.into_rows())
}

/// Runs the benchmarks of every selected kernel, and calls `progress` with each row.
///
/// # Errors
/// [`InputError`] when nothing is selected; errors of the device.
pub fn run(gpu: &Gpu, only: Option<&str>, progress: &mut dyn FnMut(&Row)) -> Result<Summary, Error> {
    let chosen: Vec<_> = STEMS.iter().filter(|stem| selected(stem.name, only)).collect();
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
