// Draws meshes with relief (B section 3.1, tables 4.1 to 4.4) by any method, with self-shadow, silhouettes and
// the depth of the relief. The method and the options are override constants; everything else is a uniform.
import package::wgsl::light::lambert;
import package::wgsl::surface::ray::{SurfaceMarch, surface_inside, surface_ray};
import package::wgsl::surface::height::surface_mip;
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_normal, surface_towards};
import package::wgsl::surface::sunlit::{SurfaceShadow, surface_mapped_normal, surface_sunlit};

// A method of wgsl/surface/trace.wgsl.
override METHOD: u32 = 3u;
// 0 for none, 1 for hard, 2 for soft.
override SHADOW: u32 = 0u;
// Whether normals come from the normal map and not from the heights.
override NORMAL_MAP: bool = false;
// Whether the green channel of the normal map points up its image, against v, as in glTF and OpenGL, or down
// it, as in Direct3D.
override GREEN_UP: bool = true;
// Whether to discard points outside the range of uv that the mesh covers.
override SILHOUETTE: bool = false;
// Whether to choose the mip level of the heights from the size of a pixel, once per fragment.
override CHOOSE_MIP: bool = false;

struct ReliefView {
    clip_from_world: mat4x4<f32>,
    // The position of the eye (w = 1), or the direction towards it (w = 0).
    eye: vec4<f32>,
    // Unit vector towards the light; w: the light that shadowed points still receive, 0..1.
    light: vec4<f32>,
    // The mesh's range of uv: lower and upper end.
    range: vec4<f32>,
    // Depth of the relief in uv units, and height of the polygon in the relief.
    scale: f32,
    plane: f32,
    // World units per uv unit.
    world: f32,
    // For soft shadow: number of steps, and the ratio of excess height to distance at which shadow is full.
    shadow_steps: u32,
    softness: f32,
}

@group(0) @binding(0) var<uniform> view: ReliefView;
@group(0) @binding(1) var<uniform> march: SurfaceMarch;
@group(0) @binding(2) var heights: texture_2d<f32>;
@group(0) @binding(3) var acceleration: texture_2d<f32>;
@group(0) @binding(4) var albedo: texture_2d<f32>;
@group(0) @binding(5) var normals: texture_2d<f32>;
@group(0) @binding(6) var filtering: sampler;

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) world: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
}

@vertex
fn vertex(
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    // w: the bitangent along v is w · normal × tangent. glTF's bitangent points against v, so that its w has
    // the opposite sign.
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
) -> Vertex {
    return Vertex(view.clip_from_world * vec4<f32>(position, 1.0), position, normal, tangent, uv);
}

struct Shaded {
    color: vec4<f32>,
    depth: f32,
    is_outside: bool,
}

fn shaded(in: Vertex) -> Shaded {
    // Derivatives need uniform control flow, so they are taken here, of the polygon's own coordinates.
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let normal = normalize(in.normal);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let bitangent = in.tangent.w * cross(normal, tangent);
    let towards = surface_towards(view.eye, in.world);
    let eye = vec3<f32>(dot(tangent, towards), dot(bitangent, towards), dot(normal, towards));
    var settings = march;
    if CHOOSE_MIP {
        settings.mip = surface_mip(heights, uv_dx, uv_dy);
    }
    let ray = surface_ray(in.uv, eye, view.scale, view.plane);
    let hit = surface_trace(METHOD, heights, acceleration, ray, settings);
    let color = textureSampleGrad(albedo, filtering, hit.uv, uv_dx, uv_dy).rgb;
    var facing = surface_normal(heights, hit.uv, view.scale, settings);
    if NORMAL_MAP {
        facing = surface_mapped_normal(textureSampleGrad(normals, filtering, hit.uv, uv_dx, uv_dy), GREEN_UP);
    }
    let light = vec3<f32>(dot(tangent, view.light.xyz), dot(bitangent, view.light.xyz), dot(normal, view.light.xyz));
    let direct = max(dot(facing, light), 0.0) * surface_sunlit(
        METHOD, SHADOW, heights, acceleration, hit, light,
        SurfaceShadow(view.scale, view.shadow_steps, view.softness), settings);
    let lit = lambert(color, view.light.w, direct);
    let distance = surface_distance(ray, hit, view.scale) * view.world;
    let depth = surface_depth(view.clip_from_world, in.world, towards, distance);
    let is_outside = SILHOUETTE && !surface_inside(hit.uv, view.range.xy, view.range.zw);
    return Shaded(vec4<f32>(lit, 1.0), depth, is_outside);
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4<f32> {
    let result = shaded(in);
    if result.is_outside {
        discard;
    }
    return result.color;
}

struct Deep {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

// Writes the depth of the relief and not that of the polygon, for intersections with other geometry and for
// shadow maps.
@fragment
fn fragment_depth(in: Vertex) -> Deep {
    let result = shaded(in);
    if result.is_outside {
        discard;
    }
    return Deep(result.color, result.depth);
}
