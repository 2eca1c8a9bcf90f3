//! What the program says to relievo: what there is, what of it changes in a frame, and where it is drawn.

use glam::Vec3;
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer, SunShadow, TargetFormat};
use relievo::scene::{
    Camera, InstanceId, ObjectId, Placement, Play, Relief, Scene, TerrainConfig, TerrainSource, View,
};
use relievo_samples::{creature, maps::BuiltInMap};

use crate::Failure;
use crate::eye::Eye;
use crate::targets::SAMPLES;

/// Characters in a row, and rows.
const CROWD: [u32; 2] = [16, 12];

/// World units from one character's round to the next one's.
const SPACING: f64 = 14.0;

/// The size of the characters: twice 1.8 metres.
const SIZE: f32 = 2.0;

/// World units a second: those of a step of the model, which takes half a second.
const PACE: f64 = 1.55 * SIZE as f64;

/// Factors of the characters' colours: red, green, blue and alpha in linear light.
const TINTS: [[f32; 4]; 4] =
    [[0.85, 0.75, 0.6, 1.0], [0.75, 0.35, 0.25, 1.0], [0.3, 0.45, 0.7, 1.0], [0.35, 0.55, 0.3, 1.0]];

/// The scene with its renderer and its view, and what the program changes in it.
pub struct World {
    scene: Scene,
    renderer: Renderer,
    view: View,
    shadow: SunShadow,
    land: ObjectId,
    walkers: Vec<InstanceId>,
}

impl World {
    /// Loads it, for targets of this format. This takes time; a frame does not.
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        color: wgpu::TextureFormat,
    ) -> Result<Self, Failure> {
        let gpu = Gpu::from_wgpu(device.clone(), queue.clone());
        let mut scene = Scene::new(&gpu)?;
        let patches: Vec<[i32; 2]> = (0..25).map(|at| [at % 5 - 2, at / 5 - 2]).collect();
        // A sample every two world units, so that a patch is 128 long.
        let config = TerrainConfig { terrain_scale: 2.0, ..TerrainConfig::new(65, 9.0, "window")? };
        let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches))?;

        let mut model = creature()?;
        relievo::scene::add_levels(&mut model, &[0], 60)?;
        let count = CROWD[0] * CROWD[1];
        let crowd = scene.add_character(&model, count as usize)?;
        let mut walkers = Vec::new();
        for at in 0..count {
            let walker = scene.spawn(crowd, Placement::default())?;
            // Each at a time of its own, so that they are not in step.
            scene.play(walker, &Play { start: -0.31 * f64::from(at), ..Play::new("walk") })?;
            scene.set_tint(walker, TINTS[at as usize * 5 % TINTS.len()])?;
            walkers.push(walker);
        }

        let bricks = BuiltInMap::Bricks;
        let relief = Relief::wall(2.0, bricks.height_map(256)?, bricks.albedo(256)?);
        let wall = scene.add_relief(&Relief { double_sided: true, ..relief }, 16)?;
        for at in (0..count).filter(|at| at % 13 == 5) {
            let [x, z] = center(at);
            // Between two rounds, a little of it below the ground.
            let foot = on_ground(&scene, land, x, z + 0.5 * SPACING);
            let place = Placement { offset: foot.offset + Vec3::Y * 3.0, ..foot };
            scene.spawn(wall, place.turned(0.2 * at as f32).scaled(8.0))?;
        }

        let shadow = SunShadow::new(&mut scene, 4096)?; // texels along an edge
        // Pipelines for the program's targets are compiled here; drawing compiles none.
        let mut renderer = Renderer::new(&gpu, &TargetFormat::new(color).with_samples(SAMPLES))?;
        renderer.prepare(&scene)?;
        let view = scene.view(Default::default())?; // at most a pixel off
        scene.set_statistics(true)?; // for the title
        Ok(Self { scene, renderer, view, shadow, land, walkers })
    }

    /// What there is, and what of it the view saw some frames ago.
    pub fn status(&mut self) -> String {
        let characters = self.walkers.len();
        let Some(seen) = self.view.statistics() else { return format!("{characters} characters") };
        let instances: u32 = seen.objects.iter().map(|object| object.instances()).sum();
        let triangles: u64 = seen.objects.iter().map(|object| object.triangles()).sum();
        format!("{characters} characters, {instances} instances and {triangles} triangles in view")
    }

    /// Moves the characters, advances the time, and records what the device does before anything is drawn, and the map of
    /// the shadow.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        eye: &Eye,
        size: [u32; 2],
        seconds: f32,
    ) -> Result<(), Failure> {
        self.scene.advance(seconds)?;
        for (at, walker) in (0..).zip(&self.walkers) {
            self.scene.move_to(*walker, walking(&self.scene, self.land, at))?;
        }
        let mut position = eye.position();
        let ground = on_ground(&self.scene, self.land, position.x.into(), position.z.into());
        position.y = position.y.max(ground.world().y as f32 + 1.5);
        // The viewport counts physical pixels, and so does the view's quality.
        let camera = Camera::looking_at(position, position + eye.ahead(), 0.9, [0.2, 1500.0], size);
        self.view.set(camera)?;
        self.shadow.fit(&self.scene, &mut [&mut self.view], 120.0)?; // units ahead of the eye
        self.scene.record(encoder, &mut [&mut self.view, self.shadow.view()])?;
        Ok(self.shadow.draw(encoder, &self.scene)?)
    }

    /// Draws it in the program's own pass.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) -> Result<(), Failure> {
        Ok(self.renderer.draw(pass, &self.scene, &self.view, Layer::Color)?)
    }
}

/// The middle of a character's round, east and south of the world's origin.
fn center(at: u32) -> [f64; 2] {
    let [column, row] = [at % CROWD[0], at / CROWD[0]];
    let middle = |index: u32, count: u32| (f64::from(index) - f64::from(count - 1) / 2.0) * SPACING + 64.0;
    [middle(column, CROWD[0]), middle(row, CROWD[1])]
}

/// Where a character is at the time of the scene: on a circle, every other one clockwise.
fn walking(scene: &Scene, land: ObjectId, at: u32) -> Placement {
    let radius = 3.0 + 0.5 * f64::from(at * 7 % 5);
    let sense = if at.is_multiple_of(2) { 1.0 } else { -1.0 };
    let angle = f64::from(at) + sense * scene.time() * PACE / radius;
    let [x, z] = center(at);
    let place = on_ground(scene, land, x + radius * angle.sin(), z + radius * angle.cos());
    // The model faces +Z, and a turn of a quarter +X: the tangent of the circle.
    place.turned((angle + sense * std::f64::consts::FRAC_PI_2) as f32).scaled(SIZE)
}

/// A placement on the ground as it is drawn; at height 0 where there is none.
fn on_ground(scene: &Scene, land: ObjectId, x: f64, z: f64) -> Placement {
    let found = scene.ground(land, x, z).ok().flatten();
    Placement::at_world([x, found.map_or(0.0, |point| point.height), z])
}
