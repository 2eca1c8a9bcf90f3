//! Times the whole frame against distance: without level of detail; with it in animation, in skinning, in both, and in
//! meshes; and in all three.

use image::RgbaImage;
use relievo::Error;
use relievo::gpu::Gpu;
use serde::Serialize;

use crate::measure::animation::steps;
use crate::measure::drawing::{Drawing, DrawnModel, FrameCost, Parts, check_frames};
use crate::measure::levels::LevelReport;
use crate::measure::options::{Detail, DrawnOptions, LodOptions, Subject};
use crate::measure::progress::Listener;
use crate::measure::setting::{Setting, TierReport};
use crate::measure::stage::Stage;

/// What level of detail saves of whole frames, by distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneReport {
    /// What was measured.
    #[serde(flatten)]
    pub setting: Setting,
    /// The influences that vertices follow.
    pub skinning: Detail,
    /// The triangles that meshes have.
    pub mesh: Detail,
    /// The reduced skeletons that were asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tiers: Vec<TierReport>,
    /// The levels of detail of the character, itself included.
    pub levels: Vec<LevelReport>,
    /// Number of vertices of an instance.
    pub vertices: usize,
    /// The measurements, one row per distance.
    pub distances: Vec<SceneRow>,
}

/// A drawn crowd at one distance, in ways that differ in nothing but their level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SceneRow {
    /// Distance from the camera to the nearest instance, in units.
    pub distance: f32,
    /// Size on screen of the nearest instance's largest extent, in pixels.
    pub tall_pixels: f32,
    /// Without level of detail: all bones, influences and triangles.
    pub off: FrameCost,
    /// With the gate, which chooses the bones that are sampled.
    pub animation: FrameCost,
    /// With the influences of [`DrawnOptions::skinning`](crate::measure::DrawnOptions::skinning).
    pub skinning: FrameCost,
    /// With the triangles of [`DrawnOptions::mesh`](crate::measure::DrawnOptions::mesh); `None` if the meshes are full.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<FrameCost>,
    /// With the gate and with these influences.
    pub both: FrameCost,
    /// With all three; `None` if the meshes are full.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub all: Option<FrameCost>,
    /// The times of `off` divided by those of `both`.
    pub cheaper: Cheaper,
    /// The times of `off` divided by those of `all`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub all_cheaper: Option<Cheaper>,
}

/// The ratios of two ways' times; above 1 the second is faster.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Cheaper {
    /// The ratio of the times of whole frames.
    pub frame: f64,
    /// The ratio of the times of what precedes the drawing.
    pub compute: f64,
}

impl Cheaper {
    fn new(off: &FrameCost, way: &FrameCost) -> Self {
        Self {
            frame: off.frame_nanoseconds / way.frame_nanoseconds,
            compute: off.compute_nanoseconds / way.compute_nanoseconds,
        }
    }
}

impl SceneRow {
    /// The names that reports and plots give to the entries of [`costs`](Self::costs).
    pub const NAMES: [&str; 6] = ["off", "animation", "skinning", "both", "mesh", "all"];

    /// The costs in the order of [`NAMES`](Self::NAMES).
    pub fn costs(&self) -> impl Iterator<Item = &FrameCost> {
        [&self.off, &self.animation, &self.skinning, &self.both]
            .into_iter()
            .chain(&self.mesh)
            .chain(&self.all)
    }

    fn new(stage: &Stage<'_>, distance: f32, costs: &[FrameCost]) -> Self {
        let [off, animation, skinning, both] = std::array::from_fn(|variant| costs[variant]);
        let [mesh, all] = [4, 5].map(|variant| costs.get(variant).copied());
        Self {
            distance,
            tall_pixels: stage.options.size * stage.projection.focal_pixels / distance,
            off,
            animation,
            skinning,
            mesh,
            both,
            all,
            cheaper: Cheaper::new(&off, &both),
            all_cheaper: all.map(|all| Cheaper::new(&off, &all)),
        }
    }
}

/// Draws a crowd at each distance in four or six ways, each a scene with its own pixels and shares, and times whole frames.
/// Each distance comes with a picture of the last frame of the last way, 1920 × 1080 pixels.
///
/// The times are medians. The ways take turns, so that other load of the machine affects all of them alike. The camera
/// does not move.
///
/// # Errors
/// [`InputError`](relievo::InputError) for options out of their ranges, for [`GateMode::Random`](crate::measure::GateMode::Random), which no scene has, fewer than 4 frames, a clip that the model lacks or that lasts more than an hour, and a model
/// without meshes; errors of the device.
pub fn scene(
    gpu: &Gpu,
    subject: Subject<'_>,
    options: &LodOptions,
    drawn: &DrawnOptions,
    listener: Listener<'_>,
) -> Result<(SceneReport, Vec<RgbaImage>), Error> {
    options.validate()?;
    drawn.validate()?;
    let ways = ways(&Parts::new(&options.gate, drawn)?, drawn);
    check_frames(&options.crowd)?;
    let model = DrawnModel::new(subject, drawn.mesh, listener)?;
    let stage = Stage::new(subject, &options.crowd, true)?;
    let steps = steps(options, "scene", listener);
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for distance in &options.distances {
        let placements = stage.placements(*distance);
        let mut drawing = Drawing::new(gpu, &stage, &model, &placements, &ways)?;
        let costs = drawing.run(0, || steps.step())?;
        pictures.push(drawing.picture(ways.len() - 1)?);
        rows.push(SceneRow::new(&stage, *distance, &costs));
    }
    let report = SceneReport {
        setting: Setting::new(Some(gpu), Drawing::timed_by(gpu)?, &stage, options),
        skinning: drawn.skinning,
        mesh: drawn.mesh,
        tiers: TierReport::of(drawn),
        levels: model.levels,
        vertices: subject.model.meshes.iter().map(|mesh| mesh.positions.len()).sum(),
        distances: rows,
    };
    Ok((report, pictures))
}

/// The ways to draw in the order of [`SceneRow::NAMES`].
fn ways(all: &Parts, drawn: &DrawnOptions) -> Vec<Parts> {
    let Parts { bones, influences, mesh, gate, skinning, ref tiers } = *all;
    let mut ways = vec![
        Parts::NONE,
        Parts { bones, gate, tiers: tiers.clone(), ..Parts::NONE },
        Parts { influences, skinning, ..Parts::NONE },
        Parts { mesh: 0.0, ..all.clone() },
    ];
    if drawn.mesh != Detail::Full {
        ways.extend([Parts { mesh, ..Parts::NONE }, all.clone()]);
    }
    ways
}
