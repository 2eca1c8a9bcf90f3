//! Quadrics with a minimum (Garland and Heckbert 1997): sums of squared distances from planes anywhere.

use glam::DVec3;

/// How much a quadric prefers the place at which its minimum is sought, as a fraction of its trace. On flat ground, where a
/// minimum has no place of its own, this one decides. Where planes decide, it moves the minimum by about this fraction, and
/// each repetition from there by this fraction of what the last one left.
const PREFERENCE: f64 = 1e-5;

/// How often the minimum is sought again from the place where it was found.
const REPETITIONS: usize = 2;

/// The weighted sum of squared distances from planes, at x: `xᵀ A x + 2 b·x + c`.
///
/// Coordinates are those of a frame in which the mesh has about unit size, so that sums lose about 10⁻¹⁶ of that squared.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct PlaneQuadric {
    /// The upper triangle of A: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
    /// Sum of the weights that count.
    pub(super) weight: f64,
}

impl PlaneQuadric {
    /// The plane with the unit normal `normal` through `at`.
    pub(super) fn plane(normal: DVec3, at: DVec3, weight: f64) -> Self {
        let DVec3 { x, y, z } = normal;
        let d = -normal.dot(at);
        let a = [x * x, x * y, x * z, y * y, y * z, z * z].map(|product| product * weight);
        Self { a, b: normal * (d * weight), c: d * d * weight, weight }
    }

    /// The same sum, which does not count in the weight by which sums are divided.
    pub(super) fn unweighted(self) -> Self {
        Self { weight: 0.0, ..self }
    }

    pub(super) fn sum(&self, other: &Self) -> Self {
        let mut sum = *self;
        for (all, value) in sum.a.iter_mut().zip(other.a) {
            *all += value;
        }
        sum.b += other.b;
        sum.c += other.c;
        sum.weight += other.weight;
        sum
    }

    fn times(&self, x: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        DVec3::new(
            xx * x.x + xy * x.y + xz * x.z,
            xy * x.x + yy * x.y + yz * x.z,
            xz * x.x + yz * x.y + zz * x.z,
        )
    }

    /// The mean squared distance of x from the planes; 0 without planes.
    pub(super) fn mean_at(&self, x: DVec3) -> f64 {
        let sum = (self.times(x) + self.b * 2.0).dot(x) + self.c;
        if self.weight > 0.0 { (sum / self.weight).max(0.0) } else { 0.0 }
    }

    /// The place of the smallest sum; near `near` where the planes leave a choice.
    pub(super) fn minimum(&self, near: DVec3) -> DVec3 {
        (0..=REPETITIONS).fold(near, |near, _| self.pulled(near))
    }

    /// The place of the smallest sum of this quadric and of the squared distance from `near`, weighted by the preference.
    fn pulled(&self, near: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let pull = PREFERENCE * (xx + yy + zz);
        // (A + pull) d = −(A near + b), solved by Cramer's rule; A + pull is positive definite.
        let right = -(self.times(near) + self.b);
        let rows =
            [DVec3::new(xx + pull, xy, xz), DVec3::new(xy, yy + pull, yz), DVec3::new(xz, yz, zz + pull)];
        let determinant = rows[0].dot(rows[1].cross(rows[2]));
        if determinant <= 0.0 {
            return near;
        }
        let solved = rows[1].cross(rows[2]) * right.x
            + rows[2].cross(rows[0]) * right.y
            + rows[0].cross(rows[1]) * right.z;
        near + solved / determinant
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_is_where_planes_meet() {
        let corner = DVec3::new(0.25, -0.5, 0.125);
        let normals = [DVec3::X, DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, 0.6, -0.8)];
        let quadrics = normals.map(|normal| PlaneQuadric::plane(normal, corner, 2.0));
        let all = quadrics[0].sum(&quadrics[1]).sum(&quadrics[2]);
        let near = DVec3::new(0.3, -0.4, 0.2);
        assert!(all.minimum(near).distance(corner) < 1e-9, "{}", all.minimum(near));
        let expected = normals.iter().map(|normal| normal.dot(near - corner).powi(2)).sum::<f64>() / 3.0;
        assert!((all.mean_at(near) - expected).abs() < 1e-15);
        // Two planes leave a line, and one leaves a plane: the minimum is the nearest place on it.
        let line = normals[0].cross(normals[1]).normalize();
        let nearest = corner + line * line.dot(near - corner);
        assert!(quadrics[0].sum(&quadrics[1]).minimum(near).distance(nearest) < 1e-9);
        let nearest = near - normals[2] * normals[2].dot(near - corner);
        assert!(quadrics[2].minimum(near).distance(nearest) < 1e-9);
        assert_eq!(PlaneQuadric::default().minimum(near), near);
    }
}
