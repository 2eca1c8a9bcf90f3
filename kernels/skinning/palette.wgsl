// Palettes: for each instance and bone of a skin, the matrix from bind space to model space. With DUAL, the matrix is
// decomposed into a stretch followed by a rigid motion. A thread computes one bone. Invisible instances are skipped, and so are
// bones of a skeleton tier that the instance does not use.
import package::wgsl::skinning::instance_lod::InstanceLod;
import package::wgsl::affine::product_row;
import package::wgsl::skinning::rows::{LEAST_LENGTH, unit_or};

// Whether palettes hold dual quaternions and stretches instead of matrices.
override DUAL: bool = false;

// Parameters of the kernel `skinning/palette`.
struct PaletteParams {
    // Number of bones of the skin.
    bones: u32,
    // Number of bones of the skeleton.
    all_bones: u32,
    // Number of bones of the skin times number of instances.
    pairs: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: PaletteParams;
// Bone word of each bone of the skin: its index in the skeleton, and the tier of the skeleton that it belongs to.
// packed SkinBone: index 24, tier 8
@group(0) @binding(1) var<storage, read> bones: array<u32>;
// Inverse bind matrices: three rows per bone of the skin.
@group(0) @binding(2) var<storage, read> inverse_binds: array<vec4<f32>>;
// Model matrices: three rows per bone of the skeleton and instance.
@group(0) @binding(3) var<storage, read> model_matrices: array<vec4<f32>>;
// Level of detail of each instance.
@group(0) @binding(4) var<storage, read> instance_lods: array<InstanceLod>;
// Out: three rows per bone of the skin and instance. With DUAL, four vectors: the rotation, the dual part, the diagonal of the
// stretch, and the elements of the stretch above the diagonal.
@group(0) @binding(5) var<storage, read_write> palette: array<vec4<f32>>;

// A unit vector perpendicular to the unit vector `v` (Duff et al. 2017).
fn upright(v: vec3<f32>) -> vec3<f32> {
    let side = select(1.0, -1.0, v.z < 0.0);
    let a = -1.0 / (side + v.z);
    return vec3<f32>(1.0 + side * v.x * v.x * a, side * v.x * v.y * a, -side * v.x);
}

// Unit quaternion of a rotation that is given by its columns. The sign of the quaternion is arbitrary.
fn quaternion(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> vec4<f32> {
    let squares = vec4<f32>(
        1.0 + x.x - y.y - z.z, 1.0 - x.x + y.y - z.z, 1.0 - x.x - y.y + z.z, 1.0 + x.x + y.y + z.z);
    let xy = x.y + y.x;
    let yz = y.z + z.y;
    let zx = z.x + x.z;
    let with_w = vec3<f32>(y.z - z.y, z.x - x.z, x.y - y.x);
    var q = vec4<f32>(with_w, squares.w);
    if squares.w < 1.0 {
        if squares.x >= squares.y && squares.x >= squares.z {
            q = vec4<f32>(squares.x, xy, zx, with_w.x);
        } else if squares.y >= squares.z {
            q = vec4<f32>(xy, squares.y, yz, with_w.y);
        } else {
            q = vec4<f32>(zx, yz, squares.z, with_w.z);
        }
    }
    return q * inverseSqrt(dot(q, q));
}

// Decomposes a matrix into a stretch and a rigid motion, and stores it as four vectors from `at` on.
fn write_dual(at: u32, rows: array<vec4<f32>, 3>) {
    let a = vec3<f32>(rows[0].x, rows[1].x, rows[2].x);
    let b = vec3<f32>(rows[0].y, rows[1].y, rows[2].y);
    let c = vec3<f32>(rows[0].z, rows[1].z, rows[2].z);
    let t = vec3<f32>(rows[0].w, rows[1].w, rows[2].w);
    // A column without direction is replaced by a direction that leaves the other columns unchanged.
    let x = unit_or(a, vec3<f32>(1.0, 0.0, 0.0));
    let along = dot(x, b);
    let y = unit_or(b - along * x, upright(x));
    let z = cross(x, y);
    let q = quaternion(x, y, z);
    palette[at] = q;
    palette[at + 1u] = 0.5 * vec4<f32>(t * q.w + cross(t, q.xyz), -dot(t, q.xyz));
    palette[at + 2u] = vec4<f32>(dot(x, a), dot(y, b), dot(z, c), 0.0);
    palette[at + 3u] = vec4<f32>(along, dot(x, c), dot(y, c), 0.0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let pair = id.y * groups.x * 64u + id.x;
    if pair >= params.pairs {
        return;
    }
    let instance = pair / params.bones;
    let bone = pair - instance * params.bones;
    let lod = instance_lods[instance];
    if lod.max_influences == 0u || lod.tier != skin_bone_tier(bones[bone]) {
        return;
    }
    let bind = 3u * bone;
    let x = inverse_binds[bind];
    let y = inverse_binds[bind + 1u];
    let z = inverse_binds[bind + 2u];
    let model = 3u * (instance * params.all_bones + skin_bone_index(bones[bone]));
    let rows = array<vec4<f32>, 3>(
        product_row(model_matrices[model], x, y, z),
        product_row(model_matrices[model + 1u], x, y, z),
        product_row(model_matrices[model + 2u], x, y, z));
    if DUAL {
        write_dual(4u * pair, rows);
    } else {
        palette[3u * pair] = rows[0];
        palette[3u * pair + 1u] = rows[1];
        palette[3u * pair + 2u] = rows[2];
    }
}
