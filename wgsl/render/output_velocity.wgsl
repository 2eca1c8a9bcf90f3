// The output `velocity`: screen-space motion of a surface since the last frame; w is 1. The unit is the picture's width for x
// (to the right) and the picture's height for y (downwards). A point that lay behind the eye in the last frame has velocity 0.
// output velocity: moves
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;

// Targets of the output `velocity`.
struct VelocityTargets {
    // Motion since the last frame in x and y; w is 1.
    @location(0) velocity: vec4<f32>,
}

// The values that a surface writes to the render targets.
fn velocity_write(surface: Surface) -> VelocityTargets {
    let now = view.clip_from_world * vec4<f32>(surface.position, 1.0);
    let last = view.last_clip_from_world * vec4<f32>(surface.last_position, 1.0);
    if last.w <= 0.0 {
        return VelocityTargets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    let moved = now.xy / now.w - last.xy / last.w;
    return VelocityTargets(vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0));
}
