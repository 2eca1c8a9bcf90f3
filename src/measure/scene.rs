//! Times the whole frame against distance: without level of detail; with it in animation, in skinning, and in
//! both; and in these and the meshes.

use image::RgbaImage;
use serde::Serialize;

use super::animation::steps;
use super::drawing::{Animation, Drawing, Variant, check_frames};
use super::gates::GateMode;
use super::levels::LevelReport;
use super::options::{DrawnOptions, Layout, LodOptions, MeshDetail, SkinningDetail, Subject};
use super::progress::Listener;
use super::setting::Setting;
use super::stage::{Stage, mean_omega};
use super::vertices::FrameCost;
use crate::Error;
use crate::asset::Mesh;
use crate::gpu::{Gpu, TimedBy};

/// What level of detail saves of whole frames, by distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneReport {
    /// The device's adapter.
    pub adapter: String,
    /// The device's driver.
    pub driver: String,
    /// The clock that took the times.
    pub timed_by: TimedBy,
    /// The model's name.
    pub model: String,
    /// The clip's name.
    pub clip: String,
    /// The gate.
    pub gate: GateMode,
    /// The influences that vertices follow.
    pub skinning: SkinningDetail,
    /// For each mesh, the distances in units at which its fade begins and at which it is rigid; `None` if it
    /// never fades.
    pub fade: Vec<Option<[f32; 2]>>,
    /// For each mesh, the largest distance by which the complete fade moves a vertex, in metres of the model.
    pub stray_metres: Vec<f32>,
    /// The triangles that meshes have.
    pub mesh: MeshDetail,
    /// For each mesh, those of its levels of detail that are used.
    pub levels: Vec<Vec<LevelReport>>,
    /// Number of instances.
    pub instances: usize,
    /// How the instances are placed.
    pub layout: Layout,
    /// The seed of the instances' random positions and start times.
    pub seed: u32,
    /// Number of bones of an instance.
    pub bones: usize,
    /// Number of vertices of an instance.
    pub vertices: usize,
    /// The units, the camera and the frames of the measurement.
    #[serde(flatten)]
    pub setting: Setting,
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
    /// The mean of Ω over the instances, 0 to 1.
    pub mean_omega: f64,
    /// Without level of detail: all bones, influences and triangles.
    pub off: FrameCost,
    /// With the gate, which chooses the bones that are sampled.
    pub animation: FrameCost,
    /// With the influences of [`DrawnOptions::skinning`](super::DrawnOptions::skinning).
    pub skinning: FrameCost,
    /// With the gate and with these influences.
    pub both: FrameCost,
    /// With both, and the triangles of [`DrawnOptions::mesh`](super::DrawnOptions::mesh); `None` if the
    /// meshes are full.
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
    pub const NAMES: [&str; 5] = ["off", "animation", "skinning", "both", "all"];

    /// The costs in the order of [`NAMES`](Self::NAMES).
    pub fn costs(&self) -> impl Iterator<Item = &FrameCost> {
        [&self.off, &self.animation, &self.skinning, &self.both].into_iter().chain(&self.all)
    }

    fn new(stage: &Stage<'_>, distance: f32, mean_omega: f64, costs: &[FrameCost]) -> Self {
        let [off, animation, skinning, both] = std::array::from_fn(|variant| costs[variant]);
        let all = costs.get(4).copied();
        Self {
            distance,
            tall_pixels: stage.options.size * stage.projection.focal_pixels / distance,
            mean_omega,
            off,
            animation,
            skinning,
            both,
            all,
            cheaper: Cheaper::new(&off, &both),
            all_cheaper: all.map(|all| Cheaper::new(&off, &all)),
        }
    }
}

/// Draws a crowd at each distance in four or five ways, and times whole frames. Each distance comes with a picture of
/// the last frame of the last way, 1920 × 1080 pixels.
///
/// The times are medians. The ways take turns, so that other load of the machine affects all of them alike. The camera
/// does not move.
///
/// # Errors
/// [`InputError`](crate::InputError) for options out of their ranges, fewer than 11 frames, a clip that the
/// model lacks or that lasts more than an hour, and a model without meshes; errors of the device.
pub fn scene(
    gpu: &Gpu,
    subject: Subject<'_>,
    options: &LodOptions,
    drawn: &DrawnOptions,
    listener: Listener<'_>,
) -> Result<(SceneReport, Vec<RgbaImage>), Error> {
    options.validate()?;
    drawn.validate()?;
    check_frames(&options.crowd, SceneRow::NAMES.len())?;
    let stage = Stage::new(subject, &options.crowd, Some(drawn), listener)?;
    let gate = stage.gate(&options.gate)?;
    let variants = variants(drawn);
    let steps = steps(options, "scene", listener);
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for distance in &options.distances {
        let placements = stage.placements(*distance);
        let lods = stage.lods(&placements, &gate, options.gate.pixels());
        let mut drawing = Drawing::new(gpu, &stage, &placements, (&gate, &lods), &variants)?;
        let costs = drawing.run(|| steps.step())?;
        pictures.push(drawing.picture(variants.len() - 1)?);
        rows.push(SceneRow::new(&stage, *distance, mean_omega(&lods), &costs));
    }
    Ok((report(gpu, &stage, options, drawn, rows)?, pictures))
}

/// The variants in the order of [`SceneRow::NAMES`].
fn variants(drawn: &DrawnOptions) -> Vec<Variant> {
    let all = Variant { animation: Animation::Gated, ..Variant::of(drawn) };
    let mut variants = vec![
        Variant::FULL,
        Variant { animation: Animation::Gated, ..Variant::FULL },
        Variant { skinning: drawn.skinning, ..Variant::FULL },
        Variant { mesh: MeshDetail::Full, ..all },
    ];
    if drawn.mesh != MeshDetail::Full {
        variants.push(all);
    }
    variants
}

fn report(
    gpu: &Gpu,
    stage: &Stage<'_>,
    options: &LodOptions,
    drawn: &DrawnOptions,
    distances: Vec<SceneRow>,
) -> Result<SceneReport, Error> {
    let units = |metres: f32| metres / stage.metres_a_unit;
    let fade = |mesh| stage.fade(drawn.skinning, mesh).map(|range| [range.start, range.end].map(units));
    let levels = |(at, mesh): (usize, &Mesh)| {
        let own = stage.levelled.as_ref().map_or(&[][..], |levelled| &levelled.own[at]);
        LevelReport::of_mesh(mesh, own, &stage.level_begins(drawn.mesh, at), stage.metres_a_unit)
    };
    Ok(SceneReport {
        adapter: gpu.adapter().name.clone(),
        driver: gpu.adapter().driver.clone(),
        timed_by: Drawing::timed_by(gpu)?,
        model: stage.subject.name.to_owned(),
        clip: stage.clip.name().to_owned(),
        gate: options.gate,
        skinning: drawn.skinning,
        fade: (0..stage.extents.len()).map(fade).collect(),
        stray_metres: stage.extents.iter().map(|extent| extent.stray).collect(),
        mesh: drawn.mesh,
        levels: stage.model(drawn.mesh).meshes.iter().enumerate().map(levels).collect(),
        instances: options.crowd.instances,
        layout: options.crowd.layout,
        seed: options.crowd.seed,
        bones: stage.set.bones(),
        vertices: stage.subject.model.meshes.iter().map(|mesh| mesh.positions.len()).sum(),
        setting: Setting::new(stage),
        distances,
    })
}
