// Shading: `shade` returns the colour of a point (`Surface`) that a `View` sees. The caller's own `shade` replaces this one.
import package::wgsl::light::lambert;

// A point of a surface.
struct Surface {
    // Position in world units, relative to the corner of the view's cell. On a relief: the ray's hit.
    position: vec3<f32>,
    // Unit normal on the visible side, with normal map and relief.
    normal: vec3<f32>,
    // Unit normal of the vertices, interpolated, on the visible side, without normal map and relief.
    geometric_normal: vec3<f32>,
    // Texture coordinates; on a relief those of the ray's hit.
    uv: vec2<f32>,
    // Linear red, green and blue of the material, its texture and the instance's tint.
    color: vec3<f32>,
    // Alpha of material, texture and tint in the layer of transparent surfaces; 1 for opaque surfaces.
    alpha: f32,
    // Fraction of the light that reaches the point, 0 to 1: below 1 in shadow, of the relief itself or of casters.
    sunlit: f32,
    // The tint of the instance: linear red, green, blue, and alpha.
    tint: vec4<f32>,
    // The user data of the instance (`Scene::set_user_data`); 0 unless it is set.
    user_data: u32,
    // Number of the object, from 1, as in handles.
    object: u32,
    // Number of the instance in the object, from 0, as in handles.
    instance: u32,
    // The position in the target in pixels, from its upper left corner.
    pixel: vec2<f32>,
    // Linear RGB that lighting does not change; w: the fraction of the pixel that it covers, 0 to 1.
    unlit: vec4<f32>,
    // Position of the shadow map lookup: `position`; on a relief the point where the light enters the volume.
    light_position: vec3<f32>,
    // The position in the last frame, relative to the corner of this frame's cell. Only velocities need it.
    last_position: vec3<f32>,
    // Alpha cutoff: pixels with a lower alpha are discarded.
    cutoff: f32,
    // Depth, 0 to 1; on a relief that of the ray's hit.
    depth: f32,
    // Level of detail of the instance, from 0 for the finest.
    level: u32,
    // Alpha of an instance that is blended while it fades; else 1. `alpha` contains it.
    fade: f32,
}

// A view of the scene.
struct View {
    // From positions relative to the corner of the view's cell to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    // Position of the eye relative to the corner of the view's cell (w = 1); in a parallel view the direction towards it (w =
    // 0).
    eye: vec4<f32>,
    // The cell of the origin: positions are relative to its corner. Cells are cubes with an edge of 256 world units.
    cell: vec3<i32>,
    // Ambient light: the fraction of the light that surfaces facing away still receive, 0 to 1.
    ambient: f32,
    // Unit vector towards the light.
    light: vec3<f32>,
    // Linear colour of the light.
    light_color: vec3<f32>,
}

// Lambertian (matte) surfaces.
fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(lambert(surface.color * view.light_color, view.ambient, direct), surface.alpha);
}
