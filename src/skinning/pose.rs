//! A mesh at moments of clips, blended linearly: what load-time steps look at.

use glam::Vec3;

use crate::InputError;
use crate::animation::concat::reference::concat;
use crate::animation::sample::reference::sample;
use crate::asset::Model;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::Affine;
use crate::asset::{Influence, Mesh};
use crate::skinning::morph::reference::morph;
use crate::skinning::palette::reference::palette;
use crate::skinning::skin::reference::transformed;
use crate::skinning::vertex::Vertex;

/// A mesh at a moment.
pub(super) struct Pose {
    palette: Vec<Affine>,
    vertices: Vec<Vertex>,
}

/// `poses` moments of each clip, evenly spaced from start to end: the clip, and the share of its duration.
///
/// # Errors
/// [`InputError`] for a mesh or clips that the model lacks, none of these, no poses, and a mesh that does not fit its
/// skin.
pub(super) fn moments(
    model: &Model,
    mesh: usize,
    clips: &[usize],
    poses: usize,
) -> Result<Vec<(usize, f32)>, InputError> {
    let Some(mesh) = model.meshes.get(mesh) else {
        return Err(InputError::new("mesh", mesh, format!("must be below {}", model.meshes.len())));
    };
    for (field, len) in [("clips.len", clips.len()), ("poses", poses)] {
        if len == 0 {
            return Err(InputError::new(field, 0, "must be at least 1, to see what vertices do"));
        }
    }
    if let Some(at) = clips.iter().position(|clip| *clip >= model.clips.len()) {
        let bound = format!("must be below {}", model.clips.len());
        return Err(InputError::new(format!("clips[{at}]"), clips[at], bound));
    }
    mesh.validate(&model.skins)?;
    model.skins[mesh.skin].validate(&model.skeleton)?;
    let share = |at: usize| at as f32 / (poses - 1).max(1) as f32;
    Ok(clips.iter().flat_map(|clip| (0..poses).map(move |at| (*clip, share(at)))).collect())
}

impl Pose {
    /// `share` of the clip's duration after its start.
    pub(super) fn new(model: &Model, mesh: &Mesh, (clip, share): (usize, f32)) -> Self {
        let time = share * model.clips[clip].duration();
        let models = concat(&model.skeleton, &sample(&model.clips[clip], time, RotationPath::Slerp));
        Self {
            palette: palette(&model.skins[mesh.skin], &models),
            vertices: morph(mesh, &mesh.weights_at(clip, time)),
        }
    }

    /// Where each of a vertex's bones alone would have it.
    pub(super) fn places(&self, vertex: usize, influences: &[Influence]) -> Vec<Vec3> {
        let place = |influence: &Influence| {
            let bone = &self.palette[influence.bone as usize];
            Vec3::from(transformed(&self.vertices[vertex], bone).position)
        };
        influences.iter().map(place).collect()
    }

    /// Where all vertices are.
    pub(super) fn positions(&self, mesh: &Mesh) -> Vec<Vec3> {
        let position = |vertex: usize| {
            let influences = mesh.influences.of(vertex);
            mean(influences, &self.places(vertex, influences))
        };
        (0..self.vertices.len()).map(position).collect()
    }
}

pub(super) fn mean(influences: &[Influence], places: &[Vec3]) -> Vec3 {
    influences.iter().zip(places).map(|(influence, place)| influence.weight * *place).sum()
}
