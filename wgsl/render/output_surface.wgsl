// The output `surface`: normal and albedo of a surface before lighting, and the numbers of its object and instance.
// output surface
import package::wgsl::render::scene_shade::Surface;

// Targets of the output `surface`.
struct SurfaceTargets {
    // Unit normal; w is 1.
    @location(0) normal: vec4<f32>,
    // Linear colour before lighting; w is 1.
    @location(1) albedo: vec4<f32>,
    // Number of the object, from 1 (x), and number of the instance in the object, from 0 (y).
    @location(2) id: vec2<u32>,
}

// The values that a surface writes to the render targets.
fn surface_write(surface: Surface) -> SurfaceTargets {
    return SurfaceTargets(
        vec4<f32>(surface.normal, 1.0), vec4<f32>(surface.color, 1.0), vec2<u32>(surface.object, surface.instance));
}
