// The interface between kinds of objects and outputs. A kind exports `KIND_place(entry, vertex) -> SceneVertex`,
// `KIND_last_position(entry, vertex) -> vec3<f32>` and `KIND_surface(SceneFragment) -> Surface`. `KIND_surface` never discards
// and runs in uniform control flow. `build/entries.rs` generates the entry points.
import package::wgsl::render::scene_fade::{entry_word, faded_alpha, scene_word_counter_clockwise, scene_word_instance, scene_word_level};
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;

// A vertex of an instance, as a kind's place function returns it.
struct SceneVertex {
    // Position in world units, relative to the corner of the view's cell.
    position: vec3<f32>,
    // Outward normal, not normalized but never 0.
    normal: vec3<f32>,
    // Direction of u (xyz), not normalized but never 0. w is the sign of the bitangent, which is the direction of v. The
    // bitangent is w · normal × tangent, computed from unit vectors.
    tangent: vec4<f32>,
    // Two sets of texture coordinates: xy and zw.
    uv: vec4<f32>,
    // Values that the kind chooses; they are interpolated.
    values: vec4<f32>,
    // Words that the kind chooses; they are the same at all vertices of a triangle.
    words: vec3<u32>,
    // −1 if the instance's placement mirrors, else 1.
    side: f32,
}

// A fragment of an instance, as a kind's surface function receives it.
struct SceneFragment {
    // Position in world units, relative to the corner of the view's cell.
    position: vec3<f32>,
    // Outward normal, interpolated and not normalized.
    normal: vec3<f32>,
    // Direction of u (xyz) and sign of the bitangent (w), interpolated.
    tangent: vec4<f32>,
    // Two sets of texture coordinates: xy and zw.
    uv: vec4<f32>,
    // Values that the kind chose, interpolated.
    values: vec4<f32>,
    // Words that the kind chose, not interpolated.
    words: vec3<u32>,
    // Index of the instance in its chunk, the instances that are drawn together.
    instance: u32,
    // Position in the last frame if the output needs motion; otherwise the position in this frame.
    last_position: vec3<f32>,
    // Pixel position in the target (xy) and depth (z).
    clip: vec4<f32>,
    // Whether the triangle is seen from outside.
    is_outside: bool,
    // Level of detail of the instance, from 0 for the finest.
    level: u32,
    // Alpha of an instance that is blended while it fades; otherwise 1.
    fade: f32,
}

// Words that the vertex shader passes on: the kind's own words (xyz), and the word of the list entry (w).
fn scene_words(placed: SceneVertex, entry: u32) -> vec4<u32> {
    return vec4<u32>(placed.words, entry_word(entry, view.side * placed.side > 0.0));
}

// Index of the instance in its chunk, from the words that the vertex shader passes on.
fn words_instance(words: vec4<u32>) -> u32 {
    return scene_word_instance(words.w);
}

// Level of detail of the instance, from the words that the vertex shader passes on.
fn words_level(words: vec4<u32>) -> u32 {
    return scene_word_level(words.w);
}

// Alpha of the instance while it fades, from the words that the vertex shader passes on.
fn words_fade(words: vec4<u32>) -> f32 {
    return faded_alpha(words.w);
}

// Whether a triangle is seen from outside. `is_front` is true if the triangle runs counter-clockwise on screen.
fn words_outside(words: vec4<u32>, is_front: bool) -> bool {
    return is_front == (scene_word_counter_clockwise(words.w) != 0u);
}

// Default surface without an instance's properties: white, opaque and lit, with the triangle's geometry. `scene_surface` adds
// the properties.
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
    surface.level = in.level;
    surface.fade = in.fade;
    return surface;
}
