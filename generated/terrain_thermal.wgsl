// relievo terrain/thermal: generated from kernels/terrain/thermal.wgsl

@group(0) @binding(1)
var<storage, read> windows: array<i32>;

fn is_inner(width: u32, id: vec3<u32>) -> bool {
    return all(id.xy < vec2<u32>(width - 2u));
}

fn inner_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * (width - 2u) + id.y) * (width - 2u) + id.x;
}

fn sample_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * width + id.y + 1u) * width + id.x + 1u;
}

fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}

struct ThermalParams {
    width: u32,
    threshold: i32
}

@group(0) @binding(0)
var<uniform> params: ThermalParams;

@group(0) @binding(2)
var<storage, read_write> outputs: array<i32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let at = sample_index(params.width, id);
    let height = windows[at];
    outputs[inner_index(params.width, id)] = height + slide(windows[at - 1u] - height) + slide(windows[at + 1u] - height) + slide(windows[at - params.width] - height) + slide(windows[at + params.width] - height);
}

fn slide(difference: i32) -> i32 {
    let excess = max(abs(difference) - params.threshold, 0) >> 3u;
    return select(excess, -excess, difference < 0);
}
