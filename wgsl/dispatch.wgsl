// Size of a dispatch in workgroups along x, y and z, with at least `groups` workgroups in total. A row along x has at most
// `most` workgroups (maxComputeWorkgroupsPerDimension, at least 1). If `groups` is 0, the size along y is 0. Workgroup (x, y)
// has the index y * (size along x) + x. Workgroups with the index `groups` or higher have nothing to do.
fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}
