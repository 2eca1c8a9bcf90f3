// The kind `mesh`: instances of a mesh, static or skinned, with textures and normal maps. Each vertex's material says whether
// the surface is opaque, alpha-tested, blended or dithered (screen-door transparency).
// kind mesh: blends
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex};
import package::wgsl::render::scene_instances::scene_surface;
import package::wgsl::render::scene_motion::last_position;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_vertex::{material_of, placed_vertex};
import package::wgsl::surface::dither::surface_dither_threshold;

// Whether the mesh is seen from both sides. If true, back faces reverse their normals.
override DOUBLE_SIDED: bool = false;
// Whether one of the part's materials has a texture.
override TEXTURED: bool = false;
// Whether one of the part's materials has a normal map.
override NORMAL_MAPPED: bool = false;

// Alpha cutoff of materials that ignore alpha.
const CUTOFF_OPAQUE: f32 = -1.0;
// Alpha cutoff that marks dithered materials. Their alpha is the fraction of pixels that are drawn.
const CUTOFF_DITHERED: f32 = -2.0;
// Texture layer of materials that have no texture.
const NO_LAYER: u32 = 4294967295u;

// A material in the material table of a part, a piece of the mesh with draws of its own.
struct SceneMaterial {
    // Linear RGB and alpha, which multiply the texture.
    color: vec4<f32>,
    // Alpha cutoff: pixels with a lower alpha are discarded. `CUTOFF_OPAQUE` and `CUTOFF_DITHERED` are special values.
    cutoff: f32,
    // Array layer of the material's texture, or `NO_LAYER`.
    layer: u32,
    // Array layer of the material's normal map, or `NO_LAYER`.
    normal_layer: u32,
    // Factor of the normal map's x and y components.
    normal_scale: f32,
}

// Materials of the part that is drawn.
@group(2) @binding(0) var<storage, read> materials: array<SceneMaterial>;
// Textures with colour and alpha, one per layer.
@group(2) @binding(1) var albedo: texture_2d_array<f32>;
// Normal maps, one per layer. Their green channel points up the image, against v.
@group(2) @binding(2) var normals: texture_2d_array<f32>;
// Sampler of the colour textures.
@group(2) @binding(3) var filtering: sampler;
// Sampler of the normal maps.
@group(2) @binding(4) var normal_filtering: sampler;

// Places a vertex of the mesh. Word 0 of the result is the index of the vertex's material.
fn mesh_place(entry: u32, vertex: u32) -> SceneVertex {
    var placed = placed_vertex(entry, vertex);
    placed.words.x = material_of[vertex];
    return placed;
}

// Position of a vertex in the last frame, relative to the corner of the view's cell.
fn mesh_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return last_position(entry, vertex);
}

// The outward normal, reversed on back faces of double-sided meshes.
fn facing(outwards: vec3<f32>, in: SceneFragment) -> vec3<f32> {
    if DOUBLE_SIDED {
        return select(-outwards, outwards, in.is_outside);
    }
    return outwards;
}

// Outward unit normal of a fragment, from the normal map if the material has one.
fn bumpy_normal(in: SceneFragment, material: SceneMaterial, normal: vec3<f32>) -> vec3<f32> {
    let is_plain = material.normal_layer == NO_LAYER;
    let texel = textureSample(normals, normal_filtering, in.uv.xy, select(material.normal_layer, 0u, is_plain));
    let bump = (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, -material.normal_scale, 1.0);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let bitangent = in.tangent.w * cross(normal, tangent);
    let bumpy = normalize(bump.x * tangent + bump.y * bitangent + bump.z * normal);
    return select(bumpy, normal, is_plain);
}

// Surface of a fragment, with its material, texture and normal map.
fn mesh_surface(in: SceneFragment) -> Surface {
    let material = materials[in.words.x];
    var surface = scene_surface(in);
    var color = material.color * surface.tint;
    if TEXTURED {
        let has_none = material.layer == NO_LAYER;
        let texel = textureSample(albedo, filtering, in.uv.xy, select(material.layer, 0u, has_none));
        color *= select(texel, vec4<f32>(1.0), has_none);
    }
    var outwards = normalize(in.normal);
    if NORMAL_MAPPED {
        outwards = bumpy_normal(in, material, outwards);
    }
    surface.normal = facing(outwards, in);
    surface.color = color.rgb;
    surface.alpha = color.a;
    let is_dithered = material.cutoff == CUTOFF_DITHERED;
    surface.cutoff = select(material.cutoff, surface_dither_threshold(vec2<u32>(in.clip.xy)), is_dithered);
    return surface;
}
