//! Draws a scene through a view into the caller's render pass or render bundle.

mod check;
mod pipelines;
mod rebuild;
mod scene_pass;
#[cfg(test)]
mod tests;

use std::collections::HashMap;

use super::format::TargetFormat;
use super::layer::Layer;
use super::shading::Shading;
use crate::gpu::{Gpu, Shared, foreign};
use crate::lod::transition::Transition;
use crate::lod::{OBJECT_LISTS, SceneDraw};
use crate::scene::drawable::{Drawable, DrawnObject, DrawnView, Part, SortedDraws, SortedPart};
use crate::scene::layouts::SceneLayouts;
use crate::scene::specialization::{Fade, Specialization};
use crate::scene::{Scene, View};
use crate::{Error, InputError};
use pipelines::{PipelineKey, PipelineSource};
pub use scene_pass::ScenePass;

/// Draws scenes on targets of one format. Each further format needs a renderer of its own, and so does each shadow map. Renderers of
/// one device share their pipelines, except those with text of the caller.
///
/// # Examples
///
/// A depth prepass and colour in one pass with the program's own draws. [`scene`](crate::scene#examples) has a complete frame.
///
/// ```no_run
/// use relievo::gpu::Gpu;
/// use relievo::render::{Layer, Renderer, TargetFormat};
/// use relievo::scene::{Scene, View};
///
/// # fn load(gpu: &Gpu, scene: &Scene) -> Result<Renderer, relievo::Error> {
/// // Once, and `prepare` again whenever objects were added to the scene.
/// let format = TargetFormat::new(wgpu::TextureFormat::Bgra8UnormSrgb).with_samples(4);
/// let mut renderer = Renderer::new(gpu, &format)?;
/// renderer.prepare(scene)?;
/// # Ok(renderer)
/// # }
/// # fn frame(
/// #     renderer: &Renderer,
/// #     pass: &mut wgpu::RenderPass<'_>,
/// #     (scene, view): (&Scene, &View),
/// # ) -> Result<(), relievo::Error> {
///
/// // In a frame, after `Scene::record`.
/// renderer.draw(pass, scene, view, Layer::Depth)?;
/// renderer.draw(pass, scene, view, Layer::Color)?;
/// // From here on, the program sets its own pipeline, bind groups and buffers again.
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Renderer {
    gpu: Gpu,
    format: TargetFormat,
    layouts: SceneLayouts,
    /// The caller's shading; `None` for the crate's own shading.
    shading: Option<Shading>,
    /// Whether the renderer draws shadow maps, which show both sides of all triangles.
    casts: bool,
    /// Compiled pipelines of parts. Several keys may share one pipeline.
    pipelines: HashMap<PipelineKey, wgpu::RenderPipeline>,
    compiled: Shared<PipelineSource, wgpu::RenderPipeline>,
}

impl Renderer {
    /// Creates a renderer for targets of this format. No pipeline is compiled yet.
    ///
    /// # Errors
    /// [`InputError`] that names the field, for a format that the library cannot draw into or the device does not support;
    /// [`crate::gpu::GpuError`] for failures of the device.
    pub fn new(gpu: &Gpu, format: &TargetFormat) -> Result<Self, Error> {
        format.validate()?;
        format.check_on(gpu.device())?;
        let layouts = SceneLayouts::new(gpu)?;
        let (gpu, format) = (gpu.clone(), format.clone());
        let (pipelines, compiled) = Default::default();
        Ok(Self { gpu, format, layouts, shading: None, casts: false, pipelines, compiled })
    }

    /// The same renderer for shadow maps, where triangles stop light from both sides. Nothing is compiled yet.
    pub(super) fn casting(self) -> Self {
        Self { casts: true, pipelines: HashMap::new(), compiled: Shared::default(), ..self }
    }

    /// The same renderer with the caller's shading in every colour pipeline. Nothing is compiled yet.
    ///
    /// `source` is WGSL with a function `fn shade(surface: Surface, view: View) -> vec4<f32>`, which replaces the crate's own
    /// function. The function returns a linear colour, and an alpha that the format's blending may use. It is called in uniform
    /// control flow and must not discard.
    ///
    /// The text may have further functions, structs, constants and private variables. None of its names may begin with
    /// `relievo_`. The text may bind resources in bind group 3, visible to the fragment stage, with the layout `layout`. The
    /// caller sets that group before [`Renderer::draw`]. In the fragment stage, the crate's own pipelines use up to 5 storage
    /// buffers (terrain), 4 uniform buffers, 5 textures and 3 samplers; the caller may use the remainder of WebGPU's default limits.
    ///
    /// The two structs and the crate's own function are:
    ///
    /// ```wgsl
    #[doc = include_str!("../../wgsl/render/scene_shade.wgsl")]
    /// ```
    ///
    /// # Errors
    /// [`InputError`] for the first mistake in the text, with the path `shading:LINE:COLUMN`. Lines and columns are counted from
    /// 1. [`InputError`] with the path `shading.layout` for a layout that does not match the text's bindings, or that exceeds the
    /// device's limits together with the crate's own groups. A browser reports exceeded limits later ([`Scene::health`]).
    /// [`crate::gpu::GpuError`] for other failures of the device.
    pub fn with_shading(self, source: &str, layout: Option<&wgpu::BindGroupLayout>) -> Result<Self, Error> {
        let shading = Shading::new(source, layout)?;
        shading.check_layout(&self.gpu, &self.format, &self.layouts)?;
        let (pipelines, compiled) = Default::default();
        Ok(Self { shading: Some(shading), pipelines, compiled, ..self })
    }

    /// The format of the renderer's targets.
    pub fn format(&self) -> &TargetFormat {
        &self.format
    }

    /// Compiles the missing pipelines of these objects, with or without the shadow of a sun.
    pub(crate) fn prepare_objects<'a>(
        &mut self,
        objects: impl Iterator<Item = (&'a dyn Drawable, Transition)>,
        is_shadowed: bool,
    ) -> Result<(), Error> {
        let parts = objects.flat_map(|(object, transition)| {
            object.parts().map(move |part| (part.specialization, transition))
        });
        let parts: Vec<(&Specialization, Transition)> = parts.collect();
        parts.iter().try_for_each(|(part, _)| self.check_names(part))?;
        let layers: Vec<Layer> = self.format.layers().collect();
        for layer in layers {
            for (part, transition) in &parts {
                for fade in self.fades_of(part, *transition, layer) {
                    for is_flipped in [false, true] {
                        self.compile(self.key(layer, part, is_flipped, is_shadowed).fading(fade))?;
                    }
                }
            }
        }
        Ok(())
    }

    /// Compiles every missing pipeline that the objects of a scene need. Drawing never compiles.
    ///
    /// Call it again after adding objects or a [`SunShadow`](super::SunShadow). Spawned instances, growing objects and
    /// changed cameras need no new pipelines. Similar objects share pipelines, so a second call is usually quick.
    ///
    /// # Errors
    /// [`InputError`] for a scene on another device; errors of the driver's shader compiler.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::gpu::Gpu;
    /// # use relievo::render::{Renderer, TargetFormat};
    /// # use relievo::scene::Scene;
    /// # fn example(gpu: &Gpu, scene: &Scene) -> Result<(), relievo::Error> {
    /// let format = TargetFormat::new(wgpu::TextureFormat::Bgra8UnormSrgb).with_samples(4);
    /// let mut renderer = Renderer::new(gpu, &format)?;
    /// renderer.prepare(scene)?; // after objects were added, and before the first draw
    /// # Ok(())
    /// # }
    /// ```
    pub fn prepare(&mut self, scene: &Scene) -> Result<(), Error> {
        self.check_device(scene)?;
        self.prepare_objects(scene.drawables(), scene.is_shadowed())
    }

    /// Same as [`Renderer::prepare`], but completes once the device has reported its errors ([`Gpu::check_async`]).
    ///
    /// # Errors
    /// Same as [`Renderer::prepare`].
    pub async fn prepare_async(&mut self, scene: &Scene) -> Result<(), Error> {
        self.prepare(scene)?;
        Ok(self.gpu.check_async().await?)
    }

    /// Draws a layer of a scene as the view saw it in the last [`Scene::record`], which must have recorded this view.
    ///
    /// The call sets pipelines, bind groups 0 to 2, the first vertex buffer and the index buffer, and nothing else. Bind group 3,
    /// viewport, scissor and stencil reference are the caller's. The pass must have the attachments and samples of the renderer's
    /// format and belong to its device; wgpu checks this.
    ///
    /// Each object takes one indirect draw per part and level. The number doubles if only some of the object's instances are
    /// mirrored, and doubles again if its levels fade.
    ///
    /// A render bundle that is executed in a later frame shows the view's latest recording. For a bundle, nothing checks whether
    /// the last frame recorded the view. Record the bundle anew after objects were added or grew, after materials changed, and
    /// when an object gets its first mirrored or its first unmirrored instance.
    ///
    /// # Errors
    /// [`InputError`] for:
    /// - a scene on another device, or a pass of another [`wgpu::Instance`];
    /// - a view of another scene, or a view that the last [`Scene::record`] left out;
    /// - a view that was not recorded since objects were added, removed or grew, or since [`Scene::refresh`] or
    ///   [`Scene::set_error_budget`];
    /// - a view whose camera has another depth direction than the format;
    /// - a layer for which the format has no attachment;
    /// - objects that were added since [`Renderer::prepare`];
    /// - [`Layer::Velocity`] in a scene without motion history.
    ///
    /// # Examples
    ///
    /// Opaque surfaces, the program's own drawing, then blended surfaces.
    ///
    /// ```no_run
    /// # use relievo::render::{Layer, Renderer};
    /// # use relievo::scene::{Scene, View};
    /// # fn example(
    /// #     renderer: &Renderer,
    /// #     scene: &Scene,
    /// #     view: &View,
    /// #     mut pass: wgpu::RenderPass<'_>,
    /// #     draw_sky: impl Fn(&mut wgpu::RenderPass<'_>),
    /// # ) -> Result<(), relievo::Error> {
    /// renderer.draw(&mut pass, scene, view, Layer::Color)?;
    /// draw_sky(&mut pass);
    /// renderer.draw(&mut pass, scene, view, Layer::Transparent)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn draw<'a>(
        &'a self,
        pass: &mut impl ScenePass<'a>,
        scene: &'a Scene,
        view: &'a View,
        layer: Layer,
    ) -> Result<(), InputError> {
        self.check_device(scene)?;
        let Some((drawn, objects)) = scene.drawn(view)? else { return Ok(()) };
        if !self.gpu.is_taken(|probe| pass.set_index_buffer(probe.slice(..))) {
            return Err(foreign("pass"));
        }
        if layer == Layer::Transparent {
            self.draw_objects(pass, &drawn, objects.iter().copied(), layer)?;
            if let Some(sorted) = scene.sorted_draws(view) {
                self.draw_sorted(pass, &drawn, &sorted);
            }
            return Ok(());
        }
        self.draw_objects(pass, &drawn, objects.iter().copied(), layer)
    }

    fn compile(&mut self, key: PipelineKey) -> Result<(), Error> {
        if self.pipelines.contains_key(&key) {
            return Ok(());
        }
        let source = key.source(&self.format, self.casts);
        let compile = || source.compiled(&self.gpu, &self.format, &self.layouts, self.shading.as_ref());
        self.pipelines.insert(key, self.compiled.get(source.clone(), compile)?);
        Ok(())
    }

    /// Draws objects. If any check fails, nothing is drawn.
    ///
    /// # Errors
    /// [`InputError`] for a layer that the format does not have, a view with another depth direction than the format, and objects
    /// without compiled pipelines.
    pub(crate) fn draw_objects<'a>(
        &'a self,
        pass: &mut impl ScenePass<'a>,
        view: &DrawnView<'a>,
        objects: impl Iterator<Item = DrawnObject<'a>> + Clone,
        layer: Layer,
    ) -> Result<(), InputError> {
        self.check(view, objects.clone(), layer)?;
        pass.set_bind_group(0, view.group);
        let objects = objects.filter(|object| object.lod.instances > 0);
        if layer == Layer::Transparent && self.format.depth.is_some() {
            for object in objects.clone().filter(|object| hiding_fade(object.transition).is_some()) {
                self.draw_object(pass, view, &object, |part| {
                    hiding(part, object.transition).into_iter().collect()
                });
            }
        }
        for object in objects {
            self.draw_object(pass, view, &object, |part| self.lists_of(part, object.transition, layer));
        }
        Ok(())
    }

    /// The instance lists from which a layer draws a part.
    fn lists_of(&self, part: &Specialization, transition: Transition, layer: Layer) -> Vec<ListDraw> {
        let is_transparent = layer == Layer::Transparent;
        let fading = match transition {
            Transition::Hard | Transition::Geomorph => None,
            Transition::Dither(_) => (!is_transparent).then_some(Fade::Dither),
            _ if is_transparent => Some(Fade::Blend),
            Transition::FadeIn(_) | Transition::TwoPhase(_) => None,
            // Surfaces behind these instances show through, so a depth prepass must not hide them.
            Transition::CrossFade(_) | Transition::Alpha { .. } => {
                let shows = layer != Layer::Color && (layer != Layer::Depth || self.casts);
                shows.then_some(Fade::Heavier)
            }
        };
        let solid = (!is_transparent).then_some(ListDraw { layer, fade: Fade::None, is_fading: false });
        let fading = fading.map(|fade| ListDraw { layer, fade, is_fading: true });
        // Blended parts are not drawn from lists but instance by instance.
        solid.into_iter().chain(fading).filter(|_| !part.state().blended).collect()
    }

    /// The kinds of fades for which a part needs pipelines in a layer.
    fn fades_of(&self, part: &Specialization, transition: Transition, layer: Layer) -> Vec<Fade> {
        if part.state().blended && layer == Layer::Transparent {
            return vec![sorted_fade(transition)];
        }
        let hiding = hiding(part, transition).filter(|list| list.layer == layer);
        let lists = self.lists_of(part, transition, layer);
        lists.into_iter().chain(hiding).map(|list| list.fade).collect()
    }

    /// Draws the parts of an object. `lists` returns the instance lists from which a part is drawn.
    fn draw_object<'a>(
        &'a self,
        pass: &mut impl ScenePass<'a>,
        view: &DrawnView<'a>,
        object: &DrawnObject<'a>,
        lists: impl Fn(&Specialization) -> Vec<ListDraw>,
    ) {
        let Some(group) = object.drawable.group().or(object.view_group) else { return };
        let parts = (0..).zip(object.drawable.parts());
        let listed = parts.map(|(index, part)| (index, part, lists(part.specialization)));
        let mut listed = listed.filter(|(.., lists)| !lists.is_empty()).peekable();
        if listed.peek().is_none() {
            return;
        }
        pass.set_bind_group(1, group);
        pass.set_index_buffer(object.drawable.indices().slice(..));
        for (index, part, lists) in listed {
            self.draw_part(pass, view, object, index, part, &lists);
        }
    }

    /// Draws blended parts instance by instance, from back to front. The host has sorted them.
    fn draw_sorted<'a>(
        &'a self,
        pass: &mut impl ScenePass<'a>,
        view: &DrawnView<'a>,
        sorted: &SortedDraws<'a>,
    ) {
        pass.set_bind_group(0, view.group);
        for SortedPart { drawable, part, draw, is_mirrored, transition } in &sorted.parts {
            let is_flipped = *is_mirrored != view.mirrors;
            let fade = sorted_fade(*transition);
            let pipeline = self.pipeline(Layer::Transparent, part.specialization, is_flipped, fade, view);
            let (Some(pipeline), Some(group)) = (pipeline, drawable.group()) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(1, group);
            pass.set_bind_group(2, part.group);
            pass.set_index_buffer(drawable.indices().slice(..));
            let bytes = [*draw, draw + 1].map(|index| u64::from(index) * size_of::<u32>() as u64);
            pass.set_vertex_buffer(0, sorted.entries.raw().slice(bytes[0]..bytes[1]));
            let offset = u64::from(*draw) * size_of::<SceneDraw>() as u64;
            pass.draw_indexed_indirect(sorted.draws.raw(), offset);
        }
    }

    fn key(&self, layer: Layer, part: &Specialization, is_flipped: bool, is_shadowed: bool) -> PipelineKey {
        PipelineKey::new(layer, part, is_flipped).shadowed(is_shadowed)
    }

    fn pipeline(
        &self,
        layer: Layer,
        part: &Specialization,
        is_flipped: bool,
        fade: Fade,
        view: &DrawnView<'_>,
    ) -> Option<&wgpu::RenderPipeline> {
        self.pipelines.get(&self.key(layer, part, is_flipped, view.is_shadowed).fading(fade))
    }

    /// Draws one part of an object from these lists. `index` is the index of `part` in the object.
    fn draw_part<'a>(
        &'a self,
        pass: &mut impl ScenePass<'a>,
        view: &DrawnView<'a>,
        object: &DrawnObject<'a>,
        index: u32,
        part: Part<'a>,
        lists: &[ListDraw],
    ) {
        pass.set_bind_group(2, part.group);
        for list in lists {
            for is_mirrored in [false, true] {
                let is_flipped = is_mirrored != view.mirrors;
                let pipeline = self.pipeline(list.layer, part.specialization, is_flipped, list.fade, view);
                let is_listed = object.sides[usize::from(is_mirrored)];
                let Some(pipeline) = pipeline.filter(|_| is_listed) else { continue };
                pass.set_pipeline(pipeline);
                draw_lists(pass, view, object, index, is_mirrored, list.is_fading);
            }
        }
    }
}

/// A draw of one part from its instance lists.
#[derive(Debug, Clone, Copy)]
struct ListDraw {
    /// Layer of the pipeline.
    layer: Layer,
    /// How the instances fade.
    fade: Fade,
    /// Whether the lists of fading instances are drawn. Otherwise, the lists of instances that do not fade are drawn.
    is_fading: bool,
}

/// The draw that writes a part's depth before the part is blended. It hides the part's inside, and instances that fade behind the
/// part. `None` for a level that is blended over an opaque level.
fn hiding(part: &Specialization, transition: Transition) -> Option<ListDraw> {
    let fade = hiding_fade(transition)?;
    let depth = ListDraw { layer: Layer::Depth, fade, is_fading: true };
    (!part.state().blended).then_some(depth)
}

/// The fade with which an object with this transition writes depth before it is blended; `None` if it writes none.
fn hiding_fade(transition: Transition) -> Option<Fade> {
    match transition {
        Transition::Alpha { .. } => Some(Fade::None),
        Transition::CrossFade(_) => Some(Fade::Pushed),
        _ => None,
    }
}

/// The fade of instances that are drawn one by one, for an object with this transition.
fn sorted_fade(transition: Transition) -> Fade {
    if matches!(transition, Transition::Alpha { .. }) { Fade::Blend } else { Fade::None }
}

/// Draws one part from the lists of all levels. The two flags choose the lists: mirrored or unmirrored, fading or not fading.
fn draw_lists<'a>(
    pass: &mut impl ScenePass<'a>,
    view: &DrawnView<'a>,
    object: &DrawnObject<'a>,
    part: u32,
    is_mirrored: bool,
    is_fading: bool,
) {
    let lod = object.lod;
    let first = if is_fading { lod.levels } else { 0 };
    for list in (first..first + lod.levels).map(|level| 2 * level + u32::from(is_mirrored)) {
        let first = u64::from(lod.first_list) + u64::from(list) * u64::from(lod.instances);
        let bytes = [first, first + u64::from(lod.instances)].map(|word| word * size_of::<u32>() as u64);
        pass.set_vertex_buffer(0, view.lists.raw().slice(bytes[0]..bytes[1]));
        let draw = u64::from(lod.first_draw) + u64::from(OBJECT_LISTS * part + list);
        pass.draw_indexed_indirect(view.arguments.raw(), size_of::<SceneDraw>() as u64 * draw);
    }
}
