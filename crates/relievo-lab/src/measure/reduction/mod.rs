//! Measures levels of detail of the caller's own models: how far each is from the model, for a reducer and some targets, and
//! for all reducers beside each other.

pub use compare::{ReducerComparison, ReducerLevel, ReducerRow};
use std::time::Instant;

use crate::distance::{Distance, DistanceOptions};
use crate::reduce::{Limits, Reducer};
use crate::reduce::{Normals, ReducedModel, reduce_model};
use relievo::InputError;
use relievo::asset::Model;
use relievo::ops::skinning::at_rest;

use crate::measure::progress::{Listener, Steps, during};

mod compare;
mod search;

/// How far to reduce a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// To this number of triangles, at least 1 and at most as many as the model has.
    Triangles(usize),
    /// To this part of the model's triangles: above 0, and at most 1.
    Share(f64),
    /// To the fewest triangles that were found with a measured largest distance of at most this, in the model's units; at
    /// least 0.
    Error(f64),
}

/// A level of a model, and how far it is off.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredLevel {
    /// The level.
    pub reduced: ReducedModel,
    /// The distances between the surfaces of the model and the level, in the model's units.
    pub distance: Distance,
}

/// Levels of a model.
#[derive(Debug, Clone)]
pub struct Reduction {
    /// The model at rest, which was reduced.
    pub whole: Model,
    /// A level for each target, in their order.
    pub levels: Vec<MeasuredLevel>,
    /// The seconds that the reducer took, without measuring.
    pub seconds: f64,
}

/// Reduces a model as it stands at rest, all meshes as one surface ([`reduce_model`]), and measures each level
/// ([`ReducedModel::distance`]).
///
/// For [`Target::Error`], levels with ever fewer triangles are measured, first a quarter fewer each time, then in between: the
/// largest distance may grow and shrink again, so that fewer triangles within the error may exist.
///
/// # Errors
/// [`InputError`] for targets out of range (`targets[2].triangles`), and as [`reduce_model`].
pub fn reduction(
    model: &Model,
    reducer: &Reducer,
    targets: &[Target],
    normals: Normals,
    listener: Listener<'_>,
) -> Result<Reduction, InputError> {
    let whole = at_rest(model)?;
    let all = whole.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum();
    for (at, target) in targets.iter().enumerate() {
        target.validate(at, all)?;
    }
    let mut run = Run { whole: &whole, reducer, normals, listener, seconds: 0.0 };
    let counts: Vec<usize> = targets.iter().filter_map(|target| target.count(all)).collect();
    let mut counted = run.measured(&counts, &DistanceOptions::default())?.into_iter();
    let errors: Vec<f64> = targets.iter().filter_map(Target::error).collect();
    let mut found = search::within(&mut run, &errors, all)?.into_iter();
    let next = |target: &Target| if target.error().is_some() { found.next() } else { counted.next() };
    let levels = targets.iter().filter_map(next).collect();
    let seconds = run.seconds;
    Ok(Reduction { whole, levels, seconds })
}

impl Target {
    fn validate(&self, at: usize, all: usize) -> Result<(), InputError> {
        let refused = |field: &str, value: String, bound: String| {
            Err(InputError::new(format!("targets[{at}].{field}"), value, bound))
        };
        match *self {
            Self::Triangles(count) if !(1..=all).contains(&count) => refused(
                "triangles",
                count.to_string(),
                format!("must be in 1..={all}, the model's triangles"),
            ),
            Self::Share(share) if !(share > 0.0 && share <= 1.0) => {
                refused("share", share.to_string(), "must be above 0, and at most 1".to_owned())
            }
            Self::Error(error) if !(error >= 0.0 && error.is_finite()) => {
                refused("error", error.to_string(), "must be finite, and at least 0".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// The number of triangles for a model of `all`; `None` for an error.
    fn count(&self, all: usize) -> Option<usize> {
        match *self {
            Self::Triangles(count) => Some(count),
            Self::Share(share) => Some(((share * all as f64).round() as usize).max(1)),
            Self::Error(_) => None,
        }
    }

    fn error(&self) -> Option<f64> {
        match *self {
            Self::Error(error) => Some(error),
            _ => None,
        }
    }
}

/// A reducer at work on a model.
struct Run<'a> {
    whole: &'a Model,
    reducer: &'a Reducer,
    normals: Normals,
    listener: Listener<'a>,
    seconds: f64,
}

impl Run<'_> {
    /// The levels with these numbers of triangles, measured.
    fn measured(
        &mut self,
        counts: &[usize],
        options: &DistanceOptions,
    ) -> Result<Vec<MeasuredLevel>, InputError> {
        if counts.is_empty() {
            return Ok(Vec::new());
        }
        let limits: Vec<_> =
            counts.iter().map(|triangles| Limits { triangles: *triangles, ..Limits::default() }).collect();
        let start = Instant::now();
        let reduce = || reduce_model(self.whole, self.reducer, &limits, self.normals);
        let reduced = during(self.listener, "reducing", reduce)?;
        self.seconds += start.elapsed().as_secs_f64();
        let steps = Steps::new(self.listener, "measuring", reduced.len() as u64);
        let measured = reduced.into_iter().map(|reduced| {
            let distance = reduced.distance(self.whole, options)?;
            steps.step();
            Ok(MeasuredLevel { reduced, distance })
        });
        measured.collect()
    }
}
