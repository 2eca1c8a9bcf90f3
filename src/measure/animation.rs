//! A crowd under a gate beside the same in full, over distances (A section 13): work, time, errors.

use image::RgbaImage;
use serde::Serialize;

use super::cpu::Cpu;
use super::device::Device;
use super::drawing::{Animation, Drawing, Variant, check_frames};
use super::errors::{Errors, Jump};
use super::gates::GateMode;
use super::options::{DrawnOptions, Layout, LodOptions, MeshDetail, SkinningDetail, Subject};
use super::play::{Found, StageTimes, play};
use super::progress::{Listener, Steps};
use super::setting::Setting;
use super::stage::{Stage, mean_omega, moving_bones};
use super::vertices::FrameCost;
use crate::Error;
use crate::animation::Gate;
use crate::gpu::{Gpu, TimedBy};

/// What a gate saves and what it costs, by distance.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnimationReport {
    /// The device's adapter; none on the CPU.
    pub adapter: Option<String>,
    /// Its driver.
    pub driver: Option<String>,
    /// What computed: `gpu` or `cpu`.
    pub backend: &'static str,
    /// Whose clock took the times.
    pub timed_by: TimedBy,
    /// The model's name.
    pub model: String,
    /// The clip's name.
    pub clip: String,
    /// The gate.
    pub gate: GateMode,
    /// How many.
    pub instances: usize,
    /// How they stand.
    pub layout: Layout,
    /// What their places and moments are drawn by.
    pub seed: u32,
    /// Bones of an instance.
    pub bones: usize,
    /// Those that the clip moves.
    pub moving_bones: usize,
    /// How it was looked at.
    #[serde(flatten)]
    pub setting: Setting,
    /// What vertices follow, where the crowd is drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skinning: Option<SkinningDetail>,
    /// Which triangles meshes have, where the crowd is drawn.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshDetail>,
    /// One a distance.
    pub distances: Vec<AnimationRow>,
}

/// A crowd at a distance. Bones are counted over all instances and all frames but the first, which is full.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct AnimationRow {
    /// Units to the nearest instance.
    pub distance: f32,
    /// Over instances.
    pub mean_omega: f64,
    /// Bones that were interpolated.
    pub interpolated: u64,
    /// Moving bones that were not.
    pub skipped: u64,
    /// Interpolated bones, of all that move.
    pub fraction: f64,
    /// Bones whose matrices were computed.
    pub concatenated: u64,
    /// The same, of all bones.
    pub concatenated_fraction: f64,
    /// With the gate, divided by all bones of the crowd.
    pub nanoseconds_per_bone: StageTimes,
    /// Without.
    pub full_nanoseconds_per_bone: StageTimes,
    /// Of points a bone's length from each bone, along its axes.
    pub error: Errors,
    /// Of the same.
    pub jump: Jump,
    /// What [`drawn`] adds.
    #[serde(flatten)]
    pub drawn: Option<DrawnRow>,
}

/// A drawn crowd at a distance, with the gate, and in full.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DrawnRow {
    /// Whose clock took the times of frames that are drawn.
    pub drawn_timed_by: TimedBy,
    /// With the gate.
    #[serde(flatten)]
    pub gated: FrameCost,
    /// As [`FrameCost::nanoseconds_per_vertex`], of the same crowd without a gate, fully skinned.
    pub full_nanoseconds_per_vertex: f64,
    /// As [`FrameCost::frame_nanoseconds`].
    pub full_frame_nanoseconds: f64,
    /// As [`FrameCost::compute_nanoseconds`].
    pub full_compute_nanoseconds: f64,
    /// As [`FrameCost::draw_nanoseconds`].
    pub full_draw_nanoseconds: f64,
}

/// Plays a crowd under a gate and the same in full, on the device, or without one by the references on the CPU.
///
/// The times are medians over some forty frames of the run. The camera does not move.
///
/// # Errors
/// [`InputError`](crate::InputError) for options out of their bounds, a clip that the model lacks, and a model that is a
/// point at rest; what the device reports.
pub fn animation(
    gpu: Option<&Gpu>,
    subject: Subject<'_>,
    options: &LodOptions,
    listener: Listener<'_>,
) -> Result<AnimationReport, Error> {
    options.validate()?;
    let stage = Stage::new(subject, &options.crowd, None, listener)?;
    measured(gpu, &stage, options, listener)
}

/// As [`animation`] on the device, and draws both crowds with their meshes, each frame timed with its drawing. A picture
/// of the last frame under the gate comes with each distance: 1920 × 1080, with materials (clay of two colours where a
/// mesh has none).
///
/// # Errors
/// As [`animation`]; [`InputError`](crate::InputError) for fewer than 5 frames, a clip of more than an hour, and a model
/// without meshes.
pub fn drawn(
    gpu: &Gpu,
    subject: Subject<'_>,
    options: &LodOptions,
    drawn: &DrawnOptions,
    listener: Listener<'_>,
) -> Result<(AnimationReport, Vec<RgbaImage>), Error> {
    options.validate()?;
    drawn.validate()?;
    let variants = [Variant::FULL, Variant { animation: Animation::Gated, ..Variant::of(drawn) }];
    check_frames(&options.crowd, variants.len())?;
    let stage = Stage::new(subject, &options.crowd, Some(drawn), listener)?;
    let mut report = measured(Some(gpu), &stage, options, listener)?;
    (report.skinning, report.mesh) = (Some(drawn.skinning), Some(drawn.mesh));
    let gate = stage.gate(&options.gate)?;
    let steps = steps(options, "drawing", listener);
    let mut pictures = Vec::with_capacity(report.distances.len());
    for row in &mut report.distances {
        let placements = stage.placements(row.distance);
        let lods = stage.lods(&placements, &gate, options.gate.pixels());
        let mut drawing = Drawing::new(gpu, &stage, &placements, (&gate, &lods), &variants)?;
        let costs = drawing.run(|| steps.step())?;
        row.drawn = Some(drawn_row(Drawing::timed_by(gpu)?, costs[0], costs[1]));
        pictures.push(drawing.picture(1)?);
    }
    Ok((report, pictures))
}

fn drawn_row(drawn_timed_by: TimedBy, full: FrameCost, gated: FrameCost) -> DrawnRow {
    DrawnRow {
        drawn_timed_by,
        gated,
        full_nanoseconds_per_vertex: full.nanoseconds_per_vertex,
        full_frame_nanoseconds: full.frame_nanoseconds,
        full_compute_nanoseconds: full.compute_nanoseconds,
        full_draw_nanoseconds: full.draw_nanoseconds,
    }
}

/// The frames of all distances.
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
    let moving_bones = moving_bones(&gates[1]);
    let steps = steps(options, options.gate.name().as_str(), listener);
    let row = |distance: &f32| row(gpu, stage, options, &gates, *distance, &steps);
    let distances = options.distances.iter().map(row).collect::<Result<_, Error>>()?;
    let adapter = gpu.map(Gpu::adapter);
    Ok(AnimationReport {
        adapter: adapter.map(|adapter| adapter.name.clone()),
        driver: adapter.map(|adapter| adapter.driver.clone()),
        backend: if gpu.is_some() { "gpu" } else { "cpu" },
        timed_by: gpu.map_or(Ok(TimedBy::Wall), Device::timed_by)?,
        model: stage.subject.name.to_owned(),
        clip: stage.clip.name().to_owned(),
        gate: options.gate,
        instances: options.crowd.instances,
        layout: options.crowd.layout,
        seed: options.crowd.seed,
        bones: stage.set.bones(),
        moving_bones,
        setting: Setting::new(stage),
        skinning: None,
        mesh: None,
        distances,
    })
}

/// `gates` are the one that is measured, and [`GateMode::Off`].
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
    let Found { interpolated, concatenated, errors, jump, gated, full } = found;
    let (pairs, frames) = (stage.pairs(), u64::from(options.crowd.frames));
    let moving = (stage.instances.len() * moving_bones(off)) as u64 * frames;
    Ok(AnimationRow {
        distance,
        mean_omega,
        interpolated,
        skipped: moving.saturating_sub(interpolated),
        fraction: interpolated as f64 / moving.max(1) as f64,
        concatenated,
        concatenated_fraction: concatenated as f64 / (pairs as u64 * frames) as f64,
        nanoseconds_per_bone: gated.a_bone(pairs),
        full_nanoseconds_per_bone: full.a_bone(pairs),
        error: errors,
        jump,
        drawn: None,
    })
}
