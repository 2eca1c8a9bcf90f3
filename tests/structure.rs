//! Every kernel has parity cases and a benchmark, and stays within WebGPU's limits. `tests/house.rs` checks its
//! files.
#![cfg(feature = "gpu")]

#[path = "harness/mod.rs"]
mod harness;

use std::collections::BTreeSet;

use relievo::bench;
use relievo::harness::Backend;
use relievo::verify;

use relievo::gpu::shaders::{ALL, Binding, BindingKind, Shader, Stage};

fn kernels() -> Vec<&'static str> {
    let compute = |shader: &&&Shader| shader.entry_points.iter().any(|entry| entry.stage == Stage::Compute);
    ALL.iter().filter(compute).map(|shader| shader.name).collect()
}

/// What the lists lack for a kernel.
fn lacking(stem: &str) -> Vec<&'static str> {
    let verified = verify::STEMS.iter().any(|entry| entry.name == stem);
    let measured = bench::STEMS.iter().any(|entry| entry.name == stem);
    [("an entry in verify::STEMS", verified), ("an entry in bench::STEMS", measured)]
        .into_iter()
        .filter_map(|(entry, is_there)| (!is_there).then_some(entry))
        .collect()
}

#[test]
fn every_kernel_has_parity_cases_and_a_benchmark() {
    for stem in kernels() {
        assert_eq!(lacking(stem), Vec::<&str>::new(), "{stem}");
    }
    assert_eq!(lacking("terrain/nothing").len(), 2);
}

/// What a kernel's benchmark lacks: a kernel and a reference in every case, and something that both are measured
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
    let references = &[Backend::Reference, Backend::ReferenceParallel][..];
    let needed = [&[Backend::Gpu][..], references, &[Backend::Copy, Backend::Limit]];
    (cases.iter().flat_map(|case| needed.map(|backends| (case, backends))))
        .filter(|(case, backends)| !has(case, backends))
        .map(|(case, backends)| format!("one of {backends:?} in {case}"))
        .collect()
}

#[test]
fn every_benchmark_measures_kernel_reference_and_baseline() {
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

/// Shaders that need more than WebGPU's default limits: `Dispatches::of` takes this one only where a device allows it.
const OPTIONAL: &[&str] = &["animation/decide"];

/// `Gpu::headless` opens devices that permit more bindings, so nothing else would notice.
#[test]
fn all_but_optional_shaders_are_within_the_default_limits() {
    let most = wgpu::Limits::default().max_storage_buffers_per_shader_stage;
    for shader in ALL {
        let bound =
            [Stage::Vertex, Stage::Fragment, Stage::Compute].map(|stage| storage_buffers(shader, stage));
        let needed = bound.into_iter().max().filter(|buffers| *buffers > most);
        // What `build.rs` says of it, and nothing else.
        let said: Vec<_> = shader.limits.iter().map(|limit| (limit.name, limit.needed)).collect();
        let expected: Vec<_> =
            needed.iter().map(|needed| ("maxStorageBuffersPerShaderStage", *needed)).collect();
        assert_eq!(said, expected, "{}", shader.name);
        assert_eq!(needed.is_some(), OPTIONAL.contains(&shader.name), "{} binds {bound:?}", shader.name);
    }
}

fn storage_buffers(shader: &Shader, stage: Stage) -> u32 {
    let is_counted = |binding: &&Binding| {
        let kinds = [BindingKind::StorageRead, BindingKind::StorageReadWrite];
        kinds.contains(&binding.kind) && binding.stages.contains(&stage)
    };
    shader.bindings.iter().filter(is_counted).count() as u32
}
