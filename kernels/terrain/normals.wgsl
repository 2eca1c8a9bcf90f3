// Gradients (exact central differences) and unit normals of windows. Each window loses its outermost ring of samples.
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::windows::{gradient_at, inner_index, is_inner, sample_index};

// Parameters of the kernel `terrain/normals`.
struct NormalsParams {
    // Number of samples along an edge of a window.
    width: u32,
    // Twice the distance between samples, in 1/65536 world units.
    run: f32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: NormalsParams;
// Out: central differences along x and y at the inner samples, in 1/65536 units.
@group(0) @binding(2) var<storage, read_write> gradients: array<vec2<i32>>;
// Out: unit normals of the inner samples. Each has three floats, so that the buffer can serve as a vertex buffer.
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
