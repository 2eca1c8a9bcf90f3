//! The shadow of the sun: a map of depths as the sun sees what casts (Williams 1978), fitted to what views show, in which the
//! crate's shading and the caller's look surfaces up.

mod fit;

use super::format::TargetFormat;
use super::layer::Layer;
use super::renderer::Renderer;
use crate::gpu::{Gpu, GpuError};
use crate::scene::layouts::{SHADOW_FORMAT, shadow_map};
use crate::scene::{Camera, Quality, Rebuild, Scene, View, ViewShadow};
use crate::{Error, InputError};
use fit::{Fit, Frustum};

/// The least number of texels along an edge of the map.
const LEAST_SIZE: u32 = 16;

/// The shadow of a scene's light in views of the scene: a map, its camera, and what draws it.
///
/// The map has the depth of what the light reaches first. In every frame, [`SunShadow::fit`] places it around what views show
/// up to a distance, and [`SunShadow::draw`] draws it. What casts is all that casts ([`Scene::set_casts_shadow`]) and shares a
/// bit with [`SunShadow::set_mask`]'s, also outside of what the views show, up to three times as far from it towards the light
/// as the map is wide. Triangles stop light from both sides, reliefs with their own depth, and cut-out surfaces where they are
/// opaque; blended ones cast no shadow. All receive it: in the crate's shading, and as `Surface.sunlit` in the caller's
/// ([`Renderer::with_shading`]).
///
/// A texel covers 1/`size` of the width of the map, about 1.8 `range` / `size` for a field of view of 0.8. Shadows are as
/// sharp as two of them, and what is nearer to a surface than three of them may not shade it. They stay where they are while
/// the camera moves and turns, since the map moves by whole texels; they move with the light, and where the field of view or
/// `range` changes much. `docs/shadows.md` has the derivation.
///
/// # Examples
///
/// ```no_run
/// use relievo::render::{Layer, Renderer, SunShadow};
/// use relievo::scene::{Camera, Scene};
/// # fn load(
/// #     (mut scene, mut renderer, camera): (Scene, Renderer, Camera),
/// #     mut encoder: wgpu::CommandEncoder,
/// #     begin: impl Fn(&mut wgpu::CommandEncoder) -> wgpu::RenderPass<'static>,
/// # ) -> Result<(), relievo::Error> {
///
/// // Once, before renderers are prepared.
/// let mut shadow = SunShadow::new(&mut scene, 2048)?;
/// renderer.prepare(&scene)?;
/// let mut eye = scene.view(Default::default())?;
///
/// // A frame: shadows up to 120 units ahead of the eye.
/// eye.set(camera)?;
/// shadow.fit(&scene, &mut [&mut eye], 120.0)?;
/// scene.record(&mut encoder, &mut [&mut eye, shadow.view()])?;
/// shadow.draw(&mut encoder, &scene)?;
/// # let mut pass = begin(&mut encoder);
/// renderer.draw(&mut pass, &scene, &eye, Layer::Color)?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct SunShadow {
    size: u32,
    map: wgpu::TextureView,
    renderer: Renderer,
    view: View,
}

impl SunShadow {
    /// A map of `size` × `size` texels (2048, say), and the pipelines for what the scene has. From now on all renderers of the
    /// scene look surfaces up: prepare them afterwards.
    ///
    /// # Errors
    /// [`InputError`] for a size below 16 or above the device's limit of textures; what the driver's compiler reports.
    pub fn new(scene: &mut Scene, size: u32) -> Result<Self, Error> {
        let gpu = scene.gpu().clone();
        let most = gpu.device().limits().max_texture_dimension_2d;
        if !(LEAST_SIZE..=most).contains(&size) {
            let bound = format!("must be {LEAST_SIZE} to {most}, the device's limit");
            return Err(InputError::new("size", size, bound).into());
        }
        let mut renderer = Renderer::new(&gpu, &TargetFormat::depth_only(SHADOW_FORMAT))?.casting();
        renderer.prepare(scene)?;
        let mut view = scene.view(Quality::default())?;
        view.set_casters_only(true);
        view.remade_by = "SunShadow::rebuild";
        let map = created(&gpu, size)?;
        scene.set_shadowed();
        Ok(Self { size, map, renderer, view })
    }

    /// As [`SunShadow::new`], but completes once the device has told its errors ([`Gpu::check_async`]).
    ///
    /// # Errors
    /// As [`SunShadow::new`].
    pub async fn new_async(scene: &mut Scene, size: u32) -> Result<Self, Error> {
        let shadow = Self::new(scene, size)?;
        scene.gpu().check_async().await?;
        Ok(shadow)
    }

    /// Compiles the pipelines that are not there yet, after objects were added to the scene ([`Renderer::prepare`]).
    ///
    /// # Errors
    /// As [`Renderer::prepare`].
    pub fn prepare(&mut self, scene: &Scene) -> Result<(), Error> {
        self.renderer.prepare(scene)
    }

    /// As [`SunShadow::prepare`], but completes once the device has told its errors.
    ///
    /// # Errors
    /// As [`Renderer::prepare`].
    pub async fn prepare_async(&mut self, scene: &Scene) -> Result<(), Error> {
        self.renderer.prepare_async(scene).await
    }

    /// Lets only instances cast whose visibility mask ([`Scene::set_visibility_mask`]) shares a bit with `mask`; all that cast at
    /// first.
    pub fn set_mask(&mut self, mask: u16) {
        self.view.set_mask(mask);
    }

    /// Places the map around what these views show up to `range` units ahead of their cameras, and lets them show it. Call it
    /// in each frame after cameras and light were set, and before [`Scene::record`]. A view that shows the same everywhere, as a
    /// minimap does, may be left out; [`View::clear_shadow`] takes the shadow from a view again.
    ///
    /// Beyond `range` shadows end somewhere, fading. Levels of detail of what casts are those that the views decide.
    ///
    /// # Errors
    /// [`InputError`] for no view or more than four, views of another scene or without a camera, and a `range` that is not
    /// finite or not beyond a camera's near plane. Nothing changes then.
    pub fn fit(&mut self, scene: &Scene, views: &mut [&mut View], range: f32) -> Result<(), InputError> {
        self.view.check(scene, "shadow")?;
        if !(range > 0.0 && range.is_finite()) {
            return Err(InputError::new("range", range, "must be finite and above 0"));
        }
        let mut cameras: Vec<Camera> = Vec::new();
        for (at, view) in views.iter().enumerate() {
            view.check(scene, &format!("views[{at}]"))?;
            let none = || InputError::new(format!("views[{at}].camera"), "none", "must be set before");
            cameras.push(*view.camera().ok_or_else(none)?);
        }
        if cameras.is_empty() {
            return Err(InputError::new("views", "none", "must be at least one"));
        }
        let frusta = cameras.iter().map(|camera| Frustum::new(camera, f64::from(range)));
        let frusta = frusta.collect::<Result<Vec<_>, _>>()?;
        let Fit { camera, texel } = Fit::new(&frusta, scene.light().direction, self.size);
        self.view.set_lod_cameras(&cameras)?;
        let pixels = views.iter().map(|view| view.quality().pixels).fold(f32::INFINITY, f32::min);
        self.view.set_quality(Quality { pixels })?;
        self.view.set(camera)?;
        for view in views {
            view.set_shadow(ViewShadow { map: self.map.clone(), camera, texel });
        }
        Ok(())
    }

    /// The view of the light, which [`Scene::record`] takes beside those that it was fitted to.
    pub fn view(&mut self) -> &mut View {
        &mut self.view
    }

    /// The camera of the light, parallel and with forward depth, after the first [`SunShadow::fit`].
    pub fn camera(&self) -> Option<&Camera> {
        self.view.camera()
    }

    /// The map, `Depth32Float`, for shaders of the caller's own. It stays the same until the shadow is rebuilt.
    pub fn map(&self) -> &wgpu::TextureView {
        &self.map
    }

    /// Draws the map, in a pass of its own. Call it after [`Scene::record`], and before the passes that draw the views.
    ///
    /// # Errors
    /// As [`Renderer::draw`] for the view of the light; [`InputError`] for an encoder of another [`wgpu::Instance`].
    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder, scene: &Scene) -> Result<(), InputError> {
        self.view.check(scene, "shadow")?;
        scene.gpu().check_encoder(encoder)?;
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("sun shadow"),
            color_attachments: &[],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &self.map,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        let drawn = self.renderer.draw(&mut pass, scene, &self.view, Layer::Depth);
        // The caller knows the view by this name.
        drawn.map_err(|error| match error.path.as_str() {
            "view" => InputError { path: "shadow.view()".to_owned(), ..error },
            _ => error,
        })
    }

    /// Creates everything anew after the device was lost and the scene was rebuilt on another one
    /// ([`Scene::rebuild_async`]). Rebuild the views as well ([`View::rebuild`]), and fit it to them again.
    ///
    /// # Errors
    /// As [`View::rebuild`] and [`Renderer::rebuild`]; [`GpuError`].
    pub fn rebuild(&mut self, scene: &Scene) -> Result<(), Error> {
        let map = created(scene.gpu(), self.size)?;
        self.view.rebuild(scene)?;
        self.renderer.rebuild(scene.gpu())?;
        self.map = map;
        Ok(())
    }
}

impl Rebuild for SunShadow {
    fn rebuild_for(&mut self, scene: &Scene) -> Result<(), Error> {
        self.rebuild(scene)
    }
}

fn created(gpu: &Gpu, size: u32) -> Result<wgpu::TextureView, GpuError> {
    gpu.scoped(|| shadow_map(gpu, size).create_view(&wgpu::TextureViewDescriptor::default()))
}
