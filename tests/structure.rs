//! One operation, one stem: every kernel has a twin, parity cases, a benchmark and a host, and structs are laid
//! out as the shaders see them.
#![cfg(feature = "gpu")]

#[path = "harness/mod.rs"]
mod harness;

use std::collections::BTreeSet;
use std::path::Path;

use relievo::bench;
use relievo::harness::Backend;
use relievo::verify;

use relievo::gpu::shaders::{ALL, Binding, BindingKind, Stage};

fn kernels() -> Vec<&'static str> {
    let compute = |shader: &&&relievo::gpu::shaders::Shader| {
        shader.entry_points.iter().any(|entry| entry.stage == Stage::Compute)
    };
    ALL.iter().filter(compute).map(|shader| shader.name).collect()
}

/// What a kernel lacks.
fn lacking(stem: &str) -> Vec<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut lacking: Vec<String> = ["src", "src/reference", "src/verify", "src/bench"]
        .iter()
        .map(|folder| format!("{folder}/{stem}.rs"))
        .filter(|file| !root.join(file).exists())
        .collect();
    if !relievo::verify::STEMS.iter().any(|entry| entry.name == stem) {
        lacking.push("an entry in verify::STEMS".to_owned());
    }
    if !relievo::bench::STEMS.iter().any(|entry| entry.name == stem) {
        lacking.push("an entry in bench::STEMS".to_owned());
    }
    lacking
}

#[test]
fn every_kernel_has_host_twin_parity_cases_and_benchmark() {
    let kernels = kernels();
    assert!(kernels.len() >= 11, "the manifest lost kernels: {kernels:?}");
    for stem in kernels {
        assert_eq!(lacking(stem), Vec::<String>::new(), "{stem}");
    }
}

#[test]
fn a_kernel_without_them_is_reported() {
    assert_eq!(lacking("terrain/nothing").len(), 6);
}

/// What a kernel's benchmark lacks: a kernel and a twin in every case, and something that both are measured
/// against.
fn unmeasured(stem: &bench::Stem) -> Vec<String> {
    let rows = bench::unmeasured(&harness::gpu(), stem).expect("the device works");
    let cases: BTreeSet<_> = rows.iter().map(|row| row.case.as_str()).collect();
    if cases.is_empty() {
        return vec!["a case".to_owned()];
    }
    let has = |case: &str, backends: &[Backend]| {
        rows.iter().any(|row| row.case == case && row.items > 0 && backends.contains(&row.backend))
    };
    let twins = &[Backend::Twin, Backend::TwinParallel][..];
    let needed = [&[Backend::Gpu][..], twins, &[Backend::Copy, Backend::Limit]];
    (cases.iter().flat_map(|case| needed.map(|backends| (case, backends))))
        .filter(|(case, backends)| !has(case, backends))
        .map(|(case, backends)| format!("one of {backends:?} in {case}"))
        .collect()
}

#[test]
fn every_benchmark_measures_kernel_twin_and_baseline() {
    for stem in bench::STEMS {
        assert_eq!(unmeasured(stem), Vec::<String>::new(), "{}", stem.name);
    }
    let idle = bench::Stem { name: "terrain/height", run: |_| Ok(()) };
    assert_eq!(unmeasured(&idle), ["a case"]);
}

/// `tests/parity.rs` runs the cases of all.
#[test]
fn a_kernel_whose_parity_cases_add_nothing_does_not_hold() {
    let idle = verify::Stem { name: "terrain/height", run: |_| Ok(()) };
    let copy = verify::STEMS.iter().find(|stem| stem.name == "baseline/copy").expect("a stem");
    let run = |stems: &[verify::Stem]| {
        verify::run_stems(&harness::gpu(), stems, &mut |_| ()).expect("the device works").holds
    };
    assert!(run(&[*copy]));
    assert!(!run(&[*copy, idle]));
}

#[test]
fn every_stem_has_a_kernel() {
    let kernels = kernels();
    let stems = relievo::verify::STEMS.iter().map(|stem| stem.name);
    for stem in stems.chain(relievo::bench::STEMS.iter().map(|stem| stem.name)) {
        assert!(kernels.contains(&stem), "{stem} has no kernel");
    }
}

#[test]
fn kernels_have_one_compute_entry_and_render_passes_none() {
    for shader in ALL {
        let compute = shader.entry_points.iter().filter(|entry| entry.stage == Stage::Compute).count();
        let expected = usize::from(!shader.name.starts_with("render/"));
        assert_eq!(compute, expected, "{}", shader.name);
        let default_limit =
            shader.entry_points.iter().map(|entry| entry.workgroup_size.iter().product::<u32>()).max();
        assert!(default_limit.unwrap_or(0) <= 256, "{} exceeds WebGPU's default workgroup", shader.name);
    }
}

/// `Gpu::headless` opens devices that let shaders bind more, so nothing else would tell.
#[test]
fn shaders_bind_no_more_than_web_gpu_allows_by_default() {
    let most = wgpu::Limits::default().max_storage_buffers_per_shader_stage as usize;
    for shader in ALL {
        for stage in [Stage::Vertex, Stage::Fragment, Stage::Compute] {
            let is_counted = |binding: &&Binding| {
                let kinds = [BindingKind::StorageRead, BindingKind::StorageReadWrite];
                kinds.contains(&binding.kind) && binding.stages.contains(&stage)
            };
            let buffers = shader.bindings.iter().filter(is_counted).count();
            // `Dispatches::of` takes it only where the device allows it.
            let is_optional = shader.name == "animation/decide";
            assert!(buffers <= most || is_optional, "{} binds {buffers} in {stage:?}", shader.name);
        }
    }
}
