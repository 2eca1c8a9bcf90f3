// The view of a scene through which everything is drawn: its camera, and the light.
import package::wgsl::render::scene_shade::{Surface, View, shade};

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

// The colour of a surface: the one place through which all light goes.
fn scene_shaded(surface: Surface) -> vec4<f32> {
    return shade(surface, View(
        view.clip_from_world, view.eye, view.cell, view.light.w, view.light.xyz, view.light_color));
}

// What the crate's own shading needs of a surface that hides what is behind it, and nothing else.
fn scene_surface(color: vec3<f32>, normal: vec3<f32>) -> Surface {
    var surface: Surface;
    surface.color = color;
    surface.normal = normal;
    surface.alpha = 1.0;
    surface.sunlit = 1.0;
    return surface;
}

// What is written of a surface where it is not shaded.
struct SurfaceTargets {
    // The unit normal; w: 1.
    @location(0) normal: vec4<f32>,
    // The linear colour; w: 1.
    @location(1) albedo: vec4<f32>,
    // The numbers of the object and the instance.
    @location(2) id: vec2<u32>,
}

fn scene_surface_targets(surface: Surface) -> SurfaceTargets {
    return SurfaceTargets(
        vec4<f32>(surface.normal, 1.0), vec4<f32>(surface.color, 1.0), vec2<u32>(surface.object, surface.instance));
}

// x, y and w of a place in clip space.
fn scene_place(clip: vec4<f32>) -> vec3<f32> {
    return clip.xyw;
}

// The motion on the screen from a place of the last frame to one of this frame, as a fraction of the picture's width, to the
// right, and of its height, downwards; w: 1. It is 0 for what lay behind the last frame's eye.
fn scene_velocity(now: vec3<f32>, last: vec3<f32>) -> vec4<f32> {
    if last.z <= 0.0 {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let moved = now.xy / now.z - last.xy / last.z;
    return vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0);
}

// What is written of a surface where it is measured.
struct MeasureTargets {
    // The position relative to the corner of the view's cell; w: 1.
    @location(0) position: vec4<f32>,
    // The numbers of the object and the instance.
    @location(1) id: vec2<u32>,
}

fn scene_measure_targets(surface: Surface) -> MeasureTargets {
    return MeasureTargets(vec4<f32>(surface.position, 1.0), vec2<u32>(surface.object, surface.instance));
}
