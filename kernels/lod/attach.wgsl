// Placements of meshes that are attached to bones: a thread gives one of them, in one view, the transform of its character
// with that of the bone and its own offset. Where no view of the frame sees the character, its bones are those of an earlier
// frame, and the mesh becomes a point, which draws nothing.
import package::wgsl::lod::instance::{SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::view::SelectView;

struct AttachParams {
    // Number of attached meshes.
    attached: u32,
    // Number of bones of the character.
    bones: u32,
    // The index in the scene of the character's first instance.
    first: u32,
}

// A mesh that is attached to a bone.
struct Attachment {
    // The index in the scene of the mesh's instance.
    mesh: u32,
    // The instance of the character, counted from its first one.
    character: u32,
    // The index of the bone.
    bone: u32,
    // No meaning: elements have no padding.
    unused: u32,
    // The transform from the mesh's space to the bone's, three rows.
    offset: array<vec4<f32>, 3>,
}

@group(0) @binding(0) var<uniform> params: AttachParams;
@group(0) @binding(1) var<uniform> view: SelectView;
@group(0) @binding(2) var<storage, read> attachments: array<Attachment>;
// Three rows per bone of each instance of the character.
@group(0) @binding(3) var<storage, read> model_matrices: array<vec4<f32>>;
// All instances of the scene.
@group(0) @binding(4) var<storage, read> instances: array<SceneInstance>;
// For each instance of the scene what the views of the frame allow; negative if none sees it.
@group(0) @binding(5) var<storage, read> allowed: array<f32>;
// For each instance of the scene three rows: the transform from the model's space to the corner of the view's cell.
@group(0) @binding(6) var<storage, read_write> rows: array<vec4<f32>>;

// A row of the product of two transforms, from a row of the first and all of the second.
fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

@compute @workgroup_size(64)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = (group.y * groups.x + group.x) * 64u + lane;
    if index >= params.attached {
        return;
    }
    let attachment = attachments[index];
    let character = params.first + attachment.character;
    let instance = instances[character];
    let axes = instance_axes(instance);
    let at = instance_position(instance, view.cell);
    let bone = 3u * (attachment.character * params.bones + attachment.bone);
    let offset = attachment.offset;
    let x = product_row(model_matrices[bone], offset[0], offset[1], offset[2]);
    let y = product_row(model_matrices[bone + 1u], offset[0], offset[1], offset[2]);
    let z = product_row(model_matrices[bone + 2u], offset[0], offset[1], offset[2]);
    let is_seen = allowed[character] >= 0.0;
    for (var row = 0u; row < 3u; row++) {
        let placed = vec4<f32>(axes.x[row], axes.y[row], axes.z[row], at[row]);
        let moved = product_row(placed, x, y, z);
        rows[3u * attachment.mesh + row] = select(vec4<f32>(0.0, 0.0, 0.0, at[row]), moved, is_seen);
    }
}
