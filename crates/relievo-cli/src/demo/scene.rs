//! The picture of a scene file.

use std::time::Instant;

use relievo::Error;
use relievo_lab::files::write_file;

use super::{Entry, Page, entry};
use crate::scene::Scene;

const RUINS: &str = include_str!("../../../../examples/scenes/ruins.json");

const ENTRY: Entry = entry(
    "scene",
    "A scene from a file: nine patches of terrain, walls whose bricks are relief on flat squares, rocks with levels of detail, \
     and a crowd that stands on the ground",
    "",
);

/// Number of entries.
pub const COUNT: usize = 1;

/// Draws the scene onto the page.
pub fn draw(page: &mut Page<'_>, size: &str) -> Result<(), Error> {
    let Entry { name, title, .. } = ENTRY;
    page.progress.set_message(name);
    let file = page.inputs.join("ruins.json");
    write_file(&file, RUINS.as_bytes())?;
    let start = Instant::now();
    let command = ENTRY.command::<Scene>("scene", &[file.as_os_str(), "--size".as_ref(), size.as_ref()])?;
    let (picture, report) = command.picture(page.context)?;
    let seconds = start.elapsed().as_secs_f64();
    let levels = || report.objects.iter().flat_map(|object| &object.levels);
    let triangles: u64 = levels().map(|level| level.triangles).sum();
    page.staged.write("ruins.json", RUINS.as_bytes())?;
    page.staged.write_png(format!("{name}.png"), &picture)?;
    page.figures += &format!(
        "<figure>\n<a class=\"wide\" href=\"{name}.png\"><img src=\"{name}.png\" alt=\"{title}\"></a>\n\
         <figcaption>{title}.<br><code>relievo scene <a href=\"ruins.json\">ruins.json</a> --size {size} --out {name}</code><br>\
         {triangles} triangles, nothing more than {pixels} px off; {seconds:.3} s with loading and compiling</figcaption>\n\
         </figure>\n",
        pixels = report.pixels,
    );
    page.count += 1;
    page.progress.inc(1);
    Ok(())
}
