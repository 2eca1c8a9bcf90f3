//! A small scene and a picture of it: a patch of terrain, three walking creatures that stand on it, and a relief wall; and another
//! with a kind of object that the library does not know. The page and the native test draw them with this code.

#[path = "../../../../../../examples/kind/grass.rs"]
mod grass;

use std::path::Path;

use relievo::Error;
use relievo::asset::Light;
use relievo::glam::{Quat, Vec3};
use relievo::gpu::Gpu;
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::TerrainConfig;
use relievo::scene::kind::KindProgram;
use relievo::scene::{
    Camera, Depth, EndlessLimits, ObjectId, Placement, Play, Quality, Ray, Relief, Scene, TerrainSource, View,
};
use relievo::wgpu::TextureFormat;
use relievo_samples::{creature, maps::BuiltInMap};
use relievo_scene_file::SceneFile;

/// Pixels of the picture.
pub const SIZE: [u32; 2] = [512, 384];

const SKY: [f32; 3] = [0.36, 0.55, 0.8];

/// The frames before the picture: more than recordings may wait for their submission.
const FRAMES: usize = 6;

/// The most frames to wait for the detail of endless terrain.
const MOST_FRAMES: usize = 300;

/// The scene with what draws it.
pub struct World {
    scene: Scene,
    renderer: Renderer,
    shadow: Option<SunShadow>,
    eye: View,
    target: Offscreen,
    /// Endless terrain, whose detail takes some frames.
    land: Option<ObjectId>,
}

impl World {
    /// Builds the scene, under the light of the day or of the evening.
    pub async fn new(gpu: &Gpu, evening: bool) -> Result<Self, Error> {
        let mut scene = Scene::new_async(gpu).await?;
        let config = TerrainConfig::new(33, 6.0, "browser")?;
        let land = scene.add_terrain_async(&TerrainSource::new(config)).await?;
        let walkers = scene.add_character_async(&creature()?, 3).await?;
        let bricks = BuiltInMap::Bricks;
        let relief = Relief::wall(2.0, bricks.height_map(128)?, bricks.albedo(128)?);
        let walls = scene.add_relief_async(&relief, 1).await?;
        let ground = |scene: &Scene, x: f64, z: f64| {
            let found = scene.ground(land, x, z).ok().flatten();
            Placement::at_world([x, found.map_or(0.0, |point| point.height), z])
        };
        for at in 0..3 {
            let place = ground(&scene, 11.0 + 3.5 * f64::from(at), 18.0 + f64::from(at));
            let walker = scene.spawn(walkers, place.turned(0.7 * at as f32).scaled(2.0))?;
            scene.play(walker, &Play { start: -0.3 * f64::from(at), ..Play::new("walk") })?;
        }
        let place = ground(&scene, 16.0, 12.0);
        scene.spawn(walls, Placement { offset: place.offset + Vec3::Y * 3.0, ..place.scaled(8.0) })?;
        if evening {
            scene.set_light(Light { direction: Vec3::new(-0.8, 0.3, 0.1), ..Light::default() })?;
        }
        let focus = ground(&scene, 15.0, 17.0).world().as_vec3() + Vec3::Y * 2.0;
        let position = focus + Vec3::new(-4.0, 4.0, 13.0);
        Self::seen(gpu, scene, Camera::looking_at(position, focus, 0.9, [0.1, 200.0], SIZE)).await
    }

    /// Builds a meadow: tufts of grass, a kind of the caller's, on a pavement in the sun. The last frame is kept.
    pub async fn meadow(gpu: &Gpu) -> Result<Self, Error> {
        let mut scene = Scene::new_async(gpu).await?;
        scene.keep_motion_history(true)?;
        let bricks = BuiltInMap::Bricks;
        let relief = Relief::wall(1.0, bricks.height_map(128)?, bricks.albedo(128)?);
        let floor = scene.add_relief_async(&relief, 1).await?;
        let lying = Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2);
        let place = Placement::at([1.6, 0.0, 1.6]).scaled(8.0);
        scene.spawn(floor, Placement { turn: lying, ..place })?;
        let meadow = scene.add_kind(grass::Grass::new(gpu, 5)?, 9)?;
        for at in 0..9_u8 {
            let place = [1.6 * f32::from(at % 3), 0.0, 1.6 * f32::from(at / 3)];
            scene.spawn(meadow, Placement::at(place).turned(f32::from(at)).scaled(4.0))?;
        }
        scene.set_light(Light { direction: Vec3::new(-0.5, 0.6, 0.4), ..Light::default() })?;
        let shadow = SunShadow::new_async(&mut scene, 2048).await?;
        let camera =
            Camera::looking_at(Vec3::new(0.8, 2.6, 8.5), Vec3::new(1.6, 0.8, 1.6), 0.7, [0.1, 200.0], SIZE);
        Ok(Self { shadow: Some(shadow), ..Self::seen(gpu, scene, camera).await? })
    }

    /// Builds terrain without end, on WebGPU's default limits, far from the origin.
    pub async fn endless(gpu: &Gpu) -> Result<Self, Error> {
        let mut scene = Scene::new_async(gpu).await?;
        let config = TerrainConfig { coarse_levels: 5, ..TerrainConfig::new(65, 200.0, "browser")? };
        let limits = EndlessLimits { capacity: 512, node_size: 33, ..EndlessLimits::default() };
        let land = scene.add_terrain_async(&TerrainSource::endless(config).with_limits(limits)).await?;
        let at = [1.0e6, -2.0e6];
        let height = scene.ground(land, at[0], at[1])?.map_or(0.0, |point| point.height);
        let eye = [at[0], height + 40.0, at[1]];
        let target = [at[0] + 300.0, height - 20.0, at[1] - 900.0];
        let camera = Camera::looking_at_world(eye, target, 0.8, [1.0, 10_000.0], SIZE);
        let mut world = Self::seen(gpu, scene, camera).await?;
        world.eye.set_quality(Quality::pixels(4.0))?;
        Ok(Self { land: Some(land), ..world })
    }

    /// Builds the scene of a file, which names no other files.
    pub async fn of_file(gpu: &Gpu) -> Result<Self, Error> {
        let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let file = SceneFile::from_json(include_str!("scene.json"))?;
        let camera = file.camera().camera(0.0, SIZE, Depth::Forward);
        let world = file.load(&none, &relievo_samples::Samples)?.build_async(gpu).await?;
        Self::seen(gpu, world.scene, camera).await
    }

    async fn seen(gpu: &Gpu, scene: Scene, camera: Camera) -> Result<Self, Error> {
        let target = Offscreen::new(gpu, SIZE)?;
        let mut renderer = Renderer::new(gpu, target.format())?;
        renderer.prepare_async(&scene).await?;
        let mut eye = scene.view(Default::default())?;
        eye.set(camera)?;
        Ok(Self { scene, renderer, shadow: None, eye, target, land: None })
    }

    /// Plays some frames, draws the first and the last one, and reads the last one: RGBA in sRGB, row by row.
    pub async fn draw(&mut self, gpu: &Gpu) -> Result<Vec<u8>, Error> {
        let Self { scene, renderer, shadow, eye, target, land } = self;
        for frame in 1.. {
            scene.advance(0.1)?;
            let mut encoder = gpu.encoder("frame");
            match shadow {
                Some(shadow) => {
                    shadow.fit(scene, &mut [&mut *eye], 30.0)?;
                    scene.record(&mut encoder, &mut [&mut *eye, shadow.view()])?;
                    shadow.draw(&mut encoder, scene)?;
                }
                None => scene.record(&mut encoder, &mut [&mut *eye])?,
            }
            let ready = land.map_or(Ok(1.0), |land| scene.terrain_statistics(land).map(|all| all.ready))?;
            let is_last = frame >= FRAMES && (ready == 1.0 || frame == MOST_FRAMES);
            if frame == 1 || is_last {
                target.record(&mut encoder, SKY, |pass| renderer.draw(pass, scene, eye, Layer::Color))?;
            }
            gpu.queue().submit([encoder.finish()]);
            // As a page waits for its next frame.
            gpu.wait_async().await?;
            scene.health()?;
            if is_last {
                break;
            }
        }
        Ok(target.read_async(gpu).await?.into_raw())
    }

    /// The velocities of the last frame, drawn in a frame before: two 16-bit floats a pixel, row by row.
    pub async fn velocities(&self, gpu: &Gpu) -> Result<Vec<u8>, Error> {
        let target = Offscreen::with_format(gpu, SIZE, TargetFormat::velocity())?;
        let mut renderer = Renderer::new(gpu, target.format())?;
        renderer.prepare_async(&self.scene).await?;
        let mut encoder = gpu.encoder("velocities");
        let Self { scene, eye, .. } = self;
        target.record(&mut encoder, [0.0; 3], |pass| renderer.draw(pass, scene, eye, Layer::Velocity))?;
        gpu.queue().submit([encoder.finish()]);
        target.read_color(gpu, 0, TextureFormat::Rg16Float).await
    }

    /// What rays through the middles of some pixels hit: distances, or nothing.
    pub fn picked(&self) -> Result<Vec<String>, Error> {
        let Some(camera) = self.eye.camera() else { return Ok(Vec::new()) };
        let mut said = Vec::new();
        for at in 0..48_u8 {
            let pixel = [64.0 * f32::from(at % 8) + 32.5, 64.0 * f32::from(at / 8) + 32.5];
            let hit = self.scene.pick(&Ray::through(camera, pixel)?)?;
            let hit = hit.map(|hit| format!("{} {:.6}", hit.object.number(), hit.distance));
            said.push(hit.unwrap_or_else(|| "nothing".to_owned()));
        }
        Ok(said)
    }
}

/// What the library says of mistakes in the text of a kind.
pub fn mistakes() -> Vec<String> {
    let text = include_str!("../../../../../../examples/kind/grass.wgsl");
    let planted = [
        ("blade.height * up", "blade.heigth * up"),
        ("in.uv.y", "in.uv.q"),
        ("fn grass_place", "fn grass_put"),
    ];
    let said = planted.map(|(right, wrong)| KindProgram::new("grass", &text.replacen(right, wrong, 1)));
    said.into_iter()
        .map(|made| made.map_or_else(|error| error.to_string(), |_| "nothing".to_owned()))
        .collect()
}
