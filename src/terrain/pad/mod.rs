//! Windows around patches of a batch: what `seamless` generates directly, `wrap` and `blend` gather from
//! the patch itself or from its neighbours, so that the stencils after generation work on every border mode.

use crate::InputError;
use crate::terrain::config::{Border, Config};

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::PadPass;

/// Indices of the nine patches around and at a patch, row by row. Where one is missing, the window goes on
/// with the nearest sample that there is.
pub type Surround = [Option<usize>; 9];

/// The surroundings of every patch of a batch: itself for `wrap`, the batch's patches for `blend`.
pub fn surrounds(config: &Config, patches: &[[i32; 2]]) -> Vec<Surround> {
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

/// Checks that windows do not reach past the neighbours.
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
