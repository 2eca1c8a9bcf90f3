// The view that a scene is drawn for: its camera, and the light.
import package::wgsl::render::scene_shade::View;

// A view, as the shaders of a scene read it.
struct SceneView {
    // From positions relative to the corner of the view's cell to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    // From positions in the last frame, relative to the corner of this frame's cell, to the last frame's clip space.
    last_clip_from_world: mat4x4<f32>,
    // Position of the eye relative to the corner of the view's cell (w = 1); in a parallel view the direction towards it (w =
    // 0).
    eye: vec4<f32>,
    // Unit vector towards the light; w: the ambient light, the fraction that surfaces facing away still receive, 0 to 1.
    light: vec4<f32>,
    // Colour of the light, linear.
    light_color: vec3<f32>,
    // −1 if the view mirrors, else 1.
    side: f32,
    // The cell of the origin: positions are relative to its corner.
    cell: vec3<i32>,
    // Size of a shadow map texel in world units.
    shadow_texel: f32,
    // Rows of u, v and depth of the transform from positions relative to the corner of the cell to the shadow map. All are 0 in
    // a view without a shadow.
    shadow_rows: array<vec4<f32>, 3>,
    // Pixels by which the pattern of dithers is moved.
    dither_offset: vec2<u32>,
}

@group(0) @binding(0) var<uniform> view: SceneView;

// The view as `shade` receives it.
fn scene_seen_by() -> View {
    return View(view.clip_from_world, view.eye, view.cell, view.light.w, view.light.xyz, view.light_color);
}
