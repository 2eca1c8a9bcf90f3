// Methods that do not search: plain texturing and parallax (thesis B section 3.1.1, table 4.2).
import package::wgsl::surface::ray::{SURFACE_HIT, SurfaceHit, SurfaceMarch, SurfaceRay, surface_at, surface_missed, surface_point};
import package::wgsl::surface::height::{SURFACE_BILINEAR, surface_height};

// Plain texturing: the hit is the polygon's own point.
fn surface_plain(ray: SurfaceRay) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    return surface_point(ray, ray.polygon, 0u, SURFACE_HIT);
}

// Parallax with a single height: the height at the polygon's point decides how far along the ray the hit lies. `limit`, 0 to 1,
// scales that distance.
fn surface_shifted(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch, limit: f32) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let height = surface_height(heights, surface_at(ray, ray.polygon), march.mip, march.address);
    // The shift (h·s + b)·V.xy/V.z with b = −p·s, expressed as a change of the ray's parameter. h is the height, s the depth of
    // the volume, p the polygon's height in the volume, and V the vector towards the eye.
    let parameter = ray.polygon - (height - (1.0 - ray.polygon)) * limit;
    var hit = surface_point(ray, parameter, SURFACE_BILINEAR, SURFACE_HIT);
    hit.height = height;
    return hit;
}

// Parallax mapping by Kaneko, without a limit to the shift.
fn surface_parallax(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    return surface_shifted(heights, ray, march, 1.0);
}

// Parallax mapping with Welsh's offset limiting, which omits the division by V.z.
fn surface_parallax_limited(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    return surface_shifted(heights, ray, march, ray.cosine);
}
