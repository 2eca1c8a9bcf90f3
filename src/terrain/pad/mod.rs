//! Windows around the patches of a batch: each patch with a margin of samples from its neighbours. `seamless` terrain generates
//! such windows directly. For the border modes `wrap` and `blend`, this module gathers each window from the patch itself or from
//! its neighbours. Stencil operations can therefore run after generation in every border mode.

use crate::InputError;
use crate::terrain::config::{Border, TerrainConfig};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::PadPass;

/// Indices of a 3 × 3 block of patches, row by row; entry 4 is the patch in the middle. Where a neighbour is `None`, the window
/// repeats the nearest existing sample.
pub type Surround = [Option<usize>; 9];

/// Surroundings of every patch of a batch. For `wrap` every entry is the patch itself. For `blend` the entries are the adjacent
/// patches of the batch.
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

/// Checks that a window with `apron` extra samples on each side does not extend beyond the adjacent patches.
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
