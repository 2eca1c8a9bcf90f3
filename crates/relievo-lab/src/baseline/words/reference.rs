//! Random words: the CPU reference of `kernels/baseline/words.wgsl`.

use relievo::ops::hash::{LANES, threefry2x32};

/// The first word of each counter (x, y), in `rows` rows of `width`.
pub fn words(key: [u32; 2], width: u32, rows: u32) -> Vec<u32> {
    let mut all = vec![0; width as usize * rows as usize];
    for (y, row) in all.chunks_exact_mut(width.max(1) as usize).enumerate() {
        for (chunk, words) in row.chunks_mut(LANES).enumerate() {
            let x = std::array::from_fn(|lane| (chunk * LANES + lane) as u32);
            let (first, _) = threefry2x32(key, x, [y as u32; LANES]);
            words.copy_from_slice(&first[..words.len()]);
        }
    }
    all
}
