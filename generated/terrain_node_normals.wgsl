// relievo terrain/node_normals: generated from kernels/terrain/node_normals.wgsl

fn slope_normal(gradient: vec2<i32>, run: f32) -> vec3<f32> {
    return gradient_normal(vec2<f32>(gradient), run);
}

fn gradient_normal(gradient: vec2<f32>, run: f32) -> vec3<f32> {
    let along = vec3<f32>(-gradient.x, run, -gradient.y);
    return along * inverseSqrt(dot(along, along));
}

struct NodeNormalsParams {
    width: u32,
    size: u32,
    first: u32,
    step: u32,
    run: f32
}

@group(0) @binding(0)
var<uniform> params: NodeNormalsParams;

@group(0) @binding(1)
var<storage, read> heights: array<i32>;

@group(0) @binding(2)
var<storage, read> slots: array<u32>;

@group(0) @binding(3)
var<storage, read_write> normals: array<u32>;

fn height_at(region: u32, x: u32, y: u32) -> i32 {
    return heights[(region * params.width + y) * params.width + x];
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let slot = slots[id.z];
    let points = params.size * params.size;
    if max(id.x, id.y) >= params.size || slot >= arrayLength(&normals) / points {
        return;
    }
    let at = params.first + params.step * id.xy;
    let gradient = vec2<i32>(height_at(id.z, at.x + params.step, at.y) - height_at(id.z, at.x - params.step, at.y), height_at(id.z, at.x, at.y + params.step) - height_at(id.z, at.x, at.y - params.step));
    normals[slot * points + id.y * params.size + id.x] = pack2x16snorm(slope_normal(gradient, params.run).xz);
}
