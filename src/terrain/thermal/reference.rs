//! Thermal erosion: the CPU reference of `kernels/terrain/thermal.wgsl`.

/// Applies one iteration to a window with `width` samples per row. The result lacks the outermost ring of samples. `threshold` is
/// the largest stable difference between neighbours, in 1/65536 height units.
pub fn thermal(window: &[i32], width: usize, threshold: i32) -> Vec<i32> {
    let mut field = Vec::with_capacity((width - 2) * (width - 2));
    for y in 1..width - 1 {
        let row = |y: usize| &window[y * width..][..width];
        let (above, here, below) = (row(y - 1), row(y), row(y + 1));
        for x in 1..width - 1 {
            let height = here[x];
            field.push(
                height
                    + slide(here[x - 1] - height, threshold)
                    + slide(here[x + 1] - height, threshold)
                    + slide(above[x] - height, threshold)
                    + slide(below[x] - height, threshold),
            );
        }
    }
    field
}

/// Amount of material that a sample receives from a neighbour which is higher by `difference`; negative if the neighbour is
/// lower.
#[inline(always)]
fn slide(difference: i32, threshold: i32) -> i32 {
    let excess = (difference.abs() - threshold).max(0) >> 3;
    if difference < 0 { -excess } else { excess }
}
