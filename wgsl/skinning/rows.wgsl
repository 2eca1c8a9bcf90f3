// Affine matrices of palettes and placements, stored as three rows.

// The first three rows of a 4 × 4 affine matrix.
struct Rows {
    // Row for the x coordinate.
    x: vec4<f32>,
    // Row for the y coordinate.
    y: vec4<f32>,
    // Row for the z coordinate.
    z: vec4<f32>,
}

// A vector has no direction if all its components are smaller than this. Devices may flush smaller values to zero.
const LEAST_LENGTH: f32 = 1e-30;

// `vector` scaled to length 1, or `other` if `vector` has no direction (`LEAST_LENGTH`).
fn unit_or(vector: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let size = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    let scaled = vector / max(size, LEAST_LENGTH);
    return select(scaled * inverseSqrt(max(dot(scaled, scaled), 0.5)), other, size < LEAST_LENGTH);
}

// Matrix of a bone, or of a weighted sum of bones, from a palette of dual quaternions. `real` is the rotation and `dual` the
// dual part; the pair may have any length but 0. The stretch is an upper triangular matrix that is applied first. `diagonal`
// has the stretch's elements xx, yy and zz, `above` its elements xy, xz and yz.
fn rows_of_dual(real: vec4<f32>, dual: vec4<f32>, diagonal: vec4<f32>, above: vec4<f32>) -> Rows {
    // The factor 2 / (squared length) replaces normalization.
    let twice = 2.0 * (1.0 / dot(real, real));
    let t = twice * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real;
    let u = diagonal;
    let x = vec3<f32>(
        1.0 - twice * (q.y * q.y + q.z * q.z), twice * (q.x * q.y - q.w * q.z), twice * (q.x * q.z + q.w * q.y));
    let y = vec3<f32>(
        twice * (q.x * q.y + q.w * q.z), 1.0 - twice * (q.x * q.x + q.z * q.z), twice * (q.y * q.z - q.w * q.x));
    let z = vec3<f32>(
        twice * (q.x * q.z - q.w * q.y), twice * (q.y * q.z + q.w * q.x), 1.0 - twice * (q.x * q.x + q.y * q.y));
    return Rows(
        vec4<f32>(x.x * u.x, x.x * above.x + x.y * u.y, x.x * above.y + x.y * above.z + x.z * u.z, t.x),
        vec4<f32>(y.x * u.x, y.x * above.x + y.y * u.y, y.x * above.y + y.y * above.z + y.z * u.z, t.y),
        vec4<f32>(z.x * u.x, z.x * above.x + z.y * u.y, z.x * above.y + z.y * above.z + z.z * u.z, t.z));
}

// `position`, transformed by an affine matrix.
fn placed_position(rows: Rows, position: vec3<f32>) -> vec3<f32> {
    let point = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(rows.x, point), dot(rows.y, point), dot(rows.z, point));
}

// `normal`, transformed by an affine matrix and not normalized. The transform uses the matrix's cofactors, so it is also
// correct for uneven scales. The result points inwards if the matrix mirrors.
fn placed_normal(rows: Rows, normal: vec3<f32>) -> vec3<f32> {
    let x = rows.x.xyz;
    let y = rows.y.xyz;
    let z = rows.z.xyz;
    return vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}
