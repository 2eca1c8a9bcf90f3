//! The nodes of an endless terrain on the device: tiles of heights in a pool of fixed size, and the jobs that make them.

use std::ops::RangeInclusive;

use super::elevation::NodeElevation;
use super::eroded::{Cut, Erosion, ErosionJob, Source};
use super::hole::TerrainHole;
use crate::gpu::{Buffer, Gpu, Job, ReadbackRing, Staged, Upload as _};
use crate::scene::FRAMES_IN_FLIGHT;
use crate::scene::terrain::source::TerrainSource;
use crate::shared::render::scene_terrain::TerrainPatch;
use crate::terrain::config::TerrainConfig;
use crate::terrain::cover::TILES_PERIOD;
use crate::terrain::fixed::FeatureMode;
use crate::terrain::levels::{GivenHeights, lattice_region};
use crate::terrain::limit::ErosionLimit;
use crate::terrain::morph::{HeightMorphPass, Morph, MorphBuffers, MorphJob};
use crate::terrain::node::{NODE_FACTS, NODE_MARGIN, NodeBuffers, NodeFacts, NodePass, NodeShape};
use crate::terrain::node_normals::{NodeNormalsBuffers, NodeNormalsPass};
use crate::terrain::quadtree::Node;
use crate::terrain::recipe::Recipe;
use crate::terrain::regions::{HeightBuffers, HeightScratch, RegionJob, RegionPass};
use crate::terrain::remainder::remainder_reach;
use crate::terrain::replace::{ReplaceBuffers, ReplacePass};
use crate::terrain::window::{Region, Regions};
use crate::{Error, InputError};

/// Number of nodes in a batch.
pub(super) const BATCH: usize = 4;

/// Largest number of levels by which the heights from which a node is made are finer than the node. The node's deviation from them
/// is exact; what lies below is bounded.
const MOST_FINER: u32 = 3;

/// The same with an elevation map. Fewer levels need fewer tiles; these are the fewest with which a node's margin is as wide as
/// [`remainder_reach`].
const MOST_FINER_WITH_MAP: u32 = 2;

/// Largest number of cells along an edge of a node's finer heights, unless the node itself has more.
const MOST_CELLS: u32 = 512;

/// Largest number of iterations of erosion: each needs another sample around a node's.
const MOST_ITERATIONS: u32 = 128;

/// A slot that no batch writes.
const NO_SLOT: u32 = u32::MAX;

/// The tiles of nodes on the device.
#[derive(Debug)]
pub(super) struct Pool {
    /// Heights of the nodes, with a margin.
    pub tiles: Buffer<i32>,
    /// The node of each tile.
    pub patches: Buffer<TerrainPatch>,
    /// Holes of the nodes, one bit per vertex; for terrain that may have holes.
    pub holes: Buffer<u32>,
    /// Normals of the nodes at twice their resolution; none of those of level 0, which are the finest.
    pub normals: Buffer<u32>,
    pub size: PoolSize,
    ring: ReadbackRing<u64>,
    pub grid: Grid,
    pass: NodePass,
    /// `None` for nodes without normals, for which this pipeline is not compiled.
    normals_pass: Option<NodeNormalsPass>,
    heights: Buffer<i32>,
    /// Replaces generated heights by those of a map; `None` without a map.
    replace: Option<ReplacePass>,
    /// The heights of each recipe.
    ends: Vec<End>,
    /// Blends the heights of both recipes; `None` without a target.
    blend: Option<Blend>,
    /// The jobs of each kind and level, one for each of a frame's batches of this level.
    jobs: [Vec<Vec<BatchJob>>; 3],
    /// The batches of the frame.
    batches: Vec<Batch>,
}

/// The recipes of a terrain.
#[derive(Debug, Clone, Copy)]
pub(super) struct Recipes<'a> {
    pub own: &'a Recipe,
    /// The recipe towards which the heights move.
    pub target: Option<&'a Recipe>,
}

/// The heights of a recipe, and what makes them.
#[derive(Debug)]
struct End {
    generator: RegionPass,
    /// The mode in which the generator injects features.
    injection: Option<FeatureMode>,
    scratch: HeightScratch,
    /// Erodes the finest nodes; `None` without erosion.
    erosion: Option<Erosion>,
    tiles: Buffer<i32>,
    facts: Buffer<u32>,
}

/// The blend of the heights of two recipes, which is drawn.
#[derive(Debug)]
struct Blend {
    job: MorphJob,
    /// Whether the next frame must compute the blend.
    is_due: bool,
}

/// What the heights of a batch are made from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Heights {
    Generated,
    /// Those of a map, where it has any.
    Given,
    /// Those of the target.
    Target,
}

/// Nodes of one level that a frame makes, at most [`BATCH`].
#[derive(Debug, Clone)]
struct Batch {
    heights: Heights,
    level: usize,
    /// Number of the job among those of the level.
    job: usize,
    nodes: Vec<NewNode>,
    /// Where eroded heights come from.
    cut: Cut,
}

/// What a pool has memory for.
#[derive(Debug, Clone, Copy)]
pub(super) struct PoolSize {
    /// Number of tiles.
    pub capacity: usize,
    pub has_holes: bool,
    /// Whether nodes have normals of twice their resolution.
    pub has_normals: bool,
    /// Number of levels by which the elevation map is coarser than the terrain; `None` without a map.
    pub map: Option<u32>,
    /// The limit of erosion; `None` without erosion.
    pub erosion: Option<ErosionLimit>,
}

/// The jobs that make up to [`BATCH`] nodes of one level.
#[derive(Debug)]
struct BatchJob {
    heights: RegionJob,
    /// Number of features for which there is room.
    features: usize,
    given: Option<GivenJob>,
    slots: Buffer<u32>,
    nodes: Job,
    erosion: Option<ErodedNodes>,
    normals: Option<Job>,
}

/// Makes the eroded tiles of nodes.
#[derive(Debug)]
struct ErodedNodes {
    erosion: ErosionJob,
    /// Slots of the tiles and of their facts.
    slots: Buffer<u32>,
    nodes: Job,
}

/// Replaces heights of regions by those of a map, on the regions' own lattice.
#[derive(Debug)]
struct GivenJob {
    /// Finds the facts of the generated heights, and their slots. `None` for eroded nodes: nothing lies below their heights.
    generated: Option<(Job, Buffer<u32>)>,
    heights: Buffer<i32>,
    replace: Job,
}

/// A node to make, and its tile.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NewNode {
    pub node: Node,
    pub slot: u32,
    /// What a map gives to the node; `None` where no map reaches.
    pub elevation: Option<NodeElevation>,
}

/// Facts about a node's heights, which one recipe makes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FoundFacts {
    pub own: NodeFacts,
    /// The facts of the heights that are generated without the map, where they count, or of the eroded ones.
    pub other: Option<NodeFacts>,
}

/// The nodes into which a terrain is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grid {
    /// Number of cells along an edge of a node, a power of two.
    pub cells: u32,
    /// Level of the coarsest nodes: they cover one cell of the base lattice.
    pub top: u32,
    /// Largest number of levels by which the heights from which nodes are made are finer.
    most_finer: u32,
}

impl Grid {
    /// The nodes of `node_size` samples of a configuration.
    ///
    /// # Errors
    /// [`InputError`] for a size that is not 2^n + 1, out of bounds, or larger than a cell of the base lattice.
    pub fn new(config: &TerrainConfig, node_size: u32, has_map: bool) -> Result<Self, InputError> {
        let cells = node_size.saturating_sub(1);
        let is_size = cells.is_power_of_two() && (8..=256).contains(&cells);
        InputError::check(
            is_size,
            "node_size",
            node_size,
            || "must be 2^n + 1 with n in 3..=8 (9, 17, … 257)",
        )?;
        let most = config.levels();
        let bound = || {
            format!(
                "must be at most {}, the samples between two points of the base lattice",
                (1_u64 << most) + 1
            )
        };
        InputError::check(cells.ilog2() <= most, "node_size", node_size, bound)?;
        let most_finer = if has_map { MOST_FINER_WITH_MAP } else { MOST_FINER };
        Ok(Self { cells, top: most - cells.ilog2(), most_finer })
    }

    /// The shape of the nodes of a level. The heights from which they are made are up to `most_finer` levels finer.
    pub fn shape(self, level: u32) -> NodeShape {
        let finer = (MOST_CELLS / self.cells).max(1).ilog2().min(self.most_finer).min(level);
        NodeShape { size: self.cells + 1, finer }
    }

    /// The first sample of the region of finer heights of a node.
    pub fn first_of(self, node: Node) -> [i64; 2] {
        let (cells, finer) = (i64::from(self.cells), self.shape(node.level).finer);
        node.at.map(|at| (i64::from(at) * cells - i64::from(NODE_MARGIN)) << finer)
    }

    /// The region of finer heights of a node.
    pub fn region_of(self, node: Node) -> Region {
        let width = self.shape(node.level).region_width();
        Region { first: self.first_of(node), width, coarser: self.coarser(node.level) }
    }

    /// Columns and rows of the cells of a node's region, without the margin.
    pub fn cells_of(self, node: Node) -> [RangeInclusive<i64>; 2] {
        let cells = i64::from(self.cells) << self.shape(node.level).finer;
        node.at.map(|at| i64::from(at) * cells..=(i64::from(at) + 1) * cells - 1)
    }

    /// Number of words of a node's holes.
    pub fn hole_words(self) -> usize {
        (self.cells as usize + 1).pow(2).div_ceil(32)
    }

    /// Whether nodes of a level are eroded: those that are made from heights of the terrain's own resolution.
    pub fn is_eroded(self, size: PoolSize, level: u32) -> bool {
        size.erosion.is_some() && self.coarser(level) == 0
    }

    /// Number of levels by which the finer heights of a node of a level are coarser than the terrain.
    pub fn coarser(self, level: u32) -> u32 {
        level - self.shape(level).finer
    }
}

impl PoolSize {
    /// Number of rows of facts. The second half is about the heights without a map, or about eroded heights.
    fn rows(&self) -> usize {
        if self.map.is_some() || self.erosion.is_some() { 2 * self.capacity } else { self.capacity }
    }
}

impl<'a> Recipes<'a> {
    /// The recipes of a source, whose own recipe has become `own`.
    pub fn new(own: &'a Recipe, source: &'a TerrainSource) -> Self {
        Self { own, target: source.target.as_ref().map(|(target, _)| &**target) }
    }

    /// The own recipe, then the target's.
    pub fn all(self) -> impl Iterator<Item = &'a Recipe> {
        [Some(self.own), self.target].into_iter().flatten()
    }

    /// The recipe of the heights of a kind.
    fn of(self, kind: Heights) -> &'a Recipe {
        self.target.filter(|_| kind == Heights::Target).unwrap_or(self.own)
    }
}

impl Heights {
    /// The place of their recipe among a pool's ends.
    fn end(self) -> usize {
        usize::from(self == Self::Target)
    }
}

impl Pool {
    /// Allocates a pool.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn new(gpu: &Gpu, recipes: Recipes<'_>, grid: Grid, size: PoolSize) -> Result<Self, Error> {
        let PoolSize { capacity, has_holes, has_normals, map, .. } = size;
        let width = (0..=grid.top).map(|level| grid.shape(level).region_width()).max().unwrap_or(0);
        let words = size.rows() * NODE_FACTS as usize;
        let most = if size.erosion.is_some() { 2 * capacity } else { capacity };
        let tiles = || Buffer::new(gpu, "terrain nodes", most * (grid.shape(0).tile_width() as usize).pow(2));
        let end = |recipe: &Recipe| -> Result<End, Error> {
            // The widest regions with the most subdivisions need the largest scratch.
            let regions = Regions { count: BATCH as u32, width: width + 2 * recipe.apron(0), coarser: 0 };
            let erosion = |limit| Erosion::new(gpu, recipe, limit, grid, regions);
            let injection = recipe.features.injection();
            Ok(End {
                generator: RegionPass::new(gpu, &recipe.config, injection)?,
                injection,
                scratch: HeightScratch::for_regions(gpu, &recipe.config, regions)?,
                erosion: size.erosion.map(erosion).transpose()?,
                tiles: tiles()?,
                facts: Buffer::new(gpu, "facts of nodes", words)?,
            })
        };
        let ends = recipes.all().map(end).collect::<Result<Vec<_>, _>>()?;
        let drawn = if ends.len() > 1 { tiles()? } else { ends[0].tiles.clone() };
        let blend = |target: &End| -> Result<Blend, Error> {
            let buffers = MorphBuffers { from: &ends[0].tiles, to: &target.tiles, heights: &drawn };
            Ok(Blend { job: HeightMorphPass::new(gpu)?.prepare(gpu, buffers)?, is_due: false })
        };
        let blend = ends.get(1).map(blend).transpose()?;
        let read = 4 * (words * ends.len()) as u64;
        Ok(Self {
            tiles: drawn,
            patches: Buffer::new(gpu, "patches", capacity)?,
            holes: Buffer::new(
                gpu,
                "holes of nodes",
                if has_holes { capacity * grid.hole_words() } else { 1 },
            )?,
            ring: ReadbackRing::new(gpu, "facts of nodes", FRAMES_IN_FLIGHT, read)?,
            pass: NodePass::new(gpu)?,
            normals_pass: has_normals.then(|| NodeNormalsPass::new(gpu)).transpose()?,
            normals: Buffer::new(
                gpu,
                "normals of nodes",
                if has_normals { capacity * (grid.shape(0).normals_width() as usize).pow(2) } else { 1 },
            )?,
            heights: Buffer::new(gpu, "finer heights", BATCH * (width as usize).pow(2))?,
            replace: map.map(|_| ReplacePass::new(gpu)).transpose()?,
            size,
            grid,
            ends,
            blend,
            jobs: [(); 3].map(|()| (0..=grid.top).map(|_| Vec::new()).collect()),
            batches: Vec::new(),
        })
    }

    /// The facts of all tiles, and the number of the frame after which they were copied; `None` if none have arrived.
    /// Facts of a tile are those of the own recipe's heights and of the target's; without a target, twice the former.
    pub fn arrived(&mut self) -> Option<(u64, Vec<Option<[FoundFacts; 2]>>)> {
        let (frame, bytes) = self.ring.take()?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        let rows = words.as_chunks::<{ NODE_FACTS as usize }>().0;
        let found = |end: usize, slot: usize| {
            let rows = rows.chunks(self.size.rows()).nth(end)?;
            let facts = |row: usize| NodeFacts::from_words(*rows.get(row)?);
            Some(FoundFacts { own: facts(slot)?, other: facts(self.size.capacity + slot) })
        };
        let last = self.ends.len() - 1;
        let found = (0..self.size.capacity).map(|slot| Some([found(0, slot)?, found(last, slot)?]));
        Some((frame, found.collect()))
    }

    /// Forgets readbacks that have not arrived.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn invalidate(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.batches.clear();
        self.forget_eroded(|_| true);
        Ok(self.ring.invalidate(gpu)?)
    }

    /// Prepares the jobs that make nodes in this frame.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn make(&mut self, gpu: &Gpu, recipes: Recipes<'_>, new: &[NewNode]) -> Result<(), Error> {
        self.batches.clear();
        if let Some(blend) = &mut self.blend {
            blend.is_due |= !new.is_empty();
        }
        let (own, Recipe { config, features, .. }) = (&mut self.ends[0], recipes.own);
        if own.injection != features.injection() {
            own.generator = RegionPass::new(gpu, config, features.injection())?;
            own.injection = features.injection();
            self.jobs.iter_mut().flatten().for_each(Vec::clear);
            own.erosion.iter_mut().for_each(Erosion::forget_jobs);
        }
        self.erosions().for_each(Erosion::begin);
        let kinds = [Heights::Generated, Heights::Given, Heights::Target];
        for (level, kind) in
            (0..=self.grid.top as usize).flat_map(|level| kinds.map(|heights| (level, heights)))
        {
            let is_own = |new: &&NewNode| {
                let is_of_kind = match kind {
                    Heights::Generated => new.elevation.is_none(),
                    Heights::Given => new.elevation.is_some(),
                    Heights::Target => self.blend.is_some(),
                };
                new.node.level as usize == level && is_of_kind
            };
            let own: Vec<NewNode> = new.iter().filter(is_own).cloned().collect();
            for (job, nodes) in own.chunks(BATCH).enumerate() {
                let recipe = recipes.of(kind);
                if self.jobs[kind as usize][level].len() <= job {
                    let made = self.job(gpu, &recipe.config, level as u32, kind, 0)?;
                    self.jobs[kind as usize][level].push(made);
                }
                let firsts: Vec<[i64; 2]> = nodes.iter().map(|new| self.grid.first_of(new.node)).collect();
                let BatchJob { heights, features: room, erosion, .. } = &self.jobs[kind as usize][level][job];
                let eroded = erosion.as_ref().zip(self.ends[kind.end()].erosion.as_ref());
                let around = eroded.map_or(0, |(eroded, erosion)| {
                    eroded.erosion.feature_count(erosion, nodes, &recipe.features)
                });
                let needed = heights.feature_count(&firsts, &recipe.features).max(around);
                if needed > *room {
                    let room = needed.next_power_of_two();
                    self.jobs[kind as usize][level][job] =
                        self.job(gpu, &recipe.config, level as u32, kind, room)?;
                }
                let cut = self.cut(gpu, recipe, kind, nodes)?;
                self.batches.push(Batch { heights: kind, level, job, nodes: nodes.to_vec(), cut });
            }
        }
        Ok(())
    }

    /// Where the eroded heights of a batch come from.
    fn cut(
        &mut self,
        gpu: &Gpu,
        Recipe { config, features, .. }: &Recipe,
        kind: Heights,
        nodes: &[NewNode],
    ) -> Result<Cut, Error> {
        let map = given_by(self.size, self.replace.as_ref(), kind);
        let End { generator, scratch, erosion, .. } = &mut self.ends[kind.end()];
        let source = Source { generator, scratch, config, features: 0, map };
        let cut = erosion.as_mut().map(|erosion| erosion.cut(gpu, nodes, source, features));
        cut.unwrap_or(Ok(Cut::default()))
    }

    /// The region that is generated and eroded for a node; `None` for a node that is not eroded.
    pub fn around(&self, node: Node) -> Option<Region> {
        let erosion = self.ends[0].erosion.as_ref();
        let erosion = erosion.filter(|_| self.grid.is_eroded(self.size, node.level))?;
        Some(erosion.around(node))
    }

    /// Forgets the eroded ground whose region is changed.
    pub fn forget_eroded(&mut self, is_changed: impl Fn(Region) -> bool) {
        self.erosions().for_each(|erosion| erosion.forget(&is_changed));
    }

    fn erosions(&mut self) -> impl Iterator<Item = &mut Erosion> {
        self.ends.iter_mut().filter_map(|end| end.erosion.as_mut())
    }

    /// Makes the next frame blend the heights again, at another time.
    pub fn blend_again(&mut self) {
        if let Some(blend) = &mut self.blend {
            blend.is_due = true;
        }
    }

    fn job(
        &self,
        gpu: &Gpu,
        config: &TerrainConfig,
        level: u32,
        kind: Heights,
        features: usize,
    ) -> Result<BatchJob, Error> {
        let shape = self.grid.shape(level);
        let (count, width, coarser) = (BATCH as u32, shape.region_width(), self.grid.coarser(level));
        let regions = Regions { count, width, coarser };
        let slots = Buffer::new(gpu, "slots of nodes", BATCH)?;
        let End { generator, scratch, erosion, tiles, facts, .. } = &self.ends[kind.end()];
        let facts_of = |slots: &Buffer<u32>| {
            let heights = &self.heights;
            self.pass.prepare(gpu, shape, count, NodeBuffers { heights, slots, tiles, facts })
        };
        let output = HeightBuffers { output: &self.heights, scratch };
        let map = given_by(self.size, self.replace.as_ref(), kind);
        // A map that is coarser than the regions gives heights of a coarser lattice, from which theirs follow.
        let (lattice, own) =
            (map.filter(|map| map.coarser > coarser), map.filter(|map| map.coarser <= coarser));
        let heights = generator.prepare_regions(gpu, config, regions, features, output, lattice)?;
        let given = |GivenHeights { pass, .. }: GivenHeights<'_>| -> Result<GivenJob, Error> {
            let generated = || -> Result<_, Error> {
                let slots = Buffer::new(gpu, "slots of generated heights", BATCH)?;
                Ok((facts_of(&slots)?, slots))
            };
            let generated = (!self.grid.is_eroded(self.size, level)).then(generated).transpose()?;
            let (heights, replace) = replaced(gpu, pass, BATCH as u32, width, &self.heights)?;
            Ok(GivenJob { generated, heights, replace })
        };
        let given = own.map(given).transpose()?;
        let nodes = facts_of(&slots)?;
        let eroded = |erosion: &Erosion| -> Result<_, Error> {
            let source = Source { generator, scratch, config, features, map };
            let erosion = erosion.prepare(gpu, level, source, &self.heights)?;
            let slots = Buffer::new(gpu, "slots of eroded nodes", BATCH)?;
            let buffers = NodeBuffers { heights: &erosion.heights, slots: &slots, tiles, facts };
            let nodes = self.pass.prepare(gpu, shape, count, buffers)?;
            Ok(ErodedNodes { erosion, slots, nodes })
        };
        let erosion = erosion.as_ref().filter(|_| coarser == 0).map(eroded).transpose()?;
        let normals = |pass: &NodeNormalsPass| {
            let heights = erosion.as_ref().map_or(&self.heights, |eroded| &eroded.erosion.heights);
            let buffers = NodeNormalsBuffers { heights, slots: &slots, normals: &self.normals };
            let spacing = config.terrain_scale * f64::from(1_u32 << coarser);
            pass.prepare(gpu, shape, spacing, count, buffers)
        };
        let normals = self.normals_pass.as_ref().filter(|_| shape.finer > 0).map(normals).transpose()?;
        Ok(BatchJob { heights, features, given, slots, nodes, erosion, normals })
    }

    /// Stages what the jobs of the frame read, and the patches of new nodes.
    ///
    /// # Errors
    /// [`InputError`] for a node beyond the world; [`crate::gpu::GpuError`].
    pub fn stage(
        &self,
        staged: &mut Staged,
        recipes: Recipes<'_>,
        time: Morph,
        holes: &[TerrainHole],
    ) -> Result<(), Error> {
        if let Some(blend) = self.blend.as_ref().filter(|blend| blend.is_due) {
            blend.job.set_through(staged, time)?;
        }
        for Batch { heights, level, job, nodes, cut } in &self.batches {
            let job = &self.jobs[*heights as usize][*level][*job];
            let (end, Recipe { config, features, .. }) = (&self.ends[heights.end()], recipes.of(*heights));
            let (mut slots, mut generated) = ([NO_SLOT; BATCH], [NO_SLOT; BATCH]);
            for ((slot, generated), new) in slots.iter_mut().zip(&mut generated).zip(nodes) {
                (*slot, *generated) = (new.slot, self.size.capacity as u32 + new.slot);
            }
            staged.elements(&job.slots, 0, &slots)?;
            let firsts: Vec<[i64; 2]> = nodes.iter().map(|new| self.grid.first_of(new.node)).collect();
            job.heights.set_regions(staged, &firsts, features)?;
            if let Some((_, slots)) = job.given.as_ref().and_then(|given| given.generated.as_ref()) {
                staged.elements(slots, 0, &generated)?;
            }
            if let (Some(job), Some(erosion)) = (&job.erosion, &end.erosion) {
                staged.elements(&job.slots, 0, &generated)?;
                erosion.stage(staged, &job.erosion, cut, nodes, features)?;
            }
            for (number, new) in nodes.iter().enumerate() {
                let Some(NodeElevation { heights, .. }) = &new.elevation else { continue };
                match &job.given {
                    Some(given) => staged.elements(&given.heights, number * heights.len(), heights)?,
                    None => job.heights.stage_given(staged, number, heights)?,
                }
            }
            let none = [0; NODE_FACTS as usize];
            for new in nodes {
                if *heights != Heights::Target {
                    self.stage_patch(staged, config, new.node, new.slot, holes)?;
                }
                for row in (new.slot as usize..self.size.rows()).step_by(self.size.capacity) {
                    staged.elements(&end.facts, row * NODE_FACTS as usize, &none)?;
                }
            }
        }
        Ok(())
    }

    /// The region whose heights a map gives to a region of a node.
    pub fn given_region(&self, config: &TerrainConfig, own: Region) -> Region {
        match self.size.map.filter(|map| *map > own.coarser) {
            Some(map) => lattice_region(config, own, map),
            None => own,
        }
    }

    /// Stages the patch of a node, and its holes.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn stage_patch(
        &self,
        staged: &mut Staged,
        config: &TerrainConfig,
        node: Node,
        slot: u32,
        holes: &[TerrainHole],
    ) -> Result<(), Error> {
        let mut patch = patch_of(config, self.grid, node, slot);
        if self.grid.is_eroded(self.size, node.level) {
            patch.eroded = self.size.capacity as u32 + slot;
        }
        if let Some(words) = hole_bits(config, self.grid, node, holes) {
            let first = slot as usize * words.len();
            staged.elements(&self.holes, first, &words)?;
            patch.holes = first as u32 + 1;
        }
        Ok(staged.elements(&self.patches, slot as usize, &[patch])?)
    }

    /// Records the jobs of the frame; if `reads_facts`, also a copy of all facts to the host.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64, reads_facts: bool) {
        for Batch { heights, level, job, cut, .. } in self.batches.drain(..) {
            let job = &self.jobs[heights as usize][level][job];
            job.heights.record(encoder);
            if let Some(given) = &job.given {
                given.generated.iter().for_each(|(generated, _)| generated.record(encoder));
                given.replace.record(encoder);
            }
            job.nodes.record(encoder);
            let erosion = self.ends[heights.end()].erosion.as_ref();
            if let Some((eroded, erosion)) = job.erosion.as_ref().zip(erosion) {
                erosion.record(encoder, &eroded.erosion, &cut);
                eroded.nodes.record(encoder);
            }
            job.normals.iter().for_each(|normals| normals.record(encoder));
        }
        if let Some(blend) = &mut self.blend
            && std::mem::take(&mut blend.is_due)
        {
            blend.job.record(encoder);
        }
        if reads_facts {
            let all = &self.ends;
            self.ring.record(encoder, frame, |encoder, to| {
                let mut at = 0;
                for End { facts, .. } in all {
                    let bytes = 4 * facts.len() as u64;
                    encoder.copy_buffer_to_buffer(facts.raw(), 0, to, at, bytes);
                    at += bytes;
                }
            });
        }
    }
}

/// The map that gives heights to batches of a kind.
fn given_by(size: PoolSize, pass: Option<&ReplacePass>, kind: Heights) -> Option<GivenHeights<'_>> {
    let map = size.map.zip(pass).filter(|_| kind == Heights::Given);
    map.map(|(coarser, pass)| GivenHeights { pass, coarser })
}

/// A buffer for the heights that a map gives to `count` regions of `width` samples, and the job that puts them in place.
pub(super) fn replaced(
    gpu: &Gpu,
    pass: &ReplacePass,
    count: u32,
    width: u32,
    heights: &Buffer<i32>,
) -> Result<(Buffer<i32>, Job), Error> {
    let given = Buffer::new(gpu, "given heights", count as usize * (width as usize).pow(2))?;
    let replace = pass.prepare(gpu, width, count, ReplaceBuffers { given: &given, heights })?;
    Ok((given, replace))
}

/// A node in the format of the shader that draws it.
fn patch_of(config: &TerrainConfig, grid: Grid, node: Node, slot: u32) -> TerrainPatch {
    let edge = (grid.cells as i32) << node.level;
    let tiles = config.tiles_per_patch() / f64::from(config.patch_size - 1) * f64::from(edge);
    TerrainPatch {
        origin: node.at.map(|at| at.wrapping_mul(edge)),
        uv: node.at.map(|at| (f64::from(at) * tiles).rem_euclid(f64::from(TILES_PERIOD)) as f32),
        window: slot,
        level: node.level,
        holes: 0,
        eroded: slot,
    }
}

/// The bits of the vertices of a node that lie in holes; `None` for a node without holes. Only the finest nodes have holes.
fn hole_bits(config: &TerrainConfig, grid: Grid, node: Node, holes: &[TerrainHole]) -> Option<Vec<u32>> {
    let (size, scale) = (i64::from(grid.cells) + 1, config.terrain_scale);
    let first = node.at.map(|at| i64::from(at) * i64::from(grid.cells));
    let corner = first.map(|at| at as f64 * scale);
    let edge = f64::from(grid.cells) * scale;
    let near: Vec<&TerrainHole> =
        holes.iter().filter(|hole| node.level == 0 && hole.width_in(corner, edge, scale) > 0.0).collect();
    if near.is_empty() {
        return None;
    }
    let mut words = vec![0; grid.hole_words()];
    for bit in 0..size * size {
        let sample = [first[0] + bit % size, first[1] + bit / size];
        if near.iter().any(|hole| hole.contains(sample, scale)) {
            words[bit as usize / 32] |= 1 << (bit % 32);
        }
    }
    Some(words)
}

/// Checks what endless terrain can be made of.
///
/// # Errors
/// [`InputError`] for a recipe out of bounds, without `seamless` borders, or with what nodes are not made with.
pub(super) fn check(recipe: &Recipe, grid: Grid) -> Result<(), InputError> {
    let refused = |field: &str, bound: &str| Err(InputError::new(field, "given", bound));
    if recipe.config.border != crate::terrain::config::Border::Seamless {
        return refused(
            "border",
            "must be \"seamless\" where terrain is endless: patches alone make no plane",
        );
    }
    let finer = grid.shape(grid.top).finer;
    if grid.top > finer && remainder_reach(&recipe.config) >= NODE_MARGIN << finer {
        let bound = "must be at most 129 where interpolation is smooth";
        return Err(InputError::new("node_size", grid.cells + 1, bound));
    }
    if recipe.despike.is_some() {
        return refused("recipe", "must have no despiking where terrain is endless");
    }
    if recipe.apron(0) > MOST_ITERATIONS {
        let bound = format!("must be at most {MOST_ITERATIONS} together where terrain is endless");
        return Err(InputError::new("iterations", recipe.apron(0), bound));
    }
    Ok(())
}
