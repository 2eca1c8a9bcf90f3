// Vertices of a scene's meshes, static or skinned, in the placement of an instance.
import package::wgsl::lod::object::{MORPH_STEPS, list_entry_level, list_entry_steps};
import package::wgsl::render::scene_instances::{entry_instance, scene_placed};
import package::wgsl::render::scene_kind::SceneVertex;
import package::wgsl::skinning::cluster::CLUSTER;
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};

// Whether the mesh's levels of detail change by geomorphs.
override MORPHED: bool = false;

// Partner word of a vertex: the index of the vertex towards which it morphs, and the coarsest level of detail that contains the
// vertex itself.
// packed Partner: index 24, level 8

// Location of a mesh's vertex data in the buffers.
struct MeshParams {
    // Number of clusters of the mesh if each instance has vertices of its own, in pages. 0 if all instances share the mesh's
    // vertices.
    clusters: u32,
    // Index in `vertices` of the last frame's positions: two pairs of floats per vertex in pages. 0 if vertices do not move.
    last: u32,
    // Index of the first partner word in `material_of`; 0 if the mesh has no partners.
    partners: u32,
}

// Location of the mesh's vertex data.
@group(1) @binding(5) var<uniform> mesh: MeshParams;
// Vertices, five pairs of floats each: position, normal and tangent.
@group(1) @binding(1) var<storage, read> vertices: array<vec2<f32>>;
// Page of each cluster of each instance of the object, if vertices lie in pages.
@group(1) @binding(4) var<storage, read> page_table: array<u32>;
// Two tables with one entry per vertex of the mesh. The first table, from 0, has the index of the vertex's material in the
// part's table. The second table, from `MeshParams.partners`, has partner words.
@group(1) @binding(3) var<storage, read> material_of: array<u32>;
// Texture coordinates, one pair per vertex of the mesh.
@group(1) @binding(2) var<storage, read> texture_coordinates: array<vec2<f32>>;

// Index of an instance's vertex in the vertex buffer, counted in vertices. The index of a vertex without a page is arbitrary:
// no drawn triangle uses such a vertex.
fn vertex_index_of(instance: u32, vertex: u32) -> u32 {
    if mesh.clusters == 0u {
        return vertex;
    }
    return CLUSTER * page_table[instance * mesh.clusters + vertex / CLUSTER] + vertex % CLUSTER;
}

// Morph of a vertex towards the next coarser level.
struct VertexMorph {
    // Index of the vertex towards which this vertex moves.
    partner: u32,
    // Progress of the move, 0 to 1.
    way: f32,
}

// Morph of a vertex for a list entry. Vertices that also exist in the next coarser level do not move. No vertex moves if the
// entry has no morph.
fn vertex_morph(entry: u32, vertex: u32) -> VertexMorph {
    let word = material_of[mesh.partners + vertex];
    let steps = list_entry_steps(entry);
    if steps == 0u || mesh.partners == 0u || partner_level(word) != list_entry_level(entry) {
        return VertexMorph(vertex, 0.0);
    }
    return VertexMorph(partner_index(word), way_of(steps));
}

// Progress of a morph, 0 to 1, after `steps` steps. The last step gives exactly 1, although the division may round.
fn way_of(steps: u32) -> f32 {
    return select(f32(steps) / f32(MORPH_STEPS), 1.0, steps == MORPH_STEPS);
}

// Linear interpolation from `a` to `b`, exact to the bit where `way` is 0 or 1.
fn morphed(a: vec3<f32>, b: vec3<f32>, way: f32) -> vec3<f32> {
    return a * (1.0 - way) + b * way;
}

// A vertex of the mesh, transformed by the placement of the instance of a list entry. `vertex` is its index in the mesh.
fn placed_vertex(entry: u32, vertex: u32) -> SceneVertex {
    let instance = entry_instance(entry);
    let at = 5u * vertex_index_of(instance, vertex);
    let middle = vertices[at + 1u];
    var position = vertex_position(vertices[at], middle);
    var normal = vertex_normal(middle, vertices[at + 2u]);
    var tangent = vertex_tangent(vertices[at + 3u], vertices[at + 4u]);
    var uv = texture_coordinates[vertex];
    if MORPHED {
        let to = vertex_morph(entry, vertex);
        let other = 5u * vertex_index_of(instance, to.partner);
        let other_middle = vertices[other + 1u];
        let other_tangent = vertex_tangent(vertices[other + 3u], vertices[other + 4u]);
        position = morphed(position, vertex_position(vertices[other], other_middle), to.way);
        normal = morphed(normal, vertex_normal(other_middle, vertices[other + 2u]), to.way);
        tangent = vec4<f32>(
            morphed(tangent.xyz, other_tangent.xyz, to.way), select(tangent.w, other_tangent.w, to.way >= 0.5));
        uv = uv * (1.0 - to.way) + texture_coordinates[to.partner] * to.way;
    }
    return scene_placed(entry, position, normal, tangent, vec4<f32>(uv, 0.0, 0.0));
}
