//! The exact intersection in f64: solves for the first root of the ray against the bilinear patch of each cell
//! that it crosses, in order. The error of every method is measured against it, and it shares no code with the
//! methods.

use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::relief::{ReliefHit, ReliefRay};

/// The first intersection of a ray with the surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exact {
    /// Texture coordinates; outside the tile if the ray left it.
    pub uv: [f64; 2],
    /// The ray's parameter; the height is 1 minus it.
    pub parameter: f64,
}

impl Exact {
    /// The distance of a hit from the exact one, in texels.
    pub(crate) fn error(&self, hit: &ReliefHit, map: &HeightMap) -> f64 {
        let du = (f64::from(hit.uv[0]) - self.uv[0]) * f64::from(map.width());
        let dv = (f64::from(hit.uv[1]) - self.uv[1]) * f64::from(map.height());
        du.hypot(dv)
    }
}

/// The first intersection of a ray, or `None` for a ray that comes from behind. Heights are at least 0, so that
/// every other ray meets the surface at a parameter of at most 1.
pub fn exact(map: &HeightMap, ray: &ReliefRay, address: Address) -> Option<Exact> {
    if ray.cosine.is_nan() || ray.cosine <= 0.0 {
        return None;
    }
    let size = [f64::from(map.width()), f64::from(map.height())];
    let start = [0, 1].map(|i| f64::from(ray.origin[i]) * size[i] - 0.5);
    let travel = [0, 1].map(|i| f64::from(ray.slope[i]) * size[i]);
    let mut cell = start.map(|at| at.floor() as i64);
    let mut enter = 0.0;
    let parameter = loop {
        // The parameters at which the ray crosses the next line of texel centers, in x and in y.
        let exits = [0, 1].map(|i| match travel[i] {
            0.0 => f64::INFINITY,
            forward if forward > 0.0 => ((cell[i] + 1) as f64 - start[i]) / forward,
            backward => (cell[i] as f64 - start[i]) / backward,
        });
        let leave = exits[0].min(exits[1]).clamp(enter, 1.0);
        if let Some(found) = patch(map, address, cell, start, travel, [enter, leave]) {
            break found;
        }
        if leave >= 1.0 {
            break 1.0;
        }
        let axis = usize::from(exits[1] < exits[0]);
        cell[axis] += if travel[axis] > 0.0 { 1 } else { -1 };
        enter = leave;
    };
    let uv = [0, 1].map(|i| f64::from(ray.origin[i]) + parameter * f64::from(ray.slope[i]));
    Some(Exact { uv, parameter })
}

/// The first parameter in enter..=leave at which the ray is on or below the patch of a cell.
fn patch(
    map: &HeightMap,
    address: Address,
    cell: [i64; 2],
    start: [f64; 2],
    travel: [f64; 2],
    [enter, leave]: [f64; 2],
) -> Option<f64> {
    let texel =
        |dx: i64, dy: i64| f64::from(map.texel((cell[0] + dx) as i32, (cell[1] + dy) as i32, address));
    let (h00, h10, h01, h11) = (texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1));
    // Coefficients of the ray's height above the surface at enter + τ.
    let [x, y] = [0, 1].map(|i| start[i] + enter * travel[i] - cell[i] as f64);
    let (along_x, along_y, twist) = (h10 - h00, h01 - h00, h11 - h10 - h01 + h00);
    let c = 1.0 - enter - (h00 + along_x * x + along_y * y + twist * x * y);
    let b = -1.0 - along_x * travel[0] - along_y * travel[1] - twist * (x * travel[1] + y * travel[0]);
    let a = -twist * travel[0] * travel[1];
    if c <= 0.0 {
        return Some(enter);
    }
    let (first, second) = roots(a, b, c);
    let inside = |root: f64| (0.0..=leave - enter).contains(&root);
    [first, second].into_iter().filter(|root| inside(*root)).reduce(f64::min).map(|root| enter + root)
}

/// The real roots of a·x² + b·x + c; infinity in place of a missing root.
fn roots(a: f64, b: f64, c: f64) -> (f64, f64) {
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return (f64::INFINITY, f64::INFINITY);
    }
    // This form avoids the difference of nearly equal numbers.
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let divide = |over: f64, under: f64| if under == 0.0 { f64::INFINITY } else { over / under };
    (divide(q, a), divide(c, q))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ray(origin: [f32; 2], slope: [f32; 2]) -> ReliefRay {
        ReliefRay { origin, slope, cosine: 1.0, polygon: 0.0 }
    }

    #[test]
    fn flat_maps_are_met_at_their_height() {
        for height in [0.0, 0.25, 1.0] {
            let map = HeightMap::new(4, 4, vec![height; 16]).expect("a map");
            for slope in [[0.0, 0.0], [0.3, -2.0], [-7.0, 0.0]] {
                let hit = exact(&map, &ray([0.1, 0.9], slope), Address::Wrap).expect("a hit");
                assert!((hit.parameter - f64::from(1.0 - height)).abs() < 1e-12, "{height} {slope:?}");
            }
        }
    }

    /// On a ramp from 0 at texel 0 to 1 at texel 4, ray and ramp are straight lines.
    #[test]
    fn a_ramp_is_met_where_the_lines_cross() {
        let map = HeightMap::new(5, 1, (0..5).map(|x| x as f32 / 4.0).collect()).expect("a map");
        // The ray starts above texel 0 and moves to texel 4 while it falls by 1, so they meet halfway.
        let hit = exact(&map, &ray([0.1, 0.5], [0.8, 0.0]), Address::Clamp).expect("a hit");
        assert!((hit.parameter - 0.5).abs() < 1e-7 && (hit.uv[0] - 0.5).abs() < 1e-7, "{hit:?}");
    }

    /// With one high corner, the patch along the cell's diagonal is the square of the distance travelled.
    #[test]
    fn a_twisted_patch_is_met_at_its_quadratic_root() {
        let map = HeightMap::new(2, 2, vec![0.0, 0.0, 0.0, 1.0]).expect("a map");
        let hit = exact(&map, &ray([0.25, 0.25], [0.5, 0.5]), Address::Clamp).expect("a hit");
        // 1 − t = t²
        assert!((hit.parameter - (5.0_f64.sqrt() - 1.0) / 2.0).abs() < 1e-7, "{hit:?}");
    }

    /// The surface is never above the ray before the hit, and at the hit it has the ray's height.
    #[test]
    fn nothing_is_met_before_the_hit() {
        let heights = (0..35).map(|i| ((i * 37 + 11) % 35) as f32 / 35.0).collect();
        let map = HeightMap::new(7, 5, heights).expect("a map");
        for address in [Address::Wrap, Address::Clamp] {
            for number in 0..200 {
                let turn = number as f32 * 0.7;
                let slope = [3.0 * libm::cosf(turn), 2.0 * libm::sinf(turn)];
                let ray = ray([turn * 0.31 - 20.0, 0.4 - turn * 0.17], slope);
                let hit = exact(&map, &ray, address).expect("a hit");
                let above = |t: f64| {
                    1.0 - t
                        - f64::from(relievo::ops::surface::relief::reference::height::height(
                            &map,
                            ray.at(t as f32),
                            address,
                        ))
                };
                assert!(above(hit.parameter).abs() < 2e-4, "{number}: {}", above(hit.parameter));
                for step in 0..1000 {
                    let t = hit.parameter * f64::from(step) / 1000.0;
                    assert!(above(t) > -2e-4, "{number}: under the surface at {t} before {hit:?}");
                }
            }
        }
    }
}
