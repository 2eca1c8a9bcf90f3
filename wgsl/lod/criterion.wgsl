// What chooses the level of an instance: a metric of the instance in a view, and a threshold for each level. The coarsest level is
// drawn whose threshold the metric reaches. `src/lod/criterion.rs` is the reference.
import package::wgsl::lod::object::LodObject;
import package::wgsl::lod::view::LodCamera;

// The criteria of an object's flags.
const CRITERION_ERROR = 0u;

// The metric of an instance in a camera: by the projected error, the part of the displacement that levels may use, in the model's
// units. `center` is that of the instance's sphere, `allowed` the displacement that the camera allows it.
fn criterion_metric(object: LodObject, camera: LodCamera, center: vec3<f32>, allowed: f32) -> f32 {
    return object.mesh_fraction * allowed;
}
