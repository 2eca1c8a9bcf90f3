//! Despiking and erosion at borders, where windows contain samples of other patches or of the patch's opposite side.

use std::sync::atomic::{AtomicUsize, Ordering};

use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::{field, field_with};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;

fn despiked_beside_features(border: &str, patches: &[[i32; 2]]) -> Vec<Vec<i32>> {
    let text = format!(r#"{{"patchSize": 33, "scaleFactor": 40, "seed": "s", "border": {border}}}"#);
    let config = TerrainConfig::from_json(&text).expect("valid");
    let precomputed_heights = vec![1.0, 10.0, 50.0, 1.0, 20.0, -50.0, 2.0, 15.0, 40.0];
    let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights };
    let features = Features::new(&config, &[file], FeatureMode::Keep).expect("valid");
    let recipe = Recipe {
        features,
        despike: Some(Despike { threshold: 0.1 }),
        thermal: Some(Thermal { iterations: 3, talus: 35.0 }),
        ..Recipe::new(config)
    };
    field(&recipe, patches, 0).expect("valid")
}

/// Opposite sides of a patch still agree after despiking beside injected points, which also keeps the points on the
/// window's rim: there the window shows the patch's opposite side.
#[test]
fn wrap_still_tiles_after_despiking_beside_features() {
    let patch = &despiked_beside_features("\"wrap\"", &[[0, 0]])[0];
    for row in 0..33 {
        assert_eq!(patch[row * 33], patch[row * 33 + 32], "row {row}");
        assert_eq!(patch[row], patch[32 * 33 + row], "column {row}");
    }
}

/// Neighbours that blend still agree after despiking beside injected points.
#[test]
fn blended_neighbours_still_agree_after_despiking_beside_features() {
    let patches = despiked_beside_features("{\"blend\": 1}", &[[-1, 0], [0, 0]]);
    for row in 0..33 {
        assert_eq!(patches[0][row * 33 + 32], patches[1][row * 33], "row {row}");
    }
}

/// Progress is reported once for each patch.
#[test]
fn progress_hears_of_every_patch_and_changes_nothing() {
    let patches: Vec<[i32; 2]> = (0..6).map(|i| [i % 3, i / 3]).collect();
    for border in ["\"seamless\"", "\"wrap\"", "{\"blend\": 3}"] {
        let text = format!(r#"{{"patchSize": 17, "scaleFactor": 4, "seed": "s", "border": {border}}}"#);
        let thermal = Some(Thermal { iterations: 2, talus: 35.0 });
        let recipe = Recipe { thermal, ..Recipe::new(TerrainConfig::from_json(&text).expect("valid")) };
        let heard = AtomicUsize::new(0);
        let count = || {
            heard.fetch_add(1, Ordering::Relaxed);
        };
        let fields = field_with(&recipe, &patches, 1, &count).expect("valid");
        assert_eq!(heard.load(Ordering::Relaxed), patches.len(), "{border}");
        assert_eq!(fields, field(&recipe, &patches, 1).expect("valid"));
    }
}
