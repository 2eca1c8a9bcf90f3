//! The error of a model with collapsed bones, compared with the original.

use glam::Vec3;

use super::{CollapseError, looked_at};
use crate::InputError;
use crate::asset::{Affine, Mesh, Model};
use crate::parallel;
use crate::skinning::pose::{Moment, Pose, bones_at, weights_at};

/// Distances in one pose: the largest of any bone, the largest of any vertex, and the sum of squares over all vertices.
#[derive(Default)]
struct Off {
    bones: f64,
    vertices: f64,
    squares: f64,
}

/// Compares both models 60 times a second in every clip, or at rest if there are no clips. `kept` are the bones of `model` that
/// `collapsed` has, in order.
pub(super) fn error(model: &Model, collapsed: &Model, kept: &[usize]) -> Result<CollapseError, InputError> {
    let mut moments = looked_at(model, usize::MAX)?;
    if moments.is_empty() {
        moments.push(Moment::Rest);
    }
    let off = parallel::map(&moments, |moment| off(model, collapsed, kept, *moment));
    let vertices: usize = model.meshes.iter().map(Mesh::vertices).sum();
    let squares: f64 = off.iter().map(|off| off.squares).sum();
    let largest = |of: fn(&Off) -> f64| off.iter().map(of).fold(0.0, f64::max) as f32;
    Ok(CollapseError {
        largest: largest(|off| off.vertices),
        rms: (squares / (vertices * off.len()).max(1) as f64).sqrt() as f32,
        kept_bones: largest(|off| off.bones),
    })
}

fn off(model: &Model, collapsed: &Model, kept: &[usize], moment: Moment) -> Off {
    let [before, after] = [model, collapsed].map(|model| bones_at(model, moment));
    let mut off = Off::default();
    for (bone, after) in kept.iter().zip(&after) {
        off.bones = off.bones.max(origin(&before[*bone]).distance(origin(after)).into());
    }
    for (full, reduced) in model.meshes.iter().zip(&collapsed.meshes) {
        let weights = weights_at(model, full, moment);
        let before = Pose::at(model, full, &before, &weights).positions(full);
        let after = Pose::at(collapsed, reduced, &after, &weights).positions(reduced);
        for (before, after) in before.into_iter().zip(after) {
            let square = before.as_dvec3().distance_squared(after.as_dvec3());
            off.vertices = off.vertices.max(square.sqrt());
            off.squares += square;
        }
    }
    off
}

fn origin(model: &Affine) -> Vec3 {
    Vec3::from(model.map(|row| row[3]))
}
