//! Windows around the patches of a batch. `seamless` terrain generates its windows directly. `wrap` and `blend` gather them
//! here from the patch itself or from its neighbours, so that the stencils after generation work in every border mode.

use crate::InputError;
use crate::terrain::config::{Border, TerrainConfig};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::PadPass;

/// Indices of the nine patches at and around a patch, row by row. If one is missing, the window repeats the nearest sample that
/// exists.
pub type Surround = [Option<usize>; 9];

/// Surroundings of every patch of a batch: for `wrap` the patch itself on every side, for `blend` the patches of the batch.
pub fn surrounds(config: &TerrainConfig, patches: &[[i32; 2]]) -> Vec<Surround> {
    let index: std::collections::HashMap<_, _> =
        patches.iter().enumerate().map(|(index, patch)| (*patch, index)).collect();
    (patches.iter().enumerate())
        .map(|(own, [x, y])| {
            std::array::from_fn(|tile| {
                let (dx, dy) = (tile as i32 % 3 - 1, tile as i32 / 3 - 1);
                match config.border {
                    Border::Blend(_) if tile != 4 => {
                        index.get(&[x.wrapping_add(dx), y.wrapping_add(dy)]).copied()
                    }
                    _ => Some(own),
                }
            })
        })
        .collect()
}

/// Checks that windows do not extend beyond the adjacent patches.
///
/// # Errors
/// [`InputError`] when `apron` is patchSize or more.
pub fn validate(patch_size: u32, apron: u32) -> Result<(), InputError> {
    if apron < patch_size {
        return Ok(());
    }
    let bound = format!("must be below patchSize = {patch_size} with the borders \"wrap\" and \"blend\"");
    Err(InputError::new("apron", apron, bound))
}
