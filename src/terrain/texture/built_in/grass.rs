//! Grass texture, seen from above: blades grow from random places, and the highest blade is visible.

use crate::terrain::texture::field::{EDGE, made, mixed, texels as shaded};
use crate::terrain::texture::noise::{Noise, random, smoothstep};

/// Number of grass blades in the texture.
const BLADES: u32 = 30_000;

/// Height and colour of the surface that is visible at a texel.
#[derive(Clone, Copy)]
struct Seen {
    height: f32,
    color: [f32; 3],
}

/// Generates the texels of the grass texture.
pub fn grass() -> Vec<u8> {
    let (roughness, tufts) = (Noise::new(201, [24, 24], 4, 0.6), Noise::new(223, [11, 11], 3, 0.5));
    let soil = made(|at| {
        let rough = roughness.at(at);
        Seen {
            height: 0.08 + 0.08 * rough,
            color: mixed([0.17, 0.16, 0.09], [0.25, 0.23, 0.13], 0.5 + rough),
        }
    });
    let mut seen = soil;
    for blade in 0..BLADES {
        grow(&mut seen, &tufts, blade);
    }
    let heights: Vec<f32> = seen.iter().map(|seen| seen.height.clamp(0.0, 1.0)).collect();
    shaded(&heights, seen.iter().map(|seen| seen.color).collect(), 0.75)
}

/// Draws one blade of grass, which bends to one side.
fn grow(seen: &mut [Seen], tufts: &Noise, blade: u32) {
    let number = |use_of: u32| random(211 + use_of, [blade, 0]);
    let root = [number(0), number(1)];
    let tuft = tufts.at(root);
    let length = (9.0 + 17.0 * number(2)) * (1.0 + 0.5 * tuft);
    let tall = (0.35 + 0.45 * number(3)) * (1.0 + 0.35 * tuft);
    // Random direction, computed without sines: a random point in a square.
    let way = [2.0 * number(4) - 1.0, 2.0 * number(5) - 1.0];
    let scale = length / (way[0] * way[0] + way[1] * way[1]).sqrt().max(0.2);
    let bend = (number(6) - 0.5) * 0.7;
    let dry = smoothstep(0.72, 1.0, number(7) + 0.25 * tuft);
    let green = mixed([0.25, 0.36, 0.11], [0.40, 0.50, 0.18], number(8));
    let tip = mixed(green, [0.60, 0.57, 0.30], 0.25 + 0.6 * dry);
    let steps = (1.5 * length) as usize;
    for step in 0..=steps {
        let t = step as f32 / steps as f32;
        let along = [way[0] - bend * t * way[1], way[1] + bend * t * way[0]].map(|part| part * scale * t);
        let height = 0.15 + tall * t * (1.6 - 0.75 * t);
        let color = mixed(green.map(|channel| channel * (0.55 + 0.5 * t)), tip, t * t);
        for side in 0..if t < 0.75 { 2 } else { 1 } {
            let [x, y] = [0, 1].map(|axis| {
                let across = if axis == 0 { -way[1] } else { way[0] };
                let at = root[axis] * EDGE as f32 + along[axis] + 0.8 * side as f32 * across;
                (at.floor() as i32).rem_euclid(EDGE as i32) as usize
            });
            let seen = &mut seen[y * EDGE + x];
            if height > seen.height {
                *seen = Seen { height, color };
            }
        }
    }
}
