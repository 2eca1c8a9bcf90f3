// One iteration of thermal erosion: between each pair of 4-neighbours, an eighth of the difference beyond the
// stable one slides downhill. All pairs read the same old field. Each window loses its outermost ring of
// samples.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{QUADS, Row, centers, column_of, row_at};
import package::wgsl::terrain::outputs::store_four;

struct ThermalParams {
    blocks: Blocks,
    in_width: u32,
    threshold: i32,
}

@group(0) @binding(0) var<uniform> params: ThermalParams;

// For each output of a row, what slides from the sample below to the sample above it.
struct Slides {
    a: vec4<i32>,
    b: vec4<i32>,
    c: vec4<i32>,
    d: vec4<i32>,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    if column.rows == 0u {
        return;
    }
    var source = column.source + params.in_width;
    var row = column.target_index;
    var here = row_at(source);
    var upper = slides(row_at(column.source), here);
    for (var y = 0u; y < column.rows; y++) {
        source += params.in_width;
        let below = row_at(source);
        let lower = slides(here, below);
        store_four(row, 0u, column.width, eroded(here.a, here.b, lower.a - upper.a));
        if QUADS > 1u {
            store_four(row, 4u, column.width, eroded(here.b, here.c, lower.b - upper.b));
            store_four(row, 8u, column.width, eroded(here.c, here.d, lower.c - upper.c));
            store_four(row, 12u, column.width, eroded(here.d, here.e, lower.d - upper.d));
        }
        row += params.in_width - 2u;
        here = below;
        upper = lower;
    }
}

fn slides(above: Row, below: Row) -> Slides {
    return Slides(
        slide(centers(below.a, below.b) - centers(above.a, above.b)),
        slide(centers(below.b, below.c) - centers(above.b, above.c)),
        slide(centers(below.c, below.d) - centers(above.c, above.d)),
        slide(centers(below.d, below.e) - centers(above.d, above.e)));
}

// What moves between samples of the given difference: an eighth of what exceeds the threshold, rounded towards zero.
fn slide(difference: vec4<i32>) -> vec4<i32> {
    let limit = vec4<i32>(params.threshold);
    let excess = difference - clamp(difference, -limit, limit);
    return (excess + ((excess >> vec4<u32>(31u)) & vec4<i32>(7))) >> vec4<u32>(3u);
}

// The new heights of four samples; `gained` is what they gain from above and below.
fn eroded(left: vec4<i32>, next: vec4<i32>, gained: vec4<i32>) -> vec4<i32> {
    let here = centers(left, next);
    let lost = slide(here - left);
    let last = slide(vec4<i32>(next.y - next.x));
    return here + vec4<i32>(lost.yzw, last.x) - lost + gained;
}
