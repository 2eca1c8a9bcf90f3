//! `relievo sweep`: the test of A section 13, in which a camera moves away from a group of models.

mod plot;

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use relievo::Error;
use relievo::ops::animation::{Range, Weights, Wrap};
use relievo_lab::files::Staged;
use relievo_lab::measure::{
    DistanceSweepOptions, DistanceSweepReport, SWEEP_MODES, Subject, SweepLayout, SweepRow, distance_sweep,
};

use crate::Context;
use crate::arguments::{ModelArgs, distance, pair};
use crate::crowd::clock;
use crate::output::say;
use crate::priorities;
use crate::progress::shown;

/// Moves a camera away from a group of models, and measures frame rate, work and error of four levels of detail.
///
/// This is the test of Chakra (2008), section 13: 100 models of 153 bones, once in a grid and once at random positions in a
/// cube, with priorities of equal weights over a range of 200 to 1700 units. The group is drawn by scenes of this library. Four
/// scenes take turns at each distance from the camera to the group's centre:
///
///   off          every bone that the clip moves
///   uniform      all bones of an instance, in a fraction Ω of the frames
///   skip-period  the rule of Chakra (2008): a bone skips one update each priority · Ω · --period seconds
///   bounded      bones that could show an error of more than --pixels
///
/// Ω is 1 up to the first distance of --range and 0 from the second on; between them it falls linearly. Each instance has the Ω
/// of its own distance. Instances out of view are updated in no scene, in "off" neither. Meshes are always in full detail.
///
/// Units: --size is the number of units in the largest extent of the model at rest. All other lengths are in these units. The
/// picture is 1920 × 1080 pixels with a vertical field of view of 60 degrees. Chakra gives neither the spacing of the grid nor
/// the edge of the cube. With the defaults, the grid's last corners leave the range when the camera is 1434 units from the
/// centre, and all models when it is 1948 (grid) and 2200 (cube) units away.
///
/// The command measures for each layout, distance and mode:
///
///   updates a second  1 / (the host's time for recording a frame + the device's time for choosing, sampling and concatenating
///                     bones). A device without timestamps has the host's time of all compute work, with skinning
///   frames a second   whole frames, with culling, skinning and drawing, until the device has finished them
///   interpolations    bones interpolated between keyframes, a frame
///   error             pixels between where points that follow bones are drawn, and where full evaluation on the host puts them.
///                     A bone's points lie on its axes, as far from its origin as the furthest vertex that follows it
///
/// Writes DIR/report.json, and plots against distance, the grid beside the cube: frame_rate.png (updates a second),
/// whole_frame_rate.png (frames a second), interpolations.png and error.png. frame_rate.png also shows what Chakra reports: 12
/// frames a second without level of detail; with it 12 up to 200 units in the grid, and 43.6 in the end in both layouts.
/// Chakra gives no other number. In the grid the rate rises most beyond 1400 to 1500 units. In the cube it is above 12
/// everywhere, and falls a little before it rises. docs/reports.md in the repository describes every field of report.json.
///
/// relievo sweep --model builtin --clip walk --out sweep
/// relievo sweep --model builtin --clip walk --distance 0,900,2400 --frames 10 --drawn-frames 0 --out quick
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct Sweep {
    #[command(flatten)]
    model: ModelArgs,
    /// The clip to play: its name, or its number, counted from 0.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: String,
    /// Number of instances.
    #[arg(long, value_name = "N", default_value_t = 100)]
    instances: usize,
    /// Seed of the start times, and of positions and turns in the cube; another number gives another group.
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u32,
    /// Number of units in the model's largest extent: with 180, the units of a person are centimetres.
    #[arg(long, value_name = "UNITS", default_value_t = 180.0, allow_hyphen_values = true)]
    size: f32,
    /// The distance between neighbours in the grid.
    #[arg(long, value_name = "UNITS", default_value_t = 55.0, allow_hyphen_values = true)]
    spacing: f32,
    /// The length of an edge of the cube.
    #[arg(long, value_name = "UNITS", default_value_t = 1000.0, allow_hyphen_values = true)]
    edge: f32,
    /// Distances in units between which Ω falls from 1 to 0.
    #[arg(long, value_name = "MIN,MAX", default_value = "200,1700", allow_hyphen_values = true,
          value_parser = pair::<f32>("range", ',', "must be two distances, such as 200,1700"))]
    range: [f32; 2],
    /// For skip-period: seconds between two skipped updates at priority 1 and Ω = 1.
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, allow_hyphen_values = true)]
    period: f32,
    /// For skip-period: weights of the priorities, as for `relievo priorities`. Default: one sixth each.
    #[arg(long, value_name = "W,W,W,W,W,W|analyze", allow_hyphen_values = true)]
    weights: Option<String>,
    /// For bounded: the largest error that may show, in pixels.
    #[arg(long, value_name = "EPS", default_value_t = 1.0, allow_hyphen_values = true)]
    pixels: f32,
    /// Distances in units from the camera to the group's centre, in the order of the sweep. Default: fifteen, from 0 to 2400.
    #[arg(long, value_name = "D[,D…]", allow_hyphen_values = true, value_delimiter = ',', value_parser = distance)]
    distance: Vec<f32>,
    /// Number of frames to time and count for each distance and mode.
    #[arg(long, value_name = "F", default_value_t = 30)]
    frames: u32,
    /// Number of frames whose errors are measured, after those that are timed.
    #[arg(long, value_name = "F", default_value_t = 10)]
    error_frames: u32,
    /// Number of frames to draw and time as a whole; 0 draws nothing.
    #[arg(long, value_name = "F", default_value_t = 5)]
    drawn_frames: u32,
    /// Frames per second of the animation's time.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, allow_hyphen_values = true)]
    rate: f64,
    /// The largest number of visible instances whose errors are measured in a frame.
    #[arg(long, value_name = "N", default_value_t = 16)]
    measured: usize,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// The name of the report's file.
const REPORT: &str = "report.json";

impl Sweep {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let mut options = self.options();
        options.validate()?;
        let model = self.model.open()?;
        let clip = self.model.clip(&model, &self.clip)?;
        options.weights =
            priorities::weights(self.weights.as_deref(), &model.skeleton, &model.clips[clip], Wrap::Loop)?;
        let name = self.model.name();
        let subject = Subject { name: &name, model: &model, clip };
        let gpu = context.gpu()?;
        let staged = Staged::new(&self.out)?;
        let start = Instant::now();
        let clock = || start.elapsed().as_secs_f64();
        let report =
            shown(|listener| gpu.block_on(distance_sweep(&gpu, subject, &options, &clock, listener)))?;
        publish(staged, &options, &report)?;
        say(format_args!("{}\n{}", table(&report), summary(&report).trim_end()))
    }

    fn options(&self) -> DistanceSweepOptions {
        let [min, max] = self.range;
        let distances = match self.distance.is_empty() {
            true => DistanceSweepOptions::DISTANCES.to_vec(),
            false => self.distance.clone(),
        };
        DistanceSweepOptions {
            instances: self.instances,
            seed: self.seed,
            size: self.size,
            spacing: self.spacing,
            edge: self.edge,
            range: Range { min, max },
            period: self.period,
            weights: Weights::default(),
            pixels: self.pixels,
            distances,
            frames: self.frames,
            error_frames: self.error_frames,
            drawn_frames: self.drawn_frames,
            rate: self.rate,
            measured: self.measured,
        }
    }
}

fn publish(
    mut staged: Staged,
    options: &DistanceSweepOptions,
    report: &DistanceSweepReport,
) -> Result<(), Error> {
    staged.write_json(REPORT, report)?;
    for (name, picture) in plot::pictures(options, report)? {
        staged.write_png(name, &picture)?;
    }
    staged.remove_stale(|name| name == REPORT || plot::FILES.contains(&name));
    staged.publish()
}

fn table(report: &DistanceSweepReport) -> String {
    let DistanceSweepReport { instances, bones, vertices, clip, adapter, frames, rate, timed_by, .. } =
        report;
    let mut text = format!(
        "{instances} × {bones} bones, {} of them move in {clip:?}, {vertices} vertices; {adapter}; {frames} frames at {rate} Hz; \
         updates timed by {}.\n\n\
         | layout | distance | mode | visible | interpolations | of moving bones | update ms | updates/s | frames/s | error \
         largest, rms px |\n|---|---:|---|---:|---:|---:|---:|---:|---:|---:|\n",
        report.animated_bones,
        clock(*timed_by),
    );
    for SweepLayout { layout, rows } in &report.layouts {
        for row in rows {
            let frames = row.frame_rate.map_or("–".to_owned(), |rate| format!("{rate:.2}"));
            text += &format!(
                "| {} | {} | {} | {} | {:.0} | {:.1} % | {:.3} | {:.0} | {frames} | {:.3}, {:.3} |\n",
                layout.as_str(),
                row.distance,
                row.mode.as_str(),
                row.visible,
                row.interpolated,
                100.0 * row.fraction,
                row.update_milliseconds,
                row.update_rate,
                row.error.max_pixels,
                row.error.rms_pixels,
            );
        }
    }
    text
}

/// One sentence per layout and mode: the rates at the last distance, compared with those of `off` there.
fn summary(report: &DistanceSweepReport) -> String {
    let mut text = String::new();
    for SweepLayout { layout, rows } in &report.layouts {
        let Some((off, modes)) = rows.rchunks(SWEEP_MODES.len()).next().and_then(|last| last.split_first())
        else {
            continue;
        };
        for mode in modes {
            text += &format!(
                "{} at {} units, {}: {:.2} times the updates a second of off",
                layout.as_str(),
                mode.distance,
                mode.mode.as_str(),
                mode.update_rate / off.update_rate,
            );
            if let (Some(frames), Some(full)) = (mode.frame_rate, off.frame_rate) {
                text += &format!(", and {:.2} times the frames", frames / full);
            }
            let largest = rows.iter().filter(|row| row.mode == mode.mode);
            let largest = largest.map(|row: &SweepRow| row.error.max_pixels).fold(0.0, f64::max);
            text += &format!("; largest error of all distances {largest:.2} pixels.\n");
        }
    }
    text
}
