// The criterion for an instance's level: a metric of the instance in a view, compared with a threshold per level. The coarsest
// level whose threshold is at most the metric is drawn. `src/lod/criterion.rs` is the reference.
import package::wgsl::lod::object::LodObject;
import package::wgsl::lod::view::LodCamera;

// Criteria in the flags word of an object.
const CRITERION_ERROR = 0u;

// Metric of an instance in a camera. For the projected error: the part of the allowed displacement that levels may use, in
// model units. `center` is the center of the instance's bounding sphere, `allowed` the displacement that the camera allows it.
fn criterion_metric(object: LodObject, camera: LodCamera, center: vec3<f32>, allowed: f32) -> f32 {
    return object.mesh_fraction * allowed;
}
