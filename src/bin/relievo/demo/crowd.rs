//! A crowd, and a plot of animation level of detail.

use std::time::Instant;

use relievo::Error;

use super::{Entry, Page};
use crate::crowd::Crowd;

const PICTURE: Entry = Entry {
    name: "crowd",
    title: "A hundred creatures, each at its own moment, in one indirect draw",
    arguments: &[
        "--model",
        "builtin",
        "--clip",
        "walk",
        "--gate",
        "bounded",
        "--image",
        "--instances",
        "100",
        "--spacing",
        "0.6",
        "--distance",
        "600",
        "--frames",
        "8",
    ],
};

const PLOT: Entry = Entry {
    name: "crowd_pareto",
    title: "What skipping bones shows, by who decides which: lower and further left is better",
    arguments: &["--pareto", "--model", "builtin", "--clip", "walk", "--instances", "8", "--frames", "120"],
};

/// How many pictures there are.
pub const COUNT: usize = 2;

/// Draws both onto the page.
pub fn draw(page: &mut Page<'_>) -> Result<(), Error> {
    page.progress.set_message(PICTURE.name);
    let start = Instant::now();
    let picture = PICTURE.command::<Crowd>("crowd", &[])?.picture(page.context)?;
    let seconds = start.elapsed().as_secs_f64();
    let note = format!("no vertex is more than a pixel off; {seconds:.3} s, with all that is measured");
    page.show("crowd", &PICTURE, &picture, &note)?;
    page.progress.set_message(PLOT.name);
    let plot = PLOT.command::<Crowd>("crowd", &[])?.comparison()?;
    page.show("crowd", &PLOT, &plot, "points a bone's length from each bone, against full evaluation")
}
