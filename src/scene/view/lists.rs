//! What a view sees of a scene, in buffers.

use super::attached::AttachedJobs;
use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Uniform};
use crate::lod::SelectView;
use crate::lod::list::{ListBuffers, ListPass};
use crate::lod::select::{SelectBuffers, SelectPass};
use crate::scene::layout::Layout;
use crate::scene::layouts::SceneLayouts;
use crate::shared::lod::object::SceneDraw;
use crate::shared::render::scene_terrain::TerrainView;
use crate::shared::render::scene_view::SceneView;

/// What a view sees, in buffers for one layout of the scene.
#[derive(Debug)]
pub(crate) struct ViewLists {
    pub version: u64,
    /// The lists of instances to draw.
    pub lists: Buffer<u32>,
    /// The draws of all objects.
    pub arguments: Buffer<SceneDraw>,
    /// For each instance that is seen, the rows of its transform from the model's space to the corner of the view's cell.
    pub rows: Buffer<[f32; 4]>,
    /// Bind group 0.
    pub group: Group,
    /// For each terrain, in the order of the objects, where its samples lie, and bind group 1.
    pub terrain: Vec<(Uniform<TerrainView>, Group)>,
    pub(super) select: Job,
    pub(super) list: Job,
    pub(super) attached: AttachedJobs,
}

impl ViewLists {
    pub(super) fn new(
        gpu: &Gpu,
        layout: &Layout,
        (view, drawn): (&Uniform<SelectView>, &Uniform<SceneView>),
        (select, list): (&SelectPass, &ListPass),
        (layouts, terrains): (&SceneLayouts, usize),
    ) -> Result<Self, Error> {
        let instances = layout.instances.len();
        let decisions = Buffer::new(gpu, "decisions", instances)?;
        let counts = Buffer::new(gpu, "counts of blocks", 16 * layout.blocks as usize)?;
        let rows = Buffer::new(gpu, "placements in the view", 3 * instances)?;
        let lists = Buffer::new(gpu, "lists of instances", layout.list_words as usize)?;
        let arguments = Buffer::from_slice(gpu, "draws", &layout.draws)?;
        let select = select.prepare(
            gpu,
            SelectBuffers {
                view,
                objects: &layout.objects,
                block_objects: &layout.block_objects,
                instances: &layout.instances,
                allowed: &layout.allowed,
                decisions: &decisions,
                rows: &rows,
                counts: &counts,
            },
        )?;
        let buffers = ListBuffers {
            objects: &layout.objects,
            block_objects: &layout.block_objects,
            decisions: &decisions,
            counts: &counts,
            lists: &lists,
            arguments: &arguments,
        };
        let list = list.prepare(gpu, buffers, layout.object_count, layout.blocks)?;
        let group = layouts.view(gpu, drawn, &rows, &layout.instances)?;
        let ground = || {
            let uniform = Uniform::new(gpu, "terrain in a view", &TerrainView::nowhere())?;
            let group = layouts.ground(gpu, &uniform)?;
            Ok((uniform, group))
        };
        let terrain = (0..terrains).map(|_| ground()).collect::<Result<_, GpuError>>()?;
        Ok(Self {
            version: layout.version,
            lists,
            arguments,
            rows,
            group,
            terrain,
            select,
            list,
            attached: AttachedJobs::default(),
        })
    }
}
