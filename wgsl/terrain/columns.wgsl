// Windows of which a thread makes a column of outputs, a sample smaller on every side than the window: 4 * QUADS samples wide
// and `blocks.rows` long. It streams the rows of the window through registers, so that it loads each of them once, four samples
// at a time and wherever a row starts.
import package::wgsl::terrain::blocks::{Blocks, Thread};
import package::wgsl::terrain::order::block_in_order;

// Vectors of four outputs along a row of a column: 1, or 4 for software adapters, which loads per output cost most.
override QUADS: u32 = 1u;

// The samples of all windows, four to a vector; rows need not start at one.
@group(0) @binding(1) var<storage, read> windows: array<vec4<i32>>;

// What a thread makes.
struct Column {
    window: u32,
    // Column and row of the first output.
    at: vec2<u32>,
    // Index of the sample above and to the left of the first output, and of the first output.
    source: u32,
    target_index: u32,
    // Outputs along a row from the first one on, and rows; there are none where the thread has nothing to do.
    width: u32,
    rows: u32,
}

// The samples of a row, from the one to the left of the column on. The last three vectors have no meaning if QUADS is 1.
struct Row {
    a: vec4<i32>,
    b: vec4<i32>,
    c: vec4<i32>,
    d: vec4<i32>,
    e: vec4<i32>,
}

fn column_of(in_width: u32, blocks: Blocks, thread: Thread) -> Column {
    let block = block_in_order(blocks, thread);
    let at = block.at * vec2<u32>(4u * QUADS, blocks.rows);
    let width = in_width - 2u;
    return Column(
        block.window, at,
        (block.window * in_width + at.y) * in_width + at.x,
        (block.window * width + at.y) * width + at.x,
        width - at.x, select(0u, min(blocks.rows, width - at.y), block.there));
}

// The vectors that hold a row of the column, of which it starts in the first.
struct RowWords {
    a: vec4<i32>,
    b: vec4<i32>,
    c: vec4<i32>,
    // These have no meaning if QUADS is 1.
    d: vec4<i32>,
    e: vec4<i32>,
    f: vec4<i32>,
    // The number of samples before its start, 0 to 3.
    before: u32,
}

// The vectors of the row that starts at sample `first`.
fn row_words_at(first: u32) -> RowWords {
    let at = first / 4u;
    if QUADS == 1u {
        let none = vec4<i32>(0);
        return RowWords(windows[at], windows[at + 1u], windows[at + 2u], none, none, none, first & 3u);
    }
    return RowWords(
        windows[at], windows[at + 1u], windows[at + 2u], windows[at + 3u], windows[at + 4u], windows[at + 5u], first & 3u);
}

// The row that starts at sample `first`.
fn row_at(first: u32) -> Row {
    let words = row_words_at(first);
    return Row(
        starting(first, words.a, words.b), starting(first, words.b, words.c), starting(first, words.c, words.d),
        starting(first, words.d, words.e), starting(first, words.e, words.f));
}

// The row without its first samples, 0 to 3 of them.
fn row_from(words: RowWords, skipped: u32) -> Row {
    let first = words.before + skipped;
    let later = first > 3u;
    let a = select(words.a, words.b, later);
    let b = select(words.b, words.c, later);
    let c = select(words.c, words.d, later);
    let d = select(words.d, words.e, later);
    let e = select(words.e, words.f, later);
    return Row(
        starting(first, a, b), starting(first, b, c), starting(first, c, d), starting(first, d, e),
        starting(first, e, words.f));
}

// Four consecutive samples, of which the first is number `first` % 4 of eight.
fn starting(first: u32, before: vec4<i32>, behind: vec4<i32>) -> vec4<i32> {
    let odd = (first & 1u) != 0u;
    let near = select(before, vec4<i32>(before.yzw, behind.x), odd);
    let far = select(behind.xy, behind.yz, odd);
    return select(near, vec4<i32>(near.zw, far), (first & 2u) != 0u);
}

// The samples at four outputs, given the vector of their left neighbours and the next one of the row.
fn centers(left: vec4<i32>, next: vec4<i32>) -> vec4<i32> {
    return vec4<i32>(left.yzw, next.x);
}

// Their right neighbours.
fn right_of(left: vec4<i32>, next: vec4<i32>) -> vec4<i32> {
    return vec4<i32>(left.zw, next.xy);
}
