// Positions of a mesh's vertices in the last frame.
import package::wgsl::lod::object::{OBJECT_LEVELS, decision_level, decision_steps};
import package::wgsl::render::scene_instances::{entry_instance, instance_index, scene_last_placed};
import package::wgsl::render::scene_vertex::{MORPHED, VertexMorph, material_of, mesh, morphed, partner_index, partner_level, vertex_index_of, vertex_morph, vertices, way_of};
import package::wgsl::skinning::vertex::vertex_position;

// Per instance of the scene: the view's decision word in the last frame; 0 if the view did not see the instance in that frame.
@group(0) @binding(6) var<storage, read> last_decisions: array<u32>;

// Position of an instance's vertex in the last frame, in model space and without its morph.
fn last_local(instance: u32, vertex: u32) -> vec3<f32> {
    let at = vertex_index_of(instance, vertex);
    let first = select(5u * at, mesh.last + 2u * at, mesh.last != 0u);
    return vertex_position(vertices[first], vertices[first + 1u]);
}

// Morph of a vertex between levels in the last frame.
struct LastMorph {
    // Vertex that stood in for this vertex, in the level that was drawn in the last frame.
    standing: u32,
    // Morph of the vertex `standing`.
    to: VertexMorph,
}

// Morph of a vertex in the last frame. If the level of the last frame was coarser, the vertex was at the position of the vertex
// that replaces it in that level. If the level of the last frame was finer, the vertex had not morphed. If the view did not see
// the instance in the last frame, the vertex counts with its current morph.
fn last_morph(entry: u32, vertex: u32) -> LastMorph {
    let decision = last_decisions[instance_index(entry)];
    if decision == 0u || mesh.partners == 0u {
        return LastMorph(vertex, vertex_morph(entry, vertex));
    }
    let level = decision_level(decision);
    var standing = vertex;
    var word = material_of[mesh.partners + standing];
    for (var step = 0u; step < OBJECT_LEVELS && partner_level(word) < level; step++) {
        standing = partner_index(word);
        word = material_of[mesh.partners + standing];
    }
    if partner_level(word) != level {
        return LastMorph(standing, VertexMorph(standing, 0.0));
    }
    return LastMorph(standing, VertexMorph(partner_index(word), way_of(decision_steps(decision))));
}

// Position of a vertex in the last frame, relative to the corner of the view's cell. `entry` is the list entry of the vertex's
// instance.
fn last_position(entry: u32, vertex: u32) -> vec3<f32> {
    let instance = entry_instance(entry);
    var position = vec3<f32>(0.0);
    if MORPHED {
        let last = last_morph(entry, vertex);
        position = morphed(last_local(instance, last.standing), last_local(instance, last.to.partner), last.to.way);
    } else {
        position = last_local(instance, vertex);
    }
    return scene_last_placed(entry, position);
}
