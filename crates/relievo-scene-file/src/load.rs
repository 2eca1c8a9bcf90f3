//! Reads the files that a scene names, and prepares their contents: levels of detail, reliefs, textures.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use image::{DynamicImage, Rgba, RgbaImage};
#[cfg(not(target_arch = "wasm32"))]
use relievo::Error;
use relievo::asset::{Mesh, Model};
use relievo::ops::skinning::{
    Examined, add_levels, add_levels_and_at_rest, at_rest, join_levels_in, sparse_poses_of,
};
use relievo::ops::surface::{Green, HeightMap, ReliefMaterial, ReliefOptions, SurfaceMesh, SurfaceVertex};
use relievo::ops::terrain::config::ZoneTexture;
use relievo::ops::terrain::elevation::{ElevationLayout, ElevationMap, ElevationTiles};
use relievo::ops::terrain::features::{FeatureFile, Features};
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::scene::{Relief, SampleMask, TerrainHole};
use relievo::{BuiltIns, NoBuiltIns};
use relievo::{InputError, srgb};

use super::entries::{
    ElevationEntry, EntryKind, HoleEntry, ModelSource, ObjectEntry, PlayEntry, ReliefEntry, Source,
    TerrainEntry,
};
use super::spec::SceneFile;

/// A scene file with the contents of all files that it names. A [`World`](super::World) can be built from it any number of times.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    pub(super) file: SceneFile,
    /// The loaded model or relief of each object.
    pub(super) objects: Vec<Loaded>,
    /// The textures of the terrain's zones.
    pub(super) textures: Vec<TerrainTexture>,
    /// The holes of endless terrain; `None` for terrain that has none and gets none.
    pub(super) holes: Option<Vec<TerrainHole>>,
    /// The elevation map of endless terrain.
    pub(super) elevation: Option<Arc<ElevationTiles>>,
    /// The injected heights of the terrain.
    pub(super) features: Features,
}

/// The loaded model or relief of an object.
#[derive(Debug, Clone)]
pub(super) enum Loaded {
    /// A model with levels of detail.
    Model(Arc<Model>),
    Relief(Box<Relief>),
    /// The package is not there yet.
    Waiting,
}

impl LoadedScene {
    /// The checked contents of the scene file.
    pub fn file(&self) -> &SceneFile {
        &self.file
    }

    /// Gives the objects of a package their model, with the levels of detail that are there. `package` is the path in the scene file.
    /// [`World::show_package_async`](super::World::show_package_async) shows it.
    ///
    /// # Errors
    /// [`InputError`] with the path of the name in the scene file, in these cases: no object has this package; the model does not
    /// suit an object's use; it does not have a clip.
    pub fn set_package(&mut self, package: &Path, model: Model) -> Result<(), InputError> {
        let entries = self.file.of_package(package);
        if entries.is_empty() {
            return Err(InputError::new("package", package.display(), "must be the file of an object"));
        }
        let nothing = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let mut files = Files::new(&nothing, &NoBuiltIns);
        files.models.insert(Source::File(package.to_owned()), vec![Arc::new(model)]);
        let own: Vec<ObjectEntry> = entries.iter().map(|at| self.file.objects[*at].clone()).collect();
        for (at, loaded) in entries.into_iter().zip(files.objects(&own)?) {
            self.objects[at] = loaded;
        }
        Ok(())
    }

    /// Reads a scene file, and the files that it names, from the file system. Names with the prefix `builtin:` come from
    /// `built_ins`.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read; [`Error::InputFile`] with the path of a mistake inside the file.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn from_path(path: &Path, built_ins: &dyn BuiltIns) -> Result<Self, Error> {
        let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let read = |name: &Path| std::fs::read(folder.join(name));
        let loaded = SceneFile::from_json(&text).and_then(|file| file.load(&read, built_ins));
        loaded.map_err(|source| Error::InputFile { path: path.to_owned(), source })
    }
}

impl SceneFile {
    /// Reads the files that the scene names through `read`, and computes levels of detail.
    ///
    /// `read` gets paths relative to the scene file. Names with the prefix `builtin:` come from `built_ins`;
    /// [`NoBuiltIns`] has none. Levels are computed for all meshes and characters. For characters, they fit
    /// the clips that the characters play, at 15 poses a second and at most 48 poses per clip. A model that several objects show
    /// is read and simplified only once, for the clips of all these objects. A package (`.rlv`) keeps its own levels. Levels that
    /// an artist made are joined instead ([`join_levels`](relievo::ops::skinning::join_levels)); their errors are measured in the
    /// same poses.
    ///
    /// # Errors
    /// [`InputError`] with the path of the name in the scene file, in these cases: a file cannot be read or understood; a file
    /// does not suit its use; a model does not have a clip.
    pub fn load(
        &self,
        read: &dyn Fn(&Path) -> std::io::Result<Vec<u8>>,
        built_ins: &dyn BuiltIns,
    ) -> Result<LoadedScene, InputError> {
        self.load_with(Files::new(read, built_ins))
    }

    /// Like [`SceneFile::load`], but does not read packages (`.rlv`). Their objects are missing until
    /// [`LoadedScene::set_package`]. Packages that carry reliefs are read, as reliefs do not change later.
    ///
    /// # Errors
    /// As for [`SceneFile::load`].
    pub fn load_without_packages(
        &self,
        read: &dyn Fn(&Path) -> std::io::Result<Vec<u8>>,
        built_ins: &dyn BuiltIns,
    ) -> Result<LoadedScene, InputError> {
        self.load_with(Files { leaves_packages: true, ..Files::new(read, built_ins) })
    }

    /// Paths of the packages whose objects [`SceneFile::load_without_packages`] leaves out, ascending.
    pub fn packages(&self) -> Vec<PathBuf> {
        let paths = self.objects.iter().filter_map(ObjectEntry::package);
        paths.map(Path::to_owned).collect::<BTreeSet<_>>().into_iter().collect()
    }

    /// The `name` of the first object of a package that has one.
    pub fn package_name(&self, package: &Path) -> Option<&str> {
        self.of_package(package).into_iter().find_map(|at| self.objects[at].name.as_deref())
    }

    /// Indices of the objects of a package.
    pub(super) fn of_package(&self, package: &Path) -> Vec<usize> {
        let entries = self.objects.iter().enumerate();
        entries.filter(|(_, entry)| entry.package() == Some(package)).map(|(at, _)| at).collect()
    }

    fn load_with(&self, mut files: Files<'_>) -> Result<LoadedScene, InputError> {
        let zones = self.terrain.iter().flat_map(|terrain| &terrain.recipe.config.zones).enumerate();
        let texture =
            |(index, zone): (usize, &relievo::ops::terrain::config::Zone)| match zone.texture_at(index) {
                ZoneTexture::BuiltIn(kind) => Ok(TerrainTexture::built_in(kind)),
                ZoneTexture::File(path) => {
                    let at = format!("terrain.config.zones[{index}].texture");
                    Ok(TerrainTexture::from_image(&files.decoded(&at, &path)?))
                }
            };
        let textures = zones.map(texture).collect::<Result<_, InputError>>()?;
        let elevation = self.terrain.as_ref().map(|terrain| files.elevation(terrain)).transpose()?.flatten();
        let features = self.terrain.as_ref().map(|terrain| files.features(terrain)).transpose()?;
        let features = features.unwrap_or_default();
        let holes = self.terrain.as_ref().map(|terrain| files.holes(terrain)).transpose()?.flatten();
        let objects = files.objects(&self.objects)?;
        Ok(LoadedScene { file: self.clone(), objects, textures, holes, elevation, features })
    }
}

/// Reader of files, and the models that were read so far. Each model is read once.
struct Files<'a> {
    read: &'a dyn Fn(&Path) -> std::io::Result<Vec<u8>>,
    built_ins: &'a dyn BuiltIns,
    /// Whether the objects of packages are left out.
    leaves_packages: bool,
    /// The levels of detail that each source has, the finest first; at least one.
    models: HashMap<Source, Vec<Arc<Model>>>,
    needs: HashMap<ModelSource, Needs>,
    levelled: HashMap<ModelSource, Levelled>,
}

/// A model with levels of detail, shared by all objects that show the model.
#[derive(Clone)]
struct Levelled {
    model: Arc<Model>,
    /// The model at rest, with the same vertices, triangles and levels. `None` if no object shows the model at rest.
    resting: Option<Arc<Model>>,
}

/// How meshes and characters use a model. Its levels of detail are computed for these uses.
#[derive(Default)]
struct Needs {
    /// The clips that characters play.
    clips: BTreeSet<usize>,
    /// Whether an object shows the model at rest.
    is_at_rest: bool,
}

impl<'a> Files<'a> {
    fn new(read: &'a dyn Fn(&Path) -> std::io::Result<Vec<u8>>, built_ins: &'a dyn BuiltIns) -> Self {
        let (models, needs, levelled) = Default::default();
        Self { read, built_ins, leaves_packages: false, models, needs, levelled }
    }

    /// The elevation map of a terrain.
    fn elevation(&self, terrain: &TerrainEntry) -> Result<Option<Arc<ElevationTiles>>, InputError> {
        let Some(entry) = &terrain.elevation else { return Ok(None) };
        let image = self.decoded("terrain.elevation.file", &entry.file)?;
        let map = ElevationMap::of_brightness(image, entry.range);
        let ElevationEntry { first, spacing, margin, .. } = *entry;
        let layout = ElevationLayout { first, spacing, ..map.layout };
        let tiles = ElevationTiles::new(&terrain.recipe.config, &ElevationMap { layout, margin, ..map });
        Ok(Some(Arc::new(tiles.map_err(|error| error.below("terrain.elevation"))?)))
    }

    /// The holes of a terrain.
    fn holes(&self, terrain: &TerrainEntry) -> Result<Option<Vec<TerrainHole>>, InputError> {
        let hole = |(index, entry): (usize, &HoleEntry)| match entry {
            HoleEntry::Circle(hole) => Ok(hole.clone()),
            HoleEntry::Image { file, first } => {
                let path = format!("terrain.holes[{index}].image");
                let image = self.decoded(&path, file)?.into_luma8();
                let is_hole: Vec<bool> = image.iter().map(|brightness| *brightness < 128).collect();
                let mask = SampleMask::new(*first, [image.width(), image.height()], &is_hole);
                Ok(TerrainHole::Samples(mask.map_err(|error| error.below(&path))?))
            }
        };
        let holes = terrain.holes.as_ref();
        holes.map(|holes| holes.iter().enumerate().map(hole).collect()).transpose()
    }

    /// The injected heights of a terrain.
    fn features(&self, terrain: &TerrainEntry) -> Result<Features, InputError> {
        let config = &terrain.recipe.config;
        let mut features = Features::new(config, &[], terrain.feature_mode)?;
        for (index, file) in terrain.features.iter().enumerate() {
            let path = format!("terrain.features[{index}]");
            let bytes = self.bytes(&path, file)?;
            let text = str::from_utf8(&bytes)
                .map_err(|error| InputError::new(&path, file.display(), format!("must be text: {error}")))?;
            let added = FeatureFile::from_json(text)
                .and_then(|points| features.add(config, &points))
                .and_then(|()| features.check(config));
            added.map_err(|error| InputError::new(&path, file.display(), error.in_json().to_string()))?;
        }
        Ok(features)
    }

    fn objects(&mut self, entries: &[ObjectEntry]) -> Result<Vec<Loaded>, InputError> {
        let leaves_packages = self.leaves_packages;
        let is_left = |entry: &ObjectEntry| leaves_packages && entry.package().is_some();
        entries.iter().filter(|entry| !is_left(entry)).try_for_each(|entry| self.add_needs(entry))?;
        let object = |entry| if is_left(entry) { Ok(Loaded::Waiting) } else { self.object(entry) };
        entries.iter().map(object).collect()
    }

    /// Reads an object's model, and records the object's use of it.
    fn add_needs(&mut self, entry: &ObjectEntry) -> Result<(), InputError> {
        let models = self.models(entry)?;
        let is_empty = |model: &Arc<Model>| model.meshes.iter().all(|mesh| mesh.indices.is_empty());
        let refused = |level: usize, bound: &str| {
            InputError::new(entry.source.path(&entry.path, level), entry.source.name(level), bound)
        };
        if let Some(level) = models.iter().position(is_empty) {
            return Err(refused(level, "must have a mesh with triangles"));
        }
        let model = &models[0];
        match &entry.kind {
            EntryKind::Relief(_) => {}
            EntryKind::Mesh => self.needs.entry(entry.source.clone()).or_default().is_at_rest = true,
            EntryKind::Character(play) => {
                if model.clips.is_empty() {
                    return Err(refused(0, "must have clips: list a model without among meshes"));
                }
                let clips = played(entry, play, model)?;
                self.needs.entry(entry.source.clone()).or_default().clips.extend(clips);
            }
        }
        Ok(())
    }

    fn object(&mut self, entry: &ObjectEntry) -> Result<Loaded, InputError> {
        let within = |error: InputError| in_levels(entry, &error);
        match &entry.kind {
            EntryKind::Relief(relief) => {
                let rest = at_rest(&self.models(entry)?[0]).map_err(within)?;
                Ok(Loaded::Relief(Box::new(self.relief(entry, relief, &rest)?)))
            }
            EntryKind::Mesh | EntryKind::Character(_) => {
                let Levelled { model, resting } = self.levelled(entry).map_err(within)?;
                let resting = resting.filter(|_| entry.kind == EntryKind::Mesh);
                Ok(Loaded::Model(resting.unwrap_or(model)))
            }
        }
    }

    /// The levels of detail that the source of an entry has, the finest first; at least one.
    fn models(&mut self, entry: &ObjectEntry) -> Result<Vec<Arc<Model>>, InputError> {
        let levels = match &entry.source {
            ModelSource::One(one) => return self.models_of(&entry.source.path(&entry.path, 0), one),
            ModelSource::Levels(levels) => levels,
        };
        let finest = |(at, source): (usize, &Source)| {
            let own = self.models_of(&entry.source.path(&entry.path, at), source)?;
            Ok(own[0].clone())
        };
        levels.iter().enumerate().map(finest).collect()
    }

    /// The levels of detail in a file. `path` is the path of the file's name in the scene file.
    fn models_of(&mut self, path: &str, source: &Source) -> Result<Vec<Arc<Model>>, InputError> {
        if let Some(known) = self.models.get(source) {
            return Ok(known.clone());
        }
        let models = match source {
            Source::BuiltIn(name) => self.built_ins.model(name).map(|model| vec![model]),
            Source::File(file) => {
                let bytes = self.bytes(path, file)?;
                let folder = file.parent().unwrap_or(Path::new(""));
                Model::levels_from_bytes_beside(file, &bytes, &|name| (self.read)(&folder.join(name)))
            }
        };
        let models = models.map_err(|error| within(path, source, &error))?;
        let models: Vec<_> = models.into_iter().map(Arc::new).collect();
        self.models.insert(source.clone(), models.clone());
        Ok(models)
    }

    fn bytes(&self, path: &str, file: &Path) -> Result<Vec<u8>, InputError> {
        (self.read)(file)
            .map_err(|error| InputError::new(path, file.display(), format!("cannot be read: {error}")))
    }

    fn levelled(&mut self, entry: &ObjectEntry) -> Result<Levelled, InputError> {
        let source = &entry.source;
        if let Some(known) = self.levelled.get(source) {
            return Ok(known.clone());
        }
        let models = self.models(entry)?;
        let Needs { clips, is_at_rest } = self.needs.remove(source).unwrap_or_default();
        let clips: Vec<usize> = clips.into_iter().collect();
        let own = levelled(&models, &clips, is_at_rest)?;
        let mut resting = None;
        if is_at_rest {
            let mut rest = at_rest(&own)?;
            for (mesh, from) in rest.meshes.iter_mut().zip(&own.meshes) {
                mesh.levels.clone_from(&from.levels);
                mesh.partners.clone_from(&from.partners);
            }
            resting = Some(Arc::new(rest));
        }
        let own = Levelled { model: Arc::new(own), resting };
        self.levelled.insert(source.clone(), own.clone());
        Ok(own)
    }

    fn relief(&self, entry: &ObjectEntry, relief: &ReliefEntry, rest: &Model) -> Result<Relief, InputError> {
        let at = |field: &str| format!("{}.material.{field}", entry.path);
        let mesh = surface_mesh(rest, relief.tiles);
        let has_area = mesh.vertices.iter().any(|vertex| vertex.uv != mesh.vertices[0].uv);
        if !has_area {
            let bound = "must have texture coordinates, which a relief follows";
            return Err(InputError::new(format!("{}.file", entry.path), &entry.source, bound));
        }
        let (heights, own) = self.heights(&at("relief"), relief)?;
        let albedo = match &relief.albedo {
            Some(source) => self.colors(&at("albedo"), source)?,
            None => own.map_or_else(|| base_color(rest), Ok)?,
        };
        let normals = relief.normals.as_ref().map(|source| self.colors(&at("normal"), source)).transpose()?;
        let made = Relief::new(mesh, heights, albedo);
        let made = match normals {
            Some(normals) => made.with_normals(normals, Green::Up),
            None => made,
        };
        let options = ReliefOptions { method: relief.method, shadow: relief.shadow, ..made.options };
        let material = ReliefMaterial { scale: relief.scale, ..made.material };
        let double_sided = rest.meshes.iter().any(|mesh| mesh.double_sided);
        Ok(Relief { options, material, double_sided, ..made })
    }

    /// The heights of a relief, and the colours in the same file or built-in map, if there are any.
    fn heights(
        &self,
        path: &str,
        relief: &ReliefEntry,
    ) -> Result<(HeightMap, Option<RgbaImage>), InputError> {
        let within = |error: InputError| within(path, &relief.heights, &error);
        match &relief.heights {
            Source::BuiltIn(name) => {
                let found = self.built_ins.map(name).map_err(within);
                found.map(|(heights, colors)| (heights, Some(colors)))
            }
            Source::File(file) => {
                let image = self.decoded(path, file)?;
                if relief.is_alpha {
                    let heights = HeightMap::of_alpha(&image).map_err(within)?;
                    let mut colors = image.into_rgba8();
                    colors.pixels_mut().for_each(|texel| texel.0[3] = u8::MAX);
                    return Ok((heights, Some(colors)));
                }
                Ok((HeightMap::of_brightness(image).map_err(within)?, None))
            }
        }
    }

    fn colors(&self, path: &str, source: &Source) -> Result<RgbaImage, InputError> {
        match source {
            Source::BuiltIn(name) => {
                let found = self.built_ins.map(name).map_err(|error| within(path, source, &error));
                found.map(|(_, colors)| colors)
            }
            Source::File(file) => Ok(self.decoded(path, file)?.into_rgba8()),
        }
    }

    fn decoded(&self, path: &str, file: &Path) -> Result<DynamicImage, InputError> {
        let bytes = self.bytes(path, file)?;
        relievo::ops::surface::map::decode(&bytes).map_err(|error| {
            InputError::new(path, file.display(), format!("must be a whole PNG or JPEG: {error}"))
        })
    }
}

/// One model of the levels of detail that an artist made, or the only model with levels. The errors of levels fit the clips
/// and, if an object shows it, the rest pose.
fn levelled(models: &[Arc<Model>], clips: &[usize], is_at_rest: bool) -> Result<Model, InputError> {
    if models.len() > 1 {
        let models: Vec<Model> = models.iter().map(|model| Model::clone(model)).collect();
        return join_levels_in(&models, &Examined { clips, poses: sparse_poses_of, is_at_rest });
    }
    let mut own = Model::clone(&models[0]);
    // The levels of a package fit all clips and the rest pose.
    if own.meshes.iter().any(|mesh| !mesh.levels.is_empty()) {
        return Ok(own);
    }
    let poses = clips.iter().map(|clip| sparse_poses_of(&own.clips[*clip])).collect::<Result<Vec<_>, _>>()?;
    let poses = poses.into_iter().max().unwrap_or(1);
    match is_at_rest {
        true => add_levels_and_at_rest(&mut own, clips, poses)?,
        false => add_levels(&mut own, clips, poses)?,
    };
    Ok(own)
}

/// Reports a mistake in the levels of an entry. If the path of the error begins with a model (`models[1].skins[0]`), the
/// reported path leads to the name of this model in the scene file.
fn in_levels(entry: &ObjectEntry, error: &InputError) -> InputError {
    let of_model = error.path.strip_prefix("models[").and_then(|rest| rest.split_once("]."));
    let level = of_model.and_then(|(level, path)| Some((level.parse().ok()?, path)));
    match (level, &entry.source) {
        (Some((level, path)), ModelSource::Levels(_)) => {
            let inner = InputError { path: path.to_owned(), ..error.clone() };
            within(&entry.source.path(&entry.path, level), entry.source.name(level), &inner)
        }
        (None, ModelSource::Levels(_)) => {
            InputError::new(format!("{}.levels", entry.path), &entry.source, error.to_string())
        }
        (_, ModelSource::One(one)) => within(&entry.source.path(&entry.path, 0), one, error),
    }
}

/// Reports a mistake inside a file. The path of the error leads to the file's name in the scene file.
fn within(path: &str, source: &Source, error: &InputError) -> InputError {
    InputError::new(path, source, error.to_string())
}

/// The clips that a character and its instances play, ascending, without duplicates.
fn played(entry: &ObjectEntry, all: &PlayEntry, model: &Model) -> Result<Vec<usize>, InputError> {
    let index = |path: String, play: &PlayEntry| {
        let name = play.clip.as_deref().unwrap_or("0");
        let clip = model.clip(name).map_err(|error| InputError { path, ..error })?;
        Ok(model.clips.iter().position(|other| std::ptr::eq(other, clip)).unwrap_or(0))
    };
    let mut clips = vec![index(format!("{}.clip", entry.path), all)?];
    for (at, instance) in entry.instances.iter().enumerate() {
        if let Some(play) = &instance.play {
            clips.push(index(format!("{}.instances[{at}].clip", entry.path), play)?);
        }
    }
    clips.sort_unstable();
    clips.dedup();
    Ok(clips)
}

/// Merges all meshes of a model at rest. The texture coordinates are multiplied by `tiles`.
fn surface_mesh(rest: &Model, tiles: f32) -> SurfaceMesh {
    let mut all = SurfaceMesh { vertices: Vec::new(), indices: Vec::new() };
    for mesh in &rest.meshes {
        let first = all.vertices.len() as u32;
        all.indices.extend(mesh.indices.iter().map(|vertex| first + vertex));
        all.vertices.extend((0..mesh.vertices()).map(|at| surface_vertex(mesh, at, tiles)));
    }
    all
}

fn surface_vertex(mesh: &Mesh, at: usize, tiles: f32) -> SurfaceVertex {
    SurfaceVertex {
        position: mesh.positions[at],
        normal: mesh.normals[at],
        tangent: mesh.tangents[at],
        uv: mesh.uv[at].map(|coordinate| tiles * coordinate),
    }
}

/// The image of a model's first material, or one texel of its colour; white without materials.
fn base_color(model: &Model) -> Result<RgbaImage, InputError> {
    let material = model.meshes.iter().find_map(|mesh| model.material(mesh).ok().flatten());
    let color = material.map_or([1.0; 4], |material| material.color);
    let image = material.and_then(|material| model.images.get(material.texture?.image));
    let Some(image) = image else {
        let [red, green, blue] = [0, 1, 2].map(|channel: usize| srgb::byte(color[channel]));
        return Ok(RgbaImage::from_pixel(1, 1, Rgba([red, green, blue, u8::MAX])));
    };
    image.texels().cloned()
}

#[cfg(test)]
mod tests {
    use image::ExtendedColorType;
    use relievo::asset::encode_png;

    use super::*;
    use crate::NoBuiltIns;
    use relievo_samples::Samples;

    fn scene(entry: &str) -> Result<SceneFile, InputError> {
        SceneFile::from_json(&format!(r#"{{{entry}, "camera": {{"at": [0, 2, 9], "look": [0, 1, 0]}}}}"#))
    }

    /// The error of an entry with an instance, from files that are read by `read`.
    fn refused(list: &str, fields: &str, read: &dyn Fn(&Path) -> std::io::Result<Vec<u8>>) -> InputError {
        let entry = format!(r#""{list}": [{{{fields}, "instances": [{{"at": [0, 0, 0]}}]}}]"#);
        let loaded = scene(&entry).and_then(|file| file.load(read, &Samples).map(|_| ()));
        loaded.expect_err(fields)
    }

    /// Files by name: the rock and the creature as binary glTF.
    fn files(name: &Path) -> std::io::Result<Vec<u8>> {
        let model = match name.to_str() {
            Some("rock.glb") => relievo_samples::rock(),
            Some("creature.glb") => relievo_samples::creature(),
            _ => return Err(std::io::ErrorKind::NotFound.into()),
        };
        model.and_then(|model| model.to_glb()).map_err(std::io::Error::other)
    }

    /// Levels that an artist made: their names are listed, and an object has a level for each.
    #[test]
    fn levels_have_a_model_each() {
        let file = scene(
            r#""meshes": [
                {"levels": ["rock.glb", "builtin:wall", "builtin:rock"], "instances": [{"at": [0, 0, 0]}]},
                {"file": "builtin:rock", "instances": [{"at": [3, 0, 0]}]},
                {"levels": ["creature.glb", "builtin:creature"], "instances": [{"at": [6, 0, 0]}]}
            ],
            "characters": [
                {"levels": ["creature.glb", "builtin:creature"], "instances": [{"at": [9, 0, 0]}]}
            ]"#,
        );
        let file = file.expect("a scene");
        assert_eq!(file.files(), [Path::new("creature.glb"), Path::new("rock.glb")]);
        let loaded = file.load(&files, &Samples).expect("loaded");
        let models = loaded.objects.iter().map(|object| match object {
            Loaded::Model(model) => model.clone(),
            Loaded::Relief(_) | Loaded::Waiting => unreachable!("there is none"),
        });
        let models: Vec<Arc<Model>> = models.collect();
        let errors =
            |model: &Model| model.meshes[0].levels.iter().map(|level| level.error).collect::<Vec<_>>();
        let shown = |model: &Model| {
            let at =
                |level: u32| model.meshes.iter().map(|mesh| mesh.triangles(level).len()).sum::<usize>() / 3;
            (0..=model.meshes[0].levels.len() as u32).map(at).collect::<Vec<_>>()
        };
        let [rock, wall, creature] = ["rock", "wall", "creature"].map(|name| {
            let model = Samples.model(name).expect("a built-in model");
            model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum::<usize>()
        });
        assert_eq!(shown(&models[0]), [rock, wall, rock]);
        let found = errors(&models[0]);
        // The third level is the rock again, so it takes the place of the wall.
        assert!(found[0] > 0.1 && found[1] == found[0].next_up(), "{found:?}");
        assert_eq!(file.objects[0].source.to_string(), "rock.glb, builtin:wall, builtin:rock");
        // The same model as a mesh, at rest, and as a character.
        assert!(models[2].clips.is_empty() && !models[3].clips.is_empty());
        assert_eq!(errors(&models[2]), errors(&models[3]));
        assert_eq!((shown(&models[2]), shown(&models[3])), (vec![creature; 2], vec![creature; 2]));
    }

    /// Files of terrain: an elevation map, and injected heights.
    #[test]
    fn terrain_has_maps_and_injected_heights() {
        let read = |name: &Path| match name.to_str() {
            Some("map.png") => {
                let texels = (0..9).flat_map(|y| (0..12).map(move |x| x * 5_000 + y));
                let texels: Vec<u8> = texels.flat_map(u16::to_ne_bytes).collect();
                encode_png([12, 9], &texels, ExtendedColorType::L16).map_err(std::io::Error::other)
            }
            Some("road.json") => {
                Ok(br#"{"patchCoordinates": [1, 0], "precomputedHeights": [3, 4, 2.5, 5, 6, -1]}"#.to_vec())
            }
            Some("bad.json") => Ok(br#"{"patchCoordinates": [1, 0], "precomputedHeights": [3, 4]}"#.to_vec()),
            _ => Err(std::io::ErrorKind::NotFound.into()),
        };
        let loaded = |terrain: &str| {
            let config = r#""config": {"patchSize": 65, "scaleFactor": 9, "seed": "s", "coarseLevels": 2}"#;
            let file = scene(&format!(r#""terrain": {{{config}, {terrain}}}"#))?;
            let files = file.files();
            Ok::<_, InputError>((file.load(&read, &NoBuiltIns)?, files))
        };
        let map = r#""elevation": {"file": "map.png", "range": [-5, 25], "first": [-3, 2], "spacing": 4, "margin": 1}"#;
        let (scene, files) = loaded(&format!(r#""endless": true, {map}"#)).expect("loaded");
        assert_eq!(files, [Path::new("map.png")]);
        let info = relievo::ops::terrain::elevation::ElevationSource::info(&*scene.elevation.expect("a map"));
        assert_eq!(info.layout, ElevationLayout { spacing: 4, first: [-3, 2], size: [12, 9] });
        let holes = r#""endless": true, "holes": [{"at": [1, 2], "radius": 3}, {"image": "map.png", "first": [-2, 5]}]"#;
        let (scene, files) = loaded(holes).expect("holes");
        assert_eq!(files, [Path::new("map.png")]);
        // The brightness is 5000 / 65535 more in each column.
        let is_hole: Vec<bool> = (0..9 * 12).map(|at| at % 12 < 7).collect();
        let mask = SampleMask::new([-2, 5], [12, 9], &is_hole).expect("valid");
        let circle = TerrainHole::Circle { at: [1.0, 2.0], radius: 3.0 };
        assert_eq!(scene.holes, Some(vec![circle, TerrainHole::Samples(mask)]));
        for terrain in [r#""features": ["road.json"]"#, r#""endless": true, "features": ["road.json"]"#] {
            let (scene, files) = loaded(&format!(r#"{terrain}, "featureMode": "additive""#)).expect("loaded");
            assert_eq!((scene.features.len(), files), (2, vec![Path::new("road.json").to_path_buf()]));
        }
        let refused = |terrain: &str| loaded(terrain).map(|_| ()).expect_err(terrain).to_string();
        let error = refused(r#""features": ["road.json", "bad.json"]"#);
        assert!(error.starts_with("terrain.features[1] = bad.json: precomputedHeights"), "{error}");
        let error = refused(&format!(r#""endless": true, {}"#, map.replace("1}", "5}")));
        assert!(error.starts_with("terrain.elevation.margin = 5"), "{error}");
    }

    #[test]
    fn mistakes_in_levels_are_refused_with_their_place() {
        let none = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let refused_with = |list: &str, fields: &str, path: &str, words: &str| {
            let found = refused(list, fields, &files);
            assert!(found.path == path && found.to_string().contains(words), "{found}");
        };
        let meshes = |fields: &str, path: &str, words: &str| refused_with("meshes", fields, path, words);
        let characters =
            |fields: &str, path: &str, words: &str| refused_with("characters", fields, path, words);
        meshes(r#""clip": 0"#, "meshes[0].clip", "levels");
        meshes(r#""transition": "hard""#, "meshes[0].file", "levels in its place");
        meshes(r#""levels": "rock.glb""#, "meshes[0].levels", "must be a list");
        meshes(r#""levels": ["rock.glb"]"#, "meshes[0].levels.len", "2..=8");
        let nine = format!(r#""levels": [{}]"#, [r#""rock.glb""#; 9].join(", "));
        meshes(&nine, "meshes[0].levels.len", "2..=8");
        meshes(r#""levels": ["rock.glb", 3]"#, "meshes[0].levels[1]", "= 3");
        meshes(r#""levels": ["rock.glb", "rock.png"]"#, "meshes[0].levels[1]", ".glb, .gltf, .obj or .rlv");
        meshes(r#""levels": ["rock.glb", "gone.glb"]"#, "meshes[0].levels[1]", "cannot be read");
        meshes(r#""levels": ["rock.glb", "builtin:cow"]"#, "meshes[0].levels[1]", "creature, rock, wall");
        let both = r#""file": "rock.glb", "levels": ["rock.glb", "rock.glb"]"#;
        meshes(both, "meshes[0].levels", "must not be given beside file");
        let relief = r#""levels": ["rock.glb", "rock.glb"], "material": {"relief": "builtin:bricks"}"#;
        meshes(relief, "meshes[0].levels", "must not be given beside material");
        let moving = r#""levels": ["rock.glb", "creature.glb"]"#;
        meshes(moving, "meshes[0].levels[1]", "clips.len = ");
        characters(r#""levels": ["creature.glb", "rock.glb"]"#, "characters[0].levels[1]", "skinned = 0");
        characters(r#""levels": ["rock.glb", "rock.glb"]"#, "characters[0].levels[0]", "must have clips");
        let found = refused("meshes", r#""levels": ["rock.glb", "rock.glb"]"#, &none);
        assert_eq!((&*found.path, &*found.value), ("meshes[0].levels[0]", "rock.glb"));
    }

    /// A file whose nodes have levels (`MSFT_lod`) is shown with these.
    #[test]
    fn files_have_levels_of_their_own() {
        let document = |ids: &str| {
            let mut near = relievo_samples::rock().expect("valid");
            let mut far = Samples.model("wall").expect("valid").meshes.remove(0);
            (far.skin, far.material) = (near.meshes[0].skin, near.meshes[0].material);
            (near.meshes[0].name, far.name) = ("near_0".to_owned(), "far_0".to_owned());
            near.meshes.push(far);
            let glb = near.to_glb().expect("written");
            let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
            let mut json: serde_json::Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
            let nodes = json["nodes"].as_array_mut().expect("a list");
            let at = |name: &str| nodes.iter().position(|node| node["name"] == name).expect("a node");
            let (near, far) = (at("near"), at("far"));
            nodes
                .iter_mut()
                .filter_map(|node| node["children"].as_array_mut())
                .for_each(|all| all.retain(|node| *node != far));
            let ids: serde_json::Value =
                serde_json::from_str(&ids.replace("far", &far.to_string())).expect("JSON");
            nodes[near]["extensions"] = serde_json::json!({ "MSFT_lod": { "ids": ids } });
            let mut text = serde_json::to_vec(&json).expect("JSON");
            text.resize(text.len().next_multiple_of(4), b' ');
            let mut all = glb[..8].to_vec();
            let rest = &glb[20 + length..];
            all.extend(((20 + text.len() + rest.len()) as u32).to_le_bytes());
            all.extend((text.len() as u32).to_le_bytes());
            all.extend(&glb[16..20]);
            all.extend(text);
            all.extend(rest);
            all
        };
        let file =
            scene(r#""meshes": [{"file": "a.glb", "instances": [{"at": [0, 0, 0]}]}]"#).expect("a scene");
        let loaded = file.load(&|_| Ok(document("[far]")), &Samples).expect("loaded");
        let Loaded::Model(model) = &loaded.objects[0] else { unreachable!("a model") };
        assert_eq!((model.meshes.len(), model.meshes[0].levels.len()), (2, 1));
        let found = refused("meshes", r#""file": "a.glb""#, &|_| Ok(document("[far, 99]")));
        assert_eq!((&*found.path, &*found.value), ("meshes[0].file", "a.glb"));
        assert!(found.bound.contains("extensions.MSFT_lod.ids[1] = 99: must be below"), "{found}");
    }

    /// A model shown by a mesh and by characters with different clips is simplified once, for all of them.
    #[test]
    fn a_model_that_is_named_again_is_simplified_once() {
        let at = |x: u32| format!(r#""instances": [{{"at": [{x}, 0, 0]}}]"#);
        let [a, b, c] = [0, 3, 6].map(at);
        let file = SceneFile::from_json(&format!(
            r#"{{
                "meshes": [{{"file": "builtin:creature", {a}}}],
                "characters": [
                    {{"file": "builtin:creature", "clip": "walk", {b}}},
                    {{"file": "builtin:creature", "clip": "wave", {c}}}
                ],
                "camera": {{"at": [0, 2, 9], "look": [0, 1, 0]}}
            }}"#
        ));
        let file = file.expect("a scene");
        let read = |_: &Path| Err(std::io::ErrorKind::NotFound.into());
        let refused = file.load(&read, &NoBuiltIns).expect_err("nothing is built in").to_string();
        assert!(refused.contains("builtin = creature: must be a file"), "{refused}");
        let mut files = Files::new(&read, &Samples);
        let loaded = files.objects(&file.objects).expect("loaded");
        assert_eq!((loaded.len(), files.levelled.len()), (3, 1));
        let models: Vec<&Arc<Model>> = loaded
            .iter()
            .map(|object| match object {
                Loaded::Model(model) => model,
                Loaded::Relief(_) | Loaded::Waiting => unreachable!("there is none"),
            })
            .collect();
        let moving: Vec<_> = models.iter().filter(|model| !model.clips.is_empty()).collect();
        assert!(moving.len() == 2 && Arc::ptr_eq(moving[0], moving[1]));
        let still = models.iter().find(|model| model.clips.is_empty()).expect("the mesh");
        assert!(still.meshes[0].levels == moving[0].meshes[0].levels);
        assert!(!still.meshes[0].levels.is_empty());
        assert_eq!(still.meshes[0].validate(&still.skins), Ok(()));
    }
}
