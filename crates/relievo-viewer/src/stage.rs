//! A world on the device, with all that draws it: a view, renderers, a shadow, and targets as large as the picture.

use relievo::gpu::Gpu;
use relievo::render::{Layer, Offscreen, Renderer, SunShadow, TargetFormat};
use relievo::scene::{Camera, Rebuild, View, ViewStatistics};
use relievo::{Error, InputError};
use relievo_scene_file::{SunOptions, World, WorldKind};

use crate::streaming::Streaming;

/// Samples per pixel of pictures.
const SAMPLES: u32 = 4;

/// What surfaces are drawn in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Colors {
    /// Materials in the light of the scene.
    #[default]
    Shaded,
    /// The level of detail of each instance.
    Levels,
}

/// A world that can be drawn.
#[derive(Debug)]
pub struct Stage {
    /// The world.
    pub world: World,
    view: View,
    shadow: Option<(SunShadow, f32)>,
    shaded: Renderer,
    levels: Renderer,
    /// Targets for shaded surfaces and for levels, as far as they were drawn.
    targets: [Option<Offscreen>; 2],
}

impl Stage {
    /// Prepares a world: compiles all pipelines, and turns statistics on.
    ///
    /// # Errors
    /// [`Error`] of the device.
    pub async fn new(mut world: World) -> Result<Self, Error> {
        let gpu = world.scene.gpu().clone();
        world.scene.set_statistics(true)?;
        let shadow = match world.shadow {
            Some(SunOptions { size, range }) => {
                Some((SunShadow::new_async(&mut world.scene, size).await?, range))
            }
            None => None,
        };
        let mut shaded = Renderer::new(&gpu, &format_of(Colors::Shaded))?;
        shaded.prepare_async(&world.scene).await?;
        let mut levels = Renderer::new(&gpu, &format_of(Colors::Levels))?;
        levels.prepare_async(&world.scene).await?;
        let view = world.scene.view(world.quality)?;
        Ok(Self { world, view, shadow, shaded, levels, targets: [None, None] })
    }

    /// Compiles what is missing after a change of transitions.
    ///
    /// # Errors
    /// [`Error`] of the device.
    pub fn prepare(&mut self) -> Result<(), Error> {
        self.shaded.prepare(&self.world.scene)?;
        self.levels.prepare(&self.world.scene)?;
        match &mut self.shadow {
            Some((shadow, _)) => shadow.prepare(&self.world.scene),
            None => Ok(()),
        }
    }

    /// Shows what has arrived of a scene of a site, and asks for what the last picture needs.
    ///
    /// # Errors
    /// As for [`Streaming::update`].
    pub(crate) async fn stream(&mut self, streaming: &mut Streaming) -> Result<(), Error> {
        let views = [&self.view];
        let views = if self.view.camera().is_some() { &views[..] } else { &[] };
        if streaming.update(&mut self.world, views).await? {
            let Self { world, shadow, shaded, levels, .. } = self;
            shaded.prepare_async(&world.scene).await?;
            levels.prepare_async(&world.scene).await?;
            if let Some((shadow, _)) = shadow {
                shadow.prepare_async(&world.scene).await?;
            }
        }
        Ok(())
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        self.world.scene.gpu()
    }

    /// The view.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The view, to change its quality.
    pub fn view_mut(&mut self) -> &mut View {
        &mut self.view
    }

    /// What the view drew some frames ago.
    pub fn seen(&mut self) -> Option<&ViewStatistics> {
        self.view.statistics()
    }

    /// Makes the targets as large as the picture. Returns whether the target of these colours is another one now.
    ///
    /// # Errors
    /// [`Error`] for a size of 0 or beyond the device's limit, and of the device.
    pub fn resize(&mut self, size: [u32; 2], colors: Colors) -> Result<bool, Error> {
        let gpu = self.gpu().clone();
        let target = &mut self.targets[colors as usize];
        if target.as_ref().is_some_and(|target| target.size() == size) {
            return Ok(false);
        }
        *target = Some(Offscreen::with_format(&gpu, size, format_of(colors))?);
        Ok(true)
    }

    /// The target with the last picture in these colours.
    pub fn target(&self, colors: Colors) -> Option<&Offscreen> {
        self.targets[colors as usize].as_ref()
    }

    /// Records a frame into the target of these colours, which `resize` has made.
    ///
    /// # Errors
    /// As for [`relievo::scene::Scene::record`].
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        camera: Camera,
        colors: Colors,
    ) -> Result<(), Error> {
        let Self { world, view, shadow, shaded, levels, targets } = self;
        let Some(target) = &targets[colors as usize] else { return Ok(()) };
        view.set(camera)?;
        match shadow {
            Some((shadow, range)) if colors == Colors::Shaded => {
                shadow.fit(&world.scene, &mut [&mut *view], *range)?;
                world.scene.record(encoder, &mut [&mut *view, shadow.view()])?;
                shadow.draw(encoder, &world.scene)?;
            }
            _ => world.scene.record(encoder, &mut [&mut *view])?,
        }
        let draw = |pass: &mut wgpu::RenderPass<'_>| -> Result<(), InputError> {
            match colors {
                Colors::Shaded => {
                    shaded.draw(pass, &world.scene, view, Layer::Color)?;
                    shaded.draw(pass, &world.scene, view, Layer::Transparent)
                }
                Colors::Levels => levels.draw(pass, &world.scene, view, Layer::Levels),
            }
        };
        Ok(target.record(encoder, world.background, draw)?)
    }

    /// The fraction of the detail of endless terrain that is there; 1 without such terrain.
    pub fn ready(&self) -> f32 {
        let terrain = self.world.objects.iter().filter(|object| object.kind == WorldKind::Terrain);
        let ready = terrain.filter_map(|object| self.world.scene.terrain_statistics(object.object).ok());
        ready.map(|statistics| statistics.ready).fold(1.0, f32::min)
    }

    /// Makes everything on another device, after the own one was lost.
    ///
    /// # Errors
    /// As for [`relievo::scene::Scene::rebuild_all_async`].
    pub async fn rebuild(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let Self { world, view, shadow, shaded, levels, targets } = self;
        let mut parts: Vec<&mut dyn Rebuild> = vec![view, shaded, levels];
        parts.extend(shadow.iter_mut().map(|(shadow, _)| shadow as &mut dyn Rebuild));
        world.scene.rebuild_all_async(gpu, &mut parts).await?;
        *targets = [None, None];
        Ok(())
    }
}

fn format_of(colors: Colors) -> TargetFormat {
    match colors {
        Colors::Shaded => TargetFormat::srgb().with_samples(SAMPLES),
        Colors::Levels => TargetFormat::levels(),
    }
}
