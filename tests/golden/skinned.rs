//! Skinned meshes: a bent and a twisted limb at three fades, linear beside dual quaternions.

use glam::{Mat4, Vec3, camera};
use image::RgbaImage;
use relievo::asset::transform::Affine;
use relievo::asset::{Bone, Influence, Influences, Mesh, Model, Skeleton, Skin, Transform};
use relievo::gpu::Buffer;
use relievo::ops::animation::ModelMatrices;
use relievo::ops::skinning::frame::{SkinFrame, SkinOptions};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::still;
use relievo::ops::skinning::vertex::Blend;
use relievo::scene::{Placement, Quality, Scene};

use crate::harness::{Tolerance, check_golden, gpu};
use crate::stage::{self, checkered};

/// Number of rings of vertices of the limb.
const RINGS: usize = 41;

/// Number of quads around the limb.
const SIDES: usize = 24;

fn corner(ring: usize, side: usize) -> u32 {
    (ring * (SIDES + 1) + side) as u32
}

/// Two triangles of the limb that form a quad.
fn quad(ring: usize, side: usize) -> [u32; 6] {
    let [a, b] = [corner(ring, side), corner(ring, side + 1)];
    let [c, d] = [corner(ring + 1, side + 1), corner(ring + 1, side)];
    [a, b, d, b, c, d]
}

/// A limb along X around two bones that share the vertices in its middle.
fn limb() -> Model {
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
    let rings = (0..RINGS - 1).flat_map(|ring| (0..SIDES).flat_map(move |side| quad(ring, side)));
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
        ..Mesh::default()
    };
    let (clips, motion, materials, images) = (vec![], None, vec![], vec![]);
    Model { skeleton, skins: vec![skin], clips, motion, meshes: vec![mesh], skinned: 1, materials, images }
}

fn rows(matrix: Mat4) -> Affine {
    let [x, y, z, _] = matrix.transpose().to_cols_array_2d();
    [x, y, z]
}

/// Six limbs in one picture: from left to right λ = 0, ½ and 1; above linear, below dual quaternions. The skinning operation
/// computes them, and a scene draws them as they stand.
fn limbs(lower: Mat4) -> RgbaImage {
    let (gpu, model) = (gpu(), checkered(limb()));
    let size = [192, 112];
    let mut all = RgbaImage::new(size[0], 2 * size[1] / 2);
    for (row, blend) in (0..).zip([Blend::Linear, Blend::DualQuaternion]) {
        let pose = [rows(Mat4::IDENTITY), rows(lower)];
        let models = Buffer::from_slice(&gpu, "model matrices", &pose.repeat(3)).expect("uploaded");
        let matrices = ModelMatrices::new(&models);
        let options = SkinOptions { mesh: 0, instances: 3, blend };
        let frame = SkinFrame::new(&gpu, &model, &matrices, options).expect("prepared");
        let fades = [0.0, 0.5, 1.0].map(|fade| InstanceLod::fade(fade).expect("in range"));
        frame.crowd.instance_lods.write(&gpu, &fades).expect("written");
        gpu.run("skin", |encoder| frame.record_updated_bones(encoder)).expect("run");
        let mut scene = Scene::new(&gpu).expect("compiled");
        for (at, x) in [-2.2, 0.0, 2.2].into_iter().enumerate() {
            let vertices = frame.read(&gpu, at).expect("read");
            let standing = still(&model, &[vertices]).expect("as many");
            let object = scene.add_mesh(&standing, 1).expect("added");
            scene.spawn(object, Placement::at([x, 0.0, 0.0])).expect("room");
        }
        let look =
            camera::rh::view::look_at_mat4(Vec3::new(0.0, 1.2, 6.0), Vec3::new(0.0, 0.1, 0.0), Vec3::Y);
        let aspect = 2.0 * size[0] as f32 / size[1] as f32;
        let projection = camera::rh::proj::directx::perspective(0.33, aspect, 1.0, 20.0);
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        view.set(stage::camera(look, projection, [size[0], size[1] / 2])).expect("a camera");
        let half = stage::picture(&gpu, &mut scene, &mut view);
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
