// Rays through a relief volume, the parameters of a march, and its result: the interface of every method (thesis B section 3.1).
// The volume's top has height 1, its bottom height 0. Its depth s is in uv units.

// Address mode: the tile repeats.
const SURFACE_WRAP: u32 = 0u;
// Address mode: beyond the tile, the texels at its edge continue.
const SURFACE_CLAMP: u32 = 1u;

// Outcome: the ray comes from behind the polygon.
const SURFACE_MISS: u32 = 0u;
// Outcome: the ray met the surface.
const SURFACE_HIT: u32 = 1u;
// Outcome: the method ran out of steps. The result is the last point that it reached.
const SURFACE_EXHAUSTED: u32 = 2u;

// Smallest cosine of a marched ray (89.55° from the normal). Flatter rays are marched with this cosine, so that no step divides
// by a value close to 0.
const SURFACE_LEAST_COSINE: f32 = 0.0078125;

// A ray through the relief volume, in tangent space. At parameter t, the ray is at uv origin + t · slope and at height 1 − t.
struct SurfaceRay {
    // uv coordinates where the ray enters the volume, at height 1.
    origin: vec2<f32>,
    // Change of uv while the ray falls from height 1 to height 0.
    slope: vec2<f32>,
    // Cosine of the angle between the direction to the eye and the normal. A ray with a cosine of 0 or less is a miss.
    cosine: f32,
    // Parameter at which the ray meets the polygon. It is 0 if the polygon is the top of the volume.
    polygon: f32,
}

// Parameters of a ray march through a relief.
struct SurfaceMarch {
    // Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
    // Number of linear steps for a ray straight down, 1..=1024.
    min_steps: u32,
    // Number of linear steps for a ray at the horizon, 1..=1024.
    max_steps: u32,
    // Number of binary steps after the linear ones.
    binary_steps: u32,
    // Mip level of the height map, chosen once per fragment. Acceleration maps always use level 0.
    mip: u32,
}

// Result of tracing a ray.
struct SurfaceHit {
    // Displaced texture coordinates. They lie outside the tile if the ray left the tile.
    uv: vec2<f32>,
    // Height of the surface at the hit, 0 (bottom) to 1 (top).
    height: f32,
    // Parameter of the ray at the hit; it determines the depth.
    parameter: f32,
    // Number of texels loaded, from the height map and the acceleration map.
    samples: u32,
    // Outcome: SURFACE_MISS, SURFACE_HIT or SURFACE_EXHAUSTED.
    outcome_code: u32,
}

// Ray that meets a polygon at `uv`. `view` is the unit vector towards the eye in tangent space. `scale` is the volume's depth
// in uv units, and `plane` the polygon's height in the volume, 0 (bottom) to 1 (top).
fn surface_ray(uv: vec2<f32>, view: vec3<f32>, scale: f32, plane: f32) -> SurfaceRay {
    let slope = view.xy * (-scale / max(view.z, SURFACE_LEAST_COSINE));
    let polygon = 1.0 - plane;
    return SurfaceRay(uv - polygon * slope, slope, view.z, polygon);
}

// uv of a ray at a parameter, 0 (top of the volume) to 1 (bottom).
fn surface_at(ray: SurfaceRay, parameter: f32) -> vec2<f32> {
    return ray.origin + parameter * ray.slope;
}

// Result at the point of a ray with the given parameter.
fn surface_point(ray: SurfaceRay, parameter: f32, samples: u32, outcome: u32) -> SurfaceHit {
    return SurfaceHit(surface_at(ray, parameter), 1.0 - parameter, parameter, samples, outcome);
}

// Result of a ray that comes from behind the polygon: the polygon's own point, with the outcome SURFACE_MISS.
fn surface_missed(ray: SurfaceRay) -> SurfaceHit {
    return surface_point(ray, ray.polygon, 0u, SURFACE_MISS);
}

// Silhouette mask: whether displaced coordinates lie in the polygon's own range of uv, from `low` to `high`.
fn surface_inside(uv: vec2<f32>, low: vec2<f32>, high: vec2<f32>) -> bool {
    return all(uv >= low) && all(uv <= high);
}
