// Replaces every point that is further than the threshold from the mean of its four neighbours by that mean (B
// figure 5.10). Injected points are left alone. Each window loses its outermost ring of samples.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{QUADS, centers, column_of, right_of, row_at};
import package::wgsl::terrain::outputs::store_four;
import package::wgsl::terrain::fixed::mean_of_sums;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, feature_bits};

struct DespikeParams {
    blocks: Blocks,
    // The index of the injected points of the windows.
    features: FeatureGrid,
    in_width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: DespikeParams;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    if column.rows == 0u {
        return;
    }
    var source = column.source + params.in_width;
    var row = column.target_index;
    var above = row_at(column.source);
    var here = row_at(source);
    for (var y = 0u; y < column.rows; y++) {
        source += params.in_width;
        let below = row_at(source);
        var kept = 0u;
        if FEATURES != FEATURES_NONE {
            // The window has a sample more on every side than the output.
            let at = column.at + vec2<u32>(1u, y + 1u);
            kept = feature_bits(params.features, column.window, vec2<i32>(at));
        }
        store_four(row, 0u, column.width, smoothed(
            here.a, here.b, centers(above.a, above.b) + centers(below.a, below.b), kept));
        if QUADS > 1u {
            store_four(row, 4u, column.width, smoothed(
                here.b, here.c, centers(above.b, above.c) + centers(below.b, below.c), kept >> 4u));
            store_four(row, 8u, column.width, smoothed(
                here.c, here.d, centers(above.c, above.d) + centers(below.c, below.d), kept >> 8u));
            store_four(row, 12u, column.width, smoothed(
                here.d, here.e, centers(above.d, above.e) + centers(below.d, below.e), kept >> 12u));
        }
        row += params.in_width - 2u;
        above = here;
        here = below;
    }
}

// Four samples without spikes, given the sums of the heights above and below them. Those whose bits are set are kept.
fn smoothed(left: vec4<i32>, next: vec4<i32>, sums: vec4<i32>, kept: u32) -> vec4<i32> {
    let here = centers(left, next);
    let mean = mean_of_sums(left + right_of(left, next), sums);
    let free = (vec4<u32>(kept) & vec4<u32>(1u, 2u, 4u, 8u)) == vec4<u32>(0u);
    return select(here, mean, (abs(here - mean) > vec4<i32>(params.threshold)) & free);
}
