// Draws skinned instances of a mesh, textured and lit, each at its own placement. Surfaces are opaque, cut out,
// or drawn through a screen-door pattern.
import package::wgsl::light::lambert;
import package::wgsl::skinning::rows::{Rows, placed_normal, placed_position};
import package::wgsl::skinning::vertex::{vertex_normal, vertex_position};
import package::wgsl::surface::dither::surface_dither_threshold;

// Whether the mesh is seen from both sides; back faces reverse their normals.
override DOUBLE_SIDED: bool = false;
// Whether the draw shows only mirrored instances, or only those that are not. A double-sided mesh draws all at
// once.
override MIRRORED: bool = false;

struct SkinnedView {
    clip_from_world: mat4x4<f32>,
    // Unit vector towards the light; w: the light that surfaces facing away still receive, 0..1.
    light: vec4<f32>,
    // Linear colour and alpha by which the texture is multiplied.
    color: vec4<f32>,
    // Number of vertices of the mesh.
    vertices: u32,
    cutoff: f32,
    // −1 if the view mirrors, else 1.
    side: f32,
}

@group(0) @binding(0) var<uniform> view: SkinnedView;
// Five pairs per vertex and instance: position, normal, tangent.
@group(0) @binding(1) var<storage, read> skinned: array<vec2<f32>>;
@group(0) @binding(2) var<storage, read> texture_coordinates: array<vec2<f32>>;
// Three rows per instance: the transform from the model's space into the world.
@group(0) @binding(3) var<storage, read> placements: array<vec4<f32>>;
// Indices of the instances to draw.
@group(0) @binding(4) var<storage, read> drawn: array<u32>;
@group(0) @binding(5) var albedo: texture_2d<f32>;
@group(0) @binding(6) var filtering: sampler;

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) index: u32) -> Vertex {
    let instance = drawn[index];
    let x = placements[3u * instance];
    let y = placements[3u * instance + 1u];
    let z = placements[3u * instance + 2u];
    let determinant = dot(x.xyz, cross(y.xyz, z.xyz));
    if !DOUBLE_SIDED && (view.side * determinant < 0.0) != MIRRORED {
        // A position outside the view.
        return Vertex(vec4<f32>(2.0, 2.0, 2.0, 1.0), vec3<f32>(0.0), vec2<f32>(0.0));
    }
    let at = 5u * (instance * view.vertices + vertex);
    let middle = skinned[at + 1u];
    let rows = Rows(x, y, z);
    let world = placed_position(rows, vertex_position(skinned[at], middle));
    // If the placement mirrors, the cofactors give an inward normal. That is right for double-sided meshes,
    // because the rasterizer then takes the inner side for the front.
    let facing = placed_normal(rows, vertex_normal(middle, skinned[at + 2u]));
    let outwards = select(facing, -facing, !DOUBLE_SIDED && determinant < 0.0);
    return Vertex(view.clip_from_world * vec4<f32>(world, 1.0), outwards, texture_coordinates[vertex]);
}

fn colored(in: Vertex) -> vec4<f32> {
    return textureSample(albedo, filtering, in.uv) * view.color;
}

fn lit(color: vec3<f32>, in: Vertex, is_front: bool) -> vec4<f32> {
    var normal = normalize(in.normal);
    if DOUBLE_SIDED {
        normal = select(-normal, normal, is_front == (view.side > 0.0));
    }
    let direct = max(dot(normal, view.light.xyz), 0.0);
    return vec4<f32>(lambert(color, view.light.w, direct), 1.0);
}

// Ignores alpha. It is a separate entry point because shaders with a discard are tested for depth late.
@fragment
fn opaque(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return lit(colored(in).rgb, in, is_front);
}

// Discards pixels whose alpha is below the cutoff.
@fragment
fn masked(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let color = colored(in);
    if color.a < view.cutoff {
        discard;
    }
    return lit(color.rgb, in, is_front);
}

// Keeps as many pixels of the pattern as alpha says.
@fragment
fn screened(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let color = colored(in);
    if color.a < surface_dither_threshold(vec2<u32>(in.clip.xy)) {
        discard;
    }
    return lit(color.rgb, in, is_front);
}
