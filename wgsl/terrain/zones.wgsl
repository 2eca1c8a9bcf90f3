// Weights of height zones (B section 3.3.1, equation 3.6), to import into any material shader.
//
//     var fold = zone_fold();
//     for (var z = 0u; z < count; z++) { fold = zone_folded(fold, z, zones[z], height); }
//     for (var z = 0u; z < count; z++) { color += zone_share(fold, z, zones[z], height, additive) * … }

// A range of heights with a material of its own.
struct Zone {
    // Lower end of the range, in height units.
    min: f32,
    max: f32,
}

// What the fractions of colour depend on, accumulated over all zones.
struct ZoneFold {
    // The sum of all weights.
    total: f32,
    // The zone whose range is nearest, and its distance in height units, which is negative inside the range.
    nearest: u32,
    distance: f32,
}

// The zone's weight by B equation 3.6, 0 to 1: 1 at max, 0 at max ± (max − min) and beyond. `height` is in
// height units.
fn zone_weight(zone: Zone, height: f32) -> f32 {
    let range = zone.max - zone.min;
    return max(0.0, (range - abs(height - zone.max)) / range);
}

// The state before the first zone.
fn zone_fold() -> ZoneFold {
    return ZoneFold(0.0, 0u, 3.0e38);
}

// Adds one zone; `index` is its number.
fn zone_folded(fold: ZoneFold, index: u32, zone: Zone, height: f32) -> ZoneFold {
    let distance = abs(height - zone.max) - (zone.max - zone.min);
    let nearer = distance < fold.distance;
    return ZoneFold(
        fold.total + zone_weight(zone, height),
        select(fold.nearest, index, nearer),
        select(fold.distance, distance, nearer));
}

// The zone's fraction of the colour, 0 to 1. Normalized fractions sum to 1; where all weights are 0, the
// nearest zone has fraction 1. Additive fractions are the weights as they are.
fn zone_fraction(fold: ZoneFold, index: u32, zone: Zone, height: f32, additive: bool) -> f32 {
    let weight = zone_weight(zone, height);
    if additive {
        return weight;
    }
    if fold.total > 0.0 {
        return weight / fold.total;
    }
    return select(0.0, 1.0, index == fold.nearest);
}
