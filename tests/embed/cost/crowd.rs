//! A hundred characters in rows before a camera, as `relievo crowd` places them, drawn by a scene.

use std::rc::Rc;

use glam::Vec3;
use relievo::asset::material::Alpha;
use relievo::asset::{Light, Model};
use relievo::gpu::Gpu;
use relievo::ops::animation::Projection;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::skinning::{add_levels, poses_of};
use relievo::render::{Layer, Renderer, SunShadow};
use relievo::scene::{Camera, Placement, Play, Quality, Scene, View};

use crate::frame::Frame;
use crate::rays::{cube, model, plain};

/// Number of characters in a row, and of rows.
const ROW: usize = 10;

/// Number of characters.
pub const COUNT: usize = ROW * ROW;

/// Width and height of the picture.
pub const SIZE: [u32; 2] = [1920, 1080];

/// The vertical field of view.
const FIELD_OF_VIEW: f32 = std::f32::consts::FRAC_PI_3;

/// Units ahead of the camera that lie in shadow: all of the crowd.
const SHADOWED: f32 = 60.0;

/// Seconds between frames.
pub const STEP: f32 = 1.0 / 60.0;

/// A model with levels of detail for its first clip, and where its instances stand.
pub struct Crowd {
    pub model: Model,
    /// The positions of the instances before a camera at the origin that looks along −Z.
    pub places: Vec<Vec3>,
    pub projection: Projection,
    far: f32,
}

impl Crowd {
    /// The nearest instances are `tall` pixels tall.
    pub fn new(mut model: Model, tall: f32) -> Self {
        if model.meshes.iter().all(|mesh| mesh.levels.is_empty()) {
            let poses = poses_of(&model.clips[0]).expect("a short clip");
            add_levels(&mut model, &[0], poses).expect("valid");
        }
        let [low, high] = corners(&model);
        let size = (high - low).max_element();
        // As the measurements of crowds do, it has 180 units in the size of a character; the near plane is one unit away.
        let projection = Projection::new(SIZE[1], FIELD_OF_VIEW, size / 180.0);
        let front = size * projection.focal_pixels / tall;
        let middle = (low.y + high.y) / 2.0;
        let place = |at: usize| {
            let [column, row] = [at % ROW, at / ROW].map(|at| at as f32 * size / 2.0);
            Vec3::new(column - (ROW - 1) as f32 * size / 4.0, -middle, -front - row)
        };
        let places: Vec<Vec3> = (0..COUNT).map(place).collect();
        Self { model, places, projection, far: 2.0 * front + 14.0 * size }
    }

    /// The camera, turned about the vertical axis.
    pub fn camera(&self, viewport: [u32; 2], turn: f32) -> Camera {
        let ahead = Vec3::new(-turn.sin(), 0.0, -turn.cos());
        Camera::looking_at(Vec3::ZERO, ahead, FIELD_OF_VIEW, [self.projection.near, self.far], viewport)
    }

    /// The time in the clip at which an instance begins.
    pub fn start(&self, at: usize) -> f32 {
        self.model.clips[0].duration() * (0.618 * at as f32).fract()
    }
}

/// The corners of a box around all bones at rest, each with half its length around its origin.
fn corners(model: &Model) -> [Vec3; 2] {
    let (skeleton, lengths) = (&model.skeleton, model.skeleton.lengths());
    let matrices = local_to_model(skeleton, &skeleton.rest());
    let bone = |corners: [Vec3; 2], (rows, length): (&[[f32; 4]; 3], &f64)| {
        let half = |row: &[f32; 4]| 0.5 * *length as f32 * Vec3::new(row[0], row[1], row[2]).length();
        let (at, half) =
            (Vec3::from(rows.map(|row| row[3])), Vec3::from([0, 1, 2].map(|axis| half(&rows[axis]))));
        [corners[0].min(at - half), corners[1].max(at + half)]
    };
    matrices.iter().zip(&lengths).fold([Vec3::INFINITY, Vec3::NEG_INFINITY], bone)
}

/// A program that draws a crowd by a scene.
pub struct Staged {
    gpu: Gpu,
    scene: Scene,
    views: Vec<View>,
    /// Where it draws, if it does.
    target: Option<(Rc<Frame>, Renderer)>,
    /// The shadow of the sun on what the first view shows, if there is one.
    shadow: Option<SunShadow>,
    step: f32,
}

impl Staged {
    /// With the camera of the crowd and so many pixels, without drawing.
    pub fn new(gpu: &Gpu, crowd: &Crowd, pixels: f32) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let object = scene.add_character(&crowd.model, COUNT).expect("added");
        for (at, place) in crowd.places.iter().enumerate() {
            let placement = Placement { offset: *place, ..Default::default() };
            let instance = scene.spawn(object, placement).expect("room");
            let play = Play { start: -f64::from(crowd.start(at)), ..Play::new("0") };
            scene.play(instance, &play).expect("the clip");
        }
        let mut staged =
            Self { gpu: gpu.clone(), scene, views: Vec::new(), target: None, shadow: None, step: STEP };
        staged.add_view(crowd.camera(SIZE, 0.0), pixels);
        staged
    }

    fn add_view(&mut self, camera: Camera, pixels: f32) {
        let mut view = self.scene.view(Quality::pixels(pixels)).expect("a view");
        view.set(camera).expect("a camera");
        self.views.push(view);
    }

    /// With one view more.
    pub fn with_view(mut self, camera: Camera) -> Self {
        self.add_view(camera, 1.0);
        self
    }

    /// With another camera of the first view.
    pub fn looking(mut self, camera: Camera) -> Self {
        self.views[0].set(camera).expect("a camera");
        self
    }

    /// With a time that stands still.
    pub fn still(mut self) -> Self {
        self.step = 0.0;
        self
    }

    /// With the shadow of a sun behind the camera, and a plate that lies in it.
    pub fn in_shadow(mut self, size: Option<u32>, crowd: &Crowd) -> Self {
        self.scene
            .set_light(Light { direction: Vec3::new(-0.5, 0.7, 0.4), ..Light::default() })
            .expect("a light");
        let plate = model(&cube(), plain([0.5; 4], Alpha::Opaque), false);
        let plate = self.scene.add_mesh(&plate, 1).expect("added");
        let (low, high) = (crowd.places[0], crowd.places[COUNT - 1]);
        let width = 2.0 * (high - low).abs().max_element();
        let middle = Placement { offset: (low + high) / 2.0 - Vec3::Y * width, ..Placement::default() };
        self.scene.spawn(plate, middle.scaled(width)).expect("room");
        self.shadow = size.map(|size| SunShadow::new(&mut self.scene, size).expect("a shadow"));
        self
    }

    /// Drawing its first view into a target.
    pub fn drawing(mut self, target: &Rc<Frame>) -> Self {
        let renderer = target.renderer(&self.gpu, &self.scene);
        self.target = Some((target.clone(), renderer));
        self
    }

    /// Plays a frame, and waits for it.
    pub fn frame(&mut self) {
        if self.step > 0.0 {
            self.scene.advance(self.step).expect("finite");
        }
        let mut encoder = self.gpu.encoder("frame");
        let mut views: Vec<&mut View> = self.views.iter_mut().collect();
        if let Some(shadow) = &mut self.shadow {
            shadow.fit(&self.scene, &mut views, SHADOWED).expect("fitted");
            views.push(shadow.view());
        }
        self.scene.record(&mut encoder, &mut views).expect("recorded");
        if let Some(shadow) = &self.shadow {
            shadow.draw(&mut encoder, &self.scene).expect("drawn");
        }
        if let Some((target, renderer)) = &self.target {
            target.pass(&mut encoder, |pass| {
                renderer.draw(pass, &self.scene, &self.views[0], Layer::Color).expect("drawn");
            });
        }
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.wait().expect("done");
    }
}
