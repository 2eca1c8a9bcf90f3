//! A scene whose fields move and go away shows what a fresh one with the same fields shows.

use glam::Vec3;
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::render::target::COLOR_FORMAT;
use relievo::render::{Camera, FieldsId, Materials, Style, Target, TerrainRenderer, TerrainScene};
use relievo::terrain::blend::Shading;
use relievo::terrain::config::Config;
use relievo::terrain::fields::Fields;
use relievo::terrain::generator::Generator;
use relievo::terrain::recipe::Recipe;
use relievo::terrain::texture::Texture;

use crate::harness::gpu;

const HERE: [i32; 2] = [4, -2];
const SKY: [f64; 3] = [1.0, 0.0, 1.0];

struct Stage {
    gpu: Gpu,
    config: Config,
    scene: TerrainScene,
}

impl Stage {
    fn new() -> Self {
        let (gpu, config) = (gpu(), Config::new(17, 3.0, "scene").expect("valid"));
        let textures = Texture::of_zones(&config.zones).expect("built in");
        let materials = Materials::new(&gpu, &config.zones, &textures).expect("uploaded");
        let renderer = TerrainRenderer::new(&gpu, COLOR_FORMAT, Style::Textured).expect("compiled");
        let scene = renderer.scene(&gpu, &materials, &Shading::default()).expect("bound");
        Self { gpu, config, scene }
    }

    fn fields(&self, patches: &[[i32; 2]]) -> Fields {
        let generator = Generator::new(&self.gpu, Recipe::new(self.config.clone())).expect("valid");
        generator.generate(&self.gpu, patches, 1, &mut |_| ()).expect("generated").remove(0)
    }

    fn add(&mut self, patches: &[[i32; 2]], origin: [i32; 2]) -> FieldsId {
        let fields = self.fields(patches);
        self.scene.add(&self.gpu, &self.config, &fields, patches, origin).expect("added")
    }

    fn image(&mut self) -> RgbaImage {
        let target = Target::new(&self.gpu, [96, 72]).expect("allocated");
        let eye = Vec3::new(8.0, 40.0, 60.0);
        let camera =
            Camera { eye, target: Vec3::new(16.0, 0.0, 8.0), field_of_view: 0.9, near: 1.0, far: 200.0 };
        self.scene.set_camera(&self.gpu, &camera, target.aspect()).expect("a camera");
        target.draw(&self.gpu, SKY, |pass| self.scene.draw(pass)).expect("drawn");
        target.read(&self.gpu).expect("read")
    }
}

#[test]
fn moved_fields_look_as_if_added_there() {
    let mut moved = Stage::new();
    let id = moved.add(&[HERE, [5, -2]], [5, -2]);
    let before = moved.image();
    moved.scene.set_places(&moved.gpu, id, &[HERE, [5, -2]], HERE).expect("moved");
    let mut fresh = Stage::new();
    fresh.add(&[HERE, [5, -2]], HERE);
    let after = moved.image();
    assert!(after == fresh.image(), "the origin moved, so every patch did");
    assert!(before != after);
    // Fewer patches than fields, then all of them again.
    moved.scene.set_places(&moved.gpu, id, &[HERE], HERE).expect("moved");
    let mut fewer = Stage::new();
    fewer.add(&[HERE], HERE);
    assert!(moved.image() == fewer.image());
    moved.scene.set_places(&moved.gpu, id, &[HERE, [5, -2]], HERE).expect("moved");
    assert!(moved.image() == after);
}

#[test]
fn removed_fields_are_gone() {
    let mut stage = Stage::new();
    let first = stage.add(&[HERE], HERE);
    let alone = stage.image();
    let second = stage.add(&[[5, -2]], HERE);
    assert!(stage.image() != alone);
    assert!(stage.scene.remove(second) && !stage.scene.remove(second));
    assert!(stage.image() == alone);
    let third = stage.add(&[[5, -2]], HERE);
    assert!(third != second, "a name is used once");
    assert!(stage.scene.remove(first));
    stage.scene.clear();
    assert!(stage.image().pixels().all(|pixel| pixel.0 == [255, 0, 255, 255]));
    assert!(!stage.scene.remove(third));
}

#[test]
fn places_that_cannot_be_drawn_are_refused_and_change_nothing() {
    let mut stage = Stage::new();
    let id = stage.add(&[HERE], HERE);
    let before = stage.image();
    let gone = stage.add(&[[9, 9]], HERE);
    stage.scene.remove(gone);
    for (id, patches, words) in [
        (id, &[HERE, HERE][..], "patches.len = 2: must be at most 1"),
        (id, &[[HERE[0] + (1 << 20), 0]], "2^24"),
        (gone, &[HERE], "fields = 1: must be fields of this scene"),
    ] {
        let error = stage.scene.set_places(&stage.gpu, id, patches, HERE).expect_err("refused").to_string();
        assert!(error.contains(words), "{error}");
    }
    assert!(stage.image() == before);
    let flat = Fields::new(&stage.gpu, "no margin", 17, 1).expect("allocated");
    let error = stage.scene.add(&stage.gpu, &stage.config, &flat, &[HERE], HERE).expect_err("no margin");
    assert!(error.to_string().contains("fields.width = 17"), "{error}");
}
