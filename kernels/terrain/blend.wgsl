// The top-down colour map of patches: the ground's textures by zones (B equations 3.6 and 3.7) and hill-shading, one sRGB pixel
// per sample. The kernel reads windows that extend one sample beyond the patch. A thread makes a column of pixels, four wide, and
// reads each zone once for the four of a row.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{Row, centers, column_of, right_of, row_at};
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::tiles::{MAX_MAP_ZONES, MapZone, PackedZone, plane_tiles, texel_index, tiles_up, unpacked};
import package::wgsl::terrain::zones::{ZoneBlend, steepness, zone_blend, zone_blended, zone_color};
import package::wgsl::terrain::light::{Light, lit};

// 1 where textures lie on the ground from above alone, 3 where they lie on it from the sides too.
override PLANES: u32 = 3u;
// Whether there is a variation of colour. A constant, because software adapters run what a branch leaves out too.
override VARIED: bool = true;

struct MapParams {
    light: Light,
    blocks: Blocks,
    in_width: u32,
    run: f32,
    zone_count: u32,
    additive: u32,
    // Texture tiles per sample and per unit of height, in 2^-22 tiles.
    tiles_per_sample: u32,
    tiles_per_unit: u32,
    // The strength of the variation of colour.
    variation: f32,
}

@group(0) @binding(0) var<uniform> params: MapParams;
@group(0) @binding(2) var<uniform> zones: array<PackedZone, MAX_MAP_ZONES>;
// Linear colour and height of texels, 16 bits each.
@group(0) @binding(3) var<storage, read> texels: array<vec2<u32>>;
// The position in tiles of the first pixel of each map, in 2^-22 tiles.
@group(0) @binding(4) var<storage, read> places: array<vec2<u32>>;
// RGBA, 8 bits each, red in the lowest byte.
@group(0) @binding(5) var<storage, read_write> pixels: array<u32>;

// What the colour of a pixel depends on, and its zones' textures as far as they have been added.
struct Pixel {
    normal: vec3<f32>,
    // The weights of the planes.
    weights: vec3<f32>,
    // The height in height units.
    height: f32,
    steep: f32,
    // The place in 2^-22 tiles: east, up, south.
    tiles: vec3<u32>,
    blend: ZoneBlend,
}

// Four pixels beside each other.
struct Quad {
    a: Pixel,
    b: Pixel,
    c: Pixel,
    d: Pixel,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    if column.rows == 0u {
        return;
    }
    var source = column.source + params.in_width;
    var row = column.target_index;
    var above = row_at(column.source);
    var here = row_at(source);
    var place = places[column.window] + column.at * params.tiles_per_sample;
    for (var y = 0u; y < column.rows; y++) {
        source += params.in_width;
        let below = row_at(source);
        // Every thread has a row. The bound depends on it so that lavapipe does not compile the loop anew for a number of zones.
        let zone_count = min(params.zone_count, MAX_MAP_ZONES * column.rows);
        store_four(row, column.width, colors(quad(place, above, here, below), zone_count));
        row += params.in_width - 2u;
        place.y += params.tiles_per_sample;
        above = here;
        here = below;
    }
}

// The colours of four pixels.
fn colors(pixels: Quad, zone_count: u32) -> vec4<u32> {
    var made = pixels;
    for (var z = 0u; z < zone_count; z++) {
        made = added(made, unpacked(zones[z]));
    }
    // No colour is less than the number of zones; see `held` for what the maximum is there for. Compilers know that none is less than
    // a constant.
    return max(vec4<u32>(color(made.a), color(made.b), color(made.c), color(made.d)), vec4<u32>(params.zone_count));
}

// Stores four pixels of a row from `at` on, of which there are `width`.
fn store_four(at: u32, width: u32, colors: vec4<u32>) {
    pixels[at] = colors.x;
    if 1u < width {
        pixels[at + 1u] = colors.y;
    }
    if 2u < width {
        pixels[at + 2u] = colors.z;
    }
    if 3u < width {
        pixels[at + 3u] = colors.w;
    }
}

// Four pixels of a row from the one at `place` on, given the rows of samples from the one to the left of it on.
fn quad(place: vec2<u32>, above: Row, here: Row, below: Row) -> Quad {
    let heights = centers(here.a, here.b);
    let along = right_of(here.a, here.b) - here.a;
    let down = centers(below.a, below.b) - centers(above.a, above.b);
    let east = vec4<u32>(place.x) + vec4<u32>(0u, 1u, 2u, 3u) * params.tiles_per_sample;
    return Quad(
        pixel(heights.x, vec2<i32>(along.x, down.x), vec2<u32>(east.x, place.y)),
        pixel(heights.y, vec2<i32>(along.y, down.y), vec2<u32>(east.y, place.y)),
        pixel(heights.z, vec2<i32>(along.z, down.z), vec2<u32>(east.z, place.y)),
        pixel(heights.w, vec2<i32>(along.w, down.w), vec2<u32>(east.w, place.y)));
}

// Four pixels after one more zone.
fn added(quad: Quad, map_zone: MapZone) -> Quad {
    return Quad(
        with_zone(quad.a, map_zone), with_zone(quad.b, map_zone), with_zone(quad.c, map_zone), with_zone(quad.d, map_zone));
}

fn with_zone(before: Pixel, map_zone: MapZone) -> Pixel {
    var pixel = before;
    var texel = texel_of(map_zone, pixel, 0u);
    for (var plane = 1u; plane < PLANES; plane++) {
        texel += texel_of(map_zone, pixel, plane);
    }
    pixel.blend = zone_blended(pixel.blend, map_zone.zone, pixel.height, pixel.steep, texel);
    return pixel;
}

fn pixel(height: i32, gradient: vec2<i32>, place: vec2<u32>) -> Pixel {
    let normal = slope_normal(gradient, params.run);
    var weights = vec3<f32>(1.0, 0.0, 0.0);
    if PLANES == TRIPLANAR_PLANES {
        weights = triplanar_weights(normal);
    }
    let tiles = vec3<u32>(place.x, tiles_up(height, params.tiles_per_unit), place.y);
    return Pixel(normal, weights, f32(height) / f32(HEIGHT_ONE), steepness(normal), tiles, zone_blend());
}

// The texel of a zone on a plane, by the plane's weight.
fn texel_of(map_zone: MapZone, pixel: Pixel, plane: u32) -> vec4<f32> {
    let tiles = plane_tiles(plane, pixel.tiles);
    let texel = texels[texel_index(map_zone, tiles)];
    let weight = triplanar_weight(pixel.weights, plane) / 65535.0;
    // Drivers may divide each channel where they unpack normalized numbers.
    let channels = vec4<u32>(texel.x & 0xffffu, texel.x >> 16u, texel.y & 0xffffu, texel.y >> 16u);
    return weight * vec4<f32>(vec4<i32>(channels));
}

// The lit colour of a pixel whose zones have all been added: RGBA, 8 bits each.
fn color(pixel: Pixel) -> u32 {
    var albedo = zone_color(pixel.blend, params.additive != 0u);
    if VARIED {
        // 14 bits behind the point fit an f32.
        let tiles = vec2<f32>(pixel.tiles.xz >> vec2<u32>(8u)) / 16384.0;
        albedo = varied(albedo, color_variation(tiles), params.variation);
    }
    return pack4x8unorm(vec4<f32>(srgb(lit(params.light, pixel.normal, albedo)), 1.0));
}

// sRGB's curve within 1/100 of a level of 255. 1.055 x^(1/2.4) − 0.055 is a polynomial in the fourth root of x whose largest error
// from 0.0031308 to 1 is the least, 3.4e-5: software adapters take six times as long for a power.
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let root = sqrt(sqrt(bounded));
    let high = (((0.08132998 * root - 0.33550157) * root + 1.12268163) * root + 0.19613586) * root - 0.06461154;
    return select(high, 12.92 * bounded, bounded <= vec3<f32>(0.0031308));
}
