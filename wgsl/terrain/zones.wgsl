// Zones of ground by height and steepness (B section 3.3.1, equation 3.6), blended by the height maps of their textures
// (height blending, B section 2.3.4), to import into any material shader.
//
//     var blend = zone_blend();
//     for (var z = 0u; z < count; z++) { blend = zone_blended(blend, zones[z], height, steepness(normal), texel_of(z)); }
//     let albedo = zone_color(blend, additive);

// Ground of one kind: where it lies, and how its texture is blended with others.
struct Zone {
    // Lower end of the range of heights, in height units.
    min: f32,
    // Upper end of the range of heights, in height units, where the weight is greatest.
    max: f32,
    // The weight grows with steepness: rise.x * steepness + rise.y, clamped to 0 to 1. (0, 1) is all slopes.
    rise: vec2<f32>,
    // The weight falls with steepness, in the same way; the two are multiplied.
    fall: vec2<f32>,
    // How much the height map of the texture counts where zones meet, 0 to 1.
    height_blend: f32,
    // How many times the texture repeats in a texture tile: a whole number, 1 to 16.
    repeats: f32,
}

// State of the blend, accumulated over all zones.
struct ZoneBlend {
    // Sum of the zones' colours, each weighted by its zone's weight and height map.
    color: vec3<f32>,
    // Sum of the weights of `color`.
    total: f32,
    // Sum of the zones' weights alone, without height maps.
    weight: f32,
    // The colour of the zone whose range of heights is nearest, and its distance in height units, which is negative inside the
    // range.
    nearest: vec3<f32>,
    distance: f32,
}

// A zone on slopes of all kinds that ignores its texture's height map.
fn zone_of_heights(min: f32, max: f32) -> Zone {
    return Zone(min, max, vec2<f32>(0.0, 1.0), vec2<f32>(0.0, 1.0), 0.0, 1.0);
}

// The tangent of half the angle between a unit normal and the vertical, y: 0 on level ground, 1 on a wall.
fn steepness(normal: vec3<f32>) -> f32 {
    return sqrt(normal.x * normal.x + normal.z * normal.z) / (1.0 + normal.y);
}

// The zone's weight, 0 to 1: by height 1 at max, 0 at max ± (max − min) and beyond (B equation 3.6), times the weight by
// steepness. `height` is in height units.
fn zone_weight(zone: Zone, height: f32, steep: f32) -> f32 {
    let range = zone.max - zone.min;
    let rise = clamp(zone.rise.x * steep + zone.rise.y, 0.0, 1.0);
    let fall = clamp(zone.fall.x * steep + zone.fall.y, 0.0, 1.0);
    return max(0.0, (range - abs(height - zone.max)) * (1.0 / range)) * (rise * fall);
}

// Factor of a weight by the height of a texel, 0 to 1: high texels show first where zones meet. It is 1 without height
// blending, otherwise down to 16^-4 in the deepest texels.
fn zone_prominence(zone: Zone, texel_height: f32) -> f32 {
    let depth = 0.9375 * zone.height_blend;
    let reduced = (1.0 - depth) + depth * texel_height;
    let squared = reduced * reduced;
    return squared * squared;
}

// The state before the first zone.
fn zone_blend() -> ZoneBlend {
    return ZoneBlend(vec3<f32>(0.0), 0.0, 0.0, vec3<f32>(0.0), 3.0e38);
}

// Adds one zone. `texel` is its linear colour, and in the fourth channel the height of its texture, 0 to 1.
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

// The blended colour. Normalized, the zones' fractions sum to 1, and where all weights are 0, the nearest zone has fraction 1.
// Additive, they sum to the sum of the weights as they are.
fn zone_color(blend: ZoneBlend, additive: bool) -> vec3<f32> {
    // Where nothing has a weight the colour is 0, and so is its quotient by the smallest normal number.
    let mean = blend.color / max(blend.total, 1.17549435e-38);
    if additive {
        return blend.weight * mean;
    }
    return select(blend.nearest, mean, blend.total > 0.0);
}
