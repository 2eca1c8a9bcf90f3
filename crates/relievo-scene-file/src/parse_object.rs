//! Reads the entries of `meshes` and `characters`.

use std::path::Path;

use glam::{DVec3, Quat, Vec3};
use relievo::InputError;
use relievo::asset::ENDINGS;
use relievo::ops::animation::Wrap;
use relievo::ops::surface::ReliefShadow;
use relievo::ops::surface::relief::{MAX_SCALE, ReliefMethod};
use relievo::scene::Transition;
use relievo::shared::lod::object::OBJECT_LEVELS;

use super::entries::{
    BUILT_IN, EntryKind, InstanceEntry, ModelSource, ObjectEntry, PlayEntry, ReliefEntry, Scatter, Source,
    Spot,
};
use super::json::{At, COORDINATE, Fields};
use super::parse_character::{self, CharacterDetail};
use super::parse_lod::{level_of_detail, transition};

/// Largest number of instances of a mesh and of a character. The limit for characters is lower, because their bones take memory.
const MAX_MESHES: usize = 1 << 20;
const MAX_CHARACTERS: usize = 1 << 16;

/// Largest number of models that are the levels of detail of an object.
const MAX_LEVELS: usize = OBJECT_LEVELS as usize;

/// The largest start time of a clip in seconds, and the largest playback rate.
const MAX_SECONDS: f64 = 1e6;
const MAX_RATE: f64 = 100.0;

const WRAPS: [(&str, Wrap); 2] = [("loop", Wrap::Loop), ("clamp", Wrap::Clamp)];
const SHADOWS: [(&str, ReliefShadow); 3] =
    [("none", ReliefShadow::None), ("hard", ReliefShadow::Hard), ("soft", ReliefShadow::Soft)];

/// An entry of `meshes`.
pub(super) fn mesh(at: &At<'_>) -> Result<ObjectEntry, InputError> {
    let fields =
        at.fields(&["name", "file", "levels", "material", "transition", "lod", "instances", "scatter"])?;
    let source = model(&fields)?;
    if let (ModelSource::Levels(_), Some(levels), Some(_)) =
        (&source, fields.get("levels"), fields.get("material"))
    {
        return Err(levels.error("must not be given beside material: a relief has one level of detail"));
    }
    let kind = fields.maybe("material", |at| relief(&at))?.map_or(EntryKind::Mesh, EntryKind::Relief);
    placed(at, &fields, source, kind, MAX_MESHES)
}

/// An entry of `characters`.
pub(super) fn character(at: &At<'_>) -> Result<ObjectEntry, InputError> {
    const KNOWN: [&str; 11] = [
        "name",
        "file",
        "levels",
        "clip",
        "rate",
        "start",
        "wrap",
        "transition",
        "lod",
        "instances",
        "scatter",
    ];
    let fields = at.fields(&[&KNOWN[..], &parse_character::FIELDS].concat())?;
    let source = model(&fields)?;
    let all = PlayEntry { clip: None, rate: 1.0, start: 0.0, wrap: Wrap::Loop };
    let kind = EntryKind::Character(play(&fields, &all)?);
    let detail = parse_character::detail(&fields)?;
    Ok(ObjectEntry { detail, ..placed(at, &fields, source, kind, MAX_CHARACTERS)? })
}

fn placed(
    at: &At<'_>,
    fields: &Fields<'_>,
    source: ModelSource,
    kind: EntryKind,
    most: usize,
) -> Result<ObjectEntry, InputError> {
    let play = match &kind {
        EntryKind::Character(play) => Some(play),
        EntryKind::Mesh | EntryKind::Relief(_) => None,
    };
    let instances = fields.maybe("instances", |list| {
        list.list(1, most)?.iter().map(|at| instance(at, play)).collect::<Result<Vec<_>, _>>()
    })?;
    let scatter = fields.maybe("scatter", |at| scatter(&at, most))?;
    if instances.is_none() && scatter.is_none() {
        return Err(fields.missing("instances", "or scatter, to say where it stands"));
    }
    let instances = instances.unwrap_or_default();
    let transition = fields.maybe("transition", |at| transition(&at))?;
    let level_of_detail = fields.maybe("lod", |at| level_of_detail(&at, transition.unwrap_or_default()))?;
    if let (Some(Transition::Geomorph), EntryKind::Relief(_)) = (transition, &kind) {
        let path = format!("{}.transition", at.path);
        let bound = "must be hard: a mesh with a relief has one level of detail";
        return Err(InputError::new(path, "geomorph", bound));
    }
    let name = fields.maybe("name", |at| at.text().map(str::to_owned))?;
    let (path, detail) = (at.path.clone(), CharacterDetail::default());
    Ok(ObjectEntry { path, name, source, kind, detail, transition, level_of_detail, instances, scatter })
}

/// The model's source, from the field `file` or the field `levels`.
fn model(fields: &Fields<'_>) -> Result<ModelSource, InputError> {
    let one = |at: &At<'_>| source(at, &ENDINGS, "must be a .glb, .gltf, .obj or .rlv file");
    let Some(levels) = fields.get("levels") else {
        let at = fields
            .need("file", "a .glb, .gltf, .obj or .rlv file, a built-in model, or levels in its place")?;
        return Ok(ModelSource::One(one(&at)?));
    };
    if fields.get("file").is_some() {
        return Err(levels.error("must not be given beside file"));
    }
    let all = levels.list(2, MAX_LEVELS)?.iter().map(one).collect::<Result<_, _>>()?;
    Ok(ModelSource::Levels(all))
}

/// The source of a map: an image file or a built-in map.
fn image(at: At<'_>) -> Result<Source, InputError> {
    source(&at, &["png", "jpg", "jpeg"], "must be a .png or .jpg file")
}

/// The source that a string names: a built-in name, or a file with one of `endings`, which are in lower case.
fn source(at: &At<'_>, endings: &[&str], bound: &str) -> Result<Source, InputError> {
    let text = at.text()?;
    if let Some(name) = text.strip_prefix(BUILT_IN) {
        return Ok(Source::BuiltIn(name.to_owned()));
    }
    let ending = Path::new(text).extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.is_some_and(|ending| endings.contains(&ending.as_str())) {
        true => Ok(Source::File(text.into())),
        false => Err(at.error(bound)),
    }
}

fn relief(at: &At<'_>) -> Result<ReliefEntry, InputError> {
    let known = ["relief", "channel", "albedo", "normal", "scale", "tiles", "method", "shadow"];
    let fields = at.fields(&known)?;
    let heights = image(fields.need("relief", "the image of its heights")?)?;
    let all = ReliefMethod::ALL.map(|method| (method.name(), method));
    Ok(ReliefEntry {
        heights,
        is_alpha: fields.one_of("channel", [("brightness", false), ("alpha", true)], false)?,
        albedo: fields.maybe("albedo", image)?,
        normals: fields.maybe("normal", image)?,
        scale: fields.number("scale", 0.0, MAX_SCALE.into(), 0.1)? as f32,
        tiles: fields.number("tiles", 1e-3, 1e3, 1.0)? as f32,
        method: fields.one_of("method", all, ReliefMethod::Quadtree)?,
        shadow: fields.one_of("shadow", SHADOWS, ReliefShadow::default())?,
    })
}

/// A character's animation. Missing fields get the values of `otherwise`.
fn play(fields: &Fields<'_>, otherwise: &PlayEntry) -> Result<PlayEntry, InputError> {
    let clip = fields.maybe("clip", |at| match at.value().is_number() {
        true => Ok(at.whole(0, i64::from(u32::MAX))?.to_string()),
        false => Ok(at.text()?.to_owned()),
    })?;
    Ok(PlayEntry {
        clip: clip.or_else(|| otherwise.clip.clone()),
        rate: fields.number("rate", -MAX_RATE, MAX_RATE, otherwise.rate.into())? as f32,
        start: fields.number("start", -MAX_SECONDS, MAX_SECONDS, otherwise.start)?,
        wrap: fields.one_of("wrap", WRAPS, otherwise.wrap)?,
    })
}

fn instance(at: &At<'_>, of_character: Option<&PlayEntry>) -> Result<InstanceEntry, InputError> {
    const PLACE: [&str; 5] = ["at", "on", "lift", "turn", "scale"];
    const PLAY: [&str; 4] = ["clip", "rate", "start", "wrap"];
    let fields = match of_character {
        Some(_) => at.fields(&[&PLACE[..], &PLAY[..]].concat())?,
        None => at.fields(&PLACE)?,
    };
    let lift = fields.maybe("lift", lift)?;
    let spot = match (fields.get("at"), fields.get("on")) {
        (Some(_), Some(on)) => return Err(on.error("must not be given beside at")),
        (Some(at), None) => Spot::At(DVec3::from(at.numbers::<3>(-COORDINATE, COORDINATE)?)),
        (None, Some(on)) => {
            let [x, z] = on.numbers::<2>(-COORDINATE, COORDINATE)?;
            Spot::On { x, z, lift: lift.unwrap_or(0.0) }
        }
        (None, None) => return Err(fields.missing("at", "[x, y, z], or on: [x, z] on the ground")),
    };
    if let (Spot::At(_), Some(lift)) = (spot, fields.get("lift")) {
        return Err(lift.error("must not be given beside at, which has a height"));
    }
    Ok(InstanceEntry {
        spot,
        turn: fields.maybe("turn", turn)?.unwrap_or(Quat::IDENTITY),
        scale: fields.maybe("scale", |at| scale(&at))?.unwrap_or(Vec3::ONE),
        play: of_character.map(|otherwise| play(&fields, otherwise)).transpose()?,
    })
}

/// A height above the ground in model units.
fn lift(at: At<'_>) -> Result<f64, InputError> {
    at.number(-1e6, 1e6)
}

/// A rotation: an angle about the vertical axis, or a quaternion.
fn turn(at: At<'_>) -> Result<Quat, InputError> {
    if at.value().is_number() {
        return Ok(upright(at.number(-1e6, 1e6)?));
    }
    let numbers = at.numbers::<4>(-1e6, 1e6);
    let numbers = numbers.map_err(|error| InputError {
        bound: "must be an angle in radians, or a quaternion of four numbers: x, y, z, w".to_owned(),
        ..error
    })?;
    let quaternion = Quat::from_array(numbers.map(|number| number as f32));
    match quaternion.length() > 1e-3 {
        true => Ok(quaternion.normalize()),
        false => Err(at.error("must not be 0")),
    }
}

/// Three scale factors, or one for all axes.
fn scale(at: &At<'_>) -> Result<Vec3, InputError> {
    let check = |factor: f64| (1e-6..=1e6).contains(&factor.abs());
    let all = match at.value().is_number() {
        true => [at.number(-1e6, 1e6)?; 3],
        false => at.numbers::<3>(-1e6, 1e6)?,
    };
    if !all.into_iter().all(check) {
        return Err(at.error("must be one number or three between 1e-6 and 1e6, negative ones to mirror"));
    }
    Ok(all.map(|factor| factor as f32).into())
}

/// The rotation about the vertical axis by an angle, with the same bits on every machine.
pub(super) fn upright(angle: f64) -> Quat {
    Quat::from_xyzw(0.0, libm::sin(0.5 * angle) as f32, 0.0, libm::cos(0.5 * angle) as f32)
}

fn scatter(at: &At<'_>, most: usize) -> Result<Scatter, InputError> {
    let fields = at.fields(&["count", "seed", "area", "scale", "lift"])?;
    let count = fields.need("count", "how many")?.whole(1, most as i64)? as u32;
    let seed = fields.need("seed", "any text: the same text gives the same places")?.text()?.to_owned();
    let area = fields.maybe("area", |at| {
        let corners = at.list(2, 2).map_err(|_| at.error("must be two corners: [[x, z], [x, z]]"))?;
        let [a, b] = [0, 1].map(|corner: usize| corners[corner].numbers::<2>(-COORDINATE, COORDINATE));
        let (low, high) = (a?, b?);
        match low[0] < high[0] && low[1] < high[1] {
            true => Ok([low, high]),
            false => Err(at.error("must have the corner with the smaller x and z first")),
        }
    })?;
    let range = fields.maybe("scale", |at| match at.value().is_number() {
        true => Ok([at.number(1e-6, 1e6)?; 2]),
        false => {
            let range = at.numbers::<2>(1e-6, 1e6)?;
            if range[0] > range[1] {
                return Err(at.error("must have the smaller scale first"));
            }
            Ok(range)
        }
    })?;
    let scale = range.unwrap_or([1.0; 2]).map(|scale| scale as f32);
    Ok(Scatter { count, seed, area, scale, lift: fields.maybe("lift", lift)?.unwrap_or(0.0) })
}
