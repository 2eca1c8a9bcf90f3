// The view for which a scene is drawn: its camera, and the light.
import package::wgsl::render::scene_shade::View;

// A view, as the shaders of a scene read it.
struct SceneView {
    // Transform from positions relative to the corner of the view's cell to clip space, with depth 0 to 1.
    clip_from_world: mat4x4<f32>,
    // Transform from last-frame positions, relative to the corner of this frame's cell, to the last frame's clip space.
    last_clip_from_world: mat4x4<f32>,
    // Position of the eye relative to the corner of the view's cell (w = 1). In a parallel view, the direction towards the eye
    // (w = 0).
    eye: vec4<f32>,
    // Unit vector towards the light (xyz). w is the ambient light, 0 to 1: the fraction that surfaces facing away still
    // receive.
    light: vec4<f32>,
    // Linear RGB colour of the light.
    light_color: vec3<f32>,
    // −1 if the view mirrors, else 1.
    side: f32,
    // Cell of the view: all positions are relative to this cell's corner.
    cell: vec3<i32>,
    // Edge length of a shadow map texel, in world units.
    shadow_texel: f32,
    // Rows for u, v and depth of the transform to the shadow map, from positions relative to the corner of the view's cell. All
    // rows are 0 in a view without a shadow.
    shadow_rows: array<vec4<f32>, 3>,
    // Offset of dither patterns, in pixels.
    dither_offset: vec2<u32>,
}

// The view that is drawn.
@group(0) @binding(0) var<uniform> view: SceneView;

// The view in the form that `shade` receives.
fn scene_seen_by() -> View {
    return View(view.clip_from_world, view.eye, view.cell, view.light.w, view.light.xyz, view.light_color);
}
