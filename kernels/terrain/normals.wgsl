// Central differences (exact) and unit normals of windows. Each window loses its outermost ring of samples.
import package::wgsl::terrain::points::Thread;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::windows::{gradient_at, inner_point, sample_index};

struct NormalsParams {
    // Windows, and samples along an edge of each.
    count: u32,
    width: u32,
    // Twice the distance between samples, in 1/65536 units.
    run: f32,
}

@group(0) @binding(0) var<uniform> params: NormalsParams;
@group(0) @binding(2) var<storage, read_write> gradients: array<vec2<i32>>;
// Three components per point, so that the buffer can serve as a vertex buffer.
@group(0) @binding(3) var<storage, read_write> normals: array<f32>;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let point = inner_point(params.width, params.count, thread);
    if !point.there {
        return;
    }
    let gradient = gradient_at(params.width, sample_index(params.width, point));
    let normal = slope_normal(gradient, params.run);
    gradients[point.index] = gradient;
    normals[3u * point.index] = normal.x;
    normals[3u * point.index + 1u] = normal.y;
    normals[3u * point.index + 2u] = normal.z;
}
