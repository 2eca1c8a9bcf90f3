// Removes spikes: every point that differs from the mean of its four neighbours by more than the threshold is replaced by that
// mean (thesis B figure 5.10). Injected points are left unchanged. Each window loses its outermost ring of samples.
import package::wgsl::terrain::windows::{inner_index, is_inner, sample_index, windows};
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, has_feature};

// Parameters of the kernel `terrain/despike`.
struct DespikeParams {
    // Feature grids of the windows, which mark injected points.
    features: FeatureGrid,
    // Number of samples along an edge of a window.
    width: u32,
    // Largest difference that is not a spike, in 1/65536 units.
    threshold: i32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: DespikeParams;
// Out: heights of the inner samples of all windows, in 1/65536 units.
@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let at = sample_index(params.width, id);
    let height = windows[at];
    let mean = mean_of_four(
        vec4<i32>(windows[at - 1u]), vec4<i32>(windows[at + 1u]),
        vec4<i32>(windows[at - params.width]), vec4<i32>(windows[at + params.width])).x;
    var is_spike = abs(height - mean) > params.threshold;
    if FEATURES != FEATURES_NONE {
        is_spike = is_spike && !has_feature(params.features, id.z, vec2<i32>(id.xy + vec2<u32>(1u)));
    }
    outputs[inner_index(params.width, id)] = select(height, mean, is_spike);
}
