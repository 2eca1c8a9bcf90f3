//! Uploads that are spread over frames.

use glam::Vec3;
use image::{Rgba, RgbaImage};
use relievo::asset::material::{Sampling, Texture};
use relievo::asset::{Material, Model, Transform};
use relievo::gpu::Gpu;
use relievo::ops::surface::SurfaceMesh;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::Renderer;
use relievo::scene::{
    Camera, InstanceId, ObjectId, Placement, Play, Quality, Ray, Relief, Scene, TerrainSource, View,
};
use relievo_samples::maps::BuiltInMap;

use crate::frame::{Frame, device, devices};
use crate::solids::solid;
use crate::world::{SIZE, model};

/// Bytes of the longest row of any texture of these scenes.
const ROW: usize = 4 * 1024;

/// Bytes that a frame takes for cameras, times, and everything that was spawned.
const REST: usize = 40_000;

/// Ground, a wall with relief, a creature and a solid, added within one budget.
struct Stage {
    scene: Scene,
    view: View,
    frame: Frame,
    renderer: Renderer,
    objects: [ObjectId; 4],
    instances: [InstanceId; 3],
}

fn camera() -> Camera {
    Camera::looking_at(Vec3::new(3.0, 9.0, 14.0), Vec3::new(0.0, 3.0, 0.0), 0.9, [0.5, 400.0], SIZE)
}

/// The creature with a texture.
fn clothed() -> Model {
    let mut model = model();
    let image = RgbaImage::from_fn(64, 64, |x, y| Rgba([4 * x as u8, 4 * y as u8, 90, 255]));
    let texture = Some(Texture { image: 0, sampling: Sampling::default() });
    model.materials = vec![Material { texture, ..Material::opaque("skin", [1.0; 4]) }];
    model.images = vec![image.into()];
    model.meshes.iter_mut().for_each(|mesh| mesh.material = Some(0));
    model
}

impl Stage {
    fn new(gpu: &Gpu, budget: Option<usize>) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        scene.set_upload_budget(budget).expect("a number");
        let config = TerrainConfig::new(33, 3.0, "uploads").expect("valid");
        let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&[[0, 0], [-1, -1]]));
        let bricks = BuiltInMap::Bricks;
        let (heights, colors) = (bricks.height_map(64).expect("a map"), bricks.albedo(64).expect("colours"));
        let wall = scene.add_relief(&Relief::new(SurfaceMesh::square(5.0), heights, colors), 1);
        let creature = scene.add_character(&clothed(), 2);
        let solid = scene.add_mesh(&solid(false, false), 1);
        let objects = [land, wall, creature, solid].map(|object| object.expect("added"));
        let places = [[-4.0, 4.0, -1.0], [1.0, 3.0, 2.0], [5.0, 4.0, 1.0]].map(Placement::at);
        let scales = [1.0, 3.0, 1.5];
        let instances =
            [0, 1, 2].map(|at| scene.spawn(objects[at + 1], places[at].scaled(scales[at])).expect("room"));
        scene.play(instances[1], &Play::new("walk")).expect("the clip");
        scene.advance(1.3).expect("finite");
        let mut view = scene.view(Quality::pixels(0.5)).expect("a view");
        view.set(camera()).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        Self { scene, view, frame, renderer, objects, instances }
    }

    fn shot(&mut self) -> RgbaImage {
        self.frame.shot(&mut self.scene, &mut self.view, &self.renderer)
    }

    fn waiting(&self) -> [bool; 4] {
        self.objects.map(|object| self.scene.is_waiting(object).expect("of the scene"))
    }

    /// The picture once nothing waits.
    fn arrived(&mut self) -> RgbaImage {
        while self.scene.waiting() > 0 {
            self.shot();
        }
        self.shot()
    }

    /// The picture of a scene without a budget, in which these objects are hidden.
    fn without(&mut self, hidden: [bool; 4]) -> RgbaImage {
        for (object, is_hidden) in self.objects.into_iter().zip(hidden) {
            self.scene.set_visible(object, !is_hidden).expect("of the scene");
        }
        self.scene.refresh().expect("afresh");
        self.shot()
    }
}

/// Objects appear one after the other, whole; no frame uploads more than its budget and a row; in the end the picture is
/// that of a scene which uploaded everything at once.
#[test]
fn objects_appear_once_they_have_arrived() {
    let gpu = device();
    let mut whole = Stage::new(&gpu, None);
    let expected = whole.shot();
    assert_eq!((whole.scene.waiting(), whole.waiting()), (0, [false; 4]));
    for budget in [100_000, 500_000, usize::MAX] {
        let mut stage = Stage::new(&gpu, Some(budget));
        let all = stage.scene.waiting();
        assert!(all > 400_000 && stage.waiting() == [true; 4], "{all} bytes wait");
        let (mut frames, mut seen, mut before) = (0, [true; 4], all);
        while stage.scene.waiting() > 0 {
            let picture = stage.shot();
            let (now, waiting) = (stage.scene.waiting(), stage.waiting());
            let sent = before - now;
            assert!(sent > 0 && sent <= budget.saturating_add(ROW), "{sent} of {budget} bytes");
            assert!((sent..sent + REST).contains(&stage.scene.uploaded()), "{}", stage.scene.uploaded());
            if frames == 0 || waiting != seen {
                assert!(picture == whole.without(waiting), "frame {frames}: not what has arrived");
                assert!(waiting == [false; 4] || picture != expected, "what waits makes no difference");
            }
            (frames, seen, before) = (frames + 1, waiting, now);
        }
        let least = all.div_ceil(budget.saturating_add(ROW));
        assert!((least..=all / budget + 1).contains(&frames), "{frames} frames for {all} of {budget} bytes");
        assert_eq!(seen, [false; 4]);
        assert!(stage.shot() == expected, "budget {budget}: another picture in the end");
    }
}

/// What waits is found by no ray, and can be changed, spawned beyond its room, attached, and removed.
#[test]
fn what_waits_can_be_changed() {
    let gpu = device();
    let change = |stage: &mut Stage| {
        let [_, wall, creature, solid] = stage.objects;
        let [_, walker, box_] = stage.instances;
        let old = stage.scene.material(creature, "skin").expect("a material").clone();
        let red = Material { color: [0.8, 0.1, 0.1, 1.0], ..old };
        stage.scene.set_material(creature, "skin", &red).expect("a material");
        let image = RgbaImage::from_fn(32, 32, |x, y| Rgba([255, 8 * x as u8, 8 * y as u8, 255]));
        stage.scene.set_image(creature, 0, image).expect("an image");
        for at in 0..5 {
            let place = Placement::at([at as f32 - 2.0, 5.0, -1.0]);
            stage.scene.spawn(creature, place).expect("room");
        }
        stage.scene.spawn(solid, Placement::at([-1.0, 6.0, 0.0])).expect("room");
        stage.scene.attach(box_, walker, "0", Transform::IDENTITY).expect("a bone");
        stage.scene.remove(wall).expect("there");
        stage.renderer.prepare(&stage.scene).expect("compiled");
    };
    let mut whole = Stage::new(&gpu, None);
    let before = whole.shot();
    change(&mut whole);
    whole.scene.refresh().expect("afresh");
    let expected = whole.shot();
    assert!(expected != before, "the changes make no difference");
    let ray = Ray::new([1.0, 6.0, 30.0], [0.0, 0.0, -1.0]);
    let found = whole.scene.pick(&ray).expect("a ray");
    assert!(found.is_some(), "the ray meets nothing");
    let mut stage = Stage::new(&gpu, Some(20_000));
    let frames = [stage.shot(), stage.shot()];
    assert!(frames[0] == frames[1], "something appeared already");
    assert!(stage.scene.pick(&ray).expect("a ray").is_none(), "a ray found what waits");
    change(&mut stage);
    assert!(stage.arrived() == expected, "another picture");
    assert!(stage.scene.pick(&ray).expect("a ray").is_some());
}

/// A scene that moves to another device uploads everything there, and a budget that is lifted sends the rest at once.
#[test]
fn the_rest_arrives_at_once_where_it_is_asked_for() {
    let [gpu, other] = devices();
    let expected = Stage::new(&gpu, None).shot();
    let mut stage = Stage::new(&gpu, Some(100_000));
    stage.shot();
    assert!(stage.scene.waiting() > 0);
    stage.scene.set_upload_budget(None).expect("none");
    assert!(stage.shot() == expected && stage.scene.waiting() == 0, "not everything with the next frame");
    let mut stage = Stage::new(&gpu, Some(100_000));
    stage.shot();
    stage.scene.rebuild(&other).expect("rebuilt");
    assert_eq!((stage.scene.waiting(), stage.waiting()), (0, [false; 4]));
    stage.view.rebuild(&stage.scene).expect("rebuilt");
    let frame = Frame::plain(&other, SIZE);
    let renderer = frame.renderer(&other, &stage.scene);
    assert!(frame.shot(&mut stage.scene, &mut stage.view, &renderer) == expected, "another picture");
}

#[test]
fn no_bytes_are_no_budget() {
    let mut scene = Scene::new(&device()).expect("compiled");
    let error = scene.set_upload_budget(Some(0)).expect_err("refused").to_string();
    assert!(error.contains("bytes") && error.contains("at least 1"), "{error}");
}
