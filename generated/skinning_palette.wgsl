// relievo skinning/palette: generated from kernels/skinning/palette.wgsl

fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

struct Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>
}

const LEAST_LENGTH: f32 = 1e-30;

fn unit_or(vector: vec3<f32>, other: vec3<f32>) -> vec3<f32> {
    let size = max(max(abs(vector.x), abs(vector.y)), abs(vector.z));
    let scaled = vector / max(size, LEAST_LENGTH);
    return select(scaled * inverseSqrt(max(dot(scaled, scaled), 0.5)), other, size < LEAST_LENGTH);
}

fn rows_of_dual(real: vec4<f32>, dual: vec4<f32>, diagonal: vec4<f32>, above: vec4<f32>) -> Rows {
    let twice = 2.0 * (1.0 / dot(real, real));
    let t = twice * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
    let q = real;
    let u = diagonal;
    let x = vec3<f32>(1.0 - twice * (q.y * q.y + q.z * q.z), twice * (q.x * q.y - q.w * q.z), twice * (q.x * q.z + q.w * q.y));
    let y = vec3<f32>(twice * (q.x * q.y + q.w * q.z), 1.0 - twice * (q.x * q.x + q.z * q.z), twice * (q.y * q.z - q.w * q.x));
    let z = vec3<f32>(twice * (q.x * q.z - q.w * q.y), twice * (q.y * q.z + q.w * q.x), 1.0 - twice * (q.x * q.x + q.y * q.y));
    return Rows(vec4<f32>(x.x * u.x, x.x * above.x + x.y * u.y, x.x * above.y + x.y * above.z + x.z * u.z, t.x), vec4<f32>(y.x * u.x, y.x * above.x + y.y * u.y, y.x * above.y + y.y * above.z + y.z * u.z, t.y), vec4<f32>(z.x * u.x, z.x * above.x + z.y * u.y, z.x * above.y + z.y * above.z + z.z * u.z, t.z));
}

fn placed_position(rows: Rows, position: vec3<f32>) -> vec3<f32> {
    let point = vec4<f32>(position, 1.0);
    return vec3<f32>(dot(rows.x, point), dot(rows.y, point), dot(rows.z, point));
}

fn placed_normal(rows: Rows, normal: vec3<f32>) -> vec3<f32> {
    let x = rows.x.xyz;
    let y = rows.y.xyz;
    let z = rows.z.xyz;
    return vec3<f32>(dot(cross(y, z), normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
}

override DUAL: bool = false;

struct PaletteParams {
    bones: u32,
    all_bones: u32,
    pairs: u32
}

@group(0) @binding(0)
var<uniform> params: PaletteParams;

@group(0) @binding(1)
var<storage, read> bones: array<u32>;

@group(0) @binding(2)
var<storage, read> inverse_binds: array<vec4<f32>>;

@group(0) @binding(3)
var<storage, read> model_matrices: array<vec4<f32>>;

@group(0) @binding(4)
var<storage, read> instance_lods: array<InstanceLod>;

@group(0) @binding(5)
var<storage, read_write> palette: array<vec4<f32>>;

fn upright(v: vec3<f32>) -> vec3<f32> {
    let side = select(1.0, -1.0, v.z < 0.0);
    let a = -1.0 / (side + v.z);
    return vec3<f32>(1.0 + side * v.x * v.x * a, side * v.x * v.y * a, -side * v.x);
}

fn quaternion(x: vec3<f32>, y: vec3<f32>, z: vec3<f32>) -> vec4<f32> {
    let squares = vec4<f32>(1.0 + x.x - y.y - z.z, 1.0 - x.x + y.y - z.z, 1.0 - x.x - y.y + z.z, 1.0 + x.x + y.y + z.z);
    let xy = x.y + y.x;
    let yz = y.z + z.y;
    let zx = z.x + x.z;
    let with_w = vec3<f32>(y.z - z.y, z.x - x.z, x.y - y.x);
    var q = vec4<f32>(with_w, squares.w);
    if squares.w < 1.0 {
        if squares.x >= squares.y && squares.x >= squares.z {
            q = vec4<f32>(squares.x, xy, zx, with_w.x);
        }
        else if squares.y >= squares.z {
            q = vec4<f32>(xy, squares.y, yz, with_w.y);
        }
        else {
            q = vec4<f32>(zx, yz, squares.z, with_w.z);
        }
    }
    return q * inverseSqrt(dot(q, q));
}

fn write_dual(at: u32, rows: array<vec4<f32>, 3>) {
    let a = vec3<f32>(rows[0].x, rows[1].x, rows[2].x);
    let b = vec3<f32>(rows[0].y, rows[1].y, rows[2].y);
    let c = vec3<f32>(rows[0].z, rows[1].z, rows[2].z);
    let t = vec3<f32>(rows[0].w, rows[1].w, rows[2].w);
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
    let rows = array<vec4<f32>, 3>(product_row(model_matrices[model], x, y, z), product_row(model_matrices[model + 1u], x, y, z), product_row(model_matrices[model + 2u], x, y, z));
    if DUAL {
        write_dual(4u * pair, rows);
    }
    else {
        palette[3u * pair] = rows[0];
        palette[3u * pair + 1u] = rows[1];
        palette[3u * pair + 2u] = rows[2];
    }
}

fn skin_bone_word(index: u32, tier: u32) -> u32 {
    return index | (tier << 24u);
}

fn skin_bone_index(word: u32) -> u32 {
    return word & 16777215u;
}

fn skin_bone_tier(word: u32) -> u32 {
    return word >> 24u;
}
