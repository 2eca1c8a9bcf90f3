//! The errors of levels: the largest distance of any sample in any pose. Most samples are skipped, because another
//! sample is known to be farther away. This makes it feasible to examine all poses.

use std::ops::{ControlFlow, Range};

use glam::Vec3;

use super::bodies::{STRETCH, common};
use super::near::{Sample, Sides, blend};
use super::whole::Whole;
use crate::asset::Model;
use crate::mesh::nearest::nearest_on_triangle;
use crate::mesh::simplify::NO_BODY;
use crate::parallel;
use crate::skinning::pose::{Moment, bones_at};

/// Number of moments between two progress reports.
const BATCH: usize = 64;

/// Suspects: samples of several levels. Each of them may have the largest distance of its level at some moment.
pub(super) struct Suspects {
    /// The unit of positions, in the model's units: positions are divided by it.
    unit: f32,
    /// Bound on the rounding error of a position, in units of `unit`.
    rounding: f32,
    /// For each mesh of a group that is simplified as one, the vertices whose positions are needed.
    vertices: Vec<Vec<u32>>,
    all: Vec<Suspect>,
    triangles: Vec<[u32; 3]>,
    /// For each level, a lower bound of its error.
    least: Vec<f32>,
}

struct Suspect {
    level: u32,
    sample: Sample,
    /// The point of the triangles `near` that is nearest to the sample in the first pose.
    foot: Sample,
    /// The triangles close to the sample, as a range in [`Suspects::triangles`].
    near: Range<u32>,
}

impl Suspects {
    /// Finds the samples to examine. `first` is the first key pose and `rounding` the rounding bound, both in multiples
    /// of `unit`. `bodies` has the rigid body of each vertex.
    pub(super) fn new(
        whole: &Whole<'_>,
        sides: &[Sides],
        first: &[Vec3],
        bodies: &[u32],
        [unit, rounding]: [f32; 2],
    ) -> Self {
        let of_level = |level: usize| suspects_of(level as u32, &sides[level], first, bodies, rounding);
        let found = parallel::map_range(sides.len(), of_level);
        let (mut all, mut triangles, mut least) = (Vec::new(), Vec::new(), Vec::new());
        for (suspects, own, lowest) in found {
            let start = triangles.len() as u32;
            let moved = |suspect: Suspect| {
                let near = start + suspect.near.start..start + suspect.near.end;
                Suspect { near, ..suspect }
            };
            all.extend(suspects.into_iter().map(moved));
            triangles.extend(own);
            least.push(lowest);
        }
        let mut suspects = Self { unit, rounding, vertices: Vec::new(), all, triangles, least };
        suspects.number_anew(whole);
        suspects
    }

    /// Lists the vertices whose positions are needed, and replaces vertex indices by indices in this list.
    fn number_anew(&mut self, whole: &Whole<'_>) {
        let mut places = vec![0; whole.vertices()];
        let used = self.all.iter().flat_map(|one| [&one.sample.0, &one.foot.0]).chain(&self.triangles);
        used.flatten().for_each(|vertex| places[*vertex as usize] = 1);
        let mut next = 0;
        for member in 0..whole.meshes.len() {
            let range = whole.range(member);
            let needed = range.clone().filter(|vertex| places[*vertex] == 1);
            self.vertices.push(needed.map(|vertex| (vertex - range.start) as u32).collect());
        }
        for place in places.iter_mut().filter(|place| **place == 1) {
            (*place, next) = (next, next + 1);
        }
        let samples = self.all.iter_mut().flat_map(|one| [&mut one.sample.0, &mut one.foot.0]);
        samples.chain(&mut self.triangles).flatten().for_each(|vertex| *vertex = places[*vertex as usize]);
    }

    /// Raises the error of each level to the largest distance of its samples at the vertex positions `points`.
    fn look(&self, points: &[Vec3], errors: &mut [f32]) {
        let point = |vertex: u32| points[vertex as usize];
        for suspect in &self.all {
            let error = &mut errors[suspect.level as usize];
            let wanted = blend(&suspect.sample.0, &suspect.sample.1, &point);
            let foot = blend(&suspect.foot.0, &suspect.foot.1, &point);
            if foot.distance(wanted) + self.rounding <= *error {
                continue;
            }
            let near = &self.triangles[suspect.near.start as usize..suspect.near.end as usize];
            let squared = near
                .iter()
                .map(|triangle| nearest_on_triangle(wanted, triangle.map(point)).distance_squared(wanted));
            *error = error.max(squared.min_by(f32::total_cmp).unwrap_or(0.0).sqrt());
        }
    }
}

/// The samples that may have the largest distance of a level, the triangles near these samples, and a lower bound of
/// the level's error.
fn suspects_of(
    level: u32,
    sides: &Sides,
    first: &[Vec3],
    bodies: &[u32],
    rounding: f32,
) -> (Vec<Suspect>, Vec<[u32; 3]>, f32) {
    let point = |vertex: u32| first[vertex as usize];
    let mut least = 0.0_f32;
    let found: Vec<_> = sides
        .all()
        .map(|(sample, near)| {
            let wanted = blend(&sample.0, &sample.1, &point);
            let (foot, off) = foot_of(wanted, near, &point);
            let body = common(bodies, &sample.0);
            let is_rigid = body != NO_BODY && near.iter().all(|triangle| common(bodies, triangle) == body);
            if is_rigid {
                least = least.max((1.0 - 2.0 * STRETCH) * off - rounding);
            }
            let most = if is_rigid { (1.0 + 2.0 * STRETCH) * off + rounding } else { f32::INFINITY };
            (sample, foot, near, most)
        })
        .collect();
    let (mut all, mut triangles) = (Vec::new(), Vec::new());
    for (sample, foot, near, most) in found {
        // The comparison is false for NaN, so the sample stays.
        if most <= least {
            continue;
        }
        let start = triangles.len() as u32;
        triangles.extend_from_slice(near);
        all.push(Suspect { level, sample, foot, near: start..triangles.len() as u32 });
    }
    (all, triangles, least)
}

/// The point of the triangles `near` that is nearest to `wanted`, and its distance.
fn foot_of(wanted: Vec3, near: &[[u32; 3]], point: &impl Fn(u32) -> Vec3) -> (Sample, f32) {
    let on = |triangle: &[u32; 3]| {
        let found = nearest_on_triangle(wanted, triangle.map(point));
        (*triangle, found, found.distance_squared(wanted))
    };
    let nearest = near.iter().map(on).min_by(|a, b| a.2.total_cmp(&b.2));
    nearest.map_or((([0; 3], [0.0; 3]), f32::INFINITY), |(triangle, found, squared)| {
        ((triangle, parts_of(found, triangle.map(point))), squared.sqrt())
    })
}

/// Barycentric coordinates of a point in a triangle. If the triangle has no area, the coordinates of its first corner.
fn parts_of(point: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let normal = (b - a).cross(c - a);
    let area = normal.length_squared();
    let part = |from: Vec3, to: Vec3| ((from - point).cross(to - point).dot(normal) / area).clamp(0.0, 1.0);
    let [first, second] = [part(b, c), part(c, a)];
    if !(first.is_finite() && second.is_finite()) {
        return [1.0, 0.0, 0.0];
    }
    let second = second.min(1.0 - first);
    [first, second, 1.0 - first - second]
}

/// For several groups of meshes: the largest distance of each level at any of these moments, in the group's unit.
/// `watch` gets the number of moments examined so far, and may break.
pub(super) fn errors(
    model: &Model,
    groups: &[(&Whole<'_>, &Suspects)],
    moments: &[Moment],
    watch: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> ControlFlow<(), Vec<Vec<f32>>> {
    let mut errors: Vec<Vec<f32>> = groups.iter().map(|(_, suspects)| suspects.least.clone()).collect();
    // Widely spaced moments come first. They soon give large distances, so that most other samples can be skipped.
    let stride = moments.len().div_ceil(BATCH).max(1);
    let order: Vec<Moment> =
        (0..stride).flat_map(|first| moments.iter().skip(first).step_by(stride)).copied().collect();
    for (batch, moments) in order.chunks(BATCH).enumerate() {
        watch(batch * BATCH)?;
        let look = |moment: &Moment| {
            let bones = bones_at(model, *moment);
            let mut own = errors.clone();
            for ((whole, suspects), errors) in groups.iter().zip(&mut own) {
                let points = whole.some_points(*moment, &bones, &suspects.vertices, suspects.unit);
                suspects.look(&points, errors);
            }
            own
        };
        errors = parallel::map(moments, look).into_iter().fold(errors, larger);
    }
    ControlFlow::Continue(errors)
}

fn larger(mut a: Vec<Vec<f32>>, b: Vec<Vec<f32>>) -> Vec<Vec<f32>> {
    for (a, b) in a.iter_mut().flatten().zip(b.iter().flatten()) {
        *a = a.max(*b);
    }
    a
}

#[cfg(test)]
mod tests {
    use super::super::bodies::Bodies;
    use super::super::whole::Shared;
    use super::super::{Group, unwatched};
    use super::*;
    use crate::asset::{Influence, Influences};

    /// The errors equal, to the bit, the errors computed from all samples at all moments.
    #[test]
    fn no_sample_that_is_farthest_is_left_out() {
        let soft = crate::samples::creature().expect("valid");
        let mut rigid = soft.clone();
        let mesh = &mut rigid.meshes[0];
        let strongest = (0..mesh.vertices())
            .map(|vertex| vec![Influence { bone: mesh.influences.of(vertex)[0].bone, weight: 1.0 }]);
        mesh.influences = Influences::new("w", rigid.skins[0].bones.len(), strongest).expect("valid");
        let mut shares = Vec::new();
        for model in [soft, rigid] {
            let moments: Vec<Moment> = (0..90).map(|at| Moment::In(at % 2, at as f32 / 89.0)).collect();
            let whole = Whole::new(&model, &[0], &Shared::new());
            let bodies = Bodies::new(&model, &[0], &super::super::looked_at(&moments));
            let group = Group::new(&whole, &moments, &bodies, &mut unwatched).expect("valid");
            let group = group.expect("not broken");
            let found = errors(&model, &[(&whole, &group.suspects)], &moments, &mut unwatched);
            let found = found.continue_value().expect("not broken");
            let mut all = vec![0.0_f32; group.sides.len()];
            let mut samples = 0_u32;
            for moment in &moments {
                let points = whole.points(*moment, group.unit);
                let point = |vertex: u32| points[vertex as usize];
                for (error, sides) in all.iter_mut().zip(&group.sides) {
                    for (sample, near) in sides.all() {
                        let wanted = blend(&sample.0, &sample.1, &point);
                        *error = error.max(foot_of(wanted, near, &point).1);
                        samples += 1;
                    }
                }
            }
            assert!(all.len() > 5 && found[0] == all, "{:?} {all:?}", found[0]);
            shares.push(90.0 * group.suspects.all.len() as f64 / f64::from(samples));
        }
        // Samples near a joint have triangles of two rigid bodies.
        assert!(shares[0] < 0.9 && shares[1] < shares[0], "{shares:?}");
    }
}
