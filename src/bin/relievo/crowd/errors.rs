//! How far stale points lie from fresh ones.

use rayon::prelude::*;
use relievo::animation::Projection;
use relievo::asset::Affine;
use serde::Serialize;

use super::stage::{Scene, Stage};

/// Bits of an `f32` below those that choose a bin: 64 bins an octave.
const BIN_SHIFT: u32 = 17;

/// Errors of a run, as reports have them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Errors {
    pub rms_metres: f64,
    pub p99_metres: f64,
    pub max_metres: f64,
    pub rms_pixels: f64,
    pub p99_pixels: f64,
    pub max_pixels: f64,
    /// Points in all frames.
    pub points: u64,
    /// Those nearer than the near plane.
    pub unseen: u64,
}

/// The largest changes of errors between frames.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Jump {
    pub max_metres: f64,
    pub max_pixels: f64,
}

/// Collects errors frame by frame.
pub struct Meter<'a> {
    bone_radii: &'a [f32],
    projection: Projection,
    scene: &'a Scene,
    /// Each of some instances in turn.
    shares: Vec<Share>,
    /// Instances of a share.
    each: usize,
}

/// What is known of some instances.
struct Share {
    metres: Tally,
    pixels: Tally,
    jump: Jump,
    unseen: u64,
    /// Of each bone: stale minus fresh in the frame before.
    last: Vec<Affine>,
}

impl<'a> Meter<'a> {
    pub fn new(stage: &'a Stage<'_>, scene: &'a Scene) -> Self {
        let (count, bones) = (stage.instances.len(), stage.bone_radii.len());
        let each = count.div_ceil(rayon::current_num_threads());
        let fraction = |first: usize| Share {
            metres: Tally::new(),
            pixels: Tally::new(),
            jump: Jump { max_metres: 0.0, max_pixels: 0.0 },
            unseen: 0,
            last: vec![[[0.0; 4]; 3]; bones * each.min(count - first)],
        };
        let shares = (0..count).step_by(each).map(fraction).collect();
        Self { bone_radii: &stage.bone_radii, projection: stage.projection, scene, shares, each }
    }

    /// Adds a frame; both lists are `instance · bones + bone`.
    pub fn add(&mut self, stale: &[Affine], fresh: &[Affine]) {
        let Self { bone_radii, projection, scene, each, .. } = *self;
        let pairs = each * bone_radii.len();
        let lists = stale.par_chunks(pairs).zip(fresh.par_chunks(pairs));
        self.shares.par_iter_mut().zip(lists).enumerate().for_each(|(at, (fraction, (stale, fresh)))| {
            for (pair, (stale, fresh)) in stale.iter().zip(fresh).enumerate() {
                let instance = at * each + pair / bone_radii.len();
                let view = View { origin: scene.origins[instance], turn: scene.turns[instance], projection };
                fraction.add(pair, &view, bone_radii[pair % bone_radii.len()], stale, fresh);
            }
        });
    }

    pub fn finish(self) -> (Errors, Jump) {
        let mut all = self.shares.into_iter();
        let mut sum = all.next().expect("a crowd has instances");
        for fraction in all {
            sum.metres.merge(&fraction.metres);
            sum.pixels.merge(&fraction.pixels);
            sum.unseen += fraction.unseen;
            sum.jump.max_metres = sum.jump.max_metres.max(fraction.jump.max_metres);
            sum.jump.max_pixels = sum.jump.max_pixels.max(fraction.jump.max_pixels);
        }
        (Errors::of(&sum.metres, &sum.pixels, sum.unseen), sum.jump)
    }
}

impl Errors {
    pub(super) fn of(metres: &Tally, pixels: &Tally, unseen: u64) -> Self {
        Self {
            rms_metres: metres.rms(),
            p99_metres: metres.percentile(0.99),
            max_metres: metres.max,
            rms_pixels: pixels.rms(),
            p99_pixels: pixels.percentile(0.99),
            max_pixels: pixels.max,
            points: metres.count,
            unseen,
        }
    }
}

/// An instance as the camera has it.
pub(super) struct View {
    pub(super) origin: [f32; 3],
    pub(super) turn: [f32; 2],
    pub(super) projection: Projection,
}

impl View {
    /// A direction of the model's in the camera's space.
    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [sine, cosine] = self.turn.map(f64::from);
        [x * cosine + z * sine, y, x * sine - z * cosine]
    }

    /// Pixels between a point and another, `way` off; and pixels of a metre there.
    pub(super) fn pixels(&self, point: [f64; 3], way: [f64; 3]) -> Option<[f64; 2]> {
        let (turned, way) = (self.turned(point), self.turned(way));
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| turned[i] + f64::from(self.origin[i]));
        let [x2, y2, z2] = [x + way[0], y + way[1], z + way[2]];
        let (near, focal) = (f64::from(self.projection.near), f64::from(self.projection.focal_pixels));
        let is_seen = z > near && z2 > near;
        let [right, up] = [x2 / z2 - x / z, y2 / z2 - y / z];
        // Not hypot, which takes most of the time.
        is_seen.then(|| [focal * (right * right + up * up).sqrt(), focal / z])
    }
}

impl Share {
    /// The ends of a bone's axes, `bone_radius` out.
    fn add(&mut self, pair: usize, view: &View, bone_radius: f32, stale: &Affine, fresh: &Affine) {
        let off: Affine =
            std::array::from_fn(|row| std::array::from_fn(|column| stale[row][column] - fresh[row][column]));
        let last = std::mem::replace(&mut self.last[pair], off);
        let still = [[0.0; 4]; 3];
        if off == still && last == still {
            self.metres.count += 6;
            self.pixels.count += 6;
            return;
        }
        for (axis, side) in (0..3).flat_map(|axis| [(axis, -bone_radius), (axis, bone_radius)]) {
            let at = |matrix: &Affine| -> [f64; 3] {
                matrix.map(|row| f64::from(row[3]) + f64::from(side) * f64::from(row[axis]))
            };
            let [way, before] = [at(&off), at(&last)];
            let change = length(std::array::from_fn(|i| way[i] - before[i]));
            self.metres.add(length(way));
            self.jump.max_metres = self.jump.max_metres.max(change);
            match view.pixels(at(fresh), way) {
                None => self.unseen += 1,
                Some([pixels, a_metre]) => {
                    self.pixels.add(pixels);
                    self.jump.max_pixels = self.jump.max_pixels.max(change * a_metre);
                }
            }
        }
    }
}

pub(super) fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Values, counted by size: percentiles are at most a 64th too large.
#[derive(Clone)]
pub(super) struct Tally {
    count: u64,
    squares: f64,
    max: f64,
    /// Of all but zeros.
    bins: Vec<u64>,
}

impl Tally {
    pub(super) fn new() -> Self {
        Self { count: 0, squares: 0.0, max: 0.0, bins: vec![0; 1 << (31 - BIN_SHIFT)] }
    }

    pub(super) fn add(&mut self, value: f64) {
        self.count += 1;
        self.squares += value * value;
        self.max = self.max.max(value);
        if value > 0.0 {
            self.bins[((value as f32).to_bits() >> BIN_SHIFT) as usize] += 1;
        }
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.count += other.count;
        self.squares += other.squares;
        self.max = self.max.max(other.max);
        self.bins.iter_mut().zip(&other.bins).for_each(|(bin, more)| *bin += more);
    }

    fn rms(&self) -> f64 {
        (self.squares / self.count.max(1) as f64).sqrt()
    }

    /// A value that a share of all are at most.
    fn percentile(&self, fraction: f64) -> f64 {
        let mut above = (self.count as f64 * (1.0 - fraction)) as u64;
        for (bin, count) in self.bins.iter().enumerate().rev() {
            if *count > above {
                return f64::from(f32::from_bits((bin as u32 + 1) << BIN_SHIFT)).min(self.max);
            }
            above -= count;
        }
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tallies_know_mean_percentile_and_largest() {
        let mut tally = Tally::new();
        (0..1000).for_each(|value| tally.add(f64::from(value) / 100.0));
        let p99 = tally.percentile(0.99);
        assert!((9.89..=9.9 * 65.0 / 64.0).contains(&p99), "{p99}");
        assert!((tally.rms() - 5.7692).abs() < 1e-3 && tally.max == 9.99, "{}", tally.rms());
        let mut zeros = Tally::new();
        (0..1000).for_each(|_| zeros.add(0.0));
        assert_eq!(zeros.percentile(0.99), 0.0);
        zeros.merge(&tally);
        assert_eq!((zeros.count, zeros.max), (2000, 9.99));
        assert!((zeros.percentile(0.5) - 0.0).abs() < 0.02 && zeros.percentile(0.75) > 4.9);
    }

    /// One bone, a metre long, ten metres before a lens of 1000 pixels, moved sideways, up and away.
    #[test]
    fn errors_are_projected_and_jumps_seen() {
        let projection = Projection { focal_pixels: 1000.0, near: 0.1 };
        let scene = Scene { origins: vec![[0.0, 0.0, 10.0]], turns: vec![[0.0, 1.0]] };
        let fresh: Affine = relievo::asset::transform::AFFINE_IDENTITY;
        let run = |ways: &[[f32; 3]]| {
            let fraction = Share {
                metres: Tally::new(),
                pixels: Tally::new(),
                jump: Jump { max_metres: 0.0, max_pixels: 0.0 },
                unseen: 0,
                last: vec![[[0.0; 4]; 3]],
            };
            let mut meter =
                Meter { bone_radii: &[1.0], projection, scene: &scene, shares: vec![fraction], each: 1 };
            for way in ways {
                let mut stale = fresh;
                (0..3).for_each(|row| stale[row][3] = way[row]);
                meter.add(&[stale], &[fresh]);
            }
            meter.finish()
        };
        let (errors, jump) = run(&[[0.1, 0.0, 0.0]]);
        // The nearest point is 9 m away.
        assert!((errors.max_pixels - 100.0 / 9.0).abs() < 1e-4 && (errors.rms_metres - 0.1).abs() < 1e-6);
        assert!((jump.max_metres - 0.1).abs() < 1e-6 && errors.points == 6);
        // Toward the camera a point on the axis does not move on screen, one a metre beside it does a little.
        let (errors, _) = run(&[[0.0, 0.0, 0.1]]);
        assert!((errors.max_pixels - 1000.0 * (1.0 / 9.9 - 0.1)).abs() < 1e-3, "{errors:?}");
        let (errors, jump) = run(&[[0.0, 0.1, 0.0], [0.0, -0.1, 0.0], [0.0, -0.1, 0.0]]);
        assert!((jump.max_metres - 0.2).abs() < 1e-6 && errors.points == 18);
        let (errors, _) = run(&[[0.0, 0.0, 0.0], [0.0, 0.0, 20.0]]);
        assert_eq!((errors.points, errors.unseen), (12, 6));
    }
}
