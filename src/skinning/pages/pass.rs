//! The GPU pass of `kernels/skinning/pages.wgsl`.

use super::{NO_PAGE, PageState};
use crate::Error;
use crate::gpu::bind::SeenAs;
use crate::gpu::bindings::skinning::pages as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Kernel, Uniform};
use crate::shared::skinning::pages::PageParams;
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::clusters::CLUSTER;
use crate::skinning::vertex::Vertex;

impl SeenAs<PageState> for u32 {}

/// The pages of all instances of a mesh on the device.
#[derive(Debug, Clone)]
pub struct PageBuffers {
    /// The skinned vertices, 64 per page. If last positions are kept, they follow: four floats per vertex, the last one
    /// unused.
    pub skinned: Buffer<Vertex>,
    /// The vertices before skinning, if the mesh has morph targets; else empty.
    pub morphed: Buffer<Vertex>,
    /// Index of the first last position in pairs of floats; 0 if none are kept.
    pub last: u32,
    /// The page of each cluster of each instance, at `instance · clusters + cluster`, or [`NO_PAGE`].
    pub table: Buffer<u32>,
    /// For each instance, the number of its clusters that have a page, counted from the first.
    pub held: Buffer<u32>,
    /// Free pages, as a stack: the last one is assigned first.
    pub stack: Buffer<u32>,
    /// The number of free pages, and of instances that went without a page.
    pub state: Buffer<u32>,
}

impl PageBuffers {
    /// Allocates `pages` free pages.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd, pages: u32) -> Result<Self, GpuError> {
        let vertices = CLUSTER * pages as usize;
        Self::with_room(gpu, mesh, crowd, pages, vertices)
    }

    /// Allocates `pages` free pages. `room` is the number of vertices in them and in the area of last positions.
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

    /// As [`PageBuffers::new`], plus the area of last positions.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn keeping(
        gpu: &Gpu,
        mesh: &MeshBuffers,
        crowd: &SkinnedCrowd,
        pages: u32,
    ) -> Result<Self, GpuError> {
        let vertices = CLUSTER * pages as usize;
        // Four floats per vertex, counted in vertices of ten floats.
        let room = vertices + (4 * vertices).div_ceil(10);
        Ok(Self { last: 5 * vertices as u32, ..Self::with_room(gpu, mesh, crowd, pages, room)? })
    }

    /// Number of pages.
    pub fn pages(&self) -> usize {
        self.stack.len()
    }
}

/// Assigns pages to visible instances.
#[derive(Debug, Clone)]
pub struct PagesPass {
    kernel: Kernel,
}

impl PagesPass {
    /// Compiles the pipeline.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self { kernel: bindings::kernel(gpu)? })
    }

    /// Prepares the page assignment of a crowd. Its levels of detail decide how many pages it needs. Record it before
    /// [`select`](crate::skinning::select) and [`skin`](crate::skinning::skin).
    ///
    /// # Errors
    /// [`crate::InputError`] for buffers of another crowd; [`GpuError`].
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
