//! Helpers of the parity and benchmark cases of `kernels/terrain/`.

pub mod blend;
pub mod border;
pub mod despike;
pub mod height;
pub mod hydraulic;
pub mod morph;
pub mod normals;
pub mod pad;
pub mod smooth;
pub mod thermal;
pub mod wrap;

use relievo::gpu::{Buffer, Gpu, Job};
use relievo::hash::threefry2x32;
use relievo::terrain::config::{Config, HEIGHT_LIMIT};
use relievo::terrain::features::{FeatureFile, Features};
use relievo::terrain::fields::Fields;
use relievo::terrain::fixed::FeatureMode;
use relievo::{Error, InputError};

use crate::baseline::copy::{CopyBuffers, CopyPass};

/// The random words of a test case, the same on every machine.
pub fn random_words(case: u32, count: usize) -> Vec<u32> {
    let first = |index: usize| threefry2x32([case, 0x7e57], [index as u32; 8], [0; 8]).0[0];
    (0..count).map(first).collect()
}

/// Random heights of absolute value at most `limit`, which is itself drawn now and then.
pub fn random_heights(case: u32, count: usize, limit: i32) -> Vec<i32> {
    let span = 2 * i64::from(limit) + 1;
    let height = |word: u32| match word % 64 {
        0 => limit,
        1 => -limit,
        _ => (((i64::from(word) * span) >> 32) - i64::from(limit)) as i32,
    };
    random_words(case, count).into_iter().map(height).collect()
}

/// The largest height, in 1/65536 units.
pub const LIMIT: i32 = HEIGHT_LIMIT as i32;

/// Features scattered over the 3 × 3 patches around `patch`, edges and corners included.
///
/// # Errors
/// None, for a valid configuration.
pub(crate) fn scattered(
    config: &Config,
    patch: [i32; 2],
    mode: FeatureMode,
    case: u32,
) -> Result<Features, InputError> {
    let last = config.patch_size - 1;
    let mut files = Vec::new();
    for tile in 0..9_i32 {
        let mut heights = Vec::new();
        for pair in random_words(case * 9 + tile as u32, 24).chunks_exact(2) {
            // Coordinates of 0 are avoided: an edge that two patches share would get two heights for one
            // lattice point, which is refused.
            let (x, y) = (1 + pair[0] % last, 1 + pair[1] % last);
            heights.extend([f64::from(x), f64::from(y), f64::from(x + 3 * y) * 0.125]);
        }
        let patch_coordinates = [patch[0] + tile % 3 - 1, patch[1] + tile / 3 - 1];
        // The height depends on the position alone, so that a point that is drawn twice keeps one height.
        files.push(FeatureFile { patch_coordinates, precomputed_heights: heights });
    }
    Features::new(config, &files, mode)
}

/// Reads a configuration from JSON that is known to be valid.
///
/// # Errors
/// None, for valid JSON.
pub(crate) fn config(json: &serde_json::Value) -> Result<Config, Error> {
    Ok(Config::from_json(&json.to_string())?)
}

/// The name of a case of windows: their size, what is special about them, how many, and where the first is.
pub(crate) fn case_name(config: &Config, features: &Features, patches: &[[i32; 2]], apron: u32) -> String {
    let (size, offset, k) = (config.patch_size, config.offset, config.coarse_levels);
    let features =
        features.injection().map_or(String::new(), |mode| format!(" {mode:?} {} features", features.len()));
    format!("{size}×{size} {offset:?} k={k} apron {apron} × {} at {:?}{features}", patches.len(), patches[0])
}

/// The device's own copy of `words` words, rounded up to a multiple of four, as a baseline.
pub(crate) fn copy_of(gpu: &Gpu, words: usize) -> Result<Job, Error> {
    let words = words.next_multiple_of(4);
    let (source, destination) =
        (Buffer::new(gpu, "copy source", words)?, Buffer::new(gpu, "copy destination", words)?);
    CopyPass::new(gpu)?.prepare(gpu, words, CopyBuffers { source: &source, destination: &destination })
}

/// Plausible random heights for a batch of `points` samples, in 1/65536 units.
pub(crate) fn some_heights(points: usize) -> Vec<i32> {
    // A pattern of 4096 heights is repeated: drawing millions of heights one by one takes longer than the
    // benchmark.
    let pattern = random_heights(1, 4096, 1 << 22);
    pattern.into_iter().cycle().take(points).collect()
}

/// Plausible windows of `width`² samples, on the host and on the device.
pub(crate) fn some_windows(gpu: &Gpu, width: u32, count: u32) -> Result<(Vec<i32>, Fields), Error> {
    let host = some_heights((width * width * count) as usize);
    let windows = Fields::new(gpu, "windows", width, count)?;
    windows.heights.write(gpu, &host)?;
    Ok((host, windows))
}
