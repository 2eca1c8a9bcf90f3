// Skinning functions for vertex shaders: to draw skinned vertices at their placements, or to skin vertices from a palette in
// the shader. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend
// that text to your own code.
import package::wgsl::affine::product_row;
import package::wgsl::skinning::cluster::CLUSTER;
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};
import package::wgsl::skinning::page::NO_PAGE;
import package::wgsl::skinning::rows::{LEAST_LENGTH, Rows, placed_normal, placed_position, rows_of_dual};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};
