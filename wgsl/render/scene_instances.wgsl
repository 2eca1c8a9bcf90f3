// Instances of the object that is drawn: where they are in a view, and where they were.
import package::wgsl::lod::instance::{INSTANCE_FOLLOWS, SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::object::list_entry_instance;
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, triangle_surface};
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position};

// For each instance of the scene the transform from the model's space to positions relative to the corner of the view's cell,
// three rows. Those of instances that the view sees are written. If the scene keeps its last frame, as many follow: the
// transforms of that frame. Those of meshes that are attached to bones are written.
@group(0) @binding(1) var<storage, read> placements: array<array<vec4<f32>, 3>>;
// All instances of the scene.
@group(0) @binding(2) var<storage, read> instances: array<SceneInstance>;
// All instances of the scene as they were in the last frame, if it keeps it; else as they are.
@group(0) @binding(3) var<storage, read> last_instances: array<SceneInstance>;

// Where the instances of an object lie.
struct SceneObject {
    // The index in the scene of its first instance here.
    first_instance: u32,
    // Its number, from 1 on.
    number: u32,
    // The number in the object of its first instance here.
    first_slot: u32,
}

@group(1) @binding(0) var<uniform> scene_object: SceneObject;

// Determinants below this have no inverse.
const LEAST_DETERMINANT: f32 = 1e-30;

// The instance of a list's entry, counted from the object's first one here.
fn entry_instance(entry: u32) -> u32 {
    return list_entry_instance(entry);
}

// The index in the scene of the instance of a list's entry.
fn instance_index(entry: u32) -> u32 {
    return scene_object.first_instance + entry_instance(entry);
}

// The transform of an instance from the model's space to positions relative to the corner of the view's cell.
fn instance_placement(index: u32) -> Rows {
    return Rows(placements[index][0], placements[index][1], placements[index][2]);
}

// The same as it was in the last frame. A mesh that was attached to a bone and is no longer counts as if it had been where it
// is.
fn last_placement(index: u32) -> Rows {
    let instance = last_instances[index];
    if (instance.flags & INSTANCE_FOLLOWS) != 0u {
        let follows = (instances[index].flags & INSTANCE_FOLLOWS) != 0u;
        return instance_placement(index + select(0u, arrayLength(&last_instances), follows));
    }
    let axes = instance_axes(instance);
    let at = instance_position(instance, view.cell);
    return Rows(
        vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x),
        vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y),
        vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
}

// The transform from where an instance is to where it was, for what does not move in the model's space.
fn rows_to_last(index: u32) -> Rows {
    let now = instance_placement(index);
    let last = last_placement(index);
    // The columns of the inverse, times the determinant.
    let a = cross(now.y.xyz, now.z.xyz);
    let b = cross(now.z.xyz, now.x.xyz);
    let c = cross(now.x.xyz, now.y.xyz);
    let determinant = dot(now.x.xyz, a);
    let moved = vec3<f32>(last.x.w, last.y.w, last.z.w);
    let at = vec3<f32>(now.x.w, now.y.w, now.z.w);
    var x = vec3<f32>(1.0, 0.0, 0.0);
    var y = vec3<f32>(0.0, 1.0, 0.0);
    var z = vec3<f32>(0.0, 0.0, 1.0);
    if abs(determinant) > LEAST_DETERMINANT {
        x = vec3<f32>(dot(last.x.xyz, a), dot(last.x.xyz, b), dot(last.x.xyz, c)) / determinant;
        y = vec3<f32>(dot(last.y.xyz, a), dot(last.y.xyz, b), dot(last.y.xyz, c)) / determinant;
        z = vec3<f32>(dot(last.z.xyz, a), dot(last.z.xyz, b), dot(last.z.xyz, c)) / determinant;
    }
    return Rows(
        vec4<f32>(x, moved.x - dot(x, at)), vec4<f32>(y, moved.y - dot(y, at)), vec4<f32>(z, moved.z - dot(z, at)));
}

// Where a point of the model's space was in the last frame, relative to the corner of the view's cell: `position` is where the
// point was in the model's space then.
fn scene_last_placed(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(last_placement(instance_index(entry)), position);
}

// Where a point was in the last frame that does not move in the model's space; both are relative to the corner of the view's
// cell.
fn scene_last_rigid(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(rows_to_last(instance_index(entry)), position);
}

// A vertex given in the model's space, at the placement of the instance of a list's entry. The tangent's w is the side of the
// bitangent in the model's space.
fn scene_placed(entry: u32, position: vec3<f32>, normal: vec3<f32>, tangent: vec4<f32>, uv: vec4<f32>) -> SceneVertex {
    let placement = instance_placement(instance_index(entry));
    let along = vec3<f32>(
        dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    // Cofactors turn the normal inwards where the placement mirrors, which also changes the bitangent's side.
    let side = select(1.0, -1.0, determinant < 0.0);
    return SceneVertex(
        placed_position(placement, position), side * placed_normal(placement, normal),
        vec4<f32>(along, side * tangent.w), uv, vec4<f32>(0.0), vec3<u32>(0u), side);
}

// A white, opaque, lit surface of the triangle itself, on the side that is seen, with the tint, the user data and the
// number of its instance. The colour does not contain the tint yet.
fn scene_surface(in: SceneFragment) -> Surface {
    var surface = triangle_surface(in);
    let side = select(-1.0, 1.0, in.is_outside);
    surface.normal *= side;
    surface.geometric_normal *= side;
    let index = scene_object.first_instance + in.instance;
    surface.tint = unpack4x8unorm(instances[index].tint);
    surface.user_data = instances[index].user_data;
    surface.object = scene_object.number;
    surface.instance = scene_object.first_slot + in.instance;
    return surface;
}
