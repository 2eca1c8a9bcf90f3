// The shadow of the sun: the fraction of its light that passes everything the sun's view has drawn into its map, by percentage
// closer filtering (Reeves, Salesin and Cook 1987). docs/shadows.md derives the constants.
import package::wgsl::render::scene_view::view;

// Whether surfaces are looked up in the map.
override SHADOWED: bool = false;

// The distances along the light, 0 at the sun's near plane to 1, of what the sun sees first; 1 where it sees nothing.
@group(0) @binding(4) var shadow_map: texture_depth_2d;
// Compares a distance with four texels, and filters the results.
@group(0) @binding(5) var shadow_sampler: sampler_comparison;

// The filter reaches less than 2 texels along both axes, hence less than this along any direction: 2 · √2.
const SHADOW_REACH: f32 = 2.828427;
// What is added to the sine of the angle between the normal and the light, since triangles lean away from the normals between
// their vertices: by 0.2 radians or less.
const SHADOW_LEAN: f32 = 0.2;
// What rounding may do to a distance in the map, as a fraction of the distance between the sun's near and far plane.
const SHADOW_ROUNDING: f32 = 2e-6;
// The part of the way from the middle of the map to its edge along which shadows fade.
const SHADOW_FADE: f32 = 0.05;

// The fraction of the sun's light that reaches a point, relative to the corner of the view's cell, of a surface with this unit
// normal; 1 in a view without a shadow.
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

// The weighted fraction of 4 × 4 texels that are no nearer to the sun than a depth. Along each axis their weights are 1 − s,
// 2 − s, 1 + s and s, where s is how far the place lies beyond the second one's center; four samples between two texels each
// have them all (Castaño 2013).
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
