// Draws instances of a mesh of a scene, textured and lit. Surfaces are opaque, cut out, or drawn through a screen-door
// pattern, as each vertex's material says.
import package::wgsl::render::scene_motion::last_position;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_shadow::{SHADOWED, scene_sunlit};
import package::wgsl::render::scene_vertex::{PlacedVertex, entry_instance, instances, material_of, mesh, placed_vertex};
import package::wgsl::render::scene_view::{MeasureTargets, SurfaceTargets, scene_measure_targets, scene_place, scene_shaded, scene_surface, scene_surface_targets, scene_velocity, view};
import package::wgsl::surface::dither::surface_dither_threshold;

// Whether the mesh is seen from both sides; back faces reverse their normals.
override DOUBLE_SIDED: bool = false;
// For plain vertices: whether the materials of the part have a texture, and whether there are several.
override TEXTURED: bool = false;
override SEVERAL: bool = false;
// Whether the colour is blended with what is behind it, by its alpha.
override BLENDED: bool = false;
// For whole surfaces: whether alpha leaves out pixels, and whether a material has a normal map.
override CUT_OUT: bool = false;
override NORMAL_MAPPED: bool = false;

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

// The table of the part.
@group(2) @binding(0) var<storage, read> materials: array<SceneMaterial>;
// Colours and alpha, a layer a texture.
@group(2) @binding(1) var albedo: texture_2d_array<f32>;
// Normal maps, a layer each; the green channel points up the image, against v.
@group(2) @binding(2) var normals: texture_2d_array<f32>;
// Filters colours.
@group(2) @binding(3) var filtering: sampler;
// Filters normal maps.
@group(2) @binding(4) var normal_filtering: sampler;

// Each location costs about as much as any other, and what fragments load costs more than what vertices load where
// triangles are small. Hence few locations, and colours that vertices look up.
struct Vertex {
    // The layers of a view give equal bits.
    @invariant @builtin(position) clip: vec4<f32>,
    // The normal; w: above 0 if triangles seen from outside run counter-clockwise on the screen, else below.
    @location(0) normal: vec4<f32>,
    // Texture coordinates; z: the layer of the texture, below 0 without one; w: the index of the material. All vertices of
    // a triangle have the same z and w.
    @location(1) surface: vec4<f32>,
    // The colour of the material and the instance.
    @location(2) @interpolate(flat) color: vec4<f32>,
}

// A vertex of a part with normal maps.
struct BumpyVertex {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec4<f32>,
    @location(1) surface: vec4<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
    @location(3) tangent: vec4<f32>,
}

// A vertex of an opaque part without normal maps, whose materials have one texture or none.
struct PlainVertex {
    @invariant @builtin(position) clip: vec4<f32>,
    // The normal on the side of triangles that is in front, if both are seen, else outwards; w: the texture coordinate u.
    @location(0) normal_and_u: vec4<f32>,
    // The texture coordinate v, and the colour of the material and the instance, which all vertices of a triangle share.
    @location(1) v_and_color: vec4<f32>,
}

// A vertex with everything that there is to know of a surface.
struct WholeVertex {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) normal: vec4<f32>,
    @location(1) surface: vec4<f32>,
    @location(2) @interpolate(flat) color: vec4<f32>,
    @location(3) tangent: vec4<f32>,
    // Relative to the corner of the view's cell.
    @location(4) position: vec3<f32>,
    // The index of the instance in the object.
    @location(5) @interpolate(flat) instance: u32,
}

@vertex
fn vertex_plain(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> PlainVertex {
    let placed = placed_vertex(entry, vertex);
    var index = 0u;
    if SEVERAL {
        index = material_of[vertex];
    }
    let color = materials[index].color * unpack4x8unorm(placed.tint);
    let is_behind = DOUBLE_SIDED && view.side * placed.side < 0.0;
    return PlainVertex(
        view.clip_from_world * vec4<f32>(placed.position, 1.0),
        vec4<f32>(select(placed.normal, -placed.normal, is_behind), placed.uv.x),
        vec4<f32>(placed.uv.y, color.rgb));
}

@vertex
fn vertex(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> Vertex {
    return without_tangent(bumpy(placed_vertex(entry, vertex), vertex));
}

@vertex
fn vertex_bumpy(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> BumpyVertex {
    return bumpy(placed_vertex(entry, vertex), vertex);
}

@vertex
fn vertex_whole(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> WholeVertex {
    let placed = placed_vertex(entry, vertex);
    let out = bumpy(placed, vertex);
    return WholeVertex(out.clip, out.normal, out.surface, out.color, out.tangent, placed.position, entry_instance(entry));
}

// A vertex with what there is to know of its motion.
struct MovingVertex {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) surface: vec4<f32>,
    @location(1) @interpolate(flat) color: vec4<f32>,
    // Its places on the screen in this frame and in the last.
    @location(2) now: vec3<f32>,
    @location(3) last: vec3<f32>,
}

@vertex
fn vertex_moving(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> MovingVertex {
    let out = bumpy(placed_vertex(entry, vertex), vertex);
    let last = view.last_clip_from_world * vec4<f32>(last_position(entry, vertex), 1.0);
    return MovingVertex(out.clip, out.surface, out.color, scene_place(out.clip), scene_place(last));
}

fn bumpy(placed: PlacedVertex, vertex: u32) -> BumpyVertex {
    let index = material_of[vertex];
    let layer = materials[index].layer;
    return BumpyVertex(
        view.clip_from_world * vec4<f32>(placed.position, 1.0),
        vec4<f32>(placed.normal, view.side * placed.side),
        vec4<f32>(placed.uv, select(f32(layer), -1.0, layer == NO_LAYER), f32(index)),
        materials[index].color * unpack4x8unorm(placed.tint),
        placed.tangent);
}

fn without_tangent(in: BumpyVertex) -> Vertex {
    return Vertex(in.clip, in.normal, in.surface, in.color);
}

fn with_tangent(in: WholeVertex) -> BumpyVertex {
    return BumpyVertex(in.clip, in.normal, in.surface, in.color, in.tangent);
}

fn colored(in: Vertex) -> vec4<f32> {
    let layer = in.surface.z + 0.5;
    let texel = textureSample(albedo, filtering, in.surface.xy, u32(max(layer, 0.0)));
    return select(texel, vec4<f32>(1.0), layer < 0.0) * in.color;
}

// A normal, given outwards, on the side that is seen; `side` is that of the vertex.
fn facing(outwards: vec3<f32>, side: f32, is_front: bool) -> vec3<f32> {
    if DOUBLE_SIDED {
        return select(-outwards, outwards, is_front == (side > 0.0));
    }
    return outwards;
}

// The unit normal outwards, of the normal map where the material has one.
fn bumpy_normal(in: BumpyVertex) -> vec3<f32> {
    let normal = normalize(in.normal.xyz);
    let material = materials[material_at(without_tangent(in))];
    let is_plain = material.normal_layer == NO_LAYER;
    let texel = textureSample(normals, normal_filtering, in.surface.xy, select(material.normal_layer, 0u, is_plain));
    let bump = (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, -material.normal_scale, 1.0);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let bitangent = in.tangent.w * cross(normal, tangent);
    let bumpy = normalize(bump.x * tangent + bump.y * bitangent + bump.z * normal);
    return select(bumpy, normal, is_plain);
}

// Ignores alpha.
@fragment
fn opaque_plain(in: PlainVertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    var color = in.v_and_color.yzw;
    if TEXTURED {
        color *= textureSample(albedo, filtering, vec2<f32>(in.normal_and_u.w, in.v_and_color.x), 0).rgb;
    }
    let normal = normalize(in.normal_and_u.xyz);
    return scene_shaded(scene_surface(color, select(normal, -normal, DOUBLE_SIDED && !is_front)));
}

fn flat_lit(color: vec4<f32>, in: Vertex, is_front: bool) -> vec4<f32> {
    return lit(color, facing(normalize(in.normal.xyz), in.normal.w, is_front));
}

fn bumpy_lit(color: vec4<f32>, in: BumpyVertex, is_front: bool) -> vec4<f32> {
    return lit(color, facing(bumpy_normal(in), in.normal.w, is_front));
}

fn lit(color: vec4<f32>, normal: vec3<f32>) -> vec4<f32> {
    var surface = scene_surface(color.rgb, normal);
    surface.alpha = blended_alpha(color.a);
    return scene_shaded(surface);
}

fn blended_alpha(alpha: f32) -> f32 {
    return select(1.0, alpha, BLENDED);
}

fn material_at(in: Vertex) -> u32 {
    return u32(in.surface.w + 0.5);
}

// Whether alpha leaves a pixel out.
fn is_cut(alpha: f32, in: Vertex) -> bool {
    let cutoff = materials[material_at(in)].cutoff;
    return alpha < select(cutoff, surface_dither_threshold(vec2<u32>(in.clip.xy)), cutoff == CUTOFF_DITHERED);
}

// A surface with everything that there is to know of it. Its alpha is that of its colour.
fn whole_surface(in: WholeVertex, is_front: bool) -> Surface {
    let bumpy = with_tangent(in);
    let color = colored(without_tangent(bumpy));
    let geometric = normalize(in.normal.xyz);
    var outwards = geometric;
    if NORMAL_MAPPED {
        outwards = bumpy_normal(bumpy);
    }
    let index = mesh.first_instance + in.instance;
    return Surface(
        in.position, facing(outwards, in.normal.w, is_front), facing(geometric, in.normal.w, is_front),
        in.surface.xy, color.rgb, color.a, 1.0, unpack4x8unorm(instances[index].tint), instances[index].word,
        mesh.object, mesh.first_slot + in.instance, in.clip.xy);
}

// Whether alpha leaves a pixel of a whole surface out.
fn is_whole_cut(alpha: f32, in: WholeVertex) -> bool {
    return CUT_OUT && is_cut(alpha, without_tangent(with_tangent(in)));
}

// Ignores alpha. It is a separate entry point because shaders with a discard are tested for depth late.
@fragment
fn opaque(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return flat_lit(colored(in), in, is_front);
}

@fragment
fn opaque_bumpy(in: BumpyVertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    return bumpy_lit(colored(without_tangent(in)), in, is_front);
}

@fragment
fn cut_out(in: Vertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let color = colored(in);
    let shaded = flat_lit(color, in, is_front);
    if is_cut(color.a, in) {
        discard;
    }
    return shaded;
}

@fragment
fn cut_out_bumpy(in: BumpyVertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    let color = colored(without_tangent(in));
    let shaded = bumpy_lit(color, in, is_front);
    if is_cut(color.a, without_tangent(in)) {
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

// Colour by the caller's shading, or in the shadow of the sun.
@fragment
fn shaded_whole(in: WholeVertex, @builtin(front_facing) is_front: bool) -> @location(0) vec4<f32> {
    var surface = whole_surface(in, is_front);
    if SHADOWED {
        surface.sunlit = scene_sunlit(surface.position, surface.geometric_normal);
    }
    let is_out = is_whole_cut(surface.alpha, in);
    surface.alpha = blended_alpha(surface.alpha);
    let color = scene_shaded(surface);
    if is_out {
        discard;
    }
    return color;
}

@fragment
fn surface_whole(in: WholeVertex, @builtin(front_facing) is_front: bool) -> SurfaceTargets {
    let surface = whole_surface(in, is_front);
    if is_whole_cut(surface.alpha, in) {
        discard;
    }
    return scene_surface_targets(surface);
}

@fragment
fn measure_whole(in: WholeVertex, @builtin(front_facing) is_front: bool) -> MeasureTargets {
    let surface = whole_surface(in, is_front);
    if is_whole_cut(surface.alpha, in) {
        discard;
    }
    return scene_measure_targets(surface);
}

@fragment
fn velocity_moving(in: MovingVertex) -> @location(0) vec4<f32> {
    if CUT_OUT {
        let surface = Vertex(in.clip, vec4<f32>(0.0), in.surface, in.color);
        if is_cut(colored(surface).a, surface) {
            discard;
        }
    }
    return scene_velocity(in.now, in.last);
}
