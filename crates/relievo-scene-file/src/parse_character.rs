//! Reads the level of detail of a character: `gate`, `influences`, `priorities` and `tiers`.

use std::collections::BTreeMap;

use relievo::InputError;
use relievo::scene::{
    BoneGate, CharacterOptions, DistanceRange, InfluenceLod, PriorityWeights, SkeletonTier,
};

use super::json::{At, Fields};

/// The names of the fields.
pub(super) const FIELDS: [&str; 4] = ["gate", "influences", "priorities", "tiers"];

/// The largest distance in world units.
const MOST: f64 = 1e9;

/// The level of detail of a character, for [`CharacterOptions`].
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct CharacterDetail {
    pub gate: BoneGate,
    influences: InfluenceLod,
    priorities: BTreeMap<String, f32>,
    tiers: Vec<SkeletonTier>,
}

impl CharacterDetail {
    /// The options of a character.
    pub fn options(&self) -> CharacterOptions<'_> {
        CharacterOptions {
            gate: self.gate,
            influences: self.influences,
            priorities: self.priorities.iter().map(|(bone, priority)| (bone.as_str(), *priority)).collect(),
            tiers: self.tiers.clone(),
            ..CharacterOptions::default()
        }
    }
}

/// Reads the fields of a character's level of detail. Missing fields get their defaults.
pub(super) fn detail(fields: &Fields<'_>) -> Result<CharacterDetail, InputError> {
    Ok(CharacterDetail {
        gate: fields.maybe("gate", |at| gate(&at))?.unwrap_or_default(),
        influences: fields.maybe("influences", |at| influences(&at))?.unwrap_or_default(),
        priorities: fields.maybe("priorities", |at| priorities(&at))?.unwrap_or_default(),
        tiers: fields.maybe("tiers", |at| at.list(0, 3)?.iter().map(tier).collect())?.unwrap_or_default(),
    })
}

#[derive(Clone, Copy)]
enum Mode {
    Uniform,
    SkipPeriod,
    Budget,
}

/// A gate: its name, or an object with its mode and parameters.
fn gate(at: &At<'_>) -> Result<BoneGate, InputError> {
    if !at.value().is_object() {
        let names = [("bounded", BoneGate::Bounded), ("off", BoneGate::Off)];
        return at.one_of(names).map_err(|error| InputError {
            bound: format!("{}, or an object with a mode", error.bound),
            ..error
        });
    }
    let all = at.fields(&["mode", "range", "period", "weights", "bones"])?;
    let modes = [("uniform", Mode::Uniform), ("skip-period", Mode::SkipPeriod), ("budget", Mode::Budget)];
    let mode = all.need("mode", "the gate's name")?.one_of(modes)?;
    let known: &[&str] = match mode {
        Mode::Uniform => &["mode", "range"],
        Mode::SkipPeriod => &["mode", "range", "period", "weights"],
        Mode::Budget => &["mode", "bones"],
    };
    let fields = at.fields(known)?;
    let range = || range(&fields.need("range", "two distances between which detail falls")?);
    Ok(match mode {
        Mode::Uniform => BoneGate::Uniform(range()?),
        Mode::SkipPeriod => BoneGate::SkipPeriod {
            range: range()?,
            period: fields.number("period", 1e-3, 65_535.0, 1.0)? as f32,
            weights: fields.maybe("weights", |at| weights(&at))?.flatten(),
        },
        Mode::Budget => {
            let bones = fields.need("bones", "the largest number of bones in a frame")?;
            BoneGate::Budget { bones: bones.whole(0, u32::MAX.into())? as u32 }
        }
    })
}

/// Two distances, the smaller one first.
fn range(at: &At<'_>) -> Result<DistanceRange, InputError> {
    let [min, max] = at.numbers::<2>(0.0, MOST)?.map(|distance| distance as f32);
    match min < max {
        true => Ok(DistanceRange { min, max }),
        false => Err(at.error("must have the smaller distance first")),
    }
}

/// Six weights that add up to 1; `None` for `"analyze"`.
fn weights(at: &At<'_>) -> Result<Option<PriorityWeights>, InputError> {
    if at.value().is_string() {
        return at.one_of([("analyze", None)]);
    }
    let weights = PriorityWeights(at.numbers::<6>(0.0, 1.0)?);
    weights.validate().map_err(|error| at.error(error.bound))?;
    Ok(Some(weights))
}

/// An influence method: `"bounded"`, or an object with `most` or `fade`.
fn influences(at: &At<'_>) -> Result<InfluenceLod, InputError> {
    if !at.value().is_object() {
        return at.one_of([("bounded", InfluenceLod::Bounded)]).map_err(|error| InputError {
            bound: format!("{}, or an object with most or fade", error.bound),
            ..error
        });
    }
    let fields = at.fields(&["most", "fade"])?;
    match (fields.get("most"), fields.get("fade")) {
        (Some(most), None) => Ok(InfluenceLod::Truncated(most.whole(1, 8)? as u32)),
        (None, Some(fade)) => Ok(InfluenceLod::Faded(range(&fade)?)),
        (Some(_), Some(fade)) => Err(fade.error("must not be given beside most")),
        (None, None) => Err(fields.missing("most", "the number of bones that a vertex follows, or fade")),
    }
}

/// Priorities of bones by name.
fn priorities(at: &At<'_>) -> Result<BTreeMap<String, f32>, InputError> {
    let serde_json::Value::Object(all) = at.value() else { return Err(at.error("must be an object")) };
    let names: Vec<&str> = all.keys().map(String::as_str).collect();
    let fields = at.fields(&names)?;
    let priority = |name: &&str| Ok(((*name).to_owned(), fields.number(name, 0.0, 1.0, 0.5)? as f32));
    names.iter().map(priority).collect()
}

/// A skeleton: the fraction of bones to keep, or an object with `bones` and `rigid`.
fn tier(at: &At<'_>) -> Result<SkeletonTier, InputError> {
    let fraction = |at: &At<'_>| Ok::<_, InputError>(at.number(1e-3, 0.999)? as f32);
    if !at.value().is_object() {
        return Ok(SkeletonTier { bones: fraction(at)?, is_rigid: false });
    }
    let fields = at.fields(&["bones", "rigid"])?;
    let bones = fraction(&fields.need("bones", "the fraction of bones to keep")?)?;
    Ok(SkeletonTier { bones, is_rigid: fields.maybe("rigid", |at| at.flag())?.unwrap_or(false) })
}
