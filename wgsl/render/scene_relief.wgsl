// Draws instances of a static mesh of a scene with relief (B section 3.1, tables 4.1 to 4.4) by any method, with
// self-shadow, silhouettes and the depth of the relief.
import package::wgsl::render::scene_motion::rows_to_last;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_shadow::{SHADOWED, scene_sunlit};
import package::wgsl::render::scene_vertex::{instances, mesh, placed_vertex};
import package::wgsl::render::scene_view::{MeasureTargets, SurfaceTargets, scene_measure_targets, scene_place, scene_shaded, scene_surface_targets, scene_velocity, view};
import package::wgsl::skinning::rows::{Rows, placed_position};
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
// Whether pictures in colour have the depth of the relief and not that of the polygon.
override OWN_DEPTH: bool = false;
// Whether depth falls with distance, from 1 at the near plane.
override REVERSED: bool = false;

// The smallest cosine of the angle between the light and the normal of the polygon, for the way out of the volume.
const LEAST_COSINE: f32 = 0.05;

// A relief, besides its maps.
struct ReliefParams {
    // The mesh's range of uv: lower and upper end.
    range: vec4<f32>,
    // Linear red, green and blue, by which the texture is multiplied.
    color: vec4<f32>,
    // Depth of the relief in uv units, and height of the polygon in the relief.
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
// The acceleration map of the method, or any texture.
@group(2) @binding(3) var acceleration: texture_2d<f32>;
@group(2) @binding(4) var albedo: texture_2d<f32>;
// Any texture without `NORMAL_MAP`.
@group(2) @binding(5) var normals: texture_2d<f32>;
@group(2) @binding(6) var filtering: sampler;
// Filters the normal map.
@group(2) @binding(7) var normal_filtering: sampler;

struct Vertex {
    // The layers of a view give equal bits.
    @invariant @builtin(position) clip: vec4<f32>,
    // Relative to the corner of the view's cell.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
    // The factor of the instance's colours, 8 bits each, and the index of the instance in the object.
    @location(4) @interpolate(flat) instance: vec2<u32>,
    // World units per uv unit.
    @location(5) world: f32,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @location(0) instance: u32) -> Vertex {
    let placed = placed_vertex(instance, vertex);
    return Vertex(
        view.clip_from_world * vec4<f32>(placed.position, 1.0),
        placed.position,
        placed.normal,
        placed.tangent,
        placed.uv,
        vec2<u32>(placed.tint, instance),
        relief.world * placed.stretch);
}

// A vertex with what there is to know of its motion.
struct MovingVertex {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec2<f32>,
    @location(4) @interpolate(flat) instance: vec2<u32>,
    @location(5) world: f32,
    // The transform from where the instance is to where it was in the last frame.
    @location(6) @interpolate(flat) last_x: vec4<f32>,
    @location(7) @interpolate(flat) last_y: vec4<f32>,
    @location(8) @interpolate(flat) last_z: vec4<f32>,
}

@vertex
fn vertex_moving(@builtin(vertex_index) vertex: u32, @location(0) instance: u32) -> MovingVertex {
    let placed = placed_vertex(instance, vertex);
    let last = rows_to_last(mesh.first_instance + instance);
    return MovingVertex(
        view.clip_from_world * vec4<f32>(placed.position, 1.0),
        placed.position,
        placed.normal,
        placed.tangent,
        placed.uv,
        vec2<u32>(placed.tint, instance),
        relief.world * placed.stretch,
        last.x,
        last.y,
        last.z);
}

// The frame of a fragment's tangent space: unit vectors along u, along v, and outwards.
struct Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    normal: vec3<f32>,
}

// What the eye's ray through a fragment finds.
struct Traced {
    hit: SurfaceHit,
    frame: Frame,
    settings: SurfaceMarch,
    // Relative to the corner of the view's cell.
    position: vec3<f32>,
    depth: f32,
    is_outside: bool,
}

// Derivatives need uniform control flow, so the caller takes them, of the polygon's own coordinates.
fn traced(in: Vertex, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> Traced {
    let normal = normalize(in.normal);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let frame = Frame(tangent, in.tangent.w * cross(normal, tangent), normal);
    let towards = surface_towards(view.eye, in.position);
    var settings = march;
    if CHOOSE_MIP {
        settings.mip = surface_mip(heights, uv_dx, uv_dy);
    }
    let ray = surface_ray(in.uv, in_frame(frame, towards), relief.scale, relief.plane);
    let hit = surface_trace(METHOD, heights, acceleration, ray, settings);
    let distance = surface_distance(ray, hit, relief.scale) * in.world;
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

fn surface_of(in: Vertex, found: Traced, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> Surface {
    let hit = found.hit;
    let tint = unpack4x8unorm(in.instance.x);
    let color = textureSampleGrad(albedo, filtering, hit.uv, uv_dx, uv_dy).rgb * relief.color.rgb * tint.rgb;
    var facing = surface_normal(heights, hit.uv, relief.scale, found.settings);
    if NORMAL_MAP {
        facing = surface_mapped_normal(textureSampleGrad(normals, normal_filtering, hit.uv, uv_dx, uv_dy), GREEN_UP);
    }
    let sunlit = surface_sunlit(
        METHOD, SHADOW, heights, acceleration, hit, in_frame(found.frame, view.light.xyz),
        SurfaceShadow(relief.scale, relief.shadow_steps, relief.softness), found.settings);
    return Surface(
        found.position, in_world(found.frame, facing), found.frame.normal, hit.uv, color, 1.0, sunlit, tint,
        instances[mesh.first_instance + in.instance.y].word, mesh.object, in.instance.y, in.clip.xy);
}

fn shaded(in: Vertex, found: Traced, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> vec4<f32> {
    var seen = surface_of(in, found, uv_dx, uv_dy);
    if SHADOWED {
        seen.sunlit *= scene_sunlit(above(in, found), found.frame.normal);
    }
    return scene_shaded(seen);
}

// Where the ray from a hit towards the sun leaves the volume of the relief. The relief's own shadow ends there, and that of
// everything else begins.
fn above(in: Vertex, found: Traced) -> vec3<f32> {
    let cosine = dot(found.frame.normal, view.light.xyz);
    let deep = (1.0 - found.hit.height) * relief.scale * in.world;
    return found.position + view.light.xyz * select(0.0, deep / max(cosine, LEAST_COSINE), cosine > 0.0);
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4<f32> {
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let found = traced(in, uv_dx, uv_dy);
    let color = shaded(in, found, uv_dx, uv_dy);
    if found.is_outside {
        discard;
    }
    return color;
}

struct Deep {
    @location(0) color: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

// Writes the depth of the relief and not that of the polygon, for intersections with other geometry.
@fragment
fn fragment_deep(in: Vertex) -> Deep {
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let found = traced(in, uv_dx, uv_dy);
    let color = shaded(in, found, uv_dx, uv_dy);
    if found.is_outside {
        discard;
    }
    return Deep(color, found.depth);
}

// Writes the depth of the relief, never in front of what the same fragment has in colour, so that a picture in colour
// passes a test for less or equal behind it: two pipelines may round differently, and the polygon's depth varies between
// the samples of a pixel.
@fragment
fn depth_relief(in: Vertex) -> @builtin(frag_depth) f32 {
    let polygon = in.clip.z;
    let slope = fwidth(polygon);
    let found = traced(in, dpdx(in.uv), dpdy(in.uv));
    if found.is_outside {
        discard;
    }
    if REVERSED {
        let deepest = select(min(found.depth, polygon - slope), found.depth, OWN_DEPTH);
        return max(deepest * 0.99999904632568359375, 0.0);
    }
    let deepest = select(max(found.depth, polygon + slope), found.depth, OWN_DEPTH);
    return min(deepest * 1.00000095367431640625, 1.0);
}

struct DeepSurface {
    @location(0) normal: vec4<f32>,
    @location(1) albedo: vec4<f32>,
    @location(2) id: vec2<u32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn surface(in: Vertex) -> DeepSurface {
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let found = traced(in, uv_dx, uv_dy);
    let targets = scene_surface_targets(surface_of(in, found, uv_dx, uv_dy));
    if found.is_outside {
        discard;
    }
    return DeepSurface(targets.normal, targets.albedo, targets.id, select(in.clip.z, found.depth, OWN_DEPTH));
}

struct DeepMeasure {
    @location(0) position: vec4<f32>,
    @location(1) id: vec2<u32>,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn measure(in: Vertex) -> DeepMeasure {
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let found = traced(in, uv_dx, uv_dy);
    let targets = scene_measure_targets(surface_of(in, found, uv_dx, uv_dy));
    if found.is_outside {
        discard;
    }
    return DeepMeasure(targets.position, targets.id, select(in.clip.z, found.depth, OWN_DEPTH));
}

struct DeepVelocity {
    @location(0) velocity: vec4<f32>,
    @builtin(frag_depth) depth: f32,
}

// The motion of the point that the eye's ray meets.
@fragment
fn velocity_moving(in: MovingVertex) -> DeepVelocity {
    let vertex = Vertex(in.clip, in.position, in.normal, in.tangent, in.uv, in.instance, in.world);
    let found = traced(vertex, dpdx(in.uv), dpdy(in.uv));
    let last = placed_position(Rows(in.last_x, in.last_y, in.last_z), found.position);
    let velocity = scene_velocity(
        scene_place(view.clip_from_world * vec4<f32>(found.position, 1.0)),
        scene_place(view.last_clip_from_world * vec4<f32>(last, 1.0)));
    if found.is_outside {
        discard;
    }
    return DeepVelocity(velocity, select(in.clip.z, found.depth, OWN_DEPTH));
}
