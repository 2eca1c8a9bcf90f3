//! Reliefs from textures that the caller shares, and pictures of them in linear light.

use glam::Vec3;
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::ops::surface::{
    Address, ColorTexture, Green, HeightMap, March, Mips, ReliefMaps, ReliefMaterial, ReliefMethod,
    ReliefOptions, ReliefShadow, SurfaceMesh, SurfaceTextures,
};
use relievo::render::{Offscreen, TargetFormat};
use relievo::scene::{Camera, Placement, Relief, ReliefSource, Scene};
use relievo::{Error, InputError};
use relievo_samples::maps::BuiltInMap;

use crate::frame::device;
use crate::harness::Difference;

const SIZE: [u32; 2] = [160, 100];

fn images() -> (HeightMap, RgbaImage, RgbaImage) {
    let bricks = BuiltInMap::Bricks;
    let (heights, colors) = (bricks.height_map(64).expect("a map"), bricks.albedo(64).expect("colours"));
    let normals = RgbaImage::from_fn(64, 64, |x, y| image::Rgba([100 + x as u8, 90 + y as u8, 230, 255]));
    (heights, colors, normals)
}

/// A wall of the relief, seen aslant.
fn scene_of(gpu: &Gpu, relief: &Relief) -> Result<Scene, Error> {
    let mut scene = Scene::new(gpu)?;
    let wall = scene.add_relief(relief, 1)?;
    scene.spawn(wall, Placement::default())?;
    Ok(scene)
}

fn camera() -> Camera {
    Camera::looking_at(Vec3::new(0.5, 0.2, 1.2), Vec3::ZERO, 0.8, [0.1, 10.0], SIZE)
}

fn picture(gpu: &Gpu, relief: &Relief) -> RgbaImage {
    let target = Offscreen::new(gpu, SIZE).expect("a target");
    let mut scene = scene_of(gpu, relief).expect("added");
    target.draw(&mut scene, camera(), [0.1, 0.2, 0.3]).expect("drawn");
    target.read(gpu).expect("read")
}

fn path(error: Error) -> String {
    match error {
        Error::Input(InputError { path, .. }) => path,
        other => panic!("{other}"),
    }
}

/// Textures that were made from the same images give the same bits, and several objects share them.
#[test]
fn textures_of_the_caller_look_like_images() {
    let gpu = device();
    let (heights, colors, bumps) = images();
    let mesh = SurfaceMesh::square(2.0);
    let mut last: Option<RgbaImage> = None;
    for (method, address) in [(ReliefMethod::Quadtree, Address::Wrap), (ReliefMethod::Cone, Address::Clamp)] {
        let textures = SurfaceTextures::new(&gpu, &heights, method, address).expect("uploaded");
        let albedo = ColorTexture::new(&gpu, &Mips::of_color(colors.clone()), address).expect("uploaded");
        let normals = ColorTexture::new(&gpu, &Mips::of_data(bumps.clone()), address).expect("uploaded");
        for normals in [None, Some(&normals)] {
            let maps = ReliefMaps { textures: &textures, albedo: &albedo, normals };
            let shared = Relief::of_maps(mesh.clone(), maps);
            let normal_map = normals.map(|_| Green::Up);
            let options = ReliefOptions { normal_map, shadow: ReliefShadow::Hard, ..shared.options };
            let shared = Relief { options, ..shared };
            let own = Relief::new(mesh.clone(), heights.clone(), colors.clone());
            let own = if normals.is_some() { own.with_normals(bumps.clone(), Green::Up) } else { own };
            assert_eq!(own.options.normal_map, normal_map);
            let own = Relief { options, march: March { address, ..own.march }, ..own };
            let found = picture(&gpu, &shared);
            assert!(found == picture(&gpu, &own), "{method:?}: another picture");
            assert!(found == picture(&gpu, &shared), "{method:?}: a second object looks different");
            assert!(last.as_ref() != Some(&found), "{method:?}: a map makes no difference");
            last = Some(found);
        }
    }
}

/// Half floats and floats in linear light are the picture in sRGB, but for rounding.
#[test]
fn linear_light_is_encoded_to_the_same_picture() {
    let gpu = device();
    let (heights, colors, _) = images();
    let textures =
        SurfaceTextures::new(&gpu, &heights, ReliefMethod::Quadtree, Address::Wrap).expect("uploaded");
    let albedo =
        ColorTexture::linear(&gpu, &Mips::of_color(colors.clone()), Address::Wrap).expect("uploaded");
    let maps = ReliefMaps { textures: &textures, albedo: &albedo, normals: None };
    let mesh = SurfaceMesh::square(2.0);
    let target = Offscreen::linear(&gpu, SIZE).expect("a target");
    let mut scene = scene_of(&gpu, &Relief::of_maps(mesh.clone(), maps)).expect("added");
    target.draw(&mut scene, camera(), [0.1, 0.2, 0.3]).expect("drawn");
    let found = target.read_linear(&gpu).expect("read").encoded();
    let expected = picture(&gpu, &Relief::new(mesh, heights, colors));
    let difference = Difference::of(&found, &expected, 3);
    assert!(difference.worst <= 3 && difference.flip <= 0.01, "{difference:?}");
    assert_eq!(path(target.read(&gpu).expect_err("refused")), "format.color[0].format");
    let plain = Offscreen::new(&gpu, SIZE).expect("a target");
    assert_eq!(path(plain.read_linear(&gpu).expect_err("refused")), "format.color[0].format");
    let depth = Offscreen::with_format(
        &gpu,
        SIZE,
        TargetFormat::depth_only(relievo::wgpu::TextureFormat::Depth32Float),
    )
    .expect("a target");
    assert_eq!(path(depth.read_linear(&gpu).expect_err("refused")), "format.color");
    assert_eq!(path(depth.draw(&mut scene, camera(), [0.0; 3]).expect_err("refused")), "layer");
}

/// Textures that do not fit the options are refused by name, and so are textures of a device that was lost.
#[test]
fn mistakes_about_maps_are_told() {
    let gpu = device();
    let (heights, colors, bumps) = images();
    let textures = SurfaceTextures::new(&gpu, &heights, ReliefMethod::Cone, Address::Wrap).expect("uploaded");
    let albedo = ColorTexture::new(&gpu, &Mips::of_color(colors), Address::Wrap).expect("uploaded");
    let maps = ReliefMaps { textures: &textures, albedo: &albedo, normals: None };
    let good = Relief::of_maps(SurfaceMesh::square(1.0), maps);
    assert_eq!((good.options.method, good.march.address), (ReliefMethod::Cone, Address::Wrap));
    let refused = |relief: Relief| path(scene_of(&gpu, &relief).expect_err("refused"));
    let options = ReliefOptions { method: ReliefMethod::Quadtree, ..good.options };
    assert_eq!(refused(Relief { options, ..good.clone() }), "relief.options.method");
    let march = March { address: Address::Clamp, ..good.march };
    assert_eq!(refused(Relief { march, ..good.clone() }), "relief.march.address");
    let options = ReliefOptions { normal_map: Some(Green::Up), ..good.options };
    assert_eq!(refused(Relief { options, ..good.clone() }), "relief.maps.normals");
    let material = ReliefMaterial { scale: f32::NAN, ..good.material };
    assert_eq!(refused(Relief { material, ..good.clone() }), "relief.material.scale");
    let still = good.clone().with_normals(bumps, Green::Up);
    assert!(matches!(still.maps, ReliefSource::Textures { normals: None, .. }));
    assert_eq!(still.options.normal_map, None);
    let mut scene = scene_of(&gpu, &good).expect("added");
    assert_eq!(path(scene.rebuild(&gpu).expect_err("refused")), "relief.maps");
}

/// Images without texels, images beyond the device's textures and meshes without numbers are refused by field and size.
#[test]
fn images_and_meshes_of_reliefs_are_checked() {
    let gpu = device();
    let (heights, colors, bumps) = images();
    let relief = |albedo| Relief::wall(1.0, heights.clone(), albedo);
    let refused = |relief: &Relief| scene_of(&gpu, relief).expect_err("refused").to_string();
    let most = "must be 1 to 8192 texels wide and high, the device's limit for textures";
    let empty = refused(&relief(RgbaImage::new(0, 0)));
    assert_eq!(empty, format!("relief.maps.albedo = 0 × 0: {most}"));
    let wide = refused(&relief(RgbaImage::new(9000, 2)));
    assert_eq!(wide, format!("relief.maps.albedo = 9000 × 2: {most}"));
    let normals = relief(colors.clone()).with_normals(RgbaImage::new(3, 0), Green::Up);
    assert_eq!(refused(&normals), format!("relief.maps.normals = 3 × 0: {most}"));
    let tiles = Relief::wall(f32::NAN, heights.clone(), colors.clone());
    assert_eq!(refused(&tiles), "relief.mesh.vertices[0].uv = [NaN, NaN]: must be finite");
    let mut torn = relief(colors.clone());
    torn.mesh.indices[4] = 9;
    let torn = refused(&torn);
    assert_eq!(torn, "relief.mesh.indices[4] = 9: must be below 4, the number of vertices");
    scene_of(&gpu, &relief(colors).with_normals(bumps, Green::Up)).expect("added");
}
