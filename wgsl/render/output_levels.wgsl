// The output `levels`: surfaces in the colour of their instance's level of detail, lit by the direction that they face.
// output levels
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;

// Targets of the output `levels`.
struct LevelsTargets {
    // Linear lit colour of the level; w is 1.
    @location(0) color: vec4<f32>,
}

// Linear colours of levels 0 to 7, from red over yellow and green to blue and violet.
const LEVEL_COLORS: array<vec3<f32>, 8> = array<vec3<f32>, 8>(
    vec3<f32>(0.76, 0.05, 0.05), vec3<f32>(0.85, 0.27, 0.02), vec3<f32>(0.80, 0.62, 0.03), vec3<f32>(0.22, 0.58, 0.06),
    vec3<f32>(0.03, 0.48, 0.40), vec3<f32>(0.04, 0.27, 0.70), vec3<f32>(0.17, 0.09, 0.62), vec3<f32>(0.50, 0.08, 0.55));

// The values that a surface writes to the render targets.
fn levels_write(surface: Surface) -> LevelsTargets {
    let facing = 0.35 + 0.65 * max(dot(surface.normal, view.light.xyz), 0.0);
    return LevelsTargets(vec4<f32>(facing * LEVEL_COLORS[surface.level], 1.0));
}
