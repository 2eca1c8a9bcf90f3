//! What lies on the device of a character, with room for all of its instances.

use super::layers::CharacterLayer;
use crate::Error;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::frame::GatedFrame;
use crate::animation::{ClipSet, Gate, Instance, Wrap};
use crate::asset::Model;
use crate::gpu::{Gpu, Job, Uniform};
use crate::scene::drawable::Drawable;
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh;
use crate::scene::paging::Paging;
use crate::shared::lod::assign::AssignParams;
use crate::skinning::merged::Merged;
use crate::skinning::morph_weights::{MorphWeightsJob, MorphWeightsPass, WeightSet};
use crate::skinning::paged::PagedSkin;

/// What lies on the device, with room for all instances.
#[derive(Debug)]
pub(in crate::scene) struct Runtime {
    pub(super) crowd: Crowd,
    pub(super) frame: GatedFrame,
    pub(super) skins: Vec<PagedSkin>,
    /// One for each of `skins`.
    pub(super) paging: Vec<Paging>,
    pub(super) weights: Vec<MorphWeightsJob>,
    pub(super) assign: Vec<(Uniform<AssignParams>, AssignParams, Job)>,
    /// The layout for which `assign` was prepared.
    pub(super) version: u64,
}

impl Runtime {
    /// With room for `capacity` instances.
    pub(super) fn new(
        gpu: &Gpu,
        model: &Model,
        (set, gate, layers): (&ClipSet, &Gate, &[CharacterLayer]),
        (capacity, keeps_last): (usize, bool),
    ) -> Result<Self, Error> {
        let rest = Instance::new(0, Wrap::Loop, 0.0, 1.0);
        let layers: Vec<_> = layers.iter().map(|layer| layer.at_rest(capacity)).collect();
        let crowd = Crowd::layered(gpu, set, &vec![rest; capacity], &layers)?;
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

    /// What is drawn: each mesh, from the vertices of each instance.
    pub(super) fn drawables(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        merged: &Merged,
    ) -> Result<Vec<Drawable>, Error> {
        let skins = self.skins.iter().enumerate();
        let drawable = |(index, skin): (usize, &PagedSkin)| {
            let mesh = (&skin.mesh, &skin.clusters);
            mesh::drawable((gpu, layouts), merged, index, mesh, Some(&skin.pages))
        };
        skins.map(drawable).collect()
    }
}
