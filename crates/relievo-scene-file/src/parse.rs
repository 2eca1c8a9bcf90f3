//! Reads a scene file: terrain, light, camera, quality, and the lists of objects.

use std::path::PathBuf;

use glam::{DVec3, Vec3};
use relievo::InputError;
use relievo::asset::Light;
use relievo::ops::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, TerrainConfig};
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::morph::{Morph, check_target};
use relievo::ops::terrain::recipe::Recipe;
use relievo::scene::{EndlessLimits, GroundRelief, TerrainHole};

use super::camera::{CameraKey, CameraPath, FIELDS_OF_VIEW};
use super::entries::{ElevationEntry, HoleEntry, ObjectEntry, Spot, TerrainEntry};
use super::json::{At, COORDINATE, Fields, Json};
use super::parse_lod::quality;
use super::parse_object::{character, mesh};
use super::spec::{SceneFile, SunOptions};

/// Largest number of entries of `meshes`, and of `characters`.
const MAX_OBJECTS: usize = 256;

/// The largest number of patches of a terrain, and the largest number of heights in all patches together.
const MAX_PATCHES: usize = 4096;
const MAX_HEIGHTS: u64 = 1 << 26;

/// The largest number of keys of a camera's path.
const MAX_KEYS: usize = 4096;

/// The latest time of a camera's key, in seconds.
const MAX_TIME: f64 = 1e6;

/// Default distance of the near plane.
const NEAR: f64 = 0.1;

/// Default vertical field of view, in radians.
const FIELD_OF_VIEW: f64 = 0.8;

/// Default colour of the sky, in linear light.
const BACKGROUND: [f32; 3] = [0.36, 0.55, 0.80];

/// The largest view distance in world units.
const MOST_VIEW: f64 = 1e9;

/// The largest number of files of injected heights.
const MOST_FILES: usize = 4096;

/// The largest column and row of an elevation map.
const MOST_SAMPLE: i64 = i32::MAX as i64;

/// The largest number of holes.
const MOST_HOLES: usize = 1024;

const FIELDS: [&str; 7] = ["terrain", "meshes", "characters", "light", "camera", "quality", "background"];

impl SceneFile {
    /// Reads and checks a scene. The files that it names are read later ([`SceneFile::load`]).
    ///
    /// # Errors
    /// [`InputError`] with the path of the mistake (`characters[1].scatter.count`): text that is not JSON, fields that
    /// are unknown, missing or given twice, and values of the wrong type or out of bounds.
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        let json = Json::parse(text)?;
        let root = json.at();
        let fields = root.fields(&FIELDS)?;
        let objects = |name: &str, read: fn(&At<'_>) -> Result<ObjectEntry, InputError>| {
            let all = fields.maybe(name, |list| list.list(0, MAX_OBJECTS))?.unwrap_or_default();
            all.iter().map(read).collect::<Result<Vec<_>, InputError>>()
        };
        let (sun, shadow) = fields.maybe("light", |at| light(&at))?.unwrap_or_default();
        let (quality, transition) = fields.maybe("quality", |at| quality(&at))?.unwrap_or_default();
        let scene = Self {
            terrain: fields.maybe("terrain", |at| terrain(&at))?,
            objects: [objects("meshes", mesh)?, objects("characters", character)?].concat(),
            light: sun,
            shadow,
            camera: camera(&fields.need("camera", "where the scene is seen from")?)?,
            quality,
            transition,
            background: fields.maybe("background", |at| color(&at, 1.0))?.unwrap_or(BACKGROUND),
        };
        if scene.terrain.is_none() && scene.objects.is_empty() {
            let bound = "must have terrain, meshes or characters";
            return Err(InputError::new("scene", "empty", bound));
        }
        scene.check_grounds()?;
        scene.check_shadow()?;
        Ok(scene)
    }

    /// Checks that the range of the shadow ends beyond the camera's near plane.
    fn check_shadow(&self) -> Result<(), InputError> {
        match self.shadow {
            Some(SunOptions { range, .. }) if f64::from(range) <= 1.001 * self.camera.near => {
                let bound =
                    format!("must be beyond the camera's near = {}, by a thousandth", self.camera.near);
                Err(InputError::new("light.shadow.range", range, bound))
            }
            _ => Ok(()),
        }
    }

    /// Refuses instances on the ground if there is no terrain.
    fn check_grounds(&self) -> Result<(), InputError> {
        let has_patches = self.terrain.as_ref().is_some_and(|terrain| terrain.endless.is_none());
        if has_patches {
            return Ok(());
        }
        for entry in &self.objects {
            if entry.scatter.as_ref().is_some_and(|scatter| scatter.area.is_none()) {
                let why = if self.terrain.is_some() { "terrain is endless" } else { "there is no terrain" };
                let bound = format!("must be given where {why}: the corners [[x, z], [x, z]]");
                return Err(InputError::new(format!("{}.scatter.area", entry.path), "missing", bound));
            }
            if self.terrain.is_some() {
                continue;
            }
            for (index, instance) in entry.instances.iter().enumerate() {
                if let Spot::On { x, z, .. } = instance.spot {
                    let path = format!("{}.instances[{index}].on", entry.path);
                    let bound = "must not be given where there is no terrain: give at";
                    return Err(InputError::new(path, format!("[{x}, {z}]"), bound));
                }
            }
        }
        Ok(())
    }
}

fn terrain(at: &At<'_>) -> Result<TerrainEntry, InputError> {
    let known = [
        "config",
        "patches",
        "target",
        "time",
        "endless",
        "view",
        "erosionDepth",
        "holes",
        "elevation",
        "relief",
        "features",
        "featureMode",
    ];
    let fields = at.fields(&known)?;
    let recipe = terrain_recipe(&fields.need("config", "the configuration of `relievo terrain`")?)?;
    let relief = fields.maybe("relief", |at| relief(&at))?;
    let name = |at: &At<'_>| at.text().map(PathBuf::from);
    let features = fields.maybe("features", |at| at.list(1, MOST_FILES)?.iter().map(name).collect())?;
    let features: Vec<PathBuf> = features.unwrap_or_default();
    let modes = [("keep", FeatureMode::Keep), ("additive", FeatureMode::Additive)];
    let feature_mode = fields.one_of("featureMode", modes, FeatureMode::Keep)?;
    if let Some(limits) = endless(&fields, &recipe.config)? {
        let holes = |at: At<'_>| at.list(0, MOST_HOLES)?.iter().map(hole).collect();
        let holes = fields.maybe("holes", holes)?;
        let elevation = fields.maybe("elevation", |at| elevation(&at))?;
        let (patches, endless) = (Vec::new(), Some(limits));
        let target = target(&fields, &recipe, &patches)?;
        if let (Some(_), Some(given)) = (&target, fields.get("elevation")) {
            return Err(given.error("must not be given beside a target"));
        }
        return Ok(TerrainEntry {
            recipe,
            patches,
            target,
            endless,
            holes,
            elevation,
            relief,
            features,
            feature_mode,
        });
    }
    let patches = match fields.get("patches") {
        Some(list) => list.list(1, MAX_PATCHES)?.iter().map(patch).collect::<Result<Vec<_>, _>>()?,
        None => vec![[0, 0]],
    };
    let path = format!("{}.patches", at.path);
    for (index, patch) in patches.iter().enumerate() {
        let own = || format!("{path}[{index}]");
        if patches[..index].contains(patch) {
            return Err(InputError::new(own(), format!("{patch:?}"), "is listed before"));
        }
        recipe.validate(&[*patch], 1).map_err(|error| InputError { path: own(), ..error })?;
    }
    let heights = patches.len() as u64 * u64::from(recipe.config.patch_size).pow(2);
    if heights > MAX_HEIGHTS {
        let bound = format!("must have at most {MAX_HEIGHTS} heights together, and would have {heights}");
        return Err(InputError::new(format!("{path}.len"), patches.len(), bound));
    }
    let target = target(&fields, &recipe, &patches)?;
    let (endless, holes, elevation) = (None, None, None);
    Ok(TerrainEntry { recipe, patches, target, endless, holes, elevation, relief, features, feature_mode })
}

/// The relief of the ground's textures.
fn relief(at: &At<'_>) -> Result<GroundRelief, InputError> {
    let fields = at.fields(&["depth", "distance"])?;
    let number = |name: &str, what: &str, most: f64| {
        Ok::<_, InputError>(fields.need(name, what)?.number(1e-6, most)? as f32)
    };
    Ok(GroundRelief {
        depth: number("depth", "from the highest to the lowest texel, in world units", 1000.0)?,
        distance: number("distance", "from the eye, where textures become flat", MOST_VIEW)?,
    })
}

fn hole(at: &At<'_>) -> Result<HoleEntry, InputError> {
    let own = at.fields(&["at", "radius", "image", "first"])?;
    if let Some(image) = own.get("image") {
        if let Some(other) = ["at", "radius"].into_iter().find_map(|name| own.get(name)) {
            return Err(other.error("must not be given beside image"));
        }
        return Ok(HoleEntry::Image { file: image.text()?.into(), first: first_sample(&own)? });
    }
    if let Some(first) = own.get("first") {
        return Err(first.error("must be given beside image only"));
    }
    let at = own.need("at", "the middle: x and z; or an image")?.numbers::<2>(-MOST_VIEW, MOST_VIEW)?;
    let radius = own.need("radius", "in world units")?.number(1e-3, MOST_VIEW)?;
    Ok(HoleEntry::Circle(TerrainHole::Circle { at, radius }))
}

/// Column and row of the first pixel of an image.
fn first_sample(fields: &Fields<'_>) -> Result<[i32; 2], InputError> {
    let first = fields.maybe("first", |at| {
        let both = at.list(2, 2)?;
        Ok([both[0].whole(-MOST_SAMPLE, MOST_SAMPLE)?, both[1].whole(-MOST_SAMPLE, MOST_SAMPLE)?])
    })?;
    Ok(first.unwrap_or_default().map(|at| at as i32))
}

fn elevation(at: &At<'_>) -> Result<ElevationEntry, InputError> {
    let fields = at.fields(&["file", "range", "first", "spacing", "margin"])?;
    let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
    let whole = |name: &str, least: i64, most: i64, otherwise: i64| {
        Ok::<_, InputError>(fields.maybe(name, |at| at.whole(least, most))?.unwrap_or(otherwise))
    };
    let range = fields.need("range", "the heights of black and white")?.numbers::<2>(-most, most)?;
    Ok(ElevationEntry {
        file: fields.need("file", "an image of 16-bit grey")?.text()?.into(),
        range: range.map(|height| height as f32),
        first: first_sample(&fields)?,
        spacing: whole("spacing", 1, 1 << 20, 1)? as u32,
        margin: whole("margin", 0, 1 << 20, 0)? as u32,
    })
}

/// The limits of endless terrain; `None` if it is a list of patches.
fn endless(fields: &Fields<'_>, config: &TerrainConfig) -> Result<Option<EndlessLimits>, InputError> {
    let is_endless = fields.maybe("endless", |at| at.flag())?.unwrap_or(false);
    let view_distance = fields.maybe("view", |at| at.number(1e-3, MOST_VIEW))?;
    let erosion_depth = fields.maybe("erosionDepth", |at| at.number(1e-3, 1000.0))?;
    if !is_endless {
        for (name, why) in [
            ("holes", "true, since holes are given"),
            ("elevation", "true, since an elevation map is given"),
            ("erosionDepth", "true, since a depth of erosion is given"),
        ] {
            if fields.get(name).is_some() {
                return Err(fields.missing("endless", why));
            }
        }
        let missing = |_| Err(fields.missing("endless", "true, since a view distance is given"));
        return view_distance.map_or(Ok(None), missing);
    }
    if let Some(given) = fields.get("patches") {
        return Err(given.error("must not be given where terrain is endless"));
    }
    let most = EndlessLimits::farthest(config);
    if let (Some(at), Some(distance)) = (fields.get("view"), view_distance)
        && distance > most
    {
        let bound = format!(
            "must be at most {most}, eight spacings of the base lattice; raise coarseLevels for more"
        );
        return Err(at.error(bound));
    }
    let usual = EndlessLimits::default();
    let erosion_depth = erosion_depth.unwrap_or(usual.erosion_depth);
    Ok(Some(EndlessLimits { view_distance, erosion_depth, ..usual }))
}

fn terrain_recipe(at: &At<'_>) -> Result<Recipe, InputError> {
    if !at.value().is_object() {
        return Err(at.error("must be an object"));
    }
    Recipe::from_value(at.value()).map_err(|error| below(&at.path, "config", error))
}

/// Target heights of a morph that starts from `recipe`; `None` if the field is missing. Without a time, the morph is halfway.
fn target(
    fields: &Fields<'_>,
    recipe: &Recipe,
    patches: &[[i32; 2]],
) -> Result<Option<(Recipe, Morph)>, InputError> {
    let time = fields.maybe("time", |at| at.number(0.0, 1.0))?;
    let Some(at) = fields.get("target") else {
        let missing = |_| Err(fields.missing("target", "what the heights become at time 1"));
        return time.map_or(Ok(None), missing);
    };
    let target = terrain_recipe(&at)?;
    let refused = |error: InputError| below(&at.path, "config", error.in_json());
    check_target(&recipe.config, &target.config).map_err(refused)?;
    target.validate(patches, 1).map_err(refused)?;
    Ok(Some((target, Morph { time: time.unwrap_or(0.5) })))
}

fn patch(at: &At<'_>) -> Result<[i32; 2], InputError> {
    let range = [i32::MIN, i32::MAX].map(i64::from);
    let entries = at.list(2, 2).map_err(|_| at.error("must be two whole numbers: column and row"))?;
    let mut patch = [0; 2];
    for (axis, entry) in patch.iter_mut().zip(entries) {
        // The range fits in i32.
        *axis = entry.whole(range[0], range[1])? as i32;
    }
    Ok(patch)
}

/// Prepends `path` to an error's path. If the error's path is `whole`, the error is about the whole value, and its path becomes
/// `path`.
pub(super) fn below(path: &str, whole: &str, error: InputError) -> InputError {
    let inner = if error.path == whole { path.to_owned() } else { format!("{path}.{}", error.path) };
    InputError { path: inner, ..error }
}

/// The light and its shadow; `None` if the light casts no shadow.
fn light(at: &At<'_>) -> Result<(Light, Option<SunOptions>), InputError> {
    let fields = at.fields(&["direction", "color", "ambient", "shadow"])?;
    let otherwise = Light::default();
    let direction = fields.maybe("direction", |at| {
        let direction = Vec3::from(at.numbers::<3>(-1e6, 1e6)?.map(|axis| axis as f32));
        let is_one = direction.try_normalize().is_some();
        is_one.then_some(direction).ok_or_else(|| at.error("must not be 0: it points towards the light"))
    })?;
    let light = Light {
        direction: direction.unwrap_or(otherwise.direction),
        color: fields.maybe("color", |at| color(&at, 1000.0))?.map_or(otherwise.color, Vec3::from),
        ambient: fields.number("ambient", 0.0, 1.0, otherwise.ambient.into())? as f32,
    };
    Ok((light, fields.maybe("shadow", |at| shadow(&at))?.flatten()))
}

/// The field `shadow`: true, false, or an object with options.
fn shadow(at: &At<'_>) -> Result<Option<SunOptions>, InputError> {
    let otherwise = SunOptions::default();
    if !at.value().is_object() {
        let bound = "must be true, false, or an object with size and range";
        return Ok(at.flag().map_err(|_| at.error(bound))?.then_some(otherwise));
    }
    let fields = at.fields(&["size", "range"])?;
    // The bounds fit in u32.
    let size = fields.maybe("size", |at| at.whole(16, 8192))?.map_or(otherwise.size, |size| size as u32);
    Ok(Some(SunOptions { size, range: fields.number("range", 1e-3, 1e6, otherwise.range.into())? as f32 }))
}

/// Linear red, green and blue, each from 0 to `most`.
fn color(at: &At<'_>, most: f64) -> Result<[f32; 3], InputError> {
    Ok(at.numbers::<3>(0.0, most)?.map(|channel| channel as f32))
}

fn camera(at: &At<'_>) -> Result<CameraPath, InputError> {
    let fields = at.fields(&["fov", "near", "far", "path", "at", "look"])?;
    let near = fields.number("near", 1e-4, 1e4, NEAR)?;
    let far = fields.maybe("far", |at| {
        let far = at.number(0.0, COORDINATE)?;
        // Both distances are rounded to f32, so they must differ clearly.
        if far < 1.001 * near {
            return Err(at.error(format!("must be beyond near = {near}, by a thousandth at least")));
        }
        Ok(far)
    })?;
    let [least, most] = FIELDS_OF_VIEW;
    let field_of_view = fields.number("fov", least, most, FIELD_OF_VIEW)?;
    let Some(path) = fields.get("path") else {
        let key = CameraKey { time: 0.0, ..key(&fields, field_of_view)? };
        return Ok(CameraPath { keys: vec![key], near, far });
    };
    if let Some(other) = ["at", "look"].into_iter().find_map(|name| fields.get(name)) {
        return Err(other.error("must not be given beside path, whose moments have it"));
    }
    let mut keys: Vec<CameraKey> = Vec::new();
    for entry in path.list(1, MAX_KEYS)? {
        let moment = entry.fields(&["time", "at", "look", "fov"])?;
        let time = moment.need("time", "seconds")?;
        let seconds = time.number(0.0, MAX_TIME)?;
        if let Some(before) = keys.last().filter(|before| seconds < before.time + 1e-3) {
            let bound = format!("must be later than {} by a millisecond at least", before.time);
            return Err(time.error(bound));
        }
        let field_of_view = moment.number("fov", least, most, field_of_view)?;
        keys.push(CameraKey { time: seconds, ..key(&moment, field_of_view)? });
    }
    Ok(CameraPath { keys, near, far })
}

/// A camera key without its time: the eye's position, and the point that the eye looks at.
fn key(fields: &Fields<'_>, field_of_view: f64) -> Result<CameraKey, InputError> {
    let place = |name: &str, what: &str| {
        let at = fields.need(name, what)?;
        Ok::<_, InputError>((DVec3::from(at.numbers::<3>(-COORDINATE, COORDINATE)?), at))
    };
    let (at, _) = place("at", "where the eye is: [x, y, z]")?;
    let (look, entry) = place("look", "where it looks: [x, y, z]")?;
    // If the two points were nearer to each other, rounding would decide the direction.
    if at.distance(look) < 1e-6 * (1.0 + at.abs().max_element()) {
        return Err(entry.error("must lie apart from at, which is where the eye is"));
    }
    Ok(CameraKey { time: 0.0, at, look, field_of_view })
}
