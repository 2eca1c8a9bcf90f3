// Criteria for the level of detail of an instance. A criterion yields a metric of the instance in a camera; larger metrics give
// coarser levels. The level drawn is the coarsest one whose threshold is at most the metric. `src/lod/criterion.rs` is the
// reference.
import package::wgsl::lod::instance::{Axes, SceneInstance};
import package::wgsl::lod::object::{LodObject, object_flags_criterion};
import package::wgsl::lod::view::LodCamera;

// Criterion: the metric is the displacement that the camera allows, in model units. The CRITERION constants are values of the
// criterion in an object's flags word.
const CRITERION_ERROR = 0u;
// Criterion: the metric is the distance from the eye to the middle of the bounding sphere, in world units.
const CRITERION_DISTANCE = 1u;
// Criterion: the metric is the distance from the eye to a chosen point of the model, in world units.
const CRITERION_POINT = 2u;
// Criterion: the metric is the distance from the eye to the nearest point of the model's box, in world units.
const CRITERION_NEAREST = 3u;
// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the model's box.
const CRITERION_BOX = 4u;
// Criterion: the metric is the square root of the ratio of the viewport's area to the projected area of the bounding sphere.
const CRITERION_SPHERE = 5u;
// Criterion: the metric is the number of world units per pixel at the middle of the bounding sphere (thesis B equation 3.3).
const CRITERION_MAGNIFICATION = 6u;

// Upper bound of the metric, for every criterion.
const MAX_METRIC: f32 = 3e38;

// Transform and bounding sphere of an instance, relative to the corner of the view's cell.
struct Placed {
    // Columns of the linear part of the transform.
    axes: Axes,
    // Position of the model's origin, in world units.
    at: vec3<f32>,
    // Center of the bounding sphere, in world units.
    center: vec3<f32>,
    // Radius of the bounding sphere, in world units.
    radius: f32,
}

// Position of a point of the model relative to the corner of the view's cell. `point` is in model space.
fn placed_point(placed: Placed, point: vec3<f32>) -> vec3<f32> {
    return placed.axes.x * point.x + placed.axes.y * point.y + placed.axes.z * point.z + placed.at;
}

// Distance from the eye to the nearest point of the model's box, in world units.
fn distance_to_box(object: LodObject, placed: Placed, eye: vec3<f32>) -> f32 {
    let towards = eye - placed_point(placed, object.point);
    var nearest = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        let along = axis_of(placed.axes, axis);
        // Coordinate in model space. An axis of length 0 contributes nothing.
        let coordinate = dot(along, towards) / max(dot(along, along), 1e-30);
        nearest += along * clamp(coordinate, -object.half_size[axis], object.half_size[axis]);
    }
    return length(towards - nearest);
}

// Column `axis`, 0 to 2, of the model's linear transform.
fn axis_of(axes: Axes, axis: u32) -> vec3<f32> {
    if axis == 0u {
        return axes.x;
    }
    return select(axes.y, axes.z, axis == 2u);
}

// Area of the model's box on screen, in pixels: the sum over its visible faces, at most three.
fn box_area(object: LodObject, placed: Placed, camera: LodCamera) -> f32 {
    let middle = placed_point(placed, object.point);
    var area = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let half = object.half_size[axis] * axis_of(placed.axes, axis);
        let one = (axis + 1u) % 3u;
        let two = (axis + 2u) % 3u;
        let across = object.half_size[one] * axis_of(placed.axes, one);
        let along = object.half_size[two] * axis_of(placed.axes, two);
        // Only one of two opposite faces counts: the face turned towards the eye. If the eye lies between their planes, neither
        // face counts.
        let normal = cross(across, along);
        var offset = dot(normal, camera.eye - middle);
        if camera.perspective == 0.0 {
            offset = -dot(normal, camera.ahead) * MAX_METRIC;
        }
        let reach = dot(normal, half);
        if abs(offset) > abs(reach) {
            let side = select(-1.0, 1.0, (offset > 0.0) == (reach > 0.0));
            area += face_area(camera, middle + side * half, across, along);
        }
    }
    return area;
}

// Area on screen, in pixels, of the parallelogram with the corners `middle` ± `across` ± `along`.
fn face_area(camera: LodCamera, middle: vec3<f32>, across: vec3<f32>, along: vec3<f32>) -> f32 {
    let a = on_screen(camera, middle - across - along);
    let b = on_screen(camera, middle + across - along);
    let c = on_screen(camera, middle + across + along);
    let d = on_screen(camera, middle - across + along);
    // Half the length of the cross product of the diagonals.
    return 0.5 * length(cross(c - a, d - b));
}

// Projection of a point onto the plane at distance 1 from the eye, in pixels. Points nearer than the near plane are projected
// with the near plane's depth.
fn on_screen(camera: LodCamera, point: vec3<f32>) -> vec3<f32> {
    let towards = point - camera.eye;
    if camera.perspective == 0.0 {
        return camera.focal * (towards - dot(towards, camera.ahead) * camera.ahead);
    }
    let depth = dot(towards, camera.ahead);
    return camera.focal * (towards - depth * camera.ahead) / max(depth, max(camera.near, 1e-9));
}

// Depth of the middle of the bounding sphere in world units, at least the near plane's distance. In a parallel view it is 1.
fn depth_of(camera: LodCamera, center: vec3<f32>) -> f32 {
    if camera.perspective == 0.0 {
        return 1.0;
    }
    return max(dot(camera.ahead, center - camera.eye), max(camera.near, 1e-9));
}

// Metric of an instance in a camera, by the object's criterion. `allowed` is the displacement that the camera allows, in model
// units. A parallel view has no eye, so all distances in it are 0.
fn criterion_metric(object: LodObject, camera: LodCamera, placed: Placed, allowed: f32) -> f32 {
    switch object_flags_criterion(object.flags) {
        case CRITERION_DISTANCE: {
            return camera.perspective * distance(placed.center, camera.eye);
        }
        case CRITERION_POINT: {
            return camera.perspective * distance(placed_point(placed, object.point), camera.eye);
        }
        case CRITERION_NEAREST: {
            return camera.perspective * distance_to_box(object, placed, camera.eye);
        }
        case CRITERION_BOX: {
            return metric_of_area(camera, box_area(object, placed, camera));
        }
        case CRITERION_SPHERE: {
            let radius = camera.focal * placed.radius / depth_of(camera, placed.center);
            return metric_of_area(camera, 3.14159274 * radius * radius);
        }
        case CRITERION_MAGNIFICATION: {
            return depth_of(camera, placed.center) / camera.focal;
        }
        default: {
            return allowed;
        }
    }
}

// Metric of an area on screen: the square root of the ratio of the viewport's area to `area`, both in pixels.
fn metric_of_area(camera: LodCamera, area: f32) -> f32 {
    return min(sqrt(camera.pixel_count / max(area, 1e-30)), MAX_METRIC);
}
