// Where the instances of a scene were in the last frame, and how far their surfaces moved on the screen since.
import package::wgsl::lod::instance::{INSTANCE_FOLLOWS, SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::object::{OBJECT_LEVELS};
import package::wgsl::render::scene_vertex::{MORPHED, VertexMorph, entry_instance, instances, material_of, mesh, morphed, partner_index, partner_level, rows, vertex_index_of, vertex_morph, vertices, way_of};
import package::wgsl::render::scene_view::view;
import package::wgsl::skinning::rows::{Rows, placed_position};
import package::wgsl::skinning::vertex::vertex_position;

// All instances of the scene as they were in the last frame, if it keeps it; else as they are.
@group(0) @binding(3) var<storage, read> last_instances: array<SceneInstance>;

// Determinants below this have no inverse.
const LEAST_DETERMINANT: f32 = 1e-30;

// The transform that an instance had, from the model's space to positions relative to the corner of the view's cell. A mesh
// that was attached to a bone and is no longer counts as if it had been where it is.
fn last_rows(index: u32) -> Rows {
    let instance = last_instances[index];
    if (instance.flags & INSTANCE_FOLLOWS) != 0u {
        let follows = (instances[index].flags & INSTANCE_FOLLOWS) != 0u;
        let first = 3u * index + select(0u, 3u * arrayLength(&last_instances), follows);
        return Rows(rows[first], rows[first + 1u], rows[first + 2u]);
    }
    let axes = instance_axes(instance);
    let at = instance_position(instance, view.cell);
    return Rows(
        vec4<f32>(axes.x.x, axes.y.x, axes.z.x, at.x),
        vec4<f32>(axes.x.y, axes.y.y, axes.z.y, at.y),
        vec4<f32>(axes.x.z, axes.y.z, axes.z.z, at.z));
}

// Where a vertex of an instance was in the model's space.
fn last_local(instance: u32, vertex: u32) -> vec3<f32> {
    let at = vertex_index_of(instance, vertex);
    let first = select(5u * at, mesh.last + 2u * at, mesh.last != 0u);
    return vertex_position(vertices[first], vertices[first + 1u]);
}

// The vertex that stood for another in the last frame, where that vertex went, and how far it had moved there.
struct LastMorph {
    standing: u32,
    to: VertexMorph,
}

// If the last frame had a coarser level of detail, a vertex was where the one was that had taken its place; if it had a finer
// one, the vertex had not moved. An instance that the view did not see then counts as if its level had been as it is.
fn last_morph(entry: u32, vertex: u32) -> LastMorph {
    let known = rows[6u * arrayLength(&last_instances) + mesh.first_instance + entry_instance(entry)];
    if known.x == 0.0 || mesh.partners == 0u {
        return LastMorph(vertex, vertex_morph(entry, vertex));
    }
    let level = u32(known.x) - 1u;
    var standing = vertex;
    var word = material_of[mesh.partners + standing];
    for (var step = 0u; step < OBJECT_LEVELS && partner_level(word) < level; step++) {
        standing = partner_index(word);
        word = material_of[mesh.partners + standing];
    }
    if partner_level(word) != level {
        return LastMorph(standing, VertexMorph(standing, 0.0));
    }
    return LastMorph(standing, VertexMorph(partner_index(word), way_of(u32(known.y))));
}

// Where a vertex of an instance, given by the entry of its list, was, relative to the corner of the view's cell.
fn last_position(entry: u32, vertex: u32) -> vec3<f32> {
    let instance = entry_instance(entry);
    var position = vec3<f32>(0.0);
    if MORPHED {
        let last = last_morph(entry, vertex);
        position = morphed(last_local(instance, last.standing), last_local(instance, last.to.partner), last.to.way);
    } else {
        position = last_local(instance, vertex);
    }
    return placed_position(last_rows(mesh.first_instance + instance), position);
}

// The transform from where an instance is to where it was, for what does not move in the model's space.
fn rows_to_last(index: u32) -> Rows {
    let now = Rows(rows[3u * index], rows[3u * index + 1u], rows[3u * index + 2u]);
    let last = last_rows(index);
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
