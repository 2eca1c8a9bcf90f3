// Linear search. Relief mapping refines the result by a binary search (thesis B section 3.1.2, table 4.4). Parallax occlusion
// mapping refines it by the intersection with a line segment (thesis B section 2.3.1). Both may step over features that are
// thinner than a step.
import package::wgsl::surface::ray::{SURFACE_HIT, SurfaceHit, SurfaceMarch, SurfaceRay, surface_at, surface_missed, surface_point};
import package::wgsl::surface::height::{SURFACE_BILINEAR, surface_height};

// Largest number of linear steps in a march.
const SURFACE_MAX_STEPS: u32 = 1024u;
// Largest number of binary steps in a march.
const SURFACE_MAX_BINARY: u32 = 24u;
// Smallest divisor in `surface_occlusion`. The divisor is the sum of the ray's distances above and below the surface.
const SURFACE_LEAST_SPAN: f32 = 1e-12;

// The two points of a ray between which a linear search stopped.
struct SurfaceBracket {
    // Parameter of the last point above the surface.
    above: f32,
    // Parameter of the first point on or below the surface.
    under: f32,
    // Height of the surface at `above`.
    height_above: f32,
    // Height of the surface at `under`.
    height_under: f32,
    // Number of texels loaded.
    samples: u32,
}

// Number of linear steps for the cosine of a ray: ⌈mix(min, max, 1 − V.z)⌉, 1 to `SURFACE_MAX_STEPS`.
fn surface_steps(march: SurfaceMarch, cosine: f32) -> u32 {
    let low = f32(march.min_steps);
    let steps = ceil(low + (f32(march.max_steps) - low) * (1.0 - min(cosine, 1.0)));
    return clamp(u32(steps), 1u, SURFACE_MAX_STEPS);
}

// Linear search: takes steps of equal length from the top of the volume until a point is on or below the surface.
fn surface_search(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceBracket {
    let steps = surface_steps(march, ray.cosine);
    let width = 1.0 / f32(steps);
    var bracket = SurfaceBracket(0.0, 1.0, 0.0, 0.0, 0u);
    for (var step = 1u; step <= SURFACE_MAX_STEPS; step++) {
        // The bottom of the volume is on or below every surface, so the search stops at the last step at the latest.
        let parameter = select(f32(step) * width, 1.0, step >= steps);
        let height = surface_height(heights, surface_at(ray, parameter), march.mip, march.address);
        bracket.samples += SURFACE_BILINEAR;
        if 1.0 - parameter <= height || step >= steps {
            bracket.under = parameter;
            bracket.height_under = height;
            break;
        }
        bracket.above = parameter;
        bracket.height_above = height;
    }
    return bracket;
}

// Relief mapping: a linear search, then a binary search.
fn surface_relief(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let bracket = surface_search(heights, ray, march);
    return surface_narrowed(heights, ray, march, bracket.above, bracket.under, bracket.samples);
}

// Binary search between the parameters `above`, where the ray is above the surface, and `under`, where the ray is on or below
// the surface. `samples` is the number of texels that were loaded before the call.
fn surface_narrowed(
    heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch, above: f32, under: f32, samples: u32,
) -> SurfaceHit {
    var low = above;
    var high = under;
    var loads = samples;
    for (var step = 0u; step < min(march.binary_steps, SURFACE_MAX_BINARY); step++) {
        let middle = 0.5 * (low + high);
        let height = surface_height(heights, surface_at(ray, middle), march.mip, march.address);
        loads += SURFACE_BILINEAR;
        if 1.0 - middle <= height {
            high = middle;
        } else {
            low = middle;
        }
    }
    return surface_point(ray, 0.5 * (low + high), loads, SURFACE_HIT);
}

// Parallax occlusion mapping: a linear search, then the intersection with the segment between the last two heights.
fn surface_occlusion(heights: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    var bracket = surface_search(heights, ray, march);
    if bracket.above == 0.0 {
        bracket.height_above = surface_height(heights, ray.origin, march.mip, march.address);
        bracket.samples += SURFACE_BILINEAR;
    }
    let over = max(1.0 - bracket.above - bracket.height_above, 0.0);
    let below = max(bracket.height_under - (1.0 - bracket.under), 0.0);
    // Fraction of the segment that lies above the surface. It is 1 if both distances vanish.
    let fraction = select(1.0, over / max(over + below, SURFACE_LEAST_SPAN), over + below > SURFACE_LEAST_SPAN);
    let parameter = bracket.above + fraction * (bracket.under - bracket.above);
    return surface_point(ray, parameter, bracket.samples, SURFACE_HIT);
}
