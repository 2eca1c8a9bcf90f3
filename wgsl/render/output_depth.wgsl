// The output `depth`, for depth prepasses and shadow maps. It applies to parts whose fragments write their own depth.

// Whether the colour pass writes the depth of the surface (true) or of the polygon (false).
override OWN_DEPTH: bool = false;
// Whether depth is reversed: 1 at the near plane, and smaller with distance.
override REVERSED: bool = false;

// Depth for a prepass: equal to or slightly behind the depth that the colour pass writes for the same fragment. Two pipelines
// may round differently. With this depth, the fragment still passes the colour pass's depth test, which accepts equal depths.
// `slope` is the largest difference of the polygon's depth between the samples of a pixel.
fn depth_behind(depth: f32, polygon: f32, slope: f32) -> f32 {
    if REVERSED {
        let deepest = select(min(depth, polygon - slope), depth, OWN_DEPTH);
        return max(deepest * 0.99999904632568359375, 0.0);
    }
    let deepest = select(max(depth, polygon + slope), depth, OWN_DEPTH);
    return min(deepest * 1.00000095367431640625, 1.0);
}
