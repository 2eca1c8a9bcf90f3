//! Objects with levels of detail in a scene, and what a view draws of them.

use std::sync::LazyLock;

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::{Light, Model};
use relievo::gpu::Gpu;
use relievo::ops::skinning::add_levels;
use relievo::render::{Layer, Offscreen, Renderer, TargetFormat};
use relievo::scene::{
    Camera, InstanceId, LevelOfDetail, ObjectId, Placement, Play, Quality, Scene, View, ViewStatistics,
};
use relievo::wgpu;
use relievo_samples::{creature, rock};

/// Width and height of the pictures.
pub const SIZE: [u32; 2] = [128, 128];

/// What `zoomed_from` looks at.
pub const TARGET: Vec3 = Vec3::new(0.0, 0.6, 0.0);

/// What is behind everything: a colour that no object has.
pub const BACKGROUND: [f32; 3] = [1.0, 0.0, 1.0];

/// A rock with seven levels of detail.
pub fn mesh() -> Model {
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let mut model = rock().expect("valid");
        add_levels(&mut model, &[], 1).expect("valid");
        model
    });
    MODEL.clone()
}

/// The creature, with levels of detail for its walk.
pub fn character() -> Model {
    static MODEL: LazyLock<Model> = LazyLock::new(|| {
        let mut model = creature().expect("valid");
        add_levels(&mut model, &[0], 9).expect("valid");
        model
    });
    MODEL.clone()
}

/// A scene of one object, seen by one view.
pub struct Stage {
    pub gpu: Gpu,
    pub scene: Scene,
    pub object: ObjectId,
    pub instances: Vec<InstanceId>,
    pub view: View,
}

impl Stage {
    /// Instances of a mesh at these placements.
    pub fn of_mesh(level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Self {
        Self::of(
            |scene| scene.add_mesh(&mesh(), placements.len()).expect("added"),
            level_of_detail,
            placements,
        )
    }

    /// Instances of a character in its walk.
    pub fn of_character(level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Self {
        let add = |scene: &mut Scene| scene.add_character(&character(), placements.len()).expect("added");
        let mut stage = Self::of(add, level_of_detail, placements);
        for instance in &stage.instances {
            stage.scene.play(*instance, &Play::new("walk")).expect("the clip");
        }
        stage
    }

    /// Instances of a model: a character in its first clip, or a mesh if it has no clips.
    pub fn of_model(model: &Model, level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Self {
        let is_mesh = model.clips.is_empty();
        let add = |scene: &mut Scene| match is_mesh {
            true => scene.add_mesh(model, placements.len()).expect("added"),
            false => scene.add_character(model, placements.len()).expect("added"),
        };
        let mut stage = Self::of(add, level_of_detail, placements);
        for instance in stage.instances.iter().filter(|_| !is_mesh) {
            stage.scene.play(*instance, &Play::new("0")).expect("a clip");
        }
        stage
    }

    fn of(
        add: impl FnOnce(&mut Scene) -> ObjectId,
        level_of_detail: &LevelOfDetail,
        placements: &[Placement],
    ) -> Self {
        let gpu = relievo_testing::gpu();
        let mut scene = Scene::new(&gpu).expect("compiled");
        scene.set_light(Light { ambient: 0.3, ..Light::default() }).expect("valid");
        let object = add(&mut scene);
        scene.set_level_of_detail(object, level_of_detail).expect("valid");
        let spawn = |placement: &Placement| scene.spawn(object, *placement).expect("room");
        let instances = placements.iter().map(spawn).collect();
        scene.set_statistics(true).expect("room");
        let mut view = scene.view(Quality::default()).expect("a view");
        view.set(looking_from(10.0)).expect("a camera");
        Self { gpu, scene, object, instances, view }
    }

    /// Records a frame, without drawing it.
    pub fn record(&mut self) {
        let Self { gpu, scene, view, .. } = self;
        let mut encoder = gpu.encoder("frame");
        scene.record(&mut encoder, &mut [view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
    }

    /// The level of each instance in the last frame; `None` for one that is not drawn.
    pub fn levels(&self) -> Vec<Option<u32>> {
        let all = self.scene.drawn_instances(&self.view, self.object).expect("recorded");
        all.iter().map(|instance| instance.drawn.map(|drawn| drawn.list / 2)).collect()
    }

    /// Records a frame, and gives the levels.
    pub fn levels_now(&mut self) -> Vec<Option<u32>> {
        self.record();
        self.levels()
    }

    /// The statistics of the last frame.
    pub fn statistics(&mut self) -> ViewStatistics {
        self.view.statistics().expect("arrived").clone()
    }

    /// Numbers of instances in the lists of each level in the last frame: both levels of a fade count.
    pub fn listed(&mut self) -> Vec<u32> {
        self.statistics().objects[0].levels.iter().map(|level| level.instances).collect()
    }

    /// Records a frame, and draws layers of it.
    pub fn shot(&mut self, target: &Shot, layers: &[Layer]) {
        let Self { gpu, scene, view, .. } = self;
        let run = gpu.try_run("shot", |encoder| {
            scene.record(encoder, &mut [view])?;
            let draw = |pass: &mut wgpu::RenderPass<'_>| {
                layers.iter().try_for_each(|layer| target.renderer.draw(pass, scene, view, *layer))
            };
            Ok(target.target.record(encoder, BACKGROUND, draw)?)
        });
        run.expect("drawn");
        gpu.wait().expect("done");
    }

    /// Records a frame, and draws its colours.
    pub fn picture(&mut self, target: &Shot) -> RgbaImage {
        self.shot(target, &[Layer::Color, Layer::Transparent]);
        target.target.read(&self.gpu).expect("read")
    }
}

/// A target with its renderer.
pub struct Shot {
    pub target: Offscreen,
    renderer: Renderer,
}

impl Shot {
    pub fn new(stage: &Stage, format: TargetFormat) -> Self {
        let target = Offscreen::with_format(&stage.gpu, SIZE, format).expect("a target");
        let mut renderer = Renderer::new(&stage.gpu, target.format()).expect("a format");
        renderer.prepare(&stage.scene).expect("compiled");
        Self { target, renderer }
    }

    /// Compiles what a new transition needs.
    pub fn prepare(&mut self, stage: &Stage) {
        self.renderer.prepare(&stage.scene).expect("compiled");
    }

    /// Colours, one sample a pixel.
    pub fn colors(stage: &Stage) -> Self {
        Self::new(stage, TargetFormat::srgb())
    }
}

/// A camera `distance` ahead of the origin, of which an object is about as large as the picture at 3 units.
pub fn looking_from(distance: f32) -> Camera {
    let target = Vec3::new(0.0, 0.4, 0.0);
    Camera::looking_at(target + distance * Vec3::Z, target, 0.35, [0.01, 5000.0], SIZE)
}

/// The same picture at any distance: the field of view shrinks as the camera goes away.
pub fn zoomed_from(distance: f32) -> Camera {
    let target = TARGET;
    let field = 2.0 * (1.0 / distance).atan();
    let far = Vec3::new(0.3, 0.2, 1.0).normalize() * distance;
    Camera::looking_at(target + far, target, field, [0.5 * distance, 2.0 * distance], SIZE)
}
