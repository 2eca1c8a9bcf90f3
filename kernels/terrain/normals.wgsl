// Central differences (exact) and unit normals of windows. Each window loses its outermost ring of samples.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{QUADS, centers, column_of, right_of, row_at};
import package::wgsl::terrain::slope::slope_normal;

struct NormalsParams {
    blocks: Blocks,
    in_width: u32,
    // Twice the distance between samples, in 1/65536 units.
    run: f32,
}

@group(0) @binding(0) var<uniform> params: NormalsParams;
@group(0) @binding(2) var<storage, read_write> gradients: array<vec2<i32>>;
// Three components per point, so that the buffer can serve as a vertex buffer.
@group(0) @binding(3) var<storage, read_write> normals: array<f32>;

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    if column.rows == 0u {
        return;
    }
    var source = column.source + params.in_width;
    var row = column.target_index;
    var above = row_at(column.source);
    var here = row_at(source);
    for (var y = 0u; y < column.rows; y++) {
        source += params.in_width;
        let below = row_at(source);
        store_slopes(row, 0u, column.width, right_of(here.a, here.b) - here.a,
            centers(below.a, below.b) - centers(above.a, above.b));
        if QUADS > 1u {
            store_slopes(row, 4u, column.width, right_of(here.b, here.c) - here.b,
                centers(below.b, below.c) - centers(above.b, above.c));
            store_slopes(row, 8u, column.width, right_of(here.c, here.d) - here.c,
                centers(below.c, below.d) - centers(above.c, above.d));
            store_slopes(row, 12u, column.width, right_of(here.d, here.e) - here.d,
                centers(below.d, below.e) - centers(above.d, above.e));
        }
        row += params.in_width - 2u;
        above = here;
        here = below;
    }
}

// Stores four slopes, given the differences along x and y.
fn store_slopes(row: u32, column: u32, width: u32, along: vec4<i32>, down: vec4<i32>) {
    store_slope(row + column, column < width, vec2<i32>(along.x, down.x));
    store_slope(row + column + 1u, column + 1u < width, vec2<i32>(along.y, down.y));
    store_slope(row + column + 2u, column + 2u < width, vec2<i32>(along.z, down.z));
    store_slope(row + column + 3u, column + 3u < width, vec2<i32>(along.w, down.w));
}

fn store_slope(index: u32, there: bool, gradient: vec2<i32>) {
    let normal = slope_normal(gradient, params.run);
    if there {
        gradients[index] = gradient;
        normals[3u * index] = normal.x;
        normals[3u * index + 1u] = normal.y;
        normals[3u * index + 2u] = normal.z;
    }
}
