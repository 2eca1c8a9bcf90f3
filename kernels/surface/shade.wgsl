// Shades a list of points with the functions that fragment shaders use, and stores the results: hard and soft self-shadow, and
// the depth of the relief.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_towards};
import package::wgsl::surface::shadow::{surface_light_ray, surface_shaded, surface_soft_shadow};

// Tracing method of hard shadow: one of the constants of wgsl/surface/trace.wgsl.
override METHOD: u32 = 0u;

// View and shadow parameters that all points of a list share.
struct ShadeView {
    // Matrix from world space to clip space, with depth 0 to 1.
    clip_from_world: mat4x4<f32>,
    // Position of the eye in world space (w = 1). In a parallel projection, the direction towards the eye (w = 0).
    eye: vec4<f32>,
    // Number of heights that a soft shadow samples on the path to the light, 1 to `MAX_STEPS`.
    shadow_steps: u32,
    // Softness of a soft shadow, 0.001 to 1000: the shadow is full where the surface rises above the light's path by at least
    // this factor times the distance from the shaded point.
    softness: f32,
}

// A point of a relief, where a ray from the eye met the surface.
struct ShadePoint {
    // Unit vector towards the light, in tangent space.
    light: vec3<f32>,
    // Depth of the relief in uv units.
    scale: f32,
    // Point where the eye's ray meets the polygon, in world space.
    position: vec3<f32>,
    // Number of world units per uv unit.
    world: f32,
    // Ray from the eye.
    ray: SurfaceRay,
    // Hit of the eye's ray.
    hit: SurfaceHit,
}

// Shading of a point.
struct Shade {
    // 1 if the light's ray reaches the point, else 0.
    hard: f32,
    // Light under soft shadow, 0 (full shadow) to 1 (full light).
    soft: f32,
    // Depth of the relief at the point, 0 (near) to 1 (far).
    depth: f32,
}

// View and shadow parameters.
@group(0) @binding(0) var<uniform> view: ShadeView;
// Parameters of the ray march.
@group(0) @binding(1) var<uniform> march: SurfaceMarch;
// Height map: the red channel is the height, 0 to 1.
@group(0) @binding(2) var heights: texture_2d<f32>;
// Acceleration map of the method. Methods without an acceleration map accept any texture.
@group(0) @binding(3) var acceleration: texture_2d<f32>;
// Points to shade.
@group(0) @binding(4) var<storage, read> points: array<ShadePoint>;
// Out: shading of each point.
@group(0) @binding(5) var<storage, read_write> shades: array<Shade>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&points) {
        return;
    }
    let point = points[index];
    let light = point.light;
    let scale = point.scale;
    let first = surface_trace(METHOD, heights, acceleration, surface_light_ray(point.hit, light, scale), march);
    let soft = surface_soft_shadow(
        heights, point.hit, light, scale, march, view.shadow_steps, view.softness);
    let towards = surface_towards(view.eye, point.position);
    let distance = surface_distance(point.ray, point.hit, scale) * point.world;
    let depth = surface_depth(view.clip_from_world, point.position, towards, distance);
    let hard = select(1.0, 0.0, surface_shaded(first, point.hit));
    shades[index] = Shade(hard, soft, depth);
}
