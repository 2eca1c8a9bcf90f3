//! Meshes in pieces and terrain in chunks: what a single binding of the device does not hold.

use glam::Vec3;
use relievo::asset::material::Alpha;
use relievo::asset::{Influence, Influences, Material, Mesh, MeshLevel, Model};
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, Ray, Scene, TerrainSource};

use crate::frame::{Frame, device};
use crate::harness::{Difference, gpu_of_bindings};
use crate::raw::Raw;
use crate::world::{SIZE, model};

/// Vertices along an edge of a cloth.
const EDGE: u32 = 321;

/// A cloth in waves with 103,041 vertices, which 3 MiB do not hold, and a border of another colour that is seen from one side;
/// its second level has every other vertex in each direction.
pub fn cloth() -> Model {
    let mut model = relievo::ops::skinning::at_rest::at_rest(&model()).expect("at rest");
    let color = |color| Material {
        name: "cloth".to_owned(),
        color,
        texture: None,
        normal: None,
        normal_scale: 1.0,
        alpha: Alpha::Opaque,
        pbr: Default::default(),
    };
    model.materials = vec![color([0.2, 0.5, 0.9, 1.0]), color([0.9, 0.3, 0.1, 1.0])];
    let border = EDGE / 4 / 2 * 2;
    let sheet = |columns: std::ops::Range<u32>, material: usize| {
        let (first, width) = (columns.start, columns.len() as u32);
        let places = (0..EDGE).flat_map(|row| columns.clone().map(move |column| [column, row]));
        let positions = places.map(|[column, row]| {
            let [x, z] = [column, row].map(|at| 8.0 * at as f32 / (EDGE - 1) as f32 - 4.0);
            [x, 0.3 * (3.0 * x).sin() * (2.0 * z + 1.0).cos(), z]
        });
        let positions: Vec<[f32; 3]> = positions.collect();
        let triangles = |step: u32| {
            let corners = move |row: u32, column: u32| {
                let at = |down: u32, right: u32| (row + down * step) * width + column + right * step - first;
                [at(0, 0), at(1, 0), at(0, 1), at(0, 1), at(1, 0), at(1, 1)]
            };
            let steps = move |from: u32, to: u32| (from..to).step_by(step as usize);
            let columns = columns.clone();
            let cells = steps(0, EDGE - 1).flat_map(move |row| {
                steps(columns.start, columns.end - 1).map(move |column| corners(row, column))
            });
            cells.flatten().collect::<Vec<u32>>()
        };
        let one = || vec![Influence { bone: 0, weight: 1.0 }];
        Mesh {
            normals: vec![[0.0, 1.0, 0.0]; positions.len()],
            tangents: vec![[1.0, 0.0, 0.0, 1.0]; positions.len()],
            uv: vec![[0.0; 2]; positions.len()],
            indices: triangles(1),
            influences: Influences::new("cloth", 1, positions.iter().map(|_| one())).expect("valid"),
            levels: vec![MeshLevel { indices: triangles(2), error: 0.02 }],
            material: Some(material),
            double_sided: material == 0,
            positions,
            ..model.meshes[0].clone()
        }
    };
    model.meshes = vec![sheet(0..border + 1, 1), sheet(border..EDGE, 0)];
    model
}

/// Meshes that exceed a binding are drawn in pieces, at every level, and look as they do whole; rays hit them once.
#[test]
fn meshes_beyond_a_binding_are_drawn_in_pieces() {
    let cloth = cloth();
    let draw = |gpu: &Gpu| {
        let mut scene = Scene::new(gpu).expect("compiled");
        let object = scene.add_mesh(&cloth, 2).expect("added");
        let near = Placement::at([0.0, 0.0, 0.0]).turned(0.4);
        let far = Placement { scale: Vec3::new(-1.0, 1.0, 1.0), ..Placement::at([15.0, -9.0, -40.0]) };
        for placement in [near, far] {
            scene.spawn(object, placement).expect("room");
        }
        let mut view = scene.view(Quality::pixels(0.5)).expect("a view");
        let camera = Camera::looking_at(Vec3::new(1.0, 5.0, 9.0), Vec3::ZERO, 0.8, [0.3, 400.0], SIZE);
        view.set(camera).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        let picture = frame.shot(&mut scene, &mut view, &renderer);
        let ray = Ray::new([1.0, 5.0, 9.0], [-0.11, -0.55, -0.83]);
        let hit = scene.pick(&ray).expect("a ray").expect("a hit");
        (picture, scene.draws(object).expect("there"), hit.distance)
    };
    let (divided, pieces, distance) = draw(&gpu_of_bindings(3 << 20));
    let (whole, draws, expected) = draw(&device());
    println!("draws: {pieces} in pieces, {draws} whole");
    assert!(pieces > draws && draws <= 64, "{pieces} draws, {draws}");
    assert!(distance == expected, "{distance} m, {expected} m");
    let difference = Difference::of(&divided, &whole, 0);
    assert!(difference.outliers < 0.001, "{difference:?}");
}

/// Terrain whose heights exceed a binding is drawn in chunks, and looks as it does whole; its patches keep their numbers.
#[test]
fn terrain_beyond_a_binding_is_drawn_in_chunks() {
    let patches: Vec<[i32; 2]> = (0..256).map(|at| [at % 16 - 8, at / 16 - 8]).collect();
    let draw = |gpu: &Gpu| {
        let mut scene = Scene::new(gpu).expect("compiled");
        let config = TerrainConfig::new(65, 12.0, "chunks").expect("valid");
        let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches)).expect("generated");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        let camera = Camera::looking_at(Vec3::new(20.0, 180.0, -300.0), Vec3::ZERO, 0.8, [1.0, 4000.0], SIZE);
        view.set(camera).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        let before = frame.shot(&mut scene, &mut view, &renderer);
        scene.refresh().expect("afresh");
        let after = frame.shot(&mut scene, &mut view, &renderer);
        assert!(before == after, "another picture afresh");
        let raw = Raw::new(gpu, TargetFormat::measure(), SIZE);
        let renderer = raw.renderer(gpu, &scene);
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Measure]);
        let numbers = raw.words(gpu, 1);
        (before, scene.draws(land).expect("there"), numbers)
    };
    // 256 patches of 67 × 67 heights are 4.6 MB.
    let (divided, chunks, numbers) = draw(&gpu_of_bindings(3 << 20));
    let (whole, draws, expected) = draw(&device());
    println!("draws: {chunks} in chunks, {draws} whole");
    assert!(draws == 1 && chunks > 1, "{chunks} draws, {draws}");
    let difference = Difference::of(&divided, &whole, 0);
    assert!(difference.outliers < 0.001, "{difference:?}");
    let wrong = numbers.iter().zip(&expected).filter(|(a, b)| a != b).count();
    assert!(1000 * wrong < numbers.len(), "{wrong} other numbers");
    assert!(numbers.iter().any(|[_, instance]| *instance > 200), "patches of the last chunk are seen");
}
