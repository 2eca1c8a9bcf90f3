//! The reducers that are [`simplify()`]: stages of its recorded sequence.

use relievo::InputError;
use relievo::ops::mesh::simplify::{Cost, Seams, Simplified, SimplifyOptions, Stopped, Surface, simplify};

use crate::reduce::{Limits, Reduced};

/// Simplifies once, as far as any of the limits asks for, and takes a prefix of the sequence for each of them.
pub(super) fn reduce(
    surface: &Surface<'_>,
    cost: Cost,
    seams: Seams,
    limits: &[Limits],
) -> Result<Vec<Reduced>, InputError> {
    let triangles = limits.iter().map(|limit| limit.triangles).min().unwrap_or(usize::MAX);
    let error = limits.iter().map(|limit| limit.error).fold(0.0, f32::max);
    let simplified =
        simplify(surface, &SimplifyOptions { cost, seams, triangles, error, ..SimplifyOptions::default() })?;
    Ok(limits.iter().map(|limit| level(surface, &simplified, limit)).collect())
}

/// The level of a sequence at which a limit is reached.
fn level(surface: &Surface<'_>, simplified: &Simplified, limit: &Limits) -> Reduced {
    let collapses = simplified.collapses_to(limit.triangles).min(simplified.collapses_within(limit.error));
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    let remap = simplified.remap(collapses);
    for (triangle, vertices) in (0_u32..).zip(surface.indices.chunks_exact(3)) {
        let vertices = [0, 1, 2].map(|corner| remap[vertices[corner] as usize]);
        if simplified.are_apart(vertices) {
            corners.extend(vertices);
            triangles.push(triangle);
        }
    }
    let error = collapses.checked_sub(1).map_or(0.0, |last| simplified.collapses()[last].error);
    let stopped = match simplified.collapses().get(collapses) {
        _ if triangles.len() <= limit.triangles => Stopped::Triangles,
        Some(_) => Stopped::Error,
        None => match simplified.stopped() {
            Stopped::Triangles => Stopped::Error,
            why => why,
        },
    };
    Reduced::of_vertices(surface, &corners, triangles, error, stopped)
}
