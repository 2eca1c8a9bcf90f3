//! One operation, one stem: every kernel has a twin, parity cases, a benchmark and a host, and structs are laid
//! out as the shaders see them.
#![cfg(feature = "gpu")]

use std::path::Path;

use relievo::gpu::shaders::{ALL, Stage};

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
