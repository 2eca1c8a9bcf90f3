// A point further than the threshold from the mean of its four neighbours is replaced by it (B figure 5.10);
// injected points are left alone. Crops each window by one sample on every side.
import package::wgsl::terrain::fixed::mean_of_four;
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, FeatureGrid, has_feature};

struct DespikeParams {
    // Every injected point of the windows.
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
    let centre = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let height = windows[centre];
    // Four lanes of one value: the exact mean is written once, for vectors.
    let mean = mean_of_four(
        vec4<i32>(windows[centre - 1u]), vec4<i32>(windows[centre + 1u]),
        vec4<i32>(windows[centre - params.in_width]), vec4<i32>(windows[centre + params.in_width])).x;
    var spike = abs(height - mean) > params.threshold;
    if FEATURES != FEATURES_NONE {
        spike = spike && !has_feature(params.features, id.z, vec2<i32>(at));
    }
    cropped[(id.z * width + id.y) * width + id.x] = select(height, mean, spike);
}
