// relievo lod/attach: generated from kernels/lod/attach.wgsl

fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}

fn nonuniform(value: u32, thread: u32) -> u32 {
    return select(0u, value, thread != 4294967295u);
}

fn rows_of_workgroups(groups: u32, most: u32) -> vec3<u32> {
    let x = clamp(groups, 1u, most);
    return vec3<u32>(x, (groups + x - 1u) / x, 1u);
}

const ALLOWED_MARGIN: f32 = 0.9999;

const MAX_ALLOWED: f32 = 1000000000.0;

const LEAST_SCALE: f32 = 1e-9;

struct Allowed {
    displacement: f32,
    distance: f32
}

const UNSEEN_ALLOWED: f32 = -1.0;

fn camera_allows(camera: LodCamera, center: vec3<f32>, radius: f32) -> f32 {
    if camera.perspective == 0.0 {
        return ALLOWED_MARGIN * (camera.pixels / camera.focal);
    }
    let towards = center - camera.eye;
    let ahead = dot(camera.ahead, towards);
    let aside = length(towards - ahead * camera.ahead);
    let around = radius + POSITION_SLACK * (length(center) + length(camera.eye) + radius);
    let is_behind = ahead + around < 0.0;
    let depth = select(ahead, length(towards), is_behind) - around;
    let across = select(aside + around, 0.0, is_behind);
    if depth <= camera.near {
        return 0.0;
    }
    let cosine = depth / sqrt(depth * depth + across * across);
    let allowed = ALLOWED_MARGIN * (camera.pixels * cosine * depth / (camera.focal + camera.pixels * cosine));
    return select(allowed, 0.0, depth - allowed <= camera.near);
}

fn allowed_in_model(allowed: f32, scale: f32) -> f32 {
    return min(allowed / max(scale, LEAST_SCALE), MAX_ALLOWED);
}

const CELL_SIZE: f32 = 256.0;

const INSTANCE_ALIVE = 1u;

const INSTANCE_CASTS = 2u;

const INSTANCE_CARRIES = 4u;

const INSTANCE_FOLLOWS = 8u;

const INSTANCE_WHOLE = 16u;

struct SceneInstance {
    cell: vec3<i32>,
    flags: u32,
    offset: vec3<f32>,
    user_data: u32,
    rotation: vec4<f32>,
    scale: vec3<f32>,
    tint: u32,
    bounding_sphere: vec4<f32>
}

struct Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>
}

fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}

fn instance_flags_word(bits: u32, mask: u32) -> u32 {
    return bits | (mask << 16u);
}

fn instance_flags_bits(word: u32) -> u32 {
    return word & 65535u;
}

fn instance_flags_mask(word: u32) -> u32 {
    return word >> 16u;
}

const VIEW_CAMERAS = 4u;

struct LodCamera {
    eye: vec3<f32>,
    focal: f32,
    ahead: vec3<f32>,
    pixels: f32,
    near: f32,
    perspective: f32,
    pixel_count: f32,
    unused: f32
}

struct SelectView {
    planes: array<vec4<f32>, 6>,
    cameras: array<LodCamera, 4>,
    cell: vec3<i32>,
    mask: u32,
    camera_count: u32,
    is_first: u32,
    casters: u32,
    blocks: u32,
    is_next: u32,
    seconds: f32,
    unused_a: u32,
    unused_b: u32,
    clip_rows: array<vec4<f32>, 3>,
    last_clip_rows: array<vec4<f32>, 3>
}

const POSITION_SLACK: f32 = 3e-6;

struct AttachParams {
    attached: u32,
    bones: u32,
    first: u32,
    first_last: u32,
    frame: u32,
    last_frame: u32
}

const NO_MESH: u32 = 4294967295u;

struct Attachment {
    mesh: u32,
    character: u32,
    bone: u32,
    key: u32,
    offset: array<vec4<f32>, 3>
}

struct KeptBone {
    rows: array<vec4<f32>, 3>,
    frame: u32,
    key: u32,
    unused_a: u32,
    unused_b: u32
}

@group(0) @binding(0)
var<uniform> params: AttachParams;

@group(0) @binding(1)
var<uniform> view: SelectView;

@group(0) @binding(2)
var<storage, read> attachments: array<Attachment>;

@group(0) @binding(3)
var<storage, read> model_matrices: array<vec4<f32>>;

@group(0) @binding(4)
var<storage, read> instances: array<SceneInstance>;

@group(0) @binding(5)
var<storage, read> allowed: array<Allowed>;

@group(0) @binding(6)
var<storage, read_write> placements: array<array<vec4<f32>, 3>>;

@group(0) @binding(7)
var<storage, read> last_instances: array<SceneInstance>;

@group(0) @binding(8)
var<storage, read_write> kept: array<KeptBone>;

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
    let local = array<vec4<f32>, 3>(product_row(model_matrices[bone], offset[0], offset[1], offset[2]), product_row(model_matrices[bone + 1u], offset[0], offset[1], offset[2]), product_row(model_matrices[bone + 2u], offset[0], offset[1], offset[2]));
    let is_seen = allowed[character].displacement >= 0.0;
    write_placed(instances[character], local, attachment.mesh, is_seen);
    if nonuniform(params.first_last, index) == 0u {
        return;
    }
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
