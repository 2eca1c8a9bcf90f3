// Self-shadow: whether light reaches a point of the surface (thesis B section 3.1.2). For a hard shadow, any tracing method
// traces the light's ray from the top of the volume. The point is lit if the ray reaches it. For a soft shadow, samples measure
// how far the surface rises above the path to the light. The further the occluder, the wider the penumbra.
import package::wgsl::surface::ray::{SURFACE_LEAST_COSINE, SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::height::surface_height;
import package::wgsl::surface::linear::SURFACE_MAX_STEPS;

// Height difference below which a point does not shade itself, as a fraction of the relief's depth.
const SURFACE_SHADOW_BIAS: f32 = 0.005;
// Addend to the distance of an occluder, as a fraction of the relief's depth, so that no occluder is at distance 0.
const SURFACE_LEAST_OCCLUSION: f32 = 0.001;

// Ray from the light to a point of the surface: it falls from the top of the volume to the hit. `light` is the unit vector
// towards the light, in tangent space.
fn surface_light_ray(hit: SurfaceHit, light: vec3<f32>, scale: f32) -> SurfaceRay {
    let slope = light.xy * (-scale / max(light.z, SURFACE_LEAST_COSINE));
    return SurfaceRay(hit.uv - (1.0 - hit.height) * slope, slope, light.z, 0.0);
}

// Whether the point `hit` is in hard shadow. `first` is the result of the light's ray to this point: in shadow, the ray ended
// above the point.
fn surface_shaded(first: SurfaceHit, hit: SurfaceHit) -> bool {
    return first.parameter < 1.0 - hit.height - SURFACE_SHADOW_BIAS;
}

// Light that reaches a point, 0 (full shadow) to 1 (full light), from `steps` heights on the path to the light. `softness` sets
// the width of the penumbra: shadow is full where the surface rises above the path by at least `softness` times the distance
// from the point.
fn surface_soft_shadow(
    heights: texture_2d<f32>, hit: SurfaceHit, light: vec3<f32>, scale: f32, march: SurfaceMarch,
    steps: u32, softness: f32,
) -> f32 {
    if !(light.z > 0.0) {
        return 0.0;
    }
    // The march starts at the surface, because the hit may lie slightly below it.
    let own = surface_height(heights, hit.uv, march.mip, march.address);
    var start = hit;
    start.height = max(hit.height, own);
    let ray = surface_light_ray(start, light, scale);
    let rise = 1.0 - start.height;
    let count = clamp(steps, 1u, SURFACE_MAX_STEPS);
    var shade = 0.0;
    for (var step = 1u; (step <= count) & (shade < 1.0); step++) {
        // Samples are denser close to the point, where an occluder casts the sharpest shadow.
        let fraction = f32(step) / f32(count + 1u);
        let travelled = fraction * fraction;
        let parameter = rise * (1.0 - travelled);
        let height = surface_height(heights, ray.origin + parameter * ray.slope, march.mip, march.address);
        let excess = height - (1.0 - parameter) - SURFACE_SHADOW_BIAS;
        shade = max(shade, excess / (softness * (travelled * rise + SURFACE_LEAST_OCCLUSION)));
    }
    return 1.0 - min(shade, 1.0);
}

