//! Windows around patches: the CPU reference of `kernels/terrain/pad.wgsl`.

/// Window around a patch, with `size` + 2·`apron` samples per row. `around` holds a 3 × 3 block of patches, row by row, each with
/// `size`² samples. The patch in the middle must exist.
pub fn pad(size: usize, apron: usize, around: [Option<&[i32]>; 9]) -> Vec<i32> {
    let width = size + 2 * apron;
    let mut window = Vec::with_capacity(width * width);
    for row in 0..width {
        for column in 0..width {
            window.push(sample(size, around, column as i64 - apron as i64, row as i64 - apron as i64));
        }
    }
    window
}

fn sample(size: usize, around: [Option<&[i32]>; 9], x: i64, y: i64) -> i32 {
    let last = size as i64 - 1;
    let tile = |i: i64| {
        if i < 0 {
            0
        } else if i > last {
            2
        } else {
            1
        }
    };
    let (column, row) = (tile(x), tile(y));
    // Try the tile that contains the sample, then the adjacent tiles in the same column and in the same row, and last the patch
    // itself. If the first tile is missing, clamping takes the nearest sample of the tile that replaces it.
    for (column, row) in [(column, row), (column, 1), (1, row), (1, 1)] {
        if let Some(patch) = around[3 * row + column] {
            let local = |i: i64, tile: usize| (i - last * (tile as i64 - 1)).clamp(0, last) as usize;
            return patch[local(y, row) * size + local(x, column)];
        }
    }
    0
}
