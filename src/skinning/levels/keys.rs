//! The key poses for which meshes are simplified, and the size of the meshes in these poses.
//!
//! The error of a level is a fraction of this size. The size does not depend on the bind pose, because inverse bind
//! matrices may change its units.

use glam::{Vec2, Vec3};

use super::whole::Whole;
use crate::parallel;
use crate::skinning::attribute_weights::TextureArea;
use crate::skinning::pose::Moment;

/// Number of moments of the clips that serve as key poses.
const MOMENTS: usize = 24;

/// If the size at rest differs from the size in the clips by more than this factor, the rest pose is ignored, because
/// clips never show it.
const UNLIKE: f32 = 2.0;

/// The key poses, in multiples of a common unit, so that numbers have the same magnitude in every model. The first pose
/// is the rest pose. If the rest pose differs too much in size from the other poses, it is left out, and the largest of
/// the others comes first.
pub(super) struct Keys {
    pub poses: Vec<Vec<[f32; 3]>>,
    /// The normals of all vertices in the first pose.
    pub normals: Vec<[f32; 3]>,
    /// Diagonal of the box around the triangles in the first pose, in units of `unit`: 1 to 2, or 0 if the box has no
    /// extent.
    pub size: f32,
    /// The unit of positions: a power of two, in the model's units.
    pub unit: f32,
}

impl Keys {
    pub fn new(whole: &Whole<'_>, moments: &[Moment]) -> Self {
        let mut all: Vec<Key> = parallel::map(&key_moments(moments), |moment| Key::new(whole, *moment));
        // If several poses are equally large, the first of them is taken.
        let largest = (1..all.len()).rev().max_by(|a, b| all[*a].size.total_cmp(&all[*b].size));
        if let Some(largest) = largest.filter(|largest| all[0].is_unlike(all[*largest].size)) {
            all.swap(0, largest);
            all.remove(largest);
        }
        let (first, size) = (all[0].moment, all[0].size);
        let unit = power_of_two(size);
        all.iter_mut().for_each(|key| key.points.as_flattened_mut().iter_mut().for_each(|x| *x /= unit));
        let normals = whole.posed_normals(first);
        Self { poses: all.into_iter().map(|key| key.points).collect(), normals, size: size / unit, unit }
    }

    /// For each mesh, the weight of texture coordinates in simplification, computed from the first pose.
    pub fn texture_factors(&self, whole: &Whole<'_>) -> Vec<f32> {
        let mut areas = vec![TextureArea::default(); whole.meshes.len()];
        for triangle in whole.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| triangle[corner] as usize);
            let places = corners.map(|corner| Vec3::from(self.poses[0][corner]).as_dvec3());
            let uv = corners.map(|corner| Vec2::from(whole.uv[corner]).as_dvec2());
            areas[whole.member_of(triangle) as usize].add(places, uv);
        }
        areas.iter().map(|area| area.factor(f64::from(self.size))).collect()
    }
}

/// The rest pose, followed by at most [`MOMENTS`] of the given moments, evenly spaced.
pub(super) fn key_moments(moments: &[Moment]) -> Vec<Moment> {
    let every = moments.len().div_ceil(MOMENTS).max(1);
    let played = moments.iter().step_by(every).copied().filter(|moment| *moment != Moment::Rest);
    std::iter::once(Moment::Rest).chain(played).collect()
}

/// The meshes at one moment: vertex positions, and the diagonal of the box around the triangles.
struct Key {
    moment: Moment,
    points: Vec<[f32; 3]>,
    size: f32,
}

impl Key {
    fn new(whole: &Whole<'_>, moment: Moment) -> Self {
        let points = whole.joined_points(moment);
        let size = diagonal(&points, &whole.indices);
        Self { moment, points, size }
    }

    fn is_unlike(&self, size: f32) -> bool {
        UNLIKE * self.size < size || self.size > UNLIKE * size
    }
}

/// The diagonal of the box around the corners of triangles.
fn diagonal(pose: &[[f32; 3]], indices: &[u32]) -> f32 {
    let corners = indices.iter().map(|vertex| Vec3::from(pose[*vertex as usize]));
    let (low, high) =
        corners.fold((Vec3::MAX, Vec3::MIN), |(low, high), point| (low.min(point), high.max(point)));
    if indices.is_empty() {
        return 0.0;
    }
    // Computed in f64, because squares of large or small sizes exceed the range of f32.
    low.as_dvec3().distance(high.as_dvec3()) as f32
}

/// The largest power of two that is not above `size`; 1 for 0 and NaN.
fn power_of_two(size: f32) -> f32 {
    let is_normal = size.is_normal();
    if is_normal { f32::from_bits(size.to_bits() & 0xff80_0000) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_powers_of_two() {
        for (size, exponent) in [(1.0, 0.0), (1.99, 0.0), (2.0, 1.0), (0.3, -2.0), (1e30, 99.0)] {
            assert_eq!(power_of_two(size), libm::exp2f(exponent));
        }
        assert_eq!([0.0, 1e-40, f32::INFINITY, f32::NAN].map(power_of_two), [1.0; 4]);
    }

    #[test]
    fn what_has_no_triangle_has_no_size() {
        let points = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [900.0; 3]];
        assert_eq!(diagonal(&points, &[0, 1, 2]), 5.0);
        assert_eq!(diagonal(&points, &[]), 0.0);
    }
}
