// Windows of heights, and their inner samples: all samples except the outermost ring. A thread makes an inner sample of a
// window: `id` has its column, its row and the window.

@group(0) @binding(1) var<storage, read> windows: array<i32>;

// Whether there is an inner sample for a thread, where windows are `width` samples wide.
fn is_inner(width: u32, id: vec3<u32>) -> bool {
    return all(id.xy < vec2<u32>(width - 2u));
}

// The index of an inner sample among the inner samples of all windows.
fn inner_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * (width - 2u) + id.y) * (width - 2u) + id.x;
}

// The index of an inner sample among all samples of the windows.
fn sample_index(width: u32, id: vec3<u32>) -> u32 {
    return (id.z * width + id.y + 1u) * width + id.x + 1u;
}

// The central differences along x and y at an inner sample.
fn gradient_at(width: u32, sample: u32) -> vec2<i32> {
    return vec2<i32>(windows[sample + 1u] - windows[sample - 1u], windows[sample + width] - windows[sample - width]);
}
