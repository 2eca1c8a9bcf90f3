// The interface between kinds of objects and outputs. A kind exports `KIND_place(entry, vertex) -> SceneVertex`,
// `KIND_last_position(entry, vertex) -> vec3<f32>` and `KIND_surface(SceneFragment) -> Surface`, which never discards and runs
// in uniform control flow. `build/entries.rs` generates the entry points.
import package::wgsl::render::scene_shade::Surface;

// A vertex of an instance as its kind places it.
struct SceneVertex {
    // Relative to the corner of the view's cell.
    position: vec3<f32>,
    // Outwards, of any length but 0.
    normal: vec3<f32>,
    // Along u, of any length but 0; w: the bitangent along v is w · normal × tangent, of unit vectors.
    tangent: vec4<f32>,
    // Two sets of texture coordinates.
    uv: vec4<f32>,
    // The kind's own values, which are interpolated.
    values: vec4<f32>,
    // The kind's own words, which are the same at all vertices of a triangle.
    words: vec4<u32>,
}

// A fragment of an instance.
struct SceneFragment {
    // Interpolated from the vertices.
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    values: vec4<f32>,
    words: vec4<u32>,
    // The position in the last frame, where the output needs motion; else that of this frame.
    last_position: vec3<f32>,
    // The position in the target in pixels, and the depth.
    clip: vec4<f32>,
    // Whether triangles that run counter-clockwise on the screen are seen here.
    is_front: bool,
}

// A white, opaque, lit surface of the triangle itself.
fn scene_surface(in: SceneFragment) -> Surface {
    var surface: Surface;
    surface.position = in.position;
    surface.normal = normalize(in.normal);
    surface.geometric_normal = surface.normal;
    surface.uv = in.uv.xy;
    surface.color = vec3<f32>(1.0);
    surface.alpha = 1.0;
    surface.sunlit = 1.0;
    surface.tint = vec4<f32>(1.0);
    surface.pixel = in.clip.xy;
    surface.light_position = in.position;
    surface.last_position = in.last_position;
    surface.depth = in.clip.z;
    return surface;
}
