//! Builds the scene that a file describes.

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use relievo::asset::Model;
use relievo::gpu::Gpu;
use relievo::ops::terrain::recipe::Recipe;
use relievo::scene::{LevelOfDetail, ObjectId, Placement, Play, Quality, Scene, TerrainSource, Transition};
use relievo::shared::lod::object::OBJECT_LEVELS;
use relievo::{Error, InputError};

use super::camera::CameraPath;
use super::entries::{EntryKind, ObjectEntry, PlayEntry, Spot};
use super::load::{Loaded, LoadedScene};
use super::parse_object::upright;
use super::scatter::{self, Drawn};
use super::spec::SunOptions;

/// A scene built from a file, with the file's camera and quality.
#[derive(Debug)]
pub struct World {
    /// The scene, at time 0.
    pub scene: Scene,
    /// The scene's objects, in the order of the file: terrain, meshes, characters. Objects whose package arrives later
    /// ([`World::show_package_async`]) follow in the order of their arrival.
    pub objects: Vec<WorldObject>,
    /// The camera and its path over time.
    pub camera: CameraPath,
    /// The quality: how finely the scene is drawn.
    pub quality: Quality,
    /// The shadow of the light; `None` if the light casts no shadow.
    pub shadow: Option<SunOptions>,
    /// The background colour: linear red, green and blue.
    pub background: [f32; 3],
    /// For each entry of meshes and characters, its index in `objects`; `None` as long as its package is missing.
    shown: Vec<Option<usize>>,
}

/// An object of the scene, and its source in the scene file.
#[derive(Debug, Clone)]
pub struct WorldObject {
    /// The object's handle.
    pub object: ObjectId,
    /// The object's kind.
    pub kind: WorldKind,
    /// The `name` in the scene file; without one, the `source`.
    pub name: String,
    /// The seed of a terrain. For other kinds, the source in the scene file: a file name, or `builtin:` and a name.
    pub source: String,
    /// The model of a mesh or a character, with its levels of detail.
    pub model: Option<Arc<Model>>,
}

impl WorldObject {
    /// The model of a character; `None` for other kinds.
    pub fn character(&self) -> Option<&Model> {
        self.model.as_deref().filter(|_| self.kind == WorldKind::Character)
    }
}

/// The kind of an object in a scene file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum WorldKind {
    /// Patches of terrain.
    Terrain,
    /// A static mesh.
    Mesh,
    /// A mesh that carries a relief.
    Relief,
    /// An animated model.
    Character,
}

impl LoadedScene {
    /// Builds the scene: adds all objects and spawns all instances. Waits until the device has generated the terrain.
    ///
    /// # Errors
    /// [`InputError`], with the path in the scene file, in two cases: the terrain has no patch below an instance on the ground,
    /// or the device cannot hold an object. [`relievo::gpu::GpuError`] for other failures of the device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn build(&self, gpu: &Gpu) -> Result<World, Error> {
        gpu.block_on(self.build_async(gpu))
    }

    /// Same as `LoadedScene::build`, but completes once the device has generated the terrain and reported its errors.
    ///
    /// # Errors
    /// Same as `LoadedScene::build`.
    pub async fn build_async(&self, gpu: &Gpu) -> Result<World, Error> {
        let file = &self.file;
        let mut scene = Scene::new_async(gpu).await?;
        scene.set_light(file.light)?;
        let mut objects = Vec::new();
        let mut land = None;
        if let Some(terrain) = &file.terrain {
            let recipe = Recipe { features: self.features.clone(), ..terrain.recipe.clone() };
            let source = TerrainSource::from(recipe)
                .with_patches(&terrain.patches)
                .with_textures(self.textures.clone());
            let source = match &terrain.target {
                Some((target, morph)) => source.with_target(target.clone(), *morph),
                None => source,
            };
            let source = match terrain.endless {
                Some(limits) => source.with_limits(limits),
                None => source,
            };
            let source = match &self.holes {
                Some(holes) => source.with_holes(holes.clone()),
                None => source,
            };
            let source = match &self.elevation {
                Some(elevation) => source.with_elevation(elevation.clone()),
                None => source,
            };
            let source = match terrain.relief {
                Some(relief) => source.with_relief(relief),
                None => source,
            };
            let object =
                scene.add_terrain_async(&source).await.map_err(|error| below("terrain", in_json(error)))?;
            land = Some(object);
            let source = terrain.recipe.config.seed.clone();
            let name = source.clone();
            objects.push(WorldObject { object, kind: WorldKind::Terrain, name, source, model: None });
        }
        let mut shown = vec![None; file.objects.len()];
        for (at, loaded) in self.objects.iter().enumerate() {
            if !matches!(loaded, Loaded::Waiting) {
                let found = self.add(&mut scene, land, at).await?;
                shown[at] = Some(objects.len());
                objects.push(found);
            }
        }
        let (camera, quality, background) = (file.camera.clone(), file.quality, file.background);
        Ok(World { scene, objects, camera, quality, shadow: file.shadow, background, shown })
    }

    /// Adds the object of an entry, with its instances.
    async fn add(
        &self,
        scene: &mut Scene,
        land: Option<ObjectId>,
        entry: usize,
    ) -> Result<WorldObject, Error> {
        let (entry, loaded) = (&self.file.objects[entry], &self.objects[entry]);
        let found = added(scene, entry, loaded).await?;
        self.set_level_of_detail(scene, entry, found.object)?;
        self.spawn(scene, land, entry, &found)?;
        Ok(found)
    }

    /// Sets how an object's levels of detail are chosen, and their transition. If the object's entry names a transition, the
    /// object must support it.
    fn set_level_of_detail(
        &self,
        scene: &mut Scene,
        entry: &ObjectEntry,
        object: ObjectId,
    ) -> Result<(), Error> {
        let named = entry.transition.unwrap_or(self.file.transition);
        let may_morph = entry.transition.is_some() || scene.can_morph(object)?;
        let transition = if named == Transition::Geomorph && !may_morph { Transition::Hard } else { named };
        let level_of_detail = entry.level_of_detail.clone().unwrap_or_default();
        if entry.level_of_detail.is_none() && transition == Transition::Hard {
            return Ok(());
        }
        let level_of_detail = LevelOfDetail { transition, ..level_of_detail };
        // The finer levels of a package may arrive later.
        let set = match entry.package().is_some() {
            true => scene.set_level_of_detail_among(object, &level_of_detail, OBJECT_LEVELS as usize),
            false => scene.set_level_of_detail(object, &level_of_detail),
        };
        set.map_err(|error| match error {
            Error::Input(error) if transition == Transition::Geomorph && error.path == "object.levels" => {
                let path = format!("{}.transition", entry.path);
                InputError::new(path, "geomorph", format!("{} {}", error.path, error.bound)).into()
            }
            Error::Input(error) => in_file(error, &entry.path).into(),
            other => other,
        })
    }

    fn spawn(
        &self,
        scene: &mut Scene,
        land: Option<ObjectId>,
        entry: &ObjectEntry,
        found: &WorldObject,
    ) -> Result<(), Error> {
        for (index, instance) in entry.instances.iter().enumerate() {
            let path = format!("{}.instances[{index}]", entry.path);
            let at = match instance.spot {
                Spot::At(at) => at,
                Spot::On { x, z, lift } => {
                    let Some(height) = height(scene, land, x, z) else {
                        let bound = "must lie on a patch of the terrain";
                        let value = format!("[{x}, {z}]");
                        return Err(InputError::new(format!("{path}.on"), value, bound).into());
                    };
                    DVec3::new(x, height + lift * f64::from(instance.scale.y.abs()), z)
                }
            };
            let turned = Placement { turn: instance.turn, scale: instance.scale, ..Placement::at_world(at) };
            let play = instance.play.as_ref().map(|play| (play, play.start));
            spawn_one(scene, found, turned, play).map_err(|error| below(&path, error))?;
        }
        let Some(scatter) = &entry.scatter else { return Ok(()) };
        let path = format!("{}.scatter", entry.path);
        let rectangles = scatter.area.map_or_else(|| self.patches(), |area| vec![area]);
        let ground = |x: f64, z: f64| if land.is_some() { height(scene, land, x, z) } else { Some(0.0) };
        let all = scatter::drawn(scatter, &rectangles, ground).map_err(|error| error.below(&entry.path))?;
        for Drawn { x, y, z, turn, scale, phase } in all {
            let at = DVec3::new(x, y + scatter.lift * f64::from(scale), z);
            let turned =
                Placement { turn: upright(turn), scale: Vec3::splat(scale), ..Placement::at_world(at) };
            let play = match (&entry.kind, &found.model) {
                (EntryKind::Character(play), Some(model)) => Some((play, begun(play, model, phase)?)),
                _ => None,
            };
            spawn_one(scene, found, turned, play).map_err(|error| below(&path, error))?;
        }
        Ok(())
    }

    /// The smallest and the largest x and z of each patch.
    fn patches(&self) -> Vec<[[f64; 2]; 2]> {
        let patches = self.file.terrain.iter().flat_map(|terrain| {
            let edge = terrain.recipe.config.edge_length();
            terrain.patches.iter().map(move |patch| {
                let low = patch.map(|index| f64::from(index) * edge);
                [low, low.map(|start| start + edge)]
            })
        });
        patches.collect()
    }
}

impl World {
    /// Shows a package that was given to `loaded` ([`LoadedScene::set_package`]): adds its objects with their instances, or
    /// gives the objects the new model ([`Scene::set_model`]). Then renderers must be prepared again.
    ///
    /// # Errors
    /// Same as [`LoadedScene::build_async`].
    pub async fn show_package_async(&mut self, loaded: &LoadedScene, package: &Path) -> Result<(), Error> {
        let is_land = |object: &&WorldObject| object.kind == WorldKind::Terrain;
        let land = self.objects.iter().find(is_land).map(|object| object.object);
        for at in loaded.file.of_package(package) {
            let Loaded::Model(model) = &loaded.objects[at] else { continue };
            let entry = &loaded.file.objects[at];
            let Some(shown) = self.shown[at] else {
                let found = loaded.add(&mut self.scene, land, at).await?;
                self.shown[at] = Some(self.objects.len());
                self.objects.push(found);
                continue;
            };
            let found = &mut self.objects[shown];
            match &entry.kind {
                EntryKind::Character(_) => {
                    self.scene.set_character_model(found.object, model, &entry.detail.options())
                }
                _ => self.scene.set_model(found.object, model),
            }
            .map_err(|error| below(&entry.path, error))?;
            found.model = Some(model.clone());
            let object = found.object;
            loaded.set_level_of_detail(&mut self.scene, entry, object)?;
        }
        self.scene.gpu().check_async().await?;
        Ok(())
    }
}

/// Start time of a clip in seconds. With this start time, the fraction `phase` of the clip has been played at the time
/// `play.start`.
fn begun(play: &PlayEntry, model: &Model, phase: f64) -> Result<f64, InputError> {
    let clip = model.clip(play.clip.as_deref().unwrap_or("0"))?;
    let rate = if play.rate == 0.0 { 1.0 } else { f64::from(play.rate) };
    Ok(play.start - phase * f64::from(clip.duration()) / rate.abs())
}

fn height(scene: &Scene, land: Option<ObjectId>, x: f64, z: f64) -> Option<f64> {
    Some(scene.ground(land?, x, z).ok()??.height)
}

/// Adds an object with capacity for its instances.
async fn added(scene: &mut Scene, entry: &ObjectEntry, loaded: &Loaded) -> Result<WorldObject, Error> {
    let capacity = entry.count();
    let (kind, object) = match (loaded, &entry.kind) {
        (Loaded::Relief(relief), _) => (WorldKind::Relief, scene.add_relief_async(relief, capacity).await),
        (Loaded::Model(model), EntryKind::Character(_)) => {
            let options = entry.detail.options();
            (WorldKind::Character, scene.add_character_with_async(model, capacity, &options).await)
        }
        (Loaded::Model(model), _) => (WorldKind::Mesh, scene.add_mesh_async(model, capacity).await),
        (Loaded::Waiting, _) => {
            return Err(InputError::new(&entry.path, "not loaded", "must have its package").into());
        }
    };
    let model = match loaded {
        Loaded::Model(model) => Some(model.clone()),
        Loaded::Relief(_) | Loaded::Waiting => None,
    };
    // The fields of options are fields of the entry.
    let in_entry = |error: Error| match error {
        Error::Input(error) => {
            let path = error.path.strip_prefix("options.").unwrap_or(&error.path).to_owned();
            Error::Input(InputError { path, ..error })
        }
        other => other,
    };
    let object = object.map_err(|error| below(&entry.path, in_entry(error)))?;
    let source = entry.source.to_string();
    let name = entry.name.clone().unwrap_or_else(|| source.clone());
    Ok(WorldObject { object, kind, name, source, model })
}

fn spawn_one(
    scene: &mut Scene,
    found: &WorldObject,
    placement: Placement,
    play: Option<(&PlayEntry, f64)>,
) -> Result<(), Error> {
    let instance = scene.spawn(found.object, placement)?;
    if let Some((PlayEntry { clip, rate, wrap, .. }, start)) = play {
        let clip = clip.as_deref().unwrap_or("0");
        scene.play(instance, &Play { clip, start, rate: *rate, wrap: *wrap })?;
    }
    Ok(())
}

/// An error with the names of fields that JSON has.
fn in_json(error: Error) -> Error {
    match error {
        Error::Input(error) => Error::Input(error.in_json()),
        other => other,
    }
}

/// Prepends a path in the scene file to the path of an input error.
fn below(path: &str, error: Error) -> Error {
    match error {
        Error::Input(error) => Error::Input(error.below(path)),
        other => other,
    }
}

/// Converts the path of an error in level-of-detail settings to a path in the scene file. For example, `criterion.from[0]` of
/// `meshes[1]` becomes `meshes[1].lod.from[0]`.
fn in_file(error: InputError, entry: &str) -> InputError {
    let groups = ["criterion.", "choice.", "perceptual."];
    let path =
        groups.iter().find_map(|group| error.path.strip_prefix(group)).unwrap_or(&error.path).to_owned();
    let parent = if path.starts_with("transition") { entry.to_owned() } else { format!("{entry}.lod") };
    InputError { path, ..error }.below(&parent)
}
