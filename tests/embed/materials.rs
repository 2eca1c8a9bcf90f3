//! Materials that change in any frame.

use glam::Vec3;
use image::{Rgba, RgbaImage};
use relievo::asset::influences::{Influence, Influences};
use relievo::asset::material::{Alpha, Filter, Sampling, Texture};
use relievo::asset::{Material, Mesh, Model};
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer};
use relievo::scene::{Camera, ObjectId, Placement, Quality, Scene, View};
use relievo_samples::creature;

use crate::frame::{Frame, device, devices};
use crate::world::{SIZE, World};

/// A square that faces +Z, beside the middle.
fn square(material: usize, x: f32) -> Mesh {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let whole = |_| vec![Influence { bone: 0, weight: 1.0 }];
    Mesh {
        name: format!("square {material}"),
        skin: 0,
        positions: corners.map(|[u, v]| [x + u, v, 0.0]).to_vec(),
        normals: vec![[0.0, 0.0, 1.0]; 4],
        tangents: vec![[1.0, 0.0, 0.0, -1.0]; 4],
        uv: corners.map(|[u, v]| [u, -v]).to_vec(),
        indices: vec![0, 1, 2, 0, 2, 3],
        double_sided: false,
        material: Some(material),
        influences: Influences::new("square", 64, (0..4).map(whole)).expect("valid"),
        targets: Vec::new(),
        weights: Vec::new(),
        weight_keys: Vec::new(),
        ..Mesh::default()
    }
}

/// An image of two texels.
fn image([a, b]: [[u8; 4]; 2]) -> RgbaImage {
    RgbaImage::from_fn(2, 1, |x, _| Rgba(if x == 0 { a } else { b }))
}

/// A texture with linear filters and without mip levels.
fn texture(image: usize) -> Option<Texture> {
    Some(Texture { image, sampling: Sampling { mips: None, ..Sampling::default() } })
}

fn material(name: &str, texture: Option<Texture>) -> Material {
    Material {
        name: name.to_owned(),
        color: [1.0; 4],
        texture,
        normal: None,
        normal_scale: 1.0,
        alpha: Alpha::Opaque,
        pbr: Default::default(),
    }
}

/// Two squares with materials of their own, one with a texture, and three images, of which one is used.
fn model(moves: bool) -> Model {
    let mut model = creature().expect("valid");
    if !moves {
        model.clips.clear();
    }
    model.meshes = vec![square(0, -1.1), square(1, 1.1)];
    model.skinned = 2;
    model.materials = vec![material("left", texture(0)), material("right", None)];
    model.images = vec![
        image([[200, 60, 30, 255], [30, 60, 200, 40]]).into(),
        image([[10, 250, 120, 255], [250, 250, 20, 255]]).into(),
        image([[128, 128, 255, 255], [220, 128, 210, 255]]).into(),
    ];
    model
}

struct Stage {
    scene: Scene,
    object: ObjectId,
    view: View,
    frame: Frame,
    renderer: Renderer,
}

impl Stage {
    fn new(gpu: &Gpu, model: &Model) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let object = scene.add_character(model, 2).expect("added");
        scene.spawn(object, Placement::at([0.0, 0.0, 0.0])).expect("room");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        let eye = Camera::looking_at(Vec3::new(0.3, 0.2, 5.0), Vec3::ZERO, 0.8, [0.5, 20.0], SIZE);
        view.set(eye).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        Self { scene, object, view, frame, renderer }
    }

    fn shot(&mut self) -> RgbaImage {
        self.frame.shot(&mut self.scene, &mut self.view, &self.renderer)
    }

    fn refused(&mut self, material: &str, new: &Material) -> String {
        self.scene.set_material(self.object, material, new).expect_err("refused").to_string()
    }
}

/// After a change the picture is that of a scene that was made with the new materials, for objects that move and for those
/// that do not.
#[test]
fn a_changed_material_is_as_if_it_had_always_been() {
    let gpu = device();
    for moves in [false, true] {
        let mut now = model(moves);
        let mut stage = Stage::new(&gpu, &now);
        let mut last = stage.shot();
        let left = material("left", texture(0));
        let right = material("right", None);
        let changes = [
            ("a colour", 1, Material { color: [0.9, 0.2, 0.1, 1.0], ..right.clone() }),
            ("a texture of the part", 1, Material { texture: texture(0), ..right.clone() }),
            ("a texture that is new to the part", 0, Material { texture: texture(1), ..left.clone() }),
            ("cut out", 1, Material { texture: texture(0), alpha: Alpha::Mask(0.5), ..right.clone() }),
            ("another cutoff", 1, Material { texture: texture(0), alpha: Alpha::Mask(0.9), ..right.clone() }),
            ("a normal map", 0, Material { normal: texture(2), texture: None, ..left.clone() }),
            (
                "the scale of a normal map",
                0,
                Material { normal: texture(2), normal_scale: 3.0, ..left.clone() },
            ),
            ("plain again", 0, left.clone()),
            ("opaque again", 1, right.clone()),
        ];
        for (name, index, new) in changes {
            let which = if index == 0 { "left" } else { "1" };
            stage.scene.set_material(stage.object, which, &new).expect("changed");
            assert_eq!(stage.scene.material(stage.object, which).expect("there"), &new);
            now.materials[index] = new;
            stage.renderer.prepare(&stage.scene).expect("compiled");
            let picture = stage.shot();
            let expected = Stage::new(&gpu, &now).shot();
            assert!(picture == expected, "{name}: another picture than a new scene");
            assert!(picture != last, "{name}: the same picture as before");
            last = picture;
        }
    }
}

/// Images are replaced wherever they are used, and added.
#[test]
fn images_are_replaced_and_added() {
    let gpu = device();
    let mut now = model(false);
    let mut stage = Stage::new(&gpu, &now);
    let before = stage.shot();
    let large = RgbaImage::from_fn(8, 4, |x, y| Rgba([30 * x as u8, 60 * y as u8, 90, 255]));
    stage.scene.set_image(stage.object, 0, large.clone()).expect("replaced");
    now.images[0] = large.clone().into();
    let replaced = stage.shot();
    assert!(replaced != before && replaced == Stage::new(&gpu, &now).shot(), "another picture");
    stage.scene.set_image(stage.object, 3, image([[255; 4], [90, 9, 9, 255]])).expect("added");
    let new = material("right", texture(3));
    stage.scene.set_material(stage.object, "right", &new).expect("changed");
    now.images.push(image([[255; 4], [90, 9, 9, 255]]).into());
    now.materials[1] = new;
    let added = stage.shot();
    assert!(added != replaced && added == Stage::new(&gpu, &now).shot(), "another picture");
    let path = [(9, large), (0, RgbaImage::new(0, 3))].map(|(index, image)| {
        stage.scene.set_image(stage.object, index, image).expect_err("refused").to_string()
    });
    assert!(path[0].starts_with("index = 9") && path[1].starts_with("image = 0 × 3"), "{path:?}");
}

/// Images stay what they were when a lost device refuses another one, and the next device draws them.
#[test]
fn a_refused_image_changes_nothing() {
    let [lost, second] = devices();
    lost.device().on_uncaptured_error(std::sync::Arc::new(|_| ()));
    let stage = Stage::new(&lost, &model(false));
    lost.device().destroy();
    let Stage { mut scene, object, mut view, .. } = stage;
    let other = image([[9, 250, 9, 255]; 2]);
    let told = scene.set_image(object, 0, other).expect_err("lost").to_string();
    assert!(told.contains("lost"), "{told}");
    scene.rebuild(&second).expect("a device");
    view.rebuild(&scene).expect("a device");
    let frame = Frame::plain(&second, SIZE);
    let renderer = frame.renderer(&second, &scene);
    let mut stage = Stage { scene, object, view, frame, renderer };
    assert!(stage.shot() == Stage::new(&second, &model(false)).shot(), "another picture");
}

/// What was recorded keeps its colours, and a pipeline that is missing is told.
#[test]
fn changes_come_with_the_next_frame_and_with_their_pipelines() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, &model(false));
    let before = stage.shot();
    let mut encoder = gpu.encoder("frame");
    stage.scene.record(&mut encoder, &mut [&mut stage.view]).expect("recorded");
    let dark = Material { color: [0.1, 0.1, 0.1, 1.0], ..material("right", None) };
    stage.scene.set_material(stage.object, "right", &dark).expect("changed");
    stage.frame.pass(&mut encoder, |pass| {
        stage.renderer.draw(pass, &stage.scene, &stage.view, Layer::Color).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    assert!(stage.frame.read(&gpu) == before, "a frame that was recorded has changed");
    assert!(stage.shot() != before, "the next frame has not");
    let cut = Material { alpha: Alpha::Mask(0.5), ..dark };
    stage.scene.set_material(stage.object, "right", &cut).expect("changed");
    let mut encoder = gpu.encoder("frame");
    stage.scene.record(&mut encoder, &mut [&mut stage.view]).expect("recorded");
    let mut drawn = Ok(());
    stage.frame.pass(&mut encoder, |pass| {
        drawn = stage.renderer.draw(pass, &stage.scene, &stage.view, Layer::Color);
    });
    let refused = drawn.expect_err("refused").to_string();
    let has_advice = refused.contains("Renderer::prepare") && refused.contains("Scene::set_material");
    assert!(
        refused.starts_with("scene = object 1 (ObjectId::number), not compiled") && has_advice,
        "{refused}"
    );
}

/// Mistakes are told by field, and change nothing.
#[test]
fn mistakes_change_nothing() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, &model(false));
    let before = stage.shot();
    let right = material("right", None);
    let refused = stage.refused("front", &right);
    assert!(refused.starts_with("material = front") && refused.contains("\"left\", \"right\""), "{refused}");
    assert!(stage.refused("2", &right).starts_with("material = 2"));
    let pink = Material { color: [1.0, 1.5, 0.5, 1.0], ..right.clone() };
    assert!(stage.refused("right", &pink).starts_with("material.color[1] = 1.5"));
    let beyond = Material { normal: texture(7), ..right.clone() };
    assert!(stage.refused("right", &beyond).starts_with("material.normal.image = 7"));
    let endless = Material { normal_scale: f32::INFINITY, ..right.clone() };
    assert!(stage.refused("right", &endless).starts_with("material.normal_scale"));
    let nearest = Sampling { magnified: Filter::Nearest, mips: None, ..Sampling::default() };
    let other = Material { texture: Some(Texture { image: 1, sampling: nearest }), ..right };
    assert!(stage.refused("right", &other).starts_with("material.texture.sampling"));
    assert!(stage.shot() == before, "a mistake has changed the picture");
    let mut world = World::new(&gpu, 1);
    let refused = world.scene.set_material(world.land, "0", &other).expect_err("refused").to_string();
    assert!(refused.starts_with("object = terrain"), "{refused}");
    let gone = world.creature;
    world.scene.remove(gone).expect("there");
    assert!(world.scene.set_material(gone, "0", &other).expect_err("refused").to_string().contains("object"));
}

/// What [`Scene::set_material`] and [`Scene::set_image`] refuse, the scene refuses when a model is added, with its number.
#[test]
fn models_are_checked_when_they_are_added() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let mut refused = |change: &dyn Fn(&mut Model)| {
        let found = [false, true].map(|moves| {
            let mut model = model(moves);
            change(&mut model);
            scene.add_character(&model, 1).expect_err("refused").to_string()
        });
        assert_eq!(found[0], found[1], "a mesh and a character");
        let [found, _] = found;
        found
    };
    let most = "must be 1 to 8192 texels wide and high, the device's limit for textures";
    for (found, expected) in [
        (
            refused(&|model| model.materials[1].color[2] = 7.0),
            "model.materials[1].color[2] = 7: must be in 0..=1",
        ),
        (
            refused(&|model| model.materials[0].color[3] = f32::NAN),
            "model.materials[0].color[3] = NaN: must be in 0..=1",
        ),
        (
            refused(&|model| model.materials[0].alpha = Alpha::Mask(f32::INFINITY)),
            "model.materials[0].alpha = inf: must be finite",
        ),
        (
            refused(&|model| model.materials[0].normal_scale = f32::NAN),
            "model.materials[0].normal_scale = NaN: must be finite",
        ),
        (
            refused(&|model| model.materials[1].texture = texture(7)),
            "model.materials[1].texture.image = 7: must be below 3",
        ),
        (
            refused(&|model| model.meshes[1].indices[4] = 9),
            "model.meshes[1].indices[4] = 9: must be below 4, the number of vertices",
        ),
        (
            refused(&|model| model.meshes[1].material = Some(9)),
            "model.meshes[1].material = 9: must be below 2",
        ),
        (refused(&|model| model.skins[0].bones[3] = 999), "model.skins[0].bones[3] = 999: must be below 153"),
        (
            refused(&|model| model.images[0] = RgbaImage::new(9000, 2).into()),
            &format!("model.images[0] = 9000 × 2: {most}"),
        ),
    ] {
        assert_eq!(found, expected);
    }
    let mut stage = Stage::new(&gpu, &model(false));
    let before = stage.shot();
    let image = stage.scene.set_image(stage.object, 0, RgbaImage::new(2, 9000)).expect_err("refused");
    assert_eq!(image.to_string(), format!("image = 2 × 9000: {most}"));
    assert!(stage.shot() == before, "a mistake has changed the picture");
}

/// A normal map is filtered as it says, whatever the texture of the base colour says.
#[test]
fn normal_maps_have_their_own_filters() {
    let gpu = device();
    let shades = |filter: Filter| {
        let mut model = model(false);
        let sampling = Sampling { magnified: filter, minified: filter, mips: None, ..Sampling::default() };
        let normal = Some(Texture { image: 2, sampling });
        model.images[0] = image([[200, 200, 200, 255]; 2]).into();
        model.materials[0].normal = normal;
        model.meshes.truncate(1);
        model.skinned = 1;
        let picture = Stage::new(&gpu, &model).shot();
        let shades: std::collections::BTreeSet<_> = picture.pixels().map(|pixel| pixel.0).collect();
        shades.len()
    };
    // The sky and one shade for each texel, or all those between them.
    let (nearest, linear) = (shades(Filter::Nearest), shades(Filter::Linear));
    assert!(nearest <= 4 && linear > 8, "{nearest} shades with the nearest texel, {linear} between texels");
}
