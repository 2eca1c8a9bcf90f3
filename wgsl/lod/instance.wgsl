// Instances as a scene keeps them on the device.

// The edge of a cell in world units. A position is a whole number of cells and an offset, so that it stays precise far
// from the origin.
const CELL_SIZE: f32 = 256.0;

// The instance exists.
const INSTANCE_ALIVE = 1u;
// The instance casts shadows.
const INSTANCE_CASTS = 2u;
// The instance is a character that carries a mesh: its bones are sampled in every frame in which a view sees it.
const INSTANCE_CARRIES = 4u;
// The instance is a mesh that is attached to a bone: it has a placement only as rows in a view.
const INSTANCE_FOLLOWS = 8u;
// `SceneInstance.flags`: the bits above, and the visibility mask.
// packed InstanceFlags: bits 16, mask 16

// An instance of an object.
struct SceneInstance {
    // The cell that holds its position.
    cell: vec3<i32>,
    // `INSTANCE_ALIVE`, `INSTANCE_CASTS`, `INSTANCE_CARRIES`, `INSTANCE_FOLLOWS`, and in the upper 16 bits its visibility mask.
    flags: u32,
    // Its position in the cell, in world units.
    offset: vec3<f32>,
    // User data: a word that the caller's shading reads.
    user_data: u32,
    // A unit quaternion.
    rotation: vec4<f32>,
    // Scale factors along the model's axes, applied before the rotation; negative ones mirror.
    scale: vec3<f32>,
    // Tint that multiplies its colours: red, green, blue and alpha, 8 bits each, red in the lowest.
    tint: u32,
    // A sphere around everything that it may draw, in the model's space: center and radius.
    bounding_sphere: vec4<f32>,
}

// The columns of the model's linear transform into the world.
struct Axes {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

// Linear part of an instance's transform: the scale, then the rotation.
fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

// The position of an instance relative to the corner of another cell.
fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}
