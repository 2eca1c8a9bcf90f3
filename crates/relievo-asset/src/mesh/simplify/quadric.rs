//! Quadrics: sums of squared distances from planes (Garland and Heckbert 1997).

use glam::DVec3;

/// A weighted sum of squares of linear functions of the offset d from an origin: `dᵀ A d + 2 b·d + c`.
///
/// The origin is the position of the point that owns the quadric. The planes of the point's triangles pass through this
/// origin, so the numbers stay small wherever the mesh lies. The quadric is in f64 because a cost is a squared
/// distance. A rounding error of 2⁻⁵² in the cost is an error of 10⁻⁸ of an edge in the distance. In f32, this error
/// would be 2 · 10⁻⁴ of an edge, and flat ground would have a cost above 0.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Quadric {
    /// Upper triangle of A: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
    pub weight: f64,
}

impl Quadric {
    /// The quadric `weight × (gradient · d)²`. For a unit vector `gradient`, it is the weighted squared distance from a
    /// plane through the origin.
    pub(crate) fn linear(gradient: DVec3, weight: f64) -> Self {
        let DVec3 { x, y, z } = gradient;
        let a = [x * x, x * y, x * z, y * y, y * z, z * z].map(|product| product * weight);
        Self { a, b: DVec3::ZERO, c: 0.0, weight }
    }

    pub(crate) fn add(&mut self, other: &Self) {
        for (sum, value) in self.a.iter_mut().zip(other.a) {
            *sum += value;
        }
        self.b += other.b;
        self.c += other.c;
        self.weight += other.weight;
    }

    /// As [`Self::add`], but for a plane through the origin.
    pub(crate) fn add_plane(&mut self, plane: &Self) {
        for (sum, value) in self.a.iter_mut().zip(plane.a) {
            *sum += value;
        }
        self.weight += plane.weight;
    }

    /// As [`Self::add`], but does not change the weight.
    pub(crate) fn add_unweighted(&mut self, other: &Self) {
        let weight = self.weight;
        self.add(other);
        self.weight = weight;
    }

    /// Half the gradient of the quadric at the offset d.
    #[inline]
    fn slope(&self, d: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let ad = DVec3::new(
            xx * d.x + xy * d.y + xz * d.z,
            xy * d.x + yy * d.y + yz * d.z,
            xz * d.x + yz * d.y + zz * d.z,
        );
        ad + self.b
    }

    /// Value of the quadric at the offset d. Negative values, which rounding may cause, become 0.
    #[inline]
    pub(crate) fn at(&self, d: DVec3) -> f64 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let x = xx * d.x + 2.0 * (xy * d.y + xz * d.z + self.b.x);
        let y = yy * d.y + 2.0 * (yz * d.z + self.b.y);
        let z = zz * d.z + 2.0 * self.b.z;
        (x * d.x + y * d.y + z * d.z + self.c).max(0.0)
    }

    /// Sum of two quadrics with the same origin: this quadric divided by its weight, and a quadric (a, b, c) without
    /// weight.
    #[inline]
    pub(crate) fn mean_plus(&self, mut a: [f64; 6], b: DVec3, c: f64) -> Self {
        let factor = self.inverse_weight();
        for (sum, value) in a.iter_mut().zip(self.a) {
            *sum += value * factor;
        }
        Self { a, b: self.b * factor + b, c: self.c * factor + c, weight: 0.0 }
    }

    /// Reads the quadric's first and last words to prefetch them. The returned number only prevents the compiler from
    /// dropping the reads.
    #[inline]
    pub(crate) fn touch(&self) -> u64 {
        self.a[0].to_bits() ^ self.weight.to_bits()
    }

    /// Reciprocal of the weight; 0 if the weight is 0.
    #[inline]
    pub(crate) fn inverse_weight(&self) -> f64 {
        if self.weight > 0.0 { 1.0 / self.weight } else { 0.0 }
    }

    /// The same quadric, relative to another origin at the offset d.
    pub(crate) fn moved(&self, d: DVec3) -> Self {
        Self { a: self.a, b: self.slope(d), c: self.at(d), weight: self.weight }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_sums_squared_distances_wherever_its_origin_is() {
        let normals = [DVec3::new(0.6, 0.8, 0.0), DVec3::new(0.0, -0.6, 0.8), DVec3::Z];
        let mut quadric = Quadric::default();
        let (first, second) = (DVec3::new(0.5, -2.0, 1.0), DVec3::new(3.0, 0.25, -1.0));
        let weights = [2.0, 0.5, 3.0];
        // The first two planes pass through the origin, the third passes through `first`.
        quadric.add(&Quadric::linear(normals[0], weights[0]));
        quadric.add(&Quadric::linear(normals[1], weights[1]));
        let mut moved = quadric.moved(first);
        moved.add(&Quadric::linear(normals[2], weights[2]));
        let expected = |at: DVec3| {
            let distances = [normals[0].dot(at), normals[1].dot(at), normals[2].dot(at - first)];
            (0..3).map(|plane| weights[plane] * distances[plane] * distances[plane]).sum::<f64>()
        };
        for at in [first, second, DVec3::ZERO, DVec3::new(-1.0, 4.0, 2.0)] {
            let value = moved.at(at - first);
            assert!((value - expected(at)).abs() < 1e-12 * (1.0 + expected(at)), "{value} at {at}");
            let again = moved.moved(second - first).at(at - second);
            assert!((again - expected(at)).abs() < 1e-12 * (1.0 + expected(at)), "{again} at {at}");
        }
        assert_eq!(moved.weight, 5.5);
    }
}
