// Concatenation into the model's space. A thread walks one chain of bones of one instance, the parent's matrix in
// registers; a dispatch serves the chains of one level, whose parents are done. With WHOLE, a thread walks all chains
// of its instance, one after another.

override WHOLE: bool = false;

struct ConcatParams {
    instances: u32,
    bones: u32,
    first_chain: u32,
    chains: u32,
}

@group(0) @binding(0) var<uniform> params: ConcatParams;
// First bone in `chain_bones`, how many, parent.
@group(0) @binding(1) var<storage, read> chains: array<vec4<u32>>;
@group(0) @binding(2) var<storage, read> chain_bones: array<u32>;
// Translation and scale x; rotation; scale y and z.
@group(0) @binding(3) var<storage, read> locals: array<vec4<f32>>;
// Three rows a bone.
@group(0) @binding(4) var<storage, read_write> models: array<vec4<f32>>;

const NO_PARENT = 0xffffffffu;

fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

fn walk(chain: vec4<u32>, base: u32) {
    var x = vec4<f32>(1.0, 0.0, 0.0, 0.0);
    var y = vec4<f32>(0.0, 1.0, 0.0, 0.0);
    var z = vec4<f32>(0.0, 0.0, 1.0, 0.0);
    if chain.z != NO_PARENT {
        let parent = 3u * (base + chain.z);
        x = models[parent];
        y = models[parent + 1u];
        z = models[parent + 2u];
    }
    for (var at = chain.x; at < chain.x + chain.y; at++) {
        let bone = 3u * (base + chain_bones[at]);
        let first = locals[bone];
        let q = locals[bone + 1u];
        let scale = vec3<f32>(first.w, locals[bone + 2u].xy);
        let d = q.xyz + q.xyz;
        let local_x = vec4<f32>(
            vec3<f32>(1.0 - (q.y * d.y + q.z * d.z), q.x * d.y - q.w * d.z, q.x * d.z + q.w * d.y) * scale, first.x);
        let local_y = vec4<f32>(
            vec3<f32>(q.x * d.y + q.w * d.z, 1.0 - (q.x * d.x + q.z * d.z), q.y * d.z - q.w * d.x) * scale, first.y);
        let local_z = vec4<f32>(
            vec3<f32>(q.x * d.z - q.w * d.y, q.y * d.z + q.w * d.x, 1.0 - (q.x * d.x + q.y * d.y)) * scale, first.z);
        x = product_row(x, local_x, local_y, local_z);
        y = product_row(y, local_x, local_y, local_z);
        z = product_row(z, local_x, local_y, local_z);
        models[bone] = x;
        models[bone + 1u] = y;
        models[bone + 2u] = z;
    }
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    let instance = select(index / params.chains, index, WHOLE);
    if instance >= params.instances {
        return;
    }
    let base = instance * params.bones;
    if WHOLE {
        for (var chain = 0u; chain < params.chains; chain++) {
            walk(chains[params.first_chain + chain], base);
        }
    } else {
        walk(chains[params.first_chain + index - instance * params.chains], base);
    }
}
