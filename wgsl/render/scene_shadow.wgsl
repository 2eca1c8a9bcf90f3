// The sun's shadow, read from the sun's shadow map with percentage closer filtering (Reeves, Salesin and Cook 1987).
// docs/shadows.md derives the constants.
import package::wgsl::render::scene_view::view;

// Whether the shadow map shadows surfaces.
override SHADOWED: bool = false;

// Shadow map: distance along the light to the nearest caster. 0 is the sun's near plane; 1 means that there is no caster.
@group(0) @binding(4) var shadow_map: texture_depth_2d;
// Comparison sampler: compares a distance with four texels, and filters the four results.
@group(0) @binding(5) var shadow_sampler: sampler_comparison;

// Bound of the filter's reach in texels, in any direction. Along each axis the reach is below 2, so the bound is 2 · √2.
const SHADOW_REACH: f32 = 2.828427;
// Addend to the sine of the angle between normal and light. It accounts for triangles that lean by up to 0.2 radians from the
// normals interpolated between their vertices.
const SHADOW_LEAN: f32 = 0.2;
// Bound of the rounding error of a distance in the map, as a fraction of the distance between the sun's near and far plane.
const SHADOW_ROUNDING: f32 = 2e-6;
// Width of the margin in which shadows fade out, as a fraction of the distance from the map's middle to its edge.
const SHADOW_FADE: f32 = 0.05;

// Fraction of the sun's light that reaches a surface point, 0 to 1. It is 1 in a view without a shadow. `position` is relative
// to the corner of the view's cell, and `normal` is a unit vector.
fn scene_sunlit(position: vec3<f32>, normal: vec3<f32>) -> f32 {
    let cosine = clamp(dot(normal, view.light.xyz), -1.0, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let offset = SHADOW_REACH * min(sine + SHADOW_LEAN, 1.0) * view.shadow_texel;
    let place = vec4<f32>(position + offset * normal, 1.0);
    let uv = vec2<f32>(dot(view.shadow_rows[0], place), dot(view.shadow_rows[1], place));
    let depth = dot(view.shadow_rows[2], place) - SHADOW_ROUNDING;
    let edge = max(abs(2.0 * uv.x - 1.0), abs(2.0 * uv.y - 1.0));
    let fade = clamp((1.0 - edge) / SHADOW_FADE, 0.0, 1.0);
    return 1.0 - fade * (1.0 - shadow_filtered(uv, clamp(depth, 0.0, 1.0)));
}

// Weighted fraction of 4 × 4 shadow map texels that are not nearer to the sun than `depth`. Along each axis, the weights are
// 1 − s, 2 − s, 1 + s and s, where s is the offset from the second texel's center. Four bilinear samples cover all 16 texels
// (Castaño 2013).
fn shadow_filtered(uv: vec2<f32>, depth: f32) -> f32 {
    let size = vec2<f32>(textureDimensions(shadow_map));
    let place = uv * size;
    let base = floor(place + 0.5);
    let s = place + 0.5 - base;
    let low = 3.0 - 2.0 * s;
    let high = 1.0 + 2.0 * s;
    let a = (base - 0.5 + (2.0 - s) / low - 1.0) / size;
    let b = (base - 0.5 + s / high + 1.0) / size;
    let near = low.x * textureSampleCompareLevel(shadow_map, shadow_sampler, a, depth)
        + high.x * textureSampleCompareLevel(shadow_map, shadow_sampler, vec2<f32>(b.x, a.y), depth);
    let far = low.x * textureSampleCompareLevel(shadow_map, shadow_sampler, vec2<f32>(a.x, b.y), depth)
        + high.x * textureSampleCompareLevel(shadow_map, shadow_sampler, b, depth);
    return (low.y * near + high.y * far) / 16.0;
}
