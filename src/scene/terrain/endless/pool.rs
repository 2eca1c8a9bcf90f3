//! The nodes of an endless terrain on the device: tiles of heights in a pool of fixed size, and the jobs that make them.

use super::TerrainHole;
use crate::gpu::{Buffer, Gpu, Job, ReadbackRing, Staged, Upload as _};
use crate::scene::FRAMES_IN_FLIGHT;
use crate::shared::render::scene_terrain::TerrainPatch;
use crate::terrain::config::TerrainConfig;
use crate::terrain::cover::TILES_PERIOD;
use crate::terrain::features::Features;
use crate::terrain::height::{HeightBuffers, HeightScratch};
use crate::terrain::node::{NODE_FACTS, NODE_MARGIN, NodeBuffers, NodeFacts, NodePass, NodeShape};
use crate::terrain::quadtree::Node;
use crate::terrain::recipe::Recipe;
use crate::terrain::regions::{RegionJob, RegionPass};
use crate::terrain::remainder::remainder_reach;
use crate::terrain::window::Regions;
use crate::{Error, InputError};

/// Number of nodes in a batch.
pub(super) const BATCH: usize = 4;

/// Largest number of levels by which the heights from which a node is made are finer than the node. The node's deviation from them
/// is exact; what lies below is bounded.
const MOST_FINER: u32 = 3;

/// Largest number of cells along an edge of a node's finer heights, unless the node itself has more.
const MOST_CELLS: u32 = 512;

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
    facts: Buffer<u32>,
    ring: ReadbackRing<u64>,
    grid: Grid,
    generator: RegionPass,
    pass: NodePass,
    heights: Buffer<i32>,
    scratch: HeightScratch,
    /// The jobs of each level, one for each of a frame's batches of this level.
    jobs: Vec<Vec<BatchJob>>,
    /// Index of the job of each batch of the frame: its level and its number.
    batches: Vec<[usize; 2]>,
}

/// The jobs that make up to [`BATCH`] nodes of one level.
#[derive(Debug)]
struct BatchJob {
    heights: RegionJob,
    slots: Buffer<u32>,
    nodes: Job,
}

/// A node to make, and its tile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct NewNode {
    pub node: Node,
    pub slot: u32,
}

/// The nodes into which a terrain is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Grid {
    /// Number of cells along an edge of a node, a power of two.
    pub cells: u32,
    /// Level of the coarsest nodes: they cover one cell of the base lattice.
    pub top: u32,
}

impl Grid {
    /// The nodes of `node_size` samples of a configuration.
    ///
    /// # Errors
    /// [`InputError`] for a size that is not 2^n + 1, out of bounds, or larger than a cell of the base lattice.
    pub fn new(config: &TerrainConfig, node_size: u32) -> Result<Self, InputError> {
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
        Ok(Self { cells, top: most - cells.ilog2() })
    }

    /// The shape of the nodes of a level. The heights from which they are made are up to [`MOST_FINER`] levels finer.
    pub fn shape(self, level: u32) -> NodeShape {
        let finer = (MOST_CELLS / self.cells).max(1).ilog2().min(MOST_FINER).min(level);
        NodeShape { size: self.cells + 1, finer }
    }

    /// The first sample of the region of finer heights of a node.
    pub fn first_of(self, node: Node) -> [i64; 2] {
        let (cells, finer) = (i64::from(self.cells), self.shape(node.level).finer);
        node.at.map(|at| (i64::from(at) * cells - i64::from(NODE_MARGIN)) << finer)
    }

    /// Number of words of a node's holes.
    pub fn hole_words(self) -> usize {
        (self.cells as usize + 1).pow(2).div_ceil(32)
    }

    /// Number of levels by which the finer heights of a node of a level are coarser than the terrain.
    pub fn coarser(self, level: u32) -> u32 {
        level - self.shape(level).finer
    }
}

impl Pool {
    /// Allocates a pool of `capacity` tiles, with memory for holes if `has_holes`.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn new(
        gpu: &Gpu,
        recipe: &Recipe,
        grid: Grid,
        (capacity, has_holes): (usize, bool),
    ) -> Result<Self, Error> {
        let config = &recipe.config;
        let width = (0..=grid.top).map(|level| grid.shape(level).region_width()).max().unwrap_or(0);
        // The largest scratch is that of the widest regions with the most subdivisions.
        let regions = Regions { count: BATCH as u32, width, coarser: 0 };
        let words = capacity * NODE_FACTS as usize;
        Ok(Self {
            tiles: Buffer::new(
                gpu,
                "terrain nodes",
                capacity * (grid.shape(0).tile_width() as usize).pow(2),
            )?,
            patches: Buffer::new(gpu, "patches", capacity)?,
            holes: Buffer::new(
                gpu,
                "holes of nodes",
                if has_holes { capacity * grid.hole_words() } else { 1 },
            )?,
            facts: Buffer::new(gpu, "facts of nodes", words)?,
            ring: ReadbackRing::new(gpu, "facts of nodes", FRAMES_IN_FLIGHT, 4 * words as u64)?,
            generator: RegionPass::new(gpu, config, None)?,
            pass: NodePass::new(gpu)?,
            heights: Buffer::new(gpu, "finer heights", BATCH * (width as usize).pow(2))?,
            scratch: HeightScratch::for_regions(gpu, config, regions)?,
            grid,
            jobs: (0..=grid.top).map(|_| Vec::new()).collect(),
            batches: Vec::new(),
        })
    }

    /// The facts of all tiles, and the number of the frame after which they were copied; `None` if none have arrived.
    pub fn arrived(&mut self) -> Option<(u64, Vec<Option<NodeFacts>>)> {
        let (frame, bytes) = self.ring.take()?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        let facts = words.as_chunks::<{ NODE_FACTS as usize }>().0.iter();
        Some((frame, facts.map(|words| NodeFacts::from_words(*words)).collect()))
    }

    /// Forgets readbacks that have not arrived.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn invalidate(&mut self, gpu: &Gpu) -> Result<(), Error> {
        self.batches.clear();
        Ok(self.ring.invalidate(gpu)?)
    }

    /// Prepares the jobs that make nodes in this frame.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn make(&mut self, gpu: &Gpu, config: &TerrainConfig, new: &[NewNode]) -> Result<(), Error> {
        self.batches.clear();
        for level in 0..self.jobs.len() {
            let count = new.iter().filter(|new| new.node.level as usize == level).count().div_ceil(BATCH);
            while self.jobs[level].len() < count {
                let job = self.job(gpu, config, level as u32)?;
                self.jobs[level].push(job);
            }
            self.batches.extend((0..count).map(|number| [level, number]));
        }
        Ok(())
    }

    fn job(&self, gpu: &Gpu, config: &TerrainConfig, level: u32) -> Result<BatchJob, Error> {
        let shape = self.grid.shape(level);
        let (width, coarser) = (shape.region_width(), self.grid.coarser(level));
        let regions = Regions { count: BATCH as u32, width, coarser };
        let output = HeightBuffers { output: &self.heights, scratch: &self.scratch };
        let slots = Buffer::new(gpu, "slots of nodes", BATCH)?;
        let buffers =
            NodeBuffers { heights: &self.heights, slots: &slots, tiles: &self.tiles, facts: &self.facts };
        let nodes = self.pass.prepare(gpu, shape, BATCH as u32, buffers)?;
        let heights = self.generator.prepare_regions(gpu, config, regions, 0, output)?;
        Ok(BatchJob { heights, slots, nodes })
    }

    /// Stages what the jobs of the frame read, and the patches of new nodes.
    ///
    /// # Errors
    /// [`InputError`] for a node beyond the world; [`crate::gpu::GpuError`].
    pub fn stage(
        &self,
        staged: &mut Staged,
        config: &TerrainConfig,
        new: &[NewNode],
        holes: &[TerrainHole],
    ) -> Result<(), Error> {
        for level in 0..self.jobs.len() {
            let own: Vec<NewNode> =
                new.iter().filter(|new| new.node.level as usize == level).copied().collect();
            for (job, batch) in self.jobs[level].iter().zip(own.chunks(BATCH)) {
                let mut slots = [NO_SLOT; BATCH];
                slots.iter_mut().zip(batch).for_each(|(slot, new)| *slot = new.slot);
                staged.elements(&job.slots, 0, &slots)?;
                let firsts: Vec<[i64; 2]> = batch.iter().map(|new| self.grid.first_of(new.node)).collect();
                job.heights.stage_regions(staged, &firsts, &Features::default())?;
            }
        }
        for new in new {
            self.stage_patch(staged, config, *new, holes)?;
            let none = [0; NODE_FACTS as usize];
            staged.elements(&self.facts, new.slot as usize * NODE_FACTS as usize, &none)?;
        }
        Ok(())
    }

    /// Stages the patch of a node, and its holes.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn stage_patch(
        &self,
        staged: &mut Staged,
        config: &TerrainConfig,
        new: NewNode,
        holes: &[TerrainHole],
    ) -> Result<(), Error> {
        let mut patch = patch_of(config, self.grid, new);
        if let Some(words) = hole_bits(config, self.grid, new.node, holes) {
            let first = new.slot as usize * words.len();
            staged.elements(&self.holes, first, &words)?;
            patch.holes = first as u32 + 1;
        }
        Ok(staged.elements(&self.patches, new.slot as usize, &[patch])?)
    }

    /// Records the jobs of the frame; if `reads_facts`, also a copy of all facts to the host.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, frame: u64, reads_facts: bool) {
        for [level, number] in self.batches.drain(..) {
            let job = &self.jobs[level][number];
            job.heights.record(encoder);
            job.nodes.record(encoder);
        }
        if reads_facts {
            let facts = &self.facts;
            self.ring.record(encoder, frame, |encoder, to| {
                encoder.copy_buffer_to_buffer(facts.raw(), 0, to, 0, facts.bytes());
            });
        }
    }
}

/// A node in the format of the shader that draws it.
fn patch_of(config: &TerrainConfig, grid: Grid, NewNode { node, slot }: NewNode) -> TerrainPatch {
    let edge = (grid.cells as i32) << node.level;
    let tiles = config.tiles_per_patch() / f64::from(config.patch_size - 1) * f64::from(edge);
    TerrainPatch {
        origin: node.at.map(|at| at.wrapping_mul(edge)),
        uv: node.at.map(|at| (f64::from(at) * tiles).rem_euclid(f64::from(TILES_PERIOD)) as f32),
        window: slot,
        level: node.level,
        holes: 0,
        unused: 0,
    }
}

/// The bits of the vertices of a node that lie in holes; `None` for a node without holes. Only the finest nodes have holes.
fn hole_bits(config: &TerrainConfig, grid: Grid, node: Node, holes: &[TerrainHole]) -> Option<Vec<u32>> {
    let (size, scale) = (i64::from(grid.cells) + 1, config.terrain_scale);
    let first = node.at.map(|at| i64::from(at) * i64::from(grid.cells));
    let corner = first.map(|at| at as f64 * scale);
    let edge = f64::from(grid.cells) * scale;
    let near: Vec<&TerrainHole> =
        holes.iter().filter(|hole| node.level == 0 && hole.reaches(corner, edge)).collect();
    if near.is_empty() {
        return None;
    }
    let mut words = vec![0; grid.hole_words()];
    for bit in 0..size * size {
        let sample = [first[0] + bit % size, first[1] + bit / size].map(|at| at as f64 * scale);
        if near.iter().any(|hole| hole.contains(sample)) {
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
    if !recipe.features.is_empty() {
        return refused("features", "must not be given where terrain is endless");
    }
    if recipe.apron(0) > 0 {
        return refused("recipe", "must have no despiking and no erosion where terrain is endless");
    }
    Ok(())
}
