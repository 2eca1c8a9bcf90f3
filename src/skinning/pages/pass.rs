//! The GPU pass of `kernels/skinning/pages.wgsl`.

use super::{NO_PAGE, PageState};
use crate::Error;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::skinning::pages as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Uniform, pass};
use crate::shared::skinning::pages::PageParams;
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::clusters::CLUSTER;
use crate::skinning::vertex::Vertex;

impl SeenAs<PageState> for u32 {}

/// GPU buffers of the vertex pages that all instances of a mesh share.
#[derive(Debug, Clone)]
pub struct PageBuffers {
    /// The skinned vertices, 64 per page. If positions of the previous frame are kept, they follow: four floats per
    /// vertex, of which the fourth is unused.
    pub skinned: Buffer<Vertex>,
    /// The vertices of each page after morphing and before skinning. Empty if the mesh has no morph targets.
    pub morphed: Buffer<Vertex>,
    /// Offset of the positions of the previous frame in `skinned`, in units of two floats; 0 if they are not kept.
    pub last: u32,
    /// The page of each cluster of each instance, at index `instance · clusters + cluster`, or [`NO_PAGE`].
    pub table: Buffer<u32>,
    /// Number of pages that each instance holds. They belong to its first clusters.
    pub held: Buffer<u32>,
    /// Free pages, as a stack: the last entry is assigned first.
    pub stack: Buffer<u32>,
    /// Two words: the number of free pages, and the number of instances that lacked a page in the last frame.
    pub state: Buffer<u32>,
}

impl PageBuffers {
    /// Allocates `pages` pages, all of them free.
    ///
    /// # Errors
    /// [`GpuError`] if a buffer cannot be allocated.
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd, pages: u32) -> Result<Self, GpuError> {
        let vertices = CLUSTER * pages as usize;
        Self::with_room(gpu, mesh, crowd, pages, vertices)
    }

    /// Allocates `pages` free pages. `room` is the length of `skinned` in vertices, including the previous positions.
    fn with_room(
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: u32,
        room: usize,
    ) -> Result<Self, GpuError> {
        let stack: Vec<u32> = (0..pages).rev().collect();
        let entries = crowd.instances * mesh.clusters();
        let morphed = if mesh.targets == 0 { 0 } else { CLUSTER * pages as usize };
        Ok(Self {
            skinned: Buffer::new(gpu, "pages of vertices", room)?,
            morphed: Buffer::new(gpu, "pages of morphed vertices", morphed)?,
            last: 0,
            table: Buffer::from_slice(gpu, "page table", &vec![NO_PAGE; entries])?,
            held: Buffer::new(gpu, "pages held", crowd.instances)?,
            stack: Buffer::from_slice(gpu, "free pages", &stack)?,
            state: Buffer::from_slice(gpu, "page state", &[pages, 0])?,
        })
    }

    /// As [`PageBuffers::new`], plus memory for the vertex positions of the previous frame.
    ///
    /// # Errors
    /// [`GpuError`] if a buffer cannot be allocated.
    pub fn keeping(
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: u32,
    ) -> Result<Self, GpuError> {
        let vertices = CLUSTER * pages as usize;
        // A previous position takes four floats; the buffer is counted in vertices of ten floats.
        let room = vertices + (4 * vertices).div_ceil(10);
        Ok(Self { last: 5 * vertices as u32, ..Self::with_room(gpu, mesh, crowd, pages, room)? })
    }

    /// Number of pages, free or assigned.
    pub fn pages(&self) -> usize {
        self.stack.len()
    }
}

pass! {
    /// GPU pass that assigns pages to visible instances.
    pub struct PagesPass;
}

impl PagesPass {
    /// Prepares the page assignment of a crowd. The levels of detail of the instances decide how many pages are needed.
    /// Record the job before [`select`](crate::skinning::select) and [`skin`](crate::skinning::skin).
    ///
    /// # Errors
    /// [`crate::InputError`] if the buffers belong to another crowd; [`GpuError`] from the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: &PageBuffers,
    ) -> Result<Job, Error> {
        crowd.instance_lods.check_holds("crowd.instance_lods", crowd.instances)?;
        pages.held.check_holds("pages.held", crowd.instances)?;
        pages.table.check_holds("pages.table", crowd.instances * mesh.clusters())?;
        let params = PageParams {
            instances: crowd.instances as u32,
            clusters: mesh.clusters() as u32,
            levels: mesh.clusters_of_levels(),
        };
        let uniform = Uniform::new(gpu, "pages", &params)?;
        let group = bindings::Group {
            params: &uniform,
            instance_lods: crowd.instance_lods.slice(),
            held: pages.held.slice(),
            table: pages.table.slice(),
            stack: pages.stack.slice(),
            state: pages.state.slice().cast(),
        };
        // One workgroup processes all instances.
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "skinning/pages", &self.kernel, group, 1)?)
    }
}
