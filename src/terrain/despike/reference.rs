//! Removal of spikes: the CPU reference of `kernels/terrain/despike.wgsl`.

use crate::terrain::fixed::mean_of_four;

/// Despikes a window with `width` samples per row. The result lacks the outermost ring of samples. `injected(x, y)` tells whether
/// a sample of the window is an injected point.
pub fn despike(
    window: &[i32],
    width: usize,
    threshold: i32,
    injected: impl Fn(usize, usize) -> bool,
) -> Vec<i32> {
    let at = |x: usize, y: usize| window[y * width + x];
    let mut field = Vec::with_capacity((width - 2) * (width - 2));
    for y in 1..width - 1 {
        for x in 1..width - 1 {
            let height = at(x, y);
            let mean = mean_of_four(at(x - 1, y), at(x + 1, y), at(x, y - 1), at(x, y + 1));
            let spike = (height - mean).abs() > threshold && !injected(x, y);
            field.push(if spike { mean } else { height });
        }
    }
    field
}
