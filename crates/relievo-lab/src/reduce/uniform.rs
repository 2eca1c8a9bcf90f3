//! Uniform clustering: [`cluster()`] in the finest grid that leaves few enough triangles.

use crate::reduce::cluster::Grid;
use crate::reduce::cluster::reference::{Clustered, cluster};
use relievo::InputError;
use relievo::ops::mesh::simplify::{Stopped, Surface};

use crate::reduce::{Limits, Reduced};

/// A grid's result, with the largest distance between a vertex and its representative.
struct Tried {
    clustered: Clustered,
    error: f32,
}

/// Searches the grid for a limit.
pub(super) fn reduce(surface: &Surface<'_>, cells: u32, limit: &Limits) -> Result<Reduced, InputError> {
    let positions = &surface.poses[0];
    let grid = Grid::around(positions, cells);
    let attempt = |cells: u32| -> Result<Tried, InputError> {
        let clustered = cluster(positions, surface.indices, &Grid { cells, ..grid })?;
        let error = largest_distance(positions, &clustered);
        Ok(Tried { clustered, error })
    };
    // One cell leaves no triangle. The number of triangles mostly grows with that of cells, which bisection takes for granted.
    let wanted = |tried: &Tried| tried.clustered.triangles.len() <= limit.triangles;
    let (found, cells_found) = bisect(1, cells, &attempt, wanted, true)?;
    if found.error <= limit.error {
        return Ok(reduced(surface, &found, Stopped::Triangles));
    }
    let (found, _) = bisect(cells_found, cells, &attempt, |tried| tried.error <= limit.error, false)?;
    if found.error > limit.error {
        return Ok(whole(surface, limit));
    }
    let stopped = if wanted(&found) { Stopped::Triangles } else { Stopped::Error };
    Ok(reduced(surface, &found, stopped))
}

/// The largest number of cells from `low` to `high` that fits, or the smallest, as bisection finds it: of the two
/// neighbouring numbers at which the search ends, the one that fits. If none fits, the last one that was tried.
fn bisect(
    low: u32,
    high: u32,
    attempt: &impl Fn(u32) -> Result<Tried, InputError>,
    fits: impl Fn(&Tried) -> bool,
    is_largest: bool,
) -> Result<(Tried, u32), InputError> {
    // `near` fits if the largest is sought: it is then the low end, and otherwise the high one.
    let (mut near, mut far) = if is_largest { (low, high) } else { (high, low) };
    let mut best = attempt(near)?;
    let other = attempt(far)?;
    if fits(&other) {
        return Ok((other, far));
    }
    while near.abs_diff(far) > 1 {
        let middle = near.midpoint(far);
        let tried = attempt(middle)?;
        if fits(&tried) {
            (best, near) = (tried, middle);
        } else {
            far = middle;
        }
    }
    Ok((best, near))
}

fn largest_distance(positions: &[[f32; 3]], clustered: &Clustered) -> f32 {
    let place = |position: [f32; 3]| glam::Vec3::from(position).as_dvec3();
    let squares = positions.iter().zip(&clustered.remap).map(|(position, to)| {
        place(*position).distance_squared(place(clustered.representatives[*to as usize].position))
    });
    squares.fold(0.0, f64::max).sqrt() as f32
}

fn reduced(surface: &Surface<'_>, tried: &Tried, stopped: Stopped) -> Reduced {
    let clustered = &tried.clustered;
    let corner = |at: &u32| {
        let representative = &clustered.representatives[*at as usize];
        (representative.source, representative.position)
    };
    let corners: Vec<_> = clustered.indices.iter().map(corner).collect();
    let (attributes, triangles) = (surface.attributes, clustered.triangles.clone());
    Reduced::placed(&corners, attributes, surface.stride, triangles, tried.error, stopped)
}

/// The mesh as it is, without triangles that have two corners in one place.
fn whole(surface: &Surface<'_>, limit: &Limits) -> Reduced {
    let place = |vertex: u32| surface.poses[0][vertex as usize];
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for (triangle, vertices) in (0_u32..).zip(surface.indices.chunks_exact(3)) {
        let [a, b, c] = [0, 1, 2].map(|at| place(vertices[at]));
        if a != b && b != c && c != a {
            corners.extend(vertices);
            triangles.push(triangle);
        }
    }
    let stopped = if triangles.len() <= limit.triangles { Stopped::Triangles } else { Stopped::Error };
    Reduced::of_vertices(surface, &corners, triangles, 0.0, stopped)
}
