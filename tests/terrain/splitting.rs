//! A batch of `blend` that exceeds one binding is split, and its heights keep the same bits.

use relievo::ops::terrain::config::{Border, TerrainConfig};
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;

use crate::harness::gpu_of_bindings;

const SIZE: u32 = 33;
/// The bytes of a patch.
const PATCH: u64 = 4 * (SIZE as u64).pow(2);

/// A 4×3 grid: row by row, in reverse, in random order, with holes, and with a patch that occurs twice.
fn orders() -> Vec<(&'static str, Vec<[i32; 2]>)> {
    let raster: Vec<[i32; 2]> = (0..12).map(|i| [i % 4 - 2, i / 4 - 1]).collect();
    let shuffled: Vec<_> = (0..12).map(|i| raster[(i * 7 + 5) % 12]).collect();
    let holes = [5, 0, 11, 2, 9, 6, 10, 1].map(|i| raster[i]).to_vec();
    let mut twice = shuffled.clone();
    twice.insert(6, shuffled[0]);
    vec![
        ("backwards", raster.iter().rev().copied().collect()),
        ("raster", raster),
        ("shuffled", shuffled),
        ("holes", holes),
        ("twice", twice),
    ]
}

/// Neither despiking nor erosion, either of them, and both.
fn recipes(blend: u32) -> Vec<Recipe> {
    let config = TerrainConfig {
        border: Border::Blend(blend),
        ..TerrainConfig::new(SIZE, 20.0, "split").expect("valid")
    };
    let precomputed_heights = vec![3.0, 10.0, 50.0, 32.0, 20.0, -50.0];
    let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights };
    let features = Features::new(&config, &[file], FeatureMode::Keep).expect("valid");
    let mut recipes = Vec::new();
    for despike in [None, Some(Despike { threshold: 0.5 })] {
        for thermal in [None, Some(Thermal { iterations: 3, talus: 30.0 })] {
            recipes.push(Recipe {
                features: features.clone(),
                despike,
                thermal,
                ..Recipe::new(config.clone())
            });
        }
    }
    recipes
}

#[test]
fn split_batches_of_blend_are_the_same_bits() {
    // Buffers that hold one patch, a few patches, and almost all patches.
    for most in [1, 3, 7] {
        // The largest windows extend five samples beyond a patch: a buffer must hold one window, but not two patches.
        let gpu = gpu_of_bindings((most * PATCH).max(4 * u64::from(SIZE + 10).pow(2)).next_multiple_of(16));
        for recipe in [1, 8, 30].into_iter().flat_map(recipes) {
            let generator = Generator::new(&gpu, recipe.clone()).expect("compiled");
            for ((order, patches), margin) in
                orders().into_iter().flat_map(|order| [(order.clone(), 0), (order, 1)])
            {
                let case = format!("{order}, {most} a part, margin {margin}, {recipe:?}");
                let parts = generator.generate(&gpu, &patches, margin, &mut |_| ()).expect("generated");
                assert!(parts.len() > 1, "{case}");
                let expected = field(&recipe, &patches, margin).expect("computed");
                let mut actual = Vec::new();
                for part in &parts {
                    let heights = part.heights.read_blocking(&gpu).expect("read");
                    let windows =
                        heights.chunks_exact((part.width as usize).pow(2)).take(part.count as usize);
                    actual.extend(windows.map(<[i32]>::to_vec));
                }
                assert!(actual == expected, "{case}: heights differ");
            }
        }
    }
}
