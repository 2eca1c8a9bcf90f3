// The top-down colour map of patches: the ground's textures by zones (B equations 3.6 and 3.7) and hill-shading, one sRGB pixel
// per sample. The kernel reads windows that extend one sample beyond the patch. Places in textures are whole numbers, so that
// every device reads the same texels.
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::zones::{Zone, steepness, zone_blend, zone_blended, zone_color};
import package::wgsl::terrain::light::{Light, lit};

struct MapParams {
    light: Light,
    in_width: u32,
    run: f32,
    zone_count: u32,
    additive: u32,
    // Texture tiles per sample and per unit of height, in 2^-22 tiles.
    tiles_per_sample: u32,
    tiles_per_unit: u32,
    // 1 where textures lie on the ground from above alone, 3 where they lie on it from the sides too.
    planes: u32,
    // The strength of the variation of colour.
    variation: f32,
}

// A zone as the colour map uses it.
struct MapZone {
    zone: Zone,
    // The index of the first texel of its texture.
    first: u32,
    // The texels along an edge of its texture are 2 to this power.
    edge_log2: u32,
}

// The bits of a position in tiles behind the point; those before it are the 10 bits of TILES_PERIOD.
const TILE_BITS: u32 = 22u;

@group(0) @binding(0) var<uniform> params: MapParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read> zones: array<MapZone>;
// Linear colour and height of texels, 16 bits each.
@group(0) @binding(3) var<storage, read> texels: array<vec2<u32>>;
// The position in tiles of the first pixel of each map, in 2^-22 tiles.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
// RGBA, 8 bits each, red in the lowest byte.
@group(0) @binding(5) var<storage, read_write> pixels: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    if id.x >= width {
        return;
    }
    let at = id.xy + vec2<u32>(1u);
    let center = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let gradient = vec2<i32>(
        windows[center + 1u] - windows[center - 1u],
        windows[center + params.in_width] - windows[center - params.in_width]);
    let normal = slope_normal(gradient, params.run);
    let east_south = places[id.z] + id.xy * params.tiles_per_sample;
    let tiles = vec3<u32>(east_south.x, tiles_up(windows[center]), east_south.y);
    let color = srgb(lit(params.light, normal, ground_color(windows[center], normal, tiles)));
    pixels[(id.z * width + id.y) * width + id.x] = pack4x8unorm(vec4<f32>(color, 1.0));
}

// A height in 2^-22 tiles, rounded down, without whole multiples of TILES_PERIOD.
fn tiles_up(height: i32) -> u32 {
    let part = u32(height) & 0xffffu;
    let low = part * (params.tiles_per_unit & 0xffffu);
    return u32(height >> 16u) * params.tiles_per_unit + part * (params.tiles_per_unit >> 16u) + (low >> 16u);
}

// The colour of the ground at a place, given in 2^-22 tiles: east, up, south.
fn ground_color(height: i32, normal: vec3<f32>, tiles: vec3<u32>) -> vec3<f32> {
    let weights = select(vec3<f32>(1.0, 0.0, 0.0), triplanar_weights(normal), params.planes == TRIPLANAR_PLANES);
    let steep = steepness(normal);
    let units = f32(height) / f32(HEIGHT_ONE);
    var blend = zone_blend();
    for (var z = 0u; z < params.zone_count; z++) {
        let here = zones[z];
        var texel = vec4<f32>(0.0);
        for (var plane = 0u; plane < params.planes; plane++) {
            texel += triplanar_weight(weights, plane) * texel_of(here, plane_tiles(plane, tiles));
        }
        blend = zone_blended(blend, here.zone, units, steep, texel);
    }
    let color = zone_color(blend, params.additive != 0u);
    if params.variation == 0.0 {
        return color;
    }
    // 14 bits behind the point fit an f32.
    return varied(color, color_variation(vec2<f32>(tiles.xz >> vec2<u32>(8u)) / 16384.0), params.variation);
}

// As `triplanar_uv`, in whole numbers.
fn plane_tiles(plane: u32, tiles: vec3<u32>) -> vec2<u32> {
    let wall = vec2<u32>(select(tiles.x, tiles.z, plane == 1u), 0u - tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

fn texel_of(map_zone: MapZone, tiles: vec2<u32>) -> vec4<f32> {
    let edge = vec2<u32>(TILE_BITS - map_zone.edge_log2);
    let mask = vec2<u32>((1u << map_zone.edge_log2) - 1u);
    let at = ((tiles * u32(map_zone.zone.repeats)) >> edge) & mask;
    let texel = texels[map_zone.first + (at.y << map_zone.edge_log2) + at.x];
    return vec4<f32>(unpack2x16unorm(texel.x), unpack2x16unorm(texel.y));
}

fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let low = 12.92 * bounded;
    let high = 1.055 * pow(bounded, vec3<f32>(1.0 / 2.4)) - vec3<f32>(0.055);
    return select(high, low, bounded <= vec3<f32>(0.0031308));
}
