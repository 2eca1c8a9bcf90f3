//! A scene of one terrain, and its picture.

use glam::DVec3;
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::render::Renderer;
use relievo::scene::{ObjectId, Ray, Scene, TerrainSource, View};

use crate::frame::Frame;
use crate::world::{SIZE, camera};

/// A scene of one terrain, seen by the camera of `world`.
pub struct Stage {
    pub scene: Scene,
    pub land: ObjectId,
    pub view: View,
    pub frame: Frame,
    pub renderer: Renderer,
}

impl Stage {
    pub fn new(gpu: &Gpu, source: &TerrainSource) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let land = scene.add_terrain(source).expect("added");
        let mut view = scene.view(Default::default()).expect("a view");
        view.set(camera(SIZE)).expect("a camera");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        Self { scene, land, view, frame, renderer }
    }

    pub fn shot(&mut self) -> RgbaImage {
        self.frame.shot(&mut self.scene, &mut self.view, &self.renderer)
    }

    /// The height of the ground.
    pub fn height(&self, x: f64, z: f64) -> Option<f64> {
        self.scene.ground(self.land, x, z).expect("terrain").map(|point| point.height)
    }

    /// The distance to the ground straight down.
    pub fn below(&self, x: f64, z: f64) -> Option<f64> {
        let ray = Ray {
            cell: [0; 3],
            offset: DVec3::new(x, 500.0, z),
            direction: DVec3::NEG_Y,
            limit: f64::INFINITY,
            mask: u16::MAX,
        };
        self.scene.pick(&ray).expect("a ray").map(|hit| hit.distance)
    }
}
