//! Measures how far the points of a gated crowd lie from those of the same crowd in full.

use rayon::prelude::*;
use relievo::asset::Affine;
use relievo::ops::animation::Projection;
use serde::Serialize;

use crate::measure::placement::{Placement, Placements};
use crate::measure::tally::Tally;

/// How far points lie from where full evaluation puts them, over all frames. Metres are the model's units.
/// The percentiles are too large by 1/64 of their value at most.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Errors {
    /// The root mean square, in metres.
    pub rms_metres: f64,
    /// The 99th percentile, in metres.
    pub p99_metres: f64,
    /// The largest error, in metres.
    pub max_metres: f64,
    /// The root mean square on screen, in pixels.
    pub rms_pixels: f64,
    /// The 99th percentile on screen, in pixels.
    pub p99_pixels: f64,
    /// The largest error on screen, in pixels.
    pub max_pixels: f64,
    /// Number of points, summed over the frames.
    pub points: u64,
    /// Number of points nearer than the near plane, which have no error in pixels; among vertices, also those
    /// of instances out of view.
    pub unseen: u64,
}

/// The largest change of a point's error vector from one frame to the next.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Jump {
    /// In metres of the model.
    pub max_metres: f64,
    /// In pixels, as if the change were perpendicular to the line of sight.
    pub max_pixels: f64,
}

/// Collects, frame by frame, the errors of points on the axes of all bones.
pub(crate) struct Meter<'a> {
    /// For each bone, the distance of its points from its origin in metres.
    radii: &'a [f32],
    projection: Projection,
    placements: &'a Placements,
    /// The instances in order, split into parts that are measured in parallel.
    parts: Vec<Part>,
    /// Number of instances of a part.
    each: usize,
}

/// The measurements of some of the instances.
struct Part {
    metres: Tally,
    pixels: Tally,
    jump: Jump,
    unseen: u64,
    /// For each bone, its stale matrix minus its fresh matrix in the frame before.
    last: Vec<Affine>,
}

impl<'a> Meter<'a> {
    pub(crate) fn new(radii: &'a [f32], projection: Projection, placements: &'a Placements) -> Self {
        let (count, bones) = (placements.origins.len(), radii.len());
        let each = count.div_ceil(rayon::current_num_threads());
        let part = |first: usize| Part {
            metres: Tally::new(),
            pixels: Tally::new(),
            jump: Jump { max_metres: 0.0, max_pixels: 0.0 },
            unseen: 0,
            last: vec![[[0.0; 4]; 3]; bones * each.min(count - first)],
        };
        let parts = (0..count).step_by(each).map(part).collect();
        Self { radii, projection, placements, parts, each }
    }

    /// Adds a frame. Both slices hold model matrices at `instance · bones + bone`.
    pub(crate) fn add(&mut self, stale: &[Affine], fresh: &[Affine]) {
        let Self { radii, projection, placements, each, .. } = *self;
        let pairs = each * radii.len();
        let lists = stale.par_chunks(pairs).zip(fresh.par_chunks(pairs));
        self.parts.par_iter_mut().zip(lists).enumerate().for_each(|(at, (part, (stale, fresh)))| {
            for (pair, (stale, fresh)) in stale.iter().zip(fresh).enumerate() {
                let placement = placements.get(at * each + pair / radii.len(), projection);
                part.add(pair, &placement, radii[pair % radii.len()], stale, fresh);
            }
        });
    }

    pub(crate) fn finish(self) -> (Errors, Jump) {
        let (mut metres, mut pixels, mut unseen) = (Tally::new(), Tally::new(), 0);
        let mut jump = Jump { max_metres: 0.0, max_pixels: 0.0 };
        for part in &self.parts {
            metres.merge(&part.metres);
            pixels.merge(&part.pixels);
            unseen += part.unseen;
            jump.max_metres = jump.max_metres.max(part.jump.max_metres);
            jump.max_pixels = jump.max_pixels.max(part.jump.max_pixels);
        }
        (Errors::of(&metres, &pixels, unseen), jump)
    }
}

impl Errors {
    pub(crate) fn of(metres: &Tally, pixels: &Tally, unseen: u64) -> Self {
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

impl Part {
    /// Adds the points on a bone's axes, `radius` metres from its origin.
    fn add(&mut self, pair: usize, placement: &Placement, radius: f32, stale: &Affine, fresh: &Affine) {
        let off: Affine =
            std::array::from_fn(|row| std::array::from_fn(|column| stale[row][column] - fresh[row][column]));
        let last = std::mem::replace(&mut self.last[pair], off);
        let still = [[0.0; 4]; 3];
        if off == still && last == still {
            self.metres.count += 6;
            self.pixels.count += 6;
            return;
        }
        for (axis, side) in (0..3).flat_map(|axis| [(axis, -radius), (axis, radius)]) {
            let at = |matrix: &Affine| -> [f64; 3] {
                matrix.map(|row| f64::from(row[3]) + f64::from(side) * f64::from(row[axis]))
            };
            let [offset, before] = [at(&off), at(&last)];
            let change = length(std::array::from_fn(|axis| offset[axis] - before[axis]));
            self.metres.add(length(offset));
            self.jump.max_metres = self.jump.max_metres.max(change);
            match placement.pixels(at(fresh), offset) {
                None => self.unseen += 1,
                Some([pixels, a_metre]) => {
                    self.pixels.add(pixels);
                    self.jump.max_pixels = self.jump.max_pixels.max(change * a_metre);
                }
            }
        }
    }
}

pub(crate) fn length([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One bone, a metre long, ten metres before a projection of 1000 pixels, is moved sideways, up and away.
    #[test]
    fn errors_are_projected_and_jumps_seen() {
        let projection = Projection { focal_pixels: 1000.0, near: 0.1 };
        let placements = Placements { origins: vec![[0.0, 0.0, 10.0]], turns: vec![[0.0, 1.0]] };
        let fresh: Affine = relievo::asset::transform::AFFINE_IDENTITY;
        let run = |ways: &[[f32; 3]]| {
            let mut meter = Meter::new(&[1.0], projection, &placements);
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
        // When the bone moves towards the camera, a point on the optical axis keeps its place on screen, and
        // one a metre beside the axis moves a little.
        let (errors, _) = run(&[[0.0, 0.0, 0.1]]);
        assert!((errors.max_pixels - 1000.0 * (1.0 / 9.9 - 0.1)).abs() < 1e-3, "{errors:?}");
        let (errors, jump) = run(&[[0.0, 0.1, 0.0], [0.0, -0.1, 0.0], [0.0, -0.1, 0.0]]);
        assert!((jump.max_metres - 0.2).abs() < 1e-6 && errors.points == 18);
        let (errors, _) = run(&[[0.0, 0.0, 0.0], [0.0, 0.0, 20.0]]);
        assert_eq!((errors.points, errors.unseen), (12, 6));
    }
}
