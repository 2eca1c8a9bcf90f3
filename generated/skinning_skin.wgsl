// relievo skinning/skin: generated from kernels/skinning/skin.wgsl

const CLUSTER: u32 = 64u;

const CLUSTER_STILL: u32 = 0u;

const CLUSTER_MOVED: u32 = 1u;

const CLUSTER_FRESH: u32 = 2u;

struct InstanceLod {
    influence_fade: f32,
    max_influences: u32,
    mesh_lod: u32,
    tier: u32
}

const MAX_LEVELS: u32 = 16u;

const NO_PAGE: u32 = 4294967295u;

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

fn vertex_position(first: vec2<f32>, second: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(first, second.x);
}

fn vertex_normal(second: vec2<f32>, third: vec2<f32>) -> vec3<f32> {
    return vec3<f32>(second.y, third);
}

fn vertex_tangent(fourth: vec2<f32>, fifth: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(fourth, fifth);
}

override DUAL: bool = false;

override MORPHED: bool = false;

override PAGED: bool = false;

override KEEP: bool = false;

struct SkinParams {
    vertices: u32,
    pairs: u32,
    bones: u32,
    instances: u32,
    last: u32,
    levels: array<vec4<u32>, MAX_LEVELS / 4u>
}

@group(0) @binding(0)
var<uniform> params: SkinParams;

@group(0) @binding(1)
var<storage, read> vertices: array<vec2<f32>>;

@group(0) @binding(2)
var<storage, read> influences: array<u32>;

@group(0) @binding(3)
var<storage, read> palette: array<vec4<f32>>;

@group(0) @binding(4)
var<storage, read> instance_lods: array<InstanceLod>;

@group(0) @binding(5)
var<storage, read> pairs: array<u32>;

@group(0) @binding(6)
var<storage, read> dispatched: vec4<u32>;

@group(0) @binding(7)
var<storage, read_write> skinned: array<vec2<f32>>;

@group(0) @binding(8)
var<storage, read> page_table: array<u32>;

struct Sum {
    a: vec4<f32>,
    b: vec4<f32>,
    c: vec4<f32>,
    d: vec4<f32>
}

fn added(sum: Sum, at: u32, weight: f32, side: f32) -> Sum {
    if DUAL {
        return Sum(sum.a + side * palette[at], sum.b + side * palette[at + 1u], sum.c + weight * palette[at + 2u], sum.d + weight * palette[at + 3u]);
    }
    return Sum(sum.a + weight * palette[at], sum.b + weight * palette[at + 1u], sum.c + weight * palette[at + 2u], sum.d);
}

fn matrix_of(sum: Sum) -> Rows {
    if DUAL {
        return rows_of_dual(sum.a, sum.b, sum.c, sum.d);
    }
    return Rows(sum.a, sum.b, sum.c);
}

fn blended(column: u32, slots: u32, first_bone: u32, instance_lod: InstanceLod) -> Rows {
    let stride = select(3u, 4u, DUAL);
    var bones = influences[column];
    let strongest = stride * (first_bone + (bones & 65535u));
    var sum = Sum(vec4<f32>(0.0), vec4<f32>(0.0), vec4<f32>(0.0), vec4<f32>(0.0));
    var others = 0.0;
    let most = clamp(instance_lod.max_influences, 1u, slots);
    if most > 1u {
        let weights = column + CLUSTER * ((slots + 1u) / 2u) - CLUSTER;
        var lost = 0.0;
        for (var slot = most; slot < slots; slot++) {
            lost += bitcast<f32>(influences[weights + CLUSTER * slot]);
        }
        let scale = 1.0 / (1.0 - lost);
        var real = vec4<f32>(0.0);
        if DUAL {
            real = palette[strongest];
        }
        var weight = bitcast<f32>(influences[weights + CLUSTER]);
        let taken = instance_lod.influence_fade * weight;
        var slot = 1u;
        while (weight > taken) {
            if (slot & 1u) == 0u {
                bones = influences[column + (CLUSTER / 2u) * slot];
            }
            let at = stride * (first_bone + select(bones & 65535u, bones >> 16u, (slot & 1u) == 1u));
            let left = (weight - taken) * scale;
            others += left;
            var side = left;
            if DUAL {
                side = select(left, -left, dot(palette[at], real) < 0.0);
            }
            sum = added(sum, at, left, side);
            slot++;
            if slot >= most {
                break;
            }
            weight = bitcast<f32>(influences[weights + CLUSTER * slot]);
        }
    }
    let left = 1.0 - others;
    return matrix_of(added(sum, strongest, left, left));
}

@compute @workgroup_size(CLUSTER)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let listed = group.y * groups.x + group.x;
    if listed >= dispatched.w {
        return;
    }
    let pair = pairs[listed];
    let cluster = pair / params.instances;
    let instance = pair - cluster * params.instances;
    let vertex = CLUSTER * cluster + lane;
    if pair >= params.pairs || vertex >= params.vertices {
        return;
    }
    let instance_lod = instance_lods[instance];
    let level = min(instance_lod.mesh_lod, MAX_LEVELS - 1u);
    if instance_lod.max_influences == 0u || cluster >= params.levels[level >> 2u][level & 3u] {
        return;
    }
    var to = 5u * (instance * params.vertices + vertex);
    if PAGED {
        let page = page_table[instance * ((params.vertices + CLUSTER - 1u) / CLUSTER) + cluster];
        if page == NO_PAGE {
            return;
        }
        to = 5u * (CLUSTER * page + lane);
    }
    let header = 2u * (instance_lod.tier * ((params.vertices + CLUSTER - 1u) / CLUSTER) + cluster);
    let rows = blended(influences[header] + lane, influences[header + 1u], instance * params.bones, instance_lod);
    let first = select(5u * vertex, to, MORPHED);
    let a = vertices[first];
    let b = vertices[first + 1u];
    let c = vertices[first + 2u];
    let d = vertices[first + 3u];
    let e = vertices[first + 4u];
    let old = vertex_position(a, b);
    let old_normal = vertex_normal(b, c);
    let along = vec3<f32>(d, e.x);
    let x = rows.x.xyz;
    let y = rows.y.xyz;
    let z = rows.z.xyz;
    let position = vec3<f32>(dot(x, old) + rows.x.w, dot(y, old) + rows.y.w, dot(z, old) + rows.z.w);
    let of_x = cross(y, z);
    let side = select(1.0, -1.0, dot(x, of_x) < 0.0);
    let normal = unit_or(side * vec3<f32>(dot(of_x, old_normal), dot(cross(z, x), old_normal), dot(cross(x, y), old_normal)), old_normal);
    let tangent = unit_or(vec3<f32>(dot(x, along), dot(y, along), dot(z, along)), along);
    if KEEP {
        let kept = params.last + 2u * (to / 5u);
        let is_fresh = pairs[params.pairs + pair] == CLUSTER_FRESH;
        let before = vertex_position(skinned[to], skinned[to + 1u]);
        let last_position = select(before, position, is_fresh);
        skinned[kept] = last_position.xy;
        skinned[kept + 1u] = vec2<f32>(last_position.z, 0.0);
    }
    skinned[to] = position.xy;
    skinned[to + 1u] = vec2<f32>(position.z, normal.x);
    skinned[to + 2u] = normal.yz;
    skinned[to + 3u] = tangent.xy;
    skinned[to + 4u] = vec2<f32>(tangent.z, side * e.y);
}
