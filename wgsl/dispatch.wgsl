// Workgroups along x, y and z for `groups` in all: rows of at most `most` (maxComputeWorkgroupsPerDimension), at least 1.
// For none, none along y. Workgroup (x, y) is number y * rows.x + x, and those beyond `groups` have nothing to do.
fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}
