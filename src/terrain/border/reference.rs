//! Transitions between patches (thesis B's transition area): the CPU reference of `kernels/terrain/border.wgsl`.

/// Moves samples of `patch` towards the heights of existing neighbours. `patch` has `size` samples per row. `neighbours` holds
/// the patches to the left, to the right, above and below. Only samples closer than `width` to a shared border move.
pub fn border(patch: &mut [i32], size: usize, width: u32, neighbours: [Option<&[i32]>; 4]) {
    let last = size - 1;
    for y in 0..size {
        for x in 0..size {
            let sample = &mut patch[y * size + x];
            // Per border: the sample's distance from the border, and the index of the sample's mirror image in the neighbour.
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

/// Linear blend: the neighbour's height `theirs` at distance 0, the patch's own height `ours` at distance `width`.
fn towards(ours: i32, theirs: i32, distance: i32, width: i32) -> i32 {
    let difference = ours - theirs;
    let (quotient, remainder) = (difference.div_euclid(width), difference.rem_euclid(width));
    theirs + quotient * distance + (remainder * distance + width / 2) / width
}
