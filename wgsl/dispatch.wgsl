// `value`, which all threads have, as a value of a thread. Driver workaround: where uniforms alone decide a branch or a loop's end,
// lavapipe compiles the kernel again in each submission (docs/drivers.md). `thread` is any index of the thread, below 2³² - 1.
fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 0xffffffffu);
}

// Size of a dispatch in workgroups along x, y and z, with at least `groups` workgroups in total. A row along x has at most
// `most` workgroups (maxComputeWorkgroupsPerDimension, at least 1). If `groups` is 0, the size along y is 0. Workgroup (x, y)
// has the index y * (size along x) + x. Workgroups with the index `groups` or higher have nothing to do.
fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}
