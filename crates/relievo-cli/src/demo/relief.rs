//! The pictures of surface mapping.

use relievo::Error;
use relievo_lab::measure::relief::Measured;

use super::{Entry, Page, entry};
use crate::relief::Relief;

const ENTRIES: &[Entry] = &[
    entry(
        "relief_bricks",
        "A flat square: every brick is found by the ray of each pixel, exactly, and shades its neighbours",
        "--builtin bricks --method quadtree --shadow hard",
    ),
    entry(
        "relief_close_plain",
        "Close up, textured only",
        "--builtin bricks --method plain --tile 0.3 --angle 60",
    ),
    entry(
        "relief_close_parallax",
        "Close up, parallax, with heights taken as half the depth above and below the square",
        "--builtin bricks --method parallax --bias -0.05 --tile 0.3 --angle 60",
    ),
    entry(
        "relief_close_relief",
        "Close up, relief: linear, then binary search",
        "--builtin bricks --method relief --tile 0.3 --angle 60",
    ),
    entry(
        "relief_text",
        "Text as a height map, over relaxed cones, with soft shadows",
        "--builtin text --method cone --scale 0.08 --shadow soft --azimuth -20",
    ),
    entry(
        "relief_posts_lost",
        "Thin posts, and ten linear steps that walk past them",
        "--builtin posts --texels 256 --method relief --steps 10 --tile 0.5",
    ),
    entry(
        "relief_posts_cone",
        "The same posts over cones that lose no crossing",
        "--builtin posts --texels 256 --method cone --tile 0.5",
    ),
    entry(
        "relief_cobbles",
        "Cobbles, four tiles, cut along their own outline",
        "--builtin cobbles --tile 2 --silhouette --shadow soft --angle 65 --azimuth 35",
    ),
    entry(
        "relief_grazing",
        "80 degrees from the normal: where linear search is farthest off",
        "--builtin cobbles --angle 80 --shadow hard --light 250,35",
    ),
    entry(
        "relief_clamp",
        "Clamped addressing: beyond the edge its last heights go on",
        "--builtin cobbles --address clamp --angle 70 --azimuth 200",
    ),
];

const COMPARISON: Entry = entry(
    "relief_compare",
    "What each method costs, and how far it is off: lower and further left is better, and numbers at points are steps of linear search",
    "--builtin bricks --texels 256 --compare",
);

/// Number of entries.
pub const COUNT: usize = ENTRIES.len() + 1;

/// Draws every entry onto the page.
pub fn draw(page: &mut Page<'_>, size: &str) -> Result<(), Error> {
    page.draw("relief", ENTRIES, &["--size".as_ref(), size.as_ref()], |command: &Relief, context| {
        let (picture, measured, seconds) = command.picture(context)?;
        let Measured { mean_error_texels, mean_samples, .. } = measured;
        let note = format!(
            "mean error {mean_error_texels:.4} texels, {mean_samples:.1} texel loads a pixel; {seconds:.3} s with maps and \
             measuring"
        );
        Ok((picture, note))
    })?;
    let size = ["--size".as_ref(), "240x150".as_ref()];
    page.draw("relief", &[COMPARISON], &size, |command: &Relief, context| {
        let note = "errors against the exact intersection";
        Ok((command.comparison(context)?, note.to_owned()))
    })
}
