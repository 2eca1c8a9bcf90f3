// Shading: `Surface` is a point that is seen, `View` what sees it, and `shade` the colour that it has then. The caller's
// own `shade` replaces this one.
import package::wgsl::light::lambert;

// A point of a surface.
struct Surface {
    // Its position in world units, relative to the corner of the view's cell; on a relief the point that the ray met.
    position: vec3<f32>,
    // The unit normal, with normal maps and the relief, on the side that is seen.
    normal: vec3<f32>,
    // The unit normal that vertices have, without normal maps and relief, on the side that is seen.
    geometric_normal: vec3<f32>,
    // Texture coordinates; on a relief those of the point that the ray met.
    uv: vec2<f32>,
    // Linear red, green and blue of the material, its texture and the instance's tint.
    color: vec3<f32>,
    // The alpha of the same in the layer of transparent surfaces; 1 in the colour of opaque ones.
    alpha: f32,
    // The fraction of the light, 0..1, that reaches the point: less than 1 where a relief shades itself.
    sunlit: f32,
    // The tint of the instance: linear red, green, blue, and alpha.
    tint: vec4<f32>,
    // The user data of the instance (`Scene::set_user_data`); 0 unless it is set.
    user_data: u32,
    // The number of the object, from 1 on, and that of the instance in it, from 0 on, as handles tell them.
    object: u32,
    instance: u32,
    // The position in the target in pixels, from its upper left corner.
    pixel: vec2<f32>,
    // Linear red, green and blue that no light changes; w: the fraction of the pixel that it covers, 0..1.
    unlit: vec4<f32>,
    // Where the sun's shadow is looked up: `position`, on a relief the point where the light enters it.
    light_position: vec3<f32>,
    // The position in the last frame, relative to the corner of this frame's cell. Only velocities need it.
    last_position: vec3<f32>,
    // Pixels whose alpha is below it are not drawn.
    cutoff: f32,
    // The depth, 0 to 1; on a relief that of the point that the ray met.
    depth: f32,
}

// A view of the scene.
struct View {
    // From positions relative to the corner of the view's cell to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    // The position of the eye relative to that corner (w = 1), or in a parallel view the direction towards it (w = 0).
    eye: vec4<f32>,
    // The cell to whose corner positions are relative. Cells are cubes with an edge of 256 world units.
    cell: vec3<i32>,
    // The light that surfaces facing away still receive, 0..1.
    ambient: f32,
    // Unit vector towards the light.
    light: vec3<f32>,
    // Linear colour of the light.
    light_color: vec3<f32>,
}

// Matt surfaces, after Lambert.
fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(lambert(surface.color * view.light_color, view.ambient, direct), surface.alpha);
}
