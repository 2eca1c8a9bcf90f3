// Draws height fields straight from their heights (B section 3.3.1, tables 4.7 and 4.8): a triangle strip for
// each row of cells, zone textures blended by height, a directional light. `WIREFRAME` draws edges instead.
import package::wgsl::terrain::fixed::HEIGHT_ONE;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::zones::{Zone, zone_fold, zone_folded, zone_fraction};
import package::wgsl::terrain::light::{Light, lit};

override WIREFRAME: bool = false;

struct View {
    // The matrix from world to clip space, depth 0..1.
    clip_from_world: mat4x4<f32>,
    light: Light,
    zone_count: u32,
    additive: u32,
}

struct FieldParams {
    // Samples along an edge of a window, and along an edge of the patch inside it.
    in_width: u32,
    size: u32,
    // World units between samples, and twice that in 1/65536 units.
    spacing: f32,
    run: f32,
    // Texture tiles per sample.
    tiling: f32,
}

// Where a patch lies in the world that is drawn.
struct Place {
    // Its first sample, in samples from the origin of that world.
    origin: vec2<i32>,
    // Texture coordinates at that sample, without whole tiles.
    uv: vec2<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var<storage, read> zones: array<Zone>;
@group(0) @binding(2) var textures: texture_2d_array<f32>;
@group(0) @binding(3) var texture_sampler: sampler;
@group(1) @binding(0) var<uniform> field: FieldParams;
@group(1) @binding(1) var<storage, read> heights: array<i32>;
@group(1) @binding(2) var<storage, read> places: array<Place>;

struct Vertex {
    // Equal samples give equal bits, so that patches that share an edge leave no crack.
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec3<f32>,
    @location(1) uv: vec2<f32>,
    @location(2) height: f32,
    // 1 at one corner of each triangle, 0 at the others.
    @location(3) corner: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) vertex_index: u32, @builtin(instance_index) instance: u32) -> Vertex {
    let rows = field.size - 1u;
    let window = instance / rows;
    let at = vec2<u32>(vertex_index >> 1u, instance % rows + (vertex_index & 1u));
    let margin = (field.in_width - field.size) / 2u;
    let center = (window * field.in_width + at.y + margin) * field.in_width + at.x + margin;
    let gradient = vec2<i32>(
        heights[center + 1u] - heights[center - 1u],
        heights[center + field.in_width] - heights[center - field.in_width]);
    let place = places[window];
    let sample_index = place.origin + vec2<i32>(at);
    let height = f32(heights[center]) / f32(HEIGHT_ONE);
    let position = vec3<f32>(
        f32(sample_index.x) * field.spacing, height, f32(sample_index.y) * field.spacing);
    var corner = vec3<f32>(0.0);
    corner[vertex_index % 3u] = 1.0;
    return Vertex(
        view.clip_from_world * vec4<f32>(position, 1.0),
        slope_normal(gradient, field.run),
        place.uv + vec2<f32>(at) * field.tiling,
        height,
        corner);
}

@fragment
fn fragment(in: Vertex) -> @location(0) vec4<f32> {
    // Derivatives need uniform control flow, so they are taken here and not in the loop.
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    let edge = in.corner / max(fwidth(in.corner), vec3<f32>(1e-6));
    if WIREFRAME {
        let near = clamp(1.2 - min(edge.x, min(edge.y, edge.z)), 0.0, 1.0);
        let shade = lit(view.light, normalize(in.normal), vec3<f32>(1.0)).x;
        let ground = vec3<f32>(0.01, 0.014, 0.02);
        return vec4<f32>(mix(ground, vec3<f32>(0.35, 0.75, 0.5) * shade, near), 1.0);
    }
    var fold = zone_fold();
    for (var z = 0u; z < view.zone_count; z++) {
        fold = zone_folded(fold, z, zones[z], in.height);
    }
    var albedo = vec3<f32>(0.0);
    for (var z = 0u; z < view.zone_count; z++) {
        let fraction = zone_fraction(fold, z, zones[z], in.height, view.additive != 0u);
        albedo += fraction * textureSampleGrad(textures, texture_sampler, in.uv, z, uv_dx, uv_dy).rgb;
    }
    return vec4<f32>(lit(view.light, normalize(in.normal), albedo), 1.0);
}
