// Rays through a relief volume, how to march them, and what they hit: the interface of every method
// (B section 3.1). The volume's top has height 1, its bottom 0; s is its depth in uv units.

// Addressing: tiles repeat, or the rim goes on.
const SURFACE_WRAP: u32 = 0u;
const SURFACE_CLAMP: u32 = 1u;

// Outcomes: the ray comes from behind; it met the surface.
const SURFACE_MISS: u32 = 0u;
const SURFACE_HIT: u32 = 1u;
// The method ran out of steps: the result is where it stood.
const SURFACE_EXHAUSTED: u32 = 2u;

// Rays flatter than this are marched as if they were this steep (89.55° from the normal), so that no step
// divides by next to nothing.
const SURFACE_LEAST_COSINE: f32 = 0.0078125;

// A ray through the relief volume, in tangent space: at parameter t it is at uv origin + t · slope and height 1 − t.
struct SurfaceRay {
    // uv where the ray enters the volume, at height 1.
    origin: vec2<f32>,
    // uv that it travels while it falls to height 0.
    slope: vec2<f32>,
    // Cosine of the angle between the eye and the normal; a ray with 0 or less is a miss.
    cosine: f32,
    // The parameter at which it meets the polygon: 0 where the polygon is the top of the volume.
    polygon: f32,
}

// How methods search.
struct SurfaceMarch {
    // SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
    // Linear steps straight down and at the horizon, 1..=1024.
    min_steps: u32,
    max_steps: u32,
    // Binary steps behind them.
    binary_steps: u32,
    // Mip level of the height map, chosen once a fragment. Acceleration maps belong to level 0.
    mip: u32,
}

// What a ray hit.
struct SurfaceHit {
    // Displaced texture coordinates; beyond the tile where the ray left it.
    uv: vec2<f32>,
    // Height of the surface there.
    height: f32,
    // The ray's parameter there, which depth follows from.
    parameter: f32,
    // Texels loaded, those of acceleration maps included.
    samples: u32,
    // SURFACE_MISS, SURFACE_HIT or SURFACE_EXHAUSTED.
    outcome_code: u32,
}

// The ray that meets a polygon at `uv`. `view` is the unit vector towards the eye in tangent space; `scale` the volume's
// depth in uv units; `plane` the polygon's height in the volume, 1 (top) to 0.
fn surface_ray(uv: vec2<f32>, view: vec3<f32>, scale: f32, plane: f32) -> SurfaceRay {
    let slope = view.xy * (-scale / max(view.z, SURFACE_LEAST_COSINE));
    let polygon = 1.0 - plane;
    return SurfaceRay(uv - polygon * slope, slope, view.z, polygon);
}

// uv at a parameter, 0 (top of the volume) to 1 (bottom).
fn surface_at(ray: SurfaceRay, parameter: f32) -> vec2<f32> {
    return ray.origin + parameter * ray.slope;
}

// A point of the ray as the result.
fn surface_point(ray: SurfaceRay, parameter: f32, samples: u32, outcome: u32) -> SurfaceHit {
    return SurfaceHit(surface_at(ray, parameter), 1.0 - parameter, parameter, samples, outcome);
}

// The result of a ray that comes from behind: the polygon, unchanged.
fn surface_missed(ray: SurfaceRay) -> SurfaceHit {
    return surface_point(ray, ray.polygon, 0u, SURFACE_MISS);
}

// Whether displaced coordinates lie in the polygon's own range: the silhouette mask.
fn surface_inside(uv: vec2<f32>, low: vec2<f32>, high: vec2<f32>) -> bool {
    return all(uv >= low) && all(uv <= high);
}
