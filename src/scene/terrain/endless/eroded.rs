//! Eroded heights of an endless terrain on the device.
//!
//! Erosion needs the ground around each sample, as far as it reaches. Where nodes are small beside that reach, they are cut from larger
//! squares of eroded ground, called blocks, so that ground around nodes is not eroded for each of them.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::pool::{BATCH, Grid, NewNode, replaced};
use crate::Error;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Staged, Upload as _};
use crate::terrain::config::TerrainConfig;
use crate::terrain::erosion::{Eroding, ErosionPass};
use crate::terrain::features::Features;
use crate::terrain::fields::Fields;
use crate::terrain::hydraulic::reference::Flow;
use crate::terrain::levels::GivenHeights;
use crate::terrain::limit::{ErosionLimit, LimitBuffers, LimitPass, LimitShape};
use crate::terrain::quadtree::Node;
use crate::terrain::recipe::Recipe;
use crate::terrain::regions::{HeightBuffers, HeightScratch, RegionJob, RegionPass};
use crate::terrain::window::{Region, Regions};

/// The least width of a block, in reaches of erosion, unless even the coarsest eroded nodes are smaller. With the ground around it, the
/// ground that is eroded for such a block has at most (1 + 2/4)² times its area.
const TIMES_REACH: u32 = 4;

/// Number of blocks that are kept, more than a batch of nodes needs.
const KEPT: usize = 64;

/// The erosion of nodes: of the levels that are made from heights of the terrain's own resolution.
#[derive(Debug)]
pub(super) struct Erosion {
    recipe: Recipe,
    limit: ErosionLimit,
    grid: Grid,
    pass: ErosionPass,
    limiting: LimitPass,
    /// Regions with the samples around them that erosion needs. Its iterations alternate between both.
    windows: [Buffer<i32>; 2],
    /// Water and sediment, if there is hydraulic erosion.
    flows: Option<[Buffer<Flow>; 2]>,
    /// `None` if all nodes are wide beside the reach of erosion.
    blocks: Option<Blocks>,
}

/// The blocks that are kept. A block has the region of a node of one level.
#[derive(Debug)]
struct Blocks {
    level: u32,
    /// Number of samples along an edge.
    width: u32,
    /// The eroded heights, block by block.
    heights: Buffer<i32>,
    kept: BTreeMap<Node, Kept>,
    free: Vec<usize>,
    /// Number of batches of nodes that were cut from blocks.
    uses: u64,
    /// The jobs without and with heights of a map, one for each of a frame's new blocks.
    jobs: [Vec<BlockJob>; 2],
    /// Number of jobs of each kind that the frame has taken.
    taken: [usize; 2],
}

/// A block that is kept.
#[derive(Debug, Clone, Copy)]
struct Kept {
    /// Its place in the buffer.
    slot: usize,
    /// The last batch of nodes that was cut from it.
    used: u64,
    /// Whether a map gave it heights.
    is_given: bool,
}

/// Where a batch of nodes is cut from. Nodes that are eroded by themselves are cut from nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Cut {
    /// The blocks that are made before.
    new: Vec<NewBlock>,
    /// Where the region of each node begins in the blocks.
    corners: Vec<u32>,
}

/// A block that a frame makes.
#[derive(Debug, Clone)]
struct NewBlock {
    node: Node,
    slot: usize,
    /// Number of the job among those of the same kind.
    job: usize,
    /// Heights of a map, with the samples around the block that erosion needs.
    given: Option<Arc<Vec<i32>>>,
}

#[derive(Debug)]
struct BlockJob {
    regions: ErodedRegions,
    /// Number of features for which there is room.
    features: usize,
}

/// The generator of heights before erosion, and what it needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<'a> {
    pub generator: &'a RegionPass,
    pub scratch: &'a HeightScratch,
    pub config: &'a TerrainConfig,
    /// Number of features for which there is room.
    pub features: usize,
    pub map: Option<GivenHeights<'a>>,
}

/// Generates and erodes regions.
#[derive(Debug)]
struct ErodedRegions {
    /// Generates the regions with the samples around them.
    around: RegionJob,
    /// Replaces heights of these regions by those of a map of the terrain's own spacing.
    given: Option<(Buffer<i32>, Job)>,
    erosion: Vec<Job>,
    /// The eroded heights.
    result: Fields,
}

/// Finds the eroded heights of a batch of nodes, whose heights before erosion are there.
#[derive(Debug)]
pub(super) struct ErosionJob {
    /// Erodes each node's region; `None` for nodes that are cut from blocks.
    own: Option<ErodedRegions>,
    /// Where the region of each node begins in the eroded heights.
    corners: Buffer<u32>,
    limit: Job,
    /// The eroded heights of the nodes' regions.
    pub heights: Buffer<i32>,
}

impl Erosion {
    /// Compiles the pipelines, and allocates memory for batches of `regions`, with the samples around them.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        recipe: &Recipe,
        limit: ErosionLimit,
        grid: Grid,
        regions: Regions,
    ) -> Result<Self, Error> {
        let points = regions.count as usize * (regions.width as usize).pow(2);
        let windows = [
            Buffer::new(gpu, "regions to erode", points)?,
            Buffer::new(gpu, "regions to erode, in turn", points)?,
        ];
        let pass = ErosionPass::new(gpu, recipe)?;
        let widest = Fields { heights: windows[0].clone(), width: regions.width, count: regions.count };
        let blocks = block_level(grid, recipe.apron(0)).map(|level| Blocks::new(gpu, grid, level));
        Ok(Self {
            flows: pass.flows(gpu, &widest)?,
            blocks: blocks.transpose()?,
            recipe: recipe.clone(),
            limit,
            grid,
            pass,
            limiting: LimitPass::new(gpu)?,
            windows,
        })
    }

    /// The blocks that nodes of a level are cut from; `None` for nodes that are eroded by themselves.
    fn blocks_of(&self, level: u32) -> Option<&Blocks> {
        self.blocks.as_ref().filter(|blocks| level <= blocks.level)
    }

    /// The region that is generated and eroded for a node.
    pub fn around(&self, node: Node) -> Region {
        let block = self.blocks_of(node.level).map_or(node, |blocks| node.ancestor(blocks.level));
        self.grid.region_of(block).grown(self.recipe.apron(0))
    }

    /// Forgets the blocks whose region, with the samples around it, is changed.
    pub fn forget(&mut self, is_changed: impl Fn(Region) -> bool) {
        let (grid, apron) = (self.grid, self.recipe.apron(0));
        let Some(Blocks { kept, free, .. }) = &mut self.blocks else { return };
        kept.retain(|node, block| {
            let is_good = !is_changed(grid.region_of(*node).grown(apron));
            free.extend((!is_good).then_some(block.slot));
            is_good
        });
    }

    /// Forgets all jobs of blocks, as after a change of the generator.
    pub fn forget_jobs(&mut self) {
        self.blocks.iter_mut().flat_map(|blocks| &mut blocks.jobs).for_each(Vec::clear);
    }

    /// Begins a frame.
    pub fn begin(&mut self) {
        self.blocks.iter_mut().for_each(|blocks| blocks.taken = [0; 2]);
    }

    /// Chooses where a batch of nodes of one level is cut from, and prepares the blocks that are made for it.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn cut(
        &mut self,
        gpu: &Gpu,
        nodes: &[NewNode],
        source: Source<'_>,
        features: &Features,
    ) -> Result<Cut, Error> {
        let mut cut = Cut::default();
        let is_cut = |blocks: &&mut Blocks| nodes.iter().all(|new| new.node.level <= blocks.level);
        let Some(blocks) = self.blocks.as_mut().filter(is_cut) else { return Ok(cut) };
        blocks.uses += 1;
        for NewNode { node, elevation, .. } in nodes {
            let given = elevation.as_ref().and_then(|elevation| elevation.around.clone());
            let block = node.ancestor(blocks.level);
            cut.new.extend(blocks.take(block, given));
            let slot = blocks.kept.get(&block).map_or(0, |kept| kept.slot);
            let [first, start] = [*node, block].map(|node| self.grid.first_of(node));
            let [column, row] = [0, 1].map(|axis| (first[axis] - start[axis]) as u32);
            cut.corners.push((slot as u32 * blocks.width + row) * blocks.width + column);
        }
        for block in &cut.new {
            self.prepare_block(gpu, block, source, features)?;
        }
        Ok(cut)
    }

    /// Prepares a block's job, with room for its features.
    fn prepare_block(
        &mut self,
        gpu: &Gpu,
        block: &NewBlock,
        source: Source<'_>,
        features: &Features,
    ) -> Result<(), Error> {
        let firsts = [self.around(block.node).first];
        let map = source.map.filter(|_| block.given.is_some());
        while let Some(blocks) = &self.blocks {
            let room = match blocks.job(block) {
                None => 0,
                Some(job) => {
                    let needed = job.regions.around.feature_count(&firsts, features);
                    if needed <= job.features {
                        break;
                    }
                    needed.next_power_of_two()
                }
            };
            let source = Source { features: room, map, ..source };
            let made = BlockJob { regions: self.regions(gpu, 1, blocks.width, source)?, features: room };
            let Some(jobs) = self.blocks.as_mut().map(|blocks| &mut blocks.jobs[block.kind()]) else { break };
            match jobs.get_mut(block.job) {
                Some(job) => *job = made,
                None => jobs.push(made),
            }
        }
        Ok(())
    }

    /// Prepares the generation and the erosion of regions of the terrain's own resolution.
    ///
    /// # Errors
    /// [`GpuError`].
    fn regions(&self, gpu: &Gpu, count: u32, width: u32, source: Source<'_>) -> Result<ErodedRegions, Error> {
        let Source { generator, scratch, config, features, map } = source;
        let wide = width + 2 * self.recipe.apron(0);
        let output = HeightBuffers { output: &self.windows[0], scratch };
        let (lattice, own) = (map.filter(|map| map.coarser > 0), map.filter(|map| map.coarser == 0));
        let regions = Regions { count, width: wide, coarser: 0 };
        let around = generator.prepare_regions(gpu, config, regions, features, output, lattice)?;
        let given = own.map(|map| replaced(gpu, map.pass, count, wide, &self.windows[0])).transpose()?;
        let mut both =
            self.windows.each_ref().map(|heights| Fields { heights: heights.clone(), width: wide, count });
        both[1].width -= 2;
        let eroding = Eroding { windows: &both, flows: self.flows.as_ref() };
        let (erosion, result) = self.pass.prepare(gpu, eroding)?;
        Ok(ErodedRegions { around, given, erosion, result })
    }

    /// Prepares the erosion of a batch of nodes of a level, whose heights before erosion are in `origins`.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn prepare(
        &self,
        gpu: &Gpu,
        level: u32,
        source: Source<'_>,
        origins: &Buffer<i32>,
    ) -> Result<ErosionJob, Error> {
        let (count, width) = (BATCH as u32, self.grid.shape(level).region_width());
        let blocks = self.blocks_of(level);
        let own = blocks.is_none().then(|| self.regions(gpu, count, width, source)).transpose()?;
        // The window that does not have the eroded heights is free.
        let is_in_first = self.recipe.apron(0).is_multiple_of(2);
        let heights = self.windows[usize::from(is_in_first)].clone();
        let corners: Vec<u32> = (0..count).map(|at| at * width * width).collect();
        let corners = Buffer::from_slice(gpu, "corners of nodes", &corners)?;
        let eroded = (&self.windows[usize::from(!is_in_first)], width);
        let (eroded, eroded_width) = blocks.map_or(eroded, |blocks| (&blocks.heights, blocks.width));
        let buffers = LimitBuffers { origins, eroded, corners: &corners, heights: &heights };
        let shape = LimitShape { count, width, eroded_width };
        let limit = self.limiting.prepare(gpu, self.limit, shape, buffers)?;
        Ok(ErosionJob { own, corners, limit, heights })
    }

    /// Stages what the erosion of a batch of nodes reads, and the blocks that are made before it.
    ///
    /// # Errors
    /// [`crate::InputError`] for a node beyond the world; [`GpuError`].
    pub fn stage(
        &self,
        staged: &mut Staged,
        job: &ErosionJob,
        cut: &Cut,
        nodes: &[NewNode],
        features: &Features,
    ) -> Result<(), Error> {
        let firsts =
            |nodes: &[Node]| -> Vec<[i64; 2]> { nodes.iter().map(|node| self.around(*node).first).collect() };
        if let Some(own) = &job.own {
            let all: Vec<Node> = nodes.iter().map(|new| new.node).collect();
            own.around.set_regions(staged, &firsts(&all), features)?;
            for (number, new) in nodes.iter().enumerate() {
                let around = new.elevation.as_ref().and_then(|elevation| elevation.around.as_ref());
                around.map_or(Ok(()), |heights| own.stage_given(staged, number, heights))?;
            }
        }
        for block in &cut.new {
            let Some(BlockJob { regions, .. }) = self.blocks.as_ref().and_then(|blocks| blocks.job(block))
            else {
                continue;
            };
            regions.around.set_regions(staged, &firsts(&[block.node]), features)?;
            block.given.as_ref().map_or(Ok(()), |heights| regions.stage_given(staged, 0, heights))?;
        }
        Ok(staged.elements(&job.corners, 0, &cut.corners)?)
    }

    /// Records the erosion of a batch of nodes, after the blocks that it needs.
    pub fn record(&self, encoder: &mut wgpu::CommandEncoder, job: &ErosionJob, cut: &Cut) {
        for (blocks, block) in
            self.blocks.iter().flat_map(|blocks| cut.new.iter().map(move |new| (blocks, new)))
        {
            let Some(BlockJob { regions, .. }) = blocks.job(block) else { continue };
            regions.record(encoder);
            let bytes = 4 * u64::from(blocks.width).pow(2);
            let to = bytes * block.slot as u64;
            encoder.copy_buffer_to_buffer(regions.result.heights.raw(), 0, blocks.heights.raw(), to, bytes);
        }
        job.own.iter().for_each(|own| own.record(encoder));
        job.limit.record(encoder);
    }
}

impl ErosionJob {
    /// Number of features that a batch of nodes needs room for.
    pub fn feature_count(&self, erosion: &Erosion, nodes: &[NewNode], features: &Features) -> usize {
        let firsts: Vec<_> = nodes.iter().map(|new| erosion.around(new.node).first).collect();
        self.own.as_ref().map_or(0, |own| own.around.feature_count(&firsts, features))
    }
}

impl ErodedRegions {
    /// Stages the heights that a map gives to a region.
    fn stage_given(&self, staged: &mut Staged, number: usize, heights: &[i32]) -> Result<(), Error> {
        match &self.given {
            Some((given, _)) => Ok(staged.elements(given, number * heights.len(), heights)?),
            None => self.around.stage_given(staged, number, heights),
        }
    }

    fn record(&self, encoder: &mut wgpu::CommandEncoder) {
        self.around.record(encoder);
        self.given.iter().for_each(|(_, replace)| replace.record(encoder));
        self.erosion.iter().for_each(|step| step.record(encoder));
    }
}

impl Blocks {
    fn new(gpu: &Gpu, grid: Grid, level: u32) -> Result<Self, GpuError> {
        let width = grid.shape(level).region_width();
        Ok(Self {
            level,
            width,
            heights: Buffer::new(gpu, "eroded blocks", KEPT * (width as usize).pow(2))?,
            kept: BTreeMap::new(),
            free: (0..KEPT).rev().collect(),
            uses: 0,
            jobs: [Vec::new(), Vec::new()],
            taken: [0; 2],
        })
    }

    /// Keeps a block for the current batch; `None` if it is there, and otherwise how it is made, in the place of the one whose last use
    /// is longest ago.
    fn take(&mut self, node: Node, given: Option<Arc<Vec<i32>>>) -> Option<NewBlock> {
        let (used, is_given) = (self.uses, given.is_some());
        if let Some(kept) = self.kept.get_mut(&node).filter(|kept| kept.is_given == is_given) {
            kept.used = used;
            return None;
        }
        let own = self.kept.remove(&node).map(|kept| kept.slot);
        let slot = own.or_else(|| self.free.pop()).or_else(|| {
            let oldest = self.kept.iter().min_by_key(|(_, kept)| kept.used).map(|(node, _)| *node)?;
            self.kept.remove(&oldest).map(|kept| kept.slot)
        })?;
        self.kept.insert(node, Kept { slot, used, is_given });
        let taken = &mut self.taken[usize::from(is_given)];
        *taken += 1;
        Some(NewBlock { node, slot, job: *taken - 1, given })
    }

    fn job(&self, block: &NewBlock) -> Option<&BlockJob> {
        self.jobs[block.kind()].get(block.job)
    }
}

impl NewBlock {
    fn kind(&self) -> usize {
        usize::from(self.given.is_some())
    }
}

/// The level whose nodes' regions are blocks; `None` if the finest nodes are wide beside the reach of erosion.
fn block_level(grid: Grid, reach: u32) -> Option<u32> {
    let eroded = (0..=grid.top).take_while(|level| grid.coarser(*level) == 0);
    let is_wide = |level: &u32| grid.cells << level >= TIMES_REACH * reach;
    let level = eroded.clone().find(is_wide).or(eroded.last())?;
    (level > 0).then_some(level)
}
