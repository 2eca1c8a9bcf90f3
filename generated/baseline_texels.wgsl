// relievo baseline/texels: generated from kernels/baseline/texels.wgsl

struct MapZone {
    zone: Zone,
    first: u32,
    edge_log2: u32
}

const TILE_BITS: u32 = 22u;

fn tiles_up(height: i32, tiles_per_unit: u32) -> u32 {
    let part = u32(height) & 65535u;
    let low = part * (tiles_per_unit & 65535u);
    return u32(height >> 16u) * tiles_per_unit + part * (tiles_per_unit >> 16u) + (low >> 16u);
}

fn plane_tiles(plane: u32, tiles: vec3<u32>) -> vec2<u32> {
    let wall = vec2<u32>(select(tiles.x, tiles.z, plane == 1u), 0u - tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

fn texel_index(map_zone: MapZone, tiles: vec2<u32>) -> u32 {
    let edge_log2 = map_zone.edge_log2;
    let mask = vec2<u32>((1u << edge_log2) - 1u);
    let at = ((tiles * u32(map_zone.zone.repeats)) >> vec2<u32>(TILE_BITS - edge_log2)) & mask;
    return map_zone.first + (at.y << edge_log2) + at.x;
}

@group(0) @binding(1)
var<storage, read> windows: array<i32>;

fn is_inner(width: u32, id: vec3<u32>) -> bool {
    return all(id.xy < vec2<u32>(width - 2u));
}

fn inner_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * (width - 2u) + id.y) * (width - 2u) + id.x;
}

fn sample_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * width + id.y + 1u) * width + id.x + 1u;
}

fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}

struct Zone {
    min: f32,
    max: f32,
    rise: vec2<f32>,
    fall: vec2<f32>,
    height_blend: f32,
    repeats: f32
}

struct ZoneBlend {
    color: vec3<f32>,
    total: f32,
    weight: f32,
    nearest: vec3<f32>,
    distance: f32
}

fn zone_of_heights(min: f32, max: f32) -> Zone {
    return Zone(min, max, vec2<f32>(0.0, 1.0), vec2<f32>(0.0, 1.0), 0.0, 1.0);
}

fn steepness(normal: vec3<f32>) -> f32 {
    return sqrt(normal.x * normal.x + normal.z * normal.z) / (1.0 + normal.y);
}

fn zone_weight(zone: Zone, height: f32, steep: f32) -> f32 {
    let range = zone.max - zone.min;
    let rise = clamp(zone.rise.x * steep + zone.rise.y, 0.0, 1.0);
    let fall = clamp(zone.fall.x * steep + zone.fall.y, 0.0, 1.0);
    return max(0.0, (range - abs(height - zone.max)) * (1.0 / range)) * (rise * fall);
}

fn zone_prominence(zone: Zone, texel_height: f32) -> f32 {
    let depth = 0.9375 * zone.height_blend;
    let reduced = (1.0 - depth) + depth * texel_height;
    let squared = reduced * reduced;
    return squared * squared;
}

fn zone_blend() -> ZoneBlend {
    return ZoneBlend(vec3<f32>(0.0), 0.0, 0.0, vec3<f32>(0.0), 3e38);
}

fn zone_blended(blend: ZoneBlend, zone: Zone, height: f32, steep: f32, texel: vec4<f32>) -> ZoneBlend {
    let distance = abs(height - zone.max) - (zone.max - zone.min);
    let nearer = distance < blend.distance;
    let weight = zone_weight(zone, height, steep);
    let factor = weight * zone_prominence(zone, texel.w);
    return ZoneBlend(blend.color + factor * texel.rgb, blend.total + factor, blend.weight + weight, select(blend.nearest, texel.rgb, nearer), select(blend.distance, distance, nearer));
}

fn zone_color(blend: ZoneBlend, additive: bool) -> vec3<f32> {
    let mean = blend.color / max(blend.total, 1.17549435e-38);
    if additive {
        return blend.weight * mean;
    }
    return select(blend.nearest, mean, blend.total > 0.0);
}

struct TexelsParams {
    width: u32,
    zone_count: u32,
    planes: u32,
    tiles_per_sample: u32,
    tiles_per_unit: u32
}

@group(0) @binding(0)
var<uniform> params: TexelsParams;

@group(0) @binding(2)
var<storage, read> zones: array<MapZone>;

@group(0) @binding(3)
var<storage, read> texels: array<vec2<u32>>;

@group(0) @binding(4)
var<storage, read> places: array<vec2<u32>>;

@group(0) @binding(5)
var<storage, read_write> words: array<u32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let height = windows[sample_index(params.width, id)];
    let place = places[id.z] + id.xy * params.tiles_per_sample;
    let tiles = vec3<u32>(place.x, tiles_up(height, params.tiles_per_unit), place.y);
    var word = 0u;
    for (var z = 0u; z < params.zone_count; z++) {
        let map_zone = zones[z];
        for (var plane = 0u; plane < params.planes; plane++) {
            let texel = texels[texel_index(map_zone, plane_tiles(plane, tiles))];
            word ^= texel.x ^ texel.y;
        }
    }
    words[inner_index(params.width, id)] = word;
}
