// What the texts of callers' kinds stand beside: the interface to kinds, and all outputs.
import package::wgsl::render::output_color::{ColorTargets, TransparentTargets, color_write, transparent_write};
import package::wgsl::render::output_depth::depth_behind;
import package::wgsl::render::output_measure::{MeasureTargets, measure_write};
import package::wgsl::render::output_surface::{SurfaceTargets, surface_write};
import package::wgsl::render::output_velocity::{VelocityTargets, velocity_write};
import package::wgsl::render::scene_instances::{scene_last_placed, scene_last_rigid, scene_placed, scene_surface};
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, scene_words, words_instance, words_outside};
import package::wgsl::render::scene_view::view;
