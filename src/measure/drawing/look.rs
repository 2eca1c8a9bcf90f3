//! One variant of a drawn crowd with its own vertices, and its measurements.

use super::{Animation, SKY, Variant};
use crate::Error;
use crate::gpu::Gpu;
use crate::measure::play::middle;
use crate::measure::vertices::{FrameCost, VertexMeter};
use crate::render::skinned::SkinnedScene;
use crate::render::target::Target;
use crate::skinning::frame::SkinFrame;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::lod::LodJob;
use crate::skinning::morph_weights::MorphWeightsJob;

/// A variant of animation and skinning, its own vertices, and its measurements so far.
pub(super) struct Look {
    pub variant: Variant,
    pub meshes: Vec<Drawable>,
    pub times: Times,
    pub errors: VertexMeter,
    /// Number of clusters that were skinned, and of all clusters.
    clusters: [u64; 2],
    /// Number of triangles that were drawn, and of all triangles.
    triangles: [u64; 2],
}

/// Times in nanoseconds, one per timed frame.
#[derive(Default)]
pub(super) struct Times {
    pub frame: Vec<f64>,
    pub compute: Vec<f64>,
    pub draw: Vec<f64>,
    pub skin: Vec<f64>,
}

/// A mesh of one look.
pub(super) struct Drawable {
    pub skin: SkinFrame,
    /// For each vertex of the mesh, its index among the vertices of an instance.
    pub slots: Vec<u32>,
    pub lod: LodJob,
    pub weights: MorphWeightsJob,
    pub scene: SkinnedScene,
}

impl Look {
    pub(super) fn new(variant: Variant, meshes: Vec<Drawable>) -> Self {
        Self {
            variant,
            meshes,
            times: Times::default(),
            errors: VertexMeter::default(),
            clusters: [0; 2],
            triangles: [0; 2],
        }
    }

    /// Records the skinning: palettes, the choice of clusters, and vertices.
    pub(super) fn skin(&self, encoder: &mut wgpu::CommandEncoder) {
        for mesh in &self.meshes {
            match self.variant.animation {
                Animation::Gated => mesh.skin.record_updated_bones(encoder),
                Animation::Full => mesh.skin.record_all(encoder),
            }
        }
    }

    /// Records the decisions before skinning: visibility and fade of each instance, and the weights of its
    /// morph targets.
    pub(super) fn decide(&self, encoder: &mut wgpu::CommandEncoder) {
        for mesh in &self.meshes {
            mesh.lod.record(encoder);
            mesh.weights.record(encoder);
        }
    }

    /// Records the decisions and the skinning.
    pub(super) fn compute(&self, encoder: &mut wgpu::CommandEncoder) {
        self.decide(encoder);
        self.skin(encoder);
    }

    pub(super) fn draw(&self, target: &Target, encoder: &mut wgpu::CommandEncoder) {
        target.record(encoder, SKY, |pass| self.meshes.iter().for_each(|mesh| mesh.scene.draw(pass)));
    }

    /// Reads back how many clusters and triangles of a mesh a frame used, and adds them up.
    pub(super) fn count(
        &mut self,
        gpu: &Gpu,
        mesh: usize,
        instance_lods: &[InstanceLod],
    ) -> Result<(), Error> {
        let skin = &self.meshes[mesh].skin;
        let seen = instance_lods.iter().filter(|instance_lod| instance_lod.max_influences > 0);
        let levels = seen.map(|instance_lod| skin.clusters.level(instance_lod.mesh_lod));
        let clusters = match self.variant.animation {
            Animation::Full => levels.clone().map(|level| level.clusters).sum(),
            Animation::Gated => skin.active.dispatched.read_blocking(gpu)?[3],
        };
        let drawn: u64 = levels.map(|level| u64::from(level.indices)).sum();
        let (all, full) = (skin.crowd.instances as u64, skin.clusters.level(0));
        let [clusters, triangles] =
            [[clusters.into(), all * u64::from(full.clusters)], [drawn, all * u64::from(full.indices)]];
        for (sums, found) in [(&mut self.clusters, clusters), (&mut self.triangles, triangles)] {
            *sums = [sums[0] + found[0], sums[1] + found[1]];
        }
        Ok(())
    }

    pub(super) fn cost(&self) -> FrameCost {
        let vertices: usize = self.meshes.iter().map(|mesh| mesh.skin.skinned.len()).sum();
        let Times { frame, compute, draw, skin } = &self.times;
        let [frame, compute, draw, skin] =
            [frame, compute, draw, skin].map(|times| middle(times.clone()).unwrap_or(0.0));
        let fraction = |[some, all]: [u64; 2]| some as f64 / all.max(1) as f64;
        FrameCost {
            frame_nanoseconds: frame,
            compute_nanoseconds: compute,
            draw_nanoseconds: draw,
            nanoseconds_per_vertex: skin / vertices as f64,
            skinned_fraction: fraction(self.clusters),
            triangle_fraction: fraction(self.triangles),
            vertex_error: self.errors.errors(),
        }
    }
}
