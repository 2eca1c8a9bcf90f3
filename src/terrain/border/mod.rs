//! Transitions between patches (thesis B section 3.3.1, "transition area"), for the border mode `blend`. Along a border with an
//! existing patch, the samples of a new patch move towards the existing patch's heights.
//!
//! Where only one neighbour is within reach, samples on the shared border get exactly the neighbour's heights. Near a point where
//! four patches meet, the top or bottom transition runs after the left or right one, so heights on the vertical border no longer
//! match exactly. `seamless` terrain has no such mismatch.

use crate::InputError;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "gpu")]
mod visits;

#[cfg(feature = "gpu")]
pub use pass::BorderPass;

/// Indices of a patch's existing neighbours: to the left, to the right, above (y − 1) and below (y + 1).
pub type Neighbours = [Option<usize>; 4];

/// Neighbours of each patch, limited to patches that come earlier in `patches`.
pub fn neighbours(patches: &[[i32; 2]]) -> Vec<Neighbours> {
    let mut known = std::collections::HashMap::new();
    let mut all = Vec::with_capacity(patches.len());
    for (index, &[x, y]) in patches.iter().enumerate() {
        let at = |dx: i32, dy: i32| known.get(&[x.wrapping_add(dx), y.wrapping_add(dy)]).copied();
        all.push([at(-1, 0), at(1, 0), at(0, -1), at(0, 1)]);
        known.insert([x, y], index);
    }
    all
}

/// Groups patches into waves: each patch is in a later wave than the neighbours that it depends on. Patches of the same wave are
/// independent of each other.
///
/// # Errors
/// [`InputError`] when a patch comes before one of its neighbours.
pub fn waves(neighbours: &[Neighbours]) -> Result<Vec<Vec<u32>>, InputError> {
    let mut wave_of = vec![0; neighbours.len()];
    let mut waves: Vec<Vec<u32>> = Vec::new();
    for (index, around) in neighbours.iter().enumerate() {
        for (side, neighbour) in around.iter().enumerate() {
            let Some(neighbour) = neighbour else { continue };
            if *neighbour >= index {
                let bound = format!("must be below {index}: a patch blends towards earlier ones");
                return Err(InputError::new(format!("neighbours[{index}][{side}]"), neighbour, bound));
            }
            wave_of[index] = wave_of[index].max(wave_of[*neighbour] + 1);
        }
        waves.resize_with(waves.len().max(wave_of[index] + 1), Vec::new);
        waves[wave_of[index]].push(index as u32);
    }
    Ok(waves)
}
