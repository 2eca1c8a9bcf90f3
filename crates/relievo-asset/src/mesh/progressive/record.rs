//! Levels of detail made from a recorded sequence of collapses.

use super::partners::{Became, partners};
use crate::InputError;
use crate::asset::mesh::MAX_LEVELS;
use crate::asset::{Mesh, MeshLevel};
use crate::mesh::simplify::Simplified;

/// A level of detail to take from a sequence of collapses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChosenLevel {
    /// Number of collapses that lead from the mesh to the level. It must exceed the previous level's number.
    pub collapses: usize,
    /// Error of the level: finite, and at least the error of the previous level.
    pub error: f32,
}

/// Returns the mesh with the chosen levels and their partners. The second result has, for each vertex, the number of
/// the collapse that removed it; `u32::MAX` for a vertex that stays.
pub(super) fn levelled(
    mesh: &Mesh,
    simplified: &Simplified,
    chosen: &[ChosenLevel],
) -> Result<(Mesh, Vec<u32>), InputError> {
    let remaps = remaps(mesh, simplified, chosen)?;
    let mut levels = Vec::with_capacity(chosen.len());
    for (at, ChosenLevel { collapses, error }) in chosen.iter().enumerate() {
        let indices = simplified.triangles(&mesh.indices, *collapses);
        let left = simplified.collapses()[collapses - 1].triangles as usize;
        if indices.len() != 3 * left {
            let bound = format!("must be {left} triangles after {collapses} collapses of the sequence");
            return Err(InputError::new(format!("chosen[{at}].triangles"), indices.len() / 3, bound));
        }
        levels.push(MeshLevel { indices, error: *error });
    }
    let became: Vec<Became<'_>> = (levels.iter().zip(&remaps))
        .map(|(level, remap)| Became { indices: &level.indices, remap })
        .collect();
    let place = |vertex: u32| (0, simplified.point(vertex));
    let partners = partners(&mesh.indices, &became, place, mesh.vertices());
    let mesh = Mesh { levels, partners, ..mesh.clone() };
    // This also checks the errors and triangle counts of the levels.
    mesh.validate_alone()?;
    Ok((mesh, times(simplified)))
}

/// For each chosen level, the replacement of each vertex.
fn remaps(mesh: &Mesh, simplified: &Simplified, chosen: &[ChosenLevel]) -> Result<Vec<Vec<u32>>, InputError> {
    mesh.validate_alone()?;
    let vertices = simplified.remap(0).len();
    let reason = "as of the mesh that was simplified";
    InputError::check_same("mesh.positions.len", mesh.vertices(), vertices, reason)?;
    InputError::check_most("chosen.len", chosen.len(), MAX_LEVELS - 1)?;
    let mut least = 1;
    let most = simplified.collapses().len();
    for (at, ChosenLevel { collapses, .. }) in chosen.iter().enumerate() {
        InputError::check_within(format!("chosen[{at}].collapses"), *collapses, least..=most)?;
        least = collapses + 1;
    }
    Ok(chosen.iter().map(|level| simplified.remap(level.collapses)).collect())
}

fn times(simplified: &Simplified) -> Vec<u32> {
    let mut times = vec![u32::MAX; simplified.remap(0).len()];
    for collapse in 0..simplified.collapses().len() {
        simplified.moved(collapse).iter().for_each(|[from, _]| times[*from as usize] = collapse as u32);
    }
    times
}
