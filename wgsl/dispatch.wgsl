// Numbers of workgroups along x, y and z for a dispatch of at least `groups` workgroups. The workgroups form rows of at most
// `most` workgroups (maxComputeWorkgroupsPerDimension, at least 1). If `groups` is 0, the number along y is 0. Workgroup (x, y)
// has the number y * rows.x + x; workgroups with the number `groups` or more have nothing to do.
fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}
