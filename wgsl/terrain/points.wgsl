// The output that a thread makes: one point of a batch of square fields. Neighbouring threads make neighbouring points.

// A thread of a workgroup of 64.
struct Thread {
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
}

// A point of a batch.
struct Point {
    // False for the threads after the last point.
    there: bool,
    // Index of the field.
    field: u32,
    // Column and row in the field.
    at: vec2<u32>,
    // Index in the batch.
    index: u32,
}

// The point of a thread in a batch of `count` fields of `width` × `width` points.
fn point_of(width: u32, count: u32, thread: Thread) -> Point {
    let index = (thread.group.y * thread.groups.x + thread.group.x) * 64u + thread.lane;
    let row = index / width;
    return Point(row < width * count, row / width, vec2<u32>(index % width, row % width), index);
}
