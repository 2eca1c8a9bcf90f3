// One iteration of thermal erosion: between each pair of 4-neighbours, an eighth of the difference beyond the
// stable one slides downhill. All pairs read the same old field. Each window loses its outermost ring of
// samples.
import package::wgsl::terrain::points::Thread;
import package::wgsl::terrain::windows::{inner_point, sample_index, windows};

struct ThermalParams {
    // Windows, and samples along an edge of each.
    count: u32,
    width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: ThermalParams;
@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let point = inner_point(params.width, params.count, thread);
    if !point.there {
        return;
    }
    let at = sample_index(params.width, point);
    let height = windows[at];
    outputs[point.index] = height + slide(windows[at - 1u] - height) + slide(windows[at + 1u] - height)
        + slide(windows[at - params.width] - height) + slide(windows[at + params.width] - height);
}

// The height that a sample receives from a neighbour that is `difference` higher: an eighth of what exceeds the threshold,
// rounded towards zero.
fn slide(difference: i32) -> i32 {
    let excess = max(abs(difference) - params.threshold, 0) >> 3u;
    return select(excess, -excess, difference < 0);
}
