// Parameters of the kernel `baseline/loads`. The kernel loads texels and adds them up, to measure the cost of texel loads
// alone. Each thread walks along a row of the texture.
struct LoadsParams {
    // Number of threads along x and y.
    threads: vec2<u32>,
    // Number of texels that each thread loads.
    loads: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: LoadsParams;
// Texture to read. Only the red channel is used.
@group(0) @binding(1) var texels: texture_2d<f32>;
// Out: sum of each thread's texels, row by row.
@group(0) @binding(2) var<storage, read_write> sums: array<f32>;

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
