//! What the arguments mean, checked.

use relievo::InputError;
use relievo::animation::Range;
use relievo::animation::priority::Weights;
use relievo::asset::{Clip, Model};
use relievo::{Error, animation::lod::Projection};

use super::gates::{Mode, TICKS};
use super::skinning::{Drawn, Skinning};
use super::triangles::Triangles;
use super::{Crowd, Layout};
#[cfg(feature = "gpu")]
use crate::pose::place;
use crate::pose::{find, open, open_bare};
use crate::priorities;
use crate::terrain::Backend;

/// Lines of the picture.
pub const LINES: u32 = 1080;

/// Radians, vertical.
pub const FIELD_OF_VIEW: f32 = std::f32::consts::FRAC_PI_3;

/// The near plane, in units.
const NEAR: f32 = 1.0;

/// Distances of the default sweep.
const SWEEP: u32 = 7;

/// The most frames: 32 bits of ticks hold them at any rate.
const MAX_FRAMES: u32 = 100_000;

/// Checked arguments.
pub struct Plan {
    pub name: String,
    pub model: Model,
    pub clip: Clip,
    /// Its place among the model's.
    #[cfg(feature = "gpu")]
    pub clip_index: usize,
    pub instances: usize,
    pub layout: Layout,
    pub seed: u32,
    pub gate: Option<Mode>,
    pub period: f64,
    pub budget: Option<u32>,
    pub pixels: f32,
    pub weights: Weights,
    pub range: Range,
    pub distances: Vec<f32>,
    pub size: f32,
    pub spacing: f32,
    pub frames: u32,
    pub rate: f64,
    pub backend: Backend,
    pub tall: f32,
    pub drawn: Option<Drawn>,
    pub skinning: Skinning,
    pub triangles: Triangles,
}

impl Plan {
    pub fn new(arguments: &Crowd) -> Result<Self, Error> {
        let a = arguments;
        let range = range(&a.range)?;
        let distances = match &a.distance {
            None => sweep(&range),
            Some(text) => numbers("distance", text)?,
        };
        check("size", a.size.into(), 1e-3..=1e6)?;
        check("spacing", a.spacing.into(), 0.0..=1e3)?;
        check("rate", a.rate, 1.0..=1000.0)?;
        check("period", a.period, 0.0..=f64::from(u32::MAX / TICKS))?;
        check("pixels", a.pixels.into(), 0.0..=1e6)?;
        check("tall", a.tall.into(), 1.0..=1e4)?;
        for distance in &distances {
            check("distance", (*distance).into(), f64::from(NEAR)..=1e6)?;
        }
        let instances = a.instances.unwrap_or(if a.pareto { 25 } else { 100 });
        check("instances", instances as f64, 1.0..=1e5)?;
        check("frames", f64::from(a.frames), 1.0..=f64::from(MAX_FRAMES))?;
        if a.gate == Some(Mode::Budget) && a.budget.is_none() {
            return Err(InputError::new("budget", "nothing", "must be the most bones a frame").into());
        }
        let drawn = match (a.scene, a.image) {
            (true, _) => Some(Drawn::Scene),
            (false, true) => Some(Drawn::Image),
            (false, false) => None,
        };
        if drawn.is_some() && a.backend == Backend::Cpu {
            return Err(InputError::new("backend", "cpu", "must be gpu, as the crowd is drawn").into());
        }
        drawn.map_or(Ok(()), |drawn| drawn.check(a.frames))?;
        for (field, given) in [("skinning", &a.skinning), ("mesh", &a.mesh)] {
            if drawn.is_none() && given.is_some() {
                return Err(InputError::new(field, "given", "must come with --image or --scene").into());
            }
        }
        let faded = if a.scene { "bounded:0.5" } else { "full" };
        let skinning = a.skinning.as_deref().unwrap_or(faded);
        let triangles = Triangles::new(a.mesh.as_deref().unwrap_or(faded))?;
        let model = if drawn.is_some() { open(&a.model)? } else { open_bare(&a.model)? };
        let clip = find(&model, &a.model, &a.clip)?;
        #[cfg(feature = "gpu")]
        let clip_index = place(&model, clip);
        let clip = clip.clone();
        let weights = priorities::weights(a.weights.as_deref(), &model.skeleton, &clip, true)?;
        Ok(Self {
            name: a.model.display().to_string(),
            clip,
            #[cfg(feature = "gpu")]
            clip_index,
            model,
            instances,
            layout: a.layout,
            seed: a.seed,
            gate: a.gate,
            period: a.period,
            budget: a.budget,
            pixels: a.pixels,
            weights,
            range,
            distances,
            size: a.size,
            spacing: a.spacing,
            frames: a.frames,
            rate: a.rate,
            backend: a.backend,
            tall: a.tall,
            drawn,
            skinning: Skinning::new(skinning, range)?,
            triangles,
        })
    }

    /// The camera's lens, for a model of which a unit is so many metres.
    pub fn projection(&self, metres_a_unit: f32) -> Projection {
        Projection::new(LINES, FIELD_OF_VIEW, NEAR * metres_a_unit)
    }
}

fn check(field: &str, value: f64, bounds: std::ops::RangeInclusive<f64>) -> Result<(), InputError> {
    if bounds.contains(&value) {
        return Ok(());
    }
    Err(InputError::new(field, value, format!("must be in {}..={}", bounds.start(), bounds.end())))
}

fn numbers(field: &str, text: &str) -> Result<Vec<f32>, InputError> {
    let refused = |_| InputError::new(field, text, "must be numbers with commas between them");
    text.split(',').map(|word| word.trim().parse().map_err(refused)).collect()
}

fn range(text: &str) -> Result<Range, InputError> {
    let ends = numbers("range", text)?;
    let [min, max] = ends[..] else {
        return Err(InputError::new("range", text, "must be two distances, such as 200,1700"));
    };
    let range = Range { min, max };
    range.validate()?;
    Ok(range)
}

/// Both ends of a range, and evenly between them.
fn sweep(range: &Range) -> Vec<f32> {
    let at = |step: u32| range.min + (range.max - range.min) * step as f32 / (SWEEP - 1) as f32;
    (0..SWEEP).map(|step| at(step).max(NEAR)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sweeps_have_both_ends() {
        assert_eq!(sweep(&Range { min: 200.0, max: 1700.0 })[..2], [200.0, 450.0]);
        assert_eq!(sweep(&Range { min: 0.0, max: 6.0 }), [1.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }
}
