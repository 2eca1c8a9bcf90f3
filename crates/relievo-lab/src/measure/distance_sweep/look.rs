//! A group in one mode: a scene, and its measurements at one distance.

use relievo::Error;
use relievo::gpu::{Gpu, GpuError};
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{
    CharacterOptions, ErrorBudget, InstanceBone, InstanceId, ObjectId, Quality, Scene, StageTimes, View,
    WatchedBones,
};

use crate::harness::TimedBy;
use crate::measure::distance_sweep::error::Errors;
use crate::measure::distance_sweep::options::DistanceSweepOptions;
use crate::measure::distance_sweep::place::{Group, camera};
use crate::measure::distance_sweep::report::SweepRow;
use crate::measure::gates::GateName;
use crate::measure::options::{PICTURE, SKY};
use crate::measure::tally::lower_quartile;

/// Number of frames after the camera has moved that are not measured: instances that come into view are updated in full.
const SETTLING: u32 = 2;

/// Number of frames after which the times of a frame's stages have arrived.
const LATE: u32 = 2;

/// Number of waits for the device after which counts must have arrived.
const PATIENCE: u32 = 100;

/// All of the allowed error is for bones. Meshes and influences are exact.
const BUDGET: ErrorBudget = ErrorBudget { mesh: 0.0, bones: 1.0, influences: 0.0 };

/// What frames are drawn into.
pub(super) struct Target(Offscreen);

impl Target {
    pub fn new(gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self(Offscreen::new(gpu, PICTURE)?))
    }
}

/// The clock of the bones' update.
pub(super) fn timed_by(gpu: &Gpu) -> TimedBy {
    match gpu.device().features().contains(wgpu::Features::TIMESTAMP_QUERY) {
        true => TimedBy::Timestamp,
        false => TimedBy::Wall,
    }
}

/// A scene with the group.
pub(super) struct Look<'a> {
    gpu: Gpu,
    mode: GateName,
    scene: Scene,
    view: View,
    crowd: ObjectId,
    instances: Vec<InstanceId>,
    drawing: Option<(&'a Target, Renderer)>,
}

/// The host's times of a frame in milliseconds.
struct HostTimes {
    /// Recording of the compute work.
    record: f64,
    /// From the start of the recording until the device has finished.
    whole: f64,
}

/// The measurements of frames that are not drawn.
#[derive(Default)]
struct Timed {
    bones: u64,
    visible: u32,
    record: Vec<f64>,
    whole: Vec<f64>,
    stages: Vec<StageTimes>,
}

impl<'a> Look<'a> {
    pub async fn new(
        gpu: &Gpu,
        group: &Group<'_>,
        mode: GateName,
        target: Option<&'a Target>,
    ) -> Result<Self, Error> {
        let mut scene = Scene::new_async(gpu).await?;
        scene.set_error_budget(BUDGET)?;
        let options = CharacterOptions { gate: group.options.gate(mode), ..CharacterOptions::default() };
        let placements = group.placements();
        let crowd = scene.add_character_with_async(group.model, placements.len(), &options).await?;
        let mut instances = Vec::new();
        for (at, placement) in placements.into_iter().enumerate() {
            let instance = scene.spawn(crowd, placement)?;
            scene.play(instance, &group.play(at))?;
            instances.push(instance);
        }
        let pixels = if mode == GateName::Bounded { group.options.pixels } else { 0.0 };
        let view = scene.view(Quality::pixels(pixels))?;
        let drawing = match target {
            Some(target) => {
                let mut renderer = Renderer::new(gpu, target.0.format())?;
                renderer.prepare_async(&scene).await?;
                Some((target, renderer))
            }
            None => None,
        };
        Ok(Self { gpu: gpu.clone(), mode, scene, view, crowd, instances, drawing })
    }

    /// Moves the camera to a distance from the group's centre, and measures there.
    pub async fn measure(&mut self, group: &Group<'_>, distance: f32) -> Result<SweepRow, Error> {
        self.view.set(camera(distance))?;
        let timed = self.timed(group).await?;
        let error = self.errors(group, distance).await?;
        let frame_milliseconds = self.drawn(group).await?;
        let usual = |values: Vec<f64>| lower_quartile(values).unwrap_or(0.0);
        let record_milliseconds = usual(timed.record);
        let stages = usual_stages(&timed.stages);
        let update_milliseconds = match stages {
            Some(times) => record_milliseconds + times.gate + times.sample + times.local_to_model,
            None => usual(timed.whole),
        };
        let DistanceSweepOptions { frames, .. } = *group.options;
        let moving = u64::from(timed.visible) * group.animated_bones as u64 * u64::from(frames);
        Ok(SweepRow {
            distance,
            mode: self.mode,
            visible: timed.visible,
            interpolated: timed.bones as f64 / f64::from(frames),
            fraction: timed.bones as f64 / moving.max(1) as f64,
            record_milliseconds,
            stages,
            update_milliseconds,
            update_rate: 1000.0 / update_milliseconds,
            frame_milliseconds,
            frame_rate: frame_milliseconds.map(|milliseconds| 1000.0 / milliseconds),
            error,
        })
    }

    /// Times and counts frames that are not drawn.
    async fn timed(&mut self, group: &Group<'_>) -> Result<Timed, Error> {
        self.scene.set_statistics(true)?;
        for _ in 0..SETTLING {
            self.frame(group, false).await?;
        }
        let (first, frames) = (self.scene.frames(), u64::from(group.options.frames));
        let (mut timed, mut last) = (Timed::default(), None);
        for number in 0..frames + u64::from(LATE) {
            let HostTimes { record, whole } = self.frame(group, false).await?;
            if number < frames {
                let [bones, visible] = self.counts().await?;
                timed.bones += u64::from(bones);
                timed.visible = visible;
                timed.record.push(record);
                timed.whole.push(whole);
            }
            let measured = first..first + frames;
            if let Some(times) = self.scene.stage_times()
                && measured.contains(&times.frame)
                && last != Some(times.frame)
            {
                last = Some(times.frame);
                timed.stages.push(*times);
            }
        }
        self.scene.set_statistics(false)?;
        Ok(timed)
    }

    /// Measures the errors of bones of some visible instances.
    async fn errors(&mut self, group: &Group<'_>, distance: f32) -> Result<super::report::SweepError, Error> {
        let mut errors = Errors::new(group.model, distance);
        let names: Vec<String> = errors.bones().map(|bone| bone_name(group, bone)).collect();
        let Some(first) = names.first() else { return Ok(errors.finish()) };
        let of = |instance: &InstanceId, bone| InstanceBone { instance: *instance, bone };
        // One bone of each instance tells which instances are visible.
        let one: Vec<InstanceBone<'_>> = self.instances.iter().map(|instance| of(instance, first)).collect();
        self.scene.watch_bones(&one)?;
        self.frame(group, false).await?;
        let seen = self.watched().await?.bones;
        let seen: Vec<InstanceId> =
            seen.iter().filter(|bone| bone.is_current).map(|bone| bone.instance).collect();
        let every = seen.len().div_ceil(group.options.measured).max(1);
        let all: Vec<InstanceBone<'_>> = (seen.iter().step_by(every))
            .flat_map(|instance| names.iter().map(move |bone| of(instance, bone)))
            .collect();
        self.scene.watch_bones(&all)?;
        for _ in 0..group.options.error_frames {
            self.frame(group, false).await?;
            if !all.is_empty() {
                let watched = self.watched().await?;
                errors.add(&self.scene, &watched.bones)?;
            }
        }
        self.scene.watch_bones(&[])?;
        Ok(errors.finish())
    }

    /// The time of whole frames in milliseconds; `None` if nothing is to be drawn.
    async fn drawn(&mut self, group: &Group<'_>) -> Result<Option<f64>, Error> {
        let mut times = Vec::new();
        for _ in 0..group.options.drawn_frames {
            times.push(self.frame(group, true).await?.whole);
        }
        Ok(lower_quartile(times))
    }

    /// Plays the next frame, and waits until the device has finished.
    async fn frame(&mut self, group: &Group<'_>, is_drawn: bool) -> Result<HostTimes, Error> {
        let Self { gpu, scene, view, drawing, .. } = self;
        scene.advance(group.options.rate.recip() as f32)?;
        let start = (group.clock)();
        let mut encoder = gpu.encoder("distance sweep");
        scene.record(&mut encoder, &mut [view])?;
        let recorded = (group.clock)();
        if let Some((target, renderer)) = drawing
            && is_drawn
        {
            target.0.record(&mut encoder, SKY, |pass| {
                renderer.draw(pass, scene, view, Layer::Color)?;
                renderer.draw(pass, scene, view, Layer::Transparent)
            })?;
        }
        gpu.scoped(|| gpu.queue().submit([encoder.finish()]))?;
        gpu.wait_async().await?;
        let end = (group.clock)();
        Ok(HostTimes { record: 1e3 * (recorded - start), whole: 1e3 * (end - start) })
    }

    /// Number of interpolated bones, and number of visible instances, of the last frame.
    async fn counts(&mut self) -> Result<[u32; 2], Error> {
        let frame = self.scene.frames() - 1;
        for _ in 0..PATIENCE {
            let scene = self.scene.statistics().filter(|all| all.frame == frame);
            let bones = scene.and_then(|all| all.characters.first()).map(|own| own.bones);
            let view = self.view.statistics().filter(|all| all.frame == frame);
            let own = view.and_then(|all| all.objects.iter().find(|own| own.object == self.crowd));
            if let (Some(bones), Some(own)) = (bones, own) {
                return Ok([bones, own.instances()]);
            }
            self.gpu.wait_async().await?;
        }
        Err(late(frame))
    }

    /// The watched bones of the last frame.
    async fn watched(&mut self) -> Result<WatchedBones, Error> {
        let frame = self.scene.frames() - 1;
        for _ in 0..PATIENCE {
            if let Some(watched) = self.scene.watched_bones().filter(|watched| watched.frame == frame) {
                return Ok(watched.clone());
            }
            self.gpu.wait_async().await?;
        }
        Err(late(frame))
    }
}

fn late(frame: u64) -> Error {
    GpuError::Internal { reason: format!("the counts of frame {frame} have not arrived") }.into()
}

/// A bone as scenes name it: its index, unless another bone has that for its name.
fn bone_name(group: &Group<'_>, bone: usize) -> String {
    let bones = group.model.skeleton.bones();
    let index = bone.to_string();
    let is_taken = bones.iter().any(|other| other.name == index);
    if is_taken { bones[bone].name.clone() } else { index }
}

/// Lower quartiles of the stages' times; `None` without times.
fn usual_stages(all: &[StageTimes]) -> Option<StageTimes> {
    let usual = |of: fn(&StageTimes) -> f64| lower_quartile(all.iter().map(of).collect());
    Some(StageTimes {
        frame: all.last()?.frame,
        select: usual(|times| times.select)?,
        gate: usual(|times| times.gate)?,
        sample: usual(|times| times.sample)?,
        local_to_model: usual(|times| times.local_to_model)?,
        skin: usual(|times| times.skin)?,
    })
}
