//! `relievo crowd`: plays a crowd with level of detail, and measures what it saves and what error it causes.

mod pareto;
mod plan;
mod report;
mod scene;

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use relievo::scene::SkeletonTier;
use relievo::{Error, InputError};
use relievo_lab::measure::{GateName, Layout};

use crate::Context;
use crate::arguments::{Backend, ModelArgs, distance, one_of, pair};
use crate::demo::Shown;
use plan::Plan;
pub use report::clock;

const LAYOUTS: [(&str, Layout); 2] = [("grid", Layout::Grid), ("random", Layout::Random)];

/// Plays a crowd with animation level of detail, and measures what it saves and what error it causes.
///
/// Every instance plays the clip from its own start time. In each frame a gate decides which bones are
/// interpolated; the other bones keep their last local transforms. The same crowd is also evaluated in full. For
/// each distance of the camera the command reports how many bones were interpolated and concatenated, how long that
/// took, and the error: each bone has points one bone length from its origin along its axes, and the error of a
/// point is its distance from where full evaluation puts it.
///
/// Gates (--gate):
///   off          every bone that the clip moves
///   skip-period  the rule of Chakra (2008): a bone skips one update each priority · Ω · --period seconds
///   uniform      all bones of an instance, in a fraction Ω of the frames, as engines commonly do
///   random       a random fraction Ω of the bones
///   budget       at most --budget bones a frame, those that have missed most motion on screen
///   bounded      bones that could show an error of more than --pixels: no point is ever further off
///
/// Ω is 1 up to the first distance of --range and 0 from the second on; between them it falls linearly. Each
/// instance has the Ω of its own distance.
///
/// Units: --size is the number of units in the largest extent of the model at rest. --range and --distance are in
/// these units, as the 200 to 1700 of Chakra (2008) are. The picture is 1080 pixels high with a vertical field of view of 60
/// degrees. The camera looks at the crowd's center at half its height, and is --distance units from the nearest
/// instance, so that the whole crowd is in front of it: from the second distance of --range on, Ω is 0 for all
/// instances.
///
/// Writes DIR/report.json, which has for each distance the numbers of bones, the times in nanoseconds per bone, and
/// the errors in metres and pixels, and cost.png, interpolations.png and error.png, which plot these values against
/// distance. docs/reports.md in the repository describes every field of the JSON files.
///
/// With --image (GPU only), the command also draws the crowd as a scene, and writes DIR/crowd_<distance>.png: its last
/// frame, textured and lit, 1920 × 1080 pixels; meshes without a material are clay of two colours. A scene permits a
/// number of pixels by which anything may be off: the sum of those of --gate bounded, --skinning bounded:PIXELS and
/// --mesh bounded:PIXELS, which it divides among bones, influences and triangles in proportion. Other gates take no
/// pixels, and bound no error; random is measured without a picture. report.json also has the times of computing, of drawing and of whole frames, within
/// these pixels and in full detail, what was drawn, and how far it lies from its place.
///
/// A crowd that is drawn needs a clip of at most an hour, which is sampled 60 times a second, and at least 4 frames.
///
/// With --scene (GPU only), the command instead times six scenes at each distance, which are equal but for their level
/// of detail: "off" (all bones, influences and triangles), "animation" (the pixels of --gate), "skinning" (those of
/// --skinning), "both" of these, "mesh" (those of --mesh) and "all" three; the last two are missing if --mesh is full. It
/// writes DIR/scene.json; scene.png plots the time of a frame against distance; crowd_<distance>.png shows the last scene.
///
/// With --pareto, the command instead compares error against cost for every gate, at one distance (--tall), on the
/// CPU. All instances stand at one place, each turned by another angle. It writes pareto_max.png, pareto_rms.png
/// and DIR/pareto.json.
///
/// relievo crowd --model builtin --clip walk --gate bounded --out crowd
/// relievo crowd --model builtin --clip walk --gate bounded --pixels 0.25 --scene --out frames
/// relievo crowd --model builtin --clip walk --pareto --out gates
#[derive(Args)]
#[command(verbatim_doc_comment)]
pub struct Crowd {
    #[command(flatten)]
    model: ModelArgs,
    /// The clip to play: its name, or its number, counted from 0.
    #[arg(long, value_name = "NAME|INDEX")]
    clip: String,
    /// Number of instances. Default: 100; 25 with --pareto.
    #[arg(long, value_name = "N")]
    instances: Option<usize>,
    /// How instances are placed: in rows and columns that face the camera, or at random positions and angles
    /// in the same square.
    #[arg(long, default_value = "grid", value_parser = one_of(LAYOUTS))]
    layout: Layout,
    /// Seed of the start times and of random positions; another number gives another crowd.
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u32,
    /// The gate that decides which bones are interpolated. Not with --pareto, which compares all gates.
    #[arg(long, value_name = "MODE", required_unless_present = "pareto", conflicts_with = "pareto",
          value_parser = one_of(GateName::ALL.map(|gate| (gate.as_str(), gate))))]
    gate: Option<GateName>,
    /// For skip-period: seconds between two skipped updates at priority 1 and Ω = 1.
    #[arg(long, value_name = "SECONDS", default_value_t = 1.0, allow_hyphen_values = true)]
    period: f64,
    /// For budget: the largest number of bones to interpolate in a frame, over the whole crowd.
    #[arg(long, value_name = "N")]
    budget: Option<u32>,
    /// For bounded: the largest error that may show, in pixels. With --image and --scene, those of --skinning and --mesh
    /// add to it.
    #[arg(long, value_name = "EPS", default_value_t = 1.0, allow_hyphen_values = true)]
    pixels: f32,
    /// For skip-period: weights of the priorities, as for `relievo priorities`.
    #[arg(long, value_name = "W,W,W,W,W,W|analyze", allow_hyphen_values = true)]
    weights: Option<String>,
    /// The caller's priority of a bone, 0 to 1, such as hand_left=1; may be given several times. Other bones have 0.5. It is
    /// the sixth term of skip-period; no gate skips a bone of priority 1.
    #[arg(long, value_name = "BONE=P", value_parser = plan::priority)]
    priority: Vec<(String, f32)>,
    /// Distances in units between which Ω falls from 1 to 0.
    #[arg(long, value_name = "MIN,MAX", default_value = "200,1700", allow_hyphen_values = true,
          value_parser = pair::<f32>("range", ',', "must be two distances, such as 200,1700"))]
    range: [f32; 2],
    /// Distances in units from the camera to the nearest instance. Default: seven, spread over --range.
    #[arg(long, value_name = "D[,D…]", allow_hyphen_values = true, value_delimiter = ',', value_parser = distance)]
    distance: Vec<f32>,
    /// Number of units in the model's largest extent: with 180, the units of a person are centimetres.
    #[arg(long, value_name = "UNITS", default_value_t = 180.0, allow_hyphen_values = true)]
    size: f32,
    /// The gap between neighbours in a grid, in multiples of the model's size.
    #[arg(long, value_name = "SIZES", default_value_t = 0.5, allow_hyphen_values = true)]
    spacing: f32,
    /// Number of frames to measure, after a first frame that is evaluated in full.
    #[arg(long, value_name = "F", default_value_t = 240)]
    frames: u32,
    /// Frames per second.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, allow_hyphen_values = true)]
    rate: f64,
    /// The processor that computes; with gpu, the palettes are read back from the device.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Compares error against cost for every gate, on the CPU.
    #[arg(long)]
    pareto: bool,
    /// For --pareto: the size on screen of the model's largest extent, in pixels.
    #[arg(long, value_name = "PIXELS", default_value_t = 100.0, allow_hyphen_values = true)]
    tall: f32,
    /// Draws the crowd as a scene, and times the whole frame. The gate must not be random.
    #[arg(long, conflicts_with = "pareto")]
    image: bool,
    /// Draws the crowd as scenes with and without level of detail in animation, skinning and meshes. The gate must not
    /// be random.
    #[arg(long, conflicts_with_all = ["pareto", "image"])]
    scene: bool,
    /// Influences per vertex: all; as few as move no vertex by more than PIXELS; the K strongest; or all at the nearer
    /// distance of --range, and one at the farther. Default: full; with --scene bounded:0.5.
    #[arg(long, value_name = "full|bounded:PIXELS|truncate:K|fade")]
    skinning: Option<String>,
    /// The triangles of the meshes: all; or as few as keep the surface within PIXELS of its place, with levels that change at
    /// once (bounded) or move into each other (geomorph). Default: full; with --scene bounded:0.5.
    #[arg(long, value_name = "full|bounded:PIXELS|geomorph:PIXELS")]
    mesh: Option<String>,
    /// Reduced skeletons of the crowd that is drawn, at most 3: fractions of the bones to keep, descending. In a rigid one, each
    /// vertex follows one bone, such as 0.5,0.25,rigid:0.1.
    #[arg(long, value_name = "F[,F…]", value_delimiter = ',', value_parser = plan::tier)]
    tiers: Vec<SkeletonTier>,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Crowd {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let plan = Plan::new(self)?;
        match (self.pareto, self.scene) {
            (true, _) => pareto::run(&plan, &self.out),
            (_, true) => scene::run(&plan, context, &self.out),
            _ => report::run(&plan, self.image, context, &self.out),
        }
    }

    /// Whether the arguments ask for meshes to be drawn.
    fn is_drawn(&self) -> bool {
        self.image || self.scene
    }

    /// The plot of the largest errors, or the picture at the first distance, for `relievo demo`; writes no files.
    pub fn shown(&self, context: &Context, start: Instant) -> Result<Shown, Error> {
        let plan = Plan::new(self)?;
        if self.pareto {
            let note = "points a bone's length from each bone, against full evaluation";
            return Ok(Shown::new(pareto::largest_errors(&plan)?, note));
        }
        let (_, pictures) = report::measured(&plan, self.image, context)?;
        let missing = || InputError::new("image", "no", "must be given");
        let picture = pictures.into_iter().next().ok_or_else(missing)?;
        let seconds = start.elapsed().as_secs_f64();
        let note = format!("no vertex is more than a pixel off; {seconds:.3} s, with all that is measured");
        Ok(Shown::new(picture, note))
    }
}
