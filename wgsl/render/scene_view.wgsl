// The view of a scene through which everything is drawn: its camera, and the light.
import package::wgsl::render::scene_shade::View;

// What the shaders of a scene know of a view.
struct SceneView {
    // From positions relative to the corner of the view's cell to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    // From positions of the last frame, relative to the corner of this frame's cell, to the clip space of that frame.
    last_clip_from_world: mat4x4<f32>,
    // The position of the eye relative to that corner (w = 1), or in a parallel view the direction towards it (w = 0).
    eye: vec4<f32>,
    // Unit vector towards the light; w: the light that surfaces facing away still receive, 0..1.
    light: vec4<f32>,
    // Colour of the light, linear.
    light_color: vec3<f32>,
    // −1 if the view mirrors, else 1.
    side: f32,
    // The cell to whose corner positions are relative.
    cell: vec3<i32>,
    // World units that a texel of the sun's map covers.
    shadow_texel: f32,
    // From positions relative to the corner of the cell to places in the sun's map: the rows of u, v and depth. All are 0 where
    // the view has no shadow.
    shadow_rows: array<vec4<f32>, 3>,
}

@group(0) @binding(0) var<uniform> view: SceneView;

// What shading knows of the view.
fn scene_seen_by() -> View {
    return View(view.clip_from_world, view.eye, view.cell, view.light.w, view.light.xyz, view.light_color);
}
