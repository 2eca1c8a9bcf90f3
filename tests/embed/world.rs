//! The scene of these tests: nine patches of ground, characters that stand on them, and boxes.

use std::sync::LazyLock;

use glam::Vec3;
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::skinning::add_levels;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::scene::{Camera, InstanceId, ObjectId, Placement, Play, Quality, Scene, TerrainSource, View};
use relievo_samples::creature;

/// Width and height of the pictures.
pub const SIZE: [u32; 2] = [192, 128];

/// The seconds that the scene has gone on before its first picture.
pub const BEGIN: f32 = 1.3;

/// A scene, and what may be changed in it.
pub struct World {
    pub scene: Scene,
    pub land: ObjectId,
    pub creature: ObjectId,
    pub crowd: Vec<InstanceId>,
}

/// The creature, smaller than it is, with levels of detail for one of its clips.
pub fn model() -> Model {
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let mut model = creature().expect("valid");
        add_levels(&mut model, &[0], 9).expect("a clip");
        model
    });
    MODEL.clone()
}

impl World {
    /// With so many creatures, at a time in the middle of their walk.
    pub fn new(gpu: &Gpu, count: usize) -> Self {
        let mut world = Self::empty(gpu, count);
        for at in 0..count {
            let instance = world.spawn(at);
            world.crowd.push(instance);
        }
        world.scene.advance(BEGIN).expect("finite");
        world
    }

    /// Without creatures, at time 0.
    pub fn empty(gpu: &Gpu, capacity: usize) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let config = TerrainConfig::new(33, 6.0, "embed").expect("valid");
        let patches: Vec<[i32; 2]> = (0..9).map(|at| [at % 3 - 1, at / 3 - 1]).collect();
        let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches)).expect("generated");
        let creature = scene.add_character(&model(), capacity).expect("added");
        Self { scene, land, creature, crowd: Vec::new() }
    }

    /// Places character `at` in the grid on the ground, turned its own way, and at its own time in the walk.
    pub fn spawn(&mut self, at: usize) -> InstanceId {
        let placement = self.placement(at);
        let instance = self.scene.spawn(self.creature, placement).expect("room");
        let play = Play { start: Self::start(at), ..Play::new("walk") };
        self.scene.play(instance, &play).expect("the clip");
        instance
    }

    /// The place of character `at`.
    pub fn placement(&self, at: usize) -> Placement {
        let (x, z) = ((at % 5) as f64 * 5.0 - 10.0, (at / 5) as f64 * -6.0);
        let ground = self.scene.ground(self.land, x, z).expect("terrain").expect("inside");
        Placement::at_world([x, ground.height, z]).turned(0.7 * at as f32).scaled(3.0)
    }

    /// When character `at` began to walk.
    pub fn start(at: usize) -> f64 {
        -0.37 * at as f64
    }

    /// A view of the scene with the camera of these tests.
    pub fn view(&self, pixels: f32) -> View {
        let mut view = self.scene.view(Quality::pixels(pixels)).expect("a view");
        view.set(camera(SIZE)).expect("a camera");
        view
    }
}

/// From the south, a little above the ground.
pub fn camera(viewport: [u32; 2]) -> Camera {
    Camera::looking_at(Vec3::new(3.0, 12.0, 16.0), Vec3::new(0.0, 2.0, -6.0), 0.9, [0.5, 400.0], viewport)
}
