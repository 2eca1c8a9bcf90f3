// The top-down colour map of patches: the ground's textures by zones (B equations 3.6 and 3.7) and hill-shading, one sRGB pixel
// per sample. The kernel reads windows that extend one sample beyond the patch. A thread makes a column of pixels, four wide, so that
// it reads each zone once for four of them.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{centers, column_of, right_of, row_at};
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::tiles::{MAX_MAP_ZONES, MapZone, PackedZone, plane_tiles, texel_index, tiles_up, unpacked};
import package::wgsl::terrain::zones::{ZoneBlend, steepness, zone_blend, zone_blended, zone_color};
import package::wgsl::terrain::light::{Light, lit};

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
    // 1 where textures lie on the ground from above alone, 3 where they lie on it from the sides too.
    planes: u32,
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
        let along = right_of(here.a, here.b) - here.a;
        let down = centers(below.a, below.b) - centers(above.a, above.b);
        store_four(row, column.width, colors(centers(here.a, here.b), along, down, place));
        row += params.in_width - 2u;
        place.y += params.tiles_per_sample;
        above = here;
        here = below;
    }
}

fn store_four(row: u32, width: u32, colors: vec4<u32>) {
    pixels[row] = colors.x;
    if 1u < width {
        pixels[row + 1u] = colors.y;
    }
    if 2u < width {
        pixels[row + 2u] = colors.z;
    }
    if 3u < width {
        pixels[row + 3u] = colors.w;
    }
}

// The pixels of four samples, given their heights, the differences along x and y, and the place of the first.
fn colors(heights: vec4<i32>, along: vec4<i32>, down: vec4<i32>, place: vec2<u32>) -> vec4<u32> {
    let step = vec2<u32>(params.tiles_per_sample, 0u);
    var a = pixel(heights.x, vec2<i32>(along.x, down.x), place);
    var b = pixel(heights.y, vec2<i32>(along.y, down.y), place + step);
    var c = pixel(heights.z, vec2<i32>(along.z, down.z), place + 2u * step);
    var d = pixel(heights.w, vec2<i32>(along.w, down.w), place + 3u * step);
    for (var z = 0u; z < params.zone_count; z++) {
        let here = unpacked(zones[z]);
        var texel_a = vec4<f32>(0.0);
        var texel_b = vec4<f32>(0.0);
        var texel_c = vec4<f32>(0.0);
        var texel_d = vec4<f32>(0.0);
        for (var plane = 0u; plane < params.planes; plane++) {
            texel_a += texel_of(here, a, plane);
            texel_b += texel_of(here, b, plane);
            texel_c += texel_of(here, c, plane);
            texel_d += texel_of(here, d, plane);
        }
        a.blend = zone_blended(a.blend, here.zone, a.height, a.steep, texel_a);
        b.blend = zone_blended(b.blend, here.zone, b.height, b.steep, texel_b);
        c.blend = zone_blended(c.blend, here.zone, c.height, c.steep, texel_c);
        d.blend = zone_blended(d.blend, here.zone, d.height, d.steep, texel_d);
    }
    return vec4<u32>(color(a), color(b), color(c), color(d));
}

fn pixel(height: i32, gradient: vec2<i32>, place: vec2<u32>) -> Pixel {
    let normal = slope_normal(gradient, params.run);
    let weights = select(vec3<f32>(1.0, 0.0, 0.0), triplanar_weights(normal), params.planes == TRIPLANAR_PLANES);
    let tiles = vec3<u32>(place.x, tiles_up(height, params.tiles_per_unit), place.y);
    return Pixel(normal, weights, f32(height) / f32(HEIGHT_ONE), steepness(normal), tiles, zone_blend());
}

// The texel of a zone on a plane, by the plane's weight.
fn texel_of(map_zone: MapZone, pixel: Pixel, plane: u32) -> vec4<f32> {
    let tiles = plane_tiles(plane, pixel.tiles);
    let texel = texels[texel_index(map_zone, tiles)];
    let weight = triplanar_weight(pixel.weights, plane);
    return weight * vec4<f32>(unpack2x16unorm(texel.x), unpack2x16unorm(texel.y));
}

// The lit colour of a pixel whose zones have all been added: RGBA, 8 bits each.
fn color(pixel: Pixel) -> u32 {
    var albedo = zone_color(pixel.blend, params.additive != 0u);
    if params.variation != 0.0 {
        // 14 bits behind the point fit an f32.
        let tiles = vec2<f32>(pixel.tiles.xz >> vec2<u32>(8u)) / 16384.0;
        albedo = varied(albedo, color_variation(tiles), params.variation);
    }
    return pack4x8unorm(vec4<f32>(srgb(lit(params.light, pixel.normal, albedo)), 1.0));
}

fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let low = 12.92 * bounded;
    let high = 1.055 * pow(bounded, vec3<f32>(1.0 / 2.4)) - vec3<f32>(0.055);
    return select(high, low, bounded <= vec3<f32>(0.0031308));
}
