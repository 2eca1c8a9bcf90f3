//! Where the models of a group stand, and the camera before them. World units are the options' units.

use std::f32::consts::TAU;

use glam::DVec3;
use relievo::asset::Model;
use relievo::scene::{Camera, Placement, Play};

use crate::measure::distance_sweep::Clock;
use crate::measure::distance_sweep::options::{DistanceSweepOptions, GroupLayout, grid};
use crate::measure::extent::Extent;
use crate::measure::options::{FIELD_OF_VIEW, NEAR, PICTURE};
use crate::measure::placement::chance;

/// A group of models in one layout.
pub(super) struct Group<'a> {
    /// The model, with one clip.
    pub model: &'a Model,
    pub options: &'a DistanceSweepOptions,
    pub extent: &'a Extent,
    /// Number of bones of an instance that the clip moves.
    pub animated_bones: usize,
    pub layout: GroupLayout,
    pub clock: Clock<'a>,
}

impl Group<'_> {
    /// The placement of each instance. The middle of the model at rest is at the instance's place.
    pub fn placements(&self) -> Vec<Placement> {
        let DistanceSweepOptions { instances, seed, size, spacing, edge, .. } = *self.options;
        let scale = f64::from(size) / self.extent.largest;
        let [columns, rows] = grid(instances);
        let place = |at: usize| {
            let centred =
                |index: usize, count: usize| f64::from(spacing) * (index as f64 - 0.5 * (count - 1) as f64);
            let random = |of: u32| f64::from(edge) * (f64::from(chance(seed, at as u32, of)) - 0.5);
            let (place, turn) = match self.layout {
                GroupLayout::Grid => {
                    (DVec3::new(centred(at % columns, columns), 0.0, centred(at / columns, rows)), 0.0)
                }
                GroupLayout::Cube => {
                    (DVec3::new(random(1), random(2), random(3)), TAU * chance(seed, at as u32, 4))
                }
            };
            let origin = place - DVec3::Y * self.extent.middle * scale;
            Placement::at_world(origin).turned(turn).scaled(scale as f32)
        };
        (0..instances).map(place).collect()
    }

    /// The clip of an instance, from a random start.
    pub fn play(&self, instance: usize) -> Play<'static> {
        let start = self.model.clips[0].duration() * chance(self.options.seed, instance as u32, 0);
        Play { start: -f64::from(start), ..Play::new("0") }
    }
}

/// The camera at a distance from the group's centre, which it looks at from +Z.
pub(super) fn camera(distance: f32) -> Camera {
    let eye = DVec3::Z * f64::from(distance);
    Camera::looking_at_world(eye, eye - DVec3::Z, FIELD_OF_VIEW, [NEAR, f32::INFINITY], PICTURE)
}
