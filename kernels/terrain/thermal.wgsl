// One iteration of thermal erosion. Between each pair of 4-neighbours, an eighth of the height difference above the threshold
// slides downhill. All pairs use the heights before the iteration. Each window loses its outermost ring of samples.
import package::wgsl::terrain::windows::{inner_index, is_inner, sample_index, windows};

// Parameters of the kernel `terrain/thermal`.
struct ThermalParams {
    // Number of samples along an edge of a window.
    width: u32,
    // Largest stable height difference between neighbours, in 1/65536 units.
    threshold: i32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: ThermalParams;
// Out: heights of the inner samples of all windows, in 1/65536 units.
@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let at = sample_index(params.width, id);
    let height = windows[at];
    outputs[inner_index(params.width, id)] = height + slide(windows[at - 1u] - height) + slide(windows[at + 1u] - height)
        + slide(windows[at - params.width] - height) + slide(windows[at + params.width] - height);
}

// Height that a sample receives from a neighbour that is higher by `difference`: an eighth of the excess over the threshold,
// rounded towards zero.
fn slide(difference: i32) -> i32 {
    let excess = max(abs(difference) - params.threshold, 0) >> 3u;
    return select(excess, -excess, difference < 0);
}
