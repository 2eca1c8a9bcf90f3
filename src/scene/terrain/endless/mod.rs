//! Endless terrain: nodes of a quadtree, made on the device where the views of a frame need them (thesis B sections 4.4 and 5.1.2).
//!
//! The host decides which nodes are drawn and which are made ([`Cover`]), and the device makes them. A node is drawn as soon as it is
//! made, and refined as soon as its facts have arrived from the device: its extremes, and how far it lies from the finest heights.

mod elevation;
mod eroded;
mod ground;
mod hole;
mod in_view;
mod pool;

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};

use glam::{DVec3, Vec3};

use super::TerrainDrawable;
use super::device::{params_of, zones_of};
use super::drawable::{TerrainGeometry, patch_indices};
use super::source::TerrainSource;
use crate::animation::Frame;
use crate::gpu::{Buffer, Gpu, Staged, Uniform};
use crate::lod::select::reference::nearly_seen;
use crate::lod::{LodCamera, SelectView};
use crate::scene::chunk::Chunk;
use crate::scene::instances::Instances;
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::NOTHING;
use crate::scene::object_kind::{
    KindInView, Made, MakeOn, Making, ObjectKind, OnDevice, Placed, Provided, SeenBy, UnitRay,
};
use crate::scene::placement::Placement;
use crate::scene::ray::SurfaceHit;
use crate::shared::lod::object::{OBJECT_LEVELS, SceneDraw};
use crate::shared::render::scene_terrain::{MORPH_START, STITCHED, TerrainFrame, TerrainNode, TerrainParams};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::ground::within;
use crate::terrain::injection::{ChangedPoint, FeatureOffsets};
use crate::terrain::limit::ErosionLimit;
use crate::terrain::mesh::GroundPoint;
use crate::terrain::morph::Morph;
use crate::terrain::node::NodeFacts;
use crate::terrain::quadtree::{Beside, Cover, Leaf, Node};
use crate::terrain::recipe::Recipe;
use crate::terrain::remainder::remainder;
use crate::terrain::window::Region;
use crate::{Error, InputError};
use elevation::{Beyond, Elevation, NodeElevation};
use ground::FinestGround;
pub use hole::{SampleMask, TerrainHole};
use in_view::{EndlessInView, ViewTable};
use pool::{BATCH, FoundFacts, Grid, NewNode, Pool, PoolSize, Recipes};

/// Number of parts along an edge of a node in which the displacement that a view allows is found. A smaller part allows more.
const PARTS: u32 = 4;

/// A node is made before it is needed: as soon as this fraction of the allowed displacement is exceeded.
const SOON: f32 = 0.8;

/// How much coarser nodes may be that a camera does not see.
const OUTSIDE: f32 = 4.0;

/// The least error in pixels for which detail is made. Without any, no number of nodes would do.
const LEAST_PIXELS: f32 = 1.0 / 16.0;

/// Largest LOD bias.
const MOST_BIAS: f32 = 1024.0;

/// Factor by which the bias of a view falls in a frame while its nodes fit the limit of triangles.
const BIAS_FALL: f32 = 0.98;

/// Largest bias of a view. Around a camera, the error of nodes is divided by the distance of the near plane.
const MOST_VIEW_BIAS: f32 = 65_536.0;

/// Number of steps that find the bias of a view: the last ones have a ratio of 1.01.
const BIAS_STEPS: u32 = 10;

/// Extent and memory of endless terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndlessLimits {
    /// Distance in world units up to which terrain is drawn around each camera, at most eight spacings of the base lattice:
    /// (`patch_size` − 1) · 2^`coarse_levels` · `terrain_scale`. `None`: one and a half. Beyond that, the number of nodes grows with the
    /// square of the distance; raise `coarse_levels` instead.
    pub view_distance: Option<f64>,
    /// Largest number of nodes to make in a frame, 16 to 1024. Default: 32.
    pub nodes_per_frame: u32,
    /// Number of nodes for which there is memory, 256 to 65536. Default: 1536. A node takes 4 · (`node_size` + 4)² bytes, and
    /// 4 · (2 · `node_size` − 1)² bytes more with finer normals. Neither part may exceed the device's storage bindings.
    pub capacity: u32,
    /// Samples along an edge of a node: 2^n + 1, n in 3..=8, at most those between two points of the base lattice. Default: 65.
    pub node_size: u32,
    /// Whether nodes are shaded with normals of twice their resolution. Default: true. Terrain with a target has none.
    pub finer_normals: bool,
    /// Largest distance in world units by which erosion may move a height, at most 1000; it has no effect without erosion.
    /// At least 0.001. Default: 4. Ground is eroded where a view allows less than twice as much; the number of nodes there grows with the
    /// square. An eroded node takes as many passes over its finest heights as there are iterations, and twice the memory for heights.
    /// Nodes less than four times as wide as there are iterations share 64 larger squares of eroded ground, 76 MB at most for a recipe.
    pub erosion_depth: f64,
}

impl Default for EndlessLimits {
    fn default() -> Self {
        Self {
            view_distance: None,
            nodes_per_frame: 32,
            capacity: 1536,
            node_size: 65,
            finer_normals: true,
            erosion_depth: 4.0,
        }
    }
}

impl EndlessLimits {
    /// The largest view distance of a configuration, in world units.
    pub fn farthest(config: &TerrainConfig) -> f64 {
        8.0 * Self::base_spacing(config)
    }

    fn base_spacing(config: &TerrainConfig) -> f64 {
        config.edge_length() * f64::from(1 << config.coarse_levels)
    }

    /// Checks the limits, and returns the view distance.
    fn checked(&self, config: &TerrainConfig) -> Result<f64, InputError> {
        let (most, spacing) = (Self::farthest(config), Self::base_spacing(config));
        let distance = self.view_distance.unwrap_or(1.5 * spacing);
        let is_distance = distance > 0.0 && distance <= most;
        InputError::check(is_distance, "view_distance", distance, || {
            format!(
                "must be above 0 and at most {most}, eight spacings of the base lattice; raise coarse_levels for more"
            )
        })?;
        InputError::check_within("nodes_per_frame", self.nodes_per_frame, 16..=1024)?;
        InputError::check_within("capacity", self.capacity, 256..=65_536)?;
        // Half of the memory is left to finer nodes.
        let least = 2 * ((2.0 * distance / spacing).ceil() as u32 + 1).pow(2);
        InputError::check(self.capacity >= least, "capacity", self.capacity, || {
            format!("must be at least {least} for this view distance; raise coarse_levels instead")
        })?;
        Ok(distance)
    }
}

/// The nodes of an endless terrain, after a frame.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct EndlessStatistics {
    /// Number of nodes on the device.
    pub nodes: usize,
    /// Number of nodes for which there is memory.
    pub capacity: usize,
    /// Number of nodes that the last frame made.
    pub made: usize,
    /// Number of nodes that the views of the last frame drew, without culling.
    pub drawn: usize,
    /// How much of the detail that the views need is there: 1 if all of it is, as after some frames in one place.
    pub ready: f32,
    /// Number of nodes that were not made because the memory holds nodes in use only.
    pub refused: usize,
    /// Number of nodes that were not made because heights of the elevation map are on their way.
    pub awaited: usize,
    /// Number of nodes of each level that the views drew, without culling; the finest level is 0.
    pub levels: [u32; 18],
}

/// An endless terrain in a scene.
#[derive(Debug)]
pub(in crate::scene) struct Endless {
    source: TerrainSource,
    recipe: Recipe,
    limits: EndlessLimits,
    grid: Grid,
    view_distance: f64,
    size: PoolSize,
    pool: Pool,
    residents: BTreeMap<Node, Resident>,
    free: Vec<u32>,
    /// Number of the frame.
    frame: u64,
    /// The nodes that the frame makes.
    new: Vec<NewNode>,
    /// Nodes to make again: their heights have changed.
    again: BTreeSet<Node>,
    /// The injected heights, by how much they matter.
    offsets: FeatureOffsets,
    /// The same of the target.
    target_offsets: Option<FeatureOffsets>,
    /// Whether bounds of nodes have changed since they were placed.
    are_bounds_changed: bool,
    tables: Arc<Mutex<Vec<ViewTable>>>,
    ground: FinestGround,
    elevation: Option<Elevation>,
    /// The map's heights of regions that this frame erodes, `None` while they are on their way. Nodes share regions.
    given_around: Vec<(Region, Option<Arc<Vec<i32>>>)>,
    /// The holes; `None` for terrain that was added without.
    holes: Option<Vec<TerrainHole>>,
    /// Whether holes have changed since they were staged.
    are_holes_changed: bool,
    statistics: EndlessStatistics,
    /// Whether the views of the last frame permit an error for which detail is made.
    is_bounded: bool,
    /// Factor of the allowed displacement: 1, or more if the nodes that views need exceed the memory.
    lod_bias: f32,
    /// The same for each view of the frame: more than 1 if the nodes in view exceed the view's limit of triangles.
    view_biases: Vec<f32>,
}

/// A node on the device.
#[derive(Debug, Clone, Copy)]
struct Resident {
    slot: u32,
    /// The last frame that needed the node.
    used: u64,
    /// The frame that makes the node.
    made: u64,
    /// What lies below the heights from which the node is made.
    beyond: Beyond,
    /// The facts of the own recipe's heights and of the target's; `None` until they arrive.
    found: Option<[FoundFacts; 2]>,
    facts: Option<Facts>,
}

/// Facts about a node on the host, in world units.
#[derive(Debug, Clone, Copy)]
struct Facts {
    /// The lowest and the highest height of its finer heights.
    heights: [f64; 2],
    /// Bound of its distance from the finest heights.
    error: f32,
}

/// The chunks of an object and the draws of a chunk.
type Drawn = (Vec<Chunk>, Vec<SceneDraw>);

/// Creates endless terrain.
///
/// # Errors
/// [`InputError`] for a recipe or limits out of bounds; [`crate::gpu::GpuError`].
pub(in crate::scene) fn made(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    source: &TerrainSource,
    recipe: &Recipe,
    limits: EndlessLimits,
) -> Result<(Endless, Instances, Drawn), Error> {
    recipe.validate(&[], 0)?;
    let mut elevation =
        source.elevation.as_ref().map(|given| Elevation::new(given, &recipe.config)).transpose()?;
    let recipe = &generated(recipe, &recipe.features, elevation.as_mut());
    let grid = Grid::new(&recipe.config, limits.node_size, elevation.is_some())?;
    pool::check(recipe, grid)?;
    let recipes = Recipes::new(recipe, source);
    let target = recipes.target;
    source.check_target()?;
    if let Some(target) = target {
        check_target(&recipe.config, target, grid).map_err(|error| error.below("target"))?;
        let bound = || "must not be given beside a target";
        InputError::check(elevation.is_none(), "elevation", "given", bound)?;
    }
    let erosion = recipes
        .all()
        .any(|recipe| recipe.apron(0) > 0)
        .then_some(ErosionLimit { depth: limits.erosion_depth });
    if let Some(erosion) = erosion {
        erosion.validate().map_err(|error| InputError { path: "erosion_depth".to_owned(), ..error })?;
    }
    let view_distance = limits.checked(&recipe.config)?;
    let mut instances = Instances::new(limits.capacity as usize);
    let capacity = instances.capacity();
    let holes = source.holes.clone();
    check_holes(holes.as_deref().unwrap_or_default())?;
    let size = PoolSize {
        capacity,
        has_holes: holes.is_some(),
        has_normals: limits.finer_normals && target.is_none(),
        map: elevation.as_ref().map(Elevation::coarser),
        erosion,
    };
    let pool = Pool::new(gpu, recipes, grid, size)?;
    let (chunks, draws) = drawn(gpu, layouts, source, &pool)?;
    let hidden = BoundingSphere { center: Vec3::ZERO, radius: 0.0 };
    for _ in 0..capacity {
        instances.spawn(&Placement::default(), &hidden);
    }
    let endless = Endless {
        source: source.clone(),
        recipe: recipe.clone(),
        limits,
        grid,
        view_distance,
        size,
        pool,
        residents: BTreeMap::new(),
        free: (0..capacity as u32).rev().collect(),
        frame: 0,
        new: Vec::new(),
        again: BTreeSet::new(),
        offsets: offsets_of(recipe, elevation.as_ref()),
        target_offsets: target.map(|target| offsets_of(target, None)),
        are_bounds_changed: false,
        tables: Arc::default(),
        ground: FinestGround::new(recipe, source.target.clone(), erosion, elevation.clone())?,
        elevation,
        given_around: Vec::new(),
        holes,
        are_holes_changed: false,
        statistics: EndlessStatistics { capacity, ..EndlessStatistics::default() },
        is_bounded: true,
        lod_bias: 1.0,
        view_biases: Vec::new(),
    };
    Ok((endless, instances, (chunks, draws)))
}

/// The drawable of all nodes of a pool.
fn drawn(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    source: &TerrainSource,
    pool: &Pool,
) -> Result<(Vec<Chunk>, Vec<SceneDraw>), Error> {
    let zones = zones_of(gpu, source)?;
    let (grid, capacity) = (pool.grid, pool.size.capacity);
    let indices = patch_indices(grid.cells + 1);
    let params = TerrainParams {
        normals_width: if pool.size.has_normals { grid.shape(0).normals_width() } else { 0 },
        erosion_depth: pool.size.erosion.map_or(0.0, |limit| limit.depth as f32),
        ..params_of(source, grid.shape(0).tile_width(), grid.cells + 1, &zones)
    };
    let geometry = TerrainGeometry {
        params: Uniform::new(gpu, "terrain", &params)?,
        heights: pool.tiles.clone(),
        patches: pool.patches.clone(),
        indices: Buffer::constant(gpu, "triangles of a node", &indices)?,
        zones,
        holes: pool.holes.clone(),
        normals: pool.normals.clone(),
        has_holes: source.holes.is_some(),
    };
    let drawable = TerrainDrawable::new(gpu, layouts, geometry, source.style)?;
    let mut draws = vec![NOTHING; OBJECT_LEVELS as usize];
    draws[0].index_count = indices.len() as u32;
    Ok((vec![Chunk::new(0..capacity, vec![Box::new(drawable)])], draws))
}

impl Endless {
    /// The finest ground at a world position; `None` in holes, and where heights of the elevation map are on their way.
    ///
    /// # Errors
    /// Those of the elevation map's source.
    pub fn point_at(&self, x: f64, z: f64) -> Result<Option<GroundPoint>, InputError> {
        self.ground.point_at(x, z, self.holes.as_deref().unwrap_or_default())
    }

    /// The ground on the host, without any patch.
    fn finest_ground(&self) -> Result<FinestGround, InputError> {
        FinestGround::new(&self.recipe, self.source.target.clone(), self.size.erosion, self.elevation.clone())
    }

    /// The first hit of a ray on the finest ground of a node, whose box it enters and leaves at `distances`. Finer nodes that are there
    /// bound their parts of the ground more tightly.
    fn hit_below(
        &self,
        node: Node,
        distances: [f64; 2],
        origin: DVec3,
        ray: &UnitRay,
        holes: &[TerrainHole],
    ) -> Result<Option<SurfaceHit>, InputError> {
        let children = node.children();
        if node.level == 0 || children.iter().all(|child| self.facts(*child).is_none()) {
            return self.ground.hit(distances, origin, ray, holes);
        }
        let entered = |child| Some((child, within(self.node_box(child), origin, ray.direction, ray.limit)?));
        let mut parts: Vec<_> = children.into_iter().filter_map(entered).collect();
        parts.sort_by(|(_, [one, _]), (_, [other, _])| one.total_cmp(other));
        let hits = parts.into_iter().map(|(child, at)| self.hit_below(child, at, origin, ray, holes));
        hits.filter_map(Result::transpose).next().transpose()
    }

    /// The nodes after the last frame.
    pub fn statistics(&self) -> EndlessStatistics {
        self.statistics
    }

    fn config(&self) -> &TerrainConfig {
        &self.recipe.config
    }

    /// Length of an edge of a node in world units.
    fn edge(&self, level: u32) -> f64 {
        f64::from(self.grid.cells) * self.config().terrain_scale * f64::from(1_u32 << level)
    }

    /// The lowest and the highest corner of a node's box in world units. A node whose facts are unknown has those of the node that
    /// covers it, or the bound of all heights.
    fn node_box(&self, node: Node) -> [DVec3; 2] {
        let known = (node.level..=self.grid.top).find_map(|level| self.facts(node.ancestor(level)));
        let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
        let [low, high] = known.map_or([-most, most], |facts| facts.heights);
        let edge = self.edge(node.level);
        let [x, z] = node.at.map(|at| f64::from(at) * edge);
        [DVec3::new(x, low, z), DVec3::new(x + edge, high, z + edge)]
    }

    /// The placement and the bounding sphere of a node.
    fn placed(&self, node: Node) -> Result<(Placement, BoundingSphere), InputError> {
        let [low, high] = self.node_box(node);
        let middle = 0.5 * (low + high);
        let placement = Placement::at_world([middle.x, 0.0, middle.z]).checked()?;
        // The sphere is slightly enlarged, to allow for rounding.
        let radius = (1.000_01 * (high - middle).length()) as f32;
        Ok((placement, BoundingSphere { center: Vec3::new(0.0, middle.y as f32, 0.0), radius }))
    }

    /// The coarsest nodes within the view distance of some eyes.
    fn roots(&self, eyes: &[DVec3]) -> BTreeSet<Node> {
        let (level, mut roots) = (self.grid.top, BTreeSet::new());
        let edge = self.edge(level);
        for eye in eyes {
            let range = |at: f64| {
                let end = |sign: f64| ((at + sign * self.view_distance) / edge).floor() as i32;
                end(-1.0)..=end(1.0)
            };
            for (x, z) in range(eye.z).flat_map(|z| range(eye.x).map(move |x| (x, z))) {
                let root = Node { level, at: [x, z] };
                // Only roots whose samples have world coordinates exist.
                let region = Region { width: 1, ..self.grid.region_of(root) };
                if region.validate(self.config()).is_ok() {
                    roots.insert(root);
                }
            }
        }
        roots
    }

    /// The facts of a node that has arrived from the device.
    fn facts(&self, node: Node) -> Option<Facts> {
        self.residents.get(&node)?.facts
    }

    /// The error of a node in world units, with the holes that it lacks.
    fn error(&self, node: Node) -> Option<f32> {
        Some(self.facts(node)?.error.max(self.hole_error(node)))
    }

    /// Whether a node's error exceeds the displacement that a view allows. `fraction` is the part of the displacement that counts.
    fn is_beyond(&self, view: &SelectView, fraction: f32, node: Node) -> bool {
        let Some(error) = self.error(node) else { return false };
        let [low, high] = self.node_box(node).map(|at| at - Placement::corner(view.cell.into()));
        // A sphere around parts of the node allows more than one around the whole node.
        let allows = |parts: u32| {
            let part = (high - low) / DVec3::new(parts.into(), 1.0, parts.into());
            let half = 0.5 * part;
            let radius = (1.000_01 * half.length()) as f32;
            (0..parts * parts).all(|at| {
                let at = DVec3::new(f64::from(at % parts), 0.0, f64::from(at / parts));
                let center = (low + at * part + half).as_vec3();
                let radius = radius + self.depth();
                view.cameras().iter().all(|camera| error <= fraction * allowed_around(camera, center, radius))
            })
        };
        !allows(1) && !allows(PARTS)
    }

    /// The largest distance in world units by which erosion moves heights.
    fn depth(&self) -> f32 {
        self.size.erosion.map_or(0.0, |limit| limit.depth as f32)
    }

    /// Where an eroded node that is drawn meets nodes that are not eroded ([`TerrainNode::plain`]). `plain` are those that are drawn.
    fn plain_beside(&self, leaf: &Leaf, plain: &BTreeSet<Node>) -> u32 {
        let node = leaf.node;
        if plain.is_empty() || !self.grid.is_eroded(self.size, node.level) {
            return 0;
        }
        let is_last = !self.grid.is_eroded(self.size, node.level + 1);
        let sides = leaf.sides.map(|beside| is_last && beside == Beside::Coarser);
        let corners = [[-1, -1], [1, -1], [-1, 1], [1, 1]].map(|corner| {
            let beside = node.beside(corner);
            (node.level + 1..=self.grid.top).any(|level| plain.contains(&beside.ancestor(level)))
        });
        let bits = sides.into_iter().chain(corners).enumerate();
        bits.filter(|(_, is_plain)| *is_plain).fold(0, |bits, (at, _)| bits | 1 << at)
    }

    /// The error of a node because of holes, which only the finest nodes have: the width of the widest hole that is missing.
    fn hole_error(&self, node: Node) -> f32 {
        let (edge, scale) = (self.edge(node.level), self.config().terrain_scale);
        let corner = node.at.map(|at| f64::from(at) * edge);
        let missing = self.holes.iter().flatten().filter(|_| node.level > 0);
        missing.map(|hole| hole.width_in(corner, edge, scale)).fold(0.0, f32::max)
    }

    /// Replaces the holes.
    ///
    /// # Errors
    /// [`InputError`] for terrain that was added without holes, and for a hole out of bounds.
    pub fn set_holes(&mut self, holes: &[TerrainHole]) -> Result<(), InputError> {
        check_holes(holes)?;
        let Some(own) = &mut self.holes else {
            let bound = "must be made with TerrainSource::with_holes, which may be none at first";
            return Err(InputError::new("terrain", "without holes", bound));
        };
        *own = holes.to_vec();
        self.are_holes_changed = true;
        Ok(())
    }

    /// Stores the facts that have arrived. Returns the nodes whose facts are new.
    fn arrive(&mut self) -> Vec<Node> {
        let Some((frame, facts)) = self.pool.arrived() else { return Vec::new() };
        let mut known = Vec::new();
        for (node, resident) in &mut self.residents {
            if resident.found.is_none() && resident.made <= frame {
                let needs_both = self.grid.is_eroded(self.size, node.level);
                let is_there = |facts: &FoundFacts| !needs_both || facts.other.is_some();
                let found = facts.get(resident.slot as usize).copied().flatten();
                resident.found = found.filter(|found| found.iter().all(is_there));
                known.extend(resident.found.map(|_| *node));
            }
        }
        self.find_facts(&known);
        known
    }

    /// Finds the facts of nodes from what the device found.
    fn find_facts(&mut self, nodes: &[Node]) {
        let (config, grid) = (&self.recipe.config, self.grid);
        let target = self.source.target.as_ref().zip(self.target_offsets.as_ref());
        for node in nodes {
            let Some(resident) = self.residents.get_mut(node) else { continue };
            let beyond = resident.beyond;
            let of = |config: &TerrainConfig, offsets: &FeatureOffsets, FoundFacts { own, other }| {
                let below =
                    |own, other| facts_of(config, offsets, grid, *node, &FoundFacts { own, other }, beyond);
                match (self.size.erosion, other) {
                    (None, _) => below(own, other),
                    (Some(limit), Some(eroded)) if grid.is_eroded(self.size, node.level) => {
                        below(own, None).eroded(below(eroded, None), limit.depth)
                    }
                    (Some(limit), _) => below(own, other).beside_eroded(limit.depth),
                }
            };
            let facts = resident.found.map(|[own, other]| {
                let own = of(config, &self.offsets, own);
                let other = target.map(|((target, _), offsets)| of(&target.config, offsets, other));
                other.map_or(own, |other| own.blended(other))
            });
            resident.facts = facts.or(resident.facts);
        }
    }

    /// Replaces the injected heights. The nodes that they change are made again: at once if those in use are at most half of what a
    /// frame may make, and otherwise coarsest first.
    ///
    /// # Errors
    /// [`InputError`] for heights out of bounds.
    pub fn set_features(&mut self, features: &Features) -> Result<(), InputError> {
        Recipe { features: features.clone(), ..self.recipe.clone() }.validate(&[], 0)?;
        let mut elevation = self.elevation.clone();
        let recipe = generated(&self.recipe, features, elevation.as_mut());
        let offsets = offsets_of(&recipe, elevation.as_ref());
        let mut changed = self.offsets.changed(&offsets);
        let maps = elevation.as_ref().zip(self.elevation.as_ref());
        changed.extend(maps.into_iter().flat_map(|(new, old)| new.changed(old)));
        (self.recipe, self.offsets, self.elevation) = (recipe, offsets, elevation);
        self.ground = self.finest_ground()?;
        let is_region_changed = |region| changed.iter().any(|point: &ChangedPoint| point.changes(region));
        self.pool.forget_eroded(is_region_changed);
        let apron = self.recipe.apron(0);
        let is_changed = |node: &Node| {
            let own = self.grid.region_of(*node);
            // Erosion carries a change as far as its iterations reach.
            is_region_changed(if self.grid.is_eroded(self.size, node.level) { own.grown(apron) } else { own })
        };
        let stale: Vec<Node> = self.residents.keys().filter(|node| is_changed(node)).copied().collect();
        let is_used = |node: &Node| self.residents.get(node).is_some_and(|own| own.used == self.frame);
        let again: BTreeSet<Node> =
            stale.iter().filter(|node| is_used(node)).chain(&self.again).copied().collect();
        let at_once = again.len() <= self.limits.nodes_per_frame as usize / 2;
        // The coarsest nodes are always drawn, so they keep their places.
        let stays = |node: &Node| node.level == self.grid.top || at_once && again.contains(node);
        let (again, gone): (Vec<Node>, Vec<Node>) =
            stale.into_iter().chain(self.again.iter().copied()).partition(stays);
        for node in gone {
            self.free.extend(self.residents.remove(&node).map(|resident| resident.slot));
        }
        self.again = again.into_iter().collect();
        // Bounds of what coarser nodes lack have changed, too.
        let all: Vec<Node> = self.residents.keys().copied().collect();
        self.find_facts(&all);
        for node in &self.again {
            let by = ChangedPoint::bound(&changed, self.grid.region_of(*node)) as f64 / HEIGHT_ONE;
            let facts = self.residents.get_mut(node).and_then(|own| own.facts.as_mut());
            if let Some(Facts { heights: [low, high], .. }) = facts {
                (*low, *high) = (*low - by, *high + by);
            }
        }
        self.are_bounds_changed = true;
        Ok(())
    }

    /// Blends the heights of the two recipes at another time, from the next frame on.
    ///
    /// # Errors
    /// [`InputError`] for terrain without a target, and for a time out of range.
    pub fn morph(&mut self, morph: Morph) -> Result<(), InputError> {
        morph.validate()?;
        let Some((_, current)) = &mut self.source.target else { return Err(super::without_target()) };
        if *current != morph {
            *current = morph;
            self.ground = self.finest_ground()?;
            self.pool.blend_again();
        }
        Ok(())
    }

    /// Makes nodes again whose heights have changed, in their places, the coarsest first. Until facts about them arrive, the old ones
    /// count.
    ///
    /// # Errors
    /// Those of the elevation map's source.
    fn make_again(&mut self) -> Result<(), Error> {
        let mut awaited = BTreeSet::new();
        while self.new.len() < self.limits.nodes_per_frame as usize / 2
            && let Some(node) = self.again.pop_last()
        {
            let Some(elevation) = self.given_to(node)? else {
                awaited.insert(node);
                continue;
            };
            let Some(resident) = self.residents.get_mut(&node) else { continue };
            resident.beyond = elevation.as_ref().map_or(Beyond::Generated, |given| given.beyond);
            if let (Some(Facts { heights: [low, high], .. }), Some(given)) = (&mut resident.facts, &elevation)
            {
                let [lowest, highest] = given.range();
                (*low, *high) = (low.min(lowest), high.max(highest));
            }
            (resident.made, resident.used, resident.found) = (self.frame, self.frame, None);
            self.new.push(NewNode { node, slot: resident.slot, elevation });
        }
        self.statistics.awaited += awaited.len();
        self.again.extend(awaited);
        Ok(())
    }

    /// Gives a node a place in the pool, and makes it in this frame. Leaves it out if its heights are on their way, or if all places are
    /// in use.
    ///
    /// # Errors
    /// Those of the elevation map's source.
    fn admit(&mut self, node: Node) -> Result<(), Error> {
        let given = self.given_to(node)?;
        if given.is_none() {
            self.statistics.awaited += 1;
            // The coarsest nodes are always drawn: without the map, until its heights are there.
            if node.level < self.grid.top {
                return Ok(());
            }
            self.again.insert(node);
        }
        let elevation = given.flatten();
        if self.free.is_empty() {
            // Siblings leave together: without one of them, the others cannot be drawn.
            let unused = self.residents.iter().filter(|(_, resident)| resident.used < self.frame);
            let oldest = unused.min_by_key(|(node, resident)| (resident.used, **node)).map(|(node, _)| *node);
            let family = match oldest {
                None => Vec::new(),
                Some(oldest) if oldest.level == self.grid.top => vec![oldest],
                Some(oldest) => oldest.parent().children().to_vec(),
            };
            let left = family.iter().filter_map(|node| self.residents.remove(node));
            self.free.extend(left.map(|resident| resident.slot));
            self.new.retain(|new| !family.contains(&new.node));
        }
        let Some(slot) = self.free.pop() else {
            self.statistics.refused += 1;
            return Ok(());
        };
        let beyond = elevation.as_ref().map_or(Beyond::Generated, |given| given.beyond);
        let resident =
            Resident { slot, used: self.frame, made: self.frame, beyond, found: None, facts: None };
        self.residents.insert(node, resident);
        self.new.push(NewNode { node, slot, elevation });
        Ok(())
    }

    /// The heights that the elevation map gives to a node: `Some(None)` if the map does not reach the node, and `None` while heights are
    /// on their way.
    fn given_to(&mut self, node: Node) -> Result<Option<Option<NodeElevation>>, Error> {
        let Some(map) = &self.elevation else { return Ok(Some(None)) };
        let region = self.grid.region_of(node);
        let around = self.pool.around(node);
        if !map.reaches(around.unwrap_or(region)) {
            return Ok(Some(None));
        }
        let config = &self.recipe.config;
        let heights = |region| map.heights(self.pool.given_region(config, region));
        let own_region = self.pool.given_region(config, region);
        let own = map.plain(own_region)?;
        let plain = own.as_deref().unwrap_or_default();
        let beyond = map.beyond(config, &self.offsets, region, plain, self.grid.cells_of(node))?;
        if let Some(around) = around
            && !self.given_around.iter().any(|(region, _)| *region == around)
        {
            self.given_around.push((around, heights(around)?.map(Arc::new)));
        }
        let around = around.map(|around| {
            let mut known = self.given_around.iter().filter(|(region, _)| *region == around);
            known.find_map(|(_, heights)| heights.clone())
        });
        Ok(match (own, around, beyond) {
            (Some(plain), around @ (None | Some(Some(_))), Some(beyond)) => {
                let (heights, around) = (Arc::new(map.with_features(own_region, plain)), around.flatten());
                Some(Some(NodeElevation { heights, around, beyond }))
            }
            _ => None,
        })
    }

    /// Admits the nodes that the frame makes: roots first, then the children that views miss. Coarser nodes come first, since finer ones
    /// cannot be drawn without them; of one level, the nearest.
    fn admit_missing(&mut self, missing: &[Node], eyes: &[DVec3]) -> Result<(), Error> {
        let distance = |node: &Node| {
            let [low, high] = self.node_box(*node);
            let to = |eye: &DVec3| eye.distance(eye.clamp(low, high));
            eyes.iter().map(to).fold(f64::INFINITY, f64::min)
        };
        let mut nearest: Vec<(f64, Node)> = missing.iter().map(|node| (distance(node), *node)).collect();
        nearest.sort_by(|one, other| {
            other.1.level.cmp(&one.1.level).then(one.0.total_cmp(&other.0)).then(one.1.cmp(&other.1))
        });
        nearest.dedup_by_key(|(_, node)| *node);
        for (_, parent) in nearest {
            if self.new.len() + self.statistics.awaited + BATCH > self.limits.nodes_per_frame as usize {
                break;
            }
            let absent: Vec<Node> =
                parent.children().into_iter().filter(|node| !self.residents.contains_key(node)).collect();
            for node in absent {
                self.admit(node)?;
            }
        }
        Ok(())
    }

    /// The limit of a node's vertices: the displacement at which the next coarser level is allowed, or more if the node itself is
    /// nearly as far off.
    fn limit(&self, node: Node) -> f32 {
        if node.level == self.grid.top {
            return f32::MAX;
        }
        let coarser = self.error(node.parent()).unwrap_or(f32::MAX);
        coarser.max(self.error(node).unwrap_or(0.0) / MORPH_START)
    }

    /// How a view draws its nodes.
    fn table(&self, view: &SelectView, fraction: f32, cover: &Cover) -> ViewTable {
        let nobody = TerrainNode { borders: [0.0; 4], inner: 0.0, plain: 0, unused_b: 0.0, unused_c: 0.0 };
        let capacity = self.statistics.capacity;
        let leaves = cover.leaves.iter().map(|leaf| leaf.node).filter(|_| self.size.erosion.is_some());
        let plain = leaves.filter(|node| !self.grid.is_eroded(self.size, node.level)).collect();
        let (mut nodes, mut shown) = (vec![nobody; capacity], vec![0_u32; capacity.div_ceil(32)]);
        for leaf @ Leaf { node, sides } in &cover.leaves {
            let Some(Resident { slot, .. }) = self.residents.get(node).copied() else { continue };
            let own = self.limit(*node);
            let border = |beside: &Beside| match beside {
                Beside::Nothing | Beside::Finer => f32::MAX,
                Beside::Coarser => STITCHED,
                Beside::Same(other) => own.max(self.limit(*other)),
            };
            nodes[slot as usize] = TerrainNode {
                borders: sides.each_ref().map(border),
                inner: own,
                plain: self.plain_beside(leaf, &plain),
                ..nobody
            };
            shown[slot as usize / 32] |= 1 << (slot % 32);
        }
        let allows = TerrainFrame { cameras: view.cameras, camera_count: view.camera_count, fraction };
        ViewTable { nodes, shown, allows }
    }

    /// Chooses what the views of a frame draw, and what the frame makes. Returns the instances that are placed anew.
    fn choose(
        &mut self,
        views: &[SelectView],
        limits: &[Option<u32>],
        fraction: f32,
    ) -> Result<Vec<Node>, Error> {
        let views = &views.iter().map(with_pixels).collect::<Vec<_>>()[..];
        self.view_biases.resize(views.len(), 1.0);
        self.frame += 1;
        self.new.clear();
        self.given_around.clear();
        let mut moved = self.arrive();
        if std::mem::take(&mut self.are_bounds_changed) {
            moved = self.residents.keys().copied().collect();
        }
        (self.statistics.refused, self.statistics.awaited) = (0, 0);
        self.make_again()?;
        let eyes: Vec<DVec3> = (views.iter())
            .flat_map(|view| {
                let corner = Placement::corner(view.cell.into());
                view.cameras().iter().map(move |camera| corner + camera.eye.as_dvec3())
            })
            .collect();
        let roots = self.roots(&eyes);
        for root in &roots {
            match self.residents.get_mut(root) {
                Some(resident) => resident.used = self.frame,
                // The roots of one camera fit the smallest limit. Those of many may have to wait.
                None if self.new.len() < self.limits.nodes_per_frame as usize => self.admit(*root)?,
                None => {}
            }
        }
        let (mut missing, mut soon, mut tables) = (Vec::new(), Vec::new(), Vec::new());
        let (mut wanted, mut split, mut drawn, mut unknown, mut levels) = (0, 0, 0, 0, [0; 18]);
        for (index, view) in views.iter().enumerate() {
            let limit = limits.get(index).copied().flatten();
            let (bias, cover) = self.within_limit(view, fraction, &roots, limit, self.view_biases[index]);
            self.view_biases[index] = bias;
            let fraction = fraction * bias;
            (wanted, split, drawn) =
                (wanted + cover.wanted.len(), split + cover.splits.len(), drawn + cover.leaves.len());
            let leaves = cover.leaves.iter().map(|leaf| leaf.node);
            let near: Vec<Node> = leaves
                .clone()
                .filter(|node| node.level > 0 && self.is_beyond(view, SOON * fraction, *node))
                .collect();
            let children = cover.wanted.iter().chain(&near).flat_map(|node| node.children());
            for node in children.chain(leaves).collect::<Vec<_>>() {
                if let Some(resident) = self.residents.get_mut(&node) {
                    resident.used = self.frame;
                }
            }
            // A node without facts may have to be refined.
            let is_unknown = |leaf: &&Leaf| {
                let is_found = |own: &Resident| leaf.node.level == 0 || own.found.is_some();
                !self.residents.get(&leaf.node).is_some_and(is_found) || self.again.contains(&leaf.node)
            };
            unknown += cover.leaves.iter().filter(is_unknown).count();
            for leaf in &cover.leaves {
                levels[leaf.node.level as usize] += 1;
            }
            tables.push(self.table(view, fraction, &cover));
            missing.extend(cover.missing);
            soon.extend(near);
        }
        missing.sort_unstable();
        missing.dedup();
        self.retune(missing.len());
        self.admit_missing(&missing, &eyes)?;
        self.admit_missing(&soon, &eyes)?;
        *self.tables.lock().unwrap_or_else(std::sync::PoisonError::into_inner) = tables;
        moved.extend(self.new.iter().map(|new| new.node));
        let open = (wanted - split) + unknown;
        self.statistics = EndlessStatistics {
            nodes: self.residents.len(),
            made: self.new.len(),
            drawn,
            levels,
            ready: if open == 0 { 1.0 } else { (split as f32 / (split + open) as f32).min(0.999) },
            ..self.statistics
        };
        Ok(moved)
    }

    /// The nodes that a view draws within its limit of triangles, and the factor of the allowed displacement at which they fit it. The
    /// factor grows at once, and falls gradually from that of the last frame.
    fn within_limit(
        &self,
        view: &SelectView,
        fraction: f32,
        roots: &BTreeSet<Node>,
        limit: Option<u32>,
        last: f32,
    ) -> (f32, Cover) {
        let cover_at = |bias: f32| {
            let is_wanted = |node: Node| self.is_beyond(view, fraction * bias, node);
            Cover::new(roots, is_wanted, |node| self.residents.contains_key(&node))
        };
        let Some(limit) = limit else { return (1.0, cover_at(1.0)) };
        let corner = Placement::corner(view.cell.into());
        let is_seen = |leaf: &&Leaf| {
            let [low, high] = self.node_box(leaf.node).map(|at| at - corner);
            nearly_seen(view, (0.5 * (low + high)).as_vec3(), (0.500_01 * (high - low).length()) as f32)
        };
        let triangles = |cover: &Cover| {
            cover.leaves.iter().filter(is_seen).count() as u64 * 2 * u64::from(self.grid.cells).pow(2)
        };
        let fits = |cover: &Cover| triangles(cover) <= u64::from(limit);
        let finer = (BIAS_FALL * last).max(1.0);
        let cover = cover_at(finer);
        if fits(&cover) {
            return (finer, cover);
        }
        // The smallest factor is between `low` and `high`, which may be too small too if the coarsest nodes exceed the limit.
        let (mut low, mut high, mut fitting) = (finer, MOST_VIEW_BIAS, cover_at(MOST_VIEW_BIAS));
        for _ in 0..BIAS_STEPS {
            let middle = (low * high).sqrt();
            let cover = cover_at(middle);
            match fits(&cover) {
                true => (high, fitting) = (middle, cover),
                false => low = middle,
            }
        }
        (high, fitting)
    }

    /// Chooses what a frame draws and makes, and prepares it.
    fn chosen(
        &mut self,
        gpu: &Gpu,
        views: &[SelectView],
        limits: &[Option<u32>],
        fraction: f32,
    ) -> Result<Provided, Error> {
        let moved = self.choose(views, limits, fraction)?;
        self.pool.make(gpu, Recipes::new(&self.recipe, &self.source), &self.new)?;
        let placed = moved.into_iter().filter_map(|node| Some((node, self.residents.get(&node)?.slot)));
        let placed = placed.map(|(node, slot)| {
            let (placement, sphere) = self.placed(node)?;
            Ok((slot, placement, sphere))
        });
        let placed = placed.collect::<Result<_, InputError>>()?;
        let lod_bias = self.view_biases.iter().copied().fold(1.0, f32::max) * self.lod_bias;
        Ok(Provided { lod_bias, placed, ..Provided::default() })
    }

    /// Takes back the nodes that a frame which fails would have made.
    fn undo(&mut self) {
        for NewNode { node, slot, .. } in std::mem::take(&mut self.new) {
            match self.residents.get(&node) {
                // Its old heights are there.
                Some(resident) if resident.facts.is_some() => drop(self.again.insert(node)),
                _ => {
                    self.residents.remove(&node);
                    self.free.push(slot);
                }
            }
        }
        self.pool.forget_eroded(|_| true);
        self.are_bounds_changed = true;
    }

    /// Makes levels coarser while the nodes that are needed exceed the memory, and finer again when there is room.
    fn retune(&mut self, missing: usize) {
        let used = self.residents.values().filter(|resident| resident.used == self.frame).count();
        let needed = used + BATCH * missing;
        let capacity = self.statistics.capacity;
        // The number of nodes falls with the square of the allowed displacement.
        let ratio = (needed as f32 / capacity as f32).sqrt();
        if needed > capacity || 4 * needed < 3 * capacity {
            self.lod_bias = (self.lod_bias * ratio.clamp(0.95, 1.25)).clamp(1.0, MOST_BIAS);
        }
    }

    /// Forgets all nodes.
    fn forget(&mut self) {
        self.residents.clear();
        self.lod_bias = 1.0;
        self.free = (0..self.statistics.capacity as u32).rev().collect();
        self.new.clear();
        self.again.clear();
    }
}

/// A view that permits at least [`LEAST_PIXELS`].
fn with_pixels(view: &SelectView) -> SelectView {
    let mut view = *view;
    view.cameras.iter_mut().for_each(|camera| camera.pixels = camera.pixels.max(LEAST_PIXELS));
    view
}

/// The recipe with the injected heights `features` that the generator injects; the elevation map has the others.
fn generated(recipe: &Recipe, features: &Features, elevation: Option<&mut Elevation>) -> Recipe {
    let features = elevation.map_or_else(|| features.clone(), |map| map.set_features(features));
    Recipe { features, ..recipe.clone() }
}

/// The injected heights of a recipe, by how much they matter.
fn offsets_of(recipe: &Recipe, elevation: Option<&Elevation>) -> FeatureOffsets {
    let is_near = |sample| elevation.is_some_and(|map| map.is_near(sample));
    FeatureOffsets::new(&recipe.config, &recipe.features, is_near)
}

/// Checks the target of a terrain with some nodes.
///
/// # Errors
/// [`InputError`] for a target of which no nodes can be made, or whose base lattice has another distance between its points.
fn check_target(config: &TerrainConfig, target: &Recipe, grid: Grid) -> Result<(), InputError> {
    target.validate(&[], 0)?;
    let levels = (target.config.coarse_levels, config.coarse_levels);
    InputError::check_same("coarse_levels", levels.0, levels.1, "as at time 0")?;
    pool::check(target, grid)
}

fn check_holes(holes: &[TerrainHole]) -> Result<(), InputError> {
    let below = |(at, hole): (usize, &TerrainHole)| {
        hole.validate().map_err(|error| error.below(&format!("holes[{at}]")))
    };
    holes.iter().enumerate().try_for_each(below)
}

/// The displacement that a camera allows to a sphere if it turns towards it. Spheres that it does not see as it is may be
/// [`OUTSIDE`] times coarser.
fn allowed_around(camera: &LodCamera, center: Vec3, radius: f32) -> f32 {
    let towards = center - camera.eye;
    let distance = towards.length();
    if camera.perspective == 0.0 || distance <= radius {
        return camera.allows(center, radius);
    }
    // The picture lies in a cone around the axis: its diagonal is at most 2.1 times the root of the number of its pixels, as long as
    // its sides are at most 4 : 1.
    let half_angle = (1.05 * camera.pixel_count.sqrt() / camera.focal).atan();
    let aside = camera.ahead.angle_between(towards) - (radius / distance).asin();
    if aside <= half_angle {
        return camera.allows(center, radius);
    }
    OUTSIDE * LodCamera { ahead: towards / distance, ..*camera }.allows(center, radius)
}

/// The facts of a node, from what the device found and what lies below, finer injected heights among it.
fn facts_of(
    config: &TerrainConfig,
    offsets: &FeatureOffsets,
    grid: Grid,
    node: Node,
    FoundFacts { own, other: generated }: &FoundFacts,
    beyond: Beyond,
) -> Facts {
    let region = grid.region_of(node);
    let below = |facts: &NodeFacts| remainder(config, region.coarser, 2 * i64::from(facts.second_difference));
    // Without the map, the region would be bounded by its generated heights.
    let without = generated.as_ref().map_or(0, below);
    let below = match beyond {
        Beyond::Generated => below(own),
        Beyond::Map(distance) => without.max(distance),
        Beyond::Further(distance) => without + distance,
    };
    let [low, high] = [i64::from(own.lowest) - below, i64::from(own.highest) + below];
    let below = below + offsets.bound(config, region, [low, high]);
    // Smooth interpolation is linear only where no height is clamped.
    let largest = i64::from(own.lowest.unsigned_abs().max(own.highest.unsigned_abs()));
    let below = if largest + below > HEIGHT_LIMIT { 2 * HEIGHT_LIMIT } else { below };
    let deviation = i64::from(own.deviation.max(if node.level > 0 { own.stitched } else { 0 }));
    let world = |height: i64| height as f64 / HEIGHT_ONE;
    let heights = [i64::from(own.lowest) - below, i64::from(own.highest) + below].map(world);
    Facts { heights, error: (world(deviation + below) as f32).next_up() }
}

/// What rounding adds to the error of blended heights, in 1/65536 height units: of a height, and of the triangle's.
const BLENDED: i64 = 2;

impl Facts {
    /// The facts of heights between these and others: the surface between two triangles is as far from the heights between as the
    /// farther one.
    fn blended(self, other: Self) -> Self {
        let rounding = BLENDED as f64 / HEIGHT_ONE;
        let ([low, high], [other_low, other_high]) = (self.heights, other.heights);
        Self {
            heights: [low.min(other_low) - rounding, high.max(other_high) + rounding],
            error: (self.error.max(other.error) + rounding as f32).next_up(),
        }
    }

    /// The facts of a node whose heights lie between these and eroded ones, at most `depth` away. Of what a view allows, erosion that is
    /// not shown takes at most half, so the node's own error may take the other half.
    fn eroded(self, eroded: Self, depth: f64) -> Self {
        let [low, high] = self.heights;
        Self { heights: [low - depth, high + depth], error: 2.0 * self.error.max(eroded.error) }
    }

    /// The facts of a node that is not eroded, in terrain whose finest nodes are, by at most `depth`. Such nodes are drawn where a
    /// view allows twice the depth.
    fn beside_eroded(self, depth: f64) -> Self {
        let [low, high] = self.heights;
        Self { heights: [low - depth, high + depth], error: 2.0 * self.error.max(depth as f32) }
    }
}

impl ObjectKind for Endless {
    fn name(&self) -> &'static str {
        "terrain"
    }

    fn is_spawned(&self) -> bool {
        false
    }

    fn is_complete(&self) -> bool {
        self.statistics.ready == 1.0 && self.is_bounded
    }

    /// Makes all nodes afresh: the device may have missed some.
    fn renew(&mut self, target: MakeOn<'_>, _: &mut Vec<Chunk>) -> Result<(), Error> {
        self.pool.invalidate(target.gpu)?;
        self.forget();
        Ok(())
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, .. } = target;
        Box::pin(async move {
            let pool = Pool::new(gpu, Recipes::new(&self.recipe, &self.source), self.grid, self.size)?;
            let (chunks, _) = drawn(gpu, layouts, &self.source, &pool)?;
            Ok(OnDevice { chunks, other: Box::new(pool) })
        })
    }

    fn adopt(&mut self, other: Box<dyn Made>) {
        let other: Box<dyn Any> = other;
        if let Ok(pool) = other.downcast() {
            self.pool = *pool;
            self.forget();
        }
    }

    fn in_view(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        number: u32,
    ) -> Result<Option<Box<dyn KindInView>>, Error> {
        let (spacing, capacity) = (self.config().terrain_scale, self.statistics.capacity);
        let in_view = EndlessInView::new(gpu, layouts, spacing, number, capacity, self.tables.clone())?;
        Ok(Some(Box::new(in_view)))
    }

    fn provide(
        &mut self,
        gpu: &Gpu,
        _: &SceneLayouts,
        seen: &SeenBy<'_>,
        _: &mut Vec<Chunk>,
    ) -> Result<Provided, Error> {
        let asked = seen.views.iter().flat_map(SelectView::cameras).map(|camera| camera.pixels);
        self.is_bounded = asked.fold(f32::INFINITY, f32::min) >= LEAST_PIXELS;
        let fraction = seen.object.metric_scale * self.lod_bias;
        let provided = self.chosen(gpu, seen.views, seen.triangle_limits, fraction);
        if provided.is_err() {
            self.undo();
        }
        provided
    }

    fn stage(&mut self, staged: &mut Staged, _: &Frame, _: f64) -> Result<(), Error> {
        let (config, holes) = (&self.recipe.config, self.holes.as_deref().unwrap_or_default());
        if std::mem::take(&mut self.are_holes_changed) {
            let finest = self.residents.iter().filter(|(node, _)| node.level == 0);
            for (node, Resident { slot, .. }) in finest {
                self.pool.stage_patch(staged, config, *node, *slot, holes)?;
            }
        }
        let time = self.source.target.as_ref().map_or_else(Morph::default, |(_, time)| *time);
        self.pool.stage(staged, Recipes::new(&self.recipe, &self.source), time, holes)
    }

    fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let reads = self.residents.values().any(|resident| resident.found.is_none());
        self.pool.record(encoder, self.frame, reads);
    }

    /// The first hit of a ray on the finest ground. The coarsest nodes answer for all others.
    fn hit(&self, instance: &Placed, ray: &UnitRay) -> Result<Option<SurfaceHit>, InputError> {
        // The coarsest nodes come last in the order of nodes.
        let mut roots = self.residents.iter().rev().take_while(|(node, _)| node.level == self.grid.top);
        let Some((node, _)) = roots.find(|(_, resident)| resident.slot == instance.index) else {
            return Ok(None);
        };
        let (origin, holes) = (Placement::corner(instance.cell) + ray.origin, self.holes.as_deref());
        let distances = within(self.node_box(*node), origin, ray.direction, ray.limit);
        let Some(distances) = distances else { return Ok(None) };
        self.hit_below(*node, distances, origin, ray, holes.unwrap_or_default())
    }

    fn tight_box(&self, instance: &Placed) -> Result<[DVec3; 2], InputError> {
        Ok(instance.sphere_box)
    }

    fn wide_box(&self, instance: &Placed) -> Result<Option<[DVec3; 2]>, InputError> {
        Ok(Some(instance.sphere_box))
    }
}
