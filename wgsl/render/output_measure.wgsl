// The output `measure`: the position of a surface, and the numbers of its object and instance.
// output measure
import package::wgsl::render::scene_shade::Surface;

// Targets of the output `measure`.
struct MeasureTargets {
    // Position in world units, relative to the corner of the view's cell; w is 1.
    @location(0) position: vec4<f32>,
    // Number of the object, from 1 (x), and number of the instance in the object, from 0 (y).
    @location(1) id: vec2<u32>,
}

// The values that a surface writes to the render targets.
fn measure_write(surface: Surface) -> MeasureTargets {
    return MeasureTargets(vec4<f32>(surface.position, 1.0), vec2<u32>(surface.object, surface.instance));
}
