//! Reads the field `lod` of an object, and the field `quality` of a scene.

use glam::Vec3;
use relievo::InputError;
use relievo::scene::{
    Criterion, Culling, DistanceTo, LevelChoice, LevelOfDetail, Pace, Perceptual, Quality, SizeOf, Transition,
};
use relievo::shared::lod::object::{OBJECT_LEVELS, RANKS};

use super::json::{At, COORDINATE, Fields};

/// Exclusive upper limit of a triangle budget.
const MAX_TRIANGLES: i64 = 1 << 32;

/// The largest distance, area, magnification or time that a file may give.
const MOST: f64 = 1e9;

/// How finely the scene is drawn, and the transition of objects that name no transition.
pub(super) fn quality(at: &At<'_>) -> Result<(Quality, Transition), InputError> {
    let fields = at.fields(&["pixels", "triangles", "milliseconds", "transition"])?;
    let quality = Quality {
        pixels: fields.number("pixels", 0.0, 1e4, Quality::default().pixels.into())? as f32,
        // The bounds fit in u32.
        triangles: fields.maybe("triangles", |at| at.whole(1, MAX_TRIANGLES - 1))?.map(|count| count as u32),
        milliseconds: fields.maybe("milliseconds", |at| at.number(1e-3, 1e6))?.map(|time| time as f32),
    };
    Ok((quality, fields.maybe("transition", |at| transition(&at))?.unwrap_or_default()))
}

/// A transition: its name, or a JSON object with its name and options.
pub(super) fn transition(at: &At<'_>) -> Result<Transition, InputError> {
    if !at.value().is_object() {
        return at.one_of(Transition::NAMES);
    }
    let fields = at.fields(&["kind", "band", "seconds", "opaque", "gone"])?;
    let kind = fields.need("kind", "the name of the transition")?;
    let number = |name: &str, least: f64, most: f64| fields.maybe(name, |at| at.number(least, most));
    let (band, seconds) = (number("band", 1e-6, 0.999)?, number("seconds", 1e-3, 1e6)?);
    let (opaque, gone) = (number("opaque", 0.0, MOST)?, number("gone", 0.0, MOST)?);
    if kind.text()? == "alpha" {
        let need =
            |value: Option<f64>, name: &str| value.ok_or_else(|| fields.missing(name, "where it fades"));
        let (opaque, gone) = (need(opaque, "opaque")? as f32, need(gone, "gone")? as f32);
        return match band.or(seconds) {
            Some(_) => Err(kind.error("must be another one: alpha has neither band nor seconds")),
            None => Ok(Transition::Alpha { opaque, gone }),
        };
    }
    let pace = match (band, seconds) {
        (Some(_), Some(_)) => return Err(at.error("must have band or seconds, and not both")),
        (_, Some(seconds)) => Pace::Seconds(seconds as f32),
        (band, None) => band.map_or_else(Pace::default, |band| Pace::Band(band as f32)),
    };
    match kind.one_of(Transition::NAMES)? {
        Transition::Dither(_) => Ok(Transition::Dither(pace)),
        Transition::CrossFade(_) => Ok(Transition::CrossFade(pace)),
        Transition::FadeIn(_) => Ok(Transition::FadeIn(pace)),
        Transition::TwoPhase(_) => Ok(Transition::TwoPhase(pace)),
        other if band.or(seconds).or(opaque).or(gone).is_none() => Ok(other),
        _ => Err(kind.error("must be a fade to have band or seconds, and alpha to have opaque and gone")),
    }
}

const FIELDS: [&str; 11] =
    ["criterion", "to", "of", "from", "below", "near", "far", "level", "hysteresis", "bias", "rank"];

/// How an object's levels of detail are chosen and change. `transition` is the object's transition.
pub(super) fn level_of_detail(at: &At<'_>, transition: Transition) -> Result<LevelOfDetail, InputError> {
    let known: Vec<&str> = FIELDS.into_iter().chain(["motion", "periphery", "culling"]).collect();
    let fields = at.fields(&known)?;
    let otherwise = LevelOfDetail::default();
    let level = fields.maybe("level", |at| at.whole(0, i64::from(OBJECT_LEVELS) - 1))?;
    let choice = match level {
        Some(level) => LevelChoice::Forced(level as u32),
        None => LevelChoice::By(criterion(at, &fields)?),
    };
    let number = |name: &str, most: f64, otherwise: f32| fields.number(name, 0.0, most, otherwise.into());
    Ok(LevelOfDetail {
        choice,
        transition,
        hysteresis: number("hysteresis", 0.999, otherwise.hysteresis)? as f32,
        bias: fields.number("bias", 1e-6, 1e6, otherwise.bias.into())? as f32,
        rank: fields.maybe("rank", |at| at.whole(0, i64::from(RANKS) - 1))?.map(|rank| rank as u8),
        perceptual: Perceptual {
            motion: number("motion", 1e6, 0.0)? as f32,
            periphery: number("periphery", 1e6, 0.0)? as f32,
        },
        culling: fields.one_of(
            "culling",
            [("frustum", Culling::Frustum), ("never", Culling::Never)],
            Culling::Frustum,
        )?,
    })
}

/// Names of the criteria for levels of detail.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Named {
    Error,
    Distance,
    Size,
    Magnification,
    Ratio,
}

fn criterion(at: &At<'_>, fields: &Fields<'_>) -> Result<Criterion, InputError> {
    let names = [
        ("error", Named::Error),
        ("distance", Named::Distance),
        ("size", Named::Size),
        ("magnification", Named::Magnification),
        ("ratio", Named::Ratio),
    ];
    let named = fields.one_of("criterion", names, Named::Error)?;
    let fits: &[&str] = match named {
        Named::Error => &[],
        Named::Distance => &["to", "from"],
        Named::Size => &["of", "below"],
        Named::Magnification => &["below"],
        Named::Ratio => &["to", "near", "far"],
    };
    for name in ["to", "of", "from", "below", "near", "far"] {
        if let Some(field) = fields.get(name).filter(|_| !fits.contains(&name)) {
            let [(name, _), ..] = names.into_iter().filter(|(_, of)| *of == named).collect::<Vec<_>>()[..]
            else {
                return Err(at.error("must name a criterion"));
            };
            return Err(field.error(format!("must not be given with the criterion {name}")));
        }
    }
    let list = |name: &str, what: &str| {
        let all = fields.need(name, what)?.list(1, OBJECT_LEVELS as usize - 1)?;
        all.iter().map(|at| Ok(at.number(0.0, MOST)? as f32)).collect::<Result<Vec<f32>, InputError>>()
    };
    Ok(match named {
        Named::Error => Criterion::Error,
        Named::Distance => {
            Criterion::Distance { to: to(fields)?, from: list("from", "the distances of levels 1, 2, …")? }
        }
        Named::Size => {
            let of =
                fields.one_of("of", [("box", SizeOf::Box), ("sphere", SizeOf::Sphere)], SizeOf::Sphere)?;
            Criterion::Size { of, below: list("below", "the fractions of the picture of levels 1, 2, …")? }
        }
        Named::Magnification => {
            Criterion::Magnification { below: list("below", "the pixels per unit of levels 1, 2, …")? }
        }
        Named::Ratio => {
            let number =
                |name: &str| Ok::<_, InputError>(fields.need(name, "a distance")?.number(0.0, MOST)? as f32);
            Criterion::Ratio { to: to(fields)?, near: number("near")?, far: number("far")? }
        }
    })
}

/// The point that distances are measured to: a name, or a point of the model.
fn to(fields: &Fields<'_>) -> Result<DistanceTo, InputError> {
    let to = fields.maybe("to", |at| match at.value().is_array() {
        true => {
            let point = at.numbers::<3>(-COORDINATE, COORDINATE)?;
            Ok(DistanceTo::Point(Vec3::from(point.map(|axis| axis as f32))))
        }
        false => at.one_of([("center", DistanceTo::Center), ("nearest", DistanceTo::NearestPoint)]),
    })?;
    Ok(to.unwrap_or_default())
}
