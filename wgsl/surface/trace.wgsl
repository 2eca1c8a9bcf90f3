// One function for all tracing methods. An override constant or a uniform selects the method, so that one shader serves all
// methods.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::flat::{surface_parallax, surface_parallax_limited, surface_plain};
import package::wgsl::surface::linear::{surface_occlusion, surface_relief};
import package::wgsl::surface::cone::surface_cone;
import package::wgsl::surface::quadtree::surface_quadtree;

// Method: plain texturing, without displacement.
const SURFACE_PLAIN: u32 = 0u;
// Method: Kaneko's parallax mapping.
const SURFACE_PARALLAX: u32 = 1u;
// Method: parallax mapping with Welsh's offset limiting.
const SURFACE_PARALLAX_LIMITED: u32 = 2u;
// Method: relief mapping, a linear search followed by a binary search.
const SURFACE_RELIEF: u32 = 3u;
// Method: parallax occlusion mapping, a linear search followed by the intersection with a segment.
const SURFACE_OCCLUSION: u32 = 4u;
// Method: cone stepping.
const SURFACE_CONE: u32 = 5u;
// Method: max-mip traversal (quadtree).
const SURFACE_QUADTREE: u32 = 6u;

// Traces a ray by the given method. `acceleration` is the cone map for SURFACE_CONE, the max-mip pyramid for SURFACE_QUADTREE,
// and any texture for other methods.
fn surface_trace(
    method: u32, heights: texture_2d<f32>, acceleration: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch,
) -> SurfaceHit {
    switch method {
        case SURFACE_PARALLAX: { return surface_parallax(heights, ray, march); }
        case SURFACE_PARALLAX_LIMITED: { return surface_parallax_limited(heights, ray, march); }
        case SURFACE_RELIEF: { return surface_relief(heights, ray, march); }
        case SURFACE_OCCLUSION: { return surface_occlusion(heights, ray, march); }
        case SURFACE_CONE: { return surface_cone(heights, acceleration, ray, march); }
        case SURFACE_QUADTREE: { return surface_quadtree(heights, acceleration, ray, march); }
        default: { return surface_plain(ray); }
    }
}
