//! Helpers of the parity and benchmark cases of `kernels/terrain/`.

pub mod blend;
pub mod border;
pub mod despike;
pub mod height;
pub mod hydraulic;
mod levels;
pub mod limit;
pub mod morph;
pub mod node;
pub mod node_normals;
pub mod noise;
pub mod normals;
pub mod pad;
pub mod replace;
pub mod smooth;
pub mod thermal;
pub mod wrap;

use std::fmt::Debug;

use relievo::gpu::{Buffer, Gpu, Job};
use relievo::ops::hash::threefry2x32;
use relievo::ops::terrain::config::{HEIGHT_LIMIT, TerrainConfig, Zone};
use relievo::ops::terrain::cover::{Cover, MapZone, zone_of};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::{Error, InputError};

use crate::baseline::copy::{CopyBuffers, CopyPass};
use crate::harness::compare::exact;
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

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
    config: &TerrainConfig,
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
    Ok((host.clone(), uploaded(gpu, width, &host)?))
}

/// Windows of `width`² random heights of at most `limit` in size, on the host and on the device.
pub(crate) fn random_windows(
    gpu: &Gpu,
    [width, count]: [u32; 2],
    limit: i32,
) -> Result<(Vec<i32>, Fields), Error> {
    let host = random_heights(width, (width * width * count) as usize, limit);
    Ok((host.clone(), uploaded(gpu, width, &host)?))
}

/// Fields of `width`² samples.
pub(crate) fn uploaded(gpu: &Gpu, width: u32, heights: &[i32]) -> Result<Fields, Error> {
    let count = heights.len() as u32 / (width * width);
    Ok(Fields { heights: Buffer::from_slice(gpu, "windows", heights)?, width, count })
}

/// A cover whose zones have random texels, 4^`edge_log2` each.
pub(crate) fn random_cover(zones: &[Zone], edge_log2: u32) -> Cover {
    let texels = 1_u32 << (2 * edge_log2);
    let map_zone = |(at, zone): (u32, &Zone)| MapZone { zone: zone_of(zone), first: at * texels, edge_log2 };
    let words = random_words(edge_log2, 2 * zones.len() * texels as usize);
    let texel =
        |words: &[u32]| [words[0] as u16, (words[0] >> 16) as u16, words[1] as u16, (words[1] >> 16) as u16];
    Cover {
        zones: (0..).zip(zones).map(map_zone).collect(),
        texels: words.chunks_exact(2).map(texel).collect(),
        terrain_scale: 20.0,
        tile: 130.0,
        variation: 0.0,
        triplanar: false,
    }
}

/// The patches of a benchmark.
pub(crate) fn some_patches(count: u32) -> Vec<[i32; 2]> {
    (0..count as i32).map(|index| [index % 8, index / 8]).collect()
}

/// Compares an output, which has been computed, with what is expected to the bit.
pub(crate) async fn check_exact<T: bytemuck::Pod + PartialEq + Debug>(
    cases: &mut Cases<'_>,
    name: String,
    output: &Poisoned<T>,
    expected: &[T],
) -> Result<(), Error> {
    let comparison = output.check(cases.gpu, |actual| exact(actual, expected)).await?;
    cases.add(name, comparison);
    Ok(())
}

/// Measures work that reads and writes `bytes` bytes for each point, its reference, and a copy of as many bytes.
pub(crate) fn measure(
    bench: &mut Bench<'_>,
    name: &str,
    points: usize,
    bytes: usize,
    record: impl Fn(&mut wgpu::CommandEncoder),
    reference: impl FnMut(),
) -> Result<(), Error> {
    // A copy reads half of the bytes that it moves, and writes the other half.
    let copied = copy_of(bench.gpu, points * bytes / 8)?;
    let contenders = vec![
        Contender::recorded(Backend::Gpu, record),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, reference),
    ];
    bench.case(name, points, "point", (bytes * points) as u64, contenders)
}
