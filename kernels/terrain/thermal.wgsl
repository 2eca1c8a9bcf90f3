// One iteration of thermal erosion: between each pair of 4-neighbours, an eighth of the difference beyond the
// stable one slides downhill. All pairs read the same old field. Each window loses its outermost ring of
// samples.
import package::wgsl::terrain::windows::{inner_index, is_inner, sample_index, windows};

struct ThermalParams {
    // Samples along an edge of a window.
    width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: ThermalParams;
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

// The height that a sample receives from a neighbour that is `difference` higher: an eighth of what exceeds the threshold,
// rounded towards zero.
fn slide(difference: i32) -> i32 {
    let excess = max(abs(difference) - params.threshold, 0) >> 3u;
    return select(excess, -excess, difference < 0);
}
