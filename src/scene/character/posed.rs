//! A character on the host: its clips and bones, and poses of its instances.

use glam::{DAffine3, DVec3};

use super::Character;
use super::layers::layered_pose;
use crate::InputError;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::{Instance, ModelMatrices, Pose};
use crate::asset::{Model, Transform};
use crate::gpu::Buffer;
use crate::scene::matrices::{CharacterMatrices, affine_of};
use crate::scene::placement::ClipTime;
use crate::scene::playing::Playing;
use crate::scene::ray::Surface;
use crate::skinning::bone_path::BonePath;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::morph::reference::morph;
use crate::skinning::paged::PagedSkin;
use crate::skinning::palette::reference::palette_for;
use crate::skinning::skin::reference::skin;
use crate::skinning::vertex::Blend;

impl Character {
    /// The index of a bone that is given by its name or its index in digits.
    pub fn bone(&self, name_or_index: &str) -> Result<usize, InputError> {
        self.merged.model.bone(name_or_index)
    }

    /// The root motion of an instance between two scene times in seconds.
    pub fn root_motion(&self, index: u32, from: f64, to: f64) -> Result<Transform, InputError> {
        let Some(motions) = &self.motions else {
            let bound = "must be of a character that was added with options.root_motion";
            return Err(InputError::new("instance", "a character that keeps its motion", bound));
        };
        let Playing { clip, wrap, start, rate } = self.plays[index as usize];
        let instance = Instance::new(clip, wrap, 0.0, rate);
        motions[clip as usize].delta(&instance, from - start, to - start)
    }

    /// The model matrices of all bones in a chunk, for binding; `None` if there is no such chunk.
    pub fn matrices(&self, chunk: usize) -> Option<&ModelMatrices> {
        self.runtimes.get(chunk).map(|runtime| runtime.frame.model_matrices())
    }

    /// The merged model.
    pub fn model(&self) -> &Model {
        &self.merged.model
    }

    /// A sphere around an instance in all poses of its present clip and layers, in model space.
    pub fn sphere_as_played(&self, index: u32) -> BoundingSphere {
        match &self.reach {
            Some(reach) if self.is_blended(index) => reach.sphere(),
            _ => self.spheres[self.plays[index as usize].clip as usize],
        }
    }

    /// The path of the sphere `carried`, which moves with a bone, through all poses of the instance's present clip and layers.
    pub fn path_of(&self, index: u32, bone: usize, carried: &BoundingSphere) -> BonePath {
        let path = BonePath::new(&self.merged.model, self.plays[index as usize].clip as usize, bone, carried);
        match &self.reach {
            Some(reach) if self.is_blended(index) => {
                let (sphere, stretch) = reach.of_bone(bone, carried);
                BonePath { sphere, stretch, ..path }
            }
            _ => path,
        }
    }

    /// The instance's state that [`Character::path_of`] depends on: its clip, and whether layers are blended over the clip.
    pub fn path_key(&self, index: u32) -> (u32, bool) {
        (self.plays[index as usize].clip, self.is_blended(index))
    }

    /// The model matrices of the chunk that holds an instance, and the instance's index in the chunk.
    pub fn model_matrices(&self, index: u32) -> Option<(CharacterMatrices<'_>, usize)> {
        let index = index as usize;
        let runtime = self.runtimes.iter().find(|runtime| runtime.slots.contains(&index))?;
        let raw = runtime.frame.model_matrices().raw();
        let matrices = CharacterMatrices { raw, bones: self.shared.tiers.skeleton.len() };
        Some((matrices, index - runtime.slots.start))
    }

    /// The clip that an instance plays, and the position in it at scene time `now`.
    pub fn clip_time(&self, index: u32, now: f64) -> Result<ClipTime, InputError> {
        self.time_of(&self.plays[index as usize], now)
    }

    fn time_of(&self, play: &Playing, now: f64) -> Result<ClipTime, InputError> {
        let duration = self.merged.model.clips[play.clip as usize].duration();
        let seconds = play.wrap.inside(duration, (now - play.start) * f64::from(play.rate))?;
        Ok(ClipTime { clip: play.clip as usize, seconds })
    }

    /// An instance's pose at scene time `now`, with the bones that the host wrote in the last frame.
    pub fn pose(&self, index: u32, now: f64) -> Result<Pose, InputError> {
        let mut pose = self.sampled(index, now)?;
        if let Some(written) = self.driven.written.get(&index) {
            written.iter().for_each(|(bone, local)| pose.locals[*bone] = *local);
            pose.model_matrices = local_to_model(&self.merged.model.skeleton, &pose.locals);
        }
        Ok(pose)
    }

    /// An instance's pose at scene time `now`, computed only from its clip and layers.
    pub fn sampled(&self, index: u32, now: f64) -> Result<Pose, InputError> {
        let ClipTime { clip, seconds } = self.clip_time(index, now)?;
        let above = self.layers.iter().map(|layer| {
            let (play, weight) = (&layer.plays[index as usize], layer.weights[index as usize].at(now));
            let ClipTime { clip, seconds } = self.time_of(play, now)?;
            Ok((clip, seconds, weight, &layer.mask))
        });
        let above = above.collect::<Result<Vec<_>, InputError>>()?;
        Ok(layered_pose(&self.merged.model, clip, seconds, above.into_iter()))
    }

    /// The low and the high corner of a box around a posed instance, in the target space of `placed`. All vertices that
    /// follow a bone lie in a sphere around the bone's origin. The bone's matrix turns this sphere into an ellipsoid, which the
    /// box encloses.
    pub fn bounds(&self, pose: &Pose, placed: DAffine3) -> [DVec3; 2] {
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for (matrix, radius) in pose.model_matrices.iter().zip(&self.radii) {
            let Some(radius) = radius else { continue };
            let DAffine3 { matrix3, translation } = placed * affine_of(matrix);
            let rows = [0, 1, 2].map(|axis| matrix3.row(axis).length());
            let half = f64::from(*radius) * DVec3::from(rows);
            low = low.min(translation - half);
            high = high.max(translation + half);
        }
        [low, high]
    }

    /// The surface of each mesh of an instance in full detail, in the pose at scene time `now`.
    pub(super) fn posed_surfaces(&self, index: u32, now: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let (ClipTime { clip, seconds }, pose) = (self.clip_time(index, now)?, self.pose(index, now)?);
        let model = &self.merged.model;
        let of_mesh = |(at, mesh): (usize, &crate::asset::Mesh)| {
            let palette = palette_for(&model.skins[mesh.skin], &pose.model_matrices, Blend::Linear);
            let morphed = morph(mesh, &mesh.weights_at(clip, seconds));
            let vertices = skin(&morphed, &mesh.influences, &palette, InstanceLod::FULL);
            let positions: Vec<_> = vertices.iter().map(|vertex| vertex.position).collect();
            Surface::of_merged(&self.merged, at, positions)
        };
        Ok(model.meshes.iter().enumerate().map(of_mesh).collect())
    }

    /// The dispatch arguments of each chunk: one buffer for sampling bones, then one per mesh for skinning clusters. The
    /// fourth word of a buffer is the number of bones or clusters.
    pub fn counters(&self) -> impl Iterator<Item = &Buffer<u32>> {
        self.runtimes.iter().flat_map(|runtime| {
            let clusters = runtime.skins.iter().map(PagedSkin::dispatched);
            std::iter::once(&runtime.frame.active.pairs.dispatched).chain(clusters)
        })
    }

    /// The number of meshes, and the number of chunks.
    pub fn counted(&self) -> [usize; 2] {
        [self.merged.model.meshes.len(), self.runtimes.len()]
    }
}
