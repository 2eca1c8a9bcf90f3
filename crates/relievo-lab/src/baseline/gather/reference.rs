//! Moves the bytes that sampling moves: the CPU reference of `kernels/baseline/gather.wgsl`.

use relievo::asset::keyframe::KeyframeCursor;
use relievo::ops::animation::clip_set::ClipSet;
use relievo::ops::animation::instance::Instance;

/// For each instance and bone of its clip, writes the exclusive or of the two keys around the instance's cursor
/// on three tracks, as the bits of a local transform; the other words of the track table and of the cursor are
/// combined into it too.
///
/// # Panics
/// If there are fewer values than the tracks have, and for a cursor at the last key.
pub fn gather(
    set: &ClipSet,
    instances: &[Instance],
    cursors: &[KeyframeCursor],
    gathered: &mut [[[u32; 4]; 3]],
) {
    let bones = set.bones();
    for ((instance, cursor), gathered) in instances.iter().zip(cursors).zip(gathered.chunks_mut(bones)) {
        let tracks = &set.tracks()[3 * bones * instance.clip as usize..];
        for (tracks, gathered) in tracks.chunks_exact(3).zip(gathered) {
            let [moved, turned, scaled] =
                [0, 1, 2].map(|part| both_keys(set, tracks[part].first_value, *cursor));
            let unused =
                tracks.iter().fold(cursor.fraction.to_bits(), |bits, track| bits ^ track.packed().words[0]);
            *gathered =
                [[moved[0], moved[1], moved[2], scaled[0]], turned, [scaled[1], scaled[2], unused, 0]];
        }
    }
}

/// As [`gather`], for the keys alone of a clip whose tracks have `keys` values each, one after another.
///
/// # Panics
/// As [`gather`].
pub fn gather_keys(set: &ClipSet, keys: u32, cursors: &[KeyframeCursor], gathered: &mut [[[u32; 4]; 3]]) {
    for (cursor, gathered) in cursors.iter().zip(gathered.chunks_mut(set.bones())) {
        for (bone, gathered) in (0..).zip(gathered) {
            let [moved, turned, scaled] =
                [0, 1, 2].map(|part| both_keys(set, (3 * bone + part) * keys, *cursor));
            *gathered = [[moved[0], moved[1], moved[2], scaled[0]], turned, [scaled[1], scaled[2], 0, 0]];
        }
    }
}

fn both_keys(set: &ClipSet, first: u32, cursor: KeyframeCursor) -> [u32; 4] {
    let at = (first + cursor.key) as usize;
    let [before, after] = [set.values()[at], set.values()[at + 1]].map(|key| key.map(f32::to_bits));
    std::array::from_fn(|i| before[i] ^ after[i])
}
