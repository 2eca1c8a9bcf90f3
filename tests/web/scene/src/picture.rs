//! A small scene and a picture of it: a patch of terrain, three walking creatures that stand on it, and a relief wall.
//! The page and the native test draw it with this code.

use relievo::asset::Light;
use relievo::glam::Vec3;
use relievo::gpu::{Buffer, Gpu};
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::samples::{creature, maps::BuiltInMap};
use relievo::scene::{Camera, Placement, Play, Relief, Scene, TerrainSource, View};
use relievo::terrain::config::Config;
use relievo::{Error, wgpu};

/// Pixels of the picture. Rows are 2048 bytes: copies need multiples of 256.
pub const SIZE: [u32; 2] = [512, 384];

const COLOR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
const SKY: wgpu::Color = wgpu::Color { r: 0.36, g: 0.55, b: 0.8, a: 1.0 };

/// The frames before the picture: more than recordings may wait for their submission.
const FRAMES: usize = 6;

/// The scene with what draws it.
pub struct World {
    scene: Scene,
    renderer: Renderer,
    eye: View,
}

impl World {
    /// Builds the scene, under the light of the day or of the evening.
    pub async fn new(gpu: &Gpu, evening: bool) -> Result<Self, Error> {
        let mut scene = Scene::new_async(gpu).await?;
        let config = Config::new(33, 6.0, "browser")?;
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
        scene.spawn(walls, Placement { at: place.at + Vec3::Y * 3.0, ..place.scaled(8.0) })?;
        if evening {
            scene.set_light(Light { direction: Vec3::new(-0.8, 0.3, 0.1), ..Light::default() })?;
        }
        let mut renderer = Renderer::new(gpu, &TargetFormat::new(COLOR))?;
        renderer.prepare_async(&scene).await?;
        let mut eye = scene.view(Default::default())?;
        let focus = ground(&scene, 15.0, 17.0).position().as_vec3() + Vec3::Y * 2.0;
        let position = focus + Vec3::new(-4.0, 4.0, 13.0);
        eye.set(Camera::looking_at(position, focus, 0.9, [0.1, 200.0], SIZE))?;
        Ok(Self { scene, renderer, eye })
    }

    /// Plays some frames, and reads the last one: RGBA in sRGB, row by row.
    pub async fn draw(&mut self, gpu: &Gpu) -> Result<Vec<u8>, Error> {
        let color = texture(gpu, COLOR);
        let depth = texture(gpu, wgpu::TextureFormat::Depth32Float);
        for _ in 0..FRAMES {
            self.scene.advance(0.1)?;
            let mut encoder = gpu.encoder("frame");
            self.scene.record(&mut encoder, &mut [&mut self.eye])?;
            self.pass(&mut encoder, &color, &depth)?;
            gpu.queue().submit([encoder.finish()]);
            // As a page waits for its next frame.
            gpu.wait_async().await?;
            self.scene.health()?;
        }
        let pixels = Buffer::<u8>::new(gpu, "pixels", (4 * SIZE[0] * SIZE[1]) as usize)?;
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE[0]), rows_per_image: None };
        gpu.submit("copy", |encoder| {
            let to = wgpu::TexelCopyBufferInfo { buffer: pixels.raw(), layout };
            encoder.copy_texture_to_buffer(color.as_image_copy(), to, color.size());
        })?;
        Ok(pixels.read(gpu).await?)
    }

    fn pass(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        color: &wgpu::Texture,
        depth: &wgpu::Texture,
    ) -> Result<(), Error> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (color, depth) = (view(color), view(depth));
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &color,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load: wgpu::LoadOp::Clear(SKY), store: wgpu::StoreOp::Store },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        Ok(self.renderer.draw(&mut pass, &self.scene, &self.eye, Layer::Color)?)
    }
}

fn texture(gpu: &Gpu, format: wgpu::TextureFormat) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}
