// Shading of a displaced point: its normal, from the heights around the point, and its depth.
import package::wgsl::surface::ray::{SURFACE_LEAST_COSINE, SurfaceHit, SurfaceMarch, SurfaceRay};
import package::wgsl::surface::height::surface_height;

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
