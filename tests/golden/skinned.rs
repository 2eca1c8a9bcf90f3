//! Skinned meshes: a bent and a twisted limb at three fades, linear beside dual quaternions; a crowd near and far.

use glam::{Mat4, Vec3, camera};
use image::{Rgba, RgbaImage};
use relievo::animation::ModelMatrices;
use relievo::animation::local_to_model::reference::local_to_model;
use relievo::animation::sample::reference::sample;
use relievo::asset::Light;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::asset::{Bone, Influence, Influences, Mesh, Model, Skeleton, Skin, Transform};
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::LINEAR_FORMAT;
use relievo::render::{Albedo, ColorTexture, SkinnedInstances, SkinnedRenderer, SkinnedScene, Target};
use relievo::samples::creature;
use relievo::skinning::bounding_sphere::BoundingSphere;
use relievo::skinning::frame::SkinFrame;
use relievo::skinning::instance_lod::{FadeRange, InstanceLod};
use relievo::skinning::lod::{LevelRanges, LodBuffers, LodPass, LodView, placed};
use relievo::skinning::vertex::Blend;
use relievo::surface::linear_image::LinearImage;
use relievo::surface::mips::Mips;

use crate::harness::{Tolerance, check_golden, gpu};

pub const SKY: [f64; 3] = [0.02, 0.025, 0.03];

/// A checkerboard of two colours.
pub fn checks(gpu: &Gpu) -> Albedo {
    let square = |x: u32, y: u32| {
        if (x / 16 + y / 16).is_multiple_of(2) { [214, 150, 104, 255] } else { [150, 82, 52, 255] }
    };
    let image = RgbaImage::from_fn(64, 64, |x, y| Rgba(square(x, y)));
    ColorTexture::linear(gpu, &Mips::of_color(image), true).expect("uploaded").into()
}

/// Number of rings of vertices of the limb.
pub const RINGS: usize = 41;

/// Number of quads around the limb.
pub const SIDES: usize = 24;

fn corner(ring: usize, side: usize) -> u32 {
    (ring * (SIDES + 1) + side) as u32
}

/// Two triangles of the limb that form a quad, `step` rings and sides wide.
pub fn quad(ring: usize, side: usize, step: usize) -> [u32; 6] {
    let [a, b] = [corner(ring, side), corner(ring, side + step)];
    let [c, d] = [corner(ring + step, side + step), corner(ring + step, side)];
    [a, b, d, b, c, d]
}

/// A limb along X around two bones that share the vertices in its middle.
pub fn limb() -> Model {
    let bone = |name: &str, parent| Bone { name: name.to_owned(), parent, rest: Transform::IDENTITY };
    let skeleton = Skeleton::of_joints(vec![bone("upper", None), bone("lower", Some(0))]).expect("valid");
    let identity = Mat4::IDENTITY.to_cols_array();
    let skin = Skin { name: "limb".to_owned(), bones: vec![0, 1], inverse_binds: vec![identity; 2] };
    let (mut positions, mut normals, mut uv, mut follows) = (vec![], vec![], vec![], vec![]);
    for (ring, side) in (0..RINGS).flat_map(|ring| (0..=SIDES).map(move |side| (ring, side))) {
        let along = 2.0 * ring as f32 / (RINGS - 1) as f32 - 1.0;
        let angle = std::f32::consts::TAU * side as f32 / SIDES as f32;
        let around = Vec3::new(0.0, libm::cosf(angle), libm::sinf(angle));
        positions.push((around * 0.28 + Vec3::X * along).to_array());
        normals.push(around.to_array());
        uv.push([along, side as f32 / SIDES as f32]);
        let fraction = (along / 0.8 + 0.5).clamp(0.0, 1.0);
        let fraction = fraction * fraction * (3.0 - 2.0 * fraction);
        follows.push(vec![
            Influence { bone: 0, weight: 1.0 - fraction },
            Influence { bone: 1, weight: fraction },
        ]);
    }
    let rings = (0..RINGS - 1).flat_map(|ring| (0..SIDES).flat_map(move |side| quad(ring, side, 1)));
    let mesh = Mesh {
        name: "limb".to_owned(),
        skin: 0,
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; positions.len()],
        indices: rings.collect(),
        // Its ends are open.
        double_sided: true,
        material: None,
        influences: Influences::new("limb", 2, follows).expect("valid"),
        positions,
        normals,
        uv,
        targets: vec![],
        weights: vec![],
        weight_keys: vec![],
        levels: vec![],
    };
    let (clips, materials, images) = (vec![], vec![], vec![]);
    Model { skeleton, skins: vec![skin], clips, meshes: vec![mesh], skinned: 1, materials, images }
}

pub fn rows(matrix: Mat4) -> Affine {
    let [x, y, z, _] = matrix.transpose().to_cols_array_2d();
    [x, y, z]
}

fn draw(gpu: &Gpu, scene: &mut SkinnedScene, clip_from_world: Mat4, size: [u32; 2]) -> RgbaImage {
    let size = size.map(|edge| 2 * edge);
    let target = Target::linear(gpu, size).expect("allocated");
    scene.set_camera(gpu, clip_from_world).expect("set");
    target.draw(gpu, SKY, |pass| scene.draw(pass)).expect("drawn");
    LinearImage { size, pixels: target.read_linear(gpu).expect("read") }.reduced(2).encoded()
}

/// Six limbs in one picture: from left to right λ = 0, ½ and 1; above linear, below dual quaternions.
fn limbs(lower: Mat4) -> RgbaImage {
    let (gpu, model) = (gpu(), limb());
    let size = [192, 112];
    let mut all = RgbaImage::new(size[0], 2 * size[1] / 2);
    for (row, blend) in (0..).zip([Blend::Linear, Blend::DualQuaternion]) {
        let pose = [rows(Mat4::IDENTITY), rows(lower)];
        let models = Buffer::from_slice(&gpu, "model matrices", &pose.repeat(3)).expect("uploaded");
        let matrices = ModelMatrices::new(&models);
        let frame = SkinFrame::new(&gpu, &model, 0, &matrices, 3, blend).expect("prepared");
        let fades = [0.0, 0.5, 1.0].map(|fade| InstanceLod::fade(fade).expect("in range"));
        frame.crowd.instance_lods.write(&gpu, &fades).expect("written");
        gpu.run("skin", |encoder| frame.record_all(encoder)).expect("run");
        let places = [-2.2, 0.0, 2.2].map(|x| placed(Vec3::X * x, 0.0, 1.0));
        let instances = SkinnedInstances {
            mesh: &frame.mesh,
            skinned: &frame.skinned,
            placements: &Buffer::from_slice(&gpu, "placements", &places).expect("uploaded"),
            drawn: &Buffer::from_slice(&gpu, "drawn", &[0, 1, 2]).expect("uploaded"),
            albedo: &checks(&gpu),
            light: Light::default(),
        };
        let mut scene = SkinnedRenderer::new(&gpu, LINEAR_FORMAT)
            .expect("compiled")
            .scene(&gpu, &instances)
            .expect("bound");
        let view =
            camera::rh::view::look_at_mat4(Vec3::new(0.0, 1.2, 6.0), Vec3::new(0.0, 0.1, 0.0), Vec3::Y);
        let aspect = 2.0 * size[0] as f32 / size[1] as f32;
        let clip = camera::rh::proj::directx::perspective(0.33, aspect, 1.0, 20.0) * view;
        let half = draw(&gpu, &mut scene, clip, [size[0], size[1] / 2]);
        image::imageops::replace(&mut all, &half, 0, i64::from(row * size[1] / 2));
    }
    all
}

fn check(name: &str, actual: &RgbaImage) {
    if let Err(error) = check_golden(name, actual, Tolerance::IMAGE) {
        panic!("{error}");
    }
}

#[test]
fn a_bent_limb() {
    check("skin_bend", &limbs(Mat4::from_axis_angle(Vec3::Z, 1.5)));
}

#[test]
fn a_twisted_limb() {
    check("skin_twist", &limbs(Mat4::from_axis_angle(Vec3::X, 2.8)));
}

/// Creatures in a row away from the eye, and some behind it: what is seen, how far it fades, which clusters are skinned,
/// and the draw are all decided on the device.
#[test]
fn a_crowd_near_and_far() {
    let (gpu, model) = (gpu(), creature().expect("valid"));
    let walk = model.clip("walk").expect("there");
    let place = |index: usize| {
        let (row, column) = (index / 6, index % 6);
        // The first row is behind the eye.
        let z = [9.0, 3.0, 0.0, -5.0, -12.0, -22.0][row];
        let at = Vec3::new(column as f32 * 1.5 - 3.75 + 0.3 * row as f32, 0.0, z);
        placed(at, 0.5 * index as f32, 1.0)
    };
    let places: Vec<Affine> = (0..36).map(place).collect();
    let pose = |index: usize| {
        let time = (index as f32 * 0.618).fract() * walk.duration();
        local_to_model(&model.skeleton, &sample(walk, time, RotationPath::Slerp))
    };
    let models: Vec<Affine> = (0..36).flat_map(pose).collect();
    let models = Buffer::from_slice(&gpu, "model matrices", &models).expect("uploaded");
    let matrices = ModelMatrices::new(&models);
    let skin = SkinFrame::new(&gpu, &model, 0, &matrices, 36, Blend::Linear).expect("prepared");
    let placements = Buffer::from_slice(&gpu, "placements", &places).expect("uploaded");
    let drawn = Buffer::new(&gpu, "drawn", 36).expect("allocated");
    let instances = SkinnedInstances {
        mesh: &skin.mesh,
        skinned: &skin.skinned,
        placements: &placements,
        drawn: &drawn,
        albedo: &checks(&gpu),
        light: Light::default(),
    };
    let renderer = SkinnedRenderer::new(&gpu, LINEAR_FORMAT).expect("compiled");
    let mut scene = renderer.scene(&gpu, &instances).expect("bound");
    let size = [176, 112];
    let eye = Vec3::new(-1.0, 2.6, 7.0);
    let look = camera::rh::view::look_at_mat4(eye, Vec3::new(0.5, 0.4, -4.0), Vec3::Y);
    let clip_from_world = camera::rh::proj::directx::perspective(0.75, 176.0 / 112.0, 0.2, 100.0) * look;
    let BoundingSphere { center, radius } =
        BoundingSphere::around(model.meshes[0].positions.iter().map(|position| Vec3::from(*position)));
    let view = LodView {
        clip_from_world,
        eye,
        fade_range: FadeRange { start: 5.0, end: 30.0 },
        steps: 64,
        max_influences: 8,
        center,
        radius,
        levels: LevelRanges::NONE,
    };
    let buffers = LodBuffers {
        placements: &placements,
        instance_lods: &skin.crowd.instance_lods,
        drawn: &drawn,
        arguments: &scene.arguments,
    };
    let lod = LodPass::new(&gpu).expect("compiled").prepare(&gpu, &view, buffers).expect("prepared");
    let frame = || {
        gpu.run("frame", |encoder| {
            lod.record(encoder);
            skin.record_updated_bones(encoder);
        })
        .expect("run");
        skin.active.dispatched.read_blocking(&gpu).expect("read")[3] as usize
    };
    // The first frame skins all that is seen; the second nothing, because nothing moves.
    let skinned = frame();
    let seen = scene.arguments.read_blocking(&gpu).expect("read")[1] as usize;
    assert!((12..34).contains(&seen), "{seen} of 36");
    assert_eq!(skinned, seen * skin.clusters.len());
    assert_eq!(frame(), 0);
    // One bone of one instance moves: the clusters that follow it are skinned.
    let mut moved = vec![0; 36 * skin.mesh.mask_words];
    moved[14 * skin.mesh.mask_words] = 1 << 4;
    skin.select.updated_bones.write(&gpu, &moved).expect("written");
    assert!((1..20).contains(&frame()));
    check("skin_crowd", &draw(&gpu, &mut scene, clip_from_world, size));
}
