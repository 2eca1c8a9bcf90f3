//! B's transition area: the CPU reference of `kernels/terrain/border.wgsl`.

/// Moves samples of `patch` (rows of `size`) towards the existing patches to the left, to the right, above and below it. Only
/// samples within `width` of the shared border move.
pub fn border(patch: &mut [i32], size: usize, width: u32, neighbours: [Option<&[i32]>; 4]) {
    let last = size - 1;
    for y in 0..size {
        for x in 0..size {
            let sample = &mut patch[y * size + x];
            // Per border: the sample's distance from it, and the neighbour's sample at that distance on the other side.
            let sides = [
                (x, y * size + (last - x)),
                (last - x, y * size + (last - x)),
                (y, (last - y) * size + x),
                (last - y, (last - y) * size + x),
            ];
            for ((distance, index), neighbour) in sides.into_iter().zip(neighbours) {
                if let Some(neighbour) = neighbour.filter(|_| (distance as u32) < width) {
                    *sample = towards(*sample, neighbour[index], distance as i32, width as i32);
                }
            }
        }
    }
}

/// Blends linearly from the neighbour's height at distance 0 to the patch's own at distance `width`.
fn towards(ours: i32, theirs: i32, distance: i32, width: i32) -> i32 {
    let difference = ours - theirs;
    let (quotient, remainder) = (difference.div_euclid(width), difference.rem_euclid(width));
    theirs + quotient * distance + (remainder * distance + width / 2) / width
}
