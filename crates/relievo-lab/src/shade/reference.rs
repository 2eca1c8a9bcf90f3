//! Shading of points: the CPU reference of `kernels/surface/shade.wgsl` and of the depth in
//! `wgsl/surface/shade.wgsl`.

use rayon::prelude::*;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::relief::{LEAST_COSINE, March, ReliefHit, ReliefMethod, ReliefRay};

use crate::shade::shadow::{SoftShadow, light_ray, shaded, soft_shadow};
use crate::shade::{Shade, ShadePoint, ShadeView};

/// The distance of a hit behind the polygon along the eye's ray, in uv units. `scale` is the relief's depth in
/// uv units.
pub(crate) fn distance(ray: &ReliefRay, hit: &ReliefHit, scale: f32) -> f32 {
    (hit.parameter - ray.polygon) * scale / ray.cosine.max(LEAST_COSINE)
}

/// The unit vector from a point of the polygon towards the eye. `eye` is its position (w = 1), or the direction
/// towards it (w = 0).
pub(crate) fn towards(eye: [f32; 4], position: [f32; 3]) -> [f32; 3] {
    let way = [0, 1, 2].map(|i| eye[i] - eye[3] * position[i]);
    let length = (way[0] * way[0] + way[1] * way[1] + way[2] * way[2]).sqrt();
    way.map(|axis| axis / length)
}

/// The depth, 0 (near) to 1 (far), of the point that lies `distance` behind a point of the polygon along the
/// eye's ray, all in world units. `clip_from_world` is given by columns.
pub(crate) fn depth(
    clip_from_world: [[f32; 4]; 4],
    position: [f32; 3],
    towards: [f32; 3],
    distance: f32,
) -> f32 {
    let world = [0, 1, 2].map(|i| position[i] - towards[i] * distance);
    let clip = |row: usize| {
        let [x, y, z, w] = clip_from_world.map(|column| column[row]);
        x * world[0] + y * world[1] + z * world[2] + w
    };
    (clip(2) / clip(3)).clamp(0.0, 1.0)
}

/// Shades a point. Hard shadows trace the light's ray with `method`.
pub fn shade(
    surface: &ReliefSurface<'_>,
    method: ReliefMethod,
    march: &March,
    view: &ShadeView,
    point: &ShadePoint,
) -> Shade {
    let ShadePoint { light, scale, position, world, ray, hit } = point;
    let first = surface.trace(method, &light_ray(hit, *light, *scale), march);
    let march = March { address: surface.address, ..*march };
    let soft = SoftShadow {
        map: surface.map,
        light: *light,
        scale: *scale,
        march: &march,
        steps: view.shadow_steps,
        softness: view.softness,
    };
    let soft = soft_shadow(&soft, hit);
    let towards = towards(view.eye.to_array(), *position);
    let distance = distance(ray, hit, *scale) * world;
    let depth = depth(view.clip_from_world.to_cols_array_2d(), *position, towards, distance);
    Shade { hard: if shaded(&first, hit) { 0.0 } else { 1.0 }, soft, depth }
}

/// As [`shade`], for a list of points, on all threads.
pub fn shade_all(
    surface: &ReliefSurface<'_>,
    method: ReliefMethod,
    march: &March,
    view: &ShadeView,
    points: &[ShadePoint],
) -> Vec<Shade> {
    points.par_iter().map(|point| shade(surface, method, march, view, point)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::ops::surface::relief::Outcome;

    /// In a parallel view straight from above, a hit is as deep as the relief is there.
    #[test]
    fn depth_is_that_of_the_hit_rather_than_the_polygon() {
        let ray = ReliefRay::new([0.5, 0.5], [0.0, 0.0, 1.0], 0.2, 0.75);
        for height in [0.0, 0.25, 0.75, 1.0] {
            let hit = ReliefHit::of(&ray, 1.0 - height, 0, Outcome::Hit);
            let behind = distance(&ray, &hit, 0.2) * 3.0;
            assert!((behind - (0.75 - height) * 0.6).abs() < 1e-6, "{height}: {behind}");
            let view = crate::shade::from_above();
            let towards = towards(view.eye.to_array(), [7.0, -3.0, -0.5]);
            let depth = depth(view.clip_from_world.to_cols_array_2d(), [7.0, -3.0, -0.5], towards, behind);
            assert!((depth - 0.5 - behind).abs() < 1e-6, "{height}: {depth}");
        }
    }

    /// In perspective at an angle, the depth is that of a point further along the eye's ray, not along the
    /// normal.
    #[test]
    fn depth_follows_the_eyes_ray() {
        let eye = [3.0, 0.0, 4.0, 1.0];
        let towards = towards(eye, [0.0; 3]);
        assert_eq!(towards, [0.6, 0.0, 0.8]);
        // The depth is z / (5 − z) of the point −2 · towards.
        let rows = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, -1.0, 5.0]];
        let columns = [0, 1, 2, 3].map(|column| rows.map(|row| row[column]));
        let depth = depth(columns, [0.0; 3], towards, 2.0);
        assert!((depth - 1.6 / 6.6).abs() < 1e-6, "{depth}");
    }
}
