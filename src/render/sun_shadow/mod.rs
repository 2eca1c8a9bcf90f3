//! The sun's shadow map (Williams 1978): the depths of casters as the sun sees them, fitted to the space that the views show. The
//! crate's shading and the caller's shading look up the map.

mod fit;

use super::format::TargetFormat;
use super::layer::Layer;
use super::renderer::Renderer;
use crate::gpu::{Gpu, GpuError};
use crate::scene::layouts::{SHADOW_FORMAT, shadow_map};
use crate::scene::{Camera, Quality, Rebuild, Scene, View, ViewShadow};
use crate::{Error, InputError};
use fit::{Fit, Frustum};

/// The smallest number of texels along an edge of the map.
const LEAST_SIZE: u32 = 16;

/// A shadow map for a scene's light: the map, its camera, and its renderer.
///
/// The map holds the depth of the first caster that the light meets. In every frame, [`SunShadow::fit`] places the
/// map around everything that the views show up to a distance, and [`SunShadow::draw`] draws the map.
///
/// Casters are all instances that cast shadows ([`Scene::set_casts_shadow`]) and whose visibility mask shares a bit with the mask
/// of [`SunShadow::set_mask`]. This includes casters outside the views, up to three map widths away towards the light. Triangles
/// stop light from both sides.
/// Reliefs cast shadows with the depth of the relief, and cut-out surfaces only where they are opaque. Blended surfaces cast no
/// shadow. All surfaces receive shadow: in the crate's shading, and as `Surface.sunlit` in the caller's shading
/// ([`Renderer::with_shading`]).
///
/// A texel covers 1/`size` of the map's width: about 1.8 `range` / `size` for a field of view of 0.8 radians. Shadow edges are
/// about two texels wide. A caster closer than three texels to a surface may not shade it. Shadows are stable while the
/// camera moves and turns, because the map moves by whole texels. Shadow edges shift when the light moves, and when the field
/// of view or `range` changes much. `docs/shadows.md` has the derivation.
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
    /// A map of `size` × `size` texels (2048, say), and pipelines for the scene's objects. From now on, all renderers of
    /// the scene look up the shadow. Prepare them after this call.
    ///
    /// # Errors
    /// [`InputError`] for a size below 16 or above the device's limit of textures; errors of the driver's shader compiler.
    pub fn new(scene: &mut Scene, size: u32) -> Result<Self, Error> {
        let gpu = scene.gpu().clone();
        let most = gpu.device().limits().max_texture_dimension_2d;
        let bound = || format!("must be {LEAST_SIZE} to {most}, the device's limit");
        InputError::check((LEAST_SIZE..=most).contains(&size), "size", size, bound)?;
        let mut renderer = Renderer::new(&gpu, &TargetFormat::depth_only(SHADOW_FORMAT))?.casting();
        renderer.prepare(scene)?;
        let mut view = scene.view(Quality::default())?;
        view.set_casters_only(true);
        view.remade_by = "SunShadow::rebuild";
        let map = created(&gpu, size)?;
        scene.set_shadowed();
        Ok(Self { size, map, renderer, view })
    }

    /// Same as [`SunShadow::new`], but completes once the device has reported its errors ([`Gpu::check_async`]).
    ///
    /// # Errors
    /// Same as [`SunShadow::new`].
    pub async fn new_async(scene: &mut Scene, size: u32) -> Result<Self, Error> {
        let shadow = Self::new(scene, size)?;
        scene.gpu().check_async().await?;
        Ok(shadow)
    }

    /// Compiles the missing pipelines after objects were added to the scene ([`Renderer::prepare`]).
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`].
    pub fn prepare(&mut self, scene: &Scene) -> Result<(), Error> {
        self.renderer.prepare(scene)
    }

    /// Same as [`SunShadow::prepare`], but completes once the device has reported its errors.
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`].
    pub async fn prepare_async(&mut self, scene: &Scene) -> Result<(), Error> {
        self.renderer.prepare_async(scene).await
    }

    /// Restricts casters to instances whose visibility mask ([`Scene::set_visibility_mask`]) shares a bit with `mask`.
    /// The default shows all casters.
    pub fn set_mask(&mut self, mask: u16) {
        self.view.set_mask(mask);
    }

    /// Places the map around everything that these views show up to `range` units ahead of their cameras. The views then use the
    /// map.
    ///
    /// Call it in each frame after cameras and light were set, and before [`Scene::record`]. A view with a constant picture, such
    /// as a minimap, may be left out. [`View::clear_shadow`] removes the shadow from a view. Shadows fade out at some distance
    /// beyond `range`. The cameras of the views decide the levels of detail of casters.
    ///
    /// # Errors
    /// [`InputError`] for no view or more than four, views of another scene or without a camera, and a `range` that is not finite
    /// or not beyond a camera's near plane. After an error, nothing has changed.
    pub fn fit(&mut self, scene: &Scene, views: &mut [&mut View], range: f32) -> Result<(), InputError> {
        self.view.check(scene, "shadow")?;
        InputError::check(range > 0.0 && range.is_finite(), "range", range, || "must be finite and above 0")?;
        let mut cameras: Vec<Camera> = Vec::new();
        for (at, view) in views.iter().enumerate() {
            view.check(scene, &format!("views[{at}]"))?;
            let none = || InputError::new(format!("views[{at}].camera"), "none", "must be set before");
            cameras.push(*view.camera().ok_or_else(none)?);
        }
        InputError::check(!cameras.is_empty(), "views", "none", || "must be at least one")?;
        let frusta = cameras.iter().map(|camera| Frustum::new(camera, f64::from(range)));
        let frusta = frusta.collect::<Result<Vec<_>, _>>()?;
        let Fit { camera, texel } = Fit::new(&frusta, scene.light().direction, self.size);
        self.view.set_lod_cameras(&cameras)?;
        let pixels = views.iter().map(|view| view.quality().pixels).fold(f32::INFINITY, f32::min);
        self.view.set_quality(Quality::pixels(pixels))?;
        self.view.set(camera)?;
        for view in views {
            view.set_shadow(ViewShadow { map: self.map.clone(), camera, texel });
        }
        Ok(())
    }

    /// The light's view. Pass it to [`Scene::record`] together with the views that the map was fitted to.
    pub fn view(&mut self) -> &mut View {
        &mut self.view
    }

    /// The light's camera, orthographic with forward depth. `None` before the first [`SunShadow::fit`].
    pub fn camera(&self) -> Option<&Camera> {
        self.view.camera()
    }

    /// The map, `Depth32Float`, for the caller's own shaders. It stays the same until the shadow is rebuilt.
    pub fn map(&self) -> &wgpu::TextureView {
        &self.map
    }

    /// Draws the map in a pass of its own. Call it after [`Scene::record`] and before the passes that draw the views.
    ///
    /// # Errors
    /// The errors of [`Renderer::draw`] for the light's view; [`InputError`] for an encoder of another [`wgpu::Instance`].
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
        // For the caller, the light's view has the name `shadow.view()`.
        drawn.map_err(|error| match error.path.as_str() {
            "view" => InputError { path: "shadow.view()".to_owned(), ..error },
            _ => error,
        })
    }

    /// Creates the map and all pipelines anew after the device was lost and the scene was rebuilt on another one
    /// ([`Scene::rebuild_async`]). Also rebuild the views ([`View::rebuild`]), and fit the map to them again.
    ///
    /// # Errors
    /// The errors of [`View::rebuild`] and [`Renderer::rebuild`]; [`GpuError`] for other failures of the device.
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
