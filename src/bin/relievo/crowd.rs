//! `relievo crowd`

mod detail;
mod pareto;
mod plan;
mod progress;
mod report;
mod scene;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use relievo::{Error, InputError, measure};

use crate::Context;
use crate::arguments::Backend;
use plan::Plan;

/// Plays a crowd under animation level of detail, and measures what it saves and what it costs: A's experiment
/// (section 13), with the error that A left out.
///
/// Every instance plays the clip from a moment of its own. A gate decides in each frame which bones are interpolated;
/// the others keep their last local transforms. The same crowd, evaluated in full, is played beside it. For each
/// distance of the camera this writes how many bones were interpolated and concatenated, what that took, and how far
/// points a bone's length from each bone, along its axes, lie from where full evaluation puts them.
///
/// Gates (--gate):
///   off          every bone that the clip moves
///   skip-period  A's rule: a bone skips one update each priority · Ω · --period seconds
///   uniform      all bones of an instance, in a fraction Ω of the frames: what engines do
///   random       a fraction Ω of the bones, by chance
///   budget       at most --budget bones a frame, those that have missed most on screen
///   bounded      bones that may show an error of more than --pixels: no point is ever further off
///
/// Ω is 1 up to the first distance of --range, 0 from the second on, between them it falls evenly; each instance has
/// its own, by its own distance.
///
/// Units: --size says how many units long, wide or tall (whichever is most) the model at rest counts; --range and
/// --distance are in these units, as A's 200 to 1700 are. The picture is 1080 pixels high with a field of view of 60
/// degrees. The camera looks at the crowd's centre at half its height, --distance units before its nearest instance,
/// so that all of it is in front: from the second distance of --range on, Ω is 0 for all.
///
/// DIR/report.json: "adapter", "driver" (null on the CPU), "backend", "timed_by" (timestamp: the device's clock; wall:
/// the host's), "model", "clip", "gate" {"mode", "period", "budget", "pixels", "weights"}, "instances", "layout",
/// "seed", "bones", "moving_bones" (those of an instance that the clip moves), "size", "metres_a_unit", "spacing",
/// "range", "frames", "rate", "focal_pixels", and "distances", a list of
///   "distance"; "mean_omega"
///   "interpolated", "skipped": bones of instances, of all moving ones in all frames but the first, which is full
///   "fraction": interpolated / moving; "concatenated": bones whose matrices were computed; "concatenated_fraction": of all
///   "nanoseconds_per_bone" {"gate", "sample", "local_to_model", "total"}: medians over frames, divided by all bones of the
///     crowd; gate is the search for clip clocks, the decision and the lists; on the CPU the total alone
///   "full_nanoseconds_per_bone" {"sample", "local_to_model", "total"}: the same crowd without a gate
///   "error" {"rms_metres", "p99_metres", "max_metres", "rms_pixels", "p99_pixels", "max_pixels", "points", "unseen"}:
///     over all points and frames; metres are the model's; points nearer than the near plane are unseen, and have no
///     pixels
///   "jump" {"max_metres", "max_pixels"}: the largest change of a point's error from one frame to the next
/// and cost.png, interpolations.png, error.png: the same against distance.
///
/// With --image, on the GPU, DIR/crowd_<distance>.png too: the last frame of the gated crowd, textured and lit (clay of
/// two colours where a mesh has no material), 1920 × 1080 pixels. Clusters of 64 vertices with a bone that moved are
/// skinned, once, in compute, and drawn from there; who is out of view is not skinned; morph targets move in every
/// frame, whatever the gate says; the gate watches every vertex. "skinning" is what vertices follow (--skinning), and
/// "distances" also have
///   "nanoseconds_per_vertex": palettes, the choice of clusters and vertices, divided by all vertices of the crowd
///   "frame_nanoseconds": gate, places, sampling, concatenation, who is seen, skinning, and the drawing, in one
///     submission; "compute_nanoseconds", "draw_nanoseconds": what precedes the drawing, and the drawing, each alone
///   "full_…" of each: the same crowd without a gate, fully skinned
///   "skinned_fraction": clusters that were skinned, of all, in the frames that were timed
///   "triangle_fraction": triangles that were drawn, of all meshes in full
///   "drawn_timed_by": as "timed_by", of these; on a processor wall
///   "vertex_error": as "error", of all vertices of the full crowd to those drawn, or where a mesh lacks them, to its
///     surface, in the frames that were timed;
///     "unseen" are those of instances out of view too, which are not skinned, nor among the "points"
///
/// A crowd that is drawn needs a clip of at most an hour, which is looked at 60 times a second.
///
/// With --scene, instead: the whole frame at each distance in five ways, which differ in nothing else: "off" (all bones,
/// influences and triangles), "animation" (the gate), "skinning" (--skinning), "both" of these, and "all" (both, and
/// --mesh, where it is not full). DIR/scene.json: what report.json says of the crowd, "vertices", "skinning", "mesh", for
/// each mesh "fade" (units from which on it fades, and from which on it is rigid, or null), "stray_metres" (how far the
/// whole fade takes a vertex), "levels" [{"triangles", "vertices", "error_metres", "from" (units)}], its own that are used,
/// and "distances":
/// "distance", "tall_pixels" (size of the nearest instance), "mean_omega", for each way the fields above, and "cheaper"
/// {"frame", "compute"}, off divided by both, and "all_cheaper", by all. scene.png: "frame_nanoseconds" against distance;
/// crowd_<distance>.png: the last way.
///
/// With --pareto, instead: error against cost for every gate, at one distance (--tall), on the CPU: DIR/pareto.json
/// {"model", "clip", "instances", "bones", "moving_bones", "frames", "rate", "period", "weights", "tall_pixels",
/// "points", "verdicts"}, pareto_max.png, pareto_rms.png. Instances stand at one place, turned every way. A point is
/// {"gate", "parameter", "cost", "concatenated_fraction", the fields of "error", "jump"}: "cost" is interpolated /
/// moving, "parameter" what the gate sweeps: Ω of uniform, random and skip-period, the fraction of the moving bones of
/// budget, the pixels of bounded. Verdicts compare along these curves: "bounded_max_pixels" and "budget_rms_pixels"
/// [{"cost", "gate", "uniform", "random", "ratio"}], errors at equal cost, ratio to the better rival;
/// "bounded_cost" [{"max_pixels", "uniform", "bounded", "ratio"}], costs at equal largest error.
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct Crowd {
    /// A .gltf or .glb file, or `builtin`: a creature of 153 bones with the clips walk, idle and wave.
    #[arg(long, value_name = "FILE|builtin")]
    model: PathBuf,
    /// The clip: its name, or its number, counted from 0.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: String,
    /// How many. Default: 100, with --pareto 25.
    #[arg(long, value_name = "N")]
    instances: Option<usize>,
    /// Rows and columns that face the camera; or anywhere in the same square, turned any way.
    #[arg(long, default_value = "grid")]
    layout: Layout,
    /// Another number, other places and moments.
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u32,
    /// Who decides. Not with --pareto, which compares them all.
    #[arg(long, value_name = "MODE", required_unless_present = "pareto", conflicts_with = "pareto")]
    gate: Option<Gate>,
    /// skip-period: seconds between two skipped updates at priority 1 and Ω = 1.
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, allow_hyphen_values = true)]
    period: f64,
    /// budget: the most bones a frame, over the whole crowd.
    #[arg(long, value_name = "N")]
    budget: Option<u32>,
    /// bounded: the error that may show.
    #[arg(long, value_name = "EPS", default_value_t = 1.0, allow_hyphen_values = true)]
    pixels: f32,
    /// skip-period: weights of the priorities, as for `relievo priorities`.
    #[arg(long, value_name = "W,W,W,W,W,W|analyze", allow_hyphen_values = true)]
    weights: Option<String>,
    /// Units between which detail falls from full to none.
    #[arg(long, value_name = "MIN,MAX", default_value = "200,1700", allow_hyphen_values = true)]
    range: String,
    /// Units from the camera to the nearest instance. Default: seven, over --range.
    #[arg(long, value_name = "D[,D…]", allow_hyphen_values = true)]
    distance: Option<String>,
    /// Units that the model's largest extent counts: 180 is a person in centimetres.
    #[arg(long, value_name = "UNITS", default_value_t = 180.0, allow_hyphen_values = true)]
    size: f32,
    /// Between neighbours of a grid, in sizes of the model.
    #[arg(long, value_name = "SIZES", default_value_t = 0.5, allow_hyphen_values = true)]
    spacing: f32,
    /// Frames that are measured, after a first one that is full.
    #[arg(long, value_name = "F", default_value_t = 240)]
    frames: u32,
    /// Frames a second.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, allow_hyphen_values = true)]
    rate: f64,
    /// What computes; gpu reads the model matrices back from the device.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Error against cost for every gate, on the CPU.
    #[arg(long)]
    pareto: bool,
    /// --pareto: pixels that the model's largest extent takes.
    #[arg(long, value_name = "PIXELS", default_value_t = 100.0, allow_hyphen_values = true)]
    tall: f32,
    /// Draws the crowd, and times the whole frame.
    #[arg(long, conflicts_with = "pareto")]
    image: bool,
    /// Draws the crowd with and without level of detail in animation, skinning and meshes.
    #[arg(long, conflicts_with_all = ["pareto", "image"])]
    scene: bool,
    /// Which bones vertices follow: all of theirs; the K strongest; all, fading to one over --range; or all, fading as far
    /// as no vertex is more than PIXELS off, which with the gate's own --pixels add up. Default: full, with --scene
    /// bounded:0.5.
    #[arg(long, value_name = "full|truncate:K|fade|bounded:PIXELS")]
    skinning: Option<String>,
    /// Which triangles meshes have: all; or as few as it takes for no vertex to be more than PIXELS off what is drawn,
    /// which add to those of --skinning and the gate. Default: full, with --scene bounded:0.5.
    #[arg(long, value_name = "full|bounded:PIXELS")]
    mesh: Option<String>,
    /// The folder.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

/// The gates' names.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Gate {
    Off,
    SkipPeriod,
    Uniform,
    Random,
    Budget,
    Bounded,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Layout {
    Grid,
    Random,
}

impl From<Layout> for measure::Layout {
    fn from(layout: Layout) -> Self {
        match layout {
            Layout::Grid => Self::Grid,
            Layout::Random => Self::Random,
        }
    }
}

impl Crowd {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let plan = Plan::new(self)?;
        match (self.pareto, self.scene) {
            (true, _) => pareto::run(&plan, &self.out)?,
            (_, true) => scene::run(&plan, context, &self.out)?,
            _ => report::run(&plan, self.image, context, &self.out)?,
        }
        Ok(ExitCode::SUCCESS)
    }

    /// Whether meshes are asked for.
    fn is_drawn(&self) -> bool {
        self.image || self.scene
    }

    /// The largest errors of `--pareto` alone, for the demonstration.
    pub fn comparison(&self) -> Result<image::RgbaImage, Error> {
        pareto::largest_errors(&Plan::new(self)?)
    }

    /// The picture of `--image` at the first distance alone, for the demonstration.
    pub fn picture(&self, context: &Context) -> Result<image::RgbaImage, Error> {
        let (_, pictures) = report::measured(&Plan::new(self)?, self.image, context)?;
        let missing = || InputError::new("image", "no", "must be given");
        Ok(pictures.into_iter().next().ok_or_else(missing)?)
    }
}
