// Shares out the allowed displacement of each instance of a character: among its bones (for gates) and its influences (for
// skinning). The mesh is skinned at the finest level that is drawn. A thread handles one instance.
import package::wgsl::animation::gate_state::{FULL_WEIGHT, LOD_HIDDEN, Lod, OMEGA_ONE};
import package::wgsl::lod::instance::{INSTANCE_CARRIES, SceneInstance};
import package::wgsl::skinning::instance_lod::InstanceLod;

// Steps to which the influence fade is rounded: an instance that hardly moves keeps its fade.
const FADE_STEPS: f32 = 64.0;
// The largest `Lod::allowed`: exact in an f32, and below the motion of a whole clip, 2^30.
const MAX_UNITS: f32 = 1073741760.0;

struct AssignParams {
    // The index of the object's first instance in `allowed`.
    first: u32,
    // Number of instances.
    instances: u32,
    // The fraction of the allowed displacement that unsampled bones may use, 0 to 1.
    bone_fraction: f32,
    // The fraction that influence fades may use, 0 to 1.
    influence_fraction: f32,
    // The unit of the gate's table in the model's units, above 0.
    unit: f32,
    // Largest displacement of a vertex whose influences have faded completely, in model units, at least 0.
    stray: f32,
    // Largest number of influences of a visible instance, 1 to 8.
    max_influences: u32,
}

@group(0) @binding(0) var<uniform> params: AssignParams;
// Per instance of the scene: the displacement that the frame's views allow, in model units; negative if no view sees it.
// length: instances
@group(0) @binding(1) var<storage, read> allowed: array<f32>;
// Out, per instance of the object: the input of gates.
// length: instances
@group(0) @binding(2) var<storage, read_write> lods: array<Lod>;
// Out, per instance of the object: the input of skinning.
// length: instances
@group(0) @binding(3) var<storage, read_write> instance_lods: array<InstanceLod>;
// All instances of the scene.
// length: instances
@group(0) @binding(4) var<storage, read> instances: array<SceneInstance>;
// Per instance of the scene: the finest level that the frame's views draw.
// length: instances
@group(0) @binding(5) var<storage, read> finest: array<u32>;

// Influence fade that the budget permits, 0 to 1; 1 if a complete fade displaces nothing.
fn fade_within(within: f32) -> f32 {
    let faded = floor(FADE_STEPS * min(params.influence_fraction * within / params.stray, 1.0)) / FADE_STEPS;
    return select(faded, 1.0, params.stray <= 0.0);
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let instance = id.y * groups.x * 64u + id.x;
    if instance >= params.instances {
        return;
    }
    let within = allowed[params.first + instance];
    if within < 0.0 {
        lods[instance] = Lod(OMEGA_ONE, 0u, FULL_WEIGHT, LOD_HIDDEN);
        instance_lods[instance] = InstanceLod(0.0, 0u, 0u);
        return;
    }
    // An attached mesh may reach further from its bone than the vertices that the gate's table covers. Its character's bones
    // get no budget.
    let carries = (instances[params.first + instance].flags & INSTANCE_CARRIES) != 0u;
    let units = u32(min(floor(params.bone_fraction * within / params.unit), MAX_UNITS));
    lods[instance] = Lod(OMEGA_ONE, select(units, 0u, carries), FULL_WEIGHT, 0u);
    instance_lods[instance] = InstanceLod(fade_within(within), params.max_influences, finest[params.first + instance]);
}
