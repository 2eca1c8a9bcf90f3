//! The nearest point on a triangle.

use glam::{DVec3, Vec3};

/// Defines the function for one vector type.
macro_rules! nearest_on_triangle {
    ($(#[$documentation:meta])* $name:ident, $vector:ty, $number:ty) => {
        $(#[$documentation])*
        #[inline]
        pub fn $name(point: $vector, [a, b, c]: [$vector; 3]) -> $vector {
            // Returns `one / all` if the ratio is in 0..=1, otherwise 0. For 0 / 0 and NaN, the result is 0.
            let ratio = |one: $number, all: $number| {
                let ratio = one / all;
                if (0.0..=1.0).contains(&ratio) { ratio } else { 0.0 }
            };
            // The fraction of `one` in the sum `one + other`.
            let part = |one: $number, other: $number| ratio(one, one + other);
            let (ab, ac, ap) = (b - a, c - a, point - a);
            let (to_b, to_c) = (ab.dot(ap), ac.dot(ap));
            if to_b <= 0.0 && to_c <= 0.0 {
                return a;
            }
            let bp = point - b;
            let (b_to_b, b_to_c) = (ab.dot(bp), ac.dot(bp));
            if b_to_b >= 0.0 && b_to_c <= b_to_b {
                return b;
            }
            let cp = point - c;
            let (c_to_b, c_to_c) = (ab.dot(cp), ac.dot(cp));
            if c_to_c >= 0.0 && c_to_b <= c_to_c {
                return c;
            }
            let over_c = to_b * b_to_c - b_to_b * to_c;
            if over_c <= 0.0 && to_b >= 0.0 && b_to_b <= 0.0 {
                return a + ab * part(to_b, -b_to_b);
            }
            let over_b = c_to_b * to_c - to_b * c_to_c;
            if over_b <= 0.0 && to_c >= 0.0 && c_to_c <= 0.0 {
                return a + ac * part(to_c, -c_to_c);
            }
            let over_a = b_to_b * c_to_c - c_to_b * b_to_c;
            if over_a <= 0.0 && b_to_c >= b_to_b && c_to_b >= c_to_c {
                return b + (c - b) * part(b_to_c - b_to_b, c_to_b - c_to_c);
            }
            let all = over_a + over_b + over_c;
            let [to_b, to_c] = [over_b, over_c].map(|over| ratio(over, all));
            a + ab * to_b + ac * to_c.min(1.0 - to_b)
        }
    };
}

nearest_on_triangle! {
    /// The point of a triangle that is nearest to `point`. Computed from the Voronoi regions of the corners, the edges
    /// and the interior (Ericson, "Real-Time Collision Detection", section 5.1.5). The triangle may be degenerate: a
    /// line or a point.
    ///
    /// For triangle sizes and distances from 1e-8 to 1e9, the error is about 1e-6 of the size or the distance,
    /// whichever is larger. The computation uses fourth powers of these lengths. Beyond this range, `f32` cannot
    /// represent these powers, but the result still lies on the triangle. The distance from `point` to the result may
    /// be too large, but is never too small.
    nearest_on_triangle, Vec3, f32
}

nearest_on_triangle! {
    /// As [`nearest_on_triangle()`], in double precision.
    precise_nearest_on_triangle, DVec3, f64
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [Vec3; 3] = [Vec3::ZERO, Vec3::new(4.0, 0.0, 0.0), Vec3::new(0.0, 3.0, 0.0)];

    #[test]
    fn every_part_of_the_plane_has_its_place() {
        let found = |x: f32, y: f32| nearest_on_triangle(Vec3::new(x, y, 2.0), CORNERS).truncate().to_array();
        assert_eq!(found(-1.0, -1.0), [0.0, 0.0]);
        assert_eq!(found(6.0, -1.0), [4.0, 0.0]);
        assert_eq!(found(-1.0, 5.0), [0.0, 3.0]);
        assert_eq!(found(1.0, -2.0), [1.0, 0.0]);
        assert_eq!(found(-2.0, 1.0), [0.0, 1.0]);
        assert_eq!(found(1.0, 1.0), [1.0, 1.0]);
        // The middle of the long edge, displaced along the edge's normal.
        let [x, y] = found(2.0 + 3.0, 1.5 + 4.0);
        assert!((x - 2.0).abs() < 1e-6 && (y - 1.5).abs() < 1e-6, "{x} {y}");
    }

    #[test]
    fn both_precisions_agree() {
        for at in 0..200 {
            let [x, y, z] = [1.7, 2.9, 4.3].map(|turn| 6.0 * libm::sinf(turn * at as f32));
            let point = Vec3::new(x, y, z);
            let found =
                precise_nearest_on_triangle(point.as_dvec3(), CORNERS.map(|corner| corner.as_dvec3()));
            assert!(found.distance(nearest_on_triangle(point, CORNERS).as_dvec3()) < 1e-5, "{point}");
        }
    }

    #[test]
    fn positions_are_nearer_than_any_other() {
        let steps = || (0..=20).map(|step| step as f32 / 20.0);
        for x in steps() {
            for y in steps() {
                let point = Vec3::new(8.0 * x - 2.0, 7.0 * y - 2.0, x - y);
                let found = nearest_on_triangle(point, CORNERS).distance(point);
                let others = steps().flat_map(|u| steps().map(move |v| (u, (1.0 - u) * v)));
                let least = others
                    .map(|(u, v)| (CORNERS[1] * u + CORNERS[2] * v).distance(point))
                    .fold(f32::INFINITY, f32::min);
                assert!(found <= least + 1e-6 && found > least - 0.2, "{point}: {found} {least}");
            }
        }
    }

    /// These triangle sizes are too large or too small for `f32` to represent their fourth powers.
    #[test]
    fn positions_are_always_on_the_triangle() {
        for scale in [1e-30_f32, 1e-18, 1e-11, 1e10, 1e15, 1e18] {
            for at in 0..100 {
                let at = at as f32;
                let [x, y, z] = [1.7, 2.9, 4.3].map(|turn| 6.0 * libm::sinf(turn * at));
                let found =
                    nearest_on_triangle(scale * Vec3::new(x, y, z), CORNERS.map(|c| scale * c)) / scale;
                let is_inside = found.cmpge(Vec3::ZERO).all() && found.x / 4.0 + found.y / 3.0 < 1.0001;
                assert!(is_inside && found.z == 0.0, "{found} at {scale}");
            }
        }
    }

    #[test]
    fn lines_and_points_are_triangles_too() {
        let point = Vec3::new(1.0, 1.0, 0.0);
        let line = [Vec3::ZERO, Vec3::X * 2.0, Vec3::X * 4.0];
        assert_eq!(nearest_on_triangle(point, line), Vec3::X);
        assert_eq!(nearest_on_triangle(point, [Vec3::Y; 3]), Vec3::Y);
        let folded = [Vec3::X * 4.0, Vec3::ZERO, Vec3::ZERO];
        assert_eq!(nearest_on_triangle(point, folded), Vec3::X);
    }
}
