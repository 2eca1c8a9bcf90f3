//! B's transition area: reference of `kernels/terrain/border.wgsl`.

/// Moves the samples of `patch` (rows of `size`) within `width` of a border towards the existing patches
/// left, right, above and below it.
pub fn border(patch: &mut [i32], size: usize, width: u32, neighbours: [Option<&[i32]>; 4]) {
    let last = size - 1;
    for y in 0..size {
        for x in 0..size {
            let sample = &mut patch[y * size + x];
            // Each border: our distance from it, and the neighbour's sample at that distance on its side.
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

/// The neighbour's height at distance 0, ours at distance `width`.
fn towards(ours: i32, theirs: i32, distance: i32, width: i32) -> i32 {
    let difference = ours - theirs;
    let (quotient, remainder) = (difference.div_euclid(width), difference.rem_euclid(width));
    theirs + quotient * distance + (remainder * distance + width / 2) / width
}
