//! Zone weights and the top-down colour map: the CPU reference of `kernels/terrain/blend.wgsl` and
//! `wgsl/terrain/zones.wgsl`.

use crate::srgb;
use crate::terrain::blend::{MapZone, Shading, WeightMode};
use crate::terrain::normals::reference::unit_normal;

/// The weight of a zone at `height` (B equation 3.6): 1 at `max`, falling linearly to 0 at `max` ± (`max` −
/// `min`).
pub fn zone_weight(zone: &MapZone, height: f32) -> f32 {
    let range = zone.max - zone.min;
    ((range - (height - zone.max).abs()) / range).max(0.0)
}

/// The fraction of each zone's colour at `height`, in the order of `zones`.
pub fn zone_fractions(zones: &[MapZone], height: f32, weights: WeightMode) -> Vec<f32> {
    let all: Vec<f32> = zones.iter().map(|zone| zone_weight(zone, height)).collect();
    let total: f32 = all.iter().sum();
    if weights == WeightMode::Additive {
        return all;
    }
    if total > 0.0 {
        return all.into_iter().map(|weight| weight / total).collect();
    }
    let distance = |zone: &MapZone| (height - zone.max).abs() - (zone.max - zone.min);
    let nearest = (zones.iter().enumerate())
        .min_by(|(_, a), (_, b)| distance(a).total_cmp(&distance(b)))
        .map_or(0, |(index, _)| index);
    (0..zones.len()).map(|index| if index == nearest { 1.0 } else { 0.0 }).collect()
}

/// The colour map of a window with `width` samples per row, without the outermost ring of samples: RGBA, 8 bits
/// each, red in the lowest byte.
pub fn blend(
    window: &[i32],
    width: usize,
    terrain_scale: f64,
    zones: &[MapZone],
    shading: &Shading,
) -> Vec<u32> {
    let at = |x: usize, y: usize| window[y * width + x];
    let mut pixels = Vec::with_capacity((width - 2) * (width - 2));
    for y in 1..width - 1 {
        for x in 1..width - 1 {
            let gradient = [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)];
            let normal = unit_normal(gradient, terrain_scale);
            let facing: f32 = normal.iter().zip(shading.light).map(|(n, l)| n * l).sum::<f32>().max(0.0);
            let light = shading.ambient + (1.0 - shading.ambient) * facing;
            let mut color = [0.0; 3];
            for (fraction, zone) in
                zone_fractions(zones, at(x, y) as f32 / 65_536.0, shading.weights).iter().zip(zones)
            {
                for (sum, channel) in color.iter_mut().zip(zone.color) {
                    *sum += fraction * channel;
                }
            }
            let bytes = color.map(|channel| srgb::byte(channel * light));
            pixels.push(u32::from_le_bytes([bytes[0], bytes[1], bytes[2], 255]));
        }
    }
    pixels
}
