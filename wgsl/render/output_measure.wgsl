// The output `measure`: the position of a surface, with its object and instance.
// output measure
import package::wgsl::render::scene_shade::Surface;

struct MeasureTargets {
    // The position relative to the corner of the view's cell; w: 1.
    @location(0) position: vec4<f32>,
    // Object number (from 1) and instance number in the object (from 0).
    @location(1) id: vec2<u32>,
}

fn measure_write(surface: Surface) -> MeasureTargets {
    return MeasureTargets(vec4<f32>(surface.position, 1.0), vec2<u32>(surface.object, surface.instance));
}
