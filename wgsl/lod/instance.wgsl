// Instances as a scene stores them on the device.

// Edge length of a cell, in world units. A position consists of a cell index and an offset, so that it stays precise far from
// the origin.
const CELL_SIZE: f32 = 256.0;

// Instance flag: the instance exists.
const INSTANCE_ALIVE = 1u;
// Instance flag: the instance casts shadows.
const INSTANCE_CASTS = 2u;
// Instance flag: the instance is a character with an attached mesh. No displacement is allowed to its bones, so the gate that
// bounds errors samples them in every frame in which a view sees the character.
const INSTANCE_CARRIES = 4u;
// Instance flag: the instance is a mesh that is attached to a bone. Its placement is stored only per view, as rows of a matrix.
const INSTANCE_FOLLOWS = 8u;
// Instance flag: the instance is a character that needs all bones of its skeleton, because the host drives bones or layers are
// blended. It keeps skeleton tier 0.
const INSTANCE_WHOLE = 16u;
// Word of `SceneInstance.flags`: the instance flags, and the visibility mask.
// packed InstanceFlags: bits 16, mask 16

// An instance of an object: its placement, flags and tint.
struct SceneInstance {
    // Cell that contains the instance's position.
    cell: vec3<i32>,
    // Instance flags (`INSTANCE_ALIVE`, `INSTANCE_CASTS`, `INSTANCE_CARRIES`, `INSTANCE_FOLLOWS`, `INSTANCE_WHOLE`) in the lower
    // 16 bits. The upper 16 bits are the visibility mask.
    flags: u32,
    // Position of the instance relative to the cell's corner, in world units.
    offset: vec3<f32>,
    // User data: a word that the caller's shading function reads.
    user_data: u32,
    // Rotation: a unit quaternion (x, y, z, w).
    rotation: vec4<f32>,
    // Scale factors along the model's axes, applied before the rotation. Negative factors mirror.
    scale: vec3<f32>,
    // Tint that multiplies the instance's colours: red, green, blue and alpha, 8 bits each, red in the lowest byte.
    tint: u32,
    // Sphere around everything that the instance may draw, in model space: center (xyz) and radius (w).
    bounding_sphere: vec4<f32>,
}

// Linear part of a transform from model to world space, as columns.
struct Axes {
    // Image of the model's x axis.
    x: vec3<f32>,
    // Image of the model's y axis.
    y: vec3<f32>,
    // Image of the model's z axis.
    z: vec3<f32>,
}

// Linear part of an instance's transform: first the scale, then the rotation.
fn instance_axes(instance: SceneInstance) -> Axes {
    let q = instance.rotation;
    let s = instance.scale;
    let x = vec3<f32>(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.w * q.z), 2.0 * (q.x * q.z - q.w * q.y));
    let y = vec3<f32>(2.0 * (q.x * q.y - q.w * q.z), 1.0 - 2.0 * (q.x * q.x + q.z * q.z), 2.0 * (q.y * q.z + q.w * q.x));
    let z = vec3<f32>(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Axes(s.x * x, s.y * y, s.z * z);
}

// Position of an instance relative to the corner of `cell`, in world units.
fn instance_position(instance: SceneInstance, cell: vec3<i32>) -> vec3<f32> {
    return vec3<f32>(instance.cell - cell) * CELL_SIZE + instance.offset;
}
