// The kind `mesh`: instances of a mesh, static or skinned, with textures and normal maps. Each vertex's material says whether
// the surface is opaque, alpha-tested, blended or dithered (screen-door transparency).
// kind mesh: blends
import package::wgsl::render::scene_kind::{SceneFragment, SceneVertex};
import package::wgsl::render::scene_instances::scene_surface;
import package::wgsl::render::scene_motion::last_position;
import package::wgsl::render::scene_shade::Surface;
import package::wgsl::render::scene_vertex::{material_of, placed_vertex};
import package::wgsl::surface::dither::surface_dither_threshold;

// Whether the mesh is seen from both sides; back faces reverse their normals.
override DOUBLE_SIDED: bool = false;
// Whether one of the part's materials has a texture, and whether one has a normal map.
override TEXTURED: bool = false;
override NORMAL_MAPPED: bool = false;

// The cutoff of materials that ignore alpha.
const CUTOFF_OPAQUE: f32 = -1.0;
// The cutoff of dithered materials: alpha decides the fraction of pixels that are drawn.
const CUTOFF_DITHERED: f32 = -2.0;
// The layer of materials that lack a texture.
const NO_LAYER: u32 = 4294967295u;

// A material in the table of its part.
struct SceneMaterial {
    // Linear RGB and alpha. They multiply the texture.
    color: vec4<f32>,
    // Alpha cutoff: pixels with a lower alpha are discarded. Or one of the constants above.
    cutoff: f32,
    // Array layer of the texture, or `NO_LAYER`.
    layer: u32,
    // Array layer of the normal map, or `NO_LAYER`.
    normal_layer: u32,
    // Scale of the normal map's x and y.
    normal_scale: f32,
}

// The materials of the part.
@group(2) @binding(0) var<storage, read> materials: array<SceneMaterial>;
// Colour and alpha, one layer per texture.
@group(2) @binding(1) var albedo: texture_2d_array<f32>;
// Normal maps, one per layer. The green channel points up the image, against v.
@group(2) @binding(2) var normals: texture_2d_array<f32>;
// Filters colours.
@group(2) @binding(3) var filtering: sampler;
// Filters normal maps.
@group(2) @binding(4) var normal_filtering: sampler;

// Word 0 of a vertex is the index of its material.
fn mesh_place(entry: u32, vertex: u32) -> SceneVertex {
    var placed = placed_vertex(entry, vertex);
    placed.words.x = material_of[vertex];
    return placed;
}

fn mesh_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return last_position(entry, vertex);
}

// The outward normal, flipped on back faces of double-sided meshes.
fn facing(outwards: vec3<f32>, in: SceneFragment) -> vec3<f32> {
    if DOUBLE_SIDED {
        return select(-outwards, outwards, in.is_outside);
    }
    return outwards;
}

// The outward unit normal, from the normal map if the material has one.
fn bumpy_normal(in: SceneFragment, material: SceneMaterial, normal: vec3<f32>) -> vec3<f32> {
    let is_plain = material.normal_layer == NO_LAYER;
    let texel = textureSample(normals, normal_filtering, in.uv.xy, select(material.normal_layer, 0u, is_plain));
    let bump = (2.0 * texel.xyz - 1.0) * vec3<f32>(material.normal_scale, -material.normal_scale, 1.0);
    let tangent = normalize(in.tangent.xyz - normal * dot(normal, in.tangent.xyz));
    let bitangent = in.tangent.w * cross(normal, tangent);
    let bumpy = normalize(bump.x * tangent + bump.y * bitangent + bump.z * normal);
    return select(bumpy, normal, is_plain);
}

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
