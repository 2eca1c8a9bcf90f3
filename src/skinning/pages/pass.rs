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
    /// The skinned vertices, 64 a page. If last positions are kept, they follow: four floats for each vertex, of which the
    /// last is unused.
    pub skinned: Buffer<Vertex>,
    /// The same vertices before skinning, if the mesh has morph targets; else empty.
    pub morphed: Buffer<Vertex>,
    /// If last positions are kept, the index of the first of them in pairs of floats; else 0.
    pub last: u32,
    /// The page of each cluster of each instance, at `instance · clusters + cluster`, or [`NO_PAGE`].
    pub table: Buffer<u32>,
    /// For each instance the number of clusters, from the first on, that have a page.
    pub held: Buffer<u32>,
    /// The pages that nobody holds; the last of them is dealt out first.
    pub stack: Buffer<u32>,
    /// How many these are, and how many instances went without a page.
    pub state: Buffer<u32>,
}

impl PageBuffers {
    /// Allocates `pages` pages that nobody holds.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu, mesh: &MeshBuffers, crowd: &SkinnedCrowd, pages: u32) -> Result<Self, GpuError> {
        let vertices = CLUSTER * pages as usize;
        Self::with_room(gpu, mesh, crowd, pages, vertices)
    }

    /// With so many pages, and room for so many vertices in them and behind them.
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

    /// As [`PageBuffers::new`], with room for last positions.
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
        // Four floats a vertex, in vertices of ten.
        let room = vertices + (4 * vertices).div_ceil(10);
        Ok(Self { last: 5 * vertices as u32, ..Self::with_room(gpu, mesh, crowd, pages, room)? })
    }

    /// Number of pages.
    pub fn pages(&self) -> usize {
        self.stack.len()
    }
}

/// Deals out pages.
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

    /// Prepares the pages of a crowd, which need as many as its levels of detail say. Record it before
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
        // One workgroup serves all instances.
        let group = group.bind(gpu, &self.kernel)?;
        Ok(Job::spread(gpu, "skinning/pages", (&self.kernel, group), 1)?)
    }
}
