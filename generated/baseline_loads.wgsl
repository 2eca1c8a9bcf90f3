// relievo baseline/loads: generated from kernels/baseline/loads.wgsl

struct LoadsParams {
    threads: vec2<u32>,
    loads: u32
}

@group(0) @binding(0)
var<uniform> params: LoadsParams;

@group(0) @binding(1)
var texels: texture_2d<f32>;

@group(0) @binding(2)
var<storage, read_write> sums: array<f32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= params.threads) {
        return;
    }
    let size = textureDimensions(texels);
    var at = id.xy % size;
    var sum = 0.0;
    for (var load = 0u; load < params.loads; load++) {
        sum += textureLoad(texels, at, 0).r;
        at.x = select(at.x + 1u, 0u, at.x + 1u == size.x);
    }
    sums[id.y * params.threads.x + id.x] = sum;
}
