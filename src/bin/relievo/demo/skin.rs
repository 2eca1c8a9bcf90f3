//! The built-in creature.

use std::time::Instant;

use relievo::Error;

use super::{Entry, Page};
use crate::skin::Skin;

const ENTRIES: &[Entry] = &[
    Entry {
        name: "skin_walk",
        title: "The built-in creature, 153 bones and 5,284 vertices, as it walks",
        arguments: &["--model", "builtin", "--clip", "walk", "--time", "0.3"],
    },
    Entry {
        name: "skin_rigid",
        title: "The same where all influences but the strongest have faded, as far away",
        arguments: &["--model", "builtin", "--clip", "walk", "--time", "0.3", "--influences", "fade:1"],
    },
    Entry {
        name: "skin_within",
        title: "The same with a tenth of its triangles: within 14 millimetres of it in every pose of the walk",
        arguments: &["--model", "builtin", "--clip", "walk", "--time", "0.3", "--within", "0.014"],
    },
    Entry {
        name: "skin_dual",
        title: "It waves, blended by dual quaternions",
        arguments: &["--model", "builtin", "--clip", "wave", "--time", "0.8", "--dual-quaternion"],
    },
];

/// How many pictures there are.
pub const COUNT: usize = ENTRIES.len();

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>) -> Result<(), Error> {
    for entry in ENTRIES {
        page.progress.set_message(entry.name);
        let start = Instant::now();
        let picture = entry.command::<Skin>("skin", &[])?.picture(page.context)?;
        let seconds = start.elapsed().as_secs_f64();
        page.show("skin", entry, &picture, &format!("{seconds:.3} s (first use compiles the kernels)"))?;
    }
    Ok(())
}
