//! Plays a crowd under a gate beside the same crowd in full, at several distances (A section 13), and
//! measures bones, times and errors.

use image::RgbaImage;
use relievo::Error;
use relievo::gpu::Gpu;
use relievo::ops::animation::Gate;
use serde::Serialize;

use crate::harness::TimedBy;
use crate::measure::cpu::Cpu;
use crate::measure::device::Device;
use crate::measure::drawing::{Drawing, DrawnModel, FrameCost, Parts, check_frames};
use crate::measure::errors::{Errors, Jump};
use crate::measure::gates::GateMode;
use crate::measure::options::{Detail, DrawnOptions, LodOptions, Subject};
use crate::measure::play::{Found, StageTimes, play};
use crate::measure::progress::{Listener, Steps};
use crate::measure::setting::{Setting, TierReport};
use crate::measure::stage::{Stage, animated_bones, mean_omega};

/// What a gate saves and what it costs, by distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnimationReport {
    /// What was measured.
    #[serde(flatten)]
    pub setting: Setting,
    /// The processor that computed: `gpu` or `cpu`.
    pub backend: &'static str,
    /// Number of bones of an instance that the clip moves.
    pub animated_bones: usize,
    /// The influences that vertices follow; only of a crowd that is drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skinning: Option<Detail>,
    /// The triangles that meshes have; only of a crowd that is drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<Detail>,
    /// The reduced skeletons of the crowd that is drawn.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tiers: Vec<TierReport>,
    /// The measurements, one row per distance.
    pub distances: Vec<AnimationRow>,
}

/// A crowd at one distance. Bones are counted over all instances and all frames but the first, which is
/// evaluated in full.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AnimationRow {
    /// Distance from the camera to the nearest instance, in units.
    pub distance: f32,
    /// The mean of Ω over the instances, 0 to 1.
    pub mean_omega: f64,
    /// Number of bones that were interpolated.
    pub interpolated: u64,
    /// Number of animated bones that were not interpolated.
    pub skipped: u64,
    /// Share of the animated bones that were interpolated, 0 to 1.
    pub fraction: f64,
    /// Number of bones whose matrices were computed.
    pub concatenated: u64,
    /// Share of all bones whose matrices were computed, 0 to 1.
    pub concatenated_fraction: f64,
    /// Times of the gated crowd, in nanoseconds per bone of the crowd, moving or not.
    pub nanoseconds_per_bone: StageTimes,
    /// Times of the same crowd without a gate, in nanoseconds per bone of the crowd.
    pub full_nanoseconds_per_bone: StageTimes,
    /// Errors of the points that lie one bone length from each bone's origin along its axes.
    pub error: Errors,
    /// The largest change of these errors from one frame to the next.
    pub jump: Jump,
    /// The measurements of the drawn crowd; only of [`drawn`].
    #[serde(flatten)]
    pub drawn: Option<DrawnRow>,
}

/// A crowd at one distance as a scene draws it: within the permitted pixels, and in full detail.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnRow {
    /// The clock that took the times of the frames that are drawn.
    pub drawn_timed_by: TimedBy,
    /// Costs and displacements within the permitted pixels.
    #[serde(flatten)]
    pub gated: FrameCost,
    /// As [`FrameCost::frame_nanoseconds`], in full detail.
    pub full_frame_nanoseconds: f64,
    /// As [`FrameCost::compute_nanoseconds`], in full detail.
    pub full_compute_nanoseconds: f64,
    /// As [`FrameCost::draw_nanoseconds`], in full detail.
    pub full_draw_nanoseconds: f64,
}

/// Plays a crowd under a gate and the same crowd in full: on the device, or, if `gpu` is `None`, on the CPU by the
/// references.
///
/// The times are medians over about forty frames of the run. The camera does not move.
///
/// # Errors
/// [`InputError`](relievo::InputError) for options out of their ranges, a clip that the model lacks, and a model whose
/// bones all lie in one point at rest; errors of the device.
pub fn animation(
    gpu: Option<&Gpu>,
    subject: Subject<'_>,
    options: &LodOptions,
    listener: Listener<'_>,
) -> Result<AnimationReport, Error> {
    options.validate()?;
    let stage = Stage::new(subject, &options.crowd, false)?;
    measured(gpu, &stage, options, listener)
}

/// As [`animation`] on the device with a gate that bounds the error of every vertex; and draws the crowd by two scenes, within
/// the permitted pixels and in full detail, and times their frames. Each distance comes with a picture of the last frame within
/// these pixels: 1920 × 1080 pixels, with materials (clay of two colours where a mesh has none).
///
/// # Errors
/// As [`animation`]; [`InputError`](relievo::InputError) for a gate that is neither [`GateMode::Off`] nor
/// [`GateMode::Bounded`], for fewer than 4 frames, a clip of more than an hour, and a model without meshes.
pub fn drawn(
    gpu: &Gpu,
    subject: Subject<'_>,
    options: &LodOptions,
    drawn: &DrawnOptions,
    listener: Listener<'_>,
) -> Result<(AnimationReport, Vec<RgbaImage>), Error> {
    options.validate()?;
    drawn.validate()?;
    let parts = [Parts::NONE, Parts::new(&options.gate, drawn)?];
    check_frames(&options.crowd)?;
    let model = DrawnModel::new(subject, drawn.mesh, listener)?;
    let stage = Stage::new(subject, &options.crowd, true)?;
    let mut report = measured(Some(gpu), &stage, options, listener)?;
    (report.skinning, report.mesh) = (Some(drawn.skinning), Some(drawn.mesh));
    report.tiers = TierReport::of(drawn);
    let steps = steps(options, "drawing", listener);
    let mut pictures = Vec::with_capacity(report.distances.len());
    for row in &mut report.distances {
        let placements = stage.placements(row.distance);
        let mut drawing = Drawing::new(gpu, &stage, &model, &placements, &parts)?;
        let costs = drawing.run(1, || steps.step())?;
        let [full, gated] = [costs[0], costs[1]];
        row.drawn = Some(DrawnRow {
            drawn_timed_by: Drawing::timed_by(gpu)?,
            gated,
            full_frame_nanoseconds: full.frame_nanoseconds,
            full_compute_nanoseconds: full.compute_nanoseconds,
            full_draw_nanoseconds: full.draw_nanoseconds,
        });
        pictures.push(drawing.picture(1)?);
    }
    Ok((report, pictures))
}

/// Makes the progress counter of the frames at all distances.
pub(crate) fn steps<'a>(options: &LodOptions, part: &'static str, listener: Listener<'a>) -> Steps<'a> {
    let frames = u64::from(options.crowd.frames + 1);
    Steps::new(listener, part, options.distances.len() as u64 * frames)
}

fn measured(
    gpu: Option<&Gpu>,
    stage: &Stage<'_>,
    options: &LodOptions,
    listener: Listener<'_>,
) -> Result<AnimationReport, Error> {
    let gates = [stage.gate(&options.gate)?, stage.gate(&GateMode::Off)?];
    let animated_bones = animated_bones(&gates[1]);
    let steps = steps(options, options.gate.name().as_str(), listener);
    let row = |distance: &f32| row(gpu, stage, options, &gates, *distance, &steps);
    let distances = options.distances.iter().map(row).collect::<Result<_, Error>>()?;
    let timed_by = gpu.map_or(Ok(TimedBy::Wall), Device::timed_by)?;
    Ok(AnimationReport {
        setting: Setting::new(gpu, timed_by, stage, options),
        backend: if gpu.is_some() { "gpu" } else { "cpu" },
        animated_bones,
        skinning: None,
        mesh: None,
        tiers: Vec::new(),
        distances,
    })
}

/// Measures one distance. `gates` holds the gate that is measured, and [`GateMode::Off`].
fn row(
    gpu: Option<&Gpu>,
    stage: &Stage<'_>,
    options: &LodOptions,
    [gate, off]: &[Gate; 2],
    distance: f32,
    steps: &Steps<'_>,
) -> Result<AnimationRow, Error> {
    let placements = stage.placements(distance);
    let lods = stage.lods(&placements, gate, options.gate.pixels());
    let mean_omega = mean_omega(&lods);
    let step = || steps.step();
    let found = match gpu {
        Some(gpu) => {
            let mut device = Device::new(gpu, stage, gate, &lods)?;
            play(&mut device, stage, &placements, true, step)?
        }
        None => play(&mut Cpu::new(stage, gate, off, lods)?, stage, &placements, true, step)?,
    };
    let Found { interpolated, concatenated, errors, jump, times: [gated, full] } = found;
    let (pairs, frames) = (stage.pairs(), u64::from(options.crowd.frames));
    let moving = (stage.instances.len() * animated_bones(off)) as u64 * frames;
    Ok(AnimationRow {
        distance,
        mean_omega,
        interpolated,
        skipped: moving.saturating_sub(interpolated),
        fraction: interpolated as f64 / moving.max(1) as f64,
        concatenated,
        concatenated_fraction: concatenated as f64 / (pairs as u64 * frames) as f64,
        nanoseconds_per_bone: gated,
        full_nanoseconds_per_bone: full,
        error: errors,
        jump,
        drawn: None,
    })
}
