//! Plays the frames of a scene file: what each draws and costs and, beside the same frame at full detail, what its level of
//! detail shows.

use relievo::Error;
use relievo::gpu::{Gpu, GpuError};
use relievo::scene::{LevelStatistics, ObjectId, Quality, StageTimes};
use relievo_scene_file::{LoadedScene, WorldKind, WorldObject};
use serde::Serialize;

use crate::measure::displacement::{Displacement, DisplacementMeter};
use crate::measure::flip::mean_flip;
use crate::measure::player::{FrameTimes, Player, Rendering};
use crate::measure::tally::middle;

/// An object of a scene, as reports name it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObjectReport {
    /// What it is.
    pub kind: WorldKind,
    /// Its file, or the seed of terrain.
    pub name: String,
    /// Number of instances; patches of terrain.
    pub instances: usize,
    /// Levels of detail, from the model itself on: how far each is off in the model's units.
    pub errors: Vec<f32>,
}

/// What a frame drew of an object.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ObjectFrame {
    /// [`Scene::lod_bias`](relievo::scene::Scene::lod_bias).
    pub lod_bias: f32,
    /// Upper bound of the error in pixels; `None` if the object's settings bound no error
    /// ([`ObjectStatistics::pixels`](relievo::scene::ObjectStatistics::pixels)).
    pub pixels: Option<f32>,
    /// What was drawn, level by level; of a split picture, what both views drew.
    pub levels: Vec<DrawnLevel>,
    /// Number of bones that were interpolated; missing unless it is a character.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bones: Option<u32>,
    /// Number of clusters of vertices that were skinned; missing unless it is a character.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clusters: Option<u32>,
    /// Numbers of nodes; missing unless it is endless terrain.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub nodes: Option<NodeCounts>,
}

/// Nodes of endless terrain in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct NodeCounts {
    /// Number of nodes that the frame made. Except of velocities, a frame includes the passes that complete the detail.
    pub made: usize,
    /// Number of nodes that the views draw, without culling.
    pub drawn: usize,
}

/// What was drawn with one level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct DrawnLevel {
    /// Number of instances.
    pub instances: u64,
    /// Number of their triangles.
    pub triangles: u64,
}

/// A frame.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrameReport {
    /// The time of the scene.
    pub seconds: f64,
    /// The number of pixels that the frame permits.
    pub pixels: f32,
    /// What it cost, by the host's clock.
    pub milliseconds: FrameTimes,
    /// The milliseconds of the stages of its compute work, by the device's clock, once they have arrived ([`ScenePlay::stages`]).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stages: Option<StageTimes>,
    /// What it drew, object by object.
    pub objects: Vec<ObjectFrame>,
    /// The comparison with the same frame at full detail.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared: Option<Compared>,
}

/// A frame beside the same one at full detail.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Compared {
    /// What full detail cost.
    pub full_milliseconds: FrameTimes,
    /// Triangles that were drawn.
    pub triangles: u64,
    /// Triangles at full detail.
    pub full_triangles: u64,
    /// How far what is drawn lies from its place. Terrain and reliefs have one level of detail and are not measured.
    pub displacement: Displacement,
    /// The mean FLIP of both pictures.
    pub flip: f64,
}

/// Plays a scene, and beside it the same at full detail if frames are compared.
pub struct ScenePlay {
    player: Player,
    full: Option<FullDetail>,
}

struct FullDetail {
    player: Player,
    /// One for each view.
    meters: Vec<DisplacementMeter>,
}

impl ScenePlay {
    /// Builds the scene, twice if frames are compared. What frames do is counted.
    ///
    /// # Errors
    /// Those of [`LoadedScene::build`] and [`Player::new`].
    pub fn new(
        gpu: &Gpu,
        loaded: &LoadedScene,
        rendering: Rendering,
        is_compared: bool,
    ) -> Result<Self, Error> {
        let player = counted(Player::new(loaded.build(gpu)?, rendering)?)?;
        let full = is_compared.then(|| FullDetail::new(gpu, loaded, &player)).transpose()?;
        Ok(Self { player, full })
    }

    /// The player of the frames, which holds the last of them.
    pub fn player(&self) -> &Player {
        &self.player
    }

    /// The objects of the scene.
    ///
    /// # Errors
    /// None in practice.
    pub fn objects(&self) -> Result<Vec<ObjectReport>, Error> {
        let world = self.player.world();
        let report = |object: &WorldObject| {
            let meshes = object.model.iter().map(|model| relievo::ops::skinning::level_errors(&model.meshes));
            Ok(ObjectReport {
                kind: object.kind,
                name: object.name.clone(),
                instances: world.scene.instances(object.object)?.len(),
                errors: std::iter::once(0.0).chain(meshes.flatten()).collect(),
            })
        };
        world.objects.iter().map(report).collect()
    }

    /// Draws the frame that is `seconds` after the one before, and compares it. Waits for the device.
    ///
    /// # Errors
    /// Those of [`Player::frame`] and [`DisplacementMeter::measure`].
    pub fn frame(&mut self, seconds: f32) -> Result<FrameReport, Error> {
        let milliseconds = self.player.frame(seconds)?;
        let objects = drawn(&mut self.player)?;
        let compared = match &mut self.full {
            Some(full) => Some(full.compare(&self.player, seconds, &objects)?),
            None => None,
        };
        let (time, pixels) = (self.player.world().scene.time(), self.player.rendering().quality.pixels);
        Ok(FrameReport { seconds: time, pixels, milliseconds, stages: None, objects, compared })
    }

    /// The stages of a frame whose times have arrived since; frames count from 0. They take a frame or two, and need a device
    /// with timestamps.
    pub fn stages(&mut self) -> Option<StageTimes> {
        self.player.world_mut().scene.stage_times().copied()
    }
}

impl FullDetail {
    fn new(gpu: &Gpu, loaded: &LoadedScene, player: &Player) -> Result<Self, Error> {
        let rendering = Rendering { quality: Quality::pixels(0.0), ..*player.rendering() };
        let full = counted(Player::new(loaded.build(gpu)?, rendering)?)?;
        let mut meters = Vec::new();
        for _ in player.views() {
            let mut meter = DisplacementMeter::new();
            for object in &player.world().objects {
                if let Some(model) = &object.model {
                    meter.watch(&player.world().scene, object.object, model)?;
                }
            }
            meters.push(meter);
        }
        Ok(Self { player: full, meters })
    }

    fn compare(&mut self, player: &Player, seconds: f32, objects: &[ObjectFrame]) -> Result<Compared, Error> {
        let full_milliseconds = self.player.frame(seconds)?;
        let pixels = player.rendering().quality.pixels;
        let mut displacement = Displacement { pixels, ..Displacement::default() };
        for (meter, view) in self.meters.iter_mut().zip(player.views()) {
            displacement = displacement.and(meter.measure(&player.world().scene, view)?);
        }
        Ok(Compared {
            full_milliseconds,
            triangles: triangles(objects),
            full_triangles: triangles(&drawn(&mut self.player)?),
            displacement,
            flip: mean_flip(&player.picture()?, &self.player.picture()?)?,
        })
    }
}

/// A player that counts what frames do.
fn counted(mut player: Player) -> Result<Player, Error> {
    player.world_mut().scene.set_statistics(true)?;
    Ok(player)
}

/// What the last frame drew of each object. The device has executed it.
fn drawn(player: &mut Player) -> Result<Vec<ObjectFrame>, Error> {
    let made = player.nodes_made().to_vec();
    let (world, views) = player.parts_mut();
    let frame = world.scene.frames().wrapping_sub(1);
    let seen: Vec<_> = views.iter_mut().filter_map(|view| view.statistics().cloned()).collect();
    let characters = world.scene.statistics().cloned();
    let characters = characters.filter(|all| all.frame == frame).map(|all| all.characters);
    let has_characters = world.objects.iter().any(|object| object.kind == WorldKind::Character);
    if has_characters && characters.is_none()
        || seen.len() < views.len()
        || seen.iter().any(|view| view.frame != frame)
    {
        let reason = format!("the counts of frame {frame} have not arrived");
        return Err(GpuError::Internal { reason }.into());
    }
    let levels = |object: ObjectId| {
        let mut sums: Vec<DrawnLevel> = Vec::new();
        let all = seen.iter().flat_map(|view| &view.objects).filter(|own| own.object == object);
        for own in all {
            sums.resize(own.levels.len(), DrawnLevel::default());
            for (sum, LevelStatistics { instances, triangles }) in sums.iter_mut().zip(&own.levels) {
                sum.instances += u64::from(*instances);
                sum.triangles += triangles;
            }
        }
        sums
    };
    let bound = |object: ObjectId| {
        let all = seen.iter().flat_map(|view| &view.objects).filter(|own| own.object == object);
        all.map(|own| own.pixels).fold(0.0, f32::max)
    };
    let of = |(object, made): (&WorldObject, usize)| {
        let terrain = world.scene.terrain_statistics(object.object).ok();
        let own = characters.iter().flatten().find(|own| own.object == object.object);
        Ok(ObjectFrame {
            lod_bias: world.scene.lod_bias(object.object)?,
            pixels: Some(bound(object.object)).filter(|pixels| pixels.is_finite()),
            levels: levels(object.object),
            bones: own.map(|own| own.bones),
            clusters: own.map(|own| own.clusters),
            nodes: terrain.map(|all| NodeCounts { made, drawn: all.drawn }),
        })
    };
    world.objects.iter().zip(made).map(of).collect()
}

fn triangles(objects: &[ObjectFrame]) -> u64 {
    objects.iter().flat_map(|object| &object.levels).map(|level| level.triangles).sum()
}

/// All frames together: the largest figures of those that were compared, and medians of times.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct FrameSummary {
    /// Medians of the milliseconds of frames.
    pub milliseconds: FrameTimes,
    /// The same at full detail; 0 unless frames were compared, like everything below.
    pub full_milliseconds: FrameTimes,
    /// The largest displacement in pixels.
    pub largest: f64,
    /// The largest jump in pixels.
    pub jump: f64,
    /// Samples whose displacement was measured.
    pub samples: u64,
    /// Samples that are nearer to the eye than the near plane and their displacement.
    pub left_out: u64,
    /// Samples of instances that were not drawn.
    pub missing: u64,
    /// The mean of the frames' FLIP.
    pub mean_flip: f64,
    /// The largest FLIP of a frame.
    pub largest_flip: f64,
    /// Triangles of all frames, divided by those at full detail.
    pub triangle_fraction: f64,
}

impl FrameSummary {
    /// Sums up frames.
    pub fn new(frames: &[FrameReport]) -> Self {
        let times = |of: fn(&FrameReport) -> Option<FrameTimes>| {
            let all = || frames.iter().filter_map(of);
            let [compute, draw] =
                [all().map(|times| times.compute).collect(), all().map(|times| times.draw).collect()]
                    .map(|times| middle(times).unwrap_or(0.0));
            FrameTimes { compute, draw }
        };
        let compared = || frames.iter().filter_map(|frame| frame.compared.as_ref());
        let most = |of: fn(&Compared) -> f64| compared().map(of).fold(0.0, f64::max);
        let sum = |of: fn(&Compared) -> u64| compared().map(of).sum::<u64>();
        Self {
            milliseconds: times(|frame| Some(frame.milliseconds)),
            full_milliseconds: times(|frame| Some(frame.compared?.full_milliseconds)),
            largest: most(|frame| frame.displacement.largest),
            jump: most(|frame| frame.displacement.jump),
            samples: sum(|frame| frame.displacement.samples),
            left_out: sum(|frame| frame.displacement.left_out),
            missing: sum(|frame| frame.displacement.missing),
            mean_flip: compared().map(|frame| frame.flip).sum::<f64>() / compared().count().max(1) as f64,
            largest_flip: most(|frame| frame.flip),
            triangle_fraction: sum(|frame| frame.triangles) as f64
                / sum(|frame| frame.full_triangles).max(1) as f64,
        }
    }
}
