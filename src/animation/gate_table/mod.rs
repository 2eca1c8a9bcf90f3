//! Tables that gates decide by, computed once when clips are loaded. A table has one column per slot of the bone
//! [`Order`](super::Order). It has one row per key time of each clip, one clip after another. The last row of each clip describes
//! the whole clip.

mod animated_bones;
mod bounds;
#[cfg(feature = "gpu")]
mod buffers;
mod columns;
mod expectations;
mod motion;
mod priorities;
pub mod sums;

use super::clip_set::ClipSet;
use crate::InputError;
use crate::asset::keyframe::RotationPath;

pub(crate) use crate::shared::animation::gate::EVERYTHING;
pub use animated_bones::AnimatedBones;
pub(crate) use animated_bones::bits_of;
pub use bounds::{BoneErrorBudget, BoundTable};
#[cfg(feature = "gpu")]
pub(crate) use buffers::TableBuffers;
pub use expectations::ExpectationTable;
pub use priorities::PriorityTable;

/// Largest accumulated motion of a whole clip, in units of the table.
const MAX_MOTION: f64 = EVERYTHING as f64;

/// Largest number of entries of a table.
const MAX_ENTRIES: usize = 1 << 27;

/// Returns an error if `sampled` differs from the rotation path `of_table` that a table's motion was computed for. A table
/// without motion (`None`) allows any path.
///
/// # Errors
/// [`InputError`] if the paths differ; the message names both paths.
pub fn check_path(of_table: Option<RotationPath>, sampled: RotationPath) -> Result<(), InputError> {
    match of_table {
        Some(path) if path != sampled => {
            let bound = format!("must be {path:?}, the path whose motion the gate's table holds");
            Err(InputError::new("crowd.path", format!("{sampled:?}"), bound))
        }
        _ => Ok(()),
    }
}

/// Number of rows of all clips in a set, without rows of parents.
fn rows_of(set: &ClipSet) -> usize {
    set.clips().iter().map(|entry| set.rows(entry) as usize).sum()
}

/// Returns zeroed entries for the rows of all clips plus `more` rows, with `stride` entries per row.
fn empty_rows(set: &ClipSet, more: usize, stride: usize) -> Result<Vec<[u32; 2]>, InputError> {
    let rows = rows_of(set) + more;
    match rows.checked_mul(stride).filter(|entries| *entries <= MAX_ENTRIES) {
        Some(entries) => Ok(vec![[0; 2]; entries]),
        None => {
            let bound =
                format!("times {stride} columns must be at most 2^27: let more tracks share their key times");
            Err(InputError::new("table.rows", rows, bound))
        }
    }
}
