// relievo animation/local_to_model: generated from kernels/animation/local_to_model.wgsl

fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

struct Slot {
    bone: u32,
    parent: u32,
    subtree: u32
}

struct Chain {
    first: u32,
    count: u32
}

const NO_PARENT: u32 = 4294967295u;

const CONTINUES: u32 = 4294967294u;

override COMPACTED: bool = false;

struct LocalToModelParams {
    instances: u32,
    bones: u32,
    words: u32,
    first_chain: u32,
    chains: u32,
    first_word: u32
}

@group(0) @binding(0)
var<uniform> params: LocalToModelParams;

@group(0) @binding(1)
var<storage, read> slots: array<Slot>;

@group(0) @binding(2)
var<storage, read> chains: array<Chain>;

@group(0) @binding(3)
var<storage, read> updated_bones: array<u32>;

@group(0) @binding(4)
var<storage, read> updated_instances: array<u32>;

@group(0) @binding(5)
var<storage, read> dispatches: array<vec4<u32>>;

@group(0) @binding(6)
var<storage, read> locals: array<vec4<f32>>;

@group(0) @binding(7)
var<storage, read_write> model_matrices: array<vec4<f32>>;

struct Rows {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>
}

fn joined(parent: Rows, bone: u32) -> Rows {
    let first = locals[bone];
    let q = locals[bone + 1u];
    let scale = vec3<f32>(first.w, locals[bone + 2u].xy);
    let d = q.xyz + q.xyz;
    let x = vec4<f32>(vec3<f32>(1.0 - (q.y * d.y + q.z * d.z), q.x * d.y - q.w * d.z, q.x * d.z + q.w * d.y) * scale, first.x);
    let y = vec4<f32>(vec3<f32>(q.x * d.y + q.w * d.z, 1.0 - (q.x * d.x + q.z * d.z), q.y * d.z - q.w * d.x) * scale, first.y);
    let z = vec4<f32>(vec3<f32>(q.x * d.z - q.w * d.y, q.y * d.z + q.w * d.x, 1.0 - (q.x * d.x + q.y * d.y)) * scale, first.z);
    let rows = Rows(product_row(parent.x, x, y, z), product_row(parent.y, x, y, z), product_row(parent.z, x, y, z));
    model_matrices[bone] = rows.x;
    model_matrices[bone + 1u] = rows.y;
    model_matrices[bone + 2u] = rows.z;
    return rows;
}

fn stored_rows(base: u32, bone: u32) -> Rows {
    if bone == NO_PARENT {
        return Rows(vec4<f32>(1.0, 0.0, 0.0, 0.0), vec4<f32>(0.0, 1.0, 0.0, 0.0), vec4<f32>(0.0, 0.0, 1.0, 0.0));
    }
    let at = 3u * (base + bone);
    return Rows(model_matrices[at], model_matrices[at + 1u], model_matrices[at + 2u]);
}

fn bone_above(slot: u32) -> u32 {
    let parent = slots[slot].parent;
    if parent == CONTINUES {
        return slots[slot - 1u].bone;
    }
    return parent;
}

fn next_updated(instance: u32, start: u32, end: u32) -> u32 {
    if start >= end {
        return end;
    }
    let first_word = params.first_word + instance * params.words;
    var word = start / 32u;
    var bits = updated_bones[first_word + word] & (4294967295u << (start % 32u));
    while (bits == 0u) {
        word++;
        if 32u * word >= end {
            return end;
        }
        bits = updated_bones[first_word + word];
    }
    return 32u * word + firstTrailingBit(bits);
}

fn walk_chain(instance: u32, chain: Chain) {
    let base = instance * params.bones;
    let end = chain.first + chain.count;
    var start = chain.first;
    if COMPACTED {
        start = next_updated(instance, start, end);
    }
    if start >= end {
        return;
    }
    var rows = stored_rows(base, bone_above(start));
    for (var slot = start; slot < end; slot++) {
        rows = joined(rows, 3u * (base + slots[slot].bone));
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    let place = index / params.chains;
    var instance = place;
    if COMPACTED {
        if place >= dispatches[0].w {
            return;
        }
        instance = updated_instances[place];
    }
    if instance < params.instances {
        walk_chain(instance, chains[params.first_chain + index - place * params.chains]);
    }
}
