// The interface between kinds of objects and outputs. A kind exports `KIND_place(entry, vertex) -> SceneVertex`,
// `KIND_last_position(entry, vertex) -> vec3<f32>` and `KIND_surface(SceneFragment) -> Surface`, which never discards and runs
// in uniform control flow. `build/entries.rs` generates the entry points.
import package::wgsl::lod::object::list_entry_instance;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;

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
    words: vec3<u32>,
    // −1 if the placement mirrors, else 1.
    side: f32,
}

// A fragment of an instance.
struct SceneFragment {
    // Interpolated from the vertices.
    position: vec3<f32>,
    normal: vec3<f32>,
    tangent: vec4<f32>,
    uv: vec4<f32>,
    values: vec4<f32>,
    words: vec3<u32>,
    // The instance, counted from the object's first one here.
    instance: u32,
    // The position in the last frame, where the output needs motion; else that of this frame.
    last_position: vec3<f32>,
    // The position in the target in pixels, and the depth.
    clip: vec4<f32>,
    // Whether the outer side of the triangle is seen.
    is_outside: bool,
}

// In the last word that a vertex hands over: triangles seen from outside run counter-clockwise on the screen.
const COUNTER_CLOCKWISE = 0x80000000u;

// The words that a vertex hands over: the kind's own, and the instance with `COUNTER_CLOCKWISE`.
fn scene_words(placed: SceneVertex, entry: u32) -> vec4<u32> {
    let facing = select(0u, COUNTER_CLOCKWISE, view.side * placed.side > 0.0);
    return vec4<u32>(placed.words, list_entry_instance(entry) | facing);
}

// The instance of those words.
fn words_instance(words: vec4<u32>) -> u32 {
    return words.w & ~COUNTER_CLOCKWISE;
}

// Whether the outer side is seen of a triangle with those words, which runs counter-clockwise on the screen if it is in front.
fn words_outside(words: vec4<u32>, is_front: bool) -> bool {
    return is_front == ((words.w & COUNTER_CLOCKWISE) != 0u);
}

// A white, opaque, lit surface of the triangle itself. It has no instance: `scene_surface` has.
fn triangle_surface(in: SceneFragment) -> Surface {
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
