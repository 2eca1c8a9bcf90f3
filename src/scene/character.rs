//! Characters: sampled, gated, morphed and skinned on the device, as fine as the views need.

mod posed;

use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::frame::GatedFrame;
use crate::animation::{BoundTable, ClipSet, Frame, Gate, Instance, RotationPath, Wrap};
#[cfg(feature = "verify")]
use crate::asset::Affine;
use crate::asset::Model;
use crate::asset::mesh::bone_radii;
use crate::gpu::{Gpu, Job, Staged, Uniform, Upload as _};
use crate::lod::assign::{AssignBuffers, AssignPass};
use crate::lod::{LodObject, SceneDraw, SceneInstance, SelectView};
use crate::scene::drawable::Drawable;
use crate::scene::frame::Stage;
use crate::scene::instances::Changed;
use crate::scene::layout::{Layout, ObjectRange, error_vectors};
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh;
use crate::scene::paging::{Needs, Paging, needs};
use crate::scene::placement::Play;
use crate::scene::playing::Playing;
use crate::scene::quality::Shares;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::bounding_sphere::{BoundingSphere, followed};
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::merged::Merged;
use crate::skinning::morph_weights::{MorphWeightsJob, MorphWeightsPass, WeightSet};
use crate::skinning::paged::PagedSkin;
use crate::skinning::pages::PageBuffers;
#[cfg(feature = "verify")]
use crate::skinning::vertex::Vertex;
use crate::skinning::{Extent, poses_of};
use crate::{Error, InputError};

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
    /// Whether last positions are kept.
    keeps_last: bool,
    runtime: Runtime,
}

/// What lies on the device, with room for all instances.
#[derive(Debug)]
struct Runtime {
    crowd: Crowd,
    frame: GatedFrame,
    skins: Vec<PagedSkin>,
    /// One for each of `skins`.
    paging: Vec<Paging>,
    weights: Vec<MorphWeightsJob>,
    assign: Vec<(Uniform<AssignParams>, AssignParams, Job)>,
    /// The layout for which `assign` was prepared.
    version: u64,
}

impl Character {
    /// Prepares a model that has clips, with room for `capacity` instances.
    pub fn new(gpu: &Gpu, merged: Merged, capacity: usize, keeps_last: bool) -> Result<Self, Error> {
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
        let radii = follows.map(|(radius, follows)| follows.then_some(*radius)).collect();
        let plays = vec![Playing::REST; capacity];
        let runtime = Runtime::new(gpu, model, (&set, &gate), (capacity, keeps_last))?;
        let mut changed = Changed::default();
        changed.all(capacity);
        let epoch = 0.0;
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
            epoch,
            keeps_last,
            runtime,
        })
    }

    /// Keeps last positions from the next [`Character::grow`] on, or does no longer.
    pub fn keep_last(&mut self, keeps_last: bool) {
        self.keeps_last = keeps_last;
    }

    /// Makes room for more instances. All of them start afresh.
    pub fn grow(&mut self, gpu: &Gpu, capacity: usize) -> Result<(), Error> {
        let room = (capacity, self.keeps_last);
        self.runtime = Runtime::new(gpu, &self.merged.model, (&self.set, &self.gate), room)?;
        self.plays.resize(capacity, Playing::REST);
        self.changed.all(capacity);
        // As in a scene that was made anew, whose starts are rounded alike.
        self.epoch = 0.0;
        Ok(())
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
        let skins = self.runtime.skins.iter().enumerate();
        let drawable = |(index, skin): (usize, &PagedSkin)| {
            let mesh = (&skin.mesh, &skin.clusters);
            mesh::drawable((gpu, layouts), &self.merged, index, mesh, Some(&skin.pages))
        };
        skins.map(drawable).collect()
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
        Ok(self.spheres[clip])
    }

    /// Sets that an instance plays the first clip, and returns a sphere around it.
    pub fn play_first(&mut self, index: u32) -> BoundingSphere {
        self.plays[index as usize] = Playing::REST;
        self.changed.add(index, self.plays.len());
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
        }
        for [from, to] in self.changed.take(self.plays.len()) {
            let clips = &self.merged.model.clips;
            let duration = |play: &Playing| f64::from(clips[play.clip as usize].duration());
            let plays = self.plays[from..to].iter().map(|play| play.on_device(duration(play), self.epoch));
            staged.elements(&self.runtime.crowd.instances, from, &plays.collect::<Vec<_>>())?;
        }
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

impl Runtime {
    fn new(
        gpu: &Gpu,
        model: &Model,
        (set, gate): (&ClipSet, &Gate),
        (capacity, keeps_last): (usize, bool),
    ) -> Result<Self, Error> {
        let rest = Instance::new(0, Wrap::Loop, 0.0, 1.0);
        let crowd = Crowd::new(gpu, set, &vec![rest; capacity])?;
        let clips = ClipBuffers::new(gpu, set)?;
        let frame = GatedFrame::new(gpu, &model.skeleton, &clips, &crowd, gate)?;
        let every: Vec<usize> = (0..model.clips.len()).collect();
        let (mut skins, mut paging, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for (index, mesh) in model.meshes.iter().enumerate() {
            let mut skin = PagedSkin::new(gpu, model, index, frame.model_matrices(), capacity, 1)?;
            if keeps_last {
                skin.keep_last(gpu)?;
            }
            let clusters = skin.mesh.levels.iter().map(|level| level.clusters).collect();
            paging.push(Paging::new(clusters, capacity, gpu.max_binding(), keeps_last));
            if !mesh.targets.is_empty() {
                let keys = WeightSet::new(mesh, set, &every)?;
                weights.push(MorphWeightsPass::new(gpu)?.prepare(
                    gpu,
                    &keys,
                    &crowd.instances,
                    &skin.crowd,
                )?);
            }
            skins.push(skin);
        }
        for (skin, paging) in skins.iter_mut().zip(&paging) {
            skin.set_pages(gpu, paging.initial())?;
        }
        Ok(Self { crowd, frame, skins, paging, weights, assign: Vec::new(), version: 0 })
    }
}
