// The output `uv`: alpha and texture coordinates of surfaces.
// output uv
import package::wgsl::render::scene_shade::Surface;

struct UvTargets {
    // Texture coordinates, alpha; w: 1.
    @location(0) uv: vec4<f32>,
}

fn uv_write(surface: Surface) -> UvTargets {
    return UvTargets(vec4<f32>(surface.uv, surface.alpha, 1.0));
}
