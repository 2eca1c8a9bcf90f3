//! The scene that is shown: on the device, with its camera, its time, and what the controls change in it.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use relievo::asset::Light;
use relievo::scene::{
    Camera, Depth, InstanceId, LevelChoice, LevelOfDetail, ObjectId, Quality, Ray, Transition, ViewStatistics,
};
use relievo::{Error, InputError};
use relievo_scene_file::{World, WorldKind};
use serde_json::Value;

use crate::controls::{Bones, Levels, QualityControls};
use crate::document::Document;
use crate::eye::Eye;
use crate::history::Sample;
use crate::load::{Known, Ready};
use crate::overlay;
use crate::source::Source;
use crate::stage::{Colors, Stage};
use crate::streaming::{PackageState, Streaming};

/// Largest number of characters among which the nearest is chosen.
const MOST_CHOICES: usize = 500;

/// How the time of the scene goes on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    /// Whether the time goes on.
    pub plays: bool,
    /// Seconds of the scene for each second of the viewer.
    pub speed: f32,
    /// Whether the camera follows the scene's path.
    pub follows: bool,
}

/// The scene that is shown.
pub struct Shown {
    /// The name of the file.
    pub name: String,
    pub(crate) document: Document,
    pub(crate) known: Known,
    pub(crate) source: Arc<dyn Source>,
    /// What the scene still fetches; `None` for one whose files were read whole.
    pub(crate) streaming: Option<Streaming>,
    /// The scene on the device.
    pub stage: Stage,
    /// The same scene in full detail, while both are compared.
    pub full: Option<Stage>,
    /// The camera.
    pub eye: Eye,
    /// The camera when the scene was opened.
    pub home: Eye,
    /// The size of what the camera frames, in world units.
    pub extent: f64,
    /// The controls of quality.
    pub quality: QualityControls,
    /// The controls of levels of detail.
    pub levels: Levels,
    /// The controls of bones.
    pub bones: Bones,
    /// The light, before exposure.
    pub light: Light,
    /// The background, before exposure.
    pub background: [f32; 3],
    /// The exposure: the logarithm to base 2 of the factor of all light.
    pub exposure: f32,
    /// How the time goes on.
    pub clock: Clock,
    /// The chosen character.
    pub chosen: Option<overlay::Bones>,
    /// The gate of characters in the scene file.
    own_gate: Option<Value>,
    /// The settings of each object in the scene file.
    own: Vec<LevelOfDetail>,
    /// What the objects have now: the controls, and the number of levels of each.
    applied: Option<(Levels, Vec<usize>)>,
    /// Whether somebody moved the camera.
    pub(crate) is_moved: bool,
    /// The newest sample whose statistics had arrived.
    last_sample: Sample,
}

impl Shown {
    pub(crate) fn new(name: String, ready: Ready) -> Result<Self, Error> {
        let Ready { document, known, stage, eye, extent, source, streaming } = ready;
        let world = &stage.world;
        let own = world.objects.iter().map(|object| world.scene.level_of_detail(object.object).cloned());
        let own = own.collect::<Result<_, InputError>>()?;
        let (quality, light, background) = (world.quality, world.scene.light(), world.background);
        let clock = Clock { plays: true, speed: 1.0, follows: world.camera.end() > 0.0 };
        Ok(Self {
            name,
            known,
            source,
            streaming,
            full: None,
            eye,
            home: eye,
            extent,
            quality: QualityControls::of(quality),
            levels: Levels::of(extent),
            bones: Bones::of(extent),
            light,
            background,
            exposure: 0.0,
            clock,
            chosen: None,
            own_gate: document.of_characters("gate").cloned(),
            document,
            own,
            applied: None,
            is_moved: false,
            last_sample: Sample::default(),
            stage,
        })
    }

    /// Takes the same scene, built anew after a change that objects cannot follow. Camera, controls and time stay.
    pub(crate) fn rebuilt(&mut self, ready: Ready) -> Result<(), Error> {
        let time = self.time();
        let place = self.chosen.as_ref().and_then(|chosen| place_of(&self.stage.world, chosen.instance));
        let other = Self::new(self.name.clone(), ready)?;
        self.document = other.document;
        self.known = other.known;
        self.streaming = other.streaming;
        self.stage = other.stage;
        self.own = other.own;
        (self.applied, self.chosen, self.full) = (None, None, None);
        if let Some((source, at)) = place
            && let Some(instance) = instance_at(&self.stage.world, &source, at)
        {
            self.chosen = Some(overlay::Bones::choose(&mut self.stage.world, instance)?);
        }
        Ok(self.stage.world.scene.advance(time as f32)?)
    }

    /// Takes the same scene for comparison in full detail.
    pub(crate) fn compare(&mut self, ready: Ready) -> Result<(), Error> {
        let mut full = ready.stage;
        full.world.scene.advance(self.time() as f32)?;
        full.view_mut().set_quality(Quality::pixels(0.0))?;
        let objects: Vec<ObjectId> = full.world.objects.iter().map(|object| object.object).collect();
        for object in objects {
            let own = full.world.scene.level_of_detail(object)?.clone();
            if !matches!(own.choice, LevelChoice::By(relievo::scene::Criterion::Error)) {
                let finest = LevelOfDetail { choice: LevelChoice::Forced(0), ..own };
                full.world.scene.set_level_of_detail(object, &finest)?;
            }
        }
        self.full = Some(full);
        Ok(())
    }

    /// Shows what has arrived of a scene of a site, and asks for what the picture needs.
    ///
    /// # Errors
    /// [`Error`] for packages that do not suit the scene, and of the device.
    pub(crate) async fn stream(&mut self, rate: Option<f64>) -> Result<(), Error> {
        let Some(streaming) = &mut self.streaming else { return Ok(()) };
        streaming.set_rate(rate);
        self.stage.stream(streaming).await?;
        let world = &self.stage.world;
        for object in &world.objects[self.own.len()..] {
            self.own.push(world.scene.level_of_detail(object.object)?.clone());
        }
        Ok(())
    }

    /// Whether something is still fetched that the picture needs.
    pub fn is_streaming(&self) -> bool {
        self.streaming.as_ref().is_some_and(|streaming| !streaming.is_settled())
    }

    /// The packages of a scene of a site, as far as they are there. Empty for a scene whose files were read whole.
    pub fn packages(&self) -> Vec<PackageState> {
        self.streaming.as_ref().map(Streaming::packages).unwrap_or_default()
    }

    /// Why nothing comes from the scene's site, and the seconds until it is asked again; `None` while it answers.
    pub fn waits(&self) -> Option<(String, f64)> {
        self.streaming.as_ref()?.waits()
    }

    /// The scene's time in seconds.
    pub fn time(&self) -> f64 {
        self.stage.world.scene.time()
    }

    /// The time of the path's end, in seconds; 0 without a path.
    pub fn path_end(&self) -> f64 {
        self.stage.world.camera.end()
    }

    /// Moves both scenes in time.
    pub fn advance(&mut self, seconds: f32) -> Result<(), InputError> {
        self.stage.world.scene.advance(seconds)?;
        self.full.iter_mut().try_for_each(|full| full.world.scene.advance(seconds))
    }

    /// Whether pictures change by themselves.
    pub fn is_moving(&self) -> bool {
        let has_clips = self.stage.world.objects.iter().any(|object| object.kind == WorldKind::Character);
        let is_on_path = self.clock.follows && self.time() < self.path_end();
        self.clock.plays && self.clock.speed != 0.0 && (has_clips || is_on_path)
    }

    /// The camera for a picture of this size.
    pub fn camera(&self, size: [u32; 2]) -> Camera {
        let own = self.stage.world.camera.camera(self.time(), size, Depth::Forward);
        if self.clock.follows { own } else { self.eye.camera(&own) }
    }

    /// Lets somebody move the camera: it leaves the path where it is.
    pub fn take_camera(&mut self) {
        if std::mem::replace(&mut self.clock.follows, false) {
            let camera = self.stage.world.camera.camera(self.time(), [960, 600], Depth::Forward);
            self.eye = Eye::of(&camera, self.eye.distance);
        }
        self.is_moved = true;
    }

    /// Puts the camera where it was when the scene was opened.
    pub fn go_home(&mut self) {
        (self.eye, self.is_moved) = (self.home, false);
        self.clock.follows = self.path_end() > 0.0;
    }

    /// The tangent of half the vertical field of view.
    pub fn tangent(&self) -> f64 {
        1.0 / f64::from(self.camera([960, 600]).clip_from_view.y_axis.y)
    }

    /// What a picture of this size shows in a pixel: its place in the world, and the instance.
    pub fn hit(&self, size: [u32; 2], pixel: [f32; 2]) -> Option<relievo::scene::Hit> {
        let ray = Ray::through(&self.camera(size), pixel).ok()?;
        self.stage.world.scene.pick(&ray).ok()?
    }

    /// Chooses the character under a pixel, or none.
    ///
    /// # Errors
    /// [`Error`] of the device.
    pub fn choose(&mut self, hit: Option<relievo::scene::Hit>) -> Result<(), Error> {
        let world = &mut self.stage.world;
        let is_character = |object: ObjectId| {
            world.objects.iter().any(|other| other.object == object && other.kind == WorldKind::Character)
        };
        self.chosen = match hit.filter(|hit| is_character(hit.object)) {
            Some(hit) => Some(overlay::Bones::choose(world, hit.instance)?),
            None => {
                world.scene.watch_bones(&[])?;
                None
            }
        };
        Ok(())
    }

    /// Chooses the character that is nearest to the eye of those in a picture of this size, or any if none is.
    ///
    /// # Errors
    /// [`Error`] of the device.
    pub fn choose_nearest(&mut self, size: [u32; 2]) -> Result<(), Error> {
        let camera = self.camera(size);
        let world = &mut self.stage.world;
        let characters = world.objects.iter().filter(|object| object.kind == WorldKind::Character);
        let instances = characters.filter_map(|object| world.scene.instances(object.object).ok()).flatten();
        let far = |instance: relievo::scene::InstanceId| {
            let place = world.scene.bounds(instance).map(|bounds| bounds.world()).ok()?;
            let middle = 0.5 * (place[0] + place[1]);
            let pixel = overlay::pixel(&camera, middle)?;
            let [width, height] = size.map(f64::from);
            let is_seen = (0.0..width).contains(&pixel.x) && (0.0..height).contains(&pixel.y);
            is_seen.then(|| middle.distance(camera.world()))
        };
        let rated =
            instances.take(MOST_CHOICES).map(|instance| (far(instance).unwrap_or(f64::INFINITY), instance));
        let Some((_, instance)) = rated.min_by(|(a, _), (b, _)| a.total_cmp(b)) else { return Ok(()) };
        self.chosen = Some(overlay::Bones::choose(world, instance)?);
        Ok(())
    }

    /// Gives the scene what the controls say. Levels of detail follow once their number is known, some frames later.
    ///
    /// # Errors
    /// [`Error`] for settings that an object cannot have.
    pub fn apply(&mut self) -> Result<(), Error> {
        let quality = self.quality.quality();
        if self.stage.view().quality() != quality {
            self.stage.view_mut().set_quality(quality)?;
        }
        let factor = self.exposure.exp2();
        let light = Light { color: factor * self.light.color, ..self.light };
        for stage in [Some(&mut self.stage), self.full.as_mut()].into_iter().flatten() {
            stage.world.scene.set_light(light)?;
            stage.world.background = self.background.map(|channel| factor * channel);
        }
        self.apply_levels()
    }

    fn apply_levels(&mut self) -> Result<(), Error> {
        if self.levels.is_own() && self.applied.is_none() {
            return Ok(());
        }
        let levels: Vec<usize> = match self.stage.seen() {
            Some(seen) => seen.objects.iter().map(|object| object.levels.len()).collect(),
            None => return Ok(()),
        };
        if self.applied.as_ref().is_some_and(|(applied, of)| *applied == self.levels && *of == levels) {
            return Ok(());
        }
        // A setting that is refused is not tried again in each frame.
        self.applied = Some((self.levels, levels.clone()));
        let world = &mut self.stage.world;
        for ((object, own), levels) in world.objects.iter().zip(&self.own).zip(levels) {
            if object.kind == WorldKind::Terrain {
                continue;
            }
            let mut of = self.levels.of_object(own, levels);
            if of.transition == Transition::Geomorph && !world.scene.can_morph(object.object)? {
                of.transition = own.transition;
            }
            world.scene.set_level_of_detail(object.object, &of)?;
        }
        self.stage.prepare()
    }

    /// The scene file as the scene is now.
    pub fn document(&mut self) -> Document {
        let mut document = self.document.clone();
        document.set_quality(self.quality.quality());
        let factor = self.exposure.exp2();
        let light = Light { color: factor * self.light.color, ..self.light };
        document.set_light(light, self.background.map(|channel| factor * channel));
        if self.is_moved {
            document.set_camera(self.eye.position(), self.eye.focus());
        }
        if !self.levels.is_own() {
            let world = &self.stage.world;
            // Objects whose packages arrived later are not in the order of the file.
            let mut left: Vec<_> =
                world.objects.iter().filter(|object| object.kind != WorldKind::Terrain).collect();
            for (at, name) in document.names().into_iter().enumerate() {
                let own = match &self.streaming {
                    Some(_) => left.iter().position(|object| Some(&object.source) == name.as_ref()),
                    None => Some(0),
                };
                let Some(own) = own.filter(|own| *own < left.len()) else { continue };
                if let Ok(lod) = world.scene.level_of_detail(left.remove(own).object) {
                    document.set_level_of_detail(at, self.levels.json(lod));
                }
            }
            if let Some(transition) = self.levels.transition {
                document.set_transition(Transition::NAMES[transition].0);
            }
        }
        document
    }

    /// The scene file with the gate that the controls ask for, where it differs from what the scene has.
    pub(crate) fn regated(&self) -> Option<Document> {
        let gate = self.bones.json();
        let wanted = gate.as_ref().or(self.own_gate.as_ref());
        if self.document.of_characters("gate") == wanted {
            return None;
        }
        let mut document = self.document.clone();
        document.set_characters("gate", wanted);
        Some(document)
    }

    /// Turns the sun, by angles in radians to the right and up.
    pub fn turn_sun(&mut self, [right, up]: [f32; 2]) {
        let direction = self.light.direction.normalize_or(Vec3::Y);
        let yaw = direction.x.atan2(direction.z) + right;
        let pitch = (direction.y.clamp(-1.0, 1.0).asin() + up).clamp(0.02, 1.55);
        self.light.direction = Vec3::new(yaw.sin() * pitch.cos(), pitch.sin(), yaw.cos() * pitch.cos());
    }

    /// Moves the focus to a point of the world, and the camera with it.
    pub fn focus(&mut self, point: DVec3) {
        self.take_camera();
        let position = self.eye.position();
        self.eye = Eye::between(position, point);
    }

    /// Records a frame of this size into the targets of its scenes.
    ///
    /// # Errors
    /// As for [`Stage::record`].
    pub(crate) fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        size: [u32; 2],
        colors: Colors,
    ) -> Result<(), Error> {
        let camera = self.camera(size);
        if let Some(chosen) = &mut self.chosen {
            chosen.record(&self.stage.world, &camera);
        }
        self.stage.record(encoder, camera, colors)?;
        self.full.iter_mut().try_for_each(|full| full.record(encoder, camera, colors))
    }

    /// What the last frames drew and what their stages cost, as far as it is known.
    pub(crate) fn sample(&mut self) -> Sample {
        if let Some(chosen) = &mut self.chosen {
            chosen.update(&mut self.stage.world);
        }
        let displacement = self.chosen.as_ref().and_then(overlay::Bones::displacement);
        let scene = &mut self.stage.world.scene;
        let bones = scene.statistics().map(|all| all.characters.iter().map(|of| f64::from(of.bones)).sum());
        let stages = scene
            .stage_times()
            .map(|times| [times.select, times.gate, times.sample, times.local_to_model, times.skin]);
        let seen = self.stage.seen();
        // The statistics of the first frames with a new model or level arrive later.
        let Some(seen) = seen else {
            return Sample { stages, bones: bones.unwrap_or(0.0), displacement, ..self.last_sample.clone() };
        };
        let sample = Sample {
            stages,
            bones: bones.unwrap_or(0.0),
            triangles: triangles(seen) as f64,
            bound: Some(f64::from(seen.pixels)).filter(|pixels| pixels.is_finite()),
            levels: mean_levels(seen),
            displacement,
            ..Sample::default()
        };
        self.last_sample = sample.clone();
        sample
    }
}

/// The source of an instance's object, and the instance's number among all of it.
fn place_of(world: &World, instance: InstanceId) -> Option<(String, usize)> {
    world.objects.iter().find_map(|object| {
        let all = world.scene.instances(object.object).ok()?;
        Some((object.source.clone(), all.iter().position(|other| *other == instance)?))
    })
}

/// The instance of an object with a source.
fn instance_at(world: &World, source: &str, at: usize) -> Option<InstanceId> {
    let of_source = world.objects.iter().filter(|object| object.kind == WorldKind::Character);
    let object = of_source.into_iter().find(|object| object.source == source)?;
    world.scene.instances(object.object).ok()?.get(at).copied()
}

/// Number of triangles that a view drew.
pub(crate) fn triangles(seen: &ViewStatistics) -> u64 {
    seen.objects.iter().map(|object| object.triangles()).sum()
}

/// The mean level of detail of the instances of each object.
fn mean_levels(seen: &ViewStatistics) -> Vec<f64> {
    let mean = |object: &relievo::scene::ObjectStatistics| {
        let instances = f64::from(object.instances());
        let levels = object.levels.iter().enumerate();
        let sum: f64 = levels.map(|(level, of)| level as f64 * f64::from(of.instances)).sum();
        if instances > 0.0 { sum / instances } else { 0.0 }
    };
    seen.objects.iter().map(mean).collect()
}
