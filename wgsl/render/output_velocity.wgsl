// The output `velocity`: the motion of surfaces on the screen since the last frame, as a fraction of the picture's width, to the
// right, and of its height, downwards; w: 1. What lay behind the last frame's eye has the velocity 0.
// output velocity: moves
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;

struct VelocityTargets {
    @location(0) velocity: vec4<f32>,
}

fn velocity_write(surface: Surface) -> VelocityTargets {
    let now = view.clip_from_world * vec4<f32>(surface.position, 1.0);
    let last = view.last_clip_from_world * vec4<f32>(surface.last_position, 1.0);
    if last.w <= 0.0 {
        return VelocityTargets(vec4<f32>(0.0, 0.0, 0.0, 1.0));
    }
    let moved = now.xy / now.w - last.xy / last.w;
    return VelocityTargets(vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0));
}
