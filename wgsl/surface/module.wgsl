// Everything that a material shader may want of surface mapping. `build.rs` writes it flat, for shaders that are not
// composed with WESL: put it before your own code, which then has `surface_trace` and its kin.
import package::wgsl::surface::ray::{surface_inside, surface_ray};
import package::wgsl::surface::height::surface_mip;
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_normal, surface_towards};
import package::wgsl::surface::shadow::{surface_light_ray, surface_shaded, surface_soft_shadow};
