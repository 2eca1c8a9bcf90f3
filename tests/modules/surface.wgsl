// A shader of somebody's own behind the module: every method meets a flat surface at half the depth, from given
// directions (x of the unit vector towards the eye).
@group(0) @binding(0) var<storage, read> given: array<f32>;
@group(0) @binding(1) var<storage, read_write> results: array<u32>;
@group(0) @binding(2) var heights: texture_2d<f32>;
@group(0) @binding(3) var acceleration: texture_2d<f32>;

override METHOD: u32 = SURFACE_QUADTREE;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&given) {
        return;
    }
    let x = given[id.x];
    let eye = vec3<f32>(x, 0.0, sqrt(1.0 - x * x));
    let ray = surface_ray(vec2<f32>(0.25, 0.25), eye, 0.125, 1.0);
    let march = SurfaceMarch(SURFACE_WRAP, 16u, 16u, 16u, 0u);
    let hit = surface_trace(METHOD, heights, acceleration, ray, march);
    let normal = surface_normal(heights, hit.uv, 0.125, march);
    results[3u * id.x] = bitcast<u32>(hit.uv.x);
    results[3u * id.x + 1u] = bitcast<u32>(hit.height);
    results[3u * id.x + 2u] = bitcast<u32>(normal.z);
}
