// Every method through one function, selected by an override constant or a uniform, so that a shader needs no
// copies.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::flat::{surface_parallax, surface_parallax_limited, surface_plain};
import package::wgsl::surface::linear::{surface_occlusion, surface_relief};
import package::wgsl::surface::cone::surface_cone;
import package::wgsl::surface::quadtree::surface_quadtree;

// The values of the methods.
const SURFACE_PLAIN: u32 = 0u;
const SURFACE_PARALLAX: u32 = 1u;
const SURFACE_PARALLAX_LIMITED: u32 = 2u;
const SURFACE_RELIEF: u32 = 3u;
const SURFACE_OCCLUSION: u32 = 4u;
const SURFACE_CONE: u32 = 5u;
const SURFACE_QUADTREE: u32 = 6u;

// `acceleration` is the cone map for SURFACE_CONE, the pyramid for SURFACE_QUADTREE, and any texture for the
// others.
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
