//! Generation of the built-in textures.

mod grass;
mod stones;

use super::field::{Field, made, mixed, ramp, stretched, texels as shaded};
use super::noise::{Noise, cell, random, smoothstep};
use crate::terrain::config::BuiltIn;

/// Generates the texels of a built-in texture: sRGB colour and height, four bytes per texel.
pub fn texels(kind: BuiltIn) -> Vec<u8> {
    match kind {
        BuiltIn::Sand => sand(),
        BuiltIn::Grass => grass::grass(),
        BuiltIn::Hill => hill(),
        BuiltIn::Snow => snow(),
        BuiltIn::Soil => stones::soil(),
        BuiltIn::Strata => strata(),
        BuiltIn::Scree => stones::scree(),
    }
}

/// Splits a list of pairs into a list of first values and a list of second values.
fn apart<T>(pairs: Vec<(f32, T)>) -> (Field, Vec<T>) {
    pairs.into_iter().unzip()
}

/// The tilted plane of the cell of Worley noise at a point, raised or lowered by up to half of `lift`: its height there, and a random
/// number from −0.5 to 0.5 of the cell.
fn face(key: u32, periods: [u32; 2], lift: f32, at: [f32; 2]) -> (f32, f32) {
    let cell = cell(key, periods, at);
    let number = |use_of: u32| random(key + 1, [cell.word, use_of]) - 0.5;
    (cell.offset[0] * number(0) + cell.offset[1] * number(1) + lift * number(2), number(3))
}

/// Sand: wind ripples, bent and broken up by noise, with grains on top.
fn sand() -> Vec<u8> {
    let (bends, waves) = (Noise::new(11, [3, 3], 3, 0.5), Noise::octave(17, [9, 9]));
    let (strengths, hills) = (Noise::new(23, [5, 5], 2, 0.5), Noise::new(41, [6, 6], 4, 0.5));
    let (coarse, fine) = (Noise::octave(31, [160, 160]), Noise::octave(32, [251, 251]));
    let (heights, grains) = apart(made(|at| {
        let [u, v] = at;
        let phase = 2.0 * u + 17.0 * (v + 0.045 * bends.at(at)) + 0.35 * waves.at(at);
        let wave = phase - phase.floor();
        // Ripples are asymmetric: the windward side is long, the lee side short.
        let ripple = if wave < 0.68 { wave / 0.68 } else { (1.0 - wave) / 0.32 };
        let ripple = smoothstep(0.0, 1.0, ripple);
        let strength = 0.55 + 0.45 * strengths.at(at);
        let grain = coarse.at(at) + 0.8 * fine.at(at);
        (0.7 * ripple * strength + 0.12 * hills.at(at) + 0.05 * grain, grain)
    }));
    let heights = stretched(heights);
    let colors = [[0.66, 0.54, 0.37], [0.78, 0.67, 0.49], [0.86, 0.77, 0.60]];
    let color = |(height, grain): (&f32, &f32)| ramp(&colors, 0.15 + 0.7 * height + 0.16 * grain);
    shaded(&heights, heights.iter().zip(&grains).map(color).collect(), 0.55)
}

/// Broken rock: tilted faces of three sizes with rough noise, ridges and lichen on top.
fn hill() -> Vec<u8> {
    let bends = [51, 57].map(|key| Noise::new(key, [5, 5], 5, 0.6));
    let (roughness, ridges) = (Noise::new(89, [12, 12], 6, 0.62), Noise::new(97, [6, 6], 4, 0.55));
    let lichens = Noise::new(101, [9, 9], 5, 0.7);
    let (heights, marks) = apart(made(|at| {
        let bent = [at[0] + 0.05 * bends[0].at(at), at[1] + 0.05 * bends[1].at(at)];
        let face = |key: u32, count: u32| face(key, [count, count], 0.3, bent);
        let ((large, tone), (middle, _), (small, _)) = (face(61, 5), face(67, 13), face(73, 31));
        let rough = roughness.at(at);
        let height = large + 0.55 * middle + 0.25 * small + 0.3 * rough + 0.35 * ridges.ridges(bent);
        let lichen = smoothstep(0.28, 0.55, lichens.at(at));
        (height, [rough, lichen, tone + 0.5])
    }));
    let heights = stretched(heights);
    let colors = [[0.21, 0.19, 0.17], [0.38, 0.35, 0.31], [0.50, 0.46, 0.41], [0.62, 0.58, 0.53]];
    let color = |(height, [rough, lichen, tone]): (&f32, &[f32; 3])| {
        let stone = ramp(&colors, 0.05 + 0.85 * height + 0.25 * rough + 0.1 * (tone - 0.5));
        let warm = mixed(stone, [stone[0] * 1.06, stone[1] * 0.97, stone[2] * 0.86], *tone);
        mixed(warm, [0.46, 0.46, 0.34], 0.55 * lichen)
    };
    shaded(&heights, heights.iter().zip(&marks).map(color).collect(), 1.6)
}

/// Snow in soft drifts, with a crust that the wind has cut in places.
fn snow() -> Vec<u8> {
    let (bends, drifts) = (Noise::new(111, [4, 4], 2, 0.5), Noise::new(113, [3, 7], 4, 0.45));
    let cuts = Noise::new(127, [5, 5], 3, 0.55);
    let (coarse, fine) = (Noise::octave(131, [190, 190]), Noise::octave(137, [256, 256]));
    let (heights, sparkles) = apart(made(|[u, v]| {
        let at = [u + 0.03 * bends.at([u, v]), v];
        let sparkle = coarse.at(at) + fine.at(at);
        (0.6 * drifts.at(at) + 0.22 * cuts.ridges([at[0], at[1] * 2.0]) + 0.025 * sparkle, sparkle)
    }));
    let heights = stretched(heights);
    let colors = [[0.80, 0.85, 0.92], [0.89, 0.92, 0.96], [0.95, 0.96, 0.98]];
    let color = |(height, sparkle): (&f32, &f32)| ramp(&colors, 0.15 + 0.75 * height + 0.10 * sparkle);
    shaded(&heights, heights.iter().zip(&sparkles).map(color).collect(), 0.35)
}

/// Layers of rock with uneven thickness and hardness, broken into blocks. The top edge of the texture is the upper side.
fn strata() -> Vec<u8> {
    let (folds, tears) = (Noise::new(151, [3, 3], 3, 0.5), Noise::new(157, [11, 17], 5, 0.7));
    let beds = [(163, 9), (173, 37)].map(|(key, count)| Noise::octave(key, [1, count / 3]));
    let roughness = Noise::new(193, [12, 20], 6, 0.66);
    let (heights, marks) = apart(made(|[u, v]| {
        let (fold, torn) = (0.02 * folds.at([u, v]), 0.010 * tears.at([u, v]));
        // Thick layers are divided into thin layers.
        let bed = |key: u32, count: u32, unevenness: &Noise, at: f32| {
            let scaled = at * count as f32 + 0.6 * unevenness.at([0.0, at]);
            let index = (scaled.floor() as i32).rem_euclid(count as i32) as u32;
            (random(key + 1, [index, 0]), scaled - scaled.floor())
        };
        let (thick, inside) = bed(163, 9, &beds[0], v + fold + torn);
        let (leaf, within) = bed(173, 37, &beds[1], v + fold + 0.6 * torn);
        let at = [u + 3.0 * torn + 0.37 * thick, v + fold + torn];
        let ((large, tone), (small, _)) = (face(181, [8, 15], 0.5, at), face(187, [21, 44], 0.5, at));
        let rough = roughness.at([u, v]);
        let ledge = smoothstep(0.0, 0.16, inside) * (0.75 + 0.25 * smoothstep(0.0, 0.3, within));
        let height = (0.4 + 0.45 * thick + 0.2 * leaf + 0.4 * large + 0.22 * small + 0.35 * rough)
            * (0.3 + 0.7 * ledge);
        (height, [thick, leaf, rough, tone])
    }));
    let heights = stretched(heights);
    let colors = [[0.45, 0.38, 0.33], [0.54, 0.47, 0.40], [0.61, 0.56, 0.50], [0.51, 0.49, 0.46]];
    let color = |(height, [thick, leaf, rough, tone]): (&f32, &[f32; 4])| {
        let layer = ramp(&colors, 0.6 * thick + 0.25 * leaf + 0.3 * (tone + 0.25));
        layer.map(|channel| channel * (0.5 + 0.65 * height + 0.2 * rough + 0.12 * tone))
    };
    shaded(&heights, heights.iter().zip(&marks).map(color).collect(), 1.2)
}
