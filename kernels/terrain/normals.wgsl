// Central differences (exact) and unit normals of windows. Each window loses its outermost ring of samples.
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::windows::{gradient_at, inner_index, is_inner, sample_index};

struct NormalsParams {
    // Samples along an edge of a window.
    width: u32,
    // Twice the distance between samples, in 1/65536 units.
    run: f32,
}

@group(0) @binding(0) var<uniform> params: NormalsParams;
@group(0) @binding(2) var<storage, read_write> gradients: array<vec2<i32>>;
// Three components per point, so that the buffer can serve as a vertex buffer.
@group(0) @binding(3) var<storage, read_write> normals: array<f32>;

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
