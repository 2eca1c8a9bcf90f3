//! Mirrored placements and mirrored views: the outside stays the outside and is lit as such, single-sided and
//! double-sided, on the device as in the reference.

use glam::{Mat4, Vec3, camera};
use image::RgbaImage;
use relievo::animation::ModelMatrices;
use relievo::asset::Light;
use relievo::asset::Mesh;
use relievo::asset::Model;
use relievo::asset::transform::Affine;
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::LINEAR_FORMAT;
use relievo::render::{
    Albedo, Character, ColorTexture, CrowdScene, SkinnedInstances, SkinnedRenderer, Target,
};
use relievo::skinning::FadeRange;
use relievo::skinning::morph::reference::morph;
use relievo::skinning::palette::reference::palette_for;
use relievo::skinning::picture::texture::Surface;
use relievo::skinning::picture::{Part, Scene};
use relievo::skinning::skin::reference::{skin, transformed};
use relievo::skinning::{Blend, InstanceLod, Vertex};
use relievo::surface::linear_image::LinearImage;
use relievo::surface::mips::Mips;

use crate::harness::{Difference, Tolerance, gpu};
use crate::skinned::{SIDES, SKY, limb, rows};

const SIZE: [u32; 2] = [2 * 176, 2 * 112];
const CLAY: [u8; 3] = [214, 150, 104];

/// Four placements: unmirrored, mirrored, mirrored with non-uniform scale, and mirrored twice, which is a
/// rotation.
fn places() -> [Affine; 4] {
    let at = |x: f32, y: f32, scale: Vec3| {
        rows(
            Mat4::from_translation(Vec3::new(x, y, 0.0))
                * Mat4::from_rotation_y(0.4)
                * Mat4::from_scale(scale),
        )
    };
    [
        at(-1.3, 0.8, Vec3::ONE),
        at(1.3, 0.8, Vec3::new(1.0, 1.0, -1.0)),
        at(-1.3, -0.8, Vec3::new(-0.8, 1.2, 1.0)),
        at(1.3, -0.8, Vec3::new(-1.0, -1.0, 1.0)),
    ]
}

fn view() -> Mat4 {
    let look = camera::rh::view::look_at_mat4(Vec3::new(0.6, 1.5, 6.0), Vec3::ZERO, Vec3::Y);
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    camera::rh::proj::directx::perspective(0.7, aspect, 1.0, 20.0) * look
}

/// The bent limb, cut open along its length, so that it shows its inside.
fn posed(double_sided: bool) -> (Model, [Affine; 2]) {
    let mut model = limb();
    let mesh = &mut model.meshes[0];
    mesh.double_sided = double_sided;
    let quads = mesh.indices.chunks(6).enumerate();
    mesh.indices = quads.filter(|(at, _)| at % SIDES > 8).flat_map(|(_, quad)| quad.to_vec()).collect();
    (model, [rows(Mat4::IDENTITY), rows(Mat4::from_axis_angle(Vec3::Z, 0.9))])
}

/// The reference's picture of instances whose vertices are in the world already; the winding of mirrored ones
/// is reversed here.
fn reference(double_sided: bool, clip_from_world: Mat4) -> RgbaImage {
    let (model, bones) = posed(double_sided);
    let palette = palette_for(&model.skins[0], &bones, Blend::Linear);
    let mesh = &model.meshes[0];
    let skinned = skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL);
    let placed = places().map(|place| {
        let vertices: Vec<Vertex> = skinned.iter().map(|vertex| transformed(vertex, &place)).collect();
        let [x, y, z] = place.map(|row| Vec3::from_slice(&row));
        let mut mesh = Mesh::clone(mesh);
        if x.dot(y.cross(z)) < 0.0 {
            mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(0, 2));
        }
        (mesh, vertices)
    });
    let surface = Surface::plain(CLAY.map(relievo::srgb::linear));
    let parts: Vec<_> =
        placed.iter().map(|(mesh, vertices)| Part { mesh, level: 0, vertices, surface: &surface }).collect();
    let scene = Scene { clip_from_model: clip_from_world, light: Light::default(), size: SIZE };
    scene.draw(&parts, SKY.map(|light| light as f32)).reduced(2).encoded()
}

/// The device's picture, with a list of instances that it makes, or with one made by hand.
fn drawn(gpu: &Gpu, double_sided: bool, clip_from_world: Mat4, is_by_hand: bool) -> RgbaImage {
    let (model, bones) = posed(double_sided);
    let [r, g, b] = CLAY;
    let clay = Mips::of_color(RgbaImage::from_pixel(1, 1, image::Rgba([r, g, b, 255])));
    let clay: Albedo = ColorTexture::linear(gpu, &clay, true).expect("uploaded").into();
    let placements = &Buffer::from_slice(gpu, "placements", &places()).expect("uploaded");
    let character = Character {
        model: &model,
        matrices: &ModelMatrices::new(
            &Buffer::from_slice(gpu, "model matrices", &bones.repeat(4)).expect("uploaded"),
        ),
        placements,
        fade_range: FadeRange::NEVER,
        levels: &[],
        blend: Blend::Linear,
        albedos: std::slice::from_ref(&clay),
    };
    let mut crowd = CrowdScene::new(gpu, LINEAR_FORMAT, Light::default()).expect("compiled");
    crowd.add(gpu, &character).expect("prepared");
    crowd.set_camera(gpu, clip_from_world, Vec3::ZERO).expect("set");
    gpu.run("skin", |encoder| crowd.record(encoder)).expect("run");
    let target = Target::linear(gpu, SIZE).expect("allocated");
    if is_by_hand {
        let frame = &crowd.characters()[0].frames[0];
        let instances = SkinnedInstances {
            mesh: &frame.mesh,
            skinned: &frame.skinned,
            placements,
            drawn: &Buffer::from_slice(gpu, "drawn", &[2, 0, 3, 1]).expect("uploaded"),
            albedo: &clay,
            light: Light::default(),
        };
        let renderer = SkinnedRenderer::new(gpu, LINEAR_FORMAT).expect("compiled");
        let mut scene = renderer.scene(gpu, &instances).expect("bound");
        scene.set_camera(gpu, clip_from_world).expect("set");
        target.draw(gpu, SKY, |pass| scene.draw(pass)).expect("drawn");
    } else {
        target.draw(gpu, SKY, |pass| crowd.draw(pass)).expect("drawn");
    }
    LinearImage { size: SIZE, pixels: target.read_linear(gpu).expect("read") }.reduced(2).encoded()
}

#[test]
fn what_is_mirrored_is_seen_from_outside() {
    let gpu = gpu();
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    for double_sided in [false, true] {
        let plain = reference(double_sided, view());
        let reflected = reference(double_sided, mirror * view());
        let wrong = [
            ("plain", drawn(&gpu, double_sided, view(), false), &plain),
            ("plain, by hand", drawn(&gpu, double_sided, view(), true), &plain),
            ("mirrored", drawn(&gpu, double_sided, mirror * view(), false), &reflected),
            ("mirrored, by hand", drawn(&gpu, double_sided, mirror * view(), true), &reflected),
            // A mirrored instance in a mirrored view looks as the original does.
            ("reflected", image::imageops::flip_horizontal(&reflected), &plain),
        ]
        .map(|(name, found, wanted)| (name, Difference::of(&found, wanted, Tolerance::IMAGE.levels)));
        println!("both sides: {double_sided}: {wrong:?}");
        assert!(wrong.iter().all(|(_, difference)| difference.within(Tolerance::IMAGE)), "{wrong:?}");
    }
    // The two sides must differ, else the pictures show nothing.
    let sides = [false, true].map(|double_sided| reference(double_sided, view()));
    assert!(!Difference::of(&sides[0], &sides[1], Tolerance::IMAGE.levels).within(Tolerance::IMAGE));
}
