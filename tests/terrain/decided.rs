//! What is decided where thesis B contradicts itself on terrain (`docs/sources.md`).

use relievo::ops::terrain::config::{Border, HEIGHT_ONE, Offset, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::wrap::reference::wrap;

const SCALE: f64 = 10.0;

/// The patch of the smallest or the second smallest size, alone, between corners of height 0.
fn patch(patch_size: u32, seed: u32) -> Vec<i32> {
    let config = TerrainConfig {
        offset: Offset::Positive,
        border: Border::Wrap,
        ..TerrainConfig::new(patch_size, SCALE, &seed.to_string()).expect("valid")
    };
    wrap(&config, &Features::default(), [0, 0])
}

/// Offsets of the first subdivision fill `scaleFactor`, those of the second half of it.
#[test]
fn the_first_subdivision_has_the_whole_range() {
    let (mut first, mut second) = (0.0_f64, 0.0_f64);
    for seed in 0..1000 {
        let offset = |heights: &[i32], at: usize, corners: [usize; 4]| {
            let mean: f64 = corners.iter().map(|corner| f64::from(heights[*corner])).sum::<f64>() / 4.0;
            (f64::from(heights[at]) - mean) / HEIGHT_ONE
        };
        // The middle of 3 × 3 points, and the middle of the first of four cells of 5 × 5.
        first = first.max(offset(&patch(3, seed), 4, [0, 2, 6, 8]));
        second = second.max(offset(&patch(5, seed), 6, [0, 2, 10, 12]));
    }
    assert!((0.99 * SCALE..SCALE).contains(&first), "{first}");
    assert!((0.495 * SCALE..0.5 * SCALE + 1e-4).contains(&second), "{second}");
}
