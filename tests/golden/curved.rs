//! Relief on a curved mesh, in perspective: tangent frames from the mesh, silhouettes, and the depth of the relief.

use glam::{Mat4, Vec3};
use relievo::Error;
use relievo::asset::Light;
use relievo::gpu::Gpu;
use relievo::ops::surface::tangent::TangentMesh;
use relievo::ops::surface::tangent::reference::tangents;
use relievo::ops::surface::{Green, ReliefMethod, ReliefOptions, ReliefShadow, SurfaceMesh, SurfaceVertex};
use relievo::render::Offscreen;
use relievo::scene::{Camera, Depth, Placement, Relief, Scene};
use relievo_samples::BuiltInMap;

use crate::harness::{self, Tolerance, check_golden};

const SKY: [f32; 3] = [0.045, 0.055, 0.07];

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
    let mesh = TangentMesh { positions: &positions, normals: &normals, uv: &uv, indices: &indices };
    let tangents = tangents(&mesh).expect("a valid mesh");
    let vertices = (0..positions.len()).map(|i| SurfaceVertex {
        position: positions[i],
        normal: normals[i],
        tangent: tangents[i],
        uv: uv[i],
    });
    SurfaceMesh { vertices: vertices.collect(), indices }
}

fn options(method: ReliefMethod, depth: bool, silhouette: bool) -> ReliefOptions {
    let (shadow, normal_map) = (ReliefShadow::Hard, None);
    ReliefOptions { method, shadow, normal_map, silhouette, depth, mip: true }
}

/// Meshes of cobbles without a normal map, both of whose sides are seen, added in their order.
fn scene_of(gpu: &Gpu, meshes: &[SurfaceMesh], options: ReliefOptions) -> Result<Scene, Error> {
    let map = BuiltInMap::Cobbles.height_map(128).expect("a map");
    let albedo = BuiltInMap::Cobbles.albedo(128).expect("colours");
    let mut scene = Scene::new(gpu)?;
    for mesh in meshes {
        let relief = Relief::new(mesh.clone(), map.clone(), albedo.clone());
        let relief = Relief { options, double_sided: true, ..relief };
        let (direction, ambient) = (relief.material.light.into(), relief.material.ambient);
        scene.set_light(Light { direction, color: Vec3::ONE, ambient })?;
        let object = scene.add_relief(&relief, 1)?;
        scene.spawn(object, Placement::default())?;
    }
    Ok(scene)
}

fn drawn(gpu: &Gpu, scene: &mut Scene, camera: Camera) -> image::RgbaImage {
    let target = Offscreen::new(gpu, [176, 112]).expect("a target");
    target.draw(scene, camera, SKY).expect("drawn");
    target.read(gpu).expect("read")
}

fn in_perspective() -> Camera {
    Camera::looking_at(Vec3::new(1.6, 1.7, 3.1), Vec3::ZERO, 0.75, [0.1, 20.0], [176, 112])
}

#[test]
fn a_barrel_of_cobbles() {
    let gpu = harness::gpu();
    let views = [("barrel_quadtree", ReliefMethod::Quadtree), ("barrel_relief", ReliefMethod::Relief)];
    let wrong = views.into_iter().filter_map(|(name, method)| {
        let mut scene = scene_of(&gpu, &[barrel()], options(method, false, true)).expect("a scene");
        let image = drawn(&gpu, &mut scene, in_perspective());
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
        ReliefOptions { shadow: ReliefShadow::Hard, ..plain },
        ReliefOptions { shadow: ReliefShadow::Soft, ..plain },
        ReliefOptions { silhouette: true, ..plain },
    ]
    .map(|options| {
        let mut scene = scene_of(&gpu, &[barrel()], options).expect("a scene");
        drawn(&gpu, &mut scene, in_perspective())
    });
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
    match scene_of(&harness::gpu(), &[barrel()], options) {
        Err(Error::Input(error)) => assert_eq!(error.path, "relief.maps.normals"),
        other => panic!("{other:?}"),
    }
}

/// A parallel camera, 30° below the normal of the plane z = 0, which it shows straightened.
fn from_below() -> Camera {
    let towards = Vec3::new(0.0, -0.5, 0.866_025_4);
    let slant = Mat4::from_cols(
        Vec3::X.extend(0.0),
        Vec3::Y.extend(0.0),
        Vec3::new(0.0, -towards.y / towards.z, 1.0).extend(0.0),
        glam::Vec4::W,
    );
    let clip_from_view =
        Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(1.4, 1.8, -0.5)) * slant;
    let view_from_cell = Mat4::IDENTITY;
    Camera { cell: [0; 3], view_from_cell, clip_from_view, viewport: [176, 112], depth: Depth::Forward }
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
        let options = options(ReliefMethod::Quadtree, depth, false);
        let mut scene = scene_of(&gpu, meshes, options).expect("a scene");
        drawn(&gpu, &mut scene, from_below())
    };
    let (first, second) = (shifted([0.0, 0.0]), shifted([0.31, 0.17]));
    let alone = [look(true, std::slice::from_ref(&first)), look(true, std::slice::from_ref(&second))];
    let flat = look(false, &[first.clone(), second.clone()]);
    let deep = look(true, &[first, second]);
    let same = |a: &image::RgbaImage, b: &image::RgbaImage| {
        a.pixels().zip(b.pixels()).filter(|(a, b)| a == b).count() as f64 / a.pixels().len() as f64
    };
    assert!(same(&flat, &alone[1]) > 0.99, "equal depths: the last drawn stays");
    let shares = [same(&deep, &alone[0]), same(&deep, &alone[1])];
    assert!(shares.iter().all(|fraction| (0.3..0.95).contains(fraction)), "both show: {shares:?}");
    let from_either = deep.pixels().zip(alone[0].pixels().zip(alone[1].pixels()));
    assert!(from_either.filter(|(deep, (a, b))| deep != a && deep != b).count() == 0, "nothing else shows");
}
