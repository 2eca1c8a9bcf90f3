//! Generation of the built-in textures.

mod grass;
mod stones;

use super::field::{Field, made, mixed, ramp, stretched, texels as shaded};
use super::noise::{cell, gradient, octaves, random, ridges, smoothstep};
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

/// Sand: wind ripples, bent and broken up by noise, with grains on top.
fn sand() -> Vec<u8> {
    let (heights, grains) = apart(made(|at| {
        let [u, v] = at;
        let bend = 0.045 * octaves(11, [3, 3], 3, 0.5, at);
        let phase = 2.0 * u + 17.0 * (v + bend) + 0.35 * gradient(17, [9, 9], at);
        let wave = phase - phase.floor();
        // Ripples are asymmetric: the windward side is long, the lee side short.
        let ripple = if wave < 0.68 { wave / 0.68 } else { (1.0 - wave) / 0.32 };
        let ripple = smoothstep(0.0, 1.0, ripple);
        let strength = 0.55 + 0.45 * octaves(23, [5, 5], 2, 0.5, at);
        let grain = gradient(31, [160, 160], at) + 0.8 * gradient(32, [251, 251], at);
        (0.7 * ripple * strength + 0.12 * octaves(41, [6, 6], 4, 0.5, at) + 0.05 * grain, grain)
    }));
    let heights = stretched(heights);
    let colors = [[0.66, 0.54, 0.37], [0.78, 0.67, 0.49], [0.86, 0.77, 0.60]];
    let color = |(height, grain): (&f32, &f32)| ramp(&colors, 0.15 + 0.7 * height + 0.16 * grain);
    shaded(&heights, heights.iter().zip(&grains).map(color).collect(), 0.55)
}

/// Broken rock: tilted faces of three sizes with rough noise, ridges and lichen on top.
fn hill() -> Vec<u8> {
    let (heights, marks) = apart(made(|at| {
        let bend = |key: u32| 0.05 * octaves(key, [5, 5], 5, 0.6, at);
        let bent = [at[0] + bend(51), at[1] + bend(57)];
        let face = |key: u32, count: u32| {
            let cell = cell(key, [count, count], bent);
            let number = |use_of: u32| random(key + 1, [cell.word, use_of]) - 0.5;
            (cell.offset[0] * number(0) + cell.offset[1] * number(1) + 0.3 * number(2), number(3))
        };
        let ((large, tone), (middle, _), (small, _)) = (face(61, 5), face(67, 13), face(73, 31));
        let rough = octaves(89, [12, 12], 6, 0.62, at);
        let ridge = ridges(97, 6, 4, bent);
        let height = large + 0.55 * middle + 0.25 * small + 0.3 * rough + 0.35 * ridge;
        let lichen = smoothstep(0.28, 0.55, octaves(101, [9, 9], 5, 0.7, at));
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
    let (heights, sparkles) = apart(made(|[u, v]| {
        let at = [u + 0.03 * octaves(111, [4, 4], 2, 0.5, [u, v]), v];
        let drift = octaves(113, [3, 7], 4, 0.45, at);
        let cut = ridges(127, 5, 3, [at[0], at[1] * 2.0]);
        let sparkle = gradient(131, [190, 190], at) + gradient(137, [256, 256], at);
        (0.6 * drift + 0.22 * cut + 0.025 * sparkle, sparkle)
    }));
    let heights = stretched(heights);
    let colors = [[0.80, 0.85, 0.92], [0.89, 0.92, 0.96], [0.95, 0.96, 0.98]];
    let color = |(height, sparkle): (&f32, &f32)| ramp(&colors, 0.15 + 0.75 * height + 0.10 * sparkle);
    shaded(&heights, heights.iter().zip(&sparkles).map(color).collect(), 0.35)
}

/// Layers of rock with uneven thickness and hardness, broken into blocks. The top edge of the texture is the upper side.
fn strata() -> Vec<u8> {
    let (heights, marks) = apart(made(|[u, v]| {
        let fold = 0.02 * octaves(151, [3, 3], 3, 0.5, [u, v]);
        let torn = 0.010 * octaves(157, [11, 17], 5, 0.7, [u, v]);
        // Thick layers are divided into thin layers.
        let bed = |key: u32, count: u32, at: f32| {
            let scaled = at * count as f32 + 0.6 * gradient(key, [1, count / 3], [0.0, at]);
            let index = (scaled.floor() as i32).rem_euclid(count as i32) as u32;
            (random(key + 1, [index, 0]), scaled - scaled.floor())
        };
        let (thick, inside) = bed(163, 9, v + fold + torn);
        let (leaf, within) = bed(173, 37, v + fold + 0.6 * torn);
        let block = |key: u32, counts: [u32; 2]| {
            let cell = cell(key, counts, [u + 3.0 * torn + 0.37 * thick, v + fold + torn]);
            let number = |use_of: u32| random(key + 1, [cell.word, use_of]) - 0.5;
            (cell.offset[0] * number(0) + cell.offset[1] * number(1) + 0.5 * number(2), number(3))
        };
        let ((large, tone), (small, _)) = (block(181, [8, 15]), block(187, [21, 44]));
        let rough = octaves(193, [12, 20], 6, 0.66, [u, v]);
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
