//! Top-down colour maps: the CPU reference of `kernels/terrain/blend.wgsl` and `wgsl/terrain/zones.wgsl`.

mod texturing;

use glam::Vec3;

use crate::asset::light::lambert;
use crate::srgb;
use crate::terrain::blend::{Shading, WeightMode};
use crate::terrain::cover::{Cover, ShaderZone};
use crate::terrain::normals::reference::unit_normal;
pub use texturing::{color_variation, texel, texel_indices, tiles_of, triplanar_weights, varied};

/// Steepness of a unit normal: the tangent of half its angle to the vertical. 0 on level ground, 1 on a vertical wall.
pub fn steepness(normal: [f32; 3]) -> f32 {
    let [x, y, z] = normal;
    (x * x + z * z).sqrt() / (1.0 + y)
}

/// Weight of a zone at a height and a steepness, 0 to 1 (B equation 3.6). It is the product of three factors: one for the
/// height, and one for each end of the zone's slope range. The factor for the height is 1 at `max` and falls linearly to 0 at
/// `max` ± (`max` − `min`).
pub fn zone_weight(zone: &ShaderZone, height: f32, steep: f32) -> f32 {
    let range = zone.max - zone.min;
    let line = |line: [f32; 2]| (line[0] * steep + line[1]).clamp(0.0, 1.0);
    ((range - (height - zone.max).abs()) / range).max(0.0) * (line(zone.rise) * line(zone.fall))
}

/// Factor by which the weight of a zone is multiplied, 0 to 1. `texel_height` is the height in the zone's texture, 0 to 1.
pub fn prominence(zone: &ShaderZone, texel_height: f32) -> f32 {
    let squared = (1.0 + zone.height_blend * (0.9375 * texel_height - 0.9375)).powi(2);
    squared * squared
}

/// Fraction of each zone's colour in the colour of the ground, in the order of `zones`. `height` is in height units, and `steep`
/// is the [`steepness`], 0 to 1. `texel_heights` has the height in each zone's texture at the point, 0 to 1.
pub fn zone_fractions(
    zones: &[ShaderZone],
    height: f32,
    steep: f32,
    texel_heights: &[f32],
    weights: WeightMode,
) -> Vec<f32> {
    let all: Vec<f32> = zones.iter().map(|zone| zone_weight(zone, height, steep)).collect();
    let factor = |((zone, texel), weight): ((&ShaderZone, &f32), &f32)| weight * prominence(zone, *texel);
    let factors: Vec<f32> = zones.iter().zip(texel_heights).zip(&all).map(factor).collect();
    let total: f32 = factors.iter().sum();
    if total > 0.0 {
        let sum = if weights == WeightMode::Additive { all.iter().sum() } else { 1.0 };
        return factors.into_iter().map(|factor| sum * (factor / total)).collect();
    }
    if weights == WeightMode::Additive {
        return vec![0.0; zones.len()];
    }
    let distance = |zone: &ShaderZone| (height - zone.max).abs() - (zone.max - zone.min);
    let nearest = (zones.iter().enumerate())
        .min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)))
        .map_or(0, |(index, _)| index);
    (0..zones.len()).map(|index| if index == nearest { 1.0 } else { 0.0 }).collect()
}

/// Colour map of a window with `width` samples per row, without the outermost ring of samples. Pixels are sRGB RGBA with 8 bits
/// per channel, red in the lowest byte. `place` is the texture position of the first inner sample ([`Cover::place`]).
pub fn blend(window: &[i32], width: usize, cover: &Cover, shading: &Shading, place: [u32; 2]) -> Vec<u32> {
    let at = |x: usize, y: usize| window[y * width + x];
    let zones: Vec<ShaderZone> = cover.zones.iter().map(|map_zone| map_zone.zone).collect();
    let mut pixels = Vec::with_capacity((width - 2) * (width - 2));
    for y in 1..width - 1 {
        for x in 1..width - 1 {
            let gradient = [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)];
            let normal = unit_normal(gradient, cover.terrain_scale);
            let facing = Vec3::from(normal).dot(shading.light.into()).max(0.0);
            let light = lambert(shading.ambient, facing);
            let tiles = tiles_of(cover, place, [x - 1, y - 1], at(x, y));
            let color = ground_color(cover, &zones, shading.weights, at(x, y), normal, tiles);
            let bytes = color.map(|channel| srgb::byte(channel * light));
            pixels.push(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], 255]));
        }
    }
    pixels
}

/// Linear colour of the ground at a texture position `tiles` (east, up, south), in 2^-22 tiles.
fn ground_color(
    cover: &Cover,
    zones: &[ShaderZone],
    weights: WeightMode,
    height: i32,
    normal: [f32; 3],
    tiles: [u32; 3],
) -> [f32; 3] {
    let texels: Vec<[f32; 4]> =
        cover.zones.iter().map(|zone| texturing::texel(cover, zone, normal, tiles)).collect();
    let texel_heights: Vec<f32> = texels.iter().map(|texel| texel[3]).collect();
    let (height, steep) = (height as f32 / 65_536.0, steepness(normal));
    let mut color = [0.0; 3];
    for (fraction, texel) in zone_fractions(zones, height, steep, &texel_heights, weights).iter().zip(&texels)
    {
        for (sum, channel) in color.iter_mut().zip(texel) {
            *sum += fraction * channel;
        }
    }
    if cover.variation == 0.0 {
        return color;
    }
    let [east, _, south] = tiles.map(|tiles| (tiles >> 8) as f32 / 16_384.0);
    varied(color, color_variation([east, south]), cover.variation)
}
