// Draws instances of a mesh of a scene, textured and lit. Surfaces are opaque, cut out, or drawn through a screen-door
// pattern, as each vertex's material says.
import package::wgsl::render::scene_vertex::placed_vertex;
import package::wgsl::render::scene_view::{scene_lit, view};
import package::wgsl::surface::dither::surface_dither_threshold;

// Whether the mesh is seen from both sides; back faces reverse their normals.
override DOUBLE_SIDED: bool = false;
// Whether a material has a normal map.
override NORMAL_MAP: bool = false;

// The cutoff of materials that ignore alpha.
const CUTOFF_OPAQUE: f32 = -1.0;
// The cutoff of materials whose alpha decides how many pixels of a pattern are drawn.
const CUTOFF_DITHERED: f32 = -2.0;
// The layer of materials that lack a texture.
const NO_LAYER: u32 = 4294967295u;

// A material in the table of its part.
struct SceneMaterial {
    // Linear red, green and blue, and alpha, by which the texture is multiplied.
    color: vec4<f32>,
    // Pixels with an alpha below it are not drawn, or one of the constants above.
    cutoff: f32,
    // The layers of its texture and of its normal map, or `NO_LAYER`.
    layer: u32,
    normal_layer: u32,
    // The factor of the normal map's x and y.
    normal_scale: f32,
}

// For each vertex of the mesh, the index of its material in the table of its part.
@group(1) @binding(3) var<storage, read> material_of: array<u32>;
// The table of the part.
@group(2) @binding(0) var<storage, read> materials: array<SceneMaterial>;
// Colours and alpha, a layer a texture.
@group(2) @binding(1) var albedo: texture_2d_array<f32>;
// Normal maps, a layer each; the green channel points up the image, against v.
@group(2) @binding(2) var normals: texture_2d_array<f32>;
// Filters both.
@group(2) @binding(3) var filtering: sampler;

struct Vertex {
    // The layers of a view give equal bits.
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) tangent: vec4<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) tint: vec4<f32>,
    @location(4) @interpolate(flat) material: u32,
    // 1 if triangles seen from outside run counter-clockwise on the screen, else −1.
    @location(5) @interpolate(flat) side: f32,
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @location(0) instance: u32) -> Vertex {
    let placed = placed_vertex(instance, vertex);
    return Vertex(
        view.clip_from_world * vec4<f32>(placed.position, 1.0),
        placed.normal,
        placed.tangent,
        placed.uv,
        placed.tint,
        material_of[vertex],
        view.side * placed.side);
}

fn colored(in: Vertex) -> vec4<f32> {
    let material = materials[in.material];
    let is_plain = material.layer == NO_LAYER;
    let texel = textureSample(albedo, filtering, in.uv, select(material.layer, 0u, is_plain));
    return select(texel, vec4<f32>(1.0), is_plain) * material.color * in.tint;
}

// The unit normal of the side that is seen.
fn facing(in: Vertex, is_front: bool) -> vec3<f32> {
    var normal = normalize(in.normal);
    if NORMAL_MAP {
        let material = materials[in.material];
        let is_plain = material.normal_layer == NO_LAYER;
        let texel = textureSample(normals, filtering, in.uv, select(material.normal_layer, 0u, is_plain));
        let bump = (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, -material.normal_scale, 1.0);
        let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
        let bitangent = in.tangent.w * cross(normal, tangent);
        let bumpy = normalize(bump.x * tangent + bump.y * bitangent + bump.z * normal);
        normal = select(bumpy, normal, is_plain);
    }
    if DOUBLE_SIDED {
        normal = select(-normal, normal, is_front == (in.side > 0.0));
    }
    return normal;
}

fn lit(color: vec4<f32>, in: Vertex, is_front: bool) -> vec4<f32> {
    let direct = max(dot(facing(in, is_front), view.light.xyz), 0.0);
    return vec4<f32>(scene_lit(color.rgb, direct), 1.0);
}

// Whether alpha leaves a pixel out.
fn is_cut(alpha: f32, in: Vertex) -> bool {
    let cutoff = materials[in.material].cutoff;
    return alpha < select(cutoff, surface_dither_threshold(vec2<u32>(in.clip.xy)), cutoff == CUTOFF_DITHERED);
}

// Ignores alpha. It is a separate entry point because shaders with a discard are tested for depth late.
@fragment
fn opaque(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return lit(colored(in), in, is_front);
}

@fragment
fn cut_out(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let color = colored(in);
    let shaded = lit(color, in, is_front);
    if is_cut(color.a, in) {
        discard;
    }
    return shaded;
}

// Only depth is written, where a pass has colour attachments as well.
@fragment
fn depth_opaque() {}

@fragment
fn depth_cut_out(in: Vertex) {
    if is_cut(colored(in).a, in) {
        discard;
    }
}
