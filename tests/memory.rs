//! Device memory: at most two `i32` per sample of the enlarged windows, or ten with hydraulic erosion, whatever else the recipe
//! asks for.

use relievo_testing as harness;

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use harness::gpu_of_bindings;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::{Border, TerrainConfig};
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::features::{FeatureFile, FeatureIndex, Features};
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::hydraulic::Hydraulic;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;

/// Bytes of uniforms, origins and neighbours: a few hundred per patch.
const SMALL: u64 = 64 << 10;

const SIZE: u32 = 65;
const PATCHES: [[i32; 2]; 12] =
    [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1], [0, 2], [1, 2], [2, 2], [-7, 4], [-6, 4], [40, -3]];

fn recipes() -> Vec<Recipe> {
    let mut recipes = Vec::new();
    for border in [Border::Seamless, Border::Wrap, Border::Blend(16)] {
        let config = TerrainConfig { border, ..TerrainConfig::new(SIZE, 20.0, "memory").expect("valid") };
        let some = (0..SIZE * SIZE).step_by(11);
        let points = some.flat_map(|i| [f64::from(i % SIZE), f64::from(i / SIZE), f64::from(i % 7)]);
        let file = FeatureFile { patch_coordinates: [1, 1], precomputed_heights: points.collect() };
        let features = |mode: Option<FeatureMode>| {
            let injected = |mode| Features::new(&config, std::slice::from_ref(&file), mode).expect("valid");
            mode.map_or(Features::default(), injected)
        };
        for mode in [None, Some(FeatureMode::Keep), Some(FeatureMode::Additive)] {
            for despike in [None, Some(Despike { threshold: 0.5 })] {
                for (rains, iterations) in [(Some(1), Some(2)), (Some(6), None)] {
                    let slides = |iterations: Option<u32>| {
                        iterations.map(|iterations| Thermal { iterations, talus: 30.0 })
                    };
                    let (thermal, thermal_after) = (slides(iterations), slides(iterations.map(|_| 3)));
                    let rain = Hydraulic { rain: 0.01, threshold: 1.0, ..Hydraulic::default() };
                    let hydraulic = rains.map(|iterations| Hydraulic { iterations, ..rain });
                    let features = features(mode);
                    recipes.push(Recipe {
                        config: config.clone(),
                        features,
                        despike,
                        thermal,
                        hydraulic,
                        thermal_after,
                    });
                }
                for iterations in [None, Some(0), Some(1), Some(4), Some(9)] {
                    let thermal = iterations.map(|iterations| Thermal { iterations, talus: 30.0 });
                    let features = features(mode);
                    recipes.push(Recipe {
                        config: config.clone(),
                        features,
                        despike,
                        thermal,
                        hydraulic: None,
                        thermal_after: None,
                    });
                }
            }
        }
    }
    recipes
}

/// Bytes of the lists of features, and of the index that finds them in every window.
fn list_bytes(gpu: &Gpu, recipe: &Recipe, apron: u32) -> u64 {
    if recipe.features.is_empty() {
        return 0;
    }
    let width = SIZE + 2 * apron;
    // Each level is at most half as wide as the next, plus three points.
    let widths: Vec<_> = (0..=6).map(|level| (width >> level) + 4).collect();
    let room = PATCHES.len() * 9 * recipe.features.len();
    FeatureIndex::new(gpu, &widths, PATCHES.len() as u32, room).expect("allocated").bytes()
}

/// The most that `work` allocates on the device beyond what is there, as wgpu's allocator and as relievo counts it.
fn most_allocated<T>(gpu: &Gpu, work: impl FnOnce() -> T) -> (T, Option<u64>, u64) {
    let report = || gpu.device().generate_allocator_report().map(|report| report.total_allocated_bytes);
    let (done, most) = (AtomicBool::new(false), AtomicU64::new(0));
    let (before, own_before) = (report(), gpu.memory().now());
    gpu.memory().take_most();
    let result = std::thread::scope(|scope| {
        scope.spawn(|| {
            while !done.load(Ordering::SeqCst) {
                most.fetch_max(report().unwrap_or(0), Ordering::SeqCst);
                std::thread::sleep(std::time::Duration::from_micros(100));
            }
        });
        let result = work();
        done.store(true, Ordering::SeqCst);
        result
    });
    let seen = before.map(|before| most.into_inner().saturating_sub(before));
    (result, seen, gpu.memory().take_most() - own_before)
}

/// Number of samples of all patches.
const POINTS: u64 = PATCHES.len() as u64 * (SIZE * SIZE) as u64;

#[test]
fn in_one_part_generation_holds_two_words_a_sample() {
    generation_holds_two_words_a_sample(128 << 20);
}

/// The windows are generated in several parts as soon as they are larger than the patches.
#[test]
fn with_windows_in_parts_generation_holds_two_words_a_sample() {
    generation_holds_two_words_a_sample(4 * POINTS + 64);
}

#[test]
fn with_patches_in_parts_generation_holds_two_words_a_sample() {
    generation_holds_two_words_a_sample(POINTS);
}

/// Every border mode with and without despiking, erosion and features, with bindings of so many bytes.
fn generation_holds_two_words_a_sample(binding: u64) {
    // This device holds all lists in one buffer, which a small binding would not.
    let roomy = gpu_of_bindings(128 << 20);
    let gpu = gpu_of_bindings(binding);
    for recipe in recipes() {
        for margin in [0, 1] {
            let apron = recipe.apron(margin);
            // The water of one window must fit a binding.
            if recipe.hydraulic.is_some() && 16 * u64::from(SIZE + 2 * apron).pow(2) > binding {
                continue;
            }
            let generator = Generator::new(&gpu, recipe.clone()).expect("compiled");
            let samples = PATCHES.len() as u64 * u64::from(SIZE + 2 * apron).pow(2);
            // With hydraulic erosion, two buffers of water and sediment beside the two of heights.
            let words = if recipe.hydraulic.is_some() { 5 } else { 1 };
            let lists = list_bytes(&roomy, &recipe, apron);
            let (parts, seen, own) = most_allocated(&gpu, || {
                generator.generate(&gpu, &PATCHES, margin, &mut |_| ()).expect("generated")
            });
            let case = format!(
                "{:?} {} despike {:?} thermal {:?} hydraulic {:?} margin {margin}: {} parts, {samples} samples, {lists} of lists",
                recipe.config.border,
                recipe.features.len(),
                recipe.despike,
                recipe.thermal,
                recipe.hydraulic.map(|hydraulic| hydraulic.iterations),
                parts.len(),
            );
            assert!(parts.len() == 1 || binding < 128 << 20, "{case}");
            assert!(own >= 4 * samples, "{case}: {own} counted");
            assert!(own <= words * 8 * samples + lists + SMALL, "{case}: {own} counted");
            // wgpu's own staging of what is written to lists comes on top of them.
            let bound = words * 8 * samples + 2 * lists + SMALL;
            assert!(seen.is_none_or(|seen| seen <= bound), "{case}: {seen:?} allocated");
            let held: u64 = parts.iter().map(|part| part.heights.bytes()).sum();
            assert_eq!(held, gpu.memory().now(), "{case}: only results are left");
            check(&gpu, &recipe, margin, &parts, &case);
        }
    }
}

/// Sharing memory changes no height.
fn check(gpu: &Gpu, recipe: &Recipe, margin: u32, parts: &[Fields], case: &str) {
    let expected = field(recipe, &PATCHES, margin).expect("computed");
    let mut windows = expected.iter();
    for part in parts {
        let heights = part.heights.read_blocking(gpu).expect("read");
        for actual in heights.chunks_exact((part.width as usize).pow(2)).take(part.count as usize) {
            assert!(Some(actual) == windows.next().map(Vec::as_slice), "{case}: heights differ");
        }
    }
    assert!(windows.next().is_none(), "{case}: windows are missing");
}
