//! The layers of surfaces and of positions, against rays that are traced on the host.

use glam::{DVec3, Vec3};
use relievo::asset::material::Alpha;
use relievo::ops::surface::HeightMap;
use relievo::render::{Attachments, Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, ObjectId, Placement, Quality, Relief, Scene, View};
use relievo::wgpu;

use crate::frame::device;
use crate::harness::is_coarse;
use crate::raw::Raw;
use crate::rays::{Hit, Triangle, cube, matrix, model, picture, placed, plain};
use crate::world::World;

const SIZE: [u32; 2] = [96, 64];

const COLOR: [f32; 4] = [0.25, 0.5, 0.75, 1.0];

fn camera() -> Camera {
    Camera::looking_at(Vec3::new(2.0, 3.0, 9.0), Vec3::new(0.0, 0.3, 0.0), 0.7, [0.5, 60.0], SIZE)
}

/// Three cubes, one of them mirrored and stretched, behind each other, and a cube that was removed.
fn cubes(gpu: &relievo::gpu::Gpu) -> (Scene, View, Vec<Triangle>, [ObjectId; 2]) {
    let mut scene = Scene::new(gpu).expect("compiled");
    let first = scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 1).expect("added");
    let object = scene.add_mesh(&model(&cube(), plain(COLOR, Alpha::Opaque), false), 3).expect("added");
    scene.spawn(first, Placement::at([0.0, -50.0, 0.0])).expect("room");
    let gone = scene.spawn(object, Placement::default()).expect("room");
    let placements = [
        Placement::at([-1.5, 0.4, 0.0]).turned(0.4),
        Placement { scale: Vec3::new(-1.0, 1.5, 0.7), ..Placement::at([1.4, 0.0, -1.0]).turned(-0.8) },
        Placement::at([0.3, 0.6, -4.0]).turned(2.0).scaled(1.3),
    ];
    let mut triangles = Vec::new();
    for placement in &placements {
        let instance = scene.spawn(object, *placement).expect("room");
        // A tag for each side of each cube.
        let tag = |at: usize| 100 * instance.number() as usize + at / 2;
        triangles.extend(placed(&cube(), placement, false, tag));
    }
    scene.despawn(gone).expect("there");
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    view.set(camera()).expect("a camera");
    (scene, view, triangles, [first, object])
}

/// The normal of a triangle, towards the outside.
fn normal(triangle: &Triangle) -> DVec3 {
    let [a, b, c] = triangle.corners;
    (b - a).cross(c - a).normalize()
}

/// Calls `check` with the index of each pixel and what it sees, and says how many pixels see something. At edges, where
/// rounding decides, nothing is checked; these are few.
fn compared(triangles: &[Triangle], camera: &Camera, mut check: impl FnMut(usize, Option<Hit>)) -> usize {
    let picture = picture(triangles, camera);
    let unsure = picture.iter().filter(|pixel| pixel.is_err()).count();
    assert!(50 * unsure < picture.len(), "{unsure} pixels lie at edges");
    let mut seen = 0;
    for (at, pixel) in picture.into_iter().enumerate() {
        let Ok(hit) = pixel else { continue };
        seen += usize::from(hit.is_some());
        check(at, hit);
    }
    seen
}

/// Normals to half a float's eleven bits, colours to a level, and numbers exactly.
#[test]
fn surfaces_are_those_of_traced_rays() {
    let gpu = device();
    let (mut scene, mut view, triangles, [_, object]) = cubes(&gpu);
    let mut floats = TargetFormat::surface();
    floats.color[1] = Some(wgpu::TextureFormat::Rgba16Float.into());
    for format in [TargetFormat::surface(), TargetFormat::surface().reversed(), floats] {
        let raw = Raw::new(&gpu, format, SIZE);
        let mut camera = camera();
        if raw.format.depth.is_some_and(|depth| depth.reversed) {
            camera = crate::frame::reversed(camera, 0.5, true);
        }
        view.set(camera).expect("a camera");
        let renderer = raw.renderer(&gpu, &scene);
        // A prepass changes nothing.
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Depth, Layer::Surface]);
        let (wrong, seen) = wrong_surfaces(&raw, &gpu, &triangles, (COLOR, object.number()));
        assert!(wrong == [0; 3] && seen > 600, "{wrong:?} of {seen} pixels");
        // Faults are seen: surfaces that are turned by a third of a degree, another colour, another number.
        let turned: Vec<Triangle> = triangles.iter().map(turned).collect();
        assert!(wrong_surfaces(&raw, &gpu, &turned, (COLOR, object.number())).0[0] > seen / 2);
        let mut other = COLOR;
        other[1] += 0.01;
        assert_eq!(wrong_surfaces(&raw, &gpu, &triangles, (other, object.number())).0, [0, seen, 0]);
        assert_eq!(wrong_surfaces(&raw, &gpu, &triangles, (COLOR, 1 + object.number())).0, [0, 0, seen]);
    }
}

/// A triangle that is turned a little around its middle.
fn turned(triangle: &Triangle) -> Triangle {
    let middle = triangle.corners.iter().sum::<DVec3>() / 3.0;
    let turn = glam::DQuat::from_euler(glam::EulerRot::XYZ, 0.005, 0.005, 0.005);
    Triangle { corners: triangle.corners.map(|corner| middle + turn * (corner - middle)), ..*triangle }
}

/// How many pixels of a picture of surfaces have another normal, another colour, and other numbers than traced rays; and how
/// many see something.
fn wrong_surfaces(
    raw: &Raw,
    gpu: &relievo::gpu::Gpu,
    triangles: &[Triangle],
    (color, object): ([f32; 4], u32),
) -> ([usize; 3], usize) {
    let (normals, colors, ids) = (raw.floats(gpu, 0), raw.floats(gpu, 1), raw.words(gpu, 2));
    let mut wrong = [0; 3];
    let seen = compared(triangles, &camera(), |at, hit| {
        let Some(hit) = hit else {
            let found = [normals[at] != [0.0; 4], colors[at] != [0.0; 4], ids[at] != [0; 2]];
            wrong.iter_mut().zip(found).for_each(|(wrong, found)| *wrong += usize::from(found));
            return;
        };
        let triangle = &triangles[hit.triangle];
        let expected = normal(triangle).as_vec3().extend(1.0);
        let near = |found: [f32; 4], wanted: [f32; 4], bound: f32| {
            found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= bound)
        };
        // A half float is off by 2^-11 of values below 1 at most, and the normal by some units of 2^-24.
        wrong[0] += usize::from(!near(normals[at], expected.into(), 0.0005));
        wrong[1] += usize::from(!near(colors[at], color, 1.0 / 255.0));
        wrong[2] += usize::from(ids[at] != [object, (triangle.tag / 100) as u32]);
    });
    (wrong, seen)
}

/// Positions are those of the rays, at any distance from the origin of the world: rounding of the transforms, of the
/// interpolation and of the ray that is compared is a few units in 2^-24 of 20 world units, magnified where a surface is
/// seen at a flat angle, ten times at most here.
#[test]
fn positions_are_those_of_traced_rays() {
    let gpu = device();
    for cell in [[0; 3], [40_000, -3, 7]] {
        let (mut scene, mut view, triangles, objects) = cubes(&gpu);
        let object = objects[1];
        for id in objects {
            for instance in scene.instances(id).expect("there") {
                let placement = scene.placement(instance).expect("there");
                let moved = [0, 1, 2].map(|axis| placement.cell[axis] + cell[axis]);
                scene.move_to(instance, Placement { cell: moved, ..placement }).expect("there");
            }
        }
        view.set(Camera { cell, ..camera() }).expect("a camera");
        let raw = Raw::new(&gpu, TargetFormat::measure(), SIZE);
        let renderer = raw.renderer(&gpu, &scene);
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Measure]);
        let (worst, wrong, seen) = wrong_positions(&raw, &gpu, &triangles, object.number());
        println!("off by {worst}");
        assert!(seen > 600 && worst < 2e-4 && wrong == 0, "{seen} pixels, off by {worst}, {wrong} wrong");
        // Faults are seen: surfaces that are moved by a thousandth of a unit (or by more than rounded vertices explain), and
        // another number.
        let shift = DVec3::new(1.0, 0.0, 1.0) * if is_coarse() { 0.05 } else { 0.001 };
        let moved = |triangle: &Triangle| Triangle {
            corners: triangle.corners.map(|corner| corner + shift),
            ..*triangle
        };
        let moved: Vec<Triangle> = triangles.iter().map(moved).collect();
        assert!(wrong_positions(&raw, &gpu, &moved, object.number()).0 > 4e-4);
        assert_eq!(wrong_positions(&raw, &gpu, &triangles, 1 + object.number()).1, seen);
    }
}

/// How far the positions of a picture are from those of traced rays; how many pixels have other numbers or show what is not
/// there; and how many see something.
fn wrong_positions(
    raw: &Raw,
    gpu: &relievo::gpu::Gpu,
    triangles: &[Triangle],
    object: u32,
) -> (f64, usize, usize) {
    let (positions, ids) = (raw.floats(gpu, 0), raw.words(gpu, 1));
    let (mut worst, mut wrong) = (0.0_f64, 0);
    let seen = compared(triangles, &camera(), |at, hit| {
        let Some(hit) = hit else {
            wrong += usize::from((positions[at], ids[at]) != ([0.0; 4], [0; 2]));
            return;
        };
        let [x, y, z, w] = positions[at].map(f64::from);
        let slack = hit.slack(|place| place.distance(hit.position));
        worst = worst.max(DVec3::new(x, y, z).distance(hit.position) - slack);
        wrong += usize::from(w != 1.0 || ids[at] != [object, (triangles[hit.triangle].tag / 100) as u32]);
    });
    (worst, wrong, seen)
}

/// Pixels that alpha leaves out show what is behind them.
#[test]
fn cut_out_pixels_are_left_out() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let wall = [[[-90.0, -90.0, 0.0], [90.0, -90.0, 0.0], [0.0, 90.0, 0.0]]];
    let plane = |alpha, scene: &mut Scene, z: f32| {
        let material = plain([1.0, 1.0, 1.0, 0.4], alpha);
        let object = scene.add_mesh(&model(&wall, material, true), 1).expect("added");
        scene.spawn(object, Placement::at([0.0, 0.0, z])).expect("room");
        object.number()
    };
    let behind = plane(Alpha::Opaque, &mut scene, -2.0);
    plane(Alpha::Mask(0.5), &mut scene, 0.0);
    let before = plane(Alpha::Mask(0.3), &mut scene, -1.0);
    let dithered = plane(Alpha::Dithered, &mut scene, 1.0);
    let mut view = scene.view(Quality::default()).expect("a view");
    view.set(camera()).expect("a camera");
    let raw = Raw::new(&gpu, TargetFormat::surface(), SIZE);
    let renderer = raw.renderer(&gpu, &scene);
    raw.frame(&mut scene, &mut view, &renderer, &[Layer::Surface]);
    let ids = raw.words(&gpu, 2);
    let of = |object: u32| ids.iter().filter(|id| id[0] == object).count();
    let drawn = ids.iter().filter(|id| id[0] != 0).count();
    assert_eq!((of(behind), of(before) + of(dithered)), (0, drawn));
    // A pattern of 0.4 of the pixels.
    let part = of(dithered) as f64 / drawn as f64;
    assert!((0.35..0.45).contains(&part), "{part} of {drawn} pixels");
}

/// Terrain lies where the ground is; a character's numbers are its own.
#[test]
fn terrain_and_characters_have_places_and_numbers() {
    let gpu = device();
    let mut world = World::new(&gpu, 6);
    let mut view = world.view(0.0);
    view.set(crate::world::camera(SIZE)).expect("a camera");
    let raw = Raw::new(&gpu, TargetFormat::measure(), SIZE);
    let renderer = raw.renderer(&gpu, &world.scene);
    raw.frame(&mut world.scene, &mut view, &renderer, &[Layer::Measure]);
    let (positions, ids) = (raw.floats(&gpu, 0), raw.words(&gpu, 1));
    let patches = world.scene.instances(world.land).expect("terrain");
    let (mut on_ground, mut worst) = (0, 0.0_f64);
    let mut crowd = std::collections::BTreeSet::new();
    for (position, id) in positions.iter().zip(&ids) {
        let [x, y, z, _] = position.map(f64::from);
        if id[0] == world.land.number() {
            assert!((id[1] as usize) < patches.len());
            let Some(ground) = world.scene.ground(world.land, x, z).expect("terrain") else { continue };
            worst = worst.max((ground.height - y).abs());
            on_ground += 1;
        } else if id[0] == world.creature.number() {
            crowd.insert(id[1]);
            let near = world.crowd.iter().find(|instance| instance.number() == id[1]).expect("one of them");
            let place = world.scene.placement(*near).expect("there").world();
            assert!((place - DVec3::new(x, y, z)).length() < 12.0, "{place} {position:?}");
        }
    }
    println!("{on_ground} pixels of ground, off by {worst}; {} characters", crowd.len());
    // Positions are interpolated: at cliffs an error of 1e-5 east is ten times that in height.
    assert!(on_ground > 1000 && worst < 1e-3, "{on_ground} pixels, off by {worst}");
    assert!(crowd.len() >= 4, "{crowd:?}");
}

/// A relief that is level and half as deep as it may be lies that far behind its polygon.
#[test]
fn reliefs_are_where_their_rays_end() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let heights = HeightMap::new(8, 8, vec![0.5; 64]).expect("a map");
    let color = image::RgbaImage::from_pixel(4, 4, image::Rgba([255, 255, 255, 255]));
    let mut relief = Relief::wall(2.0, heights, color);
    relief.material.scale = 0.2;
    let wall = scene.add_relief(&relief, 1).expect("added");
    let placement = Placement::at([0.0, 0.5, 0.0]).turned(0.3).scaled(6.0);
    scene.spawn(wall, placement).expect("room");
    let mut view = scene.view(Quality::default()).expect("a view");
    view.set(camera()).expect("a camera");
    let raw = Raw::new(&gpu, TargetFormat::measure(), SIZE);
    let renderer = raw.renderer(&gpu, &scene);
    raw.frame(&mut scene, &mut view, &renderer, &[Layer::Depth, Layer::Measure]);
    let positions = raw.floats(&gpu, 0);
    let back = matrix(&placement).inverse();
    // Two tiles along an edge: a unit of uv is half an edge.
    let depth = 0.5 * 0.2 * 0.5;
    let (mut seen, mut worst) = (0, 0.0_f64);
    for position in positions.iter().filter(|position| position[3] == 1.0) {
        let [x, y, z, _] = position.map(f64::from);
        worst = worst.max((back.transform_point3(DVec3::new(x, y, z)).z + depth).abs());
        seen += 1;
    }
    println!("{seen} pixels, off by {worst}");
    assert!(seen > 1000 && worst < 1e-4, "{seen} pixels, off by {worst}");
}

/// What a target does not hold is refused by field, as are more bytes than the device allows.
#[test]
fn targets_hold_their_own_layers() {
    let gpu = device();
    let (mut scene, mut view, ..) = cubes(&gpu);
    let raw = Raw::new(&gpu, TargetFormat::measure(), SIZE);
    let renderer = raw.renderer(&gpu, &scene);
    let mut encoder = gpu.encoder("refused");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    let mut refused = Vec::new();
    raw.pass(&mut encoder, |pass| {
        for layer in [Layer::Color, Layer::Surface] {
            refused.push(renderer.draw(pass, &scene, &view, layer).expect_err("refused").path);
        }
    });
    assert_eq!(refused, ["layer", "layer"]);
    gpu.queue().submit([encoder.finish()]);
    let wide = TargetFormat::measure()
        .with_color(Some(wgpu::TextureFormat::Rgba8Unorm.into()))
        .with_color(Some(wgpu::TextureFormat::R8Unorm.into()));
    let error = Renderer::new(&gpu, &wide).expect_err("33 bytes").to_string();
    assert!(error.contains("format.color") && error.contains("33"), "{error}");
    let holes = TargetFormat { attachments: Attachments::Surface, ..TargetFormat::measure() };
    assert!(Renderer::new(&gpu, &holes).expect_err("refused").to_string().contains("format.color[1].format"));
}
