// From relievo's wgsl/skinning/module.wgsl.
// Skinning functions for vertex shaders: to draw skinned vertices at their placements, or to skin vertices from a palette in
// the shader. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend
// that text to your own code.

// From relievo's wgsl/affine.wgsl.
// Affine transforms, stored as three rows.

// One row of the product of two transforms. `row` is a row of the first transform; `x`, `y` and `z` are all rows of the second.
fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

// From relievo's wgsl/skinning/cluster.wgsl.
// Clusters: groups of consecutive vertices that are skinned together.

// Number of vertices in a cluster. A column of influences has the same number of words, one per vertex.
const CLUSTER: u32 = 64u;

// Cluster state: not skinned in this frame, so its last positions equal the current ones. States exist only if last positions
// are kept.
const CLUSTER_STILL: u32 = 0u;
// Cluster state: skinned in this frame. Its last positions come from the last frame.
const CLUSTER_MOVED: u32 = 1u;
// Cluster state: skinned for the first time, or again after it was invisible. Its last positions equal the current ones.
const CLUSTER_FRESH: u32 = 2u;

// From relievo's wgsl/skinning/instance_lod.wgsl.
// Level of detail of one instance in skinning: the influences per vertex, and the mesh level.
struct InstanceLod {
    // Fraction by which weak bone influences are faded out: 0 is full quality, 1 is rigid (one bone per vertex). Also called λ;
    // see `fade`.
    influence_fade: f32,
    // Largest number of influences per vertex, at least 1. Also called k; see `truncate`. 0 means that the instance is
    // invisible and is not skinned.
    max_influences: u32,
    // Level of detail of the character's meshes. At level 0, the meshes themselves are drawn. At level n, each mesh uses the
    // coarsest of its `Mesh::levels` whose error is at most the n-th of `level_errors`. Larger values than the last level count
    // as the last level.
    mesh_lod: u32,
    // Tier of the skeleton that vertices follow; 0 is the whole skeleton.
    tier: u32,
}

// Largest number of levels of detail of a mesh, the mesh itself included.
const MAX_LEVELS: u32 = 16u;

// From relievo's wgsl/skinning/page.wgsl.
// Pages of skinned vertices. A page holds the vertices of one cluster of one instance.

// Page index of a cluster that has no page.
const NO_PAGE: u32 = 4294967295u;

// From relievo's wgsl/skinning/rows.wgsl.
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

// From relievo's wgsl/skinning/vertex.wgsl.
// Layout of skinned and unskinned vertices in the kernels' buffers: five pairs of floats, one after the other.

// Position in metres, in model space, from the first and second pair of a vertex.
fn vertex_position(first: vec2<f32>, second: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(first, second.x);
}

// Unit normal, from the second and third pair of a vertex.
fn vertex_normal(second: vec2<f32>, third: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(second.y, third);
}

// Unit tangent (xyz), from the fourth and fifth pair of a vertex. w is 1 or -1; the bitangent is w · normal × tangent.
fn vertex_tangent(fourth: vec2<f32>, fifth: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(fourth, fifth);
}
