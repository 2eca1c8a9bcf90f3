//! Every kernel has parity cases and a benchmark, and stays within WebGPU's limits. `tests/house.rs` checks its
//! files.

use relievo_testing as harness;

use std::collections::BTreeSet;

use relievo_lab::bench;
use relievo_lab::harness::Backend;
use relievo_lab::{OPERATIONS, Operation, verify};

use relievo::gpu::shaders::{ALL, Binding, BindingKind, Shader, Stage};

fn kernels() -> Vec<&'static str> {
    let compute = |shader: &&&Shader| shader.entry_points.iter().any(|entry| entry.stage == Stage::Compute);
    ALL.iter().filter(compute).map(|shader| shader.name).collect()
}

#[test]
fn every_kernel_has_cases() {
    let kernels = kernels();
    let operations: Vec<_> = OPERATIONS.iter().map(|operation| operation.name).collect();
    for kernel in &kernels {
        assert!(operations.contains(kernel), "{kernel} has no entry in OPERATIONS");
    }
    for operation in operations {
        assert!(kernels.contains(&operation), "{operation} has no kernel");
    }
}

/// An operation without cases.
const IDLE: Operation = Operation {
    name: "terrain/height",
    parity: |_| Box::pin(std::future::ready(Ok(()))),
    benchmark: |_| Ok(()),
};

/// What a kernel's benchmark lacks: a kernel and a reference in every case, and something that both are measured
/// against.
fn unmeasured(operation: &Operation) -> Vec<String> {
    let rows = bench::unmeasured(&harness::gpu(), operation).expect("the device works");
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
    std::thread::scope(|scope| {
        for half in 0..2 {
            scope.spawn(move || {
                for operation in OPERATIONS.iter().skip(half).step_by(2) {
                    assert_eq!(unmeasured(operation), Vec::<String>::new(), "{}", operation.name);
                }
            });
        }
    });
    assert_eq!(unmeasured(&IDLE), ["a case"]);
}

/// `tests/parity.rs` runs the cases of all.
#[test]
fn a_kernel_whose_parity_cases_add_nothing_does_not_hold() {
    let copy = OPERATIONS.iter().find(|operation| operation.name == "baseline/copy").expect("an operation");
    let run = |operations: &[Operation]| {
        let gpu = harness::gpu();
        let report = gpu.block_on(verify::run_operations(&gpu, operations, &mut |_| ()));
        report.expect("the device works").holds
    };
    assert!(run(&[*copy]));
    assert!(!run(&[*copy, IDLE]));
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

#[test]
fn shaders_are_within_the_default_limits() {
    let most = wgpu::Limits::default().max_storage_buffers_per_shader_stage;
    for shader in ALL {
        let bound =
            [Stage::Vertex, Stage::Fragment, Stage::Compute].map(|stage| storage_buffers(shader, stage));
        assert!(bound.into_iter().all(|buffers| buffers <= most), "{} binds {bound:?}", shader.name);
    }
}

fn storage_buffers(shader: &Shader, stage: Stage) -> u32 {
    let is_counted = |binding: &&Binding| {
        let kinds = [BindingKind::StorageRead, BindingKind::StorageReadWrite];
        kinds.contains(&binding.kind) && binding.stages.contains(&stage)
    };
    shader.bindings.iter().filter(is_counted).count() as u32
}
