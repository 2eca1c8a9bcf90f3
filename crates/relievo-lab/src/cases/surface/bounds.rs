//! Error bounds for hits: how far rounding may move each one, computed by the reference on heights that are
//! raised and lowered by the possible rounding errors. `docs/relief-bounds.md` has the derivation.

use std::collections::BTreeMap;

use rayon::prelude::*;
use relievo::InputError;
use relievo::ops::surface::cone_map::RADIUS_BOUND;
use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::relief::{March, Outcome, ReliefHit, ReliefMethod, ReliefRay};

/// A unit in the last place of 1: sums and products in WGSL are within this relative distance of the exact
/// result.
pub(crate) const ULP: f64 = 1.0 / 8_388_608.0;

/// Rays with a bound wider than this, in texels, prove little and count as touching.
pub(crate) const BLUNT: f64 = 1.0 / 32.0;

/// The relative error of a step over a cone: that of the radius, and that of the step's own arithmetic.
const CONE_STEP: f64 = RADIUS_BOUND as f64 + 12.0 * ULP;

/// The reference's hit of a ray, and how far a device's hit may be from it.
#[derive(Debug, Clone, Copy)]
pub struct Judged {
    /// The reference's hit.
    pub expected: ReliefHit,
    /// The largest error allowed for the parameter.
    pub parameter: f64,
    /// The largest error allowed for the height.
    pub height: f64,
    /// The largest error allowed for the position, in texels.
    pub texels: f64,
    /// Whether rounding changes no branch, so that every device makes the same number of loads.
    pub is_steady: bool,
}

impl Judged {
    /// Whether ray and surface touch within rounding, so that the hit proves little or the number of loads may
    /// differ.
    pub fn touches(&self) -> bool {
        !self.is_steady || self.texels > BLUNT
    }
}

/// Where rays come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// Every device receives the same rays.
    Given,
    /// Every device computes the rays itself, as `surface_light_ray` does.
    Computed,
}

/// Computes the hits and bounds of rays.
///
/// # Errors
/// None, for maps that [`HeightMap::new`] made.
pub fn judge(
    map: &HeightMap,
    method: ReliefMethod,
    march: &March,
    rays: &[ReliefRay],
    source: Source,
) -> Result<Vec<Judged>, InputError> {
    let surface = ReliefSurface::new(map, method, march.address);
    let steepness = steepness(map, march.address);
    // Rays with about the same position error share their raised and lowered maps.
    let mut classes: BTreeMap<i32, Vec<usize>> = BTreeMap::new();
    for (index, ray) in rays.iter().enumerate() {
        let positions = positions(ray, map, method, march.address, source);
        classes.entry(felt(ray, map, march.address, positions).log2().ceil() as i32).or_default().push(index);
    }
    let mut judged = vec![None; rays.len()];
    // If the search over cones ends in binary steps, it is close to the crossing that the quadtree finds.
    let crossing = if method == ReliefMethod::Cone { ReliefMethod::Quadtree } else { method };
    for (exponent, indices) in classes {
        let lifted = if method == ReliefMethod::Cone { CONE_STEP } else { 0.0 };
        let moved = |sign: f64| moved(map, &steepness, sign, f64::from(exponent).exp2(), lifted);
        let (raised, lowered) = (moved(1.0)?, moved(-1.0)?);
        let judge = Judge {
            surface: &surface,
            method,
            march,
            source,
            crossing,
            ends: [&raised, &lowered].map(|map| ReliefSurface::new(map, crossing, march.address)),
        };
        let found: Vec<Judged> = indices.par_iter().map(|index| judge.ray(&rays[*index])).collect();
        indices.into_iter().zip(found).for_each(|(index, found)| judged[index] = Some(found));
    }
    // Every ray is in one class.
    Ok(judged.into_iter().flatten().collect())
}

/// How far rounding may move a point of a ray, in texels along x and y.
fn positions(
    ray: &ReliefRay,
    map: &HeightMap,
    method: ReliefMethod,
    address: Address,
    source: Source,
) -> [f64; 2] {
    let size = [map.width(), map.height()].map(f64::from);
    [0, 1].map(|axis| {
        let (origin, slope) = (f64::from(ray.origin[axis]), f64::from(ray.slope[axis]));
        let farthest = origin.abs().max((origin + slope).abs());
        let travel = slope.abs() * size[axis];
        // Steps over cones are no longer than the map.
        let steps =
            if method == ReliefMethod::Cone { CONE_STEP * travel.min(size[0].min(size[1])) } else { 0.0 };
        let ulps = match (method, address) {
            (ReliefMethod::Cone | ReliefMethod::Quadtree, _) => {
                9.0 * travel + 2.0 * size[axis] * origin.abs() + 12.0
            }
            (_, Address::Wrap) => 5.0 * travel + size[axis] * (farthest + 3.0),
            (_, Address::Clamp) => 5.0 * travel + 3.0 * size[axis] * farthest + 1.0,
        };
        let computed = match source {
            Source::Given => 0.0,
            Source::Computed => 9.0 * travel + size[axis] * origin.abs(),
        };
        ULP * (ulps + computed) + steps
    })
}

/// How far rounding may move a point in a direction in which heights change: an axis along which the whole ray
/// is beyond the edge of a clamped map does not count.
fn felt(ray: &ReliefRay, map: &HeightMap, address: Address, positions: [f64; 2]) -> f64 {
    let size = [map.width(), map.height()].map(f64::from);
    let felt = |axis: usize| {
        let ends =
            [ray.origin[axis], ray.origin[axis] + ray.slope[axis]].map(|end| f64::from(end) * size[axis]);
        let is_beyond = ends.iter().all(|end| *end < 0.0) || ends.iter().all(|end| *end > size[axis]);
        if address == Address::Clamp && is_beyond { 0.0 } else { positions[axis] }
    };
    felt(0).max(felt(1)).max(ULP)
}

/// For each texel, the largest change in height per texel along x, and along y, in the cells around it.
pub(crate) fn steepness(map: &HeightMap, address: Address) -> Vec<[f64; 2]> {
    let (width, height) = (map.width() as i32, map.height() as i32);
    let rise = |x: i32, y: i32, [dx, dy]: [i32; 2]| {
        f64::from((map.texel(x + dx, y + dy, address) - map.texel(x, y, address)).abs())
    };
    let around = |x: i32, y: i32| {
        let mut most = [0.0_f64; 2];
        for (back, aside) in [(-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 0), (0, 1)] {
            most[0] = most[0].max(rise(x + back, y + aside, [1, 0]));
            most[1] = most[1].max(rise(x + aside, y + back, [0, 1]));
        }
        most
    };
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| around(x, y)).collect()
}

/// The heights raised (`sign` 1) or lowered (−1) by the possible rounding errors, if points may be off by
/// `position` texels.
fn moved(
    map: &HeightMap,
    steepness: &[[f64; 2]],
    sign: f64,
    position: f64,
    lifted: f64,
) -> Result<HeightMap, InputError> {
    let heights = map.heights().iter().zip(steepness).map(|(height, [x, y])| {
        // The reference rounds too, by half as much.
        let by = 1.5 * (off(x + y, position) + lifted) + ULP;
        (f64::from(*height) + sign * by).clamp(0.0, 1.0) as f32
    });
    HeightMap::new(map.width(), map.height(), heights.collect())
}

/// The possible error of a height that changes by `steepness` per texel at a point that may be off by
/// `position` texels.
pub(crate) fn off(steepness: f64, position: f64) -> f64 {
    position / (1.0 - 2.0 * position.min(0.25)) * steepness + ULP * (12.0 + 40.0 * steepness)
}

/// The data that one class of rays shares.
struct Judge<'a> {
    surface: &'a ReliefSurface<'a>,
    method: ReliefMethod,
    march: &'a March,
    source: Source,
    /// The method that finds the crossing on the raised and lowered maps.
    crossing: ReliefMethod,
    ends: [ReliefSurface<'a>; 2],
}

impl Judge<'_> {
    fn ray(&self, ray: &ReliefRay) -> Judged {
        let march = self.march;
        let expected = self.surface.trace(self.method, ray, march);
        let ends = self.ends.each_ref().map(|surface| surface.trace(self.crossing, ray, march));
        let shifted = self.shifted(ray).map(|ray| self.surface.trace(self.method, &ray, march));
        let is_same =
            |hit: &ReliefHit| hit.samples == expected.samples && hit.outcome_code == expected.outcome_code;
        let is_steady =
            shifted.iter().all(is_same) && (!self.method.is_stepped() || ends.iter().all(is_same));
        let mut farthest = [0.0_f64; 2];
        for hit in ends.iter().chain(shifted.iter().filter(|_| !is_steady)) {
            let off = [hit.parameter - expected.parameter, hit.height - expected.height];
            farthest = [0, 1].map(|i| farthest[i].max(f64::from(off[i]).abs()));
        }
        let around = if expected.outcome() == Outcome::Miss { 0.0 } else { self.around(ray, is_steady) };
        if !self.has_steps(ray) {
            farthest = [1.0; 2];
        }
        let size = [self.surface.map.width(), self.surface.map.height()].map(f64::from);
        let travel = (f64::from(ray.slope[0]) * size[0]).hypot(f64::from(ray.slope[1]) * size[1]);
        let [x, y] = self.positions(ray);
        let [parameter, height] = farthest.map(|off| off + around + 16.0 * ULP);
        Judged {
            expected,
            parameter,
            height,
            texels: (farthest[0] + around) * travel + 2.0 * x.hypot(y),
            is_steady,
        }
    }

    fn positions(&self, ray: &ReliefRay) -> [f64; 2] {
        positions(ray, self.surface.map, self.method, self.march.address, self.source)
    }

    /// Whether rounding cannot change the number of linear steps, ⌈mix(min, max, 1 − V.z)⌉.
    fn has_steps(&self, ray: &ReliefRay) -> bool {
        let [low, high] = self.march.steps.map(f64::from);
        let flatness = (1.0 - f64::from(ray.cosine)).max(0.0);
        let (steps, off) = (low + (high - low) * flatness, 4.0 * ULP * high);
        !self.method.is_stepped() || flatness == 0.0 || (steps - off).ceil() == (steps + off).ceil()
    }

    /// The ray shifted slightly to every side, steeper and flatter: whatever rounding does to a branch, one of
    /// these rays takes it.
    fn shifted(&self, ray: &ReliefRay) -> [ReliefRay; 4] {
        let size = [self.surface.map.width(), self.surface.map.height()].map(f64::from);
        let position = self.positions(ray);
        let relative = match self.method {
            ReliefMethod::Cone => 128.0 * ULP + CONE_STEP,
            _ => 52.0 * ULP,
        };
        let by = [0, 1].map(|i| position[i] / size[i] + relative * f64::from(ray.slope[i]).abs());
        [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]].map(|signs: [f64; 2]| {
            let steeper = 1.0 + 4.0 * ULP * signs[0];
            ReliefRay {
                origin: [0, 1].map(|i| (f64::from(ray.origin[i]) + signs[i] * by[i]) as f32),
                slope: ray.slope.map(|slope| (f64::from(slope) * steeper) as f32),
                ..*ray
            }
        })
    }

    /// How far the result of a binary search between the last two points of the search over cones may be from
    /// the crossing.
    fn around(&self, ray: &ReliefRay, is_steady: bool) -> f64 {
        if self.method != ReliefMethod::Cone {
            return 0.0;
        }
        let by_steps = |binary_steps: u32| {
            let march = March { binary_steps, ..*self.march };
            f64::from(self.surface.trace(self.method, ray, &march).parameter)
        };
        // The first step moves the middle by a quarter of the interval.
        let between = if is_steady { 4.0 * (by_steps(1) - by_steps(0)).abs() } else { 1.0 };
        between * f64::from(self.march.binary_steps).exp2().recip()
    }
}
