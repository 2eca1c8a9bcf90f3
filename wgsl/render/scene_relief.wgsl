// The kind `relief`: instances of a static mesh with a relief (B section 3.1, tables 4.1 to 4.4), traced by any method. It has
// self-shadow, silhouettes and the depth of the relief.
// kind relief: deep
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex};
import package::wgsl::render::scene_instances::{scene_last_rigid, scene_surface};
import package::wgsl::render::scene_motion::last_position;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_vertex::placed_vertex;
import package::wgsl::render::scene_view::view;
import package::wgsl::surface::ray::{SurfaceHit, SurfaceMarch, SurfaceRay, surface_inside, surface_ray};
import package::wgsl::surface::height::surface_mip;
import package::wgsl::surface::trace::surface_trace;
import package::wgsl::surface::shade::{surface_depth, surface_distance, surface_normal, surface_towards};
import package::wgsl::surface::sunlit::{SurfaceShadow, surface_mapped_normal, surface_sunlit};

// A method of wgsl/surface/trace.wgsl.
override METHOD: u32 = 3u;
// A shadow of wgsl/surface/sunlit.wgsl.
override SHADOW: u32 = 0u;
// Whether normals come from the normal map and not from the heights.
override NORMAL_MAP: bool = false;
// Whether the green channel of the normal map points up its image, against v, as in glTF and OpenGL, or down it, as in
// Direct3D.
override GREEN_UP: bool = true;
// Whether to discard points outside the range of uv that the mesh covers.
override SILHOUETTE: bool = false;
// Whether to choose the mip level of the heights from the size of a pixel, once per fragment.
override CHOOSE_MIP: bool = false;
// Lower bound of the cosine between the light and the polygon's normal. It bounds the light's way out of the relief volume.
const LEAST_COSINE: f32 = 0.05;

// Parameters of a relief. Its maps have bindings of their own.
struct ReliefParams {
    // Range of uv that the mesh covers: lower end (xy) and upper end (zw).
    range: vec4<f32>,
    // Linear RGB that multiplies the texture.
    color: vec4<f32>,
    // Depth of the relief in uv units, and height of the polygon in the relief, 0 (bottom) to 1 (top).
    scale: f32,
    plane: f32,
    // The model's units per uv unit.
    world: f32,
    // For soft shadow: number of steps, and the ratio of excess height to distance at which shadow is full.
    shadow_steps: u32,
    softness: f32,
}

@group(2) @binding(0) var<uniform> relief: ReliefParams;
@group(2) @binding(1) var<uniform> march: SurfaceMarch;
@group(2) @binding(2) var heights: texture_2d<f32>;
// The acceleration map of the method; any texture if it needs none.
@group(2) @binding(3) var acceleration: texture_2d<f32>;
@group(2) @binding(4) var albedo: texture_2d<f32>;
// The normal map; any texture without `NORMAL_MAP`.
@group(2) @binding(5) var normals: texture_2d<f32>;
@group(2) @binding(6) var filtering: sampler;
// Filters the normal map.
@group(2) @binding(7) var normal_filtering: sampler;

// The first value of a vertex: world units per uv unit.
fn relief_place(entry: u32, vertex: u32) -> SceneVertex {
    var placed = placed_vertex(entry, vertex);
    placed.values.x = relief.world * length(placed.tangent.xyz);
    return placed;
}

fn relief_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return last_position(entry, vertex);
}

// The frame of a fragment's tangent space: unit vectors along u, along v, and outwards.
struct Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    normal: vec3<f32>,
}

// Result of tracing the eye's ray through a fragment.
struct Traced {
    hit: SurfaceHit,
    frame: Frame,
    settings: SurfaceMarch,
    // Relative to the corner of the view's cell.
    position: vec3<f32>,
    depth: f32,
    is_outside: bool,
}

// `uv_dx` and `uv_dy` are the derivatives of the polygon's own coordinates.
fn traced(in: SceneFragment, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> Traced {
    let normal = normalize(in.normal);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let frame = Frame(tangent, in.tangent.w * cross(normal, tangent), normal);
    let towards = surface_towards(view.eye, in.position);
    var settings = march;
    if CHOOSE_MIP {
        settings.mip = surface_mip(heights, uv_dx, uv_dy);
    }
    let ray = surface_ray(in.uv.xy, in_frame(frame, towards), relief.scale, relief.plane);
    let hit = surface_trace(METHOD, heights, acceleration, ray, settings);
    let distance = surface_distance(ray, hit, relief.scale) * in.values.x;
    let depth = surface_depth(view.clip_from_world, in.position, towards, distance);
    let is_outside = SILHOUETTE && !surface_inside(hit.uv, relief.range.xy, relief.range.zw);
    return Traced(hit, frame, settings, in.position - towards * distance, depth, is_outside);
}

fn in_frame(frame: Frame, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(frame.tangent, direction), dot(frame.bitangent, direction), dot(frame.normal, direction));
}

fn in_world(frame: Frame, direction: vec3<f32>) -> vec3<f32> {
    return direction.x * frame.tangent + direction.y * frame.bitangent + direction.z * frame.normal;
}

// Point where the ray from a hit towards the sun leaves the relief volume. The relief's own shadow ends there; shadows of
// everything else begin there.
fn above(in: SceneFragment, found: Traced) -> vec3<f32> {
    let cosine = dot(found.frame.normal, view.light.xyz);
    let deep = (1.0 - found.hit.height) * relief.scale * in.values.x;
    return found.position + view.light.xyz * select(0.0, deep / max(cosine, LEAST_COSINE), cosine > 0.0);
}

fn relief_surface(in: SceneFragment) -> Surface {
    let uv_dx = dpdx(in.uv.xy);
    let uv_dy = dpdy(in.uv.xy);
    let found = traced(in, uv_dx, uv_dy);
    let hit = found.hit;
    var facing = surface_normal(heights, hit.uv, relief.scale, found.settings);
    if NORMAL_MAP {
        facing = surface_mapped_normal(textureSampleGrad(normals, normal_filtering, hit.uv, uv_dx, uv_dy), GREEN_UP);
    }
    var surface = scene_surface(in);
    surface.position = found.position;
    surface.normal = in_world(found.frame, facing);
    surface.geometric_normal = found.frame.normal;
    surface.uv = hit.uv;
    surface.color =
        textureSampleGrad(albedo, filtering, hit.uv, uv_dx, uv_dy).rgb * relief.color.rgb * surface.tint.rgb;
    // Outside the range of uv nothing is drawn.
    surface.alpha = select(1.0, 0.0, found.is_outside);
    surface.cutoff = 0.5;
    surface.sunlit = surface_sunlit(
        METHOD, SHADOW, heights, acceleration, hit, in_frame(found.frame, view.light.xyz),
        SurfaceShadow(relief.scale, relief.shadow_steps, relief.softness), found.settings);
    surface.light_position = above(in, found);
    surface.last_position = scene_last_rigid(in.instance, found.position);
    surface.depth = found.depth;
    return surface;
}
