//! Characters: sampled, gated, morphed and skinned on the device, as fine as the views need.

mod driven;
mod layers;
mod posed;
mod runtime;

use crate::animation::{BoundTable, ClipSet, Frame, Gate, RootMotion, RotationPath};
#[cfg(feature = "verify")]
use crate::asset::Affine;
use crate::asset::Model;
use crate::asset::mesh::bone_radii;
use crate::gpu::{Gpu, Staged, Uniform, Upload as _};
use crate::lod::assign::{AssignBuffers, AssignPass};
use crate::lod::{LodObject, SceneDraw, SceneInstance, SelectView};
use crate::scene::drawable::Drawable;
use crate::scene::instances::Changed;
use crate::scene::layers::{CharacterOptions, bone_of};
use crate::scene::layout::{Layout, ObjectRange, error_vectors};
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh;
use crate::scene::paging::{Needs, needs};
use crate::scene::placement::Play;
use crate::scene::playing::Playing;
use crate::scene::quality::Shares;
use crate::scene::stage::Stage;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::bounding_sphere::{BoundingSphere, followed};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::merged::Merged;
use crate::skinning::pages::PageBuffers;
#[cfg(feature = "verify")]
use crate::skinning::vertex::Vertex;
use crate::skinning::{Extent, poses_of};
use crate::{Error, InputError};
use driven::Driven;
use layers::{CharacterLayer, Reach};
pub(super) use runtime::Runtime;

/// The time in seconds after which starts are counted from a later moment, because `f32` seconds lose precision.
const EPOCH: f64 = 128.0;

/// A character and all of its instances.
#[derive(Debug)]
pub(super) struct Character {
    merged: Merged,
    set: ClipSet,
    gate: Gate,
    /// Metres of the model per unit of the gate's table.
    unit: f32,
    /// The displacement of vertices per step of the fade of influences.
    stray: f32,
    /// For each bone, the largest distance of a vertex that follows it, in the bone's space; `None` if none does.
    radii: Vec<Option<f32>>,
    /// A sphere around each clip.
    spheres: Vec<BoundingSphere>,
    plays: Vec<Playing>,
    changed: Changed,
    /// The time of the scene from which the device counts.
    epoch: f64,
    driven: Driven,
    layers: Vec<CharacterLayer>,
    /// How far bones get in blends; `None` if there are no layers.
    reach: Option<Reach>,
    /// The motion that was taken out of each clip.
    motions: Option<Vec<RootMotion>>,
    /// Whether last positions are kept.
    keeps_last: bool,
    runtime: Runtime,
}

impl Character {
    /// Prepares a model that has clips, with room for `capacity` instances.
    pub fn new(
        gpu: &Gpu,
        mut merged: Merged,
        options: &CharacterOptions<'_>,
        (capacity, keeps_last): (usize, bool),
    ) -> Result<Self, Error> {
        let motions = options.root_motion.map(|root| root.take(&mut merged.model)).transpose()?;
        let model = &merged.model;
        let clips: Vec<_> = model.clips.iter().collect();
        let set = ClipSet::new(&clips)?;
        let radii = bone_radii(model.skeleton.len(), &model.skins, &model.meshes);
        let table = BoundTable::new(&model.skeleton, &set, &clips, &radii, RotationPath::default())?;
        let unit = table.unit();
        let poses = clips.iter().map(|clip| poses_of(clip)).collect::<Result<Vec<_>, _>>()?;
        let every: Vec<usize> = (0..clips.len()).collect();
        let stray = Extent::of_model(model, &every, poses.into_iter().max().unwrap_or(1))?.stray;
        let spheres = every.iter().map(|clip| BoundingSphere::in_clip(model, *clip)).collect();
        let gate = Gate::Bounded(table);
        let follows = radii.iter().zip(followed(model));
        let radii: Vec<_> = follows.map(|(radius, follows)| follows.then_some(*radius)).collect();
        let plays = vec![Playing::REST; capacity];
        let bone = |name: &str| bone_of(model, name);
        let layers = CharacterLayer::of_masks(model, &options.layers, bone, capacity)?;
        let reach = (!layers.is_empty()).then(|| Reach::new(model, &radii));
        let runtime = Runtime::new(gpu, model, (&set, &gate, &layers), (capacity, keeps_last))?;
        let mut changed = Changed::default();
        changed.all(capacity);
        Ok(Self {
            merged,
            set,
            gate,
            unit,
            stray,
            radii,
            spheres,
            plays,
            changed,
            epoch: 0.0,
            driven: Driven::default(),
            layers,
            reach,
            motions,
            keeps_last,
            runtime,
        })
    }

    /// Keeps last positions of what is made on a device from now on, or does no longer.
    pub fn keep_last(&mut self, keeps_last: bool) {
        self.keeps_last = keeps_last;
    }

    /// Everything on a device, with room for `capacity` instances, and how it is drawn.
    pub fn on(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        capacity: usize,
    ) -> Result<(Runtime, Vec<Drawable>), Error> {
        let data = (&self.set, &self.gate, &self.layers[..]);
        let runtime = Runtime::new(gpu, &self.merged.model, data, (capacity, self.keeps_last))?;
        let drawables = runtime.drawables(gpu, layouts, &self.merged)?;
        Ok((runtime, drawables))
    }

    /// Takes what lies on a device. All instances start afresh.
    pub fn adopt(&mut self, runtime: Runtime) {
        let capacity = runtime.crowd.len();
        self.runtime = runtime;
        self.plays.resize(capacity, Playing::REST);
        self.changed.all(capacity);
        self.layers.iter_mut().for_each(|layer| layer.resize(capacity));
        self.driven.forget_device();
        // As in a scene that was made anew, whose starts are rounded alike.
        self.epoch = 0.0;
    }

    /// A sphere around an instance that plays the first clip.
    pub fn sphere(&self) -> BoundingSphere {
        self.spheres[0]
    }

    /// The errors of all levels.
    pub fn errors(&self) -> Vec<f32> {
        mesh::errors(&self.merged)
    }

    /// The pages of each mesh.
    pub fn pages(&self) -> impl Iterator<Item = &PageBuffers> {
        self.runtime.skins.iter().map(|skin| &skin.pages)
    }

    /// What is drawn: each mesh, from the vertices of each instance.
    pub fn drawables(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<Vec<Drawable>, Error> {
        self.runtime.drawables(gpu, layouts, &self.merged)
    }

    /// The draws of all parts.
    pub fn draws(&self) -> Vec<SceneDraw> {
        let skins = self.runtime.skins.iter().enumerate();
        skins.flat_map(|(index, skin)| mesh::part_draws(&self.merged, index, &skin.mesh)).collect()
    }

    /// Sets what an instance plays, and returns a sphere around it.
    pub fn play(&mut self, index: u32, play: &Play<'_>) -> Result<BoundingSphere, InputError> {
        play.validate()?;
        let clip = self.clip(play.clip)?;
        self.plays[index as usize] =
            Playing { clip: clip as u32, wrap: play.wrap, start: play.start, rate: play.rate };
        self.changed.add(index, self.plays.len());
        Ok(self.sphere_of(index))
    }

    /// Sets that an instance plays the first clip, and returns a sphere around it.
    pub fn play_first(&mut self, index: u32) -> BoundingSphere {
        self.plays[index as usize] = Playing::REST;
        self.changed.add(index, self.plays.len());
        self.clear_layers(index);
        self.spheres[0]
    }

    fn clip(&self, name: &str) -> Result<usize, InputError> {
        let clip = self
            .merged
            .model
            .clip(name)
            .map_err(|error| InputError { path: "play.clip".to_owned(), ..error })?;
        Ok(self.merged.model.clips.iter().position(|other| std::ptr::eq(other, clip)).unwrap_or(0))
    }

    /// The model matrices of all bones of all instances as the last frame left them, and the number of bones.
    #[cfg(feature = "verify")]
    pub fn read_matrices(&self, gpu: &Gpu) -> Result<(Vec<Affine>, usize), Error> {
        let matrices = self.runtime.frame.model_matrices().read_blocking(gpu)?;
        Ok((matrices, self.merged.model.skeleton.len()))
    }

    /// The skinned vertices of an instance, mesh by mesh.
    #[cfg(feature = "verify")]
    pub fn skinned(&self, gpu: &Gpu, index: u32) -> Result<Vec<Vec<Option<Vertex>>>, Error> {
        self.runtime.skins.iter().map(|skin| skin.read(gpu, index as usize)).collect()
    }

    /// Prepares the assignment of levels for a layout, unless it is prepared.
    pub fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        pass: &AssignPass,
        (range, errors, shares): (ObjectRange, &[f32], Shares),
    ) -> Result<(), Error> {
        if self.runtime.version == layout.version {
            return Ok(());
        }
        let instances = self.plays.len() as u32;
        let params = AssignParams {
            first: range.first,
            instances,
            levels: errors.len() as u32,
            max_influences: InstanceLod::FULL.max_influences,
            mesh_fraction: shares.mesh,
            bone_fraction: shares.bones,
            influence_fraction: shares.influences,
            unit: self.unit,
            stray: self.stray,
            errors: error_vectors(errors),
        };
        let runtime = &mut self.runtime;
        runtime.assign.clear();
        for skin in &runtime.skins {
            let uniform = Uniform::new(gpu, "assign", &params)?;
            let buffers = AssignBuffers {
                params: &uniform,
                allowed: &layout.allowed,
                instances: &layout.instances,
                lods: &runtime.frame.state.lods,
                instance_lods: &skin.crowd.instance_lods,
            };
            let job = pass.prepare(gpu, buffers, instances)?;
            runtime.assign.push((uniform, params, job));
        }
        runtime.version = layout.version;
        Ok(())
    }

    /// Provides the pages that the views of a frame need. Returns the factor by which levels of detail must be coarser
    /// (1 unless a binding is too small), and whether pages were replaced.
    pub fn provide(
        &mut self,
        gpu: &Gpu,
        views: &[SelectView],
        object: &LodObject,
        instances: &[SceneInstance],
    ) -> Result<(f32, bool), Error> {
        let Runtime { skins, paging, .. } = &mut self.runtime;
        if skins.iter().zip(&*paging).all(|(skin, paging)| skin.pages.pages() as u32 >= paging.full) {
            return Ok((1.0, false));
        }
        let Needs { pages, coarsening } = needs(views, object, instances, paging);
        let mut is_replaced = false;
        for ((skin, paging), needed) in skins.iter_mut().zip(&*paging).zip(pages) {
            if needed as usize > skin.pages.pages() {
                skin.set_pages(gpu, paging.enough(needed))?;
                is_replaced = true;
            }
        }
        Ok((coarsening, is_replaced))
    }

    /// Stages the fraction of the allowed displacement that levels of detail use.
    pub fn stage_mesh_fraction(&self, staged: &mut Staged, fraction: f32) -> Result<(), Error> {
        for (params, values, _) in &self.runtime.assign {
            staged.uniform(params, &AssignParams { mesh_fraction: fraction, ..*values })?;
        }
        Ok(())
    }

    /// Stages the time, and what instances play.
    pub fn stage(&mut self, staged: &mut Staged, frame: &Frame, now: f64) -> Result<(), Error> {
        if (now - self.epoch).abs() > EPOCH {
            self.epoch = now;
            self.changed.all(self.plays.len());
            self.layers.iter_mut().for_each(|layer| layer.changed.all(self.plays.len()));
        }
        for [from, to] in self.changed.take(self.plays.len()) {
            let clips = &self.merged.model.clips;
            let duration = |play: &Playing| f64::from(clips[play.clip as usize].duration());
            let plays = self.plays[from..to].iter().map(|play| play.on_device(duration(play), self.epoch));
            staged.elements(&self.runtime.crowd.instances, from, &plays.collect::<Vec<_>>())?;
        }
        self.stage_layers(staged, now)?;
        let elapsed = (now - self.epoch) as f32;
        self.runtime.frame.set_through(staged, frame, elapsed)?;
        for weights in &self.runtime.weights {
            weights.set_through(staged, elapsed)?;
        }
        Ok(())
    }

    /// Adds a stage to a compute pass.
    pub fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        let runtime = &self.runtime;
        match stage {
            Stage::Select => {}
            Stage::Gate => {
                runtime.assign.iter().for_each(|(_, _, job)| job.dispatch(pass));
                runtime.frame.dispatch_gate(pass);
                self.driven.dispatch(pass);
            }
            Stage::Sample => {
                runtime.frame.dispatch_sample(pass);
                runtime.weights.iter().for_each(|weights| weights.dispatch(pass));
            }
            Stage::LocalToModel => runtime.frame.dispatch_local_to_model(pass),
            Stage::Skin => runtime.skins.iter().for_each(|skin| skin.dispatch(pass)),
        }
    }
}
