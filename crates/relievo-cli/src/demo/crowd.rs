//! The pictures of `relievo crowd`: a crowd, and a plot of animation level of detail.

use std::time::Instant;

use relievo::Error;

use super::{Entry, Page, entry};
use crate::crowd::Crowd;

const PICTURE: Entry = entry(
    "crowd",
    "A hundred creatures, each at its own moment, drawn by a scene",
    "--model builtin --clip walk --gate bounded --image --instances 100 --spacing 0.6 --distance 600 --frames 8",
);

const PLOT: Entry = entry(
    "crowd_pareto",
    "Error on the screen against the fraction of bones that are interpolated, for each gate: lower and further left is better",
    "--pareto --model builtin --clip walk --instances 8 --frames 120",
);

/// Number of pictures.
pub const COUNT: usize = 2;

/// Draws both pictures onto the page.
pub fn draw(page: &mut Page<'_>) -> Result<(), Error> {
    page.draw("crowd", &[PICTURE], &[], |command: &Crowd, context| {
        let start = Instant::now();
        let picture = command.picture(context)?;
        let seconds = start.elapsed().as_secs_f64();
        Ok((
            picture,
            format!("no vertex is more than a pixel off; {seconds:.3} s, with all that is measured"),
        ))
    })?;
    page.draw("crowd", &[PLOT], &[], |command: &Crowd, _| {
        let note = "points a bone's length from each bone, against full evaluation";
        Ok((command.comparison()?, note.to_owned()))
    })
}
