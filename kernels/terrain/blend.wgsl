// Colour map of patches, seen from above, with one sRGB pixel per sample: the textures of the ground, blended by zones (thesis
// B equations 3.6 and 3.7), with hill-shading. The kernel reads windows that extend one sample beyond the patch.
import package::wgsl::dispatch::nonuniform;
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::light::{Light, lit};
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::tiles::{MapZone, plane_tiles, texel_index, tiles_up};
import package::wgsl::terrain::windows::{gradient_at, inner_index, is_inner, sample_index, windows};
import package::wgsl::terrain::zones::{steepness, zone_blend, zone_blended, zone_color};

// Parameters of the kernel `terrain/blend`.
struct MapParams {
    // Light of the hill-shading.
    light: Light,
    // Number of samples along an edge of a window.
    width: u32,
    // Twice the distance between samples, in 1/65536 world units.
    run: f32,
    // Number of zones.
    zone_count: u32,
    // 1 if zone weights are added without normalization, 0 if they are normalized.
    additive: u32,
    // Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    planes: u32,
    // Number of texture tiles per sample, in 2^-22 tiles.
    tiles_per_sample: u32,
    // Number of texture tiles per world unit of height, in 2^-22 tiles.
    tiles_per_unit: u32,
    // Strength of the colour variation, 0 to 1.
    variation: f32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: MapParams;
// Zones of the ground and their textures.
@group(0) @binding(2) var<storage, read> zones: array<MapZone>;
// Texels of all textures: linear colour and height, 16 bits each.
@group(0) @binding(3) var<storage, read> texels: array<vec2<u32>>;
// Position of the first pixel of each map, in 2^-22 tiles.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
// Out: sRGB pixels, RGBA with 8 bits each, red in the lowest byte.
@group(0) @binding(5) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let sample = sample_index(params.width, id);
    let fixed_height = windows[sample];
    let height = f32(fixed_height) / f32(HEIGHT_ONE);
    let normal = slope_normal(gradient_at(params.width, sample), params.run);
    let steep = steepness(normal);
    // The position in 2^-22 tiles: east, up, south.
    let place = places[id.z] + id.xy * params.tiles_per_sample;
    let tiles = vec3<u32>(place.x, tiles_up(fixed_height, params.tiles_per_unit), place.y);
    var weights = vec3<f32>(1.0, 0.0, 0.0);
    let planes = nonuniform(params.planes, id.x);
    if planes == TRIPLANAR_PLANES {
        weights = triplanar_weights(normal);
    }
    var blend = zone_blend();
    let zone_count = nonuniform(params.zone_count, id.x);
    for (var z = 0u; z < zone_count; z++) {
        let map_zone = zones[z];
        var texel = vec4<f32>(0.0);
        for (var plane = 0u; plane < planes; plane++) {
            texel += triplanar_weight(weights, plane) * texel_at(texel_index(map_zone, plane_tiles(plane, tiles)));
        }
        blend = zone_blended(blend, map_zone.zone, height, steep, texel);
    }
    // An f32 holds the 10 integer bits and 14 fractional bits of a position exactly.
    let variation = color_variation(vec2<f32>(tiles.xz >> vec2<u32>(8u)) / 16384.0);
    let albedo = varied(zone_color(blend, params.additive != 0u), variation, params.variation);
    pixels[inner_index(params.width, id)] = pack4x8unorm(vec4<f32>(srgb(lit(params.light, normal, albedo)), 1.0));
}

// Linear colour (rgb) and height (w) of a texel, 0 to 1.
fn texel_at(index: u32) -> vec4<f32> {
    let texel = texels[index];
    return vec4<f32>(unpack2x16unorm(texel.x), unpack2x16unorm(texel.y));
}

// sRGB transfer function, with an error of at most 1/100 of an 8-bit step. A minimax polynomial in the fourth root of x
// replaces 1.055 x^(1/2.4) − 0.055. Its largest error from 0.0031308 to 1 is 3.4e-5. On software adapters, a power function
// takes six times as long.
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let root = sqrt(sqrt(bounded));
    let high = (((0.08132998 * root - 0.33550157) * root + 1.12268163) * root + 0.19613586) * root - 0.06461154;
    return select(high, 12.92 * bounded, bounded <= vec3<f32>(0.0031308));
}
