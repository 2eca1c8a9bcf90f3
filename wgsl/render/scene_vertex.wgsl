// Vertices of the meshes of a scene, static or skinned, at the placement of an instance.
import package::wgsl::lod::instance::SceneInstance;
import package::wgsl::lod::object::{MORPH_STEPS, list_entry_instance, list_entry_morph, morph_level, morph_steps};
import package::wgsl::skinning::cluster::CLUSTER;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};

// Whether levels of detail of the mesh move into each other.
override MORPHED: bool = false;

// A vertex's partner: its index, and the coarsest level of detail that has the vertex itself.
// packed Partner: index 24, level 8

// Where the instances and the vertices of a mesh lie.
struct MeshParams {
    // The index in the scene of the object's first instance.
    first_instance: u32,
    // Number of clusters of the mesh if vertices lie in pages; 0 if all instances share those of the mesh.
    clusters: u32,
    // The number of the object, from 1 on.
    object: u32,
    // The index in `vertices` of the last frame's positions, two pairs per vertex in pages; 0 if vertices do not move.
    last: u32,
    // The number in the object of its first instance here.
    first_slot: u32,
    // The index in `material_of` of the vertices' partners; 0 if there are none.
    partners: u32,
}

// Three rows per instance of the scene: the transform from the model's space to positions relative to the corner of the
// view's cell. Only those of instances that the view sees are written. If the scene keeps its last frame, as many follow, of
// which those of meshes that are attached to bones are written: the transforms that they had then; and then an element for
// each instance, of which x is 1 + the level of detail at which the view drew it then, or 0 if it did not, and y the steps
// that the level had moved.
@group(0) @binding(1) var<storage, read> rows: array<vec4<f32>>;
// All instances of the scene.
@group(0) @binding(2) var<storage, read> instances: array<SceneInstance>;
// Where the object's instances and vertices lie.
@group(1) @binding(0) var<uniform> mesh: MeshParams;
// Five pairs per vertex: position, normal, tangent.
@group(1) @binding(1) var<storage, read> vertices: array<vec2<f32>>;
// The page of each cluster of each instance of the object, if vertices lie in pages.
@group(1) @binding(4) var<storage, read> page_table: array<u32>;
// For each vertex of the mesh, the index of its material in the table of its part; then, from `MeshParams.partners` on, its
// partner, towards which it moves, with the coarsest level that has the vertex.
@group(1) @binding(3) var<storage, read> material_of: array<u32>;
// One pair per vertex of the mesh.
@group(1) @binding(2) var<storage, read> texture_coordinates: array<vec2<f32>>;

// A vertex where an instance has it.
struct PlacedVertex {
    // Relative to the corner of the view's cell.
    position: vec3<f32>,
    // Towards the outside, of any length but 0.
    normal: vec3<f32>,
    // Along u, of any length but 0; w: the bitangent along v is w · normal × tangent, of unit vectors.
    tangent: vec4<f32>,
    uv: vec2<f32>,
    // The factor of the instance's colours and alpha, 8 bits each.
    tint: u32,
    // −1 if the placement mirrors, else 1.
    side: f32,
    // By how much the placement lengthens the direction of u.
    stretch: f32,
}

// Where a vertex lies, in vertices. One without a page, which no triangle that is drawn has, lies anywhere.
fn vertex_index_of(instance: u32, vertex: u32) -> u32 {
    if mesh.clusters == 0u {
        return vertex;
    }
    return CLUSTER * page_table[instance * mesh.clusters + vertex / CLUSTER] + vertex % CLUSTER;
}

// The instance of a list's entry, counted in the object.
fn entry_instance(entry: u32) -> u32 {
    return list_entry_instance(entry);
}

// Where a vertex goes in the next coarser level, and how far it has moved there, 0 to 1.
struct VertexMorph {
    partner: u32,
    way: f32,
}

// The vertices that the next coarser level has too stay, and so do all if the entry's level has not moved.
fn vertex_morph(entry: u32, vertex: u32) -> VertexMorph {
    let word = material_of[mesh.partners + vertex];
    let morph = list_entry_morph(entry);
    let steps = morph_steps(morph);
    if steps == 0u || mesh.partners == 0u || partner_level(word) != morph_level(morph) {
        return VertexMorph(vertex, 0.0);
    }
    return VertexMorph(partner_index(word), way_of(steps));
}

// The way of so many steps. Division may round: all of them are 1.
fn way_of(steps: u32) -> f32 {
    return select(f32(steps) / f32(MORPH_STEPS), 1.0, steps == MORPH_STEPS);
}

// Between two vectors; at 0 and 1 one of them, to the bit.
fn morphed(a: vec3<f32>, b: vec3<f32>, way: f32) -> vec3<f32> {
    return a * (1.0 - way) + b * way;
}

// A vertex of an instance, given by the entry of its list; `vertex` counts those of the mesh.
fn placed_vertex(entry: u32, vertex: u32) -> PlacedVertex {
    let instance = entry_instance(entry);
    let index = mesh.first_instance + instance;
    let placement = Rows(rows[3u * index], rows[3u * index + 1u], rows[3u * index + 2u]);
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
    let along = vec3<f32>(
        dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    // Cofactors turn the normal inwards where the placement mirrors, which also changes the bitangent's side.
    let side = select(1.0, -1.0, determinant < 0.0);
    return PlacedVertex(
        placed_position(placement, position),
        side * placed_normal(placement, normal),
        vec4<f32>(along, side * tangent.w),
        uv,
        instances[index].tint,
        side,
        length(along));
}
