// A shader of somebody's own behind the module: spheres (four floats each) that one perspective camera sees, and an instance
// that stands in another cell.
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;

@compute @workgroup_size(1)
fn main() {
    let eye = vec3<f32>(1.0, 2.0, 3.0);
    let camera = LodCamera(eye, 500.0, vec3<f32>(0.0, 0.0, -1.0), 2.0, 0.25, 1.0, 0.0, 0.0);
    let count = arrayLength(&given) / 4u;
    for (var sphere = 0u; sphere < count; sphere++) {
        let at = 4u * sphere;
        let center = vec3<f32>(given[at], given[at + 1u], given[at + 2u]);
        results[sphere] = bitcast<u32>(camera_allows(camera, center, given[at + 3u]));
    }
    var instance: SceneInstance;
    instance.cell = vec3<i32>(7, -2, 1000000);
    instance.offset = vec3<f32>(1.0, 2.0, 3.5);
    // A quarter turn about +Y.
    instance.rotation = vec4<f32>(0.0, sqrt(0.5), 0.0, sqrt(0.5));
    instance.scale = vec3<f32>(2.0, -1.0, 1.0);
    let position = instance_position(instance, vec3<i32>(6, -2, 1000001));
    let axes = instance_axes(instance);
    for (var axis = 0u; axis < 3u; axis++) {
        results[count + axis] = bitcast<u32>(position[axis]);
        results[count + 3u + axis] = bitcast<u32>(axes.x[axis]);
        results[count + 6u + axis] = bitcast<u32>(axes.y[axis]);
    }
}
