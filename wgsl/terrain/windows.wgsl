// Windows of heights, and their inner samples: all samples except the outermost ring. A thread computes one inner sample of a
// window. The thread's `id` has the sample's column, its row, and the window.

// Heights of all windows, row by row, in 1/65536 units.
@group(0) @binding(1) var<storage, read> windows: array<i32>;

// Whether there is an inner sample for a thread. Windows are `width` samples wide.
fn is_inner(width: u32, id: vec3<u32>) -> bool {
    return all(id.xy < vec2<u32>(width - 2u));
}

// Index of an inner sample among the inner samples of all windows.
fn inner_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * (width - 2u) + id.y) * (width - 2u) + id.x;
}

// Index of an inner sample among all samples of all windows.
fn sample_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * width + id.y + 1u) * width + id.x + 1u;
}

// Central differences of the heights along x and y at an inner sample, in 1/65536 units.
fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}
