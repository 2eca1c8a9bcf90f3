// The output `surface`: normal, albedo, object and instance of a surface, before lighting.
// output surface
import package::wgsl::render::scene_shade::Surface;

struct SurfaceTargets {
    // The unit normal; w: 1.
    @location(0) normal: vec4<f32>,
    // The linear colour; w: 1.
    @location(1) albedo: vec4<f32>,
    // Object number (from 1) and instance number in the object (from 0).
    @location(2) id: vec2<u32>,
}

fn surface_write(surface: Surface) -> SurfaceTargets {
    return SurfaceTargets(
        vec4<f32>(surface.normal, 1.0), vec4<f32>(surface.color, 1.0), vec2<u32>(surface.object, surface.instance));
}
