// Placements of the drawn instances in a view, in this frame and in the last frame.
import package::wgsl::lod::instance::{INSTANCE_FOLLOWS, SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::object::{list_entry_instance, list_entry_level};
import package::wgsl::render::scene_fade::{FADE, FADE_PUSHED};
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, triangle_surface};
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position};

// Per instance of the scene, three rows: the transform from model space to positions relative to the corner of the view's cell.
// These transforms are valid for instances that the view sees. If the scene keeps its last frame, a second set follows: one
// transform per instance of the last frame, valid for meshes attached to bones.
@group(0) @binding(1) var<storage, read> placements: array<array<vec4<f32>, 3>>;
// All instances of the scene.
@group(0) @binding(2) var<storage, read> instances: array<SceneInstance>;
// All instances in the state of the last frame. If the scene does not keep its last frame, this is the current state.
@group(0) @binding(3) var<storage, read> last_instances: array<SceneInstance>;

// A chunk: instances of an object that are drawn together.
struct SceneObject {
    // Index of the chunk's first instance in the scene.
    first_instance: u32,
    // Number of the object, counted from 1.
    number: u32,
    // Number of the chunk's first instance in the object, counted from 0.
    first_slot: u32,
    // Distance per level by which the fade method `FADE_PUSHED` pushes surfaces away from the eye, in model units.
    push: array<vec4<f32>, 2>,
}

// The chunk that is drawn.
@group(1) @binding(0) var<uniform> scene_object: SceneObject;

// Smallest absolute determinant of a matrix that is inverted.
const LEAST_DETERMINANT: f32 = 1e-30;

// Index of a list entry's instance in the chunk.
fn entry_instance(entry: u32) -> u32 {
    return list_entry_instance(entry);
}

// Index of a list entry's instance in the scene.
fn instance_index(entry: u32) -> u32 {
    return scene_object.first_instance + entry_instance(entry);
}

// Transform of an instance in this frame, from model space to positions relative to the corner of the view's cell. `index` is
// the instance's index in the scene.
fn instance_placement(index: u32) -> Rows {
    return Rows(placements[index][0], placements[index][1], placements[index][2]);
}

// Transform of an instance in the last frame, from model space to positions relative to the corner of this frame's cell. If a
// mesh was attached to a bone in the last frame but is not attached now, the result is its current placement.
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

// Transform from positions in an instance's current placement to positions in its last placement, for points that are static in
// model space.
fn rows_to_last(index: u32) -> Rows {
    let now = instance_placement(index);
    let last = last_placement(index);
    // Columns of the inverse matrix, multiplied by the determinant.
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

// Position of a point in the last frame, relative to the corner of the view's cell. `position` is the point's position in model
// space in the last frame.
fn scene_last_placed(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(last_placement(instance_index(entry)), position);
}

// Position in the last frame of a point that is static in model space. The argument and the result are relative to the corner
// of the view's cell.
fn scene_last_rigid(entry: u32, position: vec3<f32>) -> vec3<f32> {
    return placed_position(rows_to_last(instance_index(entry)), position);
}

// Position of a surface point under the fade method `FADE_PUSHED`. The point is pushed away from the eye by the largest
// distance between the surfaces of the instance's level and of the next level.
fn pushed_position(entry: u32, placement: Rows, position: vec3<f32>) -> vec3<f32> {
    if FADE != FADE_PUSHED {
        return position;
    }
    let level = list_entry_level(entry);
    let scale = sqrt(max(max(
        dot(placement.x.xyz, placement.x.xyz), dot(placement.y.xyz, placement.y.xyz)),
        dot(placement.z.xyz, placement.z.xyz)));
    let away = normalize(position * view.eye.w - view.eye.xyz);
    return position + scene_object.push[level >> 2u][level & 3u] * scale * away;
}

// A vertex, transformed by the placement of the instance of a list entry. `position`, `normal` and `tangent` are in model
// space. `tangent.w` is the sign of the bitangent in model space.
fn scene_placed(entry: u32, position: vec3<f32>, normal: vec3<f32>, tangent: vec4<f32>, uv: vec4<f32>) -> SceneVertex {
    let placement = instance_placement(instance_index(entry));
    let along = vec3<f32>(
        dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    // If the placement mirrors, cofactors turn the normal inwards, and the bitangent changes its sign.
    let side = select(1.0, -1.0, determinant < 0.0);
    return SceneVertex(
        pushed_position(entry, placement, placed_position(placement, position)), side * placed_normal(placement, normal),
        vec4<f32>(along, side * tangent.w), uv, vec4<f32>(0.0), vec3<u32>(0u), side);
}

// Default surface of a fragment: white, opaque and lit, with the triangle's normal on the visible side. The surface has its
// instance's tint, user data and number. The colour does not contain the tint yet.
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
