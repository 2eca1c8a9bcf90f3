// Vertices of the meshes of a scene, static or skinned, at the placement of an instance.
import package::wgsl::lod::instance::SceneInstance;
import package::wgsl::skinning::cluster::CLUSTER;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};

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
}

// Three rows per instance of the scene: the transform from the model's space to positions relative to the corner of the
// view's cell. Only those of instances that the view sees are written. If the scene keeps its last frame, as many follow, of
// which those of meshes that are attached to bones are written: the transforms that they had then.
@group(0) @binding(1) var<storage, read> rows: array<vec4<f32>>;
// All instances of the scene.
@group(0) @binding(2) var<storage, read> instances: array<SceneInstance>;
// Where the object's instances and vertices lie.
@group(1) @binding(0) var<uniform> mesh: MeshParams;
// Five pairs per vertex: position, normal, tangent.
@group(1) @binding(1) var<storage, read> vertices: array<vec2<f32>>;
// The page of each cluster of each instance of the object, if vertices lie in pages.
@group(1) @binding(4) var<storage, read> page_table: array<u32>;
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

// A vertex of an instance; `instance` counts those of the object, `vertex` those of the mesh.
fn placed_vertex(instance: u32, vertex: u32) -> PlacedVertex {
    let index = mesh.first_instance + instance;
    let placement = Rows(rows[3u * index], rows[3u * index + 1u], rows[3u * index + 2u]);
    let at = 5u * vertex_index_of(instance, vertex);
    let middle = vertices[at + 1u];
    let tangent = vertex_tangent(vertices[at + 3u], vertices[at + 4u]);
    let along = vec3<f32>(
        dot(placement.x.xyz, tangent.xyz), dot(placement.y.xyz, tangent.xyz), dot(placement.z.xyz, tangent.xyz));
    let determinant = dot(placement.x.xyz, cross(placement.y.xyz, placement.z.xyz));
    // Cofactors turn the normal inwards where the placement mirrors, which also changes the bitangent's side.
    let side = select(1.0, -1.0, determinant < 0.0);
    return PlacedVertex(
        placed_position(placement, vertex_position(vertices[at], middle)),
        side * placed_normal(placement, vertex_normal(middle, vertices[at + 2u])),
        vec4<f32>(along, side * tangent.w),
        texture_coordinates[vertex],
        instances[index].tint,
        side,
        length(along));
}
