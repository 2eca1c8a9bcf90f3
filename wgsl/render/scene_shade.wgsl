// Shading: `shade` returns the colour of a surface point (`Surface`) in a `View`. A caller's own `shade` replaces this one.
import package::wgsl::light::lambert;

// A surface point to be shaded.
struct Surface {
    // Position in world units, relative to the corner of the view's cell. On a relief, this is the ray's hit.
    position: vec3<f32>,
    // Unit normal on the visible side, including the normal map and the relief.
    normal: vec3<f32>,
    // Interpolated unit normal of the vertices on the visible side, without the normal map and the relief.
    geometric_normal: vec3<f32>,
    // Texture coordinates. On a relief, they belong to the ray's hit.
    uv: vec2<f32>,
    // Linear RGB: the product of the material's colour, its texture and the instance's tint.
    color: vec3<f32>,
    // Alpha of the material, its texture and the instance's tint for transparent surfaces; 1 for opaque surfaces.
    alpha: f32,
    // Fraction of the light that reaches the point, 0 to 1. It is below 1 in the shadow of the relief itself or of other
    // objects.
    sunlit: f32,
    // Tint of the instance: linear red, green, blue, and alpha.
    tint: vec4<f32>,
    // User data of the instance (`Scene::set_user_data`); 0 by default.
    user_data: u32,
    // Number of the object, counted from 1, as in handles.
    object: u32,
    // Number of the instance in the object, counted from 0, as in handles.
    instance: u32,
    // Position in the target in pixels, from the upper left corner.
    pixel: vec2<f32>,
    // Linear RGB that lighting does not change (xyz), and the fraction of the pixel that this colour covers, 0 to 1 (w).
    unlit: vec4<f32>,
    // Position for the shadow map lookup, equal to `position`. On a relief, this is the point where the light enters the
    // volume.
    light_position: vec3<f32>,
    // Position in the last frame, relative to the corner of this frame's cell. Only velocities need it.
    last_position: vec3<f32>,
    // Alpha cutoff: pixels with a lower alpha are discarded.
    cutoff: f32,
    // Depth, 0 to 1. On a relief, this is the depth of the ray's hit.
    depth: f32,
    // Level of detail of the instance or of the node of endless terrain, 0 to 7, from 0 for the finest.
    level: u32,
    // Alpha of an instance that is blended while it fades, else 1. `alpha` already contains this factor.
    fade: f32,
}

// A view of the scene, as shading needs it.
struct View {
    // Transform from positions relative to the corner of the view's cell to clip space, with depth 0 to 1.
    clip_from_world: mat4x4<f32>,
    // Position of the eye relative to the corner of the view's cell (w = 1). In a parallel view, the direction towards the eye
    // (w = 0).
    eye: vec4<f32>,
    // Cell of the view: all positions are relative to this cell's corner. Cells are cubes with an edge of 256 world units.
    cell: vec3<i32>,
    // Ambient light: the fraction of the light that surfaces facing away still receive, 0 to 1.
    ambient: f32,
    // Unit vector towards the light.
    light: vec3<f32>,
    // Linear RGB colour of the light.
    light_color: vec3<f32>,
}

// Linear colour and alpha of a surface point, shaded as Lambertian (matte).
fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(lambert(surface.color * view.light_color, view.ambient, direct), surface.alpha);
}
