//! Relief on a curved mesh, in perspective: tangent frames from the mesh, silhouettes, and the depth of the relief.

use glam::{Mat4, Vec3, Vec4, camera};
use relievo::Error;
use relievo::gpu::Gpu;
use relievo::render::relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
use relievo::render::{ColorTexture, Target, target::COLOR_FORMAT};
use relievo::samples::BuiltInMap;
use relievo::surface::relief::textures::SurfaceTextures;
use relievo::surface::tangent::Mesh;
use relievo::surface::tangent::reference::tangents;
use relievo::surface::{Address, Green, March, Material, Method, Mips, Shadow, SurfaceMesh, SurfaceVertex};

use crate::harness::{self, Tolerance, check_golden};

const SKY: [f64; 3] = [0.045, 0.055, 0.07];

/// A barrel: `u` around it, `v` down it; tangents by `surface::tangent`.
fn barrel() -> SurfaceMesh {
    let (columns, rows) = (48_u32, 12_u32);
    let vertices = (0..=rows).flat_map(|row| (0..=columns).map(move |column| (row, column)));
    let (mut positions, mut normals, mut uv) = (Vec::new(), Vec::new(), Vec::new());
    for (row, column) in vertices {
        let (turn, down) = (column as f32 / columns as f32, row as f32 / rows as f32);
        let angle = turn * std::f32::consts::TAU;
        let bulge = 0.8 + 0.8 * down * (1.0 - down);
        let slope = -0.8 * (1.0 - 2.0 * down) / 2.4;
        positions.push([bulge * angle.cos(), 1.2 - 2.4 * down, -bulge * angle.sin()]);
        normals.push(Vec3::new(angle.cos(), -slope, -angle.sin()).normalize().to_array());
        uv.push([3.0 * turn, 1.5 * down]);
    }
    let mut indices = Vec::new();
    for (row, column) in (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column))) {
        let first = row * (columns + 1) + column;
        let below = first + columns + 1;
        indices.extend([first, below, first + 1, first + 1, below, below + 1]);
    }
    let mesh = Mesh { positions: &positions, normals: &normals, uv: &uv, indices: &indices };
    let tangents = tangents(&mesh).expect("a valid mesh");
    let vertices = (0..positions.len()).map(|i| SurfaceVertex {
        position: positions[i],
        normal: normals[i],
        tangent: tangents[i],
        uv: uv[i],
    });
    SurfaceMesh { vertices: vertices.collect(), indices }
}

/// World units per unit of uv: a tile is 1.6 high, and nearly as wide.
const WORLD: f32 = 1.6;

fn scene(gpu: &Gpu, mesh: &SurfaceMesh, method: Method, depth: bool, silhouette: bool) -> ReliefScene {
    let options = ReliefOptions {
        method,
        shadow: Shadow::Hard,
        silhouette,
        depth,
        mip: true,
        ..ReliefOptions::default()
    };
    scene_of(gpu, mesh, options).expect("a scene")
}

/// Cobbles, without a normal map.
fn scene_of(gpu: &Gpu, mesh: &SurfaceMesh, options: ReliefOptions) -> Result<ReliefScene, Error> {
    let map = BuiltInMap::Cobbles.height_map(128).expect("a map");
    let textures = SurfaceTextures::new(gpu, &map, options.method, Address::Wrap).expect("uploaded");
    let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(128).expect("colours"));
    let albedo = ColorTexture::new(gpu, &albedo, true).expect("uploaded");
    let renderer = ReliefRenderer::new(gpu, COLOR_FORMAT, options).expect("compiled");
    let maps = ReliefMaps { textures: &textures, albedo: &albedo, normals: None };
    let mut scene = renderer.scene(gpu, mesh, maps, &Material::default(), &March::default(), WORLD)?;
    let eye = Vec3::new(1.6, 1.7, 3.1);
    let view = camera::rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
    let projection = camera::rh::proj::directx::perspective(0.75, 176.0 / 112.0, 0.1, 20.0);
    let camera = ReliefCamera { clip_from_world: projection * view, eye: eye.extend(1.0) };
    scene.set_camera(gpu, camera)?;
    Ok(scene)
}

fn drawn(gpu: &Gpu, scenes: &[ReliefScene]) -> image::RgbaImage {
    let target = Target::new(gpu, [176, 112]).expect("a target");
    target.draw(gpu, SKY, |pass| scenes.iter().for_each(|scene| scene.draw(pass))).expect("drawn");
    target.read(gpu).expect("read")
}

#[test]
fn a_barrel_of_cobbles() {
    let gpu = harness::gpu();
    let views = [("barrel_quadtree", Method::Quadtree), ("barrel_relief", Method::Relief)];
    let wrong = views.into_iter().filter_map(|(name, method)| {
        let image = drawn(&gpu, &[scene(&gpu, &barrel(), method, false, true)]);
        check_golden(name, &image, Tolerance::IMAGE).err()
    });
    let wrong: Vec<_> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Shadow and silhouette are chosen only in the options: with the same material, each changes the picture.
#[test]
fn options_alone_decide_what_is_drawn() {
    let gpu = harness::gpu();
    let plain = ReliefOptions::default();
    let pictures = [
        plain,
        ReliefOptions { shadow: Shadow::Hard, ..plain },
        ReliefOptions { shadow: Shadow::Soft, ..plain },
        ReliefOptions { silhouette: true, ..plain },
    ]
    .map(|options| drawn(&gpu, &[scene_of(&gpu, &barrel(), options).expect("a scene")]));
    for (index, picture) in pictures.iter().enumerate() {
        assert!(
            pictures[..index].iter().all(|other| other != picture),
            "picture {index} shows nothing of its own"
        );
    }
}

/// A pipeline for normal maps refuses a map of colours only.
#[test]
fn a_pipeline_for_normal_maps_refuses_maps_without_one() {
    let options = ReliefOptions { normal_map: Some(Green::Up), ..ReliefOptions::default() };
    match scene_of(&harness::gpu(), &barrel(), options) {
        Err(Error::Input(error)) => assert_eq!(error.path, "maps.normals"),
        other => panic!("{other:?}"),
    }
}

/// Two squares in one plane: with the polygon's depth one hides the other; with the relief's, the higher stones of
/// either show.
#[test]
fn reliefs_intersect_by_their_own_depth() {
    let gpu = harness::gpu();
    let shifted = |by: [f32; 2]| {
        let mut mesh = SurfaceMesh::square(2.0);
        mesh.vertices.iter_mut().for_each(|vertex| (0..2).for_each(|i| vertex.uv[i] += by[i]));
        mesh
    };
    let look = |depth: bool, meshes: &[SurfaceMesh]| {
        let scenes: Vec<_> = meshes
            .iter()
            .map(|mesh| {
                let mut scene = scene(&gpu, mesh, Method::Quadtree, depth, false);
                let scale = Mat4::from_scale(Vec3::new(1.4, 1.8, 0.5));
                let clip_from_world = Mat4::from_translation(Vec3::Z * 0.5)
                    * scale
                    * Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
                let eye = Vec4::new(0.0, -0.5, 0.866_025_4, 0.0);
                scene.set_camera(&gpu, ReliefCamera { clip_from_world, eye }).expect("set");
                scene
            })
            .collect();
        drawn(&gpu, &scenes)
    };
    let (first, second) = (shifted([0.0, 0.0]), shifted([0.31, 0.17]));
    let alone = [look(true, std::slice::from_ref(&first)), look(true, std::slice::from_ref(&second))];
    let flat = look(false, &[first.clone(), second.clone()]);
    let deep = look(true, &[first, second]);
    let same = |a: &image::RgbaImage, b: &image::RgbaImage| {
        a.pixels().zip(b.pixels()).filter(|(a, b)| a == b).count() as f64 / a.pixels().len() as f64
    };
    assert!(same(&flat, &alone[0]) > 0.99, "equal depths: the first drawn stays");
    let shares = [same(&deep, &alone[0]), same(&deep, &alone[1])];
    assert!(shares.iter().all(|fraction| (0.3..0.95).contains(fraction)), "both show: {shares:?}");
    let from_either = deep.pixels().zip(alone[0].pixels().zip(alone[1].pixels()));
    assert!(from_either.filter(|(deep, (a, b))| deep != a && deep != b).count() == 0, "nothing else shows");
}
