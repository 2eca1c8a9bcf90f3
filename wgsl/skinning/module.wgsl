// Skinning: the functions with which a vertex shader draws skinned vertices at their placements, or skins from
// a palette by itself. `build.rs` joins this file and what it imports into one text, for shaders that are not
// composed with WESL: put that text before your own code.
import package::wgsl::affine::product_row;
import package::wgsl::skinning::cluster::CLUSTER;
import package::wgsl::skinning::instance_lod::{InstanceLod, MAX_LEVELS};
import package::wgsl::skinning::page::NO_PAGE;
import package::wgsl::skinning::rows::{LEAST_LENGTH, Rows, placed_normal, placed_position, rows_of_dual};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position, vertex_tangent};
