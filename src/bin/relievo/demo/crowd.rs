//! A plot of animation level of detail.

use clap::{Args, FromArgMatches};
use relievo::Error;

use super::Page;
use crate::crowd::Crowd;
use crate::terrain::save;

const NAME: &str = "crowd_pareto";

const TITLE: &str = "What skipping bones shows, by who decides which: lower and further left is better";

const ARGUMENTS: [&str; 9] =
    ["--pareto", "--model", "builtin", "--clip", "walk", "--instances", "8", "--frames", "120"];

/// How many pictures there are.
pub const COUNT: usize = 1;

/// Draws the plot onto the page.
pub fn draw(page: &mut Page<'_>) -> Result<(), Error> {
    page.progress.set_message(NAME);
    let refused = |error: clap::Error| Error::file(NAME, error);
    let words = ["crowd", "--out", "."].into_iter().chain(ARGUMENTS);
    let matches = Crowd::augment_args(clap::Command::new("crowd")).try_get_matches_from(words);
    let crowd = Crowd::from_arg_matches(&matches.map_err(refused)?).map_err(refused)?;
    save(&page.staged.path(format!("{NAME}.png")), &crowd.comparison()?)?;
    page.figures += &format!(
        "<figure>\n<a class=\"wide\" href=\"{NAME}.png\"><img src=\"{NAME}.png\" alt=\"{TITLE}\"></a>\n\
         <figcaption>{TITLE}.<br><code>relievo crowd {} --out {NAME}</code><br>points a bone's length from each bone, \
         against full evaluation</figcaption>\n</figure>\n",
        ARGUMENTS.join(" "),
    );
    page.count += 1;
    page.progress.inc(1);
    Ok(())
}
