// The output `depth`, for prepasses and shadow maps, of parts that write their own depth.

// Whether pictures in colour have the depth of the surface and not that of the polygon.
override OWN_DEPTH: bool = false;
// Whether depth falls with distance, from 1 at the near plane.
override REVERSED: bool = false;

// A depth that is never in front of the one that the same fragment has in colour, so that colour passes a test for less or
// equal behind a prepass: two pipelines may round differently, and the polygon's depth varies between the samples of a pixel,
// by at most `slope`.
fn depth_behind(depth: f32, polygon: f32, slope: f32) -> f32 {
    if REVERSED {
        let deepest = select(min(depth, polygon - slope), depth, OWN_DEPTH);
        return max(deepest * 0.99999904632568359375, 0.0);
    }
    let deepest = select(max(depth, polygon + slope), depth, OWN_DEPTH);
    return min(deepest * 1.00000095367431640625, 1.0);
}
