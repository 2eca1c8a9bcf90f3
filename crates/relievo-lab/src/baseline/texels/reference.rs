//! The texel loads of colour maps: the CPU reference of `kernels/baseline/texels.wgsl`.

use relievo::ops::terrain::blend::reference::{texel_indices, tiles_of};
use relievo::ops::terrain::cover::Cover;

/// For each sample of a window but those of the outermost ring, the exclusive or of the words of the texels that its pixel of a
/// colour map blends. `place` is that of the first sample inside ([`Cover::place`]).
pub fn texels(window: &[i32], width: usize, cover: &Cover, place: [u32; 2]) -> Vec<u32> {
    let packed = cover.packed_texels();
    let inside = (1..width - 1).flat_map(|y| (1..width - 1).map(move |x| [x, y]));
    let word = |[x, y]: [usize; 2]| {
        let tiles = tiles_of(cover, place, [x - 1, y - 1], window[y * width + x]);
        let indices = cover.zones.iter().flat_map(|zone| texel_indices(cover, zone, tiles));
        indices.fold(0, |word, index| word ^ packed[index][0] ^ packed[index][1])
    };
    inside.map(word).collect()
}
