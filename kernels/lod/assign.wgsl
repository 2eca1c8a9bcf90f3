// Divides the allowed displacement of each instance of a character: a fraction for its bones (for gates) and a fraction for its
// influences (for skinning). The mesh is skinned at the finest level that a view draws. A thread handles one instance.
import package::wgsl::animation::gate_state::{FULL_WEIGHT, LOD_HIDDEN, Lod, OMEGA_ONE};
import package::wgsl::lod::instance::{INSTANCE_CARRIES, SceneInstance};
import package::wgsl::skinning::instance_lod::InstanceLod;

// Number of steps to which the influence fade is rounded, so that an instance that hardly moves keeps its fade.
const FADE_STEPS: f32 = 64.0;
// Largest `Lod::allowed`. It is exact in an f32, and below the motion of a whole clip, 2^30.
const MAX_UNITS: f32 = 1073741760.0;

// Parameters of the kernel `lod/assign`.
struct AssignParams {
    // Index in `allowed` of the object's first instance.
    first: u32,
    // Number of instances.
    instances: u32,
    // Fraction of the allowed displacement that unsampled bones may use, 0 to 1.
    bone_fraction: f32,
    // Fraction of the allowed displacement that influence fades may use, 0 to 1.
    influence_fraction: f32,
    // Unit of the gate's table in model units, above 0.
    unit: f32,
    // Largest displacement of a vertex whose influences have faded completely, in model units, at least 0.
    stray: f32,
    // Largest number of influences of a visible instance, 1 to 8.
    max_influences: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: AssignParams;
// Per instance of the scene: the displacement that the frame's views allow, in model units; negative if no view sees the
// instance.
// length: instances
@group(0) @binding(1) var<storage, read> allowed: array<f32>;
// Out, per instance of the object: the level of detail for gates.
// length: instances
@group(0) @binding(2) var<storage, read_write> lods: array<Lod>;
// Out, per instance of the object: the level of detail for skinning.
// length: instances
@group(0) @binding(3) var<storage, read_write> instance_lods: array<InstanceLod>;
// All instances of the scene.
// length: instances
@group(0) @binding(4) var<storage, read> instances: array<SceneInstance>;
// Per instance of the scene: the finest level that the frame's views draw.
// length: instances
@group(0) @binding(5) var<storage, read> finest: array<u32>;

// Largest influence fade, 0 to 1, that displaces vertices by at most `influence_fraction` times `within`. `within` is the
// allowed displacement in model units. The result is 1 if a complete fade displaces nothing.
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
    // An attached mesh may reach further from its bone than the vertices that the gate's table covers. Therefore, the allowed
    // displacement of bones is 0 for a character with an attached mesh.
    let carries = (instances[params.first + instance].flags & INSTANCE_CARRIES) != 0u;
    let units = u32(min(floor(params.bone_fraction * within / params.unit), MAX_UNITS));
    lods[instance] = Lod(OMEGA_ONE, select(units, 0u, carries), FULL_WEIGHT, 0u);
    instance_lods[instance] = InstanceLod(fade_within(within), params.max_influences, finest[params.first + instance]);
}
