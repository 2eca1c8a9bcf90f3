// The kind `terrain`: patches of a scene, drawn directly from their heights (thesis B section 3.3.1, tables 4.7 and 4.8). Each
// visible patch is one instance of an indexed mesh. Textures of zones are blended by height, slope and their own height maps.
// Alternatively, the patches are drawn as a wireframe.
// kind terrain:
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, triangle_surface};
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::terrain::slope::slope_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_uv, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::zones::{Zone, steepness, zone_blend, zone_blended, zone_color};

// Whether to draw a wireframe: triangle edges on unlit, dark ground.
override WIREFRAME: bool = false;

// Linear colour of triangle edges in the wireframe.
const LINE_COLOR: vec3<f32> = vec3<f32>(0.35, 0.75, 0.5);
// Linear colour of the ground between the edges of the wireframe.
const DARK_COLOR: vec3<f32> = vec3<f32>(0.01, 0.014, 0.02);

// Placement of a terrain's samples in a view. Positions are relative to a sample near the view, so that they are precise far
// from the terrain's origin. A sample that several patches share has bit-identical positions in all of them.
struct TerrainView {
    // Column and row of the sample to which positions are relative.
    base: vec2<i32>,
    // Position of the sample `base` at height 0, relative to the corner of the view's cell.
    rest: vec3<f32>,
    // Number of the object, counted from 1.
    object: u32,
}

// Parameters that the patches of a terrain share.
struct TerrainParams {
    // Number of samples along an edge of a window, a patch with a margin on every side.
    in_width: u32,
    // Number of samples along an edge of the patch inside a window.
    size: u32,
    // Distance between samples, in world units.
    spacing: f32,
    // Twice the distance between samples, in 1/65536 world units.
    run: f32,
    // Number of texture tiles from one sample to the next.
    tiling: f32,
    // Number of texture tiles per world unit of height.
    tiles_per_unit: f32,
    // Number of zones.
    zone_count: u32,
    // 1 if zone weights are added without normalization, 0 if they are normalized.
    additive: u32,
    // Number of planes from which textures are projected: 1 (from above) or 3 (triplanar).
    planes: u32,
    // Strength of the colour variation, 0 to 1.
    variation: f32,
    // Number of the chunk's first patch in the object.
    first_patch: u32,
}

// A patch of a terrain.
struct TerrainPatch {
    // Column and row of the patch's first sample, counted from the terrain's origin.
    origin: vec2<i32>,
    // Texture coordinates at the patch's first sample, in tiles, modulo `TILES_PERIOD`.
    uv: vec2<f32>,
    // Index of the patch's window in `heights`.
    window: u32,
    // Padding, not read.
    unused: u32,
}

// Placement of the terrain in the view.
@group(1) @binding(0) var<uniform> ground: TerrainView;
// Parameters of the terrain's patches.
@group(2) @binding(0) var<uniform> terrain: TerrainParams;
// Heights of all windows, row by row, in 1/65536 world units.
@group(2) @binding(1) var<storage, read> heights: array<i32>;
// The patch of each instance.
@group(2) @binding(2) var<storage, read> patches: array<TerrainPatch>;
// Zones of the ground.
@group(2) @binding(3) var<storage, read> zones: array<Zone>;
// Textures of the zones, one layer per zone.
@group(2) @binding(4) var textures: texture_2d_array<f32>;
// Sampler of the zone textures.
@group(2) @binding(5) var texture_sampler: sampler;

// Places a vertex of a patch. A sample gets bit-identical positions in all patches, so that patches that share an edge leave no
// crack. Values of the result: barycentric coordinates (xyz: 1 at one corner of each triangle, 0 at the others), and the height
// in world units (w).
fn terrain_place(instance: u32, vertex: u32) -> SceneVertex {
    let patch_of = patches[instance];
    let at = vec2<u32>(vertex % terrain.size, vertex / terrain.size);
    let margin = (terrain.in_width - terrain.size) / 2u;
    let row = patch_of.window * terrain.in_width + at.y + margin;
    let center = row * terrain.in_width + at.x + margin;
    let gradient = vec2<i32>(
        heights[center + 1u] - heights[center - 1u],
        heights[center + terrain.in_width] - heights[center - terrain.in_width]);
    let height = f32(heights[center]) / 65536.0;
    let sample_index = vec2<f32>(patch_of.origin + vec2<i32>(at) - ground.base);
    let position = ground.rest
        + vec3<f32>(sample_index.x * terrain.spacing, height, sample_index.y * terrain.spacing);
    // Within a patch, all triangles give a vertex the same corner number, 0 to 2.
    var values = vec4<f32>(0.0, 0.0, 0.0, height);
    values[(at.x + 2u * at.y) % 3u] = 1.0;
    return SceneVertex(
        position, slope_normal(gradient, terrain.run), vec4<f32>(1.0, 0.0, 0.0, 1.0),
        vec4<f32>(patch_of.uv + vec2<f32>(at) * terrain.tiling, 0.0, 0.0), values, vec3<u32>(0u), 1.0);
}

// Position of a vertex in the last frame: its current position, because the ground does not move.
fn terrain_last_position(instance: u32, vertex: u32) -> vec3<f32> {
    return terrain_place(instance, vertex).position;
}

// Linear colour of the ground at texture coordinates, a height in world units, and a unit normal.
fn ground_color(uv: vec2<f32>, height: f32, normal: vec3<f32>) -> vec3<f32> {
    let tiles = vec3<f32>(uv.x, height * terrain.tiles_per_unit, uv.y);
    // Derivatives need uniform control flow, so they are computed before the loop.
    let tiles_dx = dpdx(tiles);
    let tiles_dy = dpdy(tiles);
    let weights = select(vec3<f32>(1.0, 0.0, 0.0), triplanar_weights(normal), terrain.planes == TRIPLANAR_PLANES);
    let steep = steepness(normal);
    var blend = zone_blend();
    for (var z = 0u; z < terrain.zone_count; z++) {
        let zone = zones[z];
        var texel = vec4<f32>(0.0);
        for (var plane = 0u; plane < terrain.planes; plane++) {
            let at = zone.repeats * triplanar_uv(plane, tiles);
            let dx = zone.repeats * triplanar_uv(plane, tiles_dx);
            let dy = zone.repeats * triplanar_uv(plane, tiles_dy);
            texel += triplanar_weight(weights, plane) * textureSampleGrad(textures, texture_sampler, at, z, dx, dy);
        }
        blend = zone_blended(blend, zone, height, steep, texel);
    }
    let color = zone_color(blend, terrain.additive != 0u);
    if terrain.variation == 0.0 {
        return color;
    }
    return varied(color, color_variation(uv), terrain.variation);
}

// Surface of a fragment of the ground or of its wireframe.
fn terrain_surface(in: SceneFragment) -> Surface {
    var surface = triangle_surface(in);
    if WIREFRAME {
        let edge = in.values.xyz / max(fwidth(in.values.xyz), vec3<f32>(1e-6));
        let near = clamp(1.2 - min(edge.x, min(edge.y, edge.z)), 0.0, 1.0);
        surface.color = LINE_COLOR;
        surface.unlit = vec4<f32>(DARK_COLOR, 1.0 - near);
    } else {
        surface.color = ground_color(in.uv.xy, in.values.w, surface.normal);
    }
    surface.object = ground.object;
    surface.instance = terrain.first_patch + in.instance;
    return surface;
}
