// Light that reaches a point of a relief, for every kind of self-shadow.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch};
import package::wgsl::surface::shadow::{surface_light_ray, surface_shaded, surface_soft_shadow};
import package::wgsl::surface::trace::surface_trace;

// Kind of self-shadow: none.
const SURFACE_SHADOW_NONE: u32 = 0u;
// Kind of self-shadow: full light or none. A ray from the light is traced like the eye's ray.
const SURFACE_SHADOW_HARD: u32 = 1u;
// Kind of self-shadow: soft, with penumbras.
const SURFACE_SHADOW_SOFT: u32 = 2u;

// Parameters of a relief's self-shadow.
struct SurfaceShadow {
    // Depth of the relief in uv units.
    scale: f32,
    // Number of steps of a soft shadow.
    steps: u32,
    // Softness of a soft shadow: the shadow is full where the surface rises above the light's path by at least this factor
    // times the distance from the shaded point.
    softness: f32,
}

// Fraction of the light that reaches a hit, 0 to 1. `light` is the unit vector towards the light in tangent space. `shadow` is
// one of the constants above.
fn surface_sunlit(
    method: u32, shadow: u32, heights: texture_2d<f32>, acceleration: texture_2d<f32>,
    hit: SurfaceHit, light: vec3<f32>, relief: SurfaceShadow, march: SurfaceMarch,
) -> f32 {
    if shadow == SURFACE_SHADOW_NONE || !(light.z > 0.0) {
        return 1.0;
    }
    if shadow == SURFACE_SHADOW_SOFT {
        return surface_soft_shadow(heights, hit, light, relief.scale, march, relief.steps, relief.softness);
    }
    let ray = surface_light_ray(hit, light, relief.scale);
    let first = surface_trace(method, heights, acceleration, ray, march);
    return select(1.0, 0.0, surface_shaded(first, hit));
}

// Unit normal in tangent space, from a texel of a normal map. If `green_up` is true, the texture's green channel points up the
// image, against v. If false, it points down the image.
fn surface_mapped_normal(texel: vec4<f32>, green_up: bool) -> vec3<f32> {
    let slope = texel.xy * 2.0 - 1.0;
    return vec3<f32>(slope.x, select(slope.y, -slope.y, green_up), sqrt(max(1.0 - dot(slope, slope), 0.0)));
}
