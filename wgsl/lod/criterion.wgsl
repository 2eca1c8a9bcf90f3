// Criteria of an instance's level: a metric of the instance in a camera, which grows with the level. The coarsest level whose
// threshold is at most the metric is drawn. `src/lod/criterion.rs` is the reference.
import package::wgsl::lod::instance::{Axes, SceneInstance};
import package::wgsl::lod::object::{LodObject, object_flags_criterion};
import package::wgsl::lod::view::LodCamera;

// Criteria in the flags word of an object. The metric is a displacement that the camera allows, in model units;
const CRITERION_ERROR = 0u;
// a distance from the eye, in world units: to the middle of the bounding sphere,
const CRITERION_DISTANCE = 1u;
// to a point of the model,
const CRITERION_POINT = 2u;
// or to the nearest point of the model's box;
const CRITERION_NEAREST = 3u;
// the square root of the viewport's area per projected area: of the model's box,
const CRITERION_BOX = 4u;
// or of the bounding sphere;
const CRITERION_SPHERE = 5u;
// or world units per pixel, at the middle of the bounding sphere (B equation 3.3).
const CRITERION_MAGNIFICATION = 6u;

// Upper bound of all metrics.
const MAX_METRIC: f32 = 3e38;

// An instance's place in a view, relative to the corner of the view's cell.
struct Placed {
    axes: Axes,
    // Position of the model's origin.
    at: vec3<f32>,
    // The bounding sphere.
    center: vec3<f32>,
    radius: f32,
}

// A point of the model.
fn placed_point(placed: Placed, point: vec3<f32>) -> vec3<f32> {
    return placed.axes.x * point.x + placed.axes.y * point.y + placed.axes.z * point.z + placed.at;
}

// Distance from a point to the nearest point of the model's box.
fn distance_to_box(object: LodObject, placed: Placed, eye: vec3<f32>) -> f32 {
    let towards = eye - placed_point(placed, object.point);
    var nearest = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis++) {
        let along = axis_of(placed.axes, axis);
        // Coordinate in the model; an axis of length 0 contributes nothing.
        let coordinate = dot(along, towards) / max(dot(along, along), 1e-30);
        nearest += along * clamp(coordinate, -object.half_size[axis], object.half_size[axis]);
    }
    return length(towards - nearest);
}

// A column of the model's linear transform.
fn axis_of(axes: Axes, axis: u32) -> vec3<f32> {
    if axis == 0u {
        return axes.x;
    }
    return select(axes.y, axes.z, axis == 2u);
}

// Area on the screen, in pixels, of the model's box: the sum over the three faces that the eye may see.
fn box_area(object: LodObject, placed: Placed, camera: LodCamera) -> f32 {
    let middle = placed_point(placed, object.point);
    var area = 0.0;
    for (var axis = 0u; axis < 3u; axis++) {
        let half = object.half_size[axis] * axis_of(placed.axes, axis);
        let one = (axis + 1u) % 3u;
        let two = (axis + 2u) % 3u;
        let across = object.half_size[one] * axis_of(placed.axes, one);
        let along = object.half_size[two] * axis_of(placed.axes, two);
        // Of the two faces, the one that is turned towards the eye; none if the eye lies between their planes.
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

// Area on the screen of the parallelogram with the corners `middle` ± `across` ± `along`.
fn face_area(camera: LodCamera, middle: vec3<f32>, across: vec3<f32>, along: vec3<f32>) -> f32 {
    let a = on_screen(camera, middle - across - along);
    let b = on_screen(camera, middle + across - along);
    let c = on_screen(camera, middle + across + along);
    let d = on_screen(camera, middle - across + along);
    // Half the length of the cross product of the diagonals.
    return 0.5 * length(cross(c - a, d - b));
}

// A point on the plane at distance 1, in pixels; points behind the near plane count as if they were in it.
fn on_screen(camera: LodCamera, point: vec3<f32>) -> vec3<f32> {
    let towards = point - camera.eye;
    if camera.perspective == 0.0 {
        return camera.focal * (towards - dot(towards, camera.ahead) * camera.ahead);
    }
    let depth = dot(towards, camera.ahead);
    return camera.focal * (towards - depth * camera.ahead) / max(depth, max(camera.near, 1e-9));
}

// Depth of the middle of the bounding sphere, at least that of the near plane; 1 in a parallel view.
fn depth_of(camera: LodCamera, center: vec3<f32>) -> f32 {
    if camera.perspective == 0.0 {
        return 1.0;
    }
    return max(dot(camera.ahead, center - camera.eye), max(camera.near, 1e-9));
}

// Metric of an instance in a camera. `allowed` is the displacement that the camera allows, in model units. A parallel view's
// own camera has no eye: distances in it are 0.
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

// The metric of an area on the screen, in pixels.
fn metric_of_area(camera: LodCamera, area: f32) -> f32 {
    return min(sqrt(camera.pixel_count / max(area, 1e-30)), MAX_METRIC);
}
