// One level of diamond-square subdivision, or two, for a batch of windows onto the plane (B section 3.3.1).
//
// A thread owns 4 x CELL_ROWS coarse cells. It streams the coarse rows through registers and computes the
// diamonds on the rim of its cells a second time, so that threads need no barrier and a level is one dispatch.
// With two levels per dispatch, the rows of the level in between stream through registers too and are neither
// stored nor loaded.
import package::wgsl::terrain::blocks::{Thread, block_of};
import package::wgsl::terrain::fixed::{held, mean_of_sums};
import package::wgsl::terrain::features::{FEATURES, FEATURES_NONE, feature_at, feature_bits, injected_lanes};
import package::wgsl::terrain::level::{
    Columns, FIRST, LANES, Place, base_points, columns_of, fine_at, level, loaded, offsets, origins, store_four, world_y};

// Rows of coarse cells per thread: many for a software adapter, few for hardware.
override CELL_ROWS: u32 = 4u;
// Levels per dispatch: 1, or 2 where no features are injected.
override LEVELS: u32 = 1u;

// Columns -1 to 4 of a coarse row, for four cells.
struct CoarseRow {
    left: i32,
    inner: vec4<i32>,
    right: i32,
}

// The centers of cells -1 to 3 between two coarse rows.
struct DiamondRow {
    left: i32,
    inner: vec4<i32>,
}

@compute @workgroup_size(64)
fn main(thread: Thread) {
    let block = block_of(level.blocks, thread);
    if !block.there {
        return;
    }
    let window = block.window;
    let place = place_of(window, origins[window], level.fine_spacing, level.fine_range);
    // A thread's first cell starts at the coarse point that coincides with its first sample, or else precedes
    // it.
    let first = vec2<i32>(block.at) * vec2<i32>(4, i32(CELL_ROWS));
    if LEVELS == 1u {
        subdivide(place, first + place.shift - vec2<i32>(1));
    } else {
        let middle = place_of(window, coarse_origin(place.origin), 2u * level.fine_spacing, level.middle_range);
        let shift = middle.shift + place.shift;
        subdivide_twice(place, middle, first + vec2<i32>((shift.x + middle.shift.x) / 4, shift.y / 2));
    }
}

fn place_of(window: u32, origin: vec2<i32>, spacing: u32, range: u32) -> Place {
    return Place(window, origin, origin - 2 * coarse_origin(origin), spacing, range);
}

// ceil(origin / 2) - 1
fn coarse_origin(origin: vec2<i32>) -> vec2<i32> {
    return ((origin + vec2<i32>(1)) >> vec2<u32>(1u)) - vec2<i32>(1);
}

fn subdivide(place: Place, cell: vec2<i32>) {
    let columns = columns_of(place, cell.x);
    let above = cell - vec2<i32>(0, 1);
    var here = coarse_row(place, cell);
    var upper = diamonds(place, columns, above, coarse_row(place, above), here);
    upper = injected_diamonds(place, above, odd_features(place, above), upper);
    let last = min(cell.y + i32(CELL_ROWS), (i32(level.fine_width) - 1 + place.shift.y) / 2 + 1);
    for (var y = cell.y; y < last; y++) {
        let at = vec2<i32>(cell.x, y);
        let below = coarse_row(place, at + vec2<i32>(0, 1));
        let features = odd_features(place, at);
        let lower = injected_diamonds(place, at, features, diamonds(place, columns, at, here, below));
        write_rows(place, columns, at, here, below, upper.inner, lower, features);
        here = below;
        upper = lower;
    }
}

fn diamonds(place: Place, columns: Columns, cell: vec2<i32>, above: CoarseRow, below: CoarseRow) -> DiamondRow {
    let at = fine_at(place, cell) + vec2<i32>(-1, 1);
    let mean = mean_of_sums(vec4<i32>(above.left + below.left), vec4<i32>(above.inner.x + below.inner.x)).x;
    return DiamondRow(
        mean + offsets(place, vec4<u32>(columns.odd.x - 2u * place.spacing), world_y(place, at)).x,
        inner_diamonds(place, columns, cell, above, below));
}

fn inner_diamonds(
    place: Place, columns: Columns, cell: vec2<i32>, above: CoarseRow, below: CoarseRow,
) -> vec4<i32> {
    let sums = above.inner + below.inner;
    let beside = vec4<i32>(sums.yzw, above.right + below.right);
    return drawn(place, columns.odd, fine_at(place, cell) + vec2<i32>(1), mean_of_sums(sums, beside));
}

// The samples to the right of the coarse points of a row.
fn squares_beside(
    place: Place, columns: Columns, cell: vec2<i32>, here: CoarseRow, upper: vec4<i32>, lower: vec4<i32>,
) -> vec4<i32> {
    let beside = vec4<i32>(here.inner.yzw, here.right);
    let at = fine_at(place, cell) + vec2<i32>(1, 0);
    return drawn(place, columns.odd, at, mean_of_sums(here.inner + beside, upper + lower));
}

// The samples below the coarse points of a row.
fn squares_below(
    place: Place, columns: Columns, cell: vec2<i32>, here: CoarseRow, below: CoarseRow, lower: DiamondRow,
) -> vec4<i32> {
    let before = vec4<i32>(lower.left, lower.inner.xyz);
    let at = fine_at(place, cell) + vec2<i32>(0, 1);
    return drawn(place, columns.even, at, mean_of_sums(here.inner + below.inner, before + lower.inner));
}

// Writes the two fine rows of four cells between two coarse rows. Samples that are known already are stored
// first, between the draws of random words: the processor waits for the first store of a row, and does so while
// it computes.
fn write_rows(
    place: Place, columns: Columns, cell: vec2<i32>, here: CoarseRow, below: CoarseRow,
    upper: vec4<i32>, lower: DiamondRow, odd_features: u32,
) {
    let at = fine_at(place, cell);
    store_four(place, at, here.inner);
    let beside = held(squares_beside(place, columns, cell, here, upper, lower.inner));
    store_four(place, at + vec2<i32>(1), lower.inner);
    let under = held(squares_below(place, columns, cell, here, below, lower));
    let squares = injected_squares(place, at, odd_features, Squares(beside, under));
    store_four(place, at + vec2<i32>(1, 0), squares.beside);
    store_four(place, at + vec2<i32>(0, 1), squares.under);
}

// Columns -1 to 5 of a coarse row.
struct WideRow {
    four: CoarseRow,
    beyond: i32,
}

// Columns -1 to 8 of a middle row.
struct MiddleRow {
    left: i32,
    first: vec4<i32>,
    second: vec4<i32>,
    right: i32,
}

// Two middle rows: the one at a coarse row, and the one below it, whose odd columns are the centers of the
// coarse cells.
struct MiddleRows {
    even: MiddleRow,
    odd: MiddleRow,
    centers: DiamondRow,
}

// The centers of the middle cells -1 to 7.
struct FineDiamonds {
    first: DiamondRow,
    second: vec4<i32>,
}

// Makes two levels. A middle row is complete when the coarse row below it is known, and a fine row when the
// middle row below it is. A thread therefore writes the fine rows from the middle row above its first cell to
// the one at its last.
fn subdivide_twice(place: Place, middle: Place, cell: vec2<i32>) {
    let columns = columns_of(middle, cell.x);
    var at = cell - vec2<i32>(0, 1);
    var here = wide_row(middle, at);
    var below = wide_row(middle, cell);
    let above_here = at - vec2<i32>(0, 1);
    let centers = diamonds(middle, columns, above_here, coarse_row(middle, above_here), here.four);
    var rows = middle_rows(middle, columns, at, here, below, centers);

    var fine_cell = fine_at(middle, at) + vec2<i32>(0, 1);
    let first = columns_of(place, fine_cell.x);
    let second = columns_of(place, fine_cell.x + 4);
    var current = rows.odd;
    var upper = fine_diamonds(place, first, second, fine_cell - vec2<i32>(0, 1), rows.even, current);
    let last_row = (i32(level.fine_width) - 1 + place.shift.y) / 2;
    let last = min(cell.y + i32(CELL_ROWS), (last_row + middle.shift.y + 1) / 2 + 1);
    for (var y = cell.y; y < last; y++) {
        at = vec2<i32>(cell.x, y);
        here = below;
        below = wide_row(middle, at + vec2<i32>(0, 1));
        rows = middle_rows(middle, columns, at, here, below, rows.centers);
        var next = rows.even;
        for (var half = 0; half < 2; half++) {
            let lower = fine_diamonds(place, first, second, fine_cell, current, next);
            write_rows(
                place, first, fine_cell, first_four(current), first_four(next), upper.first.inner, lower.first, 0u);
            write_rows(
                place, second, fine_cell + vec2<i32>(4, 0), second_four(current), second_four(next),
                upper.second, DiamondRow(lower.first.inner.w, lower.second), 0u);
            fine_cell.y++;
            upper = lower;
            current = next;
            next = rows.odd;
        }
    }
}

fn wide_row(place: Place, cell: vec2<i32>) -> WideRow {
    let beyond = cell + vec2<i32>(5, 0);
    if FIRST {
        return WideRow(coarse_row(place, cell), base_points(place, beyond).x);
    }
    return WideRow(coarse_row(place, cell), loaded(place, beyond));
}

// The middle rows between two coarse rows, given the centers of the cells above them.
fn middle_rows(
    place: Place, columns: Columns, cell: vec2<i32>, here: WideRow, below: WideRow, above: DiamondRow,
) -> MiddleRows {
    let inner = inner_diamonds(place, columns, cell, here.four, below.four);
    // The rim takes one draw: the centers of cells -1 and 4, column -1 of the even row, and column 8 of the odd
    // row.
    let y = world_y(place, fine_at(place, cell));
    let step = vec4<u32>(place.spacing);
    let rim = offsets(
        place,
        vec4<u32>(columns.even.x, columns.odd.w, columns.even.x, columns.even.w) + step * vec4<u32>(~0u, 2u, ~0u, 2u),
        y + step * vec4<u32>(1u, 1u, 0u, 1u));
    let right = here.four.right + below.four.right;
    let centers = rim + mean_of_sums(
        vec4<i32>(here.four.left + below.four.left, right, 0, 0),
        vec4<i32>(here.four.inner.x + below.four.inner.x, here.beyond + below.beyond, 0, 0));
    let squares = rim + mean_of_sums(
        vec4<i32>(0, 0, here.four.left + here.four.inner.x, right),
        vec4<i32>(0, 0, above.left + centers.x, inner.w + centers.y));
    let lower = DiamondRow(centers.x, inner);
    return MiddleRows(
        middle_row(
            squares.z, here.four.inner,
            squares_beside(place, columns, cell, here.four, above.inner, inner), here.four.right),
        middle_row(
            centers.x, squares_below(place, columns, cell, here.four, below.four, lower), inner, squares.w),
        lower);
}

fn middle_row(left: i32, even: vec4<i32>, odd: vec4<i32>, right: i32) -> MiddleRow {
    return MiddleRow(
        left, vec4<i32>(even.x, odd.x, even.y, odd.y), vec4<i32>(even.z, odd.z, even.w, odd.w), right);
}

fn first_four(row: MiddleRow) -> CoarseRow {
    return CoarseRow(row.left, row.first, row.second.x);
}

fn second_four(row: MiddleRow) -> CoarseRow {
    return CoarseRow(row.first.w, row.second, row.right);
}

fn fine_diamonds(
    place: Place, first: Columns, second: Columns, cell: vec2<i32>, above: MiddleRow, below: MiddleRow,
) -> FineDiamonds {
    return FineDiamonds(
        diamonds(place, first, cell, first_four(above), first_four(below)),
        inner_diamonds(place, second, cell + vec2<i32>(4, 0), second_four(above), second_four(below)));
}

// Adds random offsets to four means at the fine samples `at`, `at` + (2, 0), …, whose world coordinates are x.
fn drawn(place: Place, x: vec4<u32>, at: vec2<i32>, means: vec4<i32>) -> vec4<i32> {
    return means + offsets(place, x, world_y(place, at));
}

fn coarse_row(place: Place, cell: vec2<i32>) -> CoarseRow {
    if FIRST {
        let left = base_points(place, cell - vec2<i32>(1, 0)).x;
        return CoarseRow(left, base_points(place, cell), base_points(place, cell + vec2<i32>(4, 0)).x);
    }
    let inner = vec4<i32>(
        loaded(place, cell), loaded(place, cell + vec2<i32>(1, 0)),
        loaded(place, cell + vec2<i32>(2, 0)), loaded(place, cell + vec2<i32>(3, 0)));
    return CoarseRow(loaded(place, cell - vec2<i32>(1, 0)), inner, loaded(place, cell + vec2<i32>(4, 0)));
}

// Which samples below a row of coarse points have features, starting with the one to the left of the first: the
// centers of cells -1 to 3, and the samples between them.
fn odd_features(place: Place, cell: vec2<i32>) -> u32 {
    if FEATURES == FEATURES_NONE {
        return 0u;
    }
    return feature_bits(level.fine_features, place.window, fine_at(place, cell) + vec2<i32>(-1, 1)) & 0x1ffu;
}

fn injected_diamonds(place: Place, cell: vec2<i32>, odd_features: u32, computed: DiamondRow) -> DiamondRow {
    if FEATURES == FEATURES_NONE {
        return computed;
    }
    var result = computed;
    let at = fine_at(place, cell) + vec2<i32>(-1, 1);
    // One loop serves all: every further loop costs lavapipe an iteration, even where there is nothing to
    // inject.
    for (var rest = odd_features & 0x155u; rest != 0u; rest &= rest - 1u) {
        let column = i32(countTrailingZeros(rest));
        let feature = feature_at(level.fine_features, place.window, at + vec2<i32>(column, 0));
        result.left = injected_lanes(feature, vec4<bool>(column == 0), vec4<i32>(result.left)).x;
        result.inner = injected_lanes(feature, 2 * LANES + vec4<i32>(2) == vec4<i32>(column), result.inner);
    }
    return result;
}

// The samples to the right of four coarse points, and those below them.
struct Squares {
    beside: vec4<i32>,
    under: vec4<i32>,
}

fn injected_squares(place: Place, at: vec2<i32>, odd_features: u32, computed: Squares) -> Squares {
    if FEATURES == FEATURES_NONE {
        return computed;
    }
    var result = computed;
    // Odd columns lie in the row of the coarse points, even columns in the row below.
    let even_features = feature_bits(level.fine_features, place.window, at);
    for (var rest = (even_features & 0xaau) | ((odd_features >> 1u) & 0x55u); rest != 0u; rest &= rest - 1u) {
        let column = i32(countTrailingZeros(rest));
        let below = 1 - column % 2;
        let feature = feature_at(level.fine_features, place.window, at + vec2<i32>(column, below));
        let lanes = 2 * LANES + vec4<i32>(1 - below) == vec4<i32>(column);
        result.beside = injected_lanes(feature, lanes & vec4<bool>(below == 0), result.beside);
        result.under = injected_lanes(feature, lanes & vec4<bool>(below == 1), result.under);
    }
    return result;
}
