//! Moves the bytes of sampling: twin of `kernels/baseline/gather.wgsl`.

use crate::animation::place::Place;

/// For each place and bone, the exclusive or of the two keys around the place of three tracks of `keys` values each,
/// as bits of a local transform.
///
/// # Panics
/// With fewer values than tracks have, and at a place of the last key.
pub fn gather(
    [bones, keys]: [usize; 2],
    places: &[Place],
    values: &[[u32; 4]],
    gathered: &mut [[[u32; 4]; 3]],
) {
    for (place, gathered) in places.iter().zip(gathered.chunks_mut(bones)) {
        for (tracks, gathered) in values.chunks_exact(3 * keys).zip(gathered) {
            let at = place.key as usize;
            let [moved, turned, scaled] = [0, keys, 2 * keys].map(|track| {
                let [before, after] = [tracks[track + at], tracks[track + at + 1]];
                std::array::from_fn::<_, 4, _>(|i| before[i] ^ after[i])
            });
            *gathered = [[moved[0], moved[1], moved[2], scaled[0]], turned, [scaled[1], scaled[2], 0, 0]];
        }
    }
}
