//! Pictures of surface mapping.

use relievo::Error;
use relievo::surface::Measured;

use super::{Entry, Page};
use crate::relief::Relief;

const ENTRIES: &[Entry] = &[
    Entry {
        name: "relief_bricks",
        title: "A flat square: every brick is found by the ray of each pixel, exactly, and shades its neighbours",
        arguments: &["--builtin", "bricks", "--method", "quadtree", "--shadow", "hard"],
    },
    Entry {
        name: "relief_close_plain",
        title: "Close up, textured only (B figure 5.11)",
        arguments: &["--builtin", "bricks", "--method", "plain", "--tile", "0.3", "--angle", "60"],
    },
    Entry {
        name: "relief_close_parallax",
        title: "Close up, parallax with the square in the middle of the relief (B figure 5.11)",
        arguments: &[
            "--builtin",
            "bricks",
            "--method",
            "parallax",
            "--bias",
            "-0.05",
            "--tile",
            "0.3",
            "--angle",
            "60",
        ],
    },
    Entry {
        name: "relief_close_relief",
        title: "Close up, relief: linear, then binary search (B figure 5.11)",
        arguments: &["--builtin", "bricks", "--method", "relief", "--tile", "0.3", "--angle", "60"],
    },
    Entry {
        name: "relief_text",
        title: "Text as a height map, over relaxed cones, with soft shadows",
        arguments: &[
            "--builtin",
            "text",
            "--method",
            "cone",
            "--scale",
            "0.08",
            "--shadow",
            "soft",
            "--azimuth",
            "-20",
        ],
    },
    Entry {
        name: "relief_posts_lost",
        title: "Thin posts, and ten linear steps that walk past them (B figure 3.6)",
        arguments: &[
            "--builtin",
            "posts",
            "--texels",
            "256",
            "--method",
            "relief",
            "--steps",
            "10",
            "--tile",
            "0.5",
        ],
    },
    Entry {
        name: "relief_posts_cone",
        title: "The same posts over cones that lose no crossing",
        arguments: &["--builtin", "posts", "--texels", "256", "--method", "cone", "--tile", "0.5"],
    },
    Entry {
        name: "relief_cobbles",
        title: "Cobbles, four tiles, cut along their own outline",
        arguments: &[
            "--builtin",
            "cobbles",
            "--tile",
            "2",
            "--silhouette",
            "--shadow",
            "soft",
            "--angle",
            "65",
            "--azimuth",
            "35",
        ],
    },
    Entry {
        name: "relief_grazing",
        title: "80 degrees from the normal: where linear search is farthest off",
        arguments: &["--builtin", "cobbles", "--angle", "80", "--shadow", "hard", "--light", "250,35"],
    },
    Entry {
        name: "relief_clamp",
        title: "Clamped addressing: beyond the edge its last heights go on",
        arguments: &["--builtin", "cobbles", "--address", "clamp", "--angle", "70", "--azimuth", "200"],
    },
];

const COMPARISON: Entry = Entry {
    name: "relief_compare",
    title: "What each method costs, and how far it is off: lower and further left is better",
    arguments: &["--builtin", "bricks", "--texels", "256", "--compare"],
};

/// How many entries there are.
pub const COUNT: usize = ENTRIES.len() + 1;

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>, size: &str) -> Result<(), Error> {
    for entry in ENTRIES {
        page.progress.set_message(entry.name);
        let command: Relief = entry.command("relief", &["--size", size])?;
        let (picture, measured, seconds) = command.picture(page.context)?;
        let Measured { mean_error_texels, mean_samples, .. } = measured;
        let note = format!(
            "mean error {mean_error_texels:.4} texels, {mean_samples:.1} texel loads a pixel; {seconds:.3} s with maps and \
             measuring"
        );
        page.show("relief", entry, &picture, &note)?;
    }
    page.progress.set_message(COMPARISON.name);
    let command: Relief = COMPARISON.command("relief", &["--size", "240x150"])?;
    let plot = command.comparison(page.context)?;
    page.show("relief", &COMPARISON, &plot, "errors against the exact intersection; labels are linear steps")
}
