//! The pictures of the built-in creature.

use std::time::Instant;

use relievo::Error;

use super::{Entry, Page, entry};
use crate::skin::Skin;

const ENTRIES: &[Entry] = &[
    entry(
        "skin_walk",
        "The built-in creature, 153 bones and 5,284 vertices, as it walks",
        "--model builtin --clip walk --time 0.3",
    ),
    entry(
        "skin_rigid",
        "The same where each vertex follows its strongest bone alone, as far away: see the top of the thigh",
        "--model builtin --clip walk --time 0.3 --influences fade:1",
    ),
    entry(
        "skin_within",
        "The same with a tenth of its triangles: within 14 millimetres of it in every pose of the walk",
        "--model builtin --clip walk --time 0.3 --within 0.014",
    ),
    entry(
        "skin_dual",
        "It waves, blended by dual quaternions",
        "--model builtin --clip wave --time 0.8 --dual-quaternion",
    ),
];

/// Number of pictures.
pub const COUNT: usize = ENTRIES.len();

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>) -> Result<(), Error> {
    page.draw("skin", ENTRIES, &[], |command: &Skin, context| {
        let start = Instant::now();
        let picture = command.picture(context)?;
        let seconds = start.elapsed().as_secs_f64();
        Ok((picture, format!("{seconds:.3} s (first use compiles the kernels)")))
    })
}
