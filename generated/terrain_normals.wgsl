// relievo terrain/normals: generated from kernels/terrain/normals.wgsl

fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return gradient_normal(vec2<f32>(gradient), run);
}

fn gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}

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

struct NormalsParams {
    width: u32,
    run: f32
}

@group(0) @binding(0)
var<uniform> params: NormalsParams;

@group(0) @binding(2)
var<storage, read_write> gradients: array<vec2<i32>>;

@group(0) @binding(3)
var<storage, read_write> normals: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if !is_inner(params.width, id) {
        return;
    }
    let gradient = gradient_at(params.width, sample_index(params.width, id));
    let normal = slope_normal(gradient, params.run);
    let index = inner_index(params.width, id);
    gradients[index] = gradient;
    normals[3u * index] = normal.x;
    normals[3u * index + 1u] = normal.y;
    normals[3u * index + 2u] = normal.z;
}
