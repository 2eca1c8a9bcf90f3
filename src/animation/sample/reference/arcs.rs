//! Slerps of several bones at once, component by component, so that compilers vectorize them. Each result
//! equals that of [`super::slerp`] to the bit.

use crate::animation::sample::{SLERP_U, SLERP_V};
use crate::asset::transform::Transform;

/// Number of slerps that are computed together.
const LANES: usize = 8;

/// Slerps that are collected until they fill all lanes.
pub struct Arcs {
    bones: [usize; LANES],
    from: [[f32; LANES]; 4],
    to: [[f32; LANES]; 4],
    fractions: [f32; LANES],
    waiting: usize,
}

impl Default for Arcs {
    fn default() -> Self {
        // Unused lanes interpolate between identities.
        let still = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]];
        Self { bones: [0; LANES], from: still, to: still, fractions: [0.0; LANES], waiting: 0 }
    }
}

impl Arcs {
    /// Adds a bone's keys and the fraction between them; once all lanes are filled, sets the rotations of the
    /// collected bones.
    pub fn push(
        &mut self,
        bone: usize,
        [from, to]: [[f32; 4]; 2],
        fraction: f32,
        transforms: &mut [Transform],
    ) {
        let lane = self.waiting;
        self.bones[lane] = bone;
        self.fractions[lane] = fraction;
        for i in 0..4 {
            (self.from[i][lane], self.to[i][lane]) = (from[i], to[i]);
        }
        self.waiting += 1;
        if self.waiting == LANES {
            self.finish(transforms);
        }
    }

    /// Sets the rotations of all remaining bones.
    pub fn finish(&mut self, transforms: &mut [Transform]) {
        if self.waiting == 0 {
            return;
        }
        let rotations = slerps(&self.from, &self.to, &self.fractions);
        for (lane, bone) in self.bones[..self.waiting].iter().enumerate() {
            transforms[*bone].rotation = rotations.map(|component| component[lane]);
        }
        self.waiting = 0;
    }
}

/// Computes [`super::slerp`] in each lane.
fn slerps(a: &[[f32; LANES]; 4], b: &[[f32; LANES]; 4], t: &[f32; LANES]) -> [[f32; LANES]; 4] {
    let each = |value: &dyn Fn(usize) -> f32| -> [f32; LANES] { std::array::from_fn(value) };
    let cosine = each(&|l| a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l] + a[3][l] * b[3][l]);
    let inverse = each(&|l| 1.0 / (2.0 + 2.0 * cosine[l]).sqrt());
    let less_one = each(&|l| (1.0 + cosine[l]) * inverse[l] - 1.0);
    let way = each(&|l| if t[l] < 0.5 { 2.0 * t[l] } else { 2.0 - 2.0 * t[l] });
    let rest = each(&|l| 1.0 - way[l]);
    let (of_middle, of_nearer) = (weights(&way, &less_one), weights(&rest, &less_one));
    let of_middle = each(&|l| of_middle[l] * inverse[l]);
    let of_nearer = each(&|l| of_nearer[l] + of_middle[l]);
    std::array::from_fn(|i| {
        each(&|l| {
            let (nearer, farther) = if t[l] < 0.5 { (a[i][l], b[i][l]) } else { (b[i][l], a[i][l]) };
            nearer * of_nearer[l] + farther * of_middle[l]
        })
    })
}

/// `sin(t·θ) / sin(θ)` for `less_one` = cos θ − 1.
fn weights(t: &[f32; LANES], less_one: &[f32; LANES]) -> [f32; LANES] {
    let mut sums = [1.0; LANES];
    for (u, v) in SLERP_U.iter().zip(SLERP_V).rev() {
        for l in 0..LANES {
            sums[l] = 1.0 + (u * (t[l] * t[l]) - v) * less_one[l] * sums[l];
        }
    }
    std::array::from_fn(|l| t[l] * sums[l])
}
