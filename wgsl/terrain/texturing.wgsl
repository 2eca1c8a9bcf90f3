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
