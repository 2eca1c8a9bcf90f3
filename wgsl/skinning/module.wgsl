// Skinning: what a vertex shader needs to draw skinned vertices at their places, or to skin from a palette by itself.
// `build.rs` joins this file and what it imports, for shaders that are not composed with WESL: put it before your own
// code.
import package::wgsl::skinning::instance_lod::InstanceLod;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position, rows_of_dual};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};
