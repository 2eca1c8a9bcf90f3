//! The search for levels within an error.

use crate::distance::DistanceOptions;
use relievo::InputError;

use crate::measure::reduction::{MeasuredLevel, Run};

/// The fraction of triangles of one trial that the next has.
const STEP: f64 = 0.75;

/// How trials are measured: the largest distance does not need the samples of a root mean square.
const TRIAL: DistanceOptions = DistanceOptions { tolerance: 0.01, samples: 1 };

/// The number of trials between two of them.
const BETWEEN: usize = 6;

/// For each error, the level with the fewest triangles of those tried whose largest distance is at most that. The model itself
/// is such a level.
pub(super) fn within(
    run: &mut Run<'_>,
    errors: &[f64],
    all: usize,
) -> Result<Vec<MeasuredLevel>, InputError> {
    if errors.is_empty() {
        return Ok(Vec::new());
    }
    let mut counts = vec![all];
    while let Some(last) = counts.last().filter(|last| **last > 4) {
        counts.push(((*last as f64 * STEP) as usize).max(1));
    }
    let trials = run.measured(&counts, &TRIAL)?;
    let found = errors.iter().map(|error| best(run, &trials, *error)).collect::<Result<Vec<_>, _>>()?;
    let measured = found.into_iter().map(|MeasuredLevel { reduced, .. }| {
        let distance = reduced.distance(run.whole, &DistanceOptions::default())?;
        Ok(MeasuredLevel { reduced, distance })
    });
    measured.collect()
}

/// The best of the trials, and of some more between it and the next.
fn best(run: &mut Run<'_>, trials: &[MeasuredLevel], error: f64) -> Result<MeasuredLevel, InputError> {
    let is_within = |level: &&MeasuredLevel| level.distance.max() <= error;
    // The first trial is the model; it is within any error but for rounding.
    let at = trials.iter().rposition(|level| is_within(&level)).unwrap_or(0);
    let (coarse, next) = (&trials[at], trials.get(at + 1));
    let (most, least) = (coarse.reduced.triangles(), next.map_or(0, |next| next.reduced.triangles()));
    let between = |part: usize| most - (most - least.min(most)) * part / (BETWEEN + 1);
    let counts: Vec<usize> =
        (1..=BETWEEN).map(between).filter(|count| *count > least && *count < most).collect();
    let finer = run.measured(&counts, &TRIAL)?;
    Ok(finer.iter().filter(is_within).min_by_key(|level| level.reduced.triangles()).unwrap_or(coarse).clone())
}
