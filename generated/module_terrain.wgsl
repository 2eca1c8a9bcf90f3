// From relievo's wgsl/terrain/module.wgsl.
// Terrain: zones of ground and their textures for materials (`zone_blend`, `triplanar_weights`, `color_variation`), normals,
// light, and exact integer arithmetic of heights. `build.rs` joins this file and its imports into one text, for shaders that
// are not composed with WESL. Prepend that text to your own code.

// From relievo's wgsl/terrain/zones.wgsl.
// Zones of ground by height and steepness (thesis B section 3.3.1, equation 3.6). The height maps of their textures blend the
// zones (height blending, thesis B section 2.3.4). Any material shader may import these functions.
//
//     var blend = zone_blend();
//     for (var z = 0u; z < count; z++) { blend = zone_blended(blend, zones[z], height, steepness(normal), texel_of(z)); }
//     let albedo = zone_color(blend, additive);

// A kind of ground: the heights and slopes where it lies, and how its texture is blended with other textures.
struct Zone {
    // Lower end of the zone's range of heights, in height units.
    min: f32,
    // Upper end of the zone's range of heights, in height units. The weight is greatest there.
    max: f32,
    // Weight that grows with steepness: rise.x * steepness + rise.y, clamped to 0 to 1. The pair (0, 1) gives weight 1 on all
    // slopes.
    rise: vec2<f32>,
    // Weight that falls with steepness: fall.x * steepness + fall.y, clamped to 0 to 1. It is multiplied by the weight of
    // `rise`.
    fall: vec2<f32>,
    // Influence of the texture's height map where zones meet, 0 to 1.
    height_blend: f32,
    // Number of times that the texture repeats in a texture tile: a whole number, 1 to 16.
    repeats: f32,
}

// State of the blend, accumulated over all zones.
struct ZoneBlend {
    // Sum of the zones' colours, each weighted by its zone's weight and height map.
    color: vec3<f32>,
    // Sum of the factors with which zones are weighted in `color`.
    total: f32,
    // Sum of the zones' weights, without the influence of height maps.
    weight: f32,
    // Linear colour of the zone whose range of heights is nearest.
    nearest: vec3<f32>,
    // Distance to the nearest zone's range of heights, in height units; negative inside the range.
    distance: f32,
}

// A zone that covers slopes of all kinds and ignores its texture's height map.
fn zone_of_heights(min: f32, max: f32) -> Zone {
    return Zone(min, max, vec2<f32>(0.0, 1.0), vec2<f32>(0.0, 1.0), 0.0, 1.0);
}

// Steepness of a unit normal: the tangent of half its angle to the vertical, y. It is 0 on level ground and 1 on a wall.
fn steepness(normal: vec3<f32>) -> f32 {
    return sqrt(normal.x * normal.x + normal.z * normal.z) / (1.0 + normal.y);
}

// Weight of a zone, 0 to 1, at a height in height units and a steepness. It is the product of a weight by height and the two
// weights by steepness. The weight by height is 1 at `max`. It is 0 where the height differs from `max` by `max` − `min` or
// more (thesis B equation 3.6).
fn zone_weight(zone: Zone, height: f32, steep: f32) -> f32 {
    let range = zone.max - zone.min;
    let rise = clamp(zone.rise.x * steep + zone.rise.y, 0.0, 1.0);
    let fall = clamp(zone.fall.x * steep + zone.fall.y, 0.0, 1.0);
    return max(0.0, (range - abs(height - zone.max)) * (1.0 / range)) * (rise * fall);
}

// Factor, 0 to 1, by which a texel's height reduces the weight of its zone: where zones meet, high texels show first. Without
// height blending, the factor is 1. With height blending, the factor falls to 16^-4 in the deepest texels.
fn zone_prominence(zone: Zone, texel_height: f32) -> f32 {
    let depth = 0.9375 * zone.height_blend;
    let reduced = (1.0 - depth) + depth * texel_height;
    let squared = reduced * reduced;
    return squared * squared;
}

// State of the blend before the first zone.
fn zone_blend() -> ZoneBlend {
    return ZoneBlend(vec3<f32>(0.0), 0.0, 0.0, vec3<f32>(0.0), 3.0e38);
}

// Adds one zone to the blend. `texel` is the linear colour of the zone's texture (rgb) and the texture's height, 0 to 1 (w).
fn zone_blended(blend: ZoneBlend, zone: Zone, height: f32, steep: f32, texel: vec4<f32>) -> ZoneBlend {
    let distance = abs(height - zone.max) - (zone.max - zone.min);
    let nearer = distance < blend.distance;
    let weight = zone_weight(zone, height, steep);
    let factor = weight * zone_prominence(zone, texel.w);
    return ZoneBlend(
        blend.color + factor * texel.rgb,
        blend.total + factor,
        blend.weight + weight,
        select(blend.nearest, texel.rgb, nearer),
        select(blend.distance, distance, nearer));
}

// The blended linear colour. If `additive` is false, the zones' fractions sum to 1; where all weights are 0, the nearest zone
// has fraction 1. If `additive` is true, the fractions sum to the sum of the zones' weights.
fn zone_color(blend: ZoneBlend, additive: bool) -> vec3<f32> {
    // Where no zone has a weight, the colour is 0. Divided by the smallest normal number, it stays 0.
    let mean = blend.color / max(blend.total, 1.17549435e-38);
    if additive {
        return blend.weight * mean;
    }
    return select(blend.nearest, mean, blend.total > 0.0);
}

// From relievo's wgsl/terrain/texturing.wgsl.
// Texture mapping of the ground, for any material shader: from above, and on steep ground also from the sides (triplanar
// mapping). A colour variation over many tiles hides their repetition.

// Period of texture coordinates in tiles. The host subtracts whole multiples of this period.
const TILES_PERIOD: u32 = 1024u;
// Number of projection planes of triplanar mapping.
const TRIPLANAR_PLANES: u32 = 3u;

// Weights of the three projection planes for a unit normal: from above (x), from the east or west (y), from the north or south
// (z). The weights sum to 1. Ground with a slope of up to 17 degrees is textured only from above.
fn triplanar_weights(normal: vec3<f32>) -> vec3<f32> {
    let facing = max(abs(normal.yxz) - 0.3, vec3<f32>(0.0));
    let squared = facing * facing;
    return squared / (squared.x + squared.y + squared.z);
}

// Texture coordinates on a projection plane, 0 to 2 in the order of the weights. `tiles` is a position in tiles: east, up,
// south. On walls, the top of the texture is up. The function is linear, so it also converts derivatives.
fn triplanar_uv(plane: u32, tiles: vec3<f32>) -> vec2<f32> {
    let wall = vec2<f32>(select(tiles.x, tiles.z, plane == 1u), -tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

// Weight of a projection plane, 0 to 2, from `triplanar_weights`.
fn triplanar_weight(weights: vec3<f32>, plane: u32) -> f32 {
    return select(select(weights.z, weights.y, plane == 1u), weights.x, plane == 0u);
}

// Random words of four cells of a lattice, by the finalizer `lowbias32` (Wellons 2018, docs/sources.md).
fn cell_words(x: vec4<u32>, y: vec4<u32>) -> vec4<u32> {
    var words = x * 0x9e3779b1u + y * 0x85ebca77u;
    words = (words ^ (words >> vec4<u32>(16u))) * 0x7feb352du;
    words = (words ^ (words >> vec4<u32>(15u))) * 0x846ca68bu;
    return words ^ (words >> vec4<u32>(16u));
}

// Bilinear mean of the values at a cell's corners: north-west, north-east, south-west, south-east. `at` is the position in the
// cell, 0 to 1.
fn cell_mean(corners: vec4<f32>, at: vec2<f32>) -> f32 {
    let rows = corners.xy + (corners.zw - corners.xy) * at.y;
    return rows.x + (rows.y - rows.x) * at.x;
}

// Noise at texture coordinates, seen from above: brightness (x) and warmth (y), each −1 to 1. The noise has cells of 2, 8 and
// 32 tiles. The cells have integer coordinates, so they are the same on every device.
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
        let warmth = cell_mean(vec4<f32>(words & vec4<u32>(0xffffu)), at);
        sum += vec2<f32>(brightness, warmth);
        scale *= 0.25;
    }
    return sum * (2.0 / 196605.0) - 1.0;
}

// Linear colour with a variation of `strength`, 0 to 1: brighter or darker by up to half, and warmer or colder.
fn varied(color: vec3<f32>, variation: vec2<f32>, strength: f32) -> vec3<f32> {
    let tint = vec3<f32>(0.2, 0.05, -0.25) * variation.y;
    return color * (vec3<f32>(1.0) + strength * (vec3<f32>(0.5 * variation.x) + tint));
}

// From relievo's wgsl/terrain/tiles.wgsl.
// Texels that a colour map reads. Positions in textures are whole numbers, so that every device reads the same texels.

// A zone of the ground and its texture, for colour maps.
struct MapZone {
    // The zone.
    zone: Zone,
    // Index of the first texel of the zone's texture.
    first: u32,
    // Binary logarithm of the number of texels along an edge of the zone's texture.
    edge_log2: u32,
}

// Number of fractional bits of a position in tiles. The integer part has 10 bits, enough for TILES_PERIOD.
const TILE_BITS: u32 = 22u;

// Converts a height, in 1/65536 units, to a position in 2^-22 tiles, rounded down, modulo TILES_PERIOD. `tiles_per_unit` is the
// number of 2^-22 tiles per world unit of height.
fn tiles_up(height: i32, tiles_per_unit: u32) -> u32 {
    let part = u32(height) & 0xffffu;
    let low = part * (tiles_per_unit & 0xffffu);
    return u32(height >> 16u) * tiles_per_unit + part * (tiles_per_unit >> 16u) + (low >> 16u);
}

// Position on a projection plane, as computed by `triplanar_uv`, but in whole numbers of 2^-22 tiles.
fn plane_tiles(plane: u32, tiles: vec3<u32>) -> vec2<u32> {
    let wall = vec2<u32>(select(tiles.x, tiles.z, plane == 1u), 0u - tiles.y);
    return select(wall, tiles.xz, plane == 0u);
}

// Index of a zone's texel at a position in 2^-22 tiles.
fn texel_index(map_zone: MapZone, tiles: vec2<u32>) -> u32 {
    let edge_log2 = map_zone.edge_log2;
    let mask = vec2<u32>((1u << edge_log2) - 1u);
    let at = ((tiles * u32(map_zone.zone.repeats)) >> vec2<u32>(TILE_BITS - edge_log2)) & mask;
    return map_zone.first + (at.y << edge_log2) + at.x;
}

// From relievo's wgsl/terrain/slope.wgsl.
// Unit normal of a height field, y up. `gradient` has the central differences along x and z: the next sample minus the previous
// one, in 1/65536 units. `run` is twice the distance between samples, in the same units.
fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return gradient_normal(vec2<f32>(gradient), run);
}

// The same for a gradient that is no integer.
fn gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}

// From relievo's wgsl/terrain/light.wgsl.
// A directional light over terrain, in linear light.

// The sun: a light with one direction for all of the terrain.
struct Light {
    // Unit vector towards the light.
    direction: vec3<f32>,
    // Fraction of the light that a surface facing away still receives, 0 to 1.
    ambient: f32,
}

// Linear light that a surface reflects: Lambert's cosine and the ambient part. `albedo` is linear, and `normal` is a unit
// vector.
fn lit(light: Light, normal: vec3<f32>, albedo: vec3<f32>) -> vec3<f32> {
    return lambert(albedo, light.ambient, max(0.0, dot(normal, light.direction)));
}

// From relievo's wgsl/terrain/offset.wgsl.
// Random offset of a height (i32, Q15.16), computed from the random words for the height's world coordinates.

// Distribution of offsets: uniform in ±range.
const OFFSET_SIGNED = 0u;
// Distribution of offsets: uniform in 0 to range.
const OFFSET_POSITIVE = 1u;
// Distribution of offsets: nearly Gaussian in ±range.
const OFFSET_GAUSSIAN = 2u;

// Four random offsets in 1/65536 units. `distribution` is one of the constants above. `range` has the same units and is at most
// 2^30, so that twice the range fits in 32 bits.
fn height_offset(distribution: u32, range: u32, words: Words) -> vec4<i32> {
    if distribution == OFFSET_POSITIVE {
        return vec4<i32>(multiply_high(words.first, range));
    }
    var uniform_word = words.first;
    if distribution == OFFSET_GAUSSIAN {
        uniform_word = sum_of_halves(words);
    }
    return vec4<i32>(multiply_high(uniform_word, 2u * range)) - vec4<i32>(i32(range));
}

// Sum of four 16-bit uniform numbers (nearly Gaussian), scaled to 32 bits and centered on 2^31, per lane.
fn sum_of_halves(words: Words) -> vec4<u32> {
    let low = vec4<u32>(0xffffu);
    let half = vec4<u32>(16u);
    let sum = (words.first & low) + (words.first >> half) + (words.second & low) + (words.second >> half);
    return (sum << vec4<u32>(14u)) + vec4<u32>(0x8000u);
}

// From relievo's wgsl/terrain/fixed.wgsl.
// Exact integer arithmetic of terrain heights (i32, Q15.16). No operation overflows for heights within the bound that the host
// checks, 2^30 - 1. Every device therefore gives the same bits.

// One world unit of height, in 1/65536 units.
const HEIGHT_ONE: i32 = 65536;
// Largest absolute height, in 1/65536 units.
const HEIGHT_LIMIT: i32 = 0x3fffffff;

// Mean of four heights, rounded half up, for four lanes at once. The sum of two heights is 2p + x, and the sum of the other two
// is 2q + y, with x and y in {0, 1}. The mean is then floor((p + q + 1 + (x & y)) / 2). No step overflows for heights of at
// most 2^30 - 1.
fn mean_of_four(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    let first = a + b;
    let second = c + d;
    let carry = (first & second & vec4<i32>(1)) + vec4<i32>(1);
    return ((first >> one) + (second >> one) + carry) >> one;
}

// High 32 bits of the 64-bit product a * b, per lane.
fn multiply_high(a: vec4<u32>, b: u32) -> vec4<u32> {
    let low = vec4<u32>(0xffffu);
    let half = vec4<u32>(16u);
    let a_low = a & low;
    let a_high = a >> half;
    let b_low = b & 0xffffu;
    let b_high = b >> 16u;
    let middle = a_high * b_low + ((a_low * b_low) >> half);
    let carry = a_low * b_high + (middle & low);
    return a_high * b_high + (middle >> half) + (carry >> half);
}

// (9 (b + c) − (a + d)) / 16, rounded half up: the value halfway between b and c on the cubic through four values (Dyn, Levin
// and Gregory 1987). For heights, the result is at most 1.25 · 2^30. No step overflows for values up to this bound, so results
// may be interpolated again.
fn four_point(a: vec4<i32>, b: vec4<i32>, c: vec4<i32>, d: vec4<i32>) -> vec4<i32> {
    let four = vec4<u32>(4u);
    let low = vec4<i32>(15);
    let whole = 9 * ((b >> four) + (c >> four)) - ((a >> four) + (d >> four));
    return whole + ((9 * ((b & low) + (c & low)) - ((a & low) + (d & low)) + 8) >> four);
}

// Mean of two heights, rounded half up, for four lanes at once.
fn mean_of_two(a: vec4<i32>, b: vec4<i32>) -> vec4<i32> {
    let one = vec4<u32>(1u);
    return (a >> one) + (b >> one) + (((a & vec4<i32>(1)) + (b & vec4<i32>(1)) + 1) >> one);
}

// Heights clamped to ±`HEIGHT_LIMIT`.
fn limited(heights: vec4<i32>) -> vec4<i32> {
    return max(min(heights, vec4<i32>(HEIGHT_LIMIT)), vec4<i32>(-HEIGHT_LIMIT));
}

// From relievo's wgsl/hash.wgsl.
// Counter-based random words: Threefry-2x32 with 20 rounds (Salmon et al. 2011, docs/sources.md). The word of any counter can
// be computed on its own, in any order.

// Results of four random draws, one per lane, for the four counters of `threefry2x32`. The lanes are independent. All 64 bits
// of a lane are uniform.
struct Words {
    // First 32 random bits of each draw.
    first: vec4<u32>,
    // Further 32 random bits of each draw.
    second: vec4<u32>,
}

// Rotates each lane by 1 to 31 bits.
fn rotate_left(value: vec4<u32>, bits: u32) -> vec4<u32> {
    return (value << vec4<u32>(bits)) | (value >> vec4<u32>(32u - bits));
}

// One round of the cipher: adds, rotates by `bits` and combines by exclusive or.
fn mix_round(words: Words, bits: u32) -> Words {
    let first = words.first + words.second;
    return Words(first, rotate_left(words.second, bits) ^ first);
}

// Four rounds with the first set of rotations: rounds 1 to 4, 9 to 12 and 17 to 20 of the cipher.
fn even_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 13u), 15u), 26u), 6u);
}

// Four rounds with the second set of rotations: rounds 5 to 8 and 13 to 16 of the cipher.
fn odd_rounds(words: Words) -> Words {
    return mix_round(mix_round(mix_round(mix_round(words, 17u), 29u), 16u), 24u);
}

// Adds two words of the key to the state. The cipher does this between groups of four rounds.
fn inject_key(words: Words, first: u32, second: u32) -> Words {
    return Words(words.first + vec4<u32>(first), words.second + vec4<u32>(second));
}

// Random words for a key and the four counters (x[i], y[i]), which may have any values.
fn threefry2x32(key: vec2<u32>, x: vec4<u32>, y: vec4<u32>) -> Words {
    let parity = 0x1bd11bdau ^ key.x ^ key.y;
    var words = inject_key(Words(x, y), key.x, key.y);
    words = inject_key(even_rounds(words), key.y, parity + 1u);
    words = inject_key(odd_rounds(words), parity, key.x + 2u);
    words = inject_key(even_rounds(words), key.x, key.y + 3u);
    words = inject_key(odd_rounds(words), key.y, parity + 4u);
    return inject_key(even_rounds(words), parity, key.x + 5u);
}

// From relievo's wgsl/light.wgsl.
// Lighting of surfaces, shared by everything that is drawn.

// Linear RGB light that a Lambertian (matte) surface reflects. `albedo` is linear RGB. `direct`, 0 to 1, is the cosine of the
// light's angle of incidence, reduced in shadow. `ambient`, 0 to 1, is the fraction of the light that the surface receives
// where `direct` is 0.
fn lambert(albedo: vec3<f32>, ambient: f32, direct: f32) -> vec3<f32> {
    return albedo * (ambient + (1.0 - ambient) * direct);
}
