// Traces a list of rays by one method and stores the hits. The kernel uses the same functions as fragment shaders.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::trace::surface_trace;

// Tracing method: one of the constants of wgsl/surface/trace.wgsl.
override METHOD: u32 = 0u;

// Parameters of the ray march.
@group(0) @binding(0) var<uniform> march: SurfaceMarch;
// Height map: the red channel is the height, 0 to 1.
@group(0) @binding(1) var heights: texture_2d<f32>;
// Acceleration map of the method. Methods without an acceleration map accept any texture.
@group(0) @binding(2) var acceleration: texture_2d<f32>;
// Rays to trace.
@group(0) @binding(3) var<storage, read> rays: array<SurfaceRay>;
// Out: hit of each ray.
@group(0) @binding(4) var<storage, read_write> hits: array<SurfaceHit>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&rays) {
        return;
    }
    hits[index] = surface_trace(METHOD, heights, acceleration, rays[index], march);
}
