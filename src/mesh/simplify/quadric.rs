//! Sums of squared distances from planes (Garland and Heckbert 1997).

use glam::DVec3;

/// The weighted sum of squared values of linear functions at a distance from an origin: there, `dᵀ A d + 2 b·d + c`.
///
/// The origin is the place of the point that it belongs to: the planes of its own triangles pass through it, so
/// differences are small against what they are taken from, wherever the mesh lies. In f64 because costs are squares:
/// rounding 2⁻⁵² is 10⁻⁸ of an edge, where f32 would leave 2 · 10⁻⁴, and flat ground would not be flat.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Quadric {
    /// The rows of A's upper half: xx, xy, xz, yy, yz, zz.
    a: [f64; 6],
    b: DVec3,
    c: f64,
    pub weight: f64,
}

impl Quadric {
    /// Of `weight × (gradient · d)²`; squared distances from a plane through the origin where the gradient has unit
    /// length.
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

    /// As [`Self::add`], without its weight.
    pub(crate) fn add_unweighted(&mut self, other: &Self) {
        let weight = self.weight;
        self.add(other);
        self.weight = weight;
    }

    /// Half its gradient at a distance from the origin.
    fn slope(&self, d: DVec3) -> DVec3 {
        let [xx, xy, xz, yy, yz, zz] = self.a;
        let ad = DVec3::new(
            xx * d.x + xy * d.y + xz * d.z,
            xy * d.x + yy * d.y + yz * d.z,
            xz * d.x + yz * d.y + zz * d.z,
        );
        ad + self.b
    }

    /// Its value at a distance from the origin, not below 0.
    pub(crate) fn at(&self, d: DVec3) -> f64 {
        ((self.slope(d) + self.b).dot(d) + self.c).max(0.0)
    }

    /// The same from another origin.
    pub(crate) fn moved(&self, d: DVec3) -> Self {
        Self { a: self.a, b: self.slope(d), c: self.at(d), weight: self.weight }
    }

    /// As [`Self::moved`], where functions also change by a constant at the new origin: their sum with the gradients is
    /// taken from b, and c becomes `c`.
    pub(crate) fn moved_by(&self, d: DVec3, gradients: DVec3, c: f64) -> Self {
        Self { a: self.a, b: self.slope(d) - gradients, c, weight: self.weight }
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
        // The first two planes pass through 0, the third through `first`.
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
