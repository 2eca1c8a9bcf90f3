//! Hashes of whole patches, computed by two independent programs (two others for smooth interpolation) in Python (one with numpy, one by recursion for each
//! point), which agree with each other and share no code with this crate.

use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::{field, generate};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::reference::thermal;
use relievo::ops::terrain::window::Window;
use serde::Deserialize;
use sha2::{Digest, Sha256};

#[derive(Deserialize)]
struct Known {
    name: String,
    config: serde_json::Value,
    patch: [i32; 2],
    features: Vec<(i32, i32, Vec<f64>)>,
    feature_mode: String,
    apron: u32,
    post: Option<String>,
    order: Option<Vec<[i32; 2]>>,
    sha256: String,
    first: Vec<i32>,
}

fn heights(known: &Known) -> Vec<i32> {
    let config = TerrainConfig::from_json(&known.config.to_string()).expect("a known configuration is valid");
    let mode = if known.feature_mode == "additive" { FeatureMode::Additive } else { FeatureMode::Keep };
    let files: Vec<_> = (known.features.iter())
        .map(|(px, py, heights)| FeatureFile {
            patch_coordinates: [*px, *py],
            precomputed_heights: heights.clone(),
        })
        .collect();
    let features = Features::new(&config, &files, mode).expect("known features are valid");
    let patches = known.order.clone().unwrap_or_else(|| vec![known.patch]);
    let at = patches.iter().position(|patch| *patch == known.patch).expect("the patch is in the order");
    let (post, argument) =
        known.post.as_deref().map_or(("", ""), |post| post.split_once(':').expect("name:value"));
    match post {
        "thermal" => {
            let (iterations, threshold) = argument.split_once(':').expect("iterations:threshold");
            let apron: u32 = iterations.parse().expect("a number");
            let mut window = generate(&config, &features, &patches, apron).swap_remove(at);
            let mut width = Window { patch: known.patch, apron }.width(&config) as usize;
            for _ in 0..apron {
                window = thermal(&window, width, threshold.parse().expect("a number"));
                width -= 2;
            }
            window
        }
        "despike" => {
            let despike = Despike { threshold: argument.parse().expect("a number") };
            let recipe = Recipe { features, despike: Some(despike), ..Recipe::new(config) };
            field(&recipe, &patches, known.apron).expect("valid").swap_remove(at)
        }
        _ => generate(&config, &features, &patches, known.apron).swap_remove(at),
    }
}

fn sha256(heights: &[i32]) -> String {
    let bytes: Vec<u8> = heights.iter().flat_map(|height| height.to_le_bytes()).collect();
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn references_give_the_known_hashes() {
    let all: Vec<Known> = serde_json::from_str(include_str!("known_heights.json")).expect("a list of cases");
    assert_eq!(all.len(), 144, "the list only grows");
    let wrong: Vec<_> = (all.iter())
        .filter_map(|known| {
            let heights = heights(known);
            let hash = sha256(&heights);
            let first = &heights[..4];
            (hash != known.sha256)
                .then(|| format!("{}: starts {first:?}, should start {:?}", known.name, known.first))
        })
        .collect();
    assert!(wrong.is_empty(), "{} of {} differ:\n{}", wrong.len(), all.len(), wrong.join("\n"));
}

#[test]
fn one_wrong_bit_changes_the_hash() {
    let all: Vec<Known> = serde_json::from_str(include_str!("known_heights.json")).expect("a list of cases");
    let mut heights = heights(&all[0]);
    assert_eq!(sha256(&heights), all[0].sha256);
    heights[5] ^= 1;
    assert_ne!(sha256(&heights), all[0].sha256);
}
