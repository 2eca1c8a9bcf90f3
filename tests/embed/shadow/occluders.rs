//! What keeps the light from a place, by rays against triangles on the host, in f64.

use std::collections::HashMap;

use glam::{DMat4, DVec3};
use relievo::asset::Model;

/// Width of the buckets, across the light, into which triangles are sorted.
const BUCKET: f64 = 0.5;

/// Rings of rays around a place, and rays of each.
const RINGS: usize = 3;
const SPOKES: usize = 12;

/// Triangles, which stop light from both sides.
pub struct Occluders {
    /// The corners, and what they belong to.
    triangles: Vec<([DVec3; 3], [u32; 2])>,
    buckets: HashMap<[i64; 2], Vec<usize>>,
    /// Two axes across the light, and towards it.
    axes: [DVec3; 3],
}

/// What rays say of a place and the texels around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    Lit,
    Dark,
    /// At the edge of a shadow, or nearer to what casts it than a map can tell.
    Edge,
}

impl Occluders {
    pub fn new(light: DVec3) -> Self {
        let towards = light.normalize();
        let right = towards.any_orthonormal_vector();
        let axes = [right, towards.cross(right), towards];
        Self { triangles: Vec::new(), buckets: HashMap::new(), axes }
    }

    pub fn light(&self) -> DVec3 {
        self.axes[2]
    }

    fn across(&self, place: DVec3) -> [f64; 2] {
        [place.dot(self.axes[0]), place.dot(self.axes[1])]
    }

    /// Adds a triangle of an instance, given by the numbers of object and instance.
    pub fn add(&mut self, corners: [DVec3; 3], of: [u32; 2]) {
        let places = corners.map(|corner| self.across(corner));
        let range = |axis: usize| {
            let all = places.map(|place| (place[axis] / BUCKET).floor() as i64);
            all[0].min(all[1]).min(all[2])..=all[0].max(all[1]).max(all[2])
        };
        for x in range(0) {
            for y in range(1) {
                self.buckets.entry([x, y]).or_default().push(self.triangles.len());
            }
        }
        self.triangles.push((corners, of));
    }

    /// Adds the triangles of a model at rest.
    pub fn add_model(&mut self, model: &Model, into: DMat4, of: [u32; 2]) {
        for mesh in &model.meshes {
            for corners in mesh.indices.as_chunks::<3>().0 {
                let place = |corner: u32| {
                    into.transform_point3(glam::Vec3::from(mesh.positions[corner as usize]).as_dvec3())
                };
                self.add(corners.map(place), of);
            }
        }
    }

    /// Whether something stops the ray from a place to the light, other than `own`.
    pub fn stop(&self, from: DVec3, own: Option<[u32; 2]>) -> bool {
        let bucket = self.across(from).map(|axis| (axis / BUCKET).floor() as i64);
        let near = self.buckets.get(&bucket).into_iter().flatten();
        near.map(|at| &self.triangles[*at]).any(|(corners, of)| Some(*of) != own && self.meets(corners, from))
    }

    fn meets(&self, [a, b, c]: &[DVec3; 3], from: DVec3) -> bool {
        // Möller and Trumbore.
        let (one, other, along) = (*b - *a, *c - *a, self.axes[2]);
        let across = along.cross(other);
        let determinant = one.dot(across);
        if determinant.abs() < 1e-14 {
            return false;
        }
        let from = from - *a;
        let u = from.dot(across) / determinant;
        let around = from.cross(one);
        let v = along.dot(around) / determinant;
        u >= 0.0 && v >= 0.0 && u + v <= 1.0 && other.dot(around) / determinant > 0.0
    }

    /// What the ray from a place says, and those from within `reach` of the place `offset` above it, along the normal: where a
    /// map is looked up, and as far as it is filtered.
    pub fn verdict(
        &self,
        (place, normal): (DVec3, DVec3),
        [offset, reach]: [f64; 2],
        own: Option<[u32; 2]>,
    ) -> Verdict {
        let is_dark = self.stop(place + 1e-3 * normal, own);
        let lifted = place + offset * normal;
        let mut around = (0..RINGS * SPOKES).map(|at| {
            let radius = reach * (1 + at / SPOKES) as f64 / RINGS as f64;
            let angle = std::f64::consts::TAU * (at % SPOKES) as f64 / SPOKES as f64;
            lifted + radius * (angle.cos() * self.axes[0] + angle.sin() * self.axes[1])
        });
        let is_sure =
            self.stop(lifted, own) == is_dark && around.all(|place| self.stop(place, own) == is_dark);
        match (is_sure, is_dark) {
            (false, _) => Verdict::Edge,
            (true, true) => Verdict::Dark,
            (true, false) => Verdict::Lit,
        }
    }
}

#[test]
fn a_square_stops_light_from_both_sides_and_nothing_else() {
    let mut occluders = Occluders::new(DVec3::new(0.0, 2.0, 0.0));
    let [a, b, c, d] =
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, z]| DVec3::new(x, 3.0, z));
    occluders.add([a, b, c], [1, 0]);
    occluders.add([a, c, d], [1, 0]);
    let stop = |x: f64, y: f64| occluders.stop(DVec3::new(x, y, 0.1), None);
    assert!(stop(0.9, 0.0) && stop(-0.9, 2.9) && !stop(1.1, 0.0) && !stop(0.0, 3.1));
    assert!(!occluders.stop(DVec3::ZERO, Some([1, 0])));
    let verdict = |x: f64| occluders.verdict((DVec3::new(x, 0.0, 0.0), DVec3::Y), [0.1, 0.3], None);
    assert_eq!(
        [0.6, 0.8, 1.2, 1.4].map(verdict),
        [Verdict::Dark, Verdict::Edge, Verdict::Edge, Verdict::Lit]
    );
}
