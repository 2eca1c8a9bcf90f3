// Replaces every point that is further than the threshold from the mean of its four neighbours by that mean (B
// figure 5.10). Injected points are left alone. Each window loses its outermost ring of samples.
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, has_feature};

struct DespikeParams {
    // The index of the injected points of the windows.
    features: FeatureGrid,
    in_width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: DespikeParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read_write> cropped: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    if id.x >= width {
        return;
    }
    let at = id.xy + vec2<u32>(1u);
    let center = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let height = windows[center];
    // All four lanes have the same value: the exact mean is written for vectors only.
    let mean = mean_of_four(
        vec4<i32>(windows[center - 1u]), vec4<i32>(windows[center + 1u]),
        vec4<i32>(windows[center - params.in_width]), vec4<i32>(windows[center + params.in_width])).x;
    var spike = abs(height - mean) > params.threshold;
    if FEATURES != FEATURES_NONE {
        spike = spike && !has_feature(params.features, id.z, vec2<i32>(at));
    }
    cropped[(id.z * width + id.y) * width + id.x] = select(height, mean, spike);
}
