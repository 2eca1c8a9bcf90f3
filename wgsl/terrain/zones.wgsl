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
