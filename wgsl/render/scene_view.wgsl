// The view of a scene through which everything is drawn: its camera, and the light.
import package::wgsl::light::lambert;

// What the shaders of a scene know of a view.
struct SceneView {
    // From positions relative to the corner of the view's cell to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    // The position of the eye relative to that corner (w = 1), or in a parallel view the direction towards it (w = 0).
    eye: vec4<f32>,
    // Unit vector towards the light; w: the light that surfaces facing away still receive, 0..1.
    light: vec4<f32>,
    // Colour of the light, linear.
    light_color: vec3<f32>,
    // −1 if the view mirrors, else 1.
    side: f32,
}

@group(0) @binding(0) var<uniform> view: SceneView;

// The light that a matt surface of a linear colour sends to the eye; `direct`, 0..1, is the cosine at which the light falls
// on it, less where it lies in shadow.
fn scene_lit(color: vec3<f32>, direct: f32) -> vec3<f32> {
    return lambert(color * view.light_color, view.light.w, direct);
}
