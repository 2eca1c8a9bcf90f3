//! Pairs of points that no edge joins: points of different parts of a mesh that lie close to each other.

use glam::DVec3;

use crate::reduce::importance::{Grid, around};
use crate::reduce::mesh::{Mesh, unique};

/// For each point those with which it makes a pair, ascending: with each point, the nearest one of another part within a
/// fraction of the diagonal of all places; of several the lowest. A part is what edges connect.
pub(super) fn near(mesh: &Mesh, places: &[DVec3], fraction: f32) -> Vec<Vec<u32>> {
    let parts = parts(mesh);
    let low = places.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = places.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let distance = low.distance(high) * f64::from(fraction);
    let mut partners = vec![Vec::new(); places.len()];
    if distance <= 0.0 || parts.iter().all(|part| *part == parts[0]) {
        return partners;
    }
    // A quarter more, so that rounding cannot put a near point two cells away. Places lie within ±1.
    let edge = (distance * 1.25).max(1e-6);
    let cell = |place: DVec3| (place / edge).floor().as_i64vec3().to_array();
    let mut cells = Grid::default();
    let used = || (0..places.len() as u32).filter(|point| mesh.ring(*point).next().is_some());
    for point in used() {
        cells.entry(cell(places[point as usize])).or_default().push(point);
    }
    for point in used() {
        let at = places[point as usize];
        let mut best = (distance * distance, u32::MAX);
        for other in around(&cells, cell(at)) {
            let key = (at.distance_squared(places[other as usize]), other);
            if parts[other as usize] != parts[point as usize] && key <= best {
                best = key;
            }
        }
        if best.1 != u32::MAX {
            partners[point as usize].push(best.1);
            partners[best.1 as usize].push(point);
        }
    }
    partners.into_iter().map(unique).collect()
}

/// The lowest point of the part to which each point belongs.
fn parts(mesh: &Mesh) -> Vec<u32> {
    let mut parts: Vec<u32> = (0..mesh.points() as u32).collect();
    fn lowest(parts: &mut [u32], mut point: u32) -> u32 {
        while parts[point as usize] != point {
            parts[point as usize] = parts[parts[point as usize] as usize];
            point = parts[point as usize];
        }
        point
    }
    for (corners, _) in mesh.all() {
        for other in [1, 2] {
            let a = lowest(&mut parts, corners[0].point);
            let b = lowest(&mut parts, corners[other].point);
            parts[a.max(b) as usize] = a.min(b);
        }
    }
    (0..mesh.points() as u32).map(|point| lowest(&mut parts, point)).collect()
}
