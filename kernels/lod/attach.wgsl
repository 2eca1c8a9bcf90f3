// Placements of meshes that are attached to bones, in one view. A thread multiplies the transform of a character, the model
// matrix of the bone and the mesh's own offset. If no view of the frame sees the character, its bones are outdated, and the
// mesh becomes a point, which draws nothing. If the scene keeps its last frame, the thread also writes the transform that the
// mesh had in the last frame.
import package::wgsl::lod::allowed::Allowed;
import package::wgsl::affine::product_row;
import package::wgsl::dispatch::nonuniform;
import package::wgsl::lod::instance::{SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::view::SelectView;

// Parameters of the kernel `lod/attach`.
struct AttachParams {
    // Number of valid entries in `attachments`.
    attached: u32,
    // Number of bones of the character.
    bones: u32,
    // Index in the scene of the character's first instance.
    first: u32,
    // Index in `placements` of the last frame's first transform, equal to the number of instances; 0 if the last frame is not
    // kept.
    first_last: u32,
    // Number of the frame, counted from 1.
    frame: u32,
    // Number of the previous frame; 0 if its data is not known.
    last_frame: u32,
}

// `Attachment.mesh` of an unused entry.
const NO_MESH: u32 = 0xffffffffu;

// A mesh that is attached to a bone.
struct Attachment {
    // Index in the scene of the mesh's instance.
    mesh: u32,
    // Index of the character's instance, counted from the character's first one.
    character: u32,
    // Index of the bone.
    bone: u32,
    // Key of the attachment. No other attachment has the same key, now or later.
    key: u32,
    // Transform from the mesh's space to the bone's space, three rows.
    offset: array<vec4<f32>, 3>,
}

// Transform that a bone gave to an attached mesh in an earlier frame.
struct KeptBone {
    // Product of the bone's model matrix and the mesh's offset, three rows.
    rows: array<vec4<f32>, 3>,
    // Number of the frame in which the bone had this transform; 0 for none.
    frame: u32,
    // Key of the attachment.
    key: u32,
    // Padding, not read.
    unused_a: u32,
    // Padding, not read.
    unused_b: u32,
}

// Parameters of the kernel.
@group(0) @binding(0) var<uniform> params: AttachParams;
// The view for which placements are written.
@group(0) @binding(1) var<uniform> view: SelectView;
// Attached meshes. Only the first `AttachParams::attached` entries are valid.
@group(0) @binding(2) var<storage, read> attachments: array<Attachment>;
// Model matrices: three rows per bone of each instance of the character.
@group(0) @binding(3) var<storage, read> model_matrices: array<vec4<f32>>;
// All instances of the scene.
@group(0) @binding(4) var<storage, read> instances: array<SceneInstance>;
// Per instance of the scene: the displacement that the frame's views allow; negative if no view sees the instance.
// length: instances
@group(0) @binding(5) var<storage, read> allowed: array<Allowed>;
// Three rows per instance of the scene: the transform from model space to positions relative to the corner of the view's cell.
// From index `first_last` on: the last frame's transforms, relative to the corner of the same cell. Out: the rows of attached
// meshes.
// length: placements
@group(0) @binding(6) var<storage, read_write> placements: array<array<vec4<f32>, 3>>;
// All instances of the scene in the state of the last frame. If the last frame is not kept, this is the same buffer as
// `instances`.
// length: instances
@group(0) @binding(7) var<storage, read> last_instances: array<SceneInstance>;
// Two entries per attachment, initially zero: the bone's transform in even frames and in odd frames.
// length: 2 * attachments
@group(0) @binding(8) var<storage, read_write> kept: array<KeptBone>;

// Writes the product of an instance's placement and `local`, a transform in the instance's space, to `placements[to]`. If
// `is_seen` is false, writes a point.
fn write_placed(instance: SceneInstance, local: array<vec4<f32>, 3>, to: u32, is_seen: bool) {
    let axes = instance_axes(instance);
    let at = instance_position(instance, view.cell);
    for (var row = 0u; row < 3u; row++) {
        let placed = vec4<f32>(axes.x[row], axes.y[row], axes.z[row], at[row]);
        let moved = product_row(placed, local[0], local[1], local[2]);
        placements[to][row] = select(vec4<f32>(0.0, 0.0, 0.0, at[row]), moved, is_seen);
    }
}

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= params.attached || attachments[index].mesh == NO_MESH {
        return;
    }
    let attachment = attachments[index];
    let character = params.first + attachment.character;
    let bone = 3u * (attachment.character * params.bones + attachment.bone);
    let offset = attachment.offset;
    let local = array<vec4<f32>, 3>(
        product_row(model_matrices[bone], offset[0], offset[1], offset[2]),
        product_row(model_matrices[bone + 1u], offset[0], offset[1], offset[2]),
        product_row(model_matrices[bone + 2u], offset[0], offset[1], offset[2]));
    let is_seen = allowed[character].displacement >= 0.0;
    write_placed(instances[character], local, attachment.mesh, is_seen);
    if nonuniform(params.first_last, index) == 0u {
        return;
    }
    // All views of a frame write equal values, and read only entries that no view of the frame writes.
    let last = kept[2u * index + ((params.frame + 1u) & 1u)];
    var last_local = local;
    if nonuniform(params.last_frame, index) != 0u && last.frame == params.last_frame && last.key == attachment.key {
        last_local = last.rows;
    }
    write_placed(last_instances[character], last_local, params.first_last + attachment.mesh, is_seen);
    if is_seen {
        kept[2u * index + (params.frame & 1u)] = KeptBone(local, params.frame, attachment.key, 0u, 0u);
    }
}
