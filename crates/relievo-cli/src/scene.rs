//! `relievo scene`: draws the frames of a scene file, and compares them with full detail.

mod layers;

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use relievo::render::Layer;
use relievo::scene::{Depth, Quality, Transition};
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::measure::{CharacterDump, FrameReport, FrameSummary, ObjectReport, Rendering, ScenePlay};
use relievo_scene_file::LoadedScene;
use serde::Serialize;

use crate::Context;
use crate::arguments::{one_of, size};
use crate::demo::Shown;
use crate::output::say;
use crate::progress::{bar, during};
use layers::Extremes;

const LAYERS: [(&str, Layer); 5] = [
    ("color", Layer::Color),
    ("depth", Layer::Depth),
    ("velocity", Layer::Velocity),
    ("surface", Layer::Surface),
    ("levels", Layer::Levels),
];
const DEPTHS: [(&str, Depth); 2] = [("forward", Depth::Forward), ("reversed", Depth::Reversed)];

/// Draws the frames of a scene file: terrain, models, reliefs and crowds, along the path of its camera.
///
/// Writes frame_0000.png and so on, and report.json: for each frame the pixels by which anything may be off, what was
/// drawn of each object with each level of detail, and what it cost. docs/scene-files.md, which is
/// also the documentation of `relievo_scene_file`, describes the format of scenes; examples/scenes has some to begin with:
///
/// relievo scene examples/scenes/ruins.json --out ruins
///
/// relievo scene examples/scenes/herd.json --frames 240 --compare --out herd
///
/// A mistake in the file is refused with its path (characters[1].scatter.count), and nothing is written.
#[derive(Args)]
pub struct Scene {
    /// The scene, as JSON: a file, or the address of one on a server (`relievo serve`). The files that it names are relative to it.
    #[arg(value_name = "FILE|URL")]
    file: PathBuf,
    /// The server's token.
    #[arg(long, value_name = "TOKEN", env = "RELIEVO_TOKEN", hide_env_values = true)]
    token: Option<String>,
    /// Number of frames.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = RangedU64ValueParser::<u32>::new().range(1..=100_000))]
    frames: u32,
    /// Frames a second: the first is at time 0.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, allow_hyphen_values = true)]
    rate: f32,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", default_value = "960x600", value_parser = size(8192))]
    size: [u32; 2],
    /// By how many pixels anything may be off. Default: the scene's own.
    #[arg(long, value_name = "E", conflicts_with = "full", allow_hyphen_values = true)]
    pixels: Option<f32>,
    /// The largest number of triangles to draw: levels of detail are coarser, all by one factor, until they fit. Default: the
    /// scene's own.
    #[arg(long, value_name = "N", conflicts_with = "full", value_parser = RangedU64ValueParser::<u32>::new().range(1..))]
    triangles: Option<u32>,
    /// How levels of detail change: at once, by a geomorph, in which they move into each other, or by a fade in a band around
    /// each threshold. Default: the scene's own. It applies to all objects; a geomorph, to those that can.
    #[arg(long, value_parser = one_of(Transition::NAMES))]
    transition: Option<Transition>,
    /// Draws everything in full detail.
    #[arg(long, conflicts_with = "compare")]
    full: bool,
    /// What is drawn. Black is where nothing is.
    /// depth: bright near, dark far; report.json has the ends of the range as nearest and farthest.
    /// velocity: red = to the right, green = down, since the last frame; half = still; the ends are `fastest` pixels in
    /// report.json.
    /// surface: normals (-1 to 1 in world axes); frame_0000_albedo.png has colours before light, and frame_0000_id.png the
    /// numbers of object (red) and instance (green), with 16 bits.
    /// levels: the level of detail of each instance, and of each node of endless terrain: red for the finest, then orange, yellow,
    /// green, teal, blue, violet.
    #[arg(verbatim_doc_comment, long, default_value = "color", value_parser = one_of(LAYERS))]
    layer: Layer,
    /// Samples a pixel: 1 or 4. Default: 4, and 1 for other layers than color, which have one alone.
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// The direction of depth: from 0 at the near plane, or from 1.
    #[arg(long, default_value = "forward", value_parser = one_of(DEPTHS))]
    depth: Depth,
    /// Draws the left half and the right half by two views of one submission, as for a split screen. The picture is the
    /// same but for rounding, which decides about some pixels on edges.
    #[arg(long)]
    split: bool,
    /// Also draws every frame at full detail, and reports what that costs, how far the frame is off (the largest
    /// displacement in pixels, and the largest change of one from frame to frame), and FLIP of both pictures. This takes
    /// long: every vertex is measured on the CPU.
    #[arg(long)]
    compare: bool,
    /// Also writes where every bone of every character was drawn: characters.f32 has, for each frame, instance and bone, the
    /// three rows of the matrix from the bone's space to the world, as 12 little-endian floats; characters.json says whose.
    #[arg(long)]
    dump: bool,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct Report<'a> {
    adapter: &'a str,
    driver: &'a str,
    scene: String,
    size: [u32; 2],
    samples: u32,
    layer: &'a str,
    depth: &'a str,
    split: bool,
    rate: f32,
    timed_by: &'a str,
    objects: Vec<ObjectReport>,
    frames: Vec<Frame>,
    summary: FrameSummary,
}

#[derive(Serialize)]
struct Frame {
    frame: u32,
    #[serde(flatten)]
    report: FrameReport,
    #[serde(flatten)]
    extremes: Extremes,
}

impl Scene {
    /// The scene of a file, or of an address.
    fn read(&self) -> Result<LoadedScene, Error> {
        let built_ins = &relievo_samples::Samples;
        match self.file.to_str().filter(|text| text.starts_with("http://") || text.starts_with("https://")) {
            #[cfg(feature = "network")]
            Some(url) => relievo_delivery::client::get_scene(url, self.token.as_deref(), built_ins),
            #[cfg(not(feature = "network"))]
            Some(url) => {
                Err(InputError::new("file", url, "must be a file without the feature `network`").into())
            }
            None => LoadedScene::from_path(&self.file, built_ins),
        }
    }

    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let (loaded, rendering) = self.loaded()?;
        let gpu = context.gpu()?;
        let mut staged = Staged::new(&self.out)?;
        let play = ScenePlay::new(&gpu, &loaded, rendering, self.compare);
        let mut play = play.map_err(|error| self.in_file(error))?;
        let frames = self.play(&mut play, &mut staged)?;
        let summary = self.report(&play, frames, &mut staged)?;
        let is_ours = |name: &str| {
            let number = name.strip_prefix("frame_").and_then(|name| name.strip_suffix(".png"));
            let number = number.map(|name| name.trim_end_matches("_albedo").trim_end_matches("_id"));
            number.is_some_and(|number| number.bytes().all(|digit| digit.is_ascii_digit()))
                || ["characters.json", "characters.f32"].contains(&name)
        };
        staged.remove_stale(is_ours);
        staged.publish()?;
        say(lines(self.frames, self.compare, &summary))
    }

    /// The first frame, for `relievo demo`; writes no files.
    pub fn shown(&self, context: &Context, start: Instant) -> Result<Shown, Error> {
        let (loaded, rendering) = self.loaded()?;
        let play = ScenePlay::new(&context.gpu()?, &loaded, rendering, false);
        let mut play = play.map_err(|error| self.in_file(error))?;
        let FrameReport { objects, pixels, .. } = play.frame(0.0)?;
        let picture = play.player().picture()?;
        let triangles: u64 =
            objects.iter().flat_map(|object| &object.levels).map(|level| level.triangles).sum();
        let seconds = start.elapsed().as_secs_f64();
        let promise = match objects.iter().all(|object| object.pixels.is_some()) {
            true => format!("nothing more than {pixels} px off"),
            false => "not all within bounds".to_owned(),
        };
        let note = format!("{triangles} triangles, {promise}; {seconds:.3} s with loading and compiling");
        Ok(Shown::new(picture, note))
    }

    /// An error of what was read as a mistake in the scene file.
    fn in_file(&self, error: Error) -> Error {
        match error {
            Error::Input(source) => Error::InputFile { path: self.file.clone(), source },
            other => other,
        }
    }

    /// Checks the arguments, and reads the file and what it names.
    fn loaded(&self) -> Result<(LoadedScene, Rendering), Error> {
        if !(self.rate > 0.0 && self.rate <= 1e6) {
            return Err(InputError::new("rate", self.rate, "must be above 0 and at most 1e6").into());
        }
        if self.compare && self.layer != Layer::Color {
            let bound = "must be color where frames are compared";
            return Err(InputError::new("layer", name_of(LAYERS, self.layer), bound).into());
        }
        let (layer, depth) = (self.layer, self.depth);
        let samples = self.samples.unwrap_or(if layer == Layer::Color { 4 } else { 1 });
        let given = Rendering {
            size: self.size,
            samples,
            depth,
            layer,
            is_split: self.split,
            quality: self.quality(Quality::default()),
            transition: self.transition,
        };
        given.validate()?;
        let loaded = during("loading", || self.read())?;
        let quality = self.quality(loaded.file().quality());
        Ok((loaded, Rendering { quality, ..given }))
    }

    /// The quality: what the arguments say, and else the scene's own.
    fn quality(&self, own: Quality) -> Quality {
        match self.full {
            true => Quality::pixels(0.0),
            false => Quality {
                pixels: self.pixels.unwrap_or(own.pixels),
                triangles: self.triangles.or(own.triangles),
                ..own
            },
        }
    }

    /// Draws and writes all frames.
    fn play(&self, play: &mut ScenePlay, staged: &mut Staged) -> Result<Vec<Frame>, Error> {
        let mut dump = CharacterDump::default();
        let output = |error| Error::output("characters.f32", error);
        let mut numbers = match self.dump {
            true => Some(BufWriter::new(File::create(staged.path("characters.f32")).map_err(output)?)),
            false => None,
        };
        let progress = bar(self.frames.into(), "drawing");
        let mut frames: Vec<Frame> = Vec::new();
        for frame in 0..self.frames {
            let report = play.frame(if frame == 0 { 0.0 } else { 1.0 / self.rate })?;
            let extremes = layers::write(play.player(), &format!("frame_{frame:04}"), staged)?;
            if let Some(numbers) = &mut numbers {
                dump.add(play.player(), numbers)?;
            }
            frames.push(Frame { frame, report, extremes });
            if let Some(stages) = play.stages()
                && let Some(earlier) = frames.get_mut(stages.frame as usize)
            {
                earlier.report.stages = Some(stages);
            }
            progress.inc(1);
        }
        progress.finish_and_clear();
        if let Some(mut numbers) = numbers {
            numbers.flush().map_err(output)?;
            staged.write_json("characters.json", &dump)?;
        }
        Ok(frames)
    }

    fn report(
        &self,
        play: &ScenePlay,
        frames: Vec<Frame>,
        staged: &mut Staged,
    ) -> Result<FrameSummary, Error> {
        let reports: Vec<FrameReport> = frames.iter().map(|frame| frame.report.clone()).collect();
        let summary = FrameSummary::new(&reports);
        let rendering = play.player().rendering();
        let adapter = play.player().world().scene.gpu().adapter();
        let report = Report {
            adapter: &adapter.name,
            driver: &adapter.driver,
            scene: self.file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default(),
            size: rendering.size,
            samples: rendering.samples,
            layer: name_of(LAYERS, rendering.layer),
            depth: name_of(DEPTHS, rendering.depth),
            split: rendering.is_split,
            rate: self.rate,
            timed_by: "wall",
            objects: play.objects()?,
            frames,
            summary,
        };
        staged.write_json("report.json", &report)?;
        Ok(summary)
    }
}

fn name_of<T: PartialEq, const N: usize>(names: [(&'static str, T); N], value: T) -> &'static str {
    names.into_iter().find(|(_, other)| *other == value).map_or("", |(name, _)| name)
}

fn lines(frames: u32, is_compared: bool, summary: &FrameSummary) -> String {
    let times = summary.milliseconds;
    let count = if frames == 1 { "1 frame:".to_owned() } else { format!("{frames} frames; medians:") };
    let drawn = format!("{count} {:.2} ms computed, {:.2} ms drawn, with waiting", times.compute, times.draw);
    if !is_compared {
        return drawn;
    }
    let full = summary.full_milliseconds;
    format!(
        "{drawn}\nfull detail: {:.2} ms computed, {:.2} ms drawn\n{:.1} % of its triangles; largest displacement {:.3} px, \
         largest jump {:.3} px, FLIP {:.4} (largest {:.4}); {} of {} samples left out, {} missing",
        full.compute,
        full.draw,
        100.0 * summary.triangle_fraction,
        summary.largest,
        summary.jump,
        summary.mean_flip,
        summary.largest_flip,
        summary.left_out,
        summary.samples,
        summary.missing,
    )
}
