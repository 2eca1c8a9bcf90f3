// relievo terrain/blend: generated from kernels/terrain/blend.wgsl

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}

const HEIGHT_ONE: i32 = 65536;

const HEIGHT_LIMIT: i32 = 1073741823;

fn mean_of_four(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    let first = a + b;
    let second = c + d;
    let carry = (first & second & vec4<i32>(1)) + vec4<i32>(1);
    return ((first >> one) + (second >> one) + carry) >> one;
}

fn multiply_high(a: vec4<u32>, b: u32) -> vec4<u32> {
    let low = vec4<u32>(65535u);
    let half = vec4<u32>(16u);
    let a_low = a & low;
    let a_high = a >> half;
    let b_low = b & 65535u;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> half);
    let carry = a_low * b_high + (middle & low);
    return a_high * b_high + (middle >> half) + (carry >> half);
}

fn four_point(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let four = vec4<u32>(4u);
    let low = vec4<i32>(15);
    let whole = 9 * ((b >> four) + (c >> four)) - ((a >> four) + (d >> four));
    return whole + ((9 * ((b & low) + (c & low)) - ((a & low) + (d & low)) + 8) >> four);
}

fn mean_of_two(a: vec4<i32>, b: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    return (a >> one) + (b >> one) + (((a & vec4<i32>(1)) + (b & vec4<i32>(1)) + 1) >> one);
}

fn limited(heights: vec4<i32>) -> vec4<i32> {
    return max(min(heights, vec4<i32>(HEIGHT_LIMIT)), vec4<i32>(-HEIGHT_LIMIT));
}

struct Light {
    direction: vec3<f32>,
    ambient: f32
}

fn lit(light: Light, normal: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    return lambert(albedo, light.ambient, max(0.0, dot(normal, light.direction)));
}

fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return gradient_normal(vec2<f32>(gradient), run);
}

fn gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}

const TILES_PERIOD: u32 = 1024u;

const TRIPLANAR_PLANES: u32 = 3u;

fn triplanar_weights(normal: vec3<f32>) -> vec3<f32> {
    let facing = max(abs(normal.yxz) - 0.3, vec3<f32>(0.0));
    let squared = facing * facing;
    return squared / (squared.x + squared.y + squared.z);
}

fn triplanar_uv(plane: u32, tiles: vec3<f32>) -> vec2<f32> {
    let wall = vec2<f32>(select(tiles.x, tiles.z, plane == 1u), -tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

fn triplanar_weight(weights: vec3<f32>, plane: u32) -> f32 {
    return select(select(weights.z, weights.y, plane == 1u), weights.x, plane == 0u);
}

fn cell_words(x: vec4<u32>, y: vec4<u32>) -> vec4<u32> {
    var words = x * 2654435761u + y * 2246822519u;
    words = (words ^ (words >> vec4<u32>(16u))) * 2146121005u;
    words = (words ^ (words >> vec4<u32>(15u))) * 2221713035u;
    return words ^ (words >> vec4<u32>(16u));
}

fn cell_mean(corners: vec4<f32>, at: vec2<f32>) -> f32 {
    let rows = corners.xy + (corners.zw - corners.xy) * at.y;
    return rows.x + (rows.y - rows.x) * at.x;
}

fn color_variation(tiles: vec2<f32>) -> vec2<f32> {
    var sum = vec2<f32>(0.0);
    var scale = 0.5;
    for (var octave = 0u; octave < 3u; octave++) {
        let cells = tiles * scale;
        let cell = floor(cells);
        let inside = cells - cell;
        let at = inside * inside * (3.0 - 2.0 * inside);
        let mask = ((TILES_PERIOD / 2u) >> (2u * octave)) - 1u;
        let corner = vec2<u32>(vec2<i32>(cell));
        let x = vec4<u32>(corner.x, corner.x + 1u, corner.x, corner.x + 1u) & vec4<u32>(mask);
        let y = vec4<u32>(corner.y, corner.y, corner.y + 1u, corner.y + 1u) & vec4<u32>(mask);
        let words = cell_words(x + vec4<u32>(octave * 4096u), y);
        let brightness = cell_mean(vec4<f32>(words >> vec4<u32>(16u)), at);
        let warmth = cell_mean(vec4<f32>(words & vec4<u32>(65535u)), at);
        sum += vec2<f32>(brightness, warmth);
        scale *= 0.25;
    }
    return sum * (2.0 / 196605.0) - 1.0;
}

fn varied(color: vec3<f32>, variation: vec2<f32>, strength: f32) -> vec3<f32> {
    let tint = vec3<f32>(0.2, 0.05, -0.25) * variation.y;
    return color * (vec3<f32>(1.0) + strength * (vec3<f32>(0.5 * variation.x) + tint));
}

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

struct MapParams {
    light: Light,
    width: u32,
    run: f32,
    zone_count: u32,
    additive: u32,
    planes: u32,
    tiles_per_sample: u32,
    tiles_per_unit: u32,
    variation: f32
}

@group(0) @binding(0)
var<uniform> params: MapParams;

@group(0) @binding(2)
var<storage, read> zones: array<MapZone>;

@group(0) @binding(3)
var<storage, read> texels: array<vec2<u32>>;

@group(0) @binding(4)
var<storage, read> places: array<vec2<u32>>;

@group(0) @binding(5)
var<storage, read_write> pixels: array<u32>;

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
    let variation = color_variation(vec2<f32>(tiles.xz >> vec2<u32>(8u)) / 16384.0);
    let albedo = varied(zone_color(blend, params.additive != 0u), variation, params.variation);
    pixels[inner_index(params.width, id)] = pack4x8unorm(vec4<f32>(srgb(lit(params.light, normal, albedo)), 1.0));
}

fn texel_at(index: u32) -> vec4<f32> {
    let texel = texels[index];
    return vec4<f32>(unpack2x16unorm(texel.x), unpack2x16unorm(texel.y));
}

fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let bounded = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    let root = sqrt(sqrt(bounded));
    let high = (((0.08132998 * root - 0.33550157) * root + 1.12268163) * root + 0.19613586) * root - 0.06461154;
    return select(high, 12.92 * bounded, bounded <= vec3<f32>(0.0031308));
}
