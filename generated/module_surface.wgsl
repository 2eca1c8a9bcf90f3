// From relievo's wgsl/surface/module.wgsl.
// Surface mapping: every ray-height method through `surface_trace`; also normals, self-shadow, depth, silhouettes and dithered
// transparency. `build.rs` joins this file and its imports into one text, for shaders that are not composed with WESL. Prepend
// that text to your own code.

// From relievo's wgsl/surface/ray.wgsl.
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

// From relievo's wgsl/surface/height.wgsl.
// Bilinear heights, computed from texel loads. The functions use neither derivatives nor filtering that depends on the driver,
// so a march may call them in any control flow. The red channel is the height.

// Number of texel loads for one bilinear height.
const SURFACE_BILINEAR: u32 = 4u;

// Height, 0 to 1, at the coordinates `uv` in a mip level. `address` is SURFACE_WRAP or SURFACE_CLAMP.
fn surface_height(heights: texture_2d<f32>, uv: vec2<f32>, mip: u32, address: u32) -> f32 {
    let size = vec2<f32>(textureDimensions(heights, mip));
    let last = vec2<i32>(size) - 1;
    var low: vec2<i32>;
    var high: vec2<i32>;
    var weight: vec2<f32>;
    if address == SURFACE_WRAP {
        let at = (uv - floor(uv)) * size - 0.5;
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = select(low + 1, vec2<i32>(0), low >= last);
        low = select(low, last, low < vec2<i32>(0));
    } else {
        let at = clamp(uv * size - 0.5, vec2<f32>(0.0), size - 1.0);
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = min(low + 1, last);
    }
    let near = vec2<f32>(
        textureLoad(heights, low, mip).r,
        textureLoad(heights, vec2<i32>(high.x, low.y), mip).r);
    let far = vec2<f32>(
        textureLoad(heights, vec2<i32>(low.x, high.y), mip).r,
        textureLoad(heights, high, mip).r);
    let rows = near + weight.y * (far - near);
    return rows.x + weight.x * (rows.y - rows.x);
}

// Mip level at which a texel is about as large as a pixel. `uv_dx` and `uv_dy` are the screen derivatives of uv.
fn surface_mip(heights: texture_2d<f32>, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> u32 {
    let size = vec2<f32>(textureDimensions(heights));
    let texels = max(dot(uv_dx * size, uv_dx * size), dot(uv_dy * size, uv_dy * size));
    let level = 0.5 * log2(max(texels, 1.0));
    return min(u32(level + 0.5), textureNumLevels(heights) - 1u);
}

// From relievo's wgsl/surface/trace.wgsl.
// One function for all tracing methods. An override constant or a uniform selects the method, so that one shader serves all
// methods.

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

// From relievo's wgsl/surface/shade.wgsl.
// Shading of a displaced point: its normal, from the heights around the point, and its depth.

// Unit normal in tangent space, by central differences over one texel to either side. `scale` is the relief's depth in uv
// units.
fn surface_normal(heights: texture_2d<f32>, uv: vec2<f32>, scale: f32, march: SurfaceMarch) -> vec3<f32> {
    let size = vec2<f32>(textureDimensions(heights, march.mip));
    let x = vec2<f32>(1.0 / size.x, 0.0);
    let y = vec2<f32>(0.0, 1.0 / size.y);
    let rise = vec2<f32>(
        surface_height(heights, uv + x, march.mip, march.address)
            - surface_height(heights, uv - x, march.mip, march.address),
        surface_height(heights, uv + y, march.mip, march.address)
            - surface_height(heights, uv - y, march.mip, march.address));
    return normalize(vec3<f32>(-0.5 * scale * size * rise, 1.0));
}

// Distance from the polygon to the hit along the eye's ray, in uv units. The depth buffer needs this distance.
fn surface_distance(ray: SurfaceRay, hit: SurfaceHit, scale: f32) -> f32 {
    return (hit.parameter - ray.polygon) * scale / max(ray.cosine, SURFACE_LEAST_COSINE);
}

// Unit vector from a point of the polygon towards the eye. `eye` is the eye's position (w = 1), or the direction towards the
// eye (w = 0).
fn surface_towards(eye: vec4<f32>, position: vec3<f32>) -> vec3<f32> {
    return normalize(eye.xyz - eye.w * position);
}

// Depth, 0 (near) to 1 (far), of the point that lies `distance` behind a point of the polygon along the eye's ray. Positions
// and distance are in world units. A fragment shader writes this depth.
fn surface_depth(clip_from_world: mat4x4<f32>, position: vec3<f32>, towards: vec3<f32>, distance: f32) -> f32 {
    let clip = clip_from_world * vec4<f32>(position - towards * distance, 1.0);
    return clamp(clip.z / clip.w, 0.0, 1.0);
}

// From relievo's wgsl/surface/shadow.wgsl.
// Self-shadow: whether light reaches a point of the surface (thesis B section 3.1.2). For a hard shadow, any tracing method
// traces the light's ray from the top of the volume. The point is lit if the ray reaches it. For a soft shadow, samples measure
// how far the surface rises above the path to the light. The further the occluder, the wider the penumbra.

// Height difference below which a point does not shade itself, as a fraction of the relief's depth.
const SURFACE_SHADOW_BIAS: f32 = 0.005;
// Addend to the distance of an occluder, as a fraction of the relief's depth, so that no occluder is at distance 0.
const SURFACE_LEAST_OCCLUSION: f32 = 0.001;

// Ray from the light to a point of the surface: it falls from the top of the volume to the hit. `light` is the unit vector
// towards the light, in tangent space.
fn surface_light_ray(hit: SurfaceHit, light: vec3<f32>, scale: f32) -> SurfaceRay {
    let slope = light.xy * (-scale / max(light.z, SURFACE_LEAST_COSINE));
    return SurfaceRay(hit.uv - (1.0 - hit.height) * slope, slope, light.z, 0.0);
}

// Whether the point `hit` is in hard shadow. `first` is the result of the light's ray to this point: in shadow, the ray ended
// above the point.
fn surface_shaded(first: SurfaceHit, hit: SurfaceHit) -> bool {
    return first.parameter < 1.0 - hit.height - SURFACE_SHADOW_BIAS;
}

// Light that reaches a point, 0 (full shadow) to 1 (full light), from `steps` heights on the path to the light. `softness` sets
// the width of the penumbra: shadow is full where the surface rises above the path by at least `softness` times the distance
// from the point.
fn surface_soft_shadow(
    heights: texture_2d<f32>, hit: SurfaceHit, light: vec3<f32>, scale: f32, march: SurfaceMarch,
    steps: u32, softness: f32,
) -> f32 {
    if !(light.z > 0.0) {
        return 0.0;
    }
    // The march starts at the surface, because the hit may lie slightly below it.
    let own = surface_height(heights, hit.uv, march.mip, march.address);
    var start = hit;
    start.height = max(hit.height, own);
    let ray = surface_light_ray(start, light, scale);
    let rise = 1.0 - start.height;
    let count = clamp(steps, 1u, SURFACE_MAX_STEPS);
    var shade = 0.0;
    for (var step = 1u; (step <= count) & (shade < 1.0); step++) {
        // Samples are denser close to the point, where an occluder casts the sharpest shadow.
        let fraction = f32(step) / f32(count + 1u);
        let travelled = fraction * fraction;
        let parameter = rise * (1.0 - travelled);
        let height = surface_height(heights, ray.origin + parameter * ray.slope, march.mip, march.address);
        let excess = height - (1.0 - parameter) - SURFACE_SHADOW_BIAS;
        shade = max(shade, excess / (softness * (travelled * rise + SURFACE_LEAST_OCCLUSION)));
    }
    return 1.0 - min(shade, 1.0);
}


// From relievo's wgsl/surface/sunlit.wgsl.
// Light that reaches a point of a relief, for every kind of self-shadow.

// Kind of self-shadow: none.
const SURFACE_SHADOW_NONE: u32 = 0u;
// Kind of self-shadow: full light or none. A ray from the light is traced like the eye's ray.
const SURFACE_SHADOW_HARD: u32 = 1u;
// Kind of self-shadow: soft, with penumbras.
const SURFACE_SHADOW_SOFT: u32 = 2u;

// Parameters of a relief's self-shadow.
struct SurfaceShadow {
    // Depth of the relief in uv units.
    scale: f32,
    // Number of steps of a soft shadow.
    steps: u32,
    // Softness of a soft shadow: the shadow is full where the surface rises above the light's path by at least this factor
    // times the distance from the shaded point.
    softness: f32,
}

// Fraction of the light that reaches a hit, 0 to 1. `light` is the unit vector towards the light in tangent space. `shadow` is
// one of the constants above.
fn surface_sunlit(
    method: u32, shadow: u32, heights: texture_2d<f32>, acceleration: texture_2d<f32>,
    hit: SurfaceHit, light: vec3<f32>, relief: SurfaceShadow, march: SurfaceMarch,
) -> f32 {
    if shadow == SURFACE_SHADOW_NONE || !(light.z > 0.0) {
        return 1.0;
    }
    if shadow == SURFACE_SHADOW_SOFT {
        return surface_soft_shadow(heights, hit, light, relief.scale, march, relief.steps, relief.softness);
    }
    let ray = surface_light_ray(hit, light, relief.scale);
    let first = surface_trace(method, heights, acceleration, ray, march);
    return select(1.0, 0.0, surface_shaded(first, hit));
}

// Unit normal in tangent space, from a texel of a normal map. If `green_up` is true, the texture's green channel points up the
// image, against v. If false, it points down the image.
fn surface_mapped_normal(texel: vec4<f32>, green_up: bool) -> vec3<f32> {
    let slope = texel.xy * 2.0 - 1.0;
    return vec3<f32>(slope.x, select(slope.y, -slope.y, green_up), sqrt(max(1.0 - dot(slope, slope), 0.0)));
}

// From relievo's wgsl/surface/dither.wgsl.
// Screen-door transparency: a pattern of opaque pixels.

// Alpha threshold of a pixel, between 0 and 1: pixels with a lower alpha are discarded. The threshold is the rank of the
// pixel's position `place` in a 4 × 4 ordered-dither matrix (Bayer 1973).
fn surface_dither_threshold(place: vec2<u32>) -> f32 {
    let fine = place & vec2<u32>(1u);
    let coarse = (place >> vec2<u32>(1u)) & vec2<u32>(1u);
    let rank = 8u * (fine.x ^ fine.y) + 4u * fine.y + 2u * (coarse.x ^ coarse.y) + coarse.y;
    return (f32(rank) + 0.5) / 16.0;
}

// From relievo's wgsl/surface/flat.wgsl.
// Methods that do not search: plain texturing and parallax (thesis B section 3.1.1, table 4.2).

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

// From relievo's wgsl/surface/linear.wgsl.
// Linear search. Relief mapping refines the result by a binary search (thesis B section 3.1.2, table 4.4). Parallax occlusion
// mapping refines it by the intersection with a line segment (thesis B section 2.3.1). Both may step over features that are
// thinner than a step.

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

// From relievo's wgsl/surface/cone.wgsl.
// Cone stepping over `cone_map`. Each cell stores the height of its highest corner, and the radius of a cone on that corner.
// Inside the cone, a ray crosses the surface at most once, so no step can pass the first crossing unnoticed. A binary search
// finds the crossing between the last two points (thesis B section 2.3.3; Policarpo and Oliveira 2007, made safe under bilinear
// filtering).

// Traces a ray by cone stepping. `cones` is the cone map of `heights`, computed by surface/cone_map. Only the address mode and
// the number of binary steps of `march` are used.
fn surface_cone(
    heights: texture_2d<f32>, cones: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch,
) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let distance = length(grid.travel);
    let bound = surface_bound(grid, 0u);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    // The last parameter at which the ray is known to be above the surface.
    var above = 0.0;
    var samples = 0u;
    var step = 0u;
    while step < bound {
        // Steps above the surface have a loop of their own. In this loop, a ray waits only for the steps of the other rays in
        // its workgroup, not for their intersections with patches.
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_near = false;
        while step < bound {
            step += 1u;
            node = surface_node(grid, cell, 0u);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            // Height of the cell's highest corner (r), and radius of the cone in cells at height 1 above the corner (g).
            let cone = textureLoad(cones, node.index, 0).rg;
            samples += 1u;
            if 1.0 - leave <= cone.r {
                is_near = true;
                break;
            }
            above = parameter;
            let reach = parameter + cone.g * (1.0 - parameter - cone.r) / (distance + cone.g);
            if reach > leave {
                parameter = min(reach, 1.0);
                cell = vec2<i32>(floor(grid.start + parameter * grid.travel));
            } else {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
            }
        }
        if !is_near {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found > parameter || (found == parameter && above == parameter) {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if found >= 0.0 {
            // Cones belong to mip level 0 of the heights.
            var level = march;
            level.mip = 0u;
            return surface_narrowed(heights, ray, level, above, parameter, samples);
        }
        above = parameter;
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
    }
    // A ray that reaches the bottom of the volume has hit, because no surface lies below the bottom.
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}

// From relievo's wgsl/surface/quadtree.wgsl.
// Max-mip traversal (thesis B section 2.3.4; Tevs, Ihrke and Seidel 2008). If the ray passes above a node, the whole node is
// skipped. In a leaf, the ray is intersected exactly with the bilinear patch.

// Traces a ray by max-mip traversal. `pyramid` is the max-mip pyramid of `heights`, computed by surface/height_pyramid. Only
// the address mode of `march` is used.
fn surface_quadtree(
    heights: texture_2d<f32>, pyramid: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch,
) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let top = surface_levels(vec2<u32>(grid.cells)) - 1u;
    let bound = surface_bound(grid, top);
    // The traversal starts with nodes of half the ray's length, because larger nodes can rarely be skipped.
    let longest = u32(max(abs(grid.travel.x), abs(grid.travel.y)));
    var level = min(firstLeadingBit(max(longest / 2u, 1u)), top);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var samples = 0u;
    var step = 0u;
    while step < bound {
        // Visits of nodes have a loop of their own. In this loop, a ray waits only for the visits of the other rays in its
        // workgroup, not for their intersections with patches.
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_leaf = false;
        while step < bound {
            step += 1u;
            node = surface_node(grid, cell, level);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let at = surface_atlas_at(vec2<u32>(grid.cells), level, node.index);
            let highest = textureLoad(pyramid, at, 0).r;
            samples += 1u;
            if 1.0 - leave > highest {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
                level = min(level + select(0u, 1u, surface_leaves_parent(grid, node, exits, level)), top);
                continue;
            }
            parameter = max(parameter, 1.0 - highest);
            if level == 0u {
                is_leaf = true;
                break;
            }
            level -= 1u;
            cell = surface_cell(grid, node, parameter);
        }
        if !is_leaf {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found >= 0.0 {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
        level = min(select(0u, 1u, surface_leaves_parent(grid, node, exits, 0u)), top);
    }
    // A ray that reaches the bottom of the volume has hit, because no surface lies below the bottom.
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}

// Whether the ray leaves a node and the node's parent through the same edge.
fn surface_leaves_parent(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, level: u32) -> bool {
    let along_x = exits.x <= exits.y;
    let index = select(node.index.y, node.index.x, along_x);
    let cells = select(grid.cells.y, grid.cells.x, along_x);
    let forward = select(grid.travel.y, grid.travel.x, along_x) >= 0.0;
    let is_odd = (index & 1) == 1;
    let is_last = ((index + 1) << level) >= cells;
    return select(!is_odd, is_odd || is_last, forward);
}

// From relievo's wgsl/surface/grid.wgsl.
// Grid of bilinear cells under a ray. A cell lies between four texel centers. With wrap addressing, a tile has the same number
// of cells and texels. With clamp addressing, a tile has one more cell per axis, and the outermost cells extend to infinity
// with constant heights. In both modes the cells cover the whole plane, so a ray never leaves the grid.

// A distance in cells that is longer than any ray's path.
const SURFACE_FAR: i32 = 1073741824;

// If a ray travels fewer cells than this along an axis, it never leaves a cell along that axis.
const SURFACE_LEAST_TRAVEL: f32 = 1e-6;

// A ray parameter that no ray reaches.
const SURFACE_NEVER: f32 = 2.0;

// Grid of cells under a ray, relative to the cell in which the ray enters.
struct SurfaceGrid {
    // Number of texels of a tile along each axis.
    size: vec2<i32>,
    // Number of cells of a tile along each axis.
    cells: vec2<i32>,
    // Cell in which the ray enters, reduced to the tile if addresses wrap. Other cells are counted from this cell, which keeps
    // f32 exact.
    base: vec2<i32>,
    // Position in the base cell at which the ray enters, 0 to 1.
    start: vec2<f32>,
    // Reciprocals of the tile's edges in texels.
    tiles: vec2<f32>,
    // Distance in cells that the ray travels along each axis, with sign.
    travel: vec2<f32>,
    // Reciprocal of `travel`; 0 along an axis where the ray hardly travels.
    inverse: vec2<f32>,
    // Address mode: SURFACE_WRAP or SURFACE_CLAMP.
    address: u32,
}

// A square of cells: a node of the pyramid.
struct SurfaceNode {
    // Index of the node at its level.
    index: vec2<i32>,
    // Lower edges in cells, counted from the base cell.
    low: vec2<i32>,
    // Upper edges in cells, counted from the base cell; exclusive.
    high: vec2<i32>,
}

// Grid of cells under a ray, for a map of `size` texels.
fn surface_grid(size: vec2<u32>, ray: SurfaceRay, address: u32) -> SurfaceGrid {
    let scale = vec2<f32>(size);
    let texel = ray.origin * scale - 0.5;
    let base = floor(texel);
    let travel = ray.slope * scale;
    let is_slow = abs(travel) < vec2<f32>(SURFACE_LEAST_TRAVEL);
    let inverse = select(1.0 / select(travel, vec2<f32>(1.0), is_slow), vec2<f32>(0.0), is_slow);
    let texels = vec2<i32>(size);
    var first = vec2<i32>(base);
    var cells = texels + 1;
    if address == SURFACE_WRAP {
        first = first % texels;
        first = select(first, first + texels, first < vec2<i32>(0));
        cells = texels;
    }
    return SurfaceGrid(texels, cells, first, texel - base, 1.0 / scale, travel, inverse, address);
}

// Largest number of cells that a ray is assumed to cross.
const SURFACE_MAX_CROSSED: f32 = 16384.0;

// Upper bound of the number of steps of a ray. In these steps, the ray can visit each node that it touches once.
fn surface_bound(grid: SurfaceGrid, levels: u32) -> u32 {
    let crossed = min(abs(grid.travel.x) + abs(grid.travel.y), SURFACE_MAX_CROSSED);
    return 2u * (u32(crossed) + 3u) + levels;
}

// Node of 2^level × 2^level cells that contains a cell. Nodes end at the tile's edge.
fn surface_node(grid: SurfaceGrid, cell: vec2<i32>, level: u32) -> SurfaceNode {
    let shift = vec2<u32>(level);
    let absolute = grid.base + cell;
    var inside: vec2<i32>;
    var tile: vec2<i32>;
    if grid.address == SURFACE_WRAP {
        // Rays cross some hundred tiles at most, so the quotient for a cell's center is exact enough for floor.
        let whole = vec2<i32>(floor((vec2<f32>(absolute) + 0.5) * grid.tiles)) * grid.size;
        inside = absolute - whole;
        tile = whole - grid.base;
    } else {
        inside = clamp(absolute + 1, vec2<i32>(0), grid.size);
        tile = -1 - grid.base;
    }
    let index = inside >> shift;
    let first = index << shift;
    let last = min(first + (vec2<i32>(1) << shift), grid.cells);
    var low = tile + first;
    var high = tile + last;
    if grid.address != SURFACE_WRAP {
        low = select(low, vec2<i32>(-SURFACE_FAR), first == vec2<i32>(0));
        high = select(high, vec2<i32>(SURFACE_FAR), last == grid.cells);
    }
    return SurfaceNode(index, low, high);
}

// Ray parameters at which the ray would leave a node through its x edge (x) and through its y edge (y).
fn surface_exits(grid: SurfaceGrid, node: SurfaceNode) -> vec2<f32> {
    let edge = select(node.low, node.high, grid.travel >= vec2<f32>(0.0));
    let exits = (vec2<f32>(edge) - grid.start) * grid.inverse;
    return select(exits, vec2<f32>(SURFACE_NEVER), grid.inverse == vec2<f32>(0.0));
}

// Cell that contains the ray's point at `parameter`, clamped to the cells of a node.
fn surface_cell(grid: SurfaceGrid, node: SurfaceNode, parameter: f32) -> vec2<i32> {
    let at = vec2<i32>(floor(grid.start + parameter * grid.travel));
    return clamp(at, node.low, node.high - 1);
}

// Cell beyond the edge through which the ray leaves a node.
fn surface_beyond(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, parameter: f32) -> vec2<i32> {
    var next = surface_cell(grid, node, parameter);
    if exits.x <= exits.y {
        next.x = select(node.low.x - 1, node.high.x, grid.travel.x >= 0.0);
    } else {
        next.y = select(node.low.y - 1, node.high.y, grid.travel.y >= 0.0);
    }
    return next;
}

// Heights at the four corners of a cell: (0,0), (1,0), (0,1), (1,1).
fn surface_corners(heights: texture_2d<f32>, grid: SurfaceGrid, index: vec2<i32>) -> vec4<f32> {
    var low = index;
    var high = index + 1;
    if grid.address == SURFACE_WRAP {
        high = select(high, vec2<i32>(0), high >= grid.size);
    } else {
        low = max(index - 1, vec2<i32>(0));
        high = min(index, grid.size - 1);
    }
    return vec4<f32>(
        textureLoad(heights, low, 0).r,
        textureLoad(heights, vec2<i32>(high.x, low.y), 0).r,
        textureLoad(heights, vec2<i32>(low.x, high.y), 0).r,
        textureLoad(heights, high, 0).r);
}

// First ray parameter in enter..=leave at which the ray is on or below the bilinear patch of a cell; -1 if there is none. `low`
// is the corner to which the patch is relative (`surface_corner`). The ray's height above a patch is a quadratic function of
// the parameter.
fn surface_patch(grid: SurfaceGrid, corners: vec4<f32>, low: vec2<i32>, enter: f32, leave: f32) -> f32 {
    let at = (grid.start - vec2<f32>(low)) + enter * grid.travel;
    let slope = vec2<f32>(corners.y - corners.x, corners.z - corners.x);
    let twist = (corners.w - corners.z) - slope.x;
    let length = leave - enter;
    let ahead = grid.travel * length;
    let height = corners.x + slope.x * at.x + (slope.y + twist * at.x) * at.y;
    // The quadratic is a·x² + 2·b·x + c over x in 0..=1; `b` is half of the linear coefficient.
    let c = 1.0 - enter - height;
    if c <= 0.0 {
        return enter;
    }
    let b = -0.5 * (length + slope.x * ahead.x + slope.y * ahead.y + twist * (at.x * ahead.y + at.y * ahead.x));
    let a = -twist * ahead.x * ahead.y;
    let discriminant = b * b - a * c;
    let root = sqrt(max(discriminant, 0.0));
    // The smaller positive root, in a form without a difference of nearly equal numbers. The root is in 0..=1 only if the
    // denominator is at least as large as the numerator. A ray that moves away from the surface (b > 0) meets it again only if
    // the surface rises towards the ray (a < 0).
    let over = select(c, b + root, b > 0.0);
    let under = select(root - b, -a, b > 0.0);
    if discriminant >= 0.0 && under >= over {
        return enter + length * (over / under);
    }
    return select(-1.0, leave, a + 2.0 * b + c <= 0.0);
}

// Corner to which a leaf's patch is relative. Along an axis where the leaf extends to infinity, heights are constant, and any
// corner will do.
fn surface_corner(leaf: SurfaceNode) -> vec2<i32> {
    return select(leaf.low, leaf.high - 1, leaf.low == vec2<i32>(-SURFACE_FAR));
}

// From relievo's wgsl/surface/atlas.wgsl.
// Layout of a max-mip pyramid's nodes in one plane. Level 0 lies at the left. The other levels are stacked to its right, from a
// column that is a multiple of four. Every level has ⌈cells / 2^level⌉ nodes per axis.

// Number of levels of a pyramid, from one node per cell up to a single node.
fn surface_levels(cells: vec2<u32>) -> u32 {
    let longest = max(cells.x, cells.y);
    return select(firstLeadingBit(longest - 1u) + 2u, 1u, longest <= 1u);
}

// Texel of a node, given the node's level (0 for cells) and its index at that level.
fn surface_atlas_at(cells: vec2<u32>, level: u32, index: vec2<i32>) -> vec2<i32> {
    if level == 0u {
        return index;
    }
    // Upper bound of the number of rows of levels 1 to level - 1. Level k has at most (r >> 1) + 1 rows, where
    // r = cells.y >> (k - 1). The bound adds r - (r >> 1) + 1 for each k instead, which is at least as large and has a short
    // sum.
    let above = cells.y - (cells.y >> (level - 1u)) + level - 1u;
    return index + vec2<i32>(vec2<u32>((cells.x + 3u) & ~3u, above));
}

// Index of the texel at the first corner of a cell, among the texels of all maps of a batch. `cell` may be one beyond the last
// cell along each axis.
fn surface_corner_index(size: vec2<u32>, address: u32, map: u32, cell: vec2<i32>) -> u32 {
    let texels = vec2<i32>(size);
    let wrapped = select(cell, vec2<i32>(0), cell >= texels);
    let clamped = clamp(cell - 1, vec2<i32>(0), texels - 1);
    let at = vec2<u32>(select(clamped, wrapped, address == SURFACE_WRAP));
    return (map * size.y + at.y) * size.x + at.x;
}
