// Screen-door transparency: a pattern of opaque pixels.

// Alpha threshold of a pixel, between 0 and 1: pixels with a lower alpha are discarded. The threshold is the rank of the
// pixel's position `place` in a 4 × 4 ordered-dither matrix (Bayer 1973).
fn surface_dither_threshold(place: vec2<u32>) -> f32 {
    let fine = place & vec2<u32>(1u);
    let coarse = (place >> vec2<u32>(1u)) & vec2<u32>(1u);
    let rank = 8u * (fine.x ^ fine.y) + 4u * fine.y + 2u * (coarse.x ^ coarse.y) + coarse.y;
    return (f32(rank) + 0.5) / 16.0;
}
