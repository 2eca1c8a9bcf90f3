//! Where instances stand in the camera's space: x right, y up, z ahead, in metres.

use std::f32::consts::TAU;

use relievo::ops::animation::Projection;
use relievo::ops::animation::gate::reference::scramble;
use relievo::scene;

use crate::measure::options::{CrowdOptions, Layout};

/// The placements of all instances.
pub(crate) struct Placements {
    pub origins: Vec<[f32; 3]>,
    /// For each instance, the sine and cosine of its angle about the vertical axis; an instance at angle 0
    /// faces the camera.
    pub turns: Vec<[f32; 2]>,
}

/// The placement of one instance in the camera's space.
pub(crate) struct Placement {
    pub origin: [f32; 3],
    pub turn: [f32; 2],
    pub projection: Projection,
}

impl Placements {
    /// Places instances by the layout. The nearest instance is `distance` metres before the camera, which
    /// looks at the height of `middle` metres above the model's origin.
    pub(crate) fn of_layout(options: &CrowdOptions, metres_a_unit: f32, middle: f32, distance: f32) -> Self {
        let CrowdOptions { instances: count, layout, seed, .. } = *options;
        let columns = (count as f64).sqrt().ceil() as usize;
        let rows = count.div_ceil(columns);
        let spacing = options.spacing * options.size * metres_a_unit;
        let [width, depth] = [columns - 1, rows - 1].map(|gaps| gaps as f32 * spacing);
        let number = |at: usize, of: u32| chance(seed, at as u32, of);
        let place = |at: usize| match layout {
            Layout::Grid => [(at % columns) as f32 * spacing - width / 2.0, (at / columns) as f32 * spacing],
            Layout::Random => [(number(at, 1) - 0.5) * width, number(at, 2) * depth],
        };
        let places: Vec<_> = (0..count).map(place).collect();
        let nearest = places.iter().map(|place| place[1]).fold(f32::INFINITY, f32::min);
        let front = distance - nearest;
        let turn = |at| match layout {
            Layout::Grid => [0.0, 1.0],
            Layout::Random => around(number(at, 3)),
        };
        Self {
            origins: places.iter().map(|[x, z]| [*x, -middle, z + front]).collect(),
            turns: (0..count).map(turn).collect(),
        }
    }

    /// Places all instances at one place, each turned by another angle.
    pub(crate) fn at_one_place(count: usize, origin: [f32; 3]) -> Self {
        let turns = (0..count).map(|at| around(at as f32 / count as f32));
        Self { origins: vec![origin; count], turns: turns.collect() }
    }

    /// The placement of one instance.
    pub(crate) fn get(&self, instance: usize, projection: Projection) -> Placement {
        Placement { origin: self.origins[instance], turn: self.turns[instance], projection }
    }

    /// The placements in a scene whose camera is at the origin and looks along −Z.
    pub(crate) fn in_scene(&self) -> Vec<scene::Placement> {
        let place = |([x, y, z], [sine, cosine]): (&[f32; 3], &[f32; 2])| {
            scene::Placement::at([*x, *y, -z]).turned(sine.atan2(*cosine))
        };
        self.origins.iter().zip(&self.turns).map(place).collect()
    }
}

impl Placement {
    /// Turns a direction from the model's space into the camera's.
    fn turned(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let [sine, cosine] = self.turn.map(f64::from);
        [x * cosine + z * sine, y, x * sine - z * cosine]
    }

    /// The distance in pixels between a point and another at `offset` from it, and the number of pixels of a
    /// metre there; `None` if the point is nearer than the near plane.
    pub(crate) fn pixels(&self, point: [f64; 3], offset: [f64; 3]) -> Option<[f64; 2]> {
        let (turned, offset) = (self.turned(point), self.turned(offset));
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| turned[i] + f64::from(self.origin[i]));
        let [x2, y2, z2] = [x + offset[0], y + offset[1], z + offset[2]];
        let (near, focal) = (f64::from(self.projection.near), f64::from(self.projection.focal_pixels));
        let is_seen = z > near && z2 > near;
        let [right, up] = [x2 / z2 - x / z, y2 / z2 - y / z];
        // `hypot` would take most of the measurement's time.
        is_seen.then(|| [focal * (right * right + up * up).sqrt(), focal / z])
    }
}

/// A random number from 0 to below 1 for an instance; `of` selects one of several.
pub(crate) fn chance(seed: u32, instance: u32, of: u32) -> f32 {
    let word = scramble(scramble(scramble(seed).wrapping_add(instance)).wrapping_add(of));
    (word >> 8) as f32 / (1 << 24) as f32
}

/// Sine and cosine of an angle, given as a part of a full turn.
fn around(turns: f32) -> [f32; 2] {
    let (sine, cosine) = (turns * TAU).sin_cos();
    [sine, cosine]
}
