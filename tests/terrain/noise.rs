//! Generators of noise against an independent formula in f64, their properties, known hashes, and refusals.

use std::f64::consts::PI;

use relievo::ops::hash::threefry2x32;
use relievo::ops::terrain::config::{HeightGenerator, TerrainConfig};
use relievo::ops::terrain::export::{cropped, sha256};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::field::{generate, region};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::window::Region;

const NOISE: [HeightGenerator; 3] = [HeightGenerator::Fbm, HeightGenerator::Ridged, HeightGenerator::Simplex];

fn config(generator: HeightGenerator, size: u32, coarse_levels: u32, seed: &str) -> TerrainConfig {
    let config = TerrainConfig::new(size, 40.0, seed).expect("valid");
    let config = TerrainConfig { generator, coarse_levels, ..config };
    config.validate().expect("valid");
    config
}

fn heights(config: &TerrainConfig, patch: [i32; 2], apron: u32) -> Vec<i32> {
    generate(config, &Features::default(), &[patch], apron).remove(0)
}

/// The 65536 gradients are those of the definition: a parabola for the sine, in steps of 1/128.
fn gradient(word: u32) -> [f64; 2] {
    let component = |turn: u32| {
        let part = f64::from(turn % 0x8000) / 32768.0;
        // 85/64 of the parabola 4x(1 − x), which is exact in 1/2^20.
        let parabola =
            ((part * (1.0 - part) * 2.0_f64.powi(22)).floor() * 85.0 / 2.0_f64.powi(19)).floor() / 128.0;
        if turn % 0x1_0000 < 0x8000 { parabola } else { -parabola }
    };
    [component(word >> 16), component((word >> 16) + 0x4000)]
}

/// Random words of a lattice point.
fn words(config: &TerrainConfig, octave: u32, at: [i64; 2]) -> [u32; 2] {
    let [first, second] = config.key();
    let key = [first, second.wrapping_add(0x9e37_79b9_u32.wrapping_mul(octave + 1))];
    let (one, two) = threefry2x32(key, [at[0] as u32; 8], [at[1] as u32; 8]);
    [one[0], two[0]]
}

fn fade(t: f64) -> f64 {
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

/// Gradient noise, and the interpolated values of the lattice points, at a world position.
fn square(config: &TerrainConfig, octave: u32, at: [i64; 2]) -> [f64; 2] {
    let spacing = 4096_i64 << config.coarse_levels >> octave;
    let mut sums = [0.0; 2];
    for corner in [[0, 0], [1, 0], [0, 1], [1, 1]] {
        let point = [0, 1].map(|axis| (at[axis].div_euclid(spacing) + corner[axis]) * spacing);
        let [x, y] = [0, 1].map(|axis| (at[axis] - point[axis]) as f64 / spacing as f64);
        let weight = (1.0 - fade(x.abs())) * (1.0 - fade(y.abs()));
        let [first, second] = words(config, octave, point);
        let [along, across] = gradient(first);
        sums[0] += weight * (along * x + across * y);
        sums[1] += weight * f64::from(second.cast_signed()) / 2.0_f64.powi(32);
    }
    sums
}

/// Simplex noise at a world position: the sum over all lattice points within reach.
fn simplex(config: &TerrainConfig, octave: u32, at: [i64; 2]) -> f64 {
    let log2 = 12 + config.coarse_levels - octave;
    let spacing = 1_i64 << log2;
    let shift = [0x9e37_79b9_u32, 0x85eb_ca6b]
        .map(|factor| i64::from(factor.wrapping_mul(octave + 1) >> (32 - log2)));
    let [x, y] = [at[0] + shift[0], at[1] + (1 << 31) + shift[1]];
    let row_height = spacing / 8 * 7;
    let mut sum = 0.0;
    for row in y.div_euclid(row_height) - 1..=y.div_euclid(row_height) + 2 {
        let start = row * spacing / 2;
        for column in (x - start).div_euclid(spacing) - 1..=(x - start).div_euclid(spacing) + 2 {
            let point = [column * spacing + start, row * row_height];
            let [dx, dy] = [x - point[0], y - point[1]].map(|distance| distance as f64 / spacing as f64);
            let near = (0.75 - dx * dx - dy * dy).max(0.0);
            let [along, across] = gradient(words(config, octave, point)[0]);
            sum += near.powi(4) * (along * dx + across * dy);
        }
    }
    11.0 * sum
}

/// Height in 1/65536 units by the definition.
fn oracle(config: &TerrainConfig, at: [i64; 2], levels: u32) -> f64 {
    let range = |octave: u32| f64::from(config.level_range(octave));
    let fixed = 10 + config.coarse_levels;
    match config.generator {
        HeightGenerator::Fbm => {
            let octaves = (0..levels).map(|octave| range(octave) * square(config, octave, at)[0]);
            octaves.sum::<f64>() + range(0) * square(config, 0, at)[1]
        }
        HeightGenerator::Ridged => {
            let size = |octave: u32| square(config, octave, at).iter().sum::<f64>().abs();
            let weight = |octave: u32| if octave == 0 { 1.0 } else { 1.0 - size(0) / 2.0 };
            (0..fixed).map(|octave| range(octave) * weight(octave) * (1.0 - size(octave))).sum()
        }
        _ => (0..fixed).map(|octave| range(octave) * simplex(config, octave, at)).sum(),
    }
}

/// Heights equal the formula in f64, within the rounding of fixed point: per octave, a value has an error below 128 in Q.27 and
/// a height is rounded down. (Fades are within 2^-25 and multiply differences below 6, twice; the fourth powers of simplex noise
/// are within 2^-26 and multiply three ramps below 1.43.)
#[test]
fn heights_equal_the_formula() {
    for generator in NOISE {
        for (size, coarse_levels, scale_factor) in
            [(9, 0, 40.0), (33, 3, 1000.0), (65, 8, 5400.0), (4097, 1, 40.0)]
        {
            let config = TerrainConfig {
                scale_factor,
                ..config(generator, size, coarse_levels, &format!("oracle {size}"))
            };
            config.validate().expect("valid");
            let spacing = 4096 / (i64::from(size) - 1);
            for first in [[-11, 4], [(1 << 29) / spacing, -(1 << 30) / spacing]] {
                let region_of = Region { first, width: 21, coarser: 0 };
                let found = region(&config, &Features::default(), region_of);
                for (index, height) in found.into_iter().enumerate() {
                    let place = [first[0] + index as i64 % 21, first[1] + index as i64 / 21];
                    let expected = oracle(&config, place.map(|index| index * spacing), config.levels());
                    let bound: f64 = (0..config.levels().max(10 + coarse_levels))
                        .map(|octave| 1.0 + f64::from(config.level_range(octave)) * 128.0 / 2.0_f64.powi(27))
                        .sum();
                    let error = (f64::from(height) - expected).abs();
                    assert!(error <= bound, "{generator:?} {size} {place:?}: {error} > {bound}");
                }
            }
        }
    }
}

/// Windows of any patch and apron agree bit for bit where they overlap.
#[test]
fn windows_agree() {
    for generator in NOISE {
        let config = config(generator, 33, 2, "windows");
        for patch in [[0, 0], [-3, 7], [262_144, -262_145]] {
            let alone = heights(&config, patch, 0);
            assert_eq!(cropped(&heights(&config, patch, 40), 113, 40), alone, "{generator:?}");
            let wide = heights(&config, [patch[0] - 1, patch[1]], 32);
            let beside: Vec<_> = (0..33 * 33).map(|at| wide[(at / 33 + 32) * 97 + 64 + at % 33]).collect();
            assert_eq!(beside, alone, "{generator:?}");
        }
    }
}

/// Coarser regions and smaller patches have exactly every second sample.
#[test]
fn coarser_resolutions_have_every_second_sample() {
    for generator in NOISE {
        let fine = config(generator, 65, 3, "resolution");
        let made = |first: [i64; 2], width: u32, coarser: u32| {
            region(&fine, &Features::default(), Region { first, width, coarser })
        };
        let second = |fine: &[i32], width: usize| -> Vec<i32> {
            let half = width / 2 + 1;
            (0..half * half).map(|at| fine[at / half * 2 * width + at % half * 2]).collect()
        };
        for coarser in 0..fine.levels() {
            assert_eq!(made([-7, 3], 11, coarser + 1), second(&made([-14, 6], 21, coarser), 21), "{coarser}");
        }
        let coarse = TerrainConfig { patch_size: 33, ..fine.clone() };
        assert_eq!(heights(&coarse, [-2, 5], 0), second(&heights(&fine, [-2, 5], 0), 65), "{generator:?}");
    }
}

/// Root mean squares of the heights and of their second differences, over 8 × 8 patches from `first` on.
fn statistics(config: &TerrainConfig, first: [i32; 2]) -> [f64; 2] {
    let width = config.patch_size as usize;
    let patches: Vec<_> = (0..64).map(|at| [first[0] + at % 8, first[1] + at / 8]).collect();
    let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
    for field in generate(config, &Features::default(), &patches, 0) {
        for row in field.chunks_exact(width) {
            sums[0] += row.iter().map(|height| f64::from(*height).powi(2)).sum::<f64>();
            counts[0] += width as f64;
            for three in row.windows(3) {
                sums[1] += f64::from(three[0] - 2 * three[1] + three[2]).powi(2);
                counts[1] += 1.0;
            }
        }
    }
    [0, 1].map(|at| (sums[at] / counts[at]).sqrt())
}

/// Nothing degrades 2^18 patches away from the origin: heights and finest details are as large as at the origin.
#[test]
fn far_away_is_like_the_origin() {
    for generator in NOISE {
        let config = config(generator, 257, 0, "far");
        let (near, far) = (statistics(&config, [-4, -4]), statistics(&config, [1 << 18, -(1 << 18)]));
        println!("{generator:?}: {near:?} {far:?}");
        // 64 patches are 64 independent base cells: heights vary by an eighth, details by much less.
        assert!(
            (near[0] / far[0] - 1.0).abs() < 0.3 && (near[1] / far[1] - 1.0).abs() < 0.1,
            "{near:?} {far:?}"
        );
    }
}

/// The highest terrain that is accepted stays within its bound, and a higher one is refused.
#[test]
fn tall_terrain_does_not_overflow() {
    for generator in NOISE {
        let tall = TerrainConfig { scale_factor: 5460.0, ..config(generator, 65, 0, "tall") };
        tall.validate().expect("valid");
        let patches: Vec<_> = (0..16).map(|at| [at % 4, at / 4]).collect();
        let fields = generate(&tall, &Features::default(), &patches, 0).concat();
        let most = fields.iter().map(|height| height.abs()).max().expect("heights");
        assert!(most < 1 << 30 && most > 1 << 27, "{generator:?}: {most}");
        let error =
            TerrainConfig { scale_factor: 5560.0, ..tall }.validate().expect_err("too tall").to_string();
        assert!(error.contains("scale_factor") && error.contains("16383"), "{error}");
    }
}

/// Hashes of patches, computed by an independent program in Python with numpy.
#[test]
fn known_hashes() {
    for (generator, known) in
        NOISE.into_iter().zip(["2eebe921059213fa", "4e14ee7d91aab547", "31d70c657965aaee"])
    {
        let found = sha256(&heights(&config(generator, 129, 2, "any text"), [-5, 3], 1));
        assert_eq!(&found[..16], known, "{generator:?}");
    }
}

/// The largest sizes of a sum over lattice points of weighted gradients.
fn largest(weights: &[[f64; 2]]) -> f64 {
    let along = |[x, y]: &[f64; 2]| {
        (0..64_u32).map(|turn| gradient(turn << 26)).map(|[a, b]| (a * x + b * y).abs()).fold(0.0, f64::max)
    };
    weights.iter().map(along).sum()
}

/// Weights of the gradients, and of the values, at a place of the lattice of spacing 1.
type Weights = fn([f64; 2]) -> (Vec<[f64; 2]>, Vec<f64>);

fn square_weights([x, y]: [f64; 2]) -> (Vec<[f64; 2]>, Vec<f64>) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let side = |t: f64, corner: f64| if corner == 0.0 { 1.0 - fade(t) } else { fade(t) };
    let values = corners.map(|[i, j]| side(x, i) * side(y, j));
    let gradients = corners.iter().zip(values).map(|([i, j], weight)| [weight * (x - i), weight * (y - j)]);
    (gradients.collect(), values.to_vec())
}

fn triangle_weights([x, y]: [f64; 2]) -> (Vec<[f64; 2]>, Vec<f64>) {
    let points =
        (-2..4).flat_map(|j| (-4..5).map(move |i| [f64::from(i) + f64::from(j) / 2.0, f64::from(j) * 0.875]));
    let weight = |[i, j]: [f64; 2]| {
        let (dx, dy) = (x - i, y - j);
        let near = 11.0 * (0.75 - dx * dx - dy * dy).max(0.0).powi(4);
        [near * dx, near * dy]
    };
    (points.map(weight).collect(), Vec::new())
}

/// Largest value, first and second derivative in any direction, over a fine grid.
fn extremes(weights: Weights, with_values: bool) -> [f64; 3] {
    let grid = 48;
    let mut most = [0.0_f64; 3];
    for (i, j) in (0..=grid).flat_map(|j| (0..=grid).map(move |i| (i, j))) {
        let at = [i, j].map(|index| f64::from(index) / f64::from(grid));
        for turn in 0..12 {
            let (sin, cos) = (f64::from(turn) * PI / 12.0).sin_cos();
            let step = 1e-3;
            let [before, here, after] =
                [-step, 0.0, step].map(|step| weights([at[0] + step * cos, at[1] + step * sin]));
            let sum = |factors: [f64; 3]| {
                let of = |pick: &dyn Fn(usize) -> f64| {
                    pick(0) * factors[0] + pick(1) * factors[1] + pick(2) * factors[2]
                };
                let all = [&before, &here, &after];
                let gradients: Vec<_> = (0..here.0.len())
                    .map(|point| [0, 1].map(|axis| of(&|at| all[at].0[point][axis])))
                    .collect();
                let values =
                    (0..here.1.len()).map(|point| of(&|at| all[at].1[point]).abs() / 2.0).sum::<f64>();
                largest(&gradients) + if with_values { values } else { 0.0 }
            };
            let found = [
                sum([0.0, 1.0, 0.0]),
                sum([-0.5 / step, 0.0, 0.5 / step]),
                sum([1.0 / step / step, -2.0 / step / step, 1.0 / step / step]),
            ];
            (0..3).for_each(|order| most[order] = most[order].max(found[order]));
        }
    }
    most
}

/// The sizes on which the bounds of `terrain::noise` and `terrain::remainder` rest.
#[test]
fn noise_and_its_derivatives_are_bounded() {
    for (name, weights, values, bounds) in [
        ("gradient noise", square_weights as Weights, false, [0.993, 2.87, 12.8]),
        ("with values", square_weights, true, [1.493, 4.74, 17.4]),
        ("simplex noise", triangle_weights, false, [0.938, 5.75, 35.2]),
    ] {
        let found = extremes(weights, values);
        println!("{name}: {found:?}");
        let tight = found.iter().zip(bounds).all(|(found, bound)| *found <= bound && *found > 0.9 * bound);
        assert!(tight, "{name}: {found:?}, bounds {bounds:?}");
    }
}

#[test]
fn what_noise_does_not_have_is_refused() {
    let json = |more: &str| {
        TerrainConfig::from_json(&format!(r#"{{"patchSize": 33, "scaleFactor": 40, "seed": ""{more}}}"#))
    };
    for generator in ["fbm", "ridged", "simplex"] {
        json(&format!(r#", "generator": "{generator}""#)).expect("valid");
        for (more, parts) in [
            (r#""border": "wrap""#, ["border", "seamless"]),
            (r#""border": {"blend": 3}"#, ["border", "seamless"]),
            (r#""offset": "positive""#, ["offset", "signed"]),
            (r#""offset": "gaussian""#, ["offset", "signed"]),
            (r#""interpolation": "smooth""#, ["interpolation", "linear"]),
        ] {
            let error =
                json(&format!(r#", "generator": "{generator}", {more}"#)).expect_err(more).to_string();
            assert!(parts.iter().all(|part| error.contains(part)), "{error}");
        }
    }
    json(r#", "generator": "diamondSquare", "offset": "gaussian""#).expect("valid");
    let error = json(r#", "generator": "perlin""#).expect_err("unknown").to_string();
    assert!(error.contains("generator") && error.contains("simplex"), "{error}");

    let config = config(HeightGenerator::Fbm, 33, 0, "");
    let file = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: vec![1.0, 2.0, 3.0] };
    let error = Features::new(&config, &[file], FeatureMode::Keep).expect_err("features").to_string();
    assert!(error.contains("precomputed_heights") && error.contains("diamondSquare"), "{error}");
    Features::new(&config, &[], FeatureMode::Keep).expect("no features");
}
