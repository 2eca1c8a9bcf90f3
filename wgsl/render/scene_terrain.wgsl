// The kind `terrain`: patches of a scene, drawn directly from their heights (thesis B section 3.3.1, tables 4.7 and 4.8). Each
// visible patch is one instance of an indexed mesh. Textures of zones are blended by height, slope and their own height maps.
// Alternatively, the patches are drawn as a wireframe.
// kind terrain:
import package::wgsl::lod::allowed::{MAX_ALLOWED, camera_allows};
import package::wgsl::lod::view::LodCamera;
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex, triangle_surface};
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_view::view;
import package::wgsl::terrain::slope::gradient_normal;
import package::wgsl::terrain::texturing::{TRIPLANAR_PLANES, color_variation, triplanar_uv, triplanar_weight, triplanar_weights, varied};
import package::wgsl::terrain::zones::{Zone, steepness, zone_blend, zone_blended, zone_color, zone_weight};

// Whether to draw a wireframe: triangle edges on unlit, dark ground.
override WIREFRAME: bool = false;

// Linear colour of triangle edges in the wireframe.
const LINE_COLOR: vec3<f32> = vec3<f32>(0.35, 0.75, 0.5);
// Linear colour of the ground between the edges of the wireframe.
const DARK_COLOR: vec3<f32> = vec3<f32>(0.01, 0.014, 0.02);

// The cameras of a view in a frame, which decide how far vertices of endless terrain may be displaced.
struct TerrainFrame {
    // Cameras that decide levels of detail; the first `camera_count` are valid. Positions are relative to the corner of the view's
    // cell in this frame.
    cameras: array<LodCamera, 4>,
    // Number of valid cameras; 0 for terrain of one resolution, which does not morph.
    camera_count: u32,
    // Factor of the displacement that the cameras allow: the fraction that levels of detail may use.
    fraction: f32,
}

// Placement of a terrain's samples in a view. Positions are relative to a sample near the view, so that they are precise far
// from the terrain's origin. A sample that several patches share has bit-identical positions in all of them.
struct TerrainView {
    // Column and row of the sample to which positions are relative.
    base: vec2<i32>,
    // Position of the sample `base` at height 0, relative to the corner of the view's cell.
    rest: vec3<f32>,
    // Number of the object, counted from 1.
    object: u32,
    // Cameras of this frame (`THIS_FRAME`) and of the view's last one (`LAST_FRAME`).
    frames: array<TerrainFrame, 2>,
}

// Index of this frame in `TerrainView`.
const THIS_FRAME = 0u;
// Index of the view's last frame in `TerrainView`. If the view was not in the last frame, it equals this frame.
const LAST_FRAME = 1u;

// How a node of endless terrain is drawn in a view. A limit is an allowed displacement in world units: where the view allows as much,
// a vertex has moved onto the triangles of the next coarser level.
struct TerrainNode {
    // Limits of the vertices on the west, east, north and south borders; `STITCHED` beside a coarser node.
    borders: vec4<f32>,
    // Limit of all other vertices.
    inner: f32,
    // Where an eroded node meets nodes that are not, one bit each: the sides west, east, north, south, then the corners north-west,
    // north-east, south-west, south-east. Its vertices there are not eroded either.
    plain: u32,
    // Padding, not read.
    unused_b: f32,
    // Padding, not read.
    unused_c: f32,
}

// Limit of a border beside a coarser node: its odd vertices lie in even ones.
const STITCHED: f32 = -1.0;
// Fraction of its limit at which a vertex begins to move.
const MORPH_START: f32 = 0.6;

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
    // Number of normals along an edge of a node, twice the resolution of its samples; 0 for terrain without such normals.
    normals_width: u32,
    // Depth of the textures' relief in world units; 0 for flat textures.
    relief_depth: f32,
    // Distance from the eye in world units from which on textures are flat. The relief fades from half of it on.
    relief_distance: f32,
    // Largest distance in world units by which erosion moves heights; 0 for terrain without erosion.
    erosion_depth: f32,
    // Padding, not read.
    unused: f32,
}

// A patch of a terrain.
struct TerrainPatch {
    // Column and row of the patch's first sample, counted from the terrain's origin.
    origin: vec2<i32>,
    // Texture coordinates at the patch's first sample, in tiles, modulo `TILES_PERIOD`.
    uv: vec2<f32>,
    // Index of the patch's window in `heights`.
    window: u32,
    // Level of the node: its samples are 2^`level` of the terrain's samples apart. 0 except in endless terrain.
    level: u32,
    // 1 + index of the first word of the patch's holes in `holes`; 0 for a patch without holes.
    holes: u32,
    // Index of the window with the eroded heights; `window` for a patch without.
    eroded: u32,
}

// Placement of the terrain in the view.
@group(1) @binding(0) var<uniform> ground: TerrainView;
// How each patch is drawn in the view. Read only if the terrain is endless.
@group(1) @binding(1) var<storage, read> nodes: array<TerrainNode>;
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
// One bit per vertex of a patch with holes, row by row, from a whole word on: whether triangles at this vertex are left out.
@group(2) @binding(6) var<storage, read> holes: array<u32>;

// Normals of all nodes but those of level 0, row by row: x in the low half of a word and z in the high half.
@group(2) @binding(7) var<storage, read> normals: array<u32>;

// Height gradient of a window at the sample `center`, from samples `reach` apart, as differences over two samples.
fn gradient_of(center: u32, reach: u32) -> vec2<f32> {
    let difference = vec2<f32>(vec2<i32>(
        heights[center + reach] - heights[center - reach],
        heights[center + reach * terrain.in_width] - heights[center - reach * terrain.in_width]));
    return difference / f32(reach);
}

// How much of its erosion a patch shows.
struct Erosion {
    // From a sample of the patch's window to the same of its window of eroded heights.
    offset: u32,
    // 0: nothing, 1: all of it.
    weight: f32,
}

// Height in world units of the sample `at`.
fn height_at(at: u32, erosion: Erosion) -> f32 {
    let height = f32(heights[at]) / 65536.0;
    if erosion.weight > 0.0 {
        return mix(height, f32(heights[at + erosion.offset]) / 65536.0, erosion.weight);
    }
    return height;
}

// Height gradient of a patch at the sample `center`, as `gradient_of`.
fn gradient_at(center: u32, reach: u32, erosion: Erosion) -> vec2<f32> {
    let gradient = gradient_of(center, reach);
    if erosion.weight > 0.0 {
        return mix(gradient, gradient_of(center + erosion.offset, reach), erosion.weight);
    }
    return gradient;
}

// Half of the way from an odd vertex of a patch to one of the two even vertices between which it lies in the next coarser level, in
// samples. The diagonal of a cell runs from south-west to north-east. (0, 0) for an even vertex.
fn coarser_half(at: vec2<u32>) -> vec2<i32> {
    let odd = vec2<i32>(at & vec2<u32>(1u));
    return vec2<i32>(odd.x, select(odd.y, -odd.y, odd.x != 0));
}

// The limit of a vertex of a node ([`TerrainNode`]), by the border on which it lies.
fn limit_of(node: TerrainNode, at: vec2<u32>) -> f32 {
    let last = terrain.size - 1u;
    var limit = node.inner;
    limit = select(limit, node.borders.w, at.y == last);
    limit = select(limit, node.borders.z, at.y == 0u);
    limit = select(limit, node.borders.y, at.x == last);
    return select(limit, node.borders.x, at.x == 0u);
}

// The vertex as which a vertex of a node is drawn: beside a coarser node, an odd vertex is drawn as the even one before or after it.
fn stitched(node: TerrainNode, at: vec2<u32>) -> vec2<u32> {
    let last = terrain.size - 1u;
    let odd = at & vec2<u32>(1u);
    let is_before = (at == vec2<u32>(0u)) & (node.borders.xz == vec2<f32>(STITCHED));
    let is_after = (at == vec2<u32>(last)) & (node.borders.yw == vec2<f32>(STITCHED));
    let back = vec2<u32>(select(0u, odd.x, is_before.y), select(0u, odd.y, is_before.x));
    let on = vec2<u32>(select(0u, odd.x, is_after.y), select(0u, odd.y, is_after.x));
    return at - back + on;
}

// The displacement that the cameras of a frame allow to a vertex, in world units, wherever erosion has moved it.
fn allowed_at(position: vec3<f32>, frame: u32) -> f32 {
    var allowed = MAX_ALLOWED;
    for (var index = 0u; index < min(ground.frames[frame].camera_count, 4u); index++) {
        allowed = min(allowed, camera_allows(ground.frames[frame].cameras[index], position, terrain.erosion_depth));
    }
    return ground.frames[frame].fraction * allowed;
}

// How much of its erosion a vertex of a node shows, 0 to 1: what is missing is at most half of what the cameras allow.
fn erosion_weight(node: TerrainNode, at: vec2<u32>, allowed: f32) -> f32 {
    let first = at == vec2<u32>(0u);
    let last = at == vec2<u32>(terrain.size - 1u);
    let sides = vec4<bool>(first.x, last.x, first.y, last.y);
    let corners = vec4<bool>(first.x && first.y, last.x && first.y, first.x && last.y, last.x && last.y);
    let bits = vec4<u32>(1u, 2u, 4u, 8u);
    let touched = select(vec4<u32>(0u), bits, sides) | select(vec4<u32>(0u), bits << vec4<u32>(4u), corners);
    let meets = (touched.x | touched.y | touched.z | touched.w) & node.plain;
    let weight = clamp(2.0 - allowed / terrain.erosion_depth, 0.0, 1.0);
    return select(weight, 0.0, meets != 0u);
}

// How far a vertex of a node has moved onto the triangles of the next coarser level, 0 to 1.
fn morphed(limit: f32, allowed: f32) -> f32 {
    if limit == STITCHED {
        return 1.0;
    }
    return clamp((allowed / max(limit, 1e-30) - MORPH_START) / (1.0 - MORPH_START), 0.0, 1.0);
}

// 1 if the triangles at a vertex of a patch are left out, else 0.
fn hole_at(patch_of: TerrainPatch, at: vec2<u32>) -> f32 {
    let bit = at.y * terrain.size + at.x;
    let word = holes[select(0u, patch_of.holes - 1u + bit / 32u, patch_of.holes != 0u)];
    return select(0.0, f32((word >> (bit % 32u)) & 1u), patch_of.holes != 0u);
}

// A vertex of a patch as a frame draws it.
struct GroundVertex {
    // Column and row in the patch.
    at: vec2<u32>,
    // How far shading has moved from the node's finer normals to the vertices' own, which are those of the next coarser level, 0 to 1.
    coarse: f32,
    // Position in the view, in world units.
    position: vec3<f32>,
    // Height in world units.
    height: f32,
    // Height gradient, as differences over two samples.
    gradient: vec2<f32>,
}

// Places a vertex of a patch in a frame of the view. A sample gets bit-identical positions in all patches, so that patches that
// share an edge leave no crack.
fn ground_vertex(instance: u32, vertex: u32, frame: u32) -> GroundVertex {
    let patch_of = patches[instance];
    let is_node = ground.frames[frame].camera_count != 0u;
    let node = nodes[select(0u, instance, is_node)];
    let corner = vec2<u32>(vertex % terrain.size, vertex / terrain.size);
    let at = select(corner, stitched(node, corner), is_node);
    let margin = (terrain.in_width - terrain.size) / 2u;
    let row = patch_of.window * terrain.in_width + at.y + margin;
    let center = row * terrain.in_width + at.x + margin;
    let sample_index = vec2<f32>(patch_of.origin + (vec2<i32>(at) << vec2<u32>(patch_of.level)) - ground.base);
    let sample = ground.rest + vec3<f32>(sample_index.x * terrain.spacing, 0.0, sample_index.y * terrain.spacing);
    var height = f32(heights[center]) / 65536.0;
    var gradient = gradient_of(center, 1u);
    var coarse = 0.0;
    if is_node {
        let allowed = allowed_at(sample + vec3<f32>(0.0, height, 0.0), frame);
        var erosion = Erosion(0u, 0.0);
        if patch_of.eroded != patch_of.window {
            let windows = patch_of.eroded - patch_of.window;
            erosion = Erosion(windows * terrain.in_width * terrain.in_width, erosion_weight(node, at, allowed));
            height = height_at(center, erosion);
            gradient = gradient_at(center, 1u, erosion);
        }
        let factor = morphed(limit_of(node, at), allowed);
        // Finer normals are those of eroded heights. Where no erosion is left, coarser nodes follow, which have none.
        coarse = select(factor, max(factor, 1.0 - erosion.weight), patch_of.eroded != patch_of.window);
        let half = coarser_half(at);
        let one = u32(i32(center) + half.y * i32(terrain.in_width) + half.x);
        let other = u32(i32(center) - half.y * i32(terrain.in_width) - half.x);
        let coarser = 0.5 * (height_at(one, erosion) + height_at(other, erosion));
        height = mix(height, coarser, factor);
        // With normals of twice the resolution, a vertex has the gradient that the next coarser level has there.
        if terrain.normals_width == 0u {
            gradient = mix(gradient, 0.5 * (gradient_at(one, 2u, erosion) + gradient_at(other, 2u, erosion)), factor);
        }
    }
    return GroundVertex(at, coarse, sample + vec3<f32>(0.0, height, 0.0), height, gradient);
}

// Places a vertex of a patch. Values of the result: column and row in the patch, how far shading has moved to the vertices' own normals,
// and the height in world units (w). For the wireframe, xyz are barycentric coordinates: 1 at one corner of each triangle, 0 at the
// others. Words: the patch's window and level.
fn terrain_place(instance: u32, vertex: u32) -> SceneVertex {
    let patch_of = patches[instance];
    let placed = ground_vertex(instance, vertex, THIS_FRAME);
    var values = vec4<f32>(vec2<f32>(placed.at), placed.coarse, placed.height);
    if WIREFRAME {
        // Within a patch, all triangles give a vertex the same corner number, 0 to 2.
        values = vec4<f32>(0.0, 0.0, 0.0, placed.height);
        values[(vertex % terrain.size + 2u * (vertex / terrain.size)) % 3u] = 1.0;
    }
    let steps = f32(1u << patch_of.level);
    return SceneVertex(
        placed.position, gradient_normal(placed.gradient, steps * terrain.run),
        vec4<f32>(1.0, 0.0, 0.0, 1.0),
        vec4<f32>(patch_of.uv + steps * vec2<f32>(placed.at) * terrain.tiling, hole_at(patch_of, placed.at), 0.0), values,
        vec3<u32>(patch_of.window, patch_of.level, 0u), 1.0);
}

// Position of a vertex in the last frame: the vertex morphs as the cameras of that frame allowed. The samples do not move. The vertex
// counts as drawn by the same node, so the jump from one node to another is no motion.
fn terrain_last_position(instance: u32, vertex: u32) -> vec3<f32> {
    return ground_vertex(instance, vertex, LAST_FRAME).position;
}

// Unit normal of a node at `at`, in samples from its first vertex, interpolated between its normals.
fn node_normal(window: u32, at: vec2<f32>) -> vec3<f32> {
    let width = terrain.normals_width;
    let place = clamp(2.0 * at, vec2<f32>(0.0), vec2<f32>(f32(width - 1u)));
    let cell = min(vec2<u32>(place), vec2<u32>(width - 2u));
    let part = place - vec2<f32>(cell);
    let first = (window * width + cell.y) * width + cell.x;
    let north = mix(unpack2x16snorm(normals[first]), unpack2x16snorm(normals[first + 1u]), part.x);
    let south = mix(unpack2x16snorm(normals[first + width]), unpack2x16snorm(normals[first + width + 1u]), part.x);
    let along = mix(north, south, part.y);
    return vec3<f32>(along.x, sqrt(max(1.0 - dot(along, along), 0.0)), along.y);
}

// Number of steps of the search along a ray that is perpendicular to the ground, and of additional steps along one in the ground.
const RELIEF_STEPS: f32 = 16.0;
const RELIEF_MORE_STEPS: f32 = 48.0;
// Number of bisections of the last step.
const RELIEF_BISECTIONS: u32 = 4u;
// Least cosine between a ray and the normal: a flatter ray is searched as if it were as steep.
const RELIEF_COSINE: f32 = 0.15;

// The texture whose relief a fragment shows: that of the zone and the plane with the greatest weight.
struct Relief {
    // Index of the zone.
    zone: u32,
    // The plane from which the texture is projected.
    plane: u32,
    // Depth in world units: 0 where no zone and no plane prevails, so that reliefs of two textures do not meet.
    depth: f32,
    // Mip level of the texture.
    level: f32,
}

// The relief of the ground at a distance from the eye. `tiles_dx` and `tiles_dy` are the derivatives of the position in tiles.
fn ground_relief(
    height: f32, steep: f32, weights: vec3<f32>, distance: f32, tiles_dx: vec3<f32>, tiles_dy: vec3<f32>,
) -> Relief {
    var relief = Relief(0u, 0u, 0.0, 0.0);
    var most = 0.0;
    var sum = 0.0;
    for (var z = 0u; z < terrain.zone_count; z++) {
        let weight = zone_weight(zones[z], height, steep);
        relief.zone = select(relief.zone, z, weight > most);
        most = max(most, weight);
        sum += weight;
    }
    relief.plane = select(select(2u, 1u, weights.y > weights.z), 0u, weights.x >= max(weights.y, weights.z));
    let facing = triplanar_weight(weights, relief.plane);
    let prevails = max(2.0 * most / max(sum, 1e-6) - 1.0, 0.0) * max(2.0 * facing - 1.0, 0.0);
    let near = 1.0 - smoothstep(0.5 * terrain.relief_distance, terrain.relief_distance, distance);
    relief.depth = terrain.relief_depth * prevails * near;
    let footprint = max(length(triplanar_uv(relief.plane, tiles_dx)), length(triplanar_uv(relief.plane, tiles_dy)));
    relief.level = log2(max(footprint * zones[relief.zone].repeats * f32(textureDimensions(textures).x), 1.0));
    return relief;
}

// Height of the relief at a position in tiles, 0 to 1.
fn relief_height(relief: Relief, tiles: vec3<f32>) -> f32 {
    let at = zones[relief.zone].repeats * triplanar_uv(relief.plane, tiles);
    return textureSampleLevel(textures, texture_sampler, at, relief.zone, relief.level).w;
}

// Way in tiles along a ray from the surface to its first hit of the relief. `way` is the way to the bottom of the relief. `cosine` is the
// cosine of the angle between ray and normal.
fn relief_hit(relief: Relief, tiles: vec3<f32>, way: vec3<f32>, cosine: f32) -> vec3<f32> {
    let step = 1.0 / (RELIEF_STEPS + floor((1.0 - cosine) * RELIEF_MORE_STEPS));
    // Parts of the way: the last point that is known to be above the relief, and the first that is not.
    var outside = 0.0;
    var inside = 0.0;
    var above = 1.0 - relief_height(relief, tiles);
    while above > 0.0 && inside < 1.0 {
        outside = inside;
        inside = min(inside + step, 1.0);
        above = 1.0 - inside - relief_height(relief, tiles + inside * way);
    }
    for (var i = 0u; i < RELIEF_BISECTIONS; i++) {
        let middle = 0.5 * (outside + inside);
        let is_inside = 1.0 - middle <= relief_height(relief, tiles + middle * way);
        outside = select(middle, outside, is_inside);
        inside = select(inside, middle, is_inside);
    }
    return way * inside;
}

// Unit normal of the relief at a position in tiles, on ground with a unit normal.
fn relief_normal(relief: Relief, tiles: vec3<f32>, normal: vec3<f32>) -> vec3<f32> {
    // The reach of differences is a texel of the mip level.
    let reach = exp2(relief.level) / (zones[relief.zone].repeats * f32(textureDimensions(textures).x));
    // Directions of the texture's rows and columns in the world.
    let east = select(vec3<f32>(1.0, 0.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), relief.plane == 1u);
    let south = select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(0.0, 0.0, 1.0), relief.plane == 0u);
    let rise = vec2<f32>(
        relief_height(relief, tiles + reach * east) - relief_height(relief, tiles - reach * east),
        relief_height(relief, tiles + reach * south) - relief_height(relief, tiles - reach * south));
    let gradient = (rise.x * east + rise.y * south) * (relief.depth * terrain.tiles_per_unit / (2.0 * reach));
    // The part along the ground: the relief is a height above it.
    return normalize(normal - (gradient - dot(gradient, normal) * normal));
}

// Colour and normal of the ground.
struct Ground {
    // Linear colour.
    color: vec3<f32>,
    // Unit normal, with the relief of the textures.
    normal: vec3<f32>,
}

// The ground at texture coordinates, a height in world units, and a unit normal. `ray` is the way from the eye to the surface in
// world units; 0 for flat textures.
fn ground_at(uv: vec2<f32>, height: f32, normal: vec3<f32>, ray: vec3<f32>) -> Ground {
    let surface = vec3<f32>(uv.x, height * terrain.tiles_per_unit, uv.y);
    // Derivatives need uniform control flow, so they are computed before the loops.
    let tiles_dx = dpdx(surface);
    let tiles_dy = dpdy(surface);
    let weights = select(vec3<f32>(1.0, 0.0, 0.0), triplanar_weights(normal), terrain.planes == TRIPLANAR_PLANES);
    let steep = steepness(normal);
    var tiles = surface;
    var relieved = normal;
    let distance = length(ray);
    if terrain.relief_depth > 0.0 && distance > 0.0 {
        let relief = ground_relief(height, steep, weights, distance, tiles_dx, tiles_dy);
        if relief.depth > 0.0 {
            let direction = ray / distance;
            let cosine = max(-dot(direction, normal), RELIEF_COSINE);
            let way = direction * (relief.depth * terrain.tiles_per_unit / cosine);
            tiles += relief_hit(relief, surface, way, cosine);
            relieved = relief_normal(relief, tiles, normal);
        }
    }
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
    var color = zone_color(blend, terrain.additive != 0u);
    if terrain.variation != 0.0 {
        color = varied(color, color_variation(uv), terrain.variation);
    }
    return Ground(color, relieved);
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
        if terrain.normals_width != 0u && in.words.y != 0u {
            surface.normal = normalize(mix(node_normal(in.words.x, in.values.xy), surface.normal, in.values.z));
        }
        // Parallel views show flat textures.
        let ray = select(vec3<f32>(0.0), surface.position - view.eye.xyz, view.eye.w == 1.0);
        let ground_here = ground_at(in.uv.xy, in.values.w, surface.normal, ray);
        surface.color = ground_here.color;
        surface.normal = ground_here.normal;
    }
    // Above 0 in a triangle with a corner in a hole.
    surface.alpha = select(1.0, 0.0, in.uv.z > 1e-4);
    surface.cutoff = 0.5;
    surface.object = ground.object;
    surface.level = min(in.words.y, 7u);
    surface.instance = terrain.first_patch + in.instance;
    return surface;
}
