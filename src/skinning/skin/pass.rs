//! The GPU pass of `kernels/skinning/skin.wgsl`.

use std::ops::Range;

use crate::gpu::bindings::skinning::skin as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Group, IndirectJob, Job, Kernel, Step, Uniform, rows_of_workgroups};
use crate::shared::skinning::skin::SkinParams;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::{Blend, Vertex};
use crate::{Error, InputError};

/// Skins vertices.
#[derive(Debug, Clone)]
pub struct SkinPass {
    // Kernels for all clusters and for a list; each for the mesh's vertices and for morphed ones.
    kernels: [[Kernel; 2]; 2],
    /// Those that write pages, for the mesh's vertices and for morphed ones.
    paged: [Kernel; 2],
    blend: Blend,
}

/// Where vertices are written, and which.
#[derive(Clone, Copy)]
struct Output<'a> {
    skinned: &'a Buffer<Vertex>,
    /// Vertices before skinning, of meshes with morph targets.
    morphed: &'a Buffer<Vertex>,
    active: &'a ActiveClusters,
    /// Any buffer where vertices do not lie in pages.
    table: &'a Buffer<u32>,
    /// Where last positions begin, in pairs of floats; 0 if they are not kept.
    last: u32,
}

/// The prepared skinning of clusters that a kernel or the host selects.
pub type SkinActiveJob = IndirectJob;

impl SkinPass {
    /// Compiles the pipelines of a kind of blending.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, blend: Blend) -> Result<Self, GpuError> {
        let dual = blend == Blend::DualQuaternion;
        let kernels = |compacted, paged| {
            let kernel = |morphed| {
                let constants = bindings::Constants { compacted, dual, morphed, paged, keep: false };
                bindings::kernel(gpu, &constants)
            };
            Ok::<_, GpuError>([kernel(false)?, kernel(true)?])
        };
        Ok(Self {
            kernels: [kernels(false, false)?, kernels(true, false)?],
            paged: kernels(true, true)?,
            blend,
        })
    }

    /// Prepares the skinning of a range of instances into `skinned`, one instance after the other, in the order
    /// of the mesh's clusters. Instances that are not seen, and clusters beyond an instance's level of detail,
    /// keep their previous contents.
    ///
    /// # Errors
    /// [`InputError`] for a crowd of another mesh or kind of blending, for instances that it does not have, and
    /// for an output that is too small; [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        instances: Range<usize>,
        skinned: &Buffer<Vertex>,
    ) -> Result<Job, Error> {
        let nothing = ActiveClusters {
            pairs: Buffer::new(gpu, "no clusters", 0)?,
            keeps_last: false,
            dispatched: Buffer::from_slice(gpu, "no clusters", &[0; 4])?,
        };
        let kernel = self.kernel(false, mesh);
        let pairs = (instances.len() * mesh.clusters()) as u32;
        // One workgroup per pair of cluster and instance.
        skinned.check_holds("skinned", instances.len() * mesh.vertices.len())?;
        let morphed = morphed(mesh, crowd)?;
        let output = Output { skinned, morphed, active: &nothing, table: &nothing.pairs, last: 0 };
        let group = self.bind(gpu, kernel, (mesh, crowd), instances, output)?;
        let workgroups = rows_of_workgroups(gpu, pairs);
        let step = Step { groups: vec![group], workgroups, kernel: kernel.clone() };
        Ok(Job::new(gpu, "skinning/skin", vec![step])?)
    }

    /// Prepares the active clusters, as far as their instances are seen and the clusters are within the level
    /// of detail; all other vertices stay unchanged.
    ///
    /// # Errors
    /// As [`SkinPass::prepare`].
    pub fn prepare_active(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        skinned: &Buffer<Vertex>,
        active: &ActiveClusters,
    ) -> Result<SkinActiveJob, Error> {
        let kernel = self.kernel(true, mesh);
        skinned.check_holds("skinned", crowd.instances * mesh.vertices.len())?;
        let morphed = morphed(mesh, crowd)?;
        let output = Output { skinned, morphed, active, table: &active.pairs, last: 0 };
        let group = self.bind(gpu, kernel, (mesh, crowd), 0..crowd.instances, output)?;
        Ok(IndirectJob::new("skinning/skin", kernel, active.dispatched.raw(), vec![(group, 0)]))
    }

    /// As [`SkinPass::prepare_active`], into the pages that [`PagesPass`](crate::skinning::pages::PagesPass) deals out.
    /// Clusters without a page are skipped. If the pages have room for last positions ([`PageBuffers::keeping`]), each
    /// vertex's position is kept before it changes, or as it becomes, as the active clusters' states say.
    ///
    /// # Errors
    /// As [`SkinPass::prepare_active`]; [`InputError`] too where only one of pages and clusters keeps last positions.
    pub fn prepare_paged(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: &PageBuffers,
        active: &ActiveClusters,
    ) -> Result<SkinActiveJob, Error> {
        let keeps = pages.last > 0;
        if keeps != active.keeps_last {
            let bound = format!("must be {keeps}, as the pages have or lack last positions");
            return Err(InputError::new("active.keeps_last", active.keeps_last, bound).into());
        }
        let (morphed, dual) = (mesh.targets > 0, self.blend == Blend::DualQuaternion);
        let constants = bindings::Constants { compacted: true, dual, morphed, paged: true, keep: true };
        let kernel = match keeps {
            true => &bindings::kernel(gpu, &constants)?,
            false => &self.paged[usize::from(morphed)],
        };
        active.pairs.check_holds("active.pairs", active.words(crowd.instances * mesh.clusters()))?;
        pages.table.check_holds("pages.table", crowd.instances * mesh.clusters())?;
        let PageBuffers { skinned, morphed, table, last, .. } = pages;
        let output = Output { skinned, morphed, active, table, last: *last };
        let group = self.bind(gpu, kernel, (mesh, crowd), 0..crowd.instances, output)?;
        Ok(IndirectJob::new("skinning/skin", kernel, active.dispatched.raw(), vec![(group, 0)]))
    }

    fn kernel(&self, compacted: bool, mesh: &MeshBuffers) -> &Kernel {
        &self.kernels[usize::from(compacted)][usize::from(mesh.targets > 0)]
    }

    fn bind(
        &self,
        gpu: &Gpu,
        kernel: &Kernel,
        (mesh, crowd): (&MeshBuffers, &SkinnedCrowd),
        instances: Range<usize>,
        output: Output<'_>,
    ) -> Result<Group, Error> {
        if crowd.blend != self.blend {
            let bound = format!("must be {:?}, as the pass's", self.blend);
            return Err(InputError::new("crowd.blend", format!("{:?}", crowd.blend), bound).into());
        }
        if instances.is_empty() {
            return Err(InputError::new("instances.len", 0, "must be at least 1").into());
        }
        if instances.end > crowd.instances {
            let bound = format!("must be at most {}, the crowd's instances", crowd.instances);
            return Err(InputError::new("instances.end", instances.end, bound).into());
        }
        let vectors = if self.blend == Blend::Linear { 3 } else { 4 };
        crowd.palette.check_holds("crowd.palette", vectors * crowd.instances * mesh.bones.len())?;
        let vertices = if mesh.targets > 0 { output.morphed } else { &mesh.vertices };
        let params = SkinParams {
            vertices: mesh.vertices.len() as u32,
            pairs: (instances.len() * mesh.clusters()) as u32,
            bones: mesh.bones.len() as u32,
            instances: instances.len() as u32,
            first_instance: instances.start as u32,
            last: output.last,
            levels: mesh.clusters_of_levels(),
        };
        let uniform = Uniform::new(gpu, "skin", &params)?;
        let group = bindings::Group {
            params: &uniform,
            vertices: vertices.slice().cast(),
            influences: mesh.influences.slice(),
            palette: crowd.palette.slice(),
            instance_lods: crowd.instance_lods.slice(),
            pairs: output.active.pairs.slice(),
            dispatched: output.active.dispatched.slice().cast(),
            skinned: output.skinned.slice().cast(),
            page_table: output.table.slice(),
        };
        Ok(group.bind(gpu, kernel)?)
    }
}

/// The morphed vertices of a crowd, instance by instance.
fn morphed<'a>(mesh: &MeshBuffers, crowd: &'a SkinnedCrowd) -> Result<&'a Buffer<Vertex>, InputError> {
    let needed = if mesh.targets > 0 { crowd.instances * mesh.vertices.len() } else { 0 };
    crowd.morphed.check_holds("crowd.morphed", needed)?;
    Ok(&crowd.morphed)
}

/// Records a copy of the skinned vertices, before the next skinning changes them. Motion vectors need these
/// vertices of the frame before.
///
/// Instances that were not seen in the frame before have no vertices of that frame: their vertices keep the
/// positions of the frame in which they were last skinned.
/// [`SelectBuffers::skinned`](crate::skinning::select::SelectBuffers::skinned) says which instances these are.
/// The vertices beyond the level that an instance had are older too. `SelectBuffers::skinned` holds that level
/// until the next selection, so copy it at this point as well if you need it.
///
/// # Errors
/// [`InputError`] for buffers of different lengths.
pub fn keep_last(
    encoder: &mut wgpu::CommandEncoder,
    skinned: &Buffer<Vertex>,
    last: &Buffer<Vertex>,
) -> Result<(), InputError> {
    if skinned.len() != last.len() {
        let bound = format!("must be {}, as there are vertices", skinned.len());
        return Err(InputError::new("last.len", last.len(), bound));
    }
    encoder.copy_buffer_to_buffer(skinned.raw(), 0, last.raw(), 0, skinned.bytes());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Options;

    #[test]
    fn the_last_frame_is_kept() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let now: Vec<Vertex> =
            (0..5).map(|x| Vertex { position: [x as f32; 3], ..Vertex::default() }).collect();
        let skinned = Buffer::from_slice(&gpu, "skinned", &now).expect("uploaded");
        let last = Buffer::from_slice(&gpu, "last", &[Vertex::default(); 5]).expect("uploaded");
        let other = Buffer::new(&gpu, "other", 4).expect("allocated");
        let mut kept = Ok(());
        gpu.run("keep", |encoder| kept = keep_last(encoder, &skinned, &last)).expect("run");
        assert_eq!(kept, Ok(()));
        assert_eq!(last.read_blocking(&gpu).expect("read"), now);
        let refused = keep_last(&mut gpu.encoder("refused"), &skinned, &other).expect_err("refused");
        assert_eq!((&*refused.path, &*refused.value), ("last.len", "4"));
    }
}
