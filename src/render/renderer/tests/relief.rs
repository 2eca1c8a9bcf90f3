//! A relief looks the same when the mesh is larger and when the instance is scaled up.

use glam::{Mat4, Vec3};

use super::mesh::OBJECT;
use super::stage::{FORMAT, Stage, differing, drawn, gpu, through, view};
use crate::asset::Light;
use crate::asset::transform::{AFFINE_IDENTITY, rows};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::render::{Layer, TargetFormat};
use crate::samples::maps::BuiltInMap;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{ReliefBindings, ReliefLook};
use crate::scene::mesh::{Faces, MeshDrawable, MeshGeometry, MeshMaterials, MeshPart};
use crate::shared::render::scene_vertex::MeshParams;
use crate::shared::render::scene_view::SceneView;
use crate::skinning::vertex::Vertex;
use crate::surface::mips::Mips;
use crate::surface::{
    Address, ColorTexture, March, ReliefMaps, ReliefMaterial, ReliefMethod, ReliefOptions, ReliefShadow,
    SurfaceMesh, SurfaceTextures,
};

const TILES: f32 = 2.0;

/// Textures of a relief.
pub struct Maps {
    textures: SurfaceTextures,
    albedo: ColorTexture,
}

impl Maps {
    pub fn new(gpu: &Gpu, method: ReliefMethod) -> Self {
        let height = BuiltInMap::Cobbles.height_map(64).expect("a map");
        let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(64).expect("a map"));
        Self {
            textures: SurfaceTextures::new(gpu, &height, method, Address::Wrap).expect("uploaded"),
            albedo: ColorTexture::new(gpu, &albedo, Address::Wrap).expect("uploaded"),
        }
    }

    fn maps(&self) -> ReliefMaps<'_> {
        ReliefMaps { textures: &self.textures, albedo: &self.albedo, normals: None }
    }
}

/// A relief material with the default light.
fn material(plane: f32) -> ReliefMaterial {
    let light = Light::default();
    ReliefMaterial {
        light: light.direction.normalize().into(),
        ambient: light.ambient,
        plane,
        ..ReliefMaterial::default()
    }
}

/// A square with a relief, as an object.
pub fn square(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    maps: &Maps,
    options: ReliefOptions,
    plane: f32,
) -> MeshDrawable {
    let mesh = SurfaceMesh::square(TILES);
    mesh_of(gpu, layouts, maps, options, &mesh, 1.0 / TILES, plane)
}

/// A mesh with a relief. One uv unit has the given length in model units.
fn mesh_of(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    maps: &Maps,
    options: ReliefOptions,
    square: &SurfaceMesh,
    world: f32,
    plane: f32,
) -> MeshDrawable {
    let vertex = |vertex: &crate::surface::SurfaceVertex| Vertex {
        position: vertex.position,
        normal: vertex.normal,
        tangent: vertex.tangent,
    };
    let look = ReliefLook {
        material: material(plane),
        march: March::default(),
        range: [[0.0; 2], [TILES; 2]],
        world,
        color: [1.0; 3],
    };
    let up = "uploaded";
    let params = MeshParams { clusters: 0, last: 0, partners: 0 };
    let uv: Vec<_> = square.vertices.iter().map(|vertex| vertex.uv).collect();
    let vertices: Vec<_> = square.vertices.iter().map(vertex).collect();
    let geometry = MeshGeometry {
        object: Uniform::new(gpu, "object", &OBJECT).expect(up),
        params: Uniform::new(gpu, "mesh", &params).expect(up),
        vertices: Buffer::from_slice(gpu, "vertices", &vertices).expect(up),
        last: 0,
        page_table: Buffer::from_slice(gpu, "no pages", &[0]).expect(up),
        uv: Buffer::from_slice(gpu, "uv", &uv).expect(up),
        partners: 0,
        material_of: Buffer::from_slice(gpu, "material of", &[0; 4]).expect(up),
        indices: Buffer::from_slice(gpu, "indices", &square.indices).expect(up),
    };
    let relief = ReliefBindings::new(gpu, layouts, maps.maps(), options, &look).expect("bound");
    let part = MeshPart::new(Faces { blended: false, double_sided: true }, MeshMaterials::Relief(relief));
    MeshDrawable::new(gpu, layouts, geometry, 0, vec![part]).expect("bound")
}

/// The placement of the square.
pub fn place(scale: Vec3) -> Mat4 {
    Mat4::from_rotation_x(-0.7) * Mat4::from_scale(scale)
}

/// The square in world space, with the scale and the placement of the instance.
fn placed(scale: f32) -> SurfaceMesh {
    let into = place(Vec3::ONE);
    let mut mesh = SurfaceMesh::square(TILES);
    for vertex in &mut mesh.vertices {
        let [tangent, normal] = [Vec3::from_slice(&vertex.tangent), Vec3::from(vertex.normal)];
        vertex.position = into.transform_point3(scale * Vec3::from(vertex.position)).into();
        vertex.normal = into.transform_vector3(normal).into();
        vertex.tangent = into.transform_vector3(tangent).extend(vertex.tangent[3]).into();
    }
    mesh
}

#[test]
fn a_scaled_instance_is_a_larger_mesh() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let format = TargetFormat::new(FORMAT);
    for (method, shadow, depth, scale) in [
        (ReliefMethod::Quadtree, ReliefShadow::Hard, false, 1.0),
        (ReliefMethod::Relief, ReliefShadow::Soft, true, 1.7),
        (ReliefMethod::Parallax, ReliefShadow::None, true, 0.8),
    ] {
        let maps = Maps::new(&gpu, method);
        let options = ReliefOptions { method, shadow, silhouette: depth, depth, ..ReliefOptions::default() };
        let seen = view(Vec3::new(0.3, 0.9, 1.6), false);
        let large = mesh_of(&gpu, &layouts, &maps, options, &placed(scale), scale / TILES, 1.0);
        let stage = Stage::new(&gpu, &layouts, seen, &[AFFINE_IDENTITY], &[[0, 6]]);
        let expected = drawn(&gpu, &format, &large, &stage, None, &[Layer::Color]);
        let square = square(&gpu, &layouts, &maps, options, 1.0);
        let look = |scale: Vec3| {
            let placement = rows(&place(scale).to_cols_array());
            let stage = Stage::new(&gpu, &layouts, seen, &[placement], &[[0, 6]]);
            drawn(&gpu, &format, &square, &stage, None, &[Layer::Color])
        };
        let found = look(Vec3::splat(scale));
        let wrong = differing(&found, &expected, 2);
        // A ray past the edge of a stone may round to either side.
        assert!(wrong <= 20, "{method:?}: {wrong} pixels");
        assert!(differing(&look(Vec3::splat(1.1 * scale)), &expected, 2) > 1000);
    }
}

#[test]
fn a_mirrored_relief_is_the_mirror_image() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let maps = Maps::new(&gpu, ReliefMethod::Quadtree);
    let options = ReliefOptions { shadow: ReliefShadow::Hard, depth: true, ..ReliefOptions::default() };
    let square = square(&gpu, &layouts, &maps, options, 1.0);
    let format = TargetFormat::new(FORMAT);
    // Placement, eye, light and picture mirrored in the plane x = 0.
    let mirror = Vec3::new(-1.0, 1.0, 1.0);
    let seen = view(Vec3::new(0.3, 0.9, 1.6), false);
    let plain = Stage::new(&gpu, &layouts, seen, &[rows(&place(Vec3::ONE).to_cols_array())], &[[0, 6]]);
    let eye = seen.eye * mirror.extend(1.0);
    let light = seen.light * mirror.extend(1.0);
    let other = SceneView { light, ..through(seen.clip_from_world * Mat4::from_scale(mirror), eye) };
    let mirrored = Stage::new(&gpu, &layouts, other, &[rows(&place(mirror).to_cols_array())], &[[0, 6]]);
    let [a, b] = [&plain, &mirrored].map(|stage| drawn(&gpu, &format, &square, stage, None, &[Layer::Color]));
    assert!(differing(&a, &b, 2) <= 20, "{} pixels", differing(&a, &b, 2));
}
