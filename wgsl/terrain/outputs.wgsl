// Where kernels store heights, four of a row at a time.
import package::wgsl::terrain::fixed::held;

@group(0) @binding(2) var<storage, read_write> outputs: array<i32>;

// Stores the heights `column` to `column` + 3 of a row that starts at `row` and has `width` of them.
fn store_four(row: u32, column: u32, width: u32, heights: vec4<i32>) {
    let stored = held(heights);
    let at = row + column;
    if column < width {
        outputs[at] = stored.x;
    }
    if column + 1u < width {
        outputs[at + 1u] = stored.y;
    }
    if column + 2u < width {
        outputs[at + 2u] = stored.z;
    }
    if column + 3u < width {
        outputs[at + 3u] = stored.w;
    }
}
