//! Device buffers of a view: lists of visible instances, and their draws.

use super::attached::AttachedJobs;
use super::budget::{self, Budget};
use crate::Error;
use crate::asset::Affine;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Job, Uniform};
use crate::lod::budget::{BudgetPass, BudgetStages};
use crate::lod::decide::{DecideBuffers, DecidePass};
use crate::lod::list::{ListBuffers, ListPass};
use crate::lod::select::{SelectBuffers, SelectPass};
use crate::lod::sorted::{SortedBuffers, SortedPass};
use crate::lod::{BudgetState, OBJECT_LISTS, SelectView};
use crate::scene::handles::Slots;
use crate::scene::layout::Layout;
use crate::scene::layouts::{InstancesInView, SceneLayouts};
use crate::scene::object::Object;
use crate::scene::object_kind::KindInView;
use crate::scene::order::Ordered;
use crate::shared::lod::object::SceneDraw;
use crate::shared::render::scene_view::SceneView;

/// The compute passes from which a view's jobs are prepared.
#[derive(Debug, Clone, Copy)]
pub(in crate::scene) struct ViewPasses<'a> {
    pub select: &'a SelectPass,
    pub decide: &'a DecidePass,
    pub budget: &'a BudgetPass,
    pub list: &'a ListPass,
    pub sorted: &'a SortedPass,
}

/// The uniforms, the sun's shadow map and the budget that a view's lists bind.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundByView<'a> {
    pub select: &'a Uniform<SelectView>,
    pub drawn: &'a Uniform<SceneView>,
    pub map: Option<&'a wgpu::TextureView>,
    pub budget: Option<&'a Budget>,
}

/// Draws of transparent surfaces, one for each instance and part, and the job that writes them.
#[derive(Debug)]
pub(crate) struct SortedLists {
    pub job: Job,
    pub draws: Buffer<SceneDraw>,
    /// For each draw, the list entry of its single instance.
    pub entries: Buffer<u32>,
}

/// Device buffers of a view, for one layout of the scene.
#[derive(Debug)]
pub(crate) struct ViewLists {
    pub version: u64,
    /// Lists of visible instances, which the draws refer to.
    pub lists: Buffer<u32>,
    /// Arguments of the indirect draws of all objects.
    pub arguments: Buffer<SceneDraw>,
    /// For each visible instance, the transform from model space to the corner of the view's cell. With motion history,
    /// a second half of the same length follows: the last frame's transforms of attached meshes.
    pub placements: Buffer<Affine>,
    /// For each instance, the view's decision in the last frame: its level of detail and its transition.
    last_decisions: Buffer<u32>,
    /// Bind group 0, with the view's uniforms and instances.
    pub group: Group,
    /// The sun's shadow map that `group` contains.
    map: Option<wgpu::TextureView>,
    /// For each object, the resources that its kind keeps per view.
    pub(in crate::scene) in_view: Vec<Option<Box<dyn KindInView>>>,
    /// For each object, the index of its first instance in the scene's instance buffers.
    pub(super) firsts: Vec<u32>,
    /// One bit per instance of the scene: whether the view may draw it.
    pub(super) shown: Buffer<u32>,
    /// Draws of transparent surfaces; `None` if the scene has none.
    pub sorted: Option<SortedLists>,
    /// The instances with transparent surfaces, sorted from back to front.
    pub order: Vec<Ordered>,
    pub(super) select: Job,
    pub(super) decide: Job,
    /// The stages of the budget, which run between `select` and `decide`; `None` without a budget.
    pub(super) budget: Option<BudgetStages>,
    /// The state of the budget, which `decide` reads. For a view without a budget, the buffer holds a state that makes
    /// no level coarser.
    pub(super) budget_state: Buffer<BudgetState>,
    pub(super) list: Job,
    pub(super) attached: AttachedJobs,
}

impl ViewLists {
    pub(super) fn new(
        gpu: &Gpu,
        layout: &Layout,
        layouts: &SceneLayouts,
        objects: &Slots<Object>,
        passes: ViewPasses<'_>,
        bound: BoundByView<'_>,
    ) -> Result<Self, Error> {
        let BoundByView { select: view, drawn, map, budget } = bound;
        let instances = layout.instances.len();
        let decisions = Buffer::new(gpu, "decisions", instances)?;
        let metrics = Buffer::new(gpu, "metrics", instances)?;
        let counts = Buffer::new(gpu, "counts of blocks", (OBJECT_LISTS * layout.blocks) as usize)?;
        let budget_state = match budget {
            Some(budget) => budget.state.clone(),
            None => Buffer::from_slice(gpu, "no budget", &[BudgetState::FREE])?,
        };
        let last_decisions = Buffer::new(gpu, "decisions of the last frame", instances)?;
        let frames = if layout.keeps_last { 2 } else { 1 };
        let placements = Buffer::new(gpu, "placements in the view", frames * instances)?;
        let lists = Buffer::new(gpu, "lists of instances", layout.list_words as usize)?;
        let arguments = Buffer::from_slice(gpu, "draws", &layout.draws)?;
        let shown = Buffer::from_slice(gpu, "instances shown", &vec![u32::MAX; layout.instances.len() / 32])?;
        let buffers = SelectBuffers {
            view,
            objects: &layout.objects,
            block_objects: &layout.block_objects,
            instances: &layout.instances,
            allowed: &layout.allowed,
            metrics: &metrics,
            placements: &placements,
            decisions: &decisions,
            shown: &shown,
        };
        let select = passes.select.prepare(gpu, buffers)?;
        let buffers = DecideBuffers {
            view,
            objects: &layout.objects,
            block_objects: &layout.block_objects,
            metrics: &metrics,
            decisions: &decisions,
            last_decisions: &last_decisions,
            counts: &counts,
            finest: &layout.finest,
            budget: &budget_state,
        };
        let decide = passes.decide.prepare(gpu, buffers)?;
        let prepared =
            |of: &Budget| budget::prepared(gpu, layout, passes.budget, view, &metrics, &decisions, of);
        let budget = budget.map(prepared).transpose()?;
        let buffers = ListBuffers {
            objects: &layout.objects,
            block_objects: &layout.block_objects,
            decisions: &decisions,
            counts: &counts,
            lists: &lists,
            arguments: &arguments,
        };
        let list = passes.list.prepare(gpu, buffers, layout.object_count, layout.blocks)?;
        let instances = in_view(layout, &placements, &last_decisions);
        let group = layouts.view(gpu, drawn, &instances, map)?;
        let in_view = objects.iter().map(|object| object.kind.in_view(gpu, layouts, object.handle));
        Ok(Self {
            sorted: sorted(gpu, layout, passes.sorted, &decisions, &arguments)?,
            version: layout.version,
            lists,
            arguments,
            placements,
            last_decisions,
            group,
            map: map.cloned(),
            in_view: in_view.collect::<Result<_, Error>>()?,
            firsts: objects.iter().map(|object| object.chunks[0].range.first).collect(),
            shown,
            order: Vec::new(),
            select,
            decide,
            budget,
            budget_state,
            list,
            attached: AttachedJobs::default(),
        })
    }
}

impl ViewLists {
    /// Binds a sun's shadow map in `group`, unless that map is bound already.
    pub(super) fn bind_map(
        &mut self,
        gpu: &Gpu,
        layout: &Layout,
        layouts: &SceneLayouts,
        drawn: &Uniform<SceneView>,
        map: Option<&wgpu::TextureView>,
    ) -> Result<(), GpuError> {
        if self.map.as_ref() != map {
            let instances = in_view(layout, &self.placements, &self.last_decisions);
            self.group = layouts.view(gpu, drawn, &instances, map)?;
            self.map = map.cloned();
        }
        Ok(())
    }
}

fn in_view<'a>(
    layout: &'a Layout,
    placements: &'a Buffer<Affine>,
    last_decisions: &'a Buffer<u32>,
) -> InstancesInView<'a> {
    let Layout { instances, last_instances, .. } = layout;
    InstancesInView { placements, instances, last_instances, last_decisions }
}

/// The draws of transparent surfaces, and the job that writes them; `None` if the scene has none.
fn sorted(
    gpu: &Gpu,
    layout: &Layout,
    pass: &SortedPass,
    decisions: &Buffer<u32>,
    arguments: &Buffer<SceneDraw>,
) -> Result<Option<SortedLists>, Error> {
    let (sorted, count) = (&layout.sorted, layout.sorted.len());
    if count == 0 {
        return Ok(None);
    }
    let draws = Buffer::new(gpu, "draws of single instances", count)?;
    let entries = Buffer::new(gpu, "lists of one", count)?;
    let objects = &layout.objects;
    let buffers = SortedBuffers { sorted, decisions, arguments, draws: &draws, entries: &entries, objects };
    Ok(Some(SortedLists { job: pass.prepare(gpu, buffers, count as u32)?, draws, entries }))
}
