// Central differences (exact) and unit normals of windows. Each window loses its outermost ring of samples.
//
// A thread makes a column of points, 4 * QUADS wide. The outputs of four consecutive points are whole vectors, so that a thread
// stores vectors: in each row it starts at the first point whose number among all is a multiple of four. Four points that begin at
// the end of a row and go on in the next belong to the row in which they begin.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::columns::{
    Column, QUADS, Row, centers, column_of, right_of, row_from, row_words_at, windows};
import package::wgsl::terrain::slope::slope_normal;

struct NormalsParams {
    blocks: Blocks,
    in_width: u32,
    // Points of all windows.
    points: u32,
    // Twice the distance between samples, in 1/65536 units.
    run: f32,
}

@group(0) @binding(0) var<uniform> params: NormalsParams;
// The differences along x and y of two points.
@group(0) @binding(2) var<storage, read_write> gradients: array<vec4<i32>>;
// Three components per point, so that the buffer can serve as a vertex buffer.
@group(0) @binding(3) var<storage, read_write> normals: array<vec4<f32>>;

const LANES = vec4<u32>(0u, 1u, 2u, 3u);

// The differences along x and y of four points.
struct Slopes {
    along: vec4<i32>,
    down: vec4<i32>,
}

// What is stored for four points.
struct Outputs {
    gradients_low: vec4<i32>,
    gradients_high: vec4<i32>,
    normals_low: vec4<f32>,
    normals_middle: vec4<f32>,
    normals_high: vec4<f32>,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let column = column_of(params.in_width, params.blocks, thread);
    if column.rows == 0u {
        return;
    }
    var source = column.source + params.in_width;
    var target_index = column.target_index;
    var above = row_words_at(column.source);
    var here = row_words_at(source);
    for (var y = 0u; y < column.rows; y++) {
        source += params.in_width;
        let below = row_words_at(source);
        let skipped = skipped_of(target_index);
        store_row((target_index + skipped) / 4u, fours_of(column, skipped),
            row_from(above, skipped), row_from(here, skipped), row_from(below, skipped));
        target_index += params.in_width - 2u;
        above = here;
        here = below;
    }
    // Only the last column sees the end of a row. A loop of its own, because software adapters run what a branch leaves out.
    let rows_across = select(0u, column.rows, column.width <= 4u * QUADS + 3u);
    for (var y = 0u; y < rows_across; y++) {
        let row = column.target_index + y * (params.in_width - 2u);
        let skipped = skipped_of(row);
        let count = fours_of(column, skipped);
        if skipped + 4u * count < column.width {
            store_across((row + skipped) / 4u + count);
        }
    }
}

// The points before the first whose number is a multiple of four, in a row whose first point is number `first`.
fn skipped_of(first: u32) -> u32 {
    return (0u - first) & 3u;
}

// How often four points are left in the row behind those skipped.
fn fours_of(column: Column, skipped: u32) -> u32 {
    return (column.width - min(skipped, column.width)) / 4u;
}

// Stores the points of a row of the column, four by four, as often as four are left in the row: `count` times. The first four are
// number `fours` among all.
fn store_row(fours: u32, count: u32, above: Row, here: Row, below: Row) {
    if count > 0u {
        store(fours, outputs(Slopes(
            right_of(here.a, here.b) - here.a, centers(below.a, below.b) - centers(above.a, above.b))));
    }
    if QUADS > 1u {
        if count > 1u {
            store(fours + 1u, outputs(Slopes(
                right_of(here.b, here.c) - here.b, centers(below.b, below.c) - centers(above.b, above.c))));
        }
        if count > 2u {
            store(fours + 2u, outputs(Slopes(
                right_of(here.c, here.d) - here.c, centers(below.c, below.d) - centers(above.c, above.d))));
        }
        if count > 3u {
            store(fours + 3u, outputs(Slopes(
                right_of(here.d, here.e) - here.d, centers(below.d, below.e) - centers(above.d, above.e))));
        }
    }
}

fn store(fours: u32, made: Outputs) {
    gradients[2u * fours] = made.gradients_low;
    gradients[2u * fours + 1u] = made.gradients_high;
    normals[3u * fours] = made.normals_low;
    normals[3u * fours + 1u] = made.normals_middle;
    normals[3u * fours + 2u] = made.normals_high;
}

// Stores four points that are not all of one row. Behind the last point of all, the buffers keep what they hold.
fn store_across(fours: u32) {
    var slopes = Slopes(vec4<i32>(0), vec4<i32>(0));
    for (var lane = 0u; lane < 4u; lane++) {
        let slope = slope_of(min(4u * fours + lane, params.points - 1u));
        slopes.along = select(slopes.along, vec4<i32>(slope.x), LANES == vec4<u32>(lane));
        slopes.down = select(slopes.down, vec4<i32>(slope.y), LANES == vec4<u32>(lane));
    }
    let made = outputs(slopes);
    let there = 4u * fours + LANES < vec4<u32>(params.points);
    store(fours, Outputs(
        select(gradients[2u * fours], made.gradients_low, there.xxyy),
        select(gradients[2u * fours + 1u], made.gradients_high, there.zzww),
        select(normals[3u * fours], made.normals_low, there.xxxy),
        select(normals[3u * fours + 1u], made.normals_middle, there.yyzz),
        select(normals[3u * fours + 2u], made.normals_high, there.zwww)));
}

// The differences along x and y of any point.
fn slope_of(point: u32) -> vec2<i32> {
    let width = params.in_width - 2u;
    let row = point / width;
    let sample = (row + 2u * (row / width)) * params.in_width + point % width;
    return vec2<i32>(
        sample_at(sample + params.in_width + 2u) - sample_at(sample + params.in_width),
        sample_at(sample + 2u * params.in_width + 1u) - sample_at(sample + 1u));
}

fn sample_at(sample: u32) -> i32 {
    return windows[sample / 4u][sample % 4u];
}

fn outputs(slopes: Slopes) -> Outputs {
    let low = vec4<i32>(slopes.along.x, slopes.down.x, slopes.along.y, slopes.down.y);
    let high = vec4<i32>(slopes.along.z, slopes.down.z, slopes.along.w, slopes.down.w);
    let a = slope_normal(low.xy, params.run);
    let b = slope_normal(low.zw, params.run);
    let c = slope_normal(high.xy, params.run);
    let d = slope_normal(high.zw, params.run);
    return Outputs(low, high, vec4<f32>(a, b.x), vec4<f32>(b.yz, c.xy), vec4<f32>(c.z, d));
}
