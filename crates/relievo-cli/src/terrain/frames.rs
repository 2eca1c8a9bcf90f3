//! The pictures of `relievo terrain` on the way to other heights.

use relievo::Error;
use relievo_lab::files::Staged;
use serde::Serialize;

use super::color_maps::fields_of;
use super::{Made, Plan, Terrain};
use crate::progress::bar;

/// A picture on the way, for the report.
#[derive(Serialize)]
pub struct Frame {
    frame: usize,
    /// How far the heights are on the way: 0 to 1.
    time: f64,
}

/// Whether a file's name is one that a picture or a map of a frame has.
pub fn is_name(name: &str) -> bool {
    let number = name
        .strip_suffix(".png")
        .and_then(|stem| ["frame_", "map_"].iter().find_map(|start| stem.strip_prefix(start)));
    number.is_some_and(|number| number.len() == 4 && number.bytes().all(|digit| digit.is_ascii_digit()))
}

impl Terrain {
    /// Draws and writes the pictures on the way, one after the other. After it the device holds the heights of the last.
    pub(super) fn write_frames(
        &self,
        plan: &Plan,
        made: &Made,
        staged: &mut Staged,
    ) -> Result<Vec<Frame>, Error> {
        let Some(way) = &made.way else { return Ok(Vec::new()) };
        let (maps, look) = (plan.maps(), self.look(plan));
        let size = plan.recipe.config.patch_size;
        let progress = bar(way.times.len() as u64, "drawing");
        let mut frames = Vec::new();
        for (frame, time) in way.times.iter().enumerate() {
            let windows = way.windows(*time);
            let (colors, view) = match &made.gpu {
                Some(gpu) if windows.is_empty() => {
                    let parts = way.fields(gpu, *time)?;
                    (maps.on_device(gpu, &parts)?, Some(look.picture(gpu, &parts, way.range)?))
                }
                Some(gpu) => {
                    let parts = fields_of(gpu, size + 2, &windows)?;
                    let view = look.picture(gpu, &parts, way.range)?;
                    (maps.on_host(&windows, &|| ())?, Some(view))
                }
                None => (maps.on_host(&windows, &|| ())?, None),
            };
            staged.write_png(format!("map_{frame:04}.png"), &plan.grid.mosaic(size, &colors))?;
            if let Some(view) = &view {
                staged.write_png(format!("frame_{frame:04}.png"), view)?;
            }
            frames.push(Frame { frame, time: time.time });
            progress.inc(1);
        }
        progress.finish_and_clear();
        Ok(frames)
    }
}
