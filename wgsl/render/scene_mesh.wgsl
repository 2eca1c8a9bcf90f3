// The kind `mesh`: instances of a mesh of a scene, static or skinned, with textures and normal maps. Surfaces are opaque, cut
// out, blended, or drawn through a screen-door pattern, as each vertex's material says.
// kind mesh: discards, blends
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

// The first word of a vertex: the index of its material.
fn mesh_place(entry: u32, vertex: u32) -> SceneVertex {
    var placed = placed_vertex(entry, vertex);
    placed.words.x = material_of[vertex];
    return placed;
}

fn mesh_last_position(entry: u32, vertex: u32) -> vec3<f32> {
    return last_position(entry, vertex);
}

// A normal, given outwards, on the side that is seen.
fn facing(outwards: vec3<f32>, in: SceneFragment) -> vec3<f32> {
    if DOUBLE_SIDED {
        return select(-outwards, outwards, in.is_outside);
    }
    return outwards;
}

// The unit normal outwards, of the normal map where the material has one.
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
