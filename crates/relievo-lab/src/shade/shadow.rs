//! Self-shadow: the CPU reference of `wgsl/surface/shadow.wgsl`.

use relievo::ops::surface::map::HeightMap;
use relievo::ops::surface::relief::reference::height::height;
use relievo::ops::surface::relief::{LEAST_COSINE, MAX_STEPS, March, ReliefHit, ReliefRay};
use relievo::shared::surface::shadow::{
    SURFACE_LEAST_OCCLUSION as LEAST_OCCLUSION, SURFACE_SHADOW_BIAS as BIAS,
};

/// The ray from the light to a point of the surface. `light` is the unit vector towards the light, in tangent
/// space.
pub fn light_ray(hit: &ReliefHit, light: [f32; 3], scale: f32) -> ReliefRay {
    let steepness = -scale / light[2].max(LEAST_COSINE);
    let slope = [light[0] * steepness, light[1] * steepness];
    let rise = 1.0 - hit.height;
    let origin = [hit.uv[0] - rise * slope[0], hit.uv[1] - rise * slope[1]];
    ReliefRay { origin, slope, cosine: light[2], polygon: 0.0 }
}

/// Whether the light's ray ended above the point at which it was aimed.
pub fn shaded(first: &ReliefHit, hit: &ReliefHit) -> bool {
    first.parameter < 1.0 - hit.height - BIAS
}

/// Input of [`soft_shadow`] besides the point.
#[derive(Debug, Clone, Copy)]
pub struct SoftShadow<'a> {
    /// Heights, 0 to 1.
    pub map: &'a HeightMap,
    /// Unit vector towards the light, in tangent space.
    pub light: [f32; 3],
    /// Depth of the relief in uv units, 0 or more.
    pub scale: f32,
    /// Addressing of the map.
    pub march: &'a March,
    /// Number of height samples on the way to the light, 1 to [`MAX_STEPS`].
    pub steps: u32,
    /// Ratio at which the shadow is full, > 0 ([`ReliefMaterial::softness`](relievo::scene::ReliefMaterial::softness)).
    pub softness: f32,
}

/// The light that reaches a point, 0 in full shadow to 1 in full light.
pub fn soft_shadow(shadow: &SoftShadow<'_>, hit: &ReliefHit) -> f32 {
    let SoftShadow { map, light, scale, march, steps, softness } = *shadow;
    if light[2] <= 0.0 {
        return 0.0;
    }
    let own = height(map, hit.uv, march.address);
    let start = ReliefHit { height: hit.height.max(own), ..*hit };
    let ray = light_ray(&start, light, scale);
    let rise = 1.0 - start.height;
    let count = steps.clamp(1, MAX_STEPS);
    let mut shade = 0.0;
    for step in 1..=count {
        let fraction = step as f32 / (count + 1) as f32;
        let travelled = fraction * fraction;
        let parameter = rise * (1.0 - travelled);
        let excess = height(map, ray.at(parameter), march.address) - (1.0 - parameter) - BIAS;
        shade = f32::max(shade, excess / (softness * (travelled * rise + LEAST_OCCLUSION)));
    }
    1.0 - shade.min(1.0)
}
