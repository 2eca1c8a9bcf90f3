// Skinning (thesis A section 8.4): transforms vertices by their bones, with the number of influences in each instance's
// InstanceLod. Invisible instances, and vertices beyond an instance's level of detail, are skipped. A workgroup skins one listed
// cluster of one instance. In the list, instances vary faster than clusters, so that a cluster's vertices stay in the cache.
import package::wgsl::skinning::cluster::{CLUSTER, CLUSTER_FRESH};
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};
import package::wgsl::skinning::page::NO_PAGE;
import package::wgsl::skinning::rows::{Rows, rows_of_dual, unit_or};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position};

// Whether the palette holds dual quaternions and stretches instead of matrices.
override DUAL: bool = false;
// Whether each instance has morphed vertices of its own, in the layout of the output. If false, all instances use the mesh's
// vertices.
override MORPHED: bool = false;
// Whether the output lies in pages. If so, clusters without a page are skipped.
override PAGED: bool = false;
// Whether the positions of the last frame are kept; only with PAGED.
override KEEP: bool = false;

// Parameters of the kernel `skinning/skin`.
struct SkinParams {
    // Number of vertices of the mesh.
    vertices: u32,
    // Number of clusters of the mesh times number of instances.
    pairs: u32,
    // Number of bones of the skin.
    bones: u32,
    // Number of instances.
    instances: u32,
    // Index in `skinned` of the last positions, two pairs per vertex; used with KEEP.
    last: u32,
    // Number of clusters of the mesh at each level of detail.
    levels: array<vec4<u32>, MAX_LEVELS / 4u>,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: SkinParams;
// Vertices, five pairs of floats each: position, normal, tangent and handedness.
@group(0) @binding(1) var<storage, read> vertices: array<vec2<f32>>;
// Two words per cluster, for one skeleton tier after the other: the index of its influences, and the largest number of influences
// per vertex. Influences are columns
// of CLUSTER words: first the bones, two per word, then the weights of all but the strongest bone, in descending order.
@group(0) @binding(2) var<storage, read> influences: array<u32>;
// Three rows per bone and instance. With DUAL, four vectors per bone and instance.
@group(0) @binding(3) var<storage, read> palette: array<vec4<f32>>;
// Level of detail of each instance.
@group(0) @binding(4) var<storage, read> instance_lods: array<InstanceLod>;
// Pairs to be skinned: cluster * instances + instance. With KEEP, the state of every pair follows, as written by
// skinning/select.
@group(0) @binding(5) var<storage, read> pairs: array<u32>;
// Numbers of workgroups of the dispatch (xyz), and the number of pairs (w).
@group(0) @binding(6) var<storage, read> dispatched: vec4<u32>;
// Out: skinned vertices in the layout of `vertices`, instance by instance or page by page. With KEEP, the last positions
// follow, two pairs per vertex; the fourth number is unused.
@group(0) @binding(7) var<storage, read_write> skinned: array<vec2<f32>>;
// Page of each cluster of each instance, with PAGED.
@group(0) @binding(8) var<storage, read> page_table: array<u32>;

// A weighted sum of bones: three rows of a matrix, or with DUAL four vectors.
struct Sum {
    // Row for x; with DUAL, the rotation.
    a: vec4<f32>,
    // Row for y; with DUAL, the dual part.
    b: vec4<f32>,
    // Row for z; with DUAL, the diagonal of the stretch.
    c: vec4<f32>,
    // With DUAL, the elements of the stretch above the diagonal.
    d: vec4<f32>,
}

// Adds a bone, whose palette data begins at `at`, to a weighted sum. `side` is the bone's weight, negated if its quaternion and
// the strongest bone's quaternion lie in opposite hemispheres.
fn added(sum: Sum, at: u32, weight: f32, side: f32) -> Sum {
    if DUAL {
        return Sum(
            sum.a + side * palette[at], sum.b + side * palette[at + 1u],
            sum.c + weight * palette[at + 2u], sum.d + weight * palette[at + 3u]);
    }
    return Sum(
        sum.a + weight * palette[at], sum.b + weight * palette[at + 1u], sum.c + weight * palette[at + 2u], sum.d);
}

// Matrix of a weighted sum of bones.
fn matrix_of(sum: Sum) -> Rows {
    if DUAL {
        return rows_of_dual(sum.a, sum.b, sum.c, sum.d);
    }
    return Rows(sum.a, sum.b, sum.c);
}

// Blended matrix of a vertex. `column` is the index of the vertex's first word of influences, and `slots` the largest number of
// influences per vertex in the cluster.
fn blended(column: u32, slots: u32, first_bone: u32, instance_lod: InstanceLod) -> Rows {
    let stride = select(3u, 4u, DUAL);
    var bones = influences[column];
    let strongest = stride * (first_bone + (bones & 0xffffu));
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
        while weight > taken {
            if (slot & 1u) == 0u {
                bones = influences[column + (CLUSTER / 2u) * slot];
            }
            let at = stride * (first_bone + select(bones & 0xffffu, bones >> 16u, (slot & 1u) == 1u));
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
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
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
    let rows = blended(
        influences[header] + lane, influences[header + 1u], instance * params.bones, instance_lod);
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
    // First row of the cofactor matrix; the other rows follow below.
    let of_x = cross(y, z);
    let side = select(1.0, -1.0, dot(x, of_x) < 0.0);
    let normal = unit_or(
        side * vec3<f32>(dot(of_x, old_normal), dot(cross(z, x), old_normal), dot(cross(x, y), old_normal)), old_normal);
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
