//! Device data of a chunk: a group of a character's instances.

use std::borrow::Cow;
use std::iter::repeat;
use std::ops::Range;
use std::sync::Arc;

use crate::Error;
use crate::animation::compact::CompactJob;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::frame::GatedFrame;
use crate::animation::{AnimationLayer, ClipSet, Gate, Instance, Wrap};
use crate::asset::{Influences, Mesh, Model};
use crate::gpu::{Gpu, GpuError, Job, Uniform};
use crate::lod::assign::{AssignBuffers, AssignPass};
use crate::scene::layout::Layout;
use crate::scene::mesh;
use crate::scene::paging::Paging;
use crate::scene::stage::Stage;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::buffers::{MeshBuffers, Rig};
use crate::skinning::clusters::Clusters;
use crate::skinning::morph_weights::{MorphWeightsJob, MorphWeightsPass, WeightSet};
use crate::skinning::paged::{PagedSkin, PagedSkinOptions};
use crate::skinning::tiers::Tiers;
use crate::skinning::{level_errors, own_levels};

/// Device data that all chunks of a character share.
#[derive(Debug)]
pub(in crate::scene) struct Shared {
    pub set: ClipSet,
    pub gate: Gate,
    /// The tiers of the skeleton, without clips: `set` has them.
    pub tiers: Tiers,
    /// Bone mask of each layer above the base; `None` = all bones.
    masks: Vec<Option<Vec<f32>>>,
    clips: ClipBuffers,
    meshes: Vec<(MeshBuffers, Arc<Clusters>)>,
}

impl Shared {
    /// Uploads a model's clips and meshes, with the masks of layers above the base.
    pub fn new(
        gpu: &Gpu,
        model: &Model,
        set: ClipSet,
        gate: Gate,
        tiers: Tiers,
        masks: Vec<Option<Vec<f32>>>,
    ) -> Result<Self, Error> {
        let clips = ClipBuffers::new(gpu, &set)?;
        let own = |mesh: &Mesh| own_levels(mesh, &level_errors(&model.meshes));
        let uploaded = |(mesh, reduced): (&Mesh, &Vec<Influences>)| {
            mesh::check_binding(gpu, mesh)?;
            let rig = Rig { skeleton: &tiers.skeleton, skins: &tiers.skins, reduced };
            let (buffers, clusters) = MeshBuffers::of_rig(gpu, &rig, mesh, &own(mesh))?;
            Ok((buffers, Arc::new(clusters)))
        };
        let meshes = model.meshes.iter().zip(&tiers.reduced).map(uploaded).collect::<Result<_, Error>>()?;
        // Layers are blended on the whole skeleton only.
        let widened =
            |mask: Vec<f32>| mask.into_iter().chain(repeat(1.0)).take(tiers.skeleton.len()).collect();
        let masks = masks.into_iter().map(|mask| mask.map(widened)).collect();
        Ok(Self { set, gate, tiers, masks, clips, meshes })
    }

    /// Creates the shared data of the same character on another device.
    pub fn on(&self, gpu: &Gpu, model: &Model) -> Result<Self, Error> {
        let Self { set, gate, tiers, masks, .. } = self;
        Self::new(gpu, model, set.clone(), gate.clone(), tiers.clone(), masks.clone())
    }
}

/// Instances to make device data for.
#[derive(Debug, Clone)]
pub(in crate::scene) struct Room {
    /// Range of the instances in the object's instance array.
    pub slots: Range<usize>,
    /// Number of instances for which the object has memory.
    pub capacity: usize,
    /// Whether the vertex positions of the last frame are kept.
    pub keeps_last: bool,
}

/// Device data of a chunk of a character's instances.
#[derive(Debug)]
pub(in crate::scene) struct Runtime {
    /// Range of the chunk's instances in the object's instance array.
    pub slots: Range<usize>,
    pub crowd: Crowd,
    pub frame: GatedFrame,
    pub skins: Vec<PagedSkin>,
    /// Page counts of each mesh, in the order of `skins`.
    pub paging: Vec<Paging>,
    pub weights: Vec<MorphWeightsJob>,
    pub assign: Vec<Job>,
    /// Two jobs. The first marks the driven bones as bones to sample, and the second lists all marked bones. `None` without
    /// driven bones.
    pub driven: Option<(Job, CompactJob)>,
    /// The version of the driven bones that `driven` was prepared for.
    pub driven_version: u64,
    /// The layout version that `assign` was prepared for.
    version: u64,
}

impl Runtime {
    /// Creates the chunks for a range of instances. All instances start afresh. A range is halved until its buffers fit into
    /// the device's bindings.
    pub fn all(gpu: &Gpu, model: &Model, shared: &Shared, room: &Room) -> Result<Vec<Self>, Error> {
        let (mut open, mut done) = (vec![room.slots.clone()], Vec::new());
        while let Some(slots) = open.pop() {
            match Self::new(gpu, model, shared, &Room { slots: slots.clone(), ..*room }) {
                Ok(runtime) => done.push(runtime),
                Err(Error::Gpu(GpuError::Limit { limit: "maxStorageBufferBindingSize", .. }))
                    if slots.len() > 1 =>
                {
                    let middle = slots.start + slots.len() / 2;
                    open.extend([middle..slots.end, slots.start..middle]);
                }
                Err(error) => return Err(error),
            }
        }
        Ok(done)
    }

    fn new(gpu: &Gpu, model: &Model, shared: &Shared, room: &Room) -> Result<Self, Error> {
        let Room { slots, capacity, keeps_last } = room.clone();
        let rest = Instance::new(0, Wrap::Loop, 0.0, 1.0);
        let count = slots.len();
        let layer = |mask: &Option<Vec<f32>>| {
            let (instances, weights) = (vec![rest; count], vec![0.0; count]);
            AnimationLayer { instances, weights, mask: mask.clone() }
        };
        let layers: Vec<AnimationLayer> = shared.masks.iter().map(layer).collect();
        let crowd = Crowd::layered(gpu, &shared.set, &vec![rest; count], &layers)?;
        // A chunk gets its part of a budget of bones.
        let gate = match &shared.gate {
            Gate::Budget { table, bones } if count < capacity => {
                let bones = u64::from(*bones) * count as u64 / capacity as u64;
                Cow::Owned(Gate::Budget { table: table.clone(), bones: bones as u32 })
            }
            gate => Cow::Borrowed(gate),
        };
        let frame = GatedFrame::new(gpu, &shared.tiers.skeleton, &shared.clips, &crowd, &gate)?;
        let every: Vec<usize> = (0..model.clips.len()).collect();
        let (mut skins, mut pagings, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for (mesh, (buffers, clusters)) in model.meshes.iter().zip(&shared.meshes) {
            let of_levels = buffers.levels.iter().map(|level| level.clusters).collect();
            let paging = Paging::new(of_levels, slots.len(), gpu.max_binding(), keeps_last);
            let room = PagedSkinOptions { instances: slots.len(), pages: paging.initial(), keeps_last };
            let matrices = frame.model_matrices();
            let skin = PagedSkin::of_mesh(gpu, buffers.clone(), clusters.clone(), matrices, room)?;
            if !mesh.targets.is_empty() {
                let keys = WeightSet::new(mesh, &shared.set, &every)?;
                let pass = MorphWeightsPass::new(gpu)?;
                weights.push(pass.prepare(gpu, &keys, &crowd.instances, &skin.crowd)?);
            }
            pagings.push(paging);
            skins.push(skin);
        }
        let (paging, assign, driven) = (pagings, Vec::new(), None);
        let [driven_version, version] = [0; 2];
        Ok(Self { slots, crowd, frame, skins, paging, weights, assign, driven, driven_version, version })
    }

    /// Whether the allocated pages suffice for all instances in full detail.
    pub fn is_full(&self) -> bool {
        self.skins.iter().zip(&self.paging).all(|(skin, paging)| paging.is_full(skin.pages().pages()))
    }

    /// Prepares the jobs that assign levels of detail to instances, unless they are up to date with the layout.
    pub fn fit(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        pass: &AssignPass,
        params: AssignParams,
    ) -> Result<(), Error> {
        if self.version == layout.version {
            return Ok(());
        }
        let params = AssignParams { instances: self.slots.len() as u32, ..params };
        self.assign.clear();
        for skin in &self.skins {
            let uniform = Uniform::new(gpu, "assign", &params)?;
            let buffers = AssignBuffers {
                allowed: &layout.allowed,
                finest: &layout.finest,
                instances: &layout.instances,
                lods: &self.frame.state.lods,
                instance_lods: &skin.crowd.instance_lods,
            };
            let job = pass.prepare(gpu, &uniform, buffers, params.instances)?;
            self.assign.push(job);
        }
        self.version = layout.version;
        Ok(())
    }

    /// Allocates at least `needed` pages for each mesh. Returns two flags: whether pages were replaced, and whether memory
    /// ran out. If memory runs out for a mesh, [`Paging::most`] is set to the mesh's present number of pages.
    pub fn provide(&mut self, gpu: &Gpu, needed: &[u32]) -> Result<[bool; 2], Error> {
        let (mut is_replaced, mut is_short) = (false, false);
        for ((skin, paging), needed) in self.skins.iter_mut().zip(&mut self.paging).zip(needed) {
            if *needed as usize <= skin.pages().pages() {
                continue;
            }
            let mut provided = skin.set_pages(gpu, paging.enough(*needed));
            if is_out_of_memory(&provided) {
                provided = skin.set_pages(gpu, *needed);
            }
            if is_out_of_memory(&provided) {
                paging.most = skin.pages().pages() as u32;
                is_short = true;
            } else {
                provided?;
                is_replaced = true;
            }
        }
        Ok([is_replaced, is_short])
    }

    /// Records the dispatches of a stage into a compute pass.
    pub fn dispatch(&self, stage: Stage, pass: &mut wgpu::ComputePass<'_>) {
        match stage {
            Stage::Select => {}
            Stage::Gate => {
                self.assign.iter().for_each(|job| job.dispatch(pass));
                self.frame.dispatch_gate(pass);
                if let Some((drive, lists)) = &self.driven {
                    drive.dispatch(pass);
                    lists.dispatch(pass);
                }
            }
            Stage::Sample => {
                self.frame.dispatch_sample(pass);
                self.weights.iter().for_each(|weights| weights.dispatch(pass));
            }
            Stage::LocalToModel => self.frame.dispatch_local_to_model(pass),
            Stage::Skin => self.skins.iter().for_each(|skin| skin.dispatch(pass)),
        }
    }
}

/// Whether the result is an error for lack of device memory.
pub(super) fn is_out_of_memory<T>(result: &Result<T, Error>) -> bool {
    matches!(result, Err(Error::Gpu(GpuError::OutOfMemory { .. })))
}
