// Level of detail in scenes: instances, objects and views in a scene's buffers, the allowed displacement, and the choice of
// levels. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend that
// text to your own code.
import package::wgsl::lod::instance::{Axes, SceneInstance, instance_axes, instance_position};
import package::wgsl::lod::object::{LodObject, SceneDraw};
import package::wgsl::lod::allowed::camera_allows;
import package::wgsl::lod::budget_state::BudgetState;
import package::wgsl::lod::view::{LodCamera, SelectView};
import package::wgsl::lod::criterion::criterion_metric;
import package::wgsl::lod::transition::{transition_decision, transition_entries};
