// Shades a list of points as fragment passes do, and stores the results: hard and soft self-shadow, and the
// depth of the relief.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_towards};
import package::wgsl::surface::shadow::{surface_light_ray, surface_shaded, surface_soft_shadow};

override METHOD: u32 = 0u;

struct ShadeView {
    clip_from_world: mat4x4<f32>,
    // The position of the eye (w = 1), or the direction towards it (w = 0).
    eye: vec4<f32>,
    // For soft shadow: number of steps, and the ratio of excess height to distance at which shadow is full.
    shadow_steps: u32,
    softness: f32,
}

struct ShadePoint {
    // Unit vector towards the light in tangent space; w: depth of the relief in uv units.
    light: vec4<f32>,
    // The point where the eye's ray meets the polygon, in world space; w: world units per uv unit.
    position: vec4<f32>,
    // The eye's ray, and its hit.
    ray: SurfaceRay,
    hit: SurfaceHit,
}

struct Shade {
    // 1 if the light's ray ends in the point, else 0.
    hard: f32,
    // Light, 0 in full shadow to 1 in full light.
    soft: f32,
    // Depth, 0 (near) to 1 (far).
    depth: f32,
}

@group(0) @binding(0) var<uniform> view: ShadeView;
@group(0) @binding(1) var<uniform> march: SurfaceMarch;
@group(0) @binding(2) var heights: texture_2d<f32>;
@group(0) @binding(3) var acceleration: texture_2d<f32>;
@group(0) @binding(4) var<storage, read> points: array<ShadePoint>;
@group(0) @binding(5) var<storage, read_write> shades: array<Shade>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&points) {
        return;
    }
    let point = points[index];
    let light = point.light.xyz;
    let scale = point.light.w;
    let first = surface_trace(METHOD, heights, acceleration, surface_light_ray(point.hit, light, scale), march);
    let soft = surface_soft_shadow(
        heights, point.hit, light, scale, march, view.shadow_steps, view.softness);
    let towards = surface_towards(view.eye, point.position.xyz);
    let distance = surface_distance(point.ray, point.hit, scale) * point.position.w;
    let depth = surface_depth(view.clip_from_world, point.position.xyz, towards, distance);
    let hard = select(1.0, 0.0, surface_shaded(first, point.hit));
    shades[index] = Shade(hard, soft, depth);
}
