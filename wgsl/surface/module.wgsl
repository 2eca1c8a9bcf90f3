// Surface mapping: every ray-height method through `surface_trace`; also normals, self-shadow, depth, silhouettes and dithered
// transparency. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend
// that text to your own code.
import package::wgsl::surface::ray::{surface_inside, surface_ray};
import package::wgsl::surface::height::surface_mip;
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_normal, surface_towards};
import package::wgsl::surface::shadow::{surface_light_ray, surface_shaded, surface_soft_shadow};
import package::wgsl::surface::sunlit::{surface_mapped_normal, surface_sunlit};
import package::wgsl::surface::dither::surface_dither_threshold;
