// Central differences (exact) and unit normals of windows. Each window loses its outermost ring of samples.
import package::wgsl::terrain::slope::slope_normal;

struct NormalsParams {
    in_width: u32,
    // Twice the distance between samples, in 1/65536 units.
    run: f32,
}

@group(0) @binding(0) var<uniform> params: NormalsParams;
@group(0) @binding(1) var<storage, read> windows: array<i32>;
@group(0) @binding(2) var<storage, read_write> gradients: array<vec2<i32>>;
// Three components per point, so that the buffer can serve as a vertex buffer.
@group(0) @binding(3) var<storage, read_write> normals: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let width = params.in_width - 2u;
    if id.x >= width {
        return;
    }
    let at = id.xy + vec2<u32>(1u);
    let center = (id.z * params.in_width + at.y) * params.in_width + at.x;
    let gradient = vec2<i32>(
        windows[center + 1u] - windows[center - 1u],
        windows[center + params.in_width] - windows[center - params.in_width]);
    let normal = slope_normal(gradient, params.run);
    let index = (id.z * width + id.y) * width + id.x;
    gradients[index] = gradient;
    normals[3u * index] = normal.x;
    normals[3u * index + 1u] = normal.y;
    normals[3u * index + 2u] = normal.z;
}
