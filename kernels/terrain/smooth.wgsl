// One level of smooth subdivision for a batch of windows onto the plane: four-point interpolation (Dyn, Levin and Gregory 1987)
// in both directions, with random offsets.
//
// A thread owns 4 x CELL_ROWS coarse cells. It streams the coarse rows through registers: of each the values interpolated along
// the row, from four of these rows the centers of a row of cells, and from four rows of centers the points on the edges between
// them. It computes the three centers on either side of its cells that other threads compute too.
import package::wgsl::terrain::blocks::{Thread};
import package::wgsl::terrain::order::block_in_order;
import package::wgsl::terrain::fixed::{four_point, limited, mean_of_two};
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, feature_at, feature_bits, injected_lanes};
import package::wgsl::terrain::level::{
    Columns, FIRST, LANES, Place, base_points, columns_of, fine_at, level, loaded, offsets, origins, store_four, world_y};

// Rows of coarse cells per thread: many for a software adapter, few for hardware.
override CELL_ROWS: u32 = 8u;

// The features of the finer level are listed for two points more on every side than those of `terrain/height`: centers up to
// three points outside of a window belong to its edges.
const FEATURE_SHIFT = vec2<i32>(2);

// Columns -3 to 6 of a coarse row, for four cells.
struct CoarseRow {
    // -3 to 0.
    before: vec4<i32>,
    // 1 to 4.
    inner: vec4<i32>,
    // 5 and 6.
    after: vec2<i32>,
}

// Values in the middle of cells -2 to 4. The last lane has no meaning.
struct Middles {
    // -2 to 1.
    first: vec4<i32>,
    // 2 to 5.
    second: vec4<i32>,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_in_order(level.blocks, thread);
    if !block.there {
        return;
    }
    let window = block.window;
    let origin = origins[window];
    // The coarse window begins three points before the one at its first sample or the one before that.
    let shift = origin - 2 * ((origin >> vec2<u32>(1u)) - vec2<i32>(3));
    let place = Place(window, origin, shift, level.fine_spacing, level.fine_range);
    subdivide(place, vec2<i32>(block.at) * vec2<i32>(4, i32(CELL_ROWS)) + vec2<i32>(3));
}

fn subdivide(place: Place, cell: vec2<i32>) {
    let columns = columns_of(place, cell.x);
    var edges = place;
    edges.range = level.edge_range;
    // The rows y - 1 to y + 2 in the thread's own columns, the values along the rows y to y + 2, and the centers of the cells
    // below rows y - 2 to y.
    var own: array<vec4<i32>, 3>;
    var along: array<Middles, 3>;
    var centers: array<Middles, 3>;
    for (var row = 0; row < 3; row++) {
        let coarse = coarse_row(place, cell + vec2<i32>(0, row - 3));
        own[row] = own_columns(coarse);
        along[row] = interpolated_along(coarse);
    }
    var above = own[0];
    let last = min(cell.y + i32(CELL_ROWS), (i32(level.fine_width) - 1 + place.shift.y) / 2 + 1);
    // Three rows only provide centers.
    for (var y = cell.y - 3; y < last; y++) {
        let at = vec2<i32>(cell.x, y);
        let coarse = coarse_row(place, at + vec2<i32>(0, 3));
        let next_own = own_columns(coarse);
        let next_along = interpolated_along(coarse);
        let next_centers = centers_below(
            place, columns, at + vec2<i32>(0, 1), along[0], along[1], along[2], next_along);
        if y >= cell.y {
            let beside = finished(
                edges, columns.odd, fine_at(place, at) + vec2<i32>(1, 0),
                mean_of_two(
                    own_cells(along[0]),
                    four_point(
                        own_cells(centers[0]), own_cells(centers[1]), own_cells(centers[2]),
                        own_cells(next_centers))));
            let across = centers[2];
            let below = finished(
                edges, columns.even, fine_at(place, at) + vec2<i32>(0, 1),
                mean_of_two(
                    four_point(above, own[0], own[1], own[2]),
                    four_point(
                        across.first, vec4<i32>(across.first.yzw, across.second.x), own_cells(across),
                        vec4<i32>(across.first.w, across.second.xyz))));
            let first = fine_at(place, at);
            store_four(place, first, own[0]);
            store_four(place, first + vec2<i32>(1, 0), beside);
            store_four(place, first + vec2<i32>(0, 1), below);
            store_four(place, first + vec2<i32>(1), own_cells(across));
        }
        above = own[0];
        own = array<vec4<i32>, 3>(own[1], own[2], next_own);
        along = array<Middles, 3>(along[1], along[2], next_along);
        centers = array<Middles, 3>(centers[1], centers[2], next_centers);
    }
}

fn coarse_row(place: Place, cell: vec2<i32>) -> CoarseRow {
    if FIRST {
        let after = base_points(place, cell + vec2<i32>(5, 0));
        return CoarseRow(
            limited(base_points(place, cell - vec2<i32>(3, 0))), limited(base_points(place, cell + vec2<i32>(1, 0))),
            limited(after).xy);
    }
    let before = vec4<i32>(
        loaded(place, cell - vec2<i32>(3, 0)), loaded(place, cell - vec2<i32>(2, 0)),
        loaded(place, cell - vec2<i32>(1, 0)), loaded(place, cell));
    let inner = vec4<i32>(
        loaded(place, cell + vec2<i32>(1, 0)), loaded(place, cell + vec2<i32>(2, 0)),
        loaded(place, cell + vec2<i32>(3, 0)), loaded(place, cell + vec2<i32>(4, 0)));
    let after = vec2<i32>(loaded(place, cell + vec2<i32>(5, 0)), loaded(place, cell + vec2<i32>(6, 0)));
    return CoarseRow(before, inner, after);
}

// Columns 0 to 3.
fn own_columns(row: CoarseRow) -> vec4<i32> {
    return vec4<i32>(row.before.w, row.inner.xyz);
}

// Cells 0 to 3.
fn own_cells(middles: Middles) -> vec4<i32> {
    return vec4<i32>(middles.first.zw, middles.second.xy);
}

fn interpolated_along(row: CoarseRow) -> Middles {
    let before = row.before;
    let inner = row.inner;
    let after = row.after;
    let shared_row = own_columns(row);
    return Middles(
        four_point(before, vec4<i32>(before.yzw, inner.x), vec4<i32>(before.zw, inner.xy), shared_row),
        four_point(
            inner, vec4<i32>(inner.yzw, after.x), vec4<i32>(inner.zw, after), vec4<i32>(inner.w, after, after.y)));
}

// The centers of the cells below a row, from the values along the row before it, that row, and the two rows after it.
fn centers_below(
    place: Place, columns: Columns, cell: vec2<i32>, a: Middles, b: Middles, c: Middles, d: Middles,
) -> Middles {
    let at = fine_at(place, cell) + vec2<i32>(1);
    let two_cells = vec4<u32>(4u * place.spacing);
    return Middles(
        finished(
            place, columns.odd - two_cells, at - vec2<i32>(4, 0), four_point(a.first, b.first, c.first, d.first)),
        finished(
            place, columns.odd + two_cells, at + vec2<i32>(4, 0),
            four_point(a.second, b.second, c.second, d.second)));
}

// Adds random offsets and features to interpolated heights at the fine samples `at`, `at` + (2, 0), …, whose world coordinates
// are x.
fn finished(place: Place, x: vec4<u32>, at: vec2<i32>, interpolated: vec4<i32>) -> vec4<i32> {
    var heights = limited(interpolated) + offsets(place, x, world_y(place, at));
    if FEATURES != FEATURES_NONE {
        let in_grid = at + FEATURE_SHIFT;
        let bits = feature_bits(level.fine_features, place.window, in_grid) & 0x55u;
        for (var rest = bits; rest != 0u; rest &= rest - 1u) {
            let column = i32(countTrailingZeros(rest));
            let feature = feature_at(level.fine_features, place.window, in_grid + vec2<i32>(column, 0));
            heights = injected_lanes(feature, 2 * LANES == vec4<i32>(column), heights);
        }
    }
    return limited(heights);
}
