//! Draws the frames of a scene off screen, one after the other.

use std::time::Instant;

use glam::{Mat4, Vec4};
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::render::target::COLOR_FORMAT;
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::{Camera, Depth, LevelOfDetail, Quality, Transition, View};
use relievo::{Error, InputError};
use relievo_scene_file::{SunOptions, World, WorldKind, WorldObject};
use wgpu::TextureFormat;

/// Largest number of frames to wait for the detail of endless terrain.
const MOST_FRAMES_OF_DETAIL: usize = 1000;

/// How frames are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rendering {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples a pixel: 1 or 4.
    pub samples: u32,
    /// The direction of depth.
    pub depth: Depth,
    /// What is drawn: [`Layer::Color`], and what is transparent above it; or with one sample [`Layer::Depth`],
    /// [`Layer::Surface`], [`Layer::Velocity`] or [`Layer::Levels`].
    pub layer: Layer,
    /// Whether two views of one submission draw the left half and the right half of the picture.
    pub is_split: bool,
    /// How fine.
    pub quality: Quality,
    /// How the levels of detail of all objects change that can do so; as the scene file says if this does not.
    pub transition: Option<Transition>,
}

impl Default for Rendering {
    /// 960 × 600 pixels of colour with 4 samples, by one view, at most a pixel off.
    fn default() -> Self {
        Self {
            size: [960, 600],
            samples: 4,
            depth: Depth::Forward,
            layer: Layer::Color,
            is_split: false,
            quality: Quality::default(),
            transition: None,
        }
    }
}

impl Rendering {
    /// Checks what does not depend on a device.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        self.quality.validate()?;
        if ![1, 4].contains(&self.samples) {
            return Err(InputError::new("samples", self.samples, "must be 1 or 4"));
        }
        if ![Layer::Color, Layer::Depth, Layer::Surface, Layer::Velocity, Layer::Levels].contains(&self.layer)
        {
            let bound = "must be color, depth, surface or velocity";
            return Err(InputError::new("layer", format!("{:?}", self.layer), bound));
        }
        if self.layer != Layer::Color && self.samples > 1 {
            return Err(InputError::new("samples", self.samples, "must be 1 for layers other than color"));
        }
        if self.size.contains(&0) || self.is_split && self.size[0] < 2 {
            let value = format!("{}x{}", self.size[0], self.size[1]);
            return Err(InputError::new("size", value, "must be at least 1x1, and 2x1 for a split picture"));
        }
        Ok(())
    }
}

/// What a frame cost, by the host's clock.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct FrameTimes {
    /// Milliseconds from the recording of the scene's compute work until the device has done it.
    pub compute: f64,
    /// Milliseconds from the recording of the draws, of a shadow's map too, until the device has done them.
    pub draw: f64,
}

/// Draws frames of a world.
#[derive(Debug)]
pub struct Player {
    gpu: Gpu,
    world: World,
    rendering: Rendering,
    target: Offscreen,
    renderer: Renderer,
    views: Vec<View>,
    /// The shadow of the light with its range, if it casts one.
    shadow: Option<(SunShadow, f32)>,
    /// For each object of the world, the number of nodes of endless terrain that the last frame made.
    nodes_made: Vec<usize>,
}

impl Player {
    /// Prepares all that frames need; nothing is compiled or allocated afterwards, except where something grows.
    ///
    /// # Errors
    /// [`InputError`] as [`Rendering::validate`], and for a size beyond the device's limit; [`relievo::gpu::GpuError`].
    pub fn new(mut world: World, rendering: Rendering) -> Result<Self, Error> {
        rendering.validate()?;
        let gpu = world.scene.gpu().clone();
        let Rendering { size, samples, depth, layer, is_split, quality, transition } = rendering;
        if let Some(transition) = transition {
            for WorldObject { object, .. } in &world.objects {
                if transition != Transition::Geomorph || world.scene.can_morph(*object)? {
                    let own = world.scene.level_of_detail(*object)?.clone();
                    world.scene.set_level_of_detail(*object, &LevelOfDetail { transition, ..own })?;
                }
            }
        }
        let format = format_of(layer).with_samples(samples);
        let format = if depth == Depth::Reversed { format.reversed() } else { format };
        let target = Offscreen::with_format(&gpu, size, format)?;
        if layer == Layer::Velocity {
            world.scene.keep_motion_history(true)?;
        }
        let shadow = match world.shadow.filter(|_| layer == Layer::Color) {
            Some(SunOptions { size, range }) => Some((SunShadow::new(&mut world.scene, size)?, range)),
            None => None,
        };
        let mut renderer = Renderer::new(&gpu, target.format())?;
        renderer.prepare(&world.scene)?;
        let views = (0..1 + usize::from(is_split)).map(|_| world.scene.view(quality));
        let views = views.collect::<Result<_, _>>()?;
        let nodes_made = vec![0; world.objects.len()];
        Ok(Self { gpu, world, rendering, target, renderer, views, shadow, nodes_made })
    }

    /// The world.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to be changed between frames.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// The world, and the views of the frame, to ask for their statistics.
    pub fn parts_mut(&mut self) -> (&mut World, &mut [View]) {
        (&mut self.world, &mut self.views)
    }

    /// The views of the frame, from left to right.
    pub fn views(&self) -> &[View] {
        &self.views
    }

    /// For each object of the world, the number of nodes that the last frame made of it; 0 unless it is endless terrain.
    pub fn nodes_made(&self) -> &[usize] {
        &self.nodes_made
    }

    /// How frames are drawn.
    pub fn rendering(&self) -> &Rendering {
        &self.rendering
    }

    /// The camera of the whole picture at the time of the scene.
    pub fn camera(&self) -> Camera {
        let Rendering { size, depth, .. } = self.rendering;
        self.world.camera.camera(self.world.scene.time(), size, depth)
    }

    /// Draws the frame that is `seconds` after the one before, the first one that long after time 0. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for seconds that are not finite; [`relievo::gpu::GpuError`].
    pub fn frame(&mut self, seconds: f32) -> Result<FrameTimes, Error> {
        self.world.scene.advance(seconds)?;
        let camera = self.camera();
        let halves = self.halves();
        for (view, [from, to]) in self.views.iter_mut().zip(&halves) {
            view.set(if halves.len() == 1 { camera } else { columns(&camera, *from, *to) })?;
        }
        self.nodes_made.fill(0);
        let start = Instant::now();
        let mut encoder = self.gpu.encoder("scene");
        let mut views: Vec<&mut View> = self.views.iter_mut().collect();
        if let Some((shadow, range)) = &mut self.shadow {
            shadow.fit(&self.world.scene, &mut views, *range)?;
            views.push(shadow.view());
        }
        self.world.scene.record(&mut encoder, &mut views)?;
        self.finish(encoder)?;
        self.count_nodes();
        // A picture shows endless terrain in full detail, which takes some frames where the camera has not been yet.
        for _ in 0..MOST_FRAMES_OF_DETAIL {
            // Velocities are those since the frame before, so no frame may come between.
            if self.is_ready() || self.rendering.layer == Layer::Velocity {
                break;
            }
            let mut encoder = self.gpu.encoder("detail");
            let mut views: Vec<&mut View> = self.views.iter_mut().collect();
            views.extend(self.shadow.iter_mut().map(|(shadow, _)| shadow.view()));
            self.world.scene.record(&mut encoder, &mut views)?;
            self.finish(encoder)?;
            self.count_nodes();
        }
        let compute = milliseconds(start);
        let start = Instant::now();
        let mut encoder = self.gpu.encoder("picture");
        if let Some((shadow, _)) = &self.shadow {
            shadow.draw(&mut encoder, &self.world.scene)?;
        }
        self.target.record(&mut encoder, self.world.background, |pass| self.draw(pass, &halves))?;
        self.finish(encoder)?;
        Ok(FrameTimes { compute, draw: milliseconds(start) })
    }

    /// Adds the nodes that were made last.
    fn count_nodes(&mut self) {
        for (object, count) in self.world.objects.iter().zip(&mut self.nodes_made) {
            *count += self.world.scene.terrain_statistics(object.object).map_or(0, |all| all.made);
        }
    }

    /// Whether all detail of endless terrain is there that the views of the last frame need.
    fn is_ready(&self) -> bool {
        let terrain = self.world.objects.iter().filter(|object| object.kind == WorldKind::Terrain);
        let ready =
            |object: &WorldObject| self.world.scene.terrain_statistics(object.object).map(|all| all.ready);
        terrain.filter_map(|object| ready(object).ok()).all(|ready| ready == 1.0)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, halves: &[[u32; 2]]) -> Result<(), InputError> {
        let height = self.rendering.size[1];
        for (view, [from, to]) in self.views.iter().zip(halves) {
            let [left, width] = [*from, to - from];
            pass.set_viewport(left as f32, 0.0, width as f32, height as f32, 0.0, 1.0);
            pass.set_scissor_rect(left, 0, width, height);
            self.renderer.draw(pass, &self.world.scene, view, self.rendering.layer)?;
            if self.rendering.layer == Layer::Color {
                self.renderer.draw(pass, &self.world.scene, view, Layer::Transparent)?;
            }
        }
        Ok(())
    }

    /// The columns of each view, from the first to before the end.
    fn halves(&self) -> Vec<[u32; 2]> {
        let [width, _] = self.rendering.size;
        match self.rendering.is_split {
            true => vec![[0, width / 2], [width / 2, width]],
            false => vec![[0, width]],
        }
    }

    fn finish(&self, encoder: wgpu::CommandEncoder) -> Result<(), Error> {
        self.gpu.scoped(|| self.gpu.queue().submit([encoder.finish()]))?;
        Ok(self.gpu.wait()?)
    }

    /// The colours of the last frame.
    ///
    /// # Errors
    /// [`InputError`] for a layer without colour; [`relievo::gpu::GpuError`].
    pub fn picture(&self) -> Result<RgbaImage, Error> {
        self.target.read(&self.gpu)
    }

    /// The surfaces of the last frame, row by row; `None` where nothing was drawn. For [`Layer::Surface`].
    ///
    /// # Errors
    /// [`InputError`] for another layer; [`relievo::gpu::GpuError`].
    pub fn surfaces(&self) -> Result<Vec<Option<SurfacePixel>>, Error> {
        let read = |index: usize| self.gpu.block_on(self.target.read_color(&self.gpu, index, SURFACE[index]));
        let normals: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&read(0)?);
        let albedo: Vec<[u8; 4]> = bytemuck::pod_collect_to_vec(&read(1)?);
        let numbers: Vec<[u32; 2]> = bytemuck::pod_collect_to_vec(&read(2)?);
        let pixels = normals.into_iter().zip(albedo).zip(numbers);
        let pixel = |(([x, y, z, there], [r, g, b, _]), numbers): (([f32; 4], [u8; 4]), [u32; 2])| {
            (there > 0.0).then_some(SurfacePixel { normal: [x, y, z], albedo: [r, g, b], numbers })
        };
        Ok(pixels.map(pixel).collect())
    }

    /// How many pixels to the right and down what is seen in the last frame has moved since the one before, row by row; `None`
    /// where nothing was drawn. For [`Layer::Velocity`].
    ///
    /// # Errors
    /// [`InputError`] for another layer; [`relievo::gpu::GpuError`].
    pub fn velocities(&self) -> Result<Vec<Option<[f32; 2]>>, Error> {
        let bytes = self.gpu.block_on(self.target.read_color(&self.gpu, 0, VELOCITY))?;
        let velocities: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
        let [width, height] = self.rendering.size;
        let halves = self.halves();
        let widths = (0..width).map(|x| {
            let [from, to] = halves.iter().copied().find(|[_, to]| x < *to).unwrap_or([0, width]);
            (to - from) as f32
        });
        let widths: Vec<f32> = widths.collect();
        let pixel = |(at, [right, down, _, there]): (usize, [f32; 4])| {
            (there > 0.0).then_some([right * widths[at % width as usize], down * height as f32])
        };
        Ok(velocities.into_iter().enumerate().map(pixel).collect())
    }

    /// The distances ahead of the eye of the last frame, in world units, row by row; `None` where nothing was drawn.
    ///
    /// # Errors
    /// [`InputError`] for more than one sample; [`relievo::gpu::GpuError`].
    pub fn distances(&self) -> Result<Vec<Option<f64>>, Error> {
        let camera = self.camera();
        // Depth is scale + offset / distance.
        let [scale, offset] =
            [-camera.clip_from_view.z_axis.z, camera.clip_from_view.w_axis.z].map(f64::from);
        let nothing = if camera.depth == Depth::Reversed { 0.0 } else { 1.0 };
        let depths = self.target.read_depth(&self.gpu)?;
        let distance = |depth: f32| (depth != nothing).then(|| offset / (f64::from(depth) - scale));
        Ok(depths.into_iter().map(distance).collect())
    }
}

/// What the surface in a pixel is before it is lit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePixel {
    /// The unit normal in world axes, on the side that is seen.
    pub normal: [f32; 3],
    /// The colour in sRGB.
    pub albedo: [u8; 3],
    /// The numbers of the object ([`ObjectId::number`](relievo::scene::ObjectId::number)) and the instance.
    pub numbers: [u32; 2],
}

/// The target of a layer, of values that need no other feature to be read: a velocity's and a normal's w tell whether there is
/// anything.
fn format_of(layer: Layer) -> TargetFormat {
    let color = |formats: &[TextureFormat]| formats.iter().map(|format| Some((*format).into())).collect();
    match layer {
        Layer::Depth => TargetFormat::depth_only(TextureFormat::Depth32Float),
        Layer::Surface => TargetFormat { color: color(&SURFACE), ..TargetFormat::surface() },
        Layer::Velocity => TargetFormat { color: color(&[VELOCITY]), ..TargetFormat::velocity() },
        Layer::Levels => TargetFormat { color: color(&[COLOR_FORMAT]), ..TargetFormat::levels() },
        _ => TargetFormat::new(COLOR_FORMAT),
    }
}

const SURFACE: [TextureFormat; 3] =
    [TextureFormat::Rgba32Float, TextureFormat::Rgba8UnormSrgb, TextureFormat::Rg32Uint];
const VELOCITY: TextureFormat = TextureFormat::Rgba32Float;

fn milliseconds(start: Instant) -> f64 {
    1e3 * start.elapsed().as_secs_f64()
}

/// The camera of the columns `from..to` of a camera's picture.
fn columns(camera: &Camera, from: u32, to: u32) -> Camera {
    let [width, height] = camera.viewport;
    let part = (to - from) as f32 / width as f32;
    // The middle of the columns, −1 to 1.
    let middle = (from + to) as f32 / width as f32 - 1.0;
    let cut = Mat4::from_cols(
        Vec4::new(1.0 / part, 0.0, 0.0, 0.0),
        Vec4::Y,
        Vec4::Z,
        Vec4::new(-middle / part, 0.0, 0.0, 1.0),
    );
    Camera { clip_from_view: cut * camera.clip_from_view, viewport: [to - from, height], ..*camera }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use relievo_scene_file::SceneFile;

    use super::*;

    #[test]
    fn columns_show_what_the_picture_shows_there() {
        let text = r#"{"meshes": [{"file": "builtin:rock", "instances": [{"at": [0, 0, 0]}]}],
            "camera": {"at": [0, 2, 0], "look": [0, 2, -10], "fov": 1, "near": 0.5}}"#;
        let file = SceneFile::from_json(text).expect("a scene");
        let camera = file.camera().camera(0.0, [300, 200], Depth::Forward);
        let right = columns(&camera, 100, 300);
        assert_eq!(right.viewport, [200, 200]);
        for point in [Vec3::new(1.0, 2.5, -4.0), Vec3::new(-2.0, 0.0, -9.0)] {
            let [whole, part] = [camera, right].map(|camera| camera.clip_from_cell().project_point3(point));
            let pixel = |x: f32, width: f32| (0.5 + 0.5 * x) * width;
            assert!((pixel(part.x, 200.0) + 100.0 - pixel(whole.x, 300.0)).abs() < 1e-3);
            assert!((part.y - whole.y).abs() < 1e-6 && (part.z - whole.z).abs() < 1e-6);
        }
    }
}
