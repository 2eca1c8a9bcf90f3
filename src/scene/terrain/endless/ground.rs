//! The finest ground of endless terrain on the host, made where it is asked for.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use glam::DVec3;

use super::elevation::Elevation;
use super::hole::TerrainHole;
use crate::scene::object_kind::UnitRay;
use crate::scene::ray::SurfaceHit;
use crate::terrain::config::TerrainConfig;
use crate::terrain::field::{finish, region_of};
use crate::terrain::ground::{Ground, slab};
use crate::terrain::lattice::Given;
use crate::terrain::limit::ErosionLimit;
use crate::terrain::limit::reference::{ErodedAt, limit as limited};
use crate::terrain::mesh::GroundPoint;
use crate::terrain::morph::Morph;
use crate::terrain::morph::reference::morph;
use crate::terrain::recipe::Recipe;
use crate::terrain::window::Region;
use crate::{Error, InputError};

/// Samples along an edge of a patch.
const SIZE: u32 = 33;

/// The same of eroded ground, which needs samples around each patch.
const ERODED_SIZE: u32 = 129;

/// Largest number of patches that are kept.
const KEPT: usize = 1024;

/// Patches of the finest ground; the last that were asked for are kept.
#[derive(Debug)]
pub(super) struct FinestGround {
    recipe: Recipe,
    target: Option<(Box<Recipe>, Morph)>,
    erosion: Option<ErosionLimit>,
    elevation: Option<Elevation>,
    /// The terrain in patches of [`SIZE`] or [`ERODED_SIZE`] samples.
    patch: TerrainConfig,
    edge: f64,
    patches: Mutex<Patches>,
}

#[derive(Debug)]
struct Patches {
    ground: Ground,
    /// The patches of `ground`, the oldest first.
    order: VecDeque<[i32; 2]>,
}

impl FinestGround {
    pub fn new(
        recipe: &Recipe,
        target: Option<(Box<Recipe>, Morph)>,
        erosion: Option<ErosionLimit>,
        elevation: Option<Elevation>,
    ) -> Result<Self, InputError> {
        let patch_size = if erosion.is_some() { ERODED_SIZE } else { SIZE };
        let patch = TerrainConfig { patch_size, ..recipe.config.clone() };
        let patches = Patches { ground: Ground::new(&patch)?, order: VecDeque::new() };
        let edge = patch.edge_length();
        let (recipe, patches) = (recipe.clone(), Mutex::new(patches));
        Ok(Self { recipe, target, erosion, elevation, patch, edge, patches })
    }

    /// The ground at a world position; `None` beyond the world and in holes.
    pub fn point_at(&self, x: f64, z: f64, holes: &[TerrainHole]) -> Result<Option<GroundPoint>, InputError> {
        if self.is_left_out(x, z, holes) {
            return Ok(None);
        }
        let Some(patch) = self.patch_at(x, z) else { return Ok(None) };
        Ok(self.with(patch)?.and_then(|patches| patches.ground.point_at(x, z)))
    }

    /// Whether the triangle at a world position is left out, because a corner of it lies in a hole.
    fn is_left_out(&self, x: f64, z: f64, holes: &[TerrainHole]) -> bool {
        let scale = self.patch.terrain_scale;
        let [u, v] = [x, z].map(|at| at / scale);
        let [column, row] = [u.floor(), v.floor()];
        // The diagonal of a cell runs from south-west to north-east.
        let corner = if (u - column) + (v - row) <= 1.0 { [0, 0] } else { [1, 1] };
        let corners = [corner, [1, 0], [0, 1]];
        let samples = corners.map(|[x, z]| [column as i64 + x, row as i64 + z]);
        holes.iter().any(|hole| samples.iter().any(|sample| hole.contains(*sample, scale)))
    }

    /// The first hit of a ray, not in a hole. `from` and `to` are distances: all patches in which the ray lies between them are
    /// searched. `origin` is the ray's in world units.
    pub fn hit(
        &self,
        [mut from, to]: [f64; 2],
        origin: DVec3,
        ray: &UnitRay,
        holes: &[TerrainHole],
    ) -> Result<Option<SurfaceHit>, InputError> {
        // A step beyond each border, so that the next patch is found whatever the rounding.
        let step = 1e-9 * self.edge;
        while from <= to {
            let at = origin + (from + step) * ray.direction;
            let Some(patch) = self.patch_at(at.x, at.z) else { return Ok(None) };
            let corner = DVec3::new(f64::from(patch[0]), 0.0, f64::from(patch[1])) * self.edge;
            // A hit in a hole is passed.
            let mut passed = 0.0;
            while let Some(patches) = self.with(patch)?
                && let start = origin + passed * ray.direction
                && let Some(hit) =
                    patches.ground.hit(patch, [start - corner, ray.direction], ray.limit - passed)
            {
                let distance = passed + hit.distance;
                let at = origin + distance * ray.direction;
                if !self.is_left_out(at.x, at.z, holes) {
                    return Ok(Some(SurfaceHit { distance, normal: hit.normal }));
                }
                passed = distance + 1e-6 * self.patch.terrain_scale;
            }
            let through =
                [0, 2].map(|axis| slab([0.0, self.edge], origin[axis] - corner[axis], ray.direction[axis]));
            let next = through.into_iter().flatten().map(|[_, leave]| leave).fold(f64::INFINITY, f64::min);
            if !next.is_finite() {
                return Ok(None);
            }
            from = next.max(from + step);
        }
        Ok(None)
    }

    fn patch_at(&self, x: f64, z: f64) -> Option<[i32; 2]> {
        let [column, row] = [x, z].map(|at| (at / self.edge).floor());
        let is_index = |at: f64| (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&at);
        (is_index(column) && is_index(row)).then_some([column as i32, row as i32])
    }

    /// The heights of a region; `None` while heights of the elevation map are on their way.
    fn heights(&self, samples: Region) -> Result<Option<Vec<i32>>, InputError> {
        let finest = |recipe: &Recipe, given: Option<&Given<'_>>| match self.erosion {
            Some(limit) => eroded_region(recipe, limit, given, samples),
            None => region_of(&recipe.config, &recipe.features, given, samples),
        };
        if let Some((target, time)) = &self.target {
            let [from, to] = [&self.recipe, target].map(|recipe| finest(recipe, None));
            return Ok(Some(morph(&from, &to, time.fixed_time())));
        }
        let around = samples.grown(self.recipe.apron(0));
        let Some(map) = self.elevation.as_ref().filter(|map| map.reaches(around)) else {
            return Ok(Some(finest(&self.recipe, None)));
        };
        let heights = map.given(&self.recipe.config, around, |given| finest(&self.recipe, Some(given)));
        heights.map_err(|error| match error {
            Error::Input(error) => error,
            other => InputError::new("elevation", "a tile", format!("must load: {other}")),
        })
    }

    /// The patches, with `patch` among them; `None` for a patch beyond the world, and while its heights are on their way.
    fn with(&self, patch: [i32; 2]) -> Result<Option<MutexGuard<'_, Patches>>, InputError> {
        let mut patches = self.patches.lock().unwrap_or_else(PoisonError::into_inner);
        if !patches.ground.contains(patch) {
            let first = patch.map(|index| i64::from(index) * (i64::from(self.patch.patch_size) - 1));
            let samples = Region { first, width: self.patch.patch_size, coarser: 0 };
            let reach = self.target.as_ref().map_or(0, |(target, _)| target.apron(0));
            if samples.grown(reach.max(self.recipe.apron(0))).validate(&self.recipe.config).is_err() {
                return Ok(None);
            }
            let Some(heights) = self.heights(samples)? else { return Ok(None) };
            patches.ground.insert(patch, &heights, 0)?;
            patches.order.push_back(patch);
            if patches.order.len() > KEPT
                && let Some(oldest) = patches.order.pop_front()
            {
                patches.ground.remove(oldest);
            }
        }
        Ok(Some(patches))
    }
}

/// Heights of a region of `seamless` terrain at its samples' own resolution, after the recipe's erosion, which moves heights by at most
/// `limit`, with given heights before erosion as for [`region_of`]. The region must be valid with [`Recipe::apron`] samples around it.
/// The recipe must have no despiking.
fn eroded_region(recipe: &Recipe, limit: ErosionLimit, given: Option<&Given<'_>>, own: Region) -> Vec<i32> {
    let apron = recipe.apron(0);
    let around = own.grown(apron);
    let window = region_of(&recipe.config, &recipe.features, given, around);
    let inside = |row: &[i32]| row[apron as usize..(apron + own.width) as usize].to_vec();
    let rows = window.chunks_exact(around.width as usize).skip(apron as usize).take(own.width as usize);
    let origins: Vec<i32> = rows.flat_map(inside).collect();
    let eroded = finish(recipe, around.width as usize, &[], window);
    let eroded = ErodedAt { heights: &eroded, width: own.width as usize, corner: 0 };
    limited(&origins, eroded, limit.fixed_depth())
}
