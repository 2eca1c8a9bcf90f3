//! Distance along a ray to a triangle.

use glam::DVec3;

/// Distance along a ray to a triangle, in multiples of the length of `direction`. The ray starts at the origin. `None`
/// if the ray misses the triangle or lies in its plane.
///
/// Each edge of the triangle spans a tetrahedron with the ray. The ray hits the triangle if the signed volumes of the
/// three tetrahedra have the same sign. Adjacent triangles compute the same volume for their common edge, up to the
/// sign. Therefore no ray slips through between two triangles.
pub fn distance_to([a, b, c]: [DVec3; 3], direction: DVec3) -> Option<f64> {
    // Six times the signed volume of a tetrahedron.
    let volume = |from: DVec3, to: DVec3| direction.dot(from.cross(to));
    let all = [volume(b, c), volume(c, a), volume(a, b)];
    let is_inside = all.iter().all(|volume| *volume >= 0.0) || all.iter().all(|volume| *volume <= 0.0);
    let sum: f64 = all.iter().sum();
    if !is_inside || sum == 0.0 {
        return None;
    }
    let [of_a, of_b, of_c] = all.map(|volume| volume / sum);
    let distance = direction.dot(of_a * a + of_b * b + of_c * c) / direction.length_squared();
    (distance >= 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_hit_triangles_and_their_edges() {
        let corners = [[0.0, 0.0, -2.0], [2.0, 0.0, -2.0], [0.0, 2.0, -2.0]].map(DVec3::from);
        let from = |x: f64, y: f64| {
            let seen = corners.map(|corner| corner - DVec3::new(x, y, 0.0));
            distance_to(seen, DVec3::NEG_Z)
        };
        assert_eq!((from(0.5, 0.5), from(1.0, 1.0), from(0.0, 0.0)), (Some(2.0), Some(2.0), Some(2.0)));
        assert_eq!((from(1.1, 1.0), from(-0.1, 0.5)), (None, None));
        assert_eq!((distance_to(corners, DVec3::Z), distance_to(corners, DVec3::X)), (None, None));
        assert_eq!(
            distance_to(corners.map(|corner| corner - DVec3::new(0.5, 0.5, 0.0)), 4.0 * DVec3::NEG_Z),
            Some(0.5)
        );
    }
}
