// Runs one method, by the functions that fragment passes import, on a list of rays, and stores the hits.
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::trace::surface_trace;

override METHOD: u32 = 0u;

@group(0) @binding(0) var<uniform> march: SurfaceMarch;
@group(0) @binding(1) var heights: texture_2d<f32>;
@group(0) @binding(2) var acceleration: texture_2d<f32>;
@group(0) @binding(3) var<storage, read> rays: array<SurfaceRay>;
@group(0) @binding(4) var<storage, read_write> hits: array<SurfaceHit>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let index = id.y * groups.x * 64u + id.x;
    if index >= arrayLength(&rays) {
        return;
    }
    hits[index] = surface_trace(METHOD, heights, acceleration, rays[index], march);
}
