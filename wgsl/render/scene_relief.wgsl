// The kind `relief`: instances of a static mesh with a relief (thesis B section 3.1, tables 4.1 to 4.4). Any method may trace the
// relief. The kind has self-shadow and silhouettes, and writes the depth of the relief.
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

// Tracing method: one of the constants of wgsl/surface/trace.wgsl.
override METHOD: u32 = 3u;
// Kind of self-shadow: one of the constants of wgsl/surface/sunlit.wgsl.
override SHADOW: u32 = 0u;
// Whether normals come from the normal map instead of the heights.
override NORMAL_MAP: bool = false;
// Direction of the normal map's green channel. If true, it points up the image, against v, as in glTF and OpenGL. If false, it
// points down the image, as in Direct3D.
override GREEN_UP: bool = true;
// Whether to discard points outside the range of uv that the mesh covers.
override SILHOUETTE: bool = false;
// Whether to choose the mip level of the heights from the size of a pixel, once per fragment.
override CHOOSE_MIP: bool = false;
// Lower bound of the cosine between the light and the polygon's normal. It limits the length of the light's path in the relief
// volume.
const LEAST_COSINE: f32 = 0.05;

// Parameters of a relief. The relief's maps have bindings of their own.
struct ReliefParams {
    // Range of uv that the mesh covers: lower end (xy) and upper end (zw).
    range: vec4<f32>,
    // Linear RGB that multiplies the texture.
    color: vec4<f32>,
    // Depth of the relief, in uv units.
    scale: f32,
    // Height of the polygon in the relief, 0 (bottom) to 1 (top).
    plane: f32,
    // Model units per uv unit.
    world: f32,
    // Number of steps of a soft shadow.
    shadow_steps: u32,
    // Softness of a soft shadow: the shadow is full where the surface rises above the light's path by at least this factor
    // times the distance from the shaded point.
    softness: f32,
}

// Parameters of the relief.
@group(2) @binding(0) var<uniform> relief: ReliefParams;
// Parameters of the ray march.
@group(2) @binding(1) var<uniform> march: SurfaceMarch;
// Height map: the red channel is the height, 0 to 1.
@group(2) @binding(2) var heights: texture_2d<f32>;
// Acceleration map of the tracing method. Methods without an acceleration map accept any texture.
@group(2) @binding(3) var acceleration: texture_2d<f32>;
// Colour texture.
@group(2) @binding(4) var albedo: texture_2d<f32>;
// Normal map. Any texture may be bound if `NORMAL_MAP` is false.
@group(2) @binding(5) var normals: texture_2d<f32>;
// Sampler of the colour texture.
@group(2) @binding(6) var filtering: sampler;
// Sampler of the normal map.
@group(2) @binding(7) var normal_filtering: sampler;

// Places a vertex of the relief's mesh. The first value of the result is the number of world units per uv unit.
fn relief_place(entry: u32, vertex: u32) -> SceneVertex {
    var placed = placed_vertex(entry, vertex);
    placed.values.x = relief.world * length(placed.tangent.xyz);
    return placed;
}

// Position of a polygon's vertex in the last frame, relative to the corner of the view's cell.
fn relief_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return last_position(entry, vertex);
}

// Tangent frame of a fragment: unit vectors along u, along v, and outwards.
struct Frame {
    // Unit vector along u.
    tangent: vec3<f32>,
    // Unit vector along v.
    bitangent: vec3<f32>,
    // Outward unit normal.
    normal: vec3<f32>,
}

// Result of tracing the eye's ray through a fragment.
struct Traced {
    // Point where the ray meets the relief.
    hit: SurfaceHit,
    // Tangent frame of the fragment.
    frame: Frame,
    // Parameters of the march, with the mip level used.
    settings: SurfaceMarch,
    // Position of the hit, relative to the corner of the view's cell.
    position: vec3<f32>,
    // Depth of the hit, 0 to 1.
    depth: f32,
    // Whether the hit lies outside the mesh's range of uv and is discarded.
    is_outside: bool,
}

// Traces the eye's ray through a fragment. `uv_dx` and `uv_dy` are the screen derivatives of the polygon's uv.
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

// Converts a direction from world space to a tangent frame.
fn in_frame(frame: Frame, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(frame.tangent, direction), dot(frame.bitangent, direction), dot(frame.normal, direction));
}

// Converts a direction from a tangent frame to world space.
fn in_world(frame: Frame, direction: vec3<f32>) -> vec3<f32> {
    return direction.x * frame.tangent + direction.y * frame.bitangent + direction.z * frame.normal;
}

// Point where the ray from a hit towards the sun leaves the relief volume. Below this point, the relief can shade itself; above
// it, only other objects can shade the relief.
fn above(in: SceneFragment, found: Traced) -> vec3<f32> {
    let cosine = dot(found.frame.normal, view.light.xyz);
    let deep = (1.0 - found.hit.height) * relief.scale * in.values.x;
    return found.position + view.light.xyz * select(0.0, deep / max(cosine, LEAST_COSINE), cosine > 0.0);
}

// Surface of a fragment, at the hit of the eye's ray with the relief.
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
    // Points outside the mesh's range of uv are not drawn.
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
