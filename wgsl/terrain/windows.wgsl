// Windows of heights, and their samples without the outermost ring.
import package::wgsl::terrain::points::{Point, Thread, point_of};

@group(0) @binding(1) var<storage, read> windows: array<i32>;

// The inner sample of a thread, for `count` windows of `width` × `width` samples.
fn inner_point(width: u32, count: u32, thread: Thread) -> Point {
    return point_of(width - 2u, count, thread);
}

// The index of an inner sample among all samples of the windows.
fn sample_index(width: u32, inner: Point) -> u32 {
    return (inner.field * width + inner.at.y + 1u) * width + inner.at.x + 1u;
}

// The central differences along x and y at a sample that is not on the outermost ring.
fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}
