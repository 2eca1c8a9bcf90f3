//! Poses of a mesh, at rest and at moments of clips, on the CPU with linear blending. Used for computations at load time.

use glam::Vec3;

use super::InstanceLod;
use super::palette::Palette;
use crate::InputError;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::sample::reference::sample;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::{Affine, Transform};
use crate::asset::{Clip, Model};
use crate::asset::{Influence, Mesh};
use crate::skinning::morph::reference::morph;
use crate::skinning::palette::reference::palette;
use crate::skinning::skin::reference::skin;
use crate::skinning::vertex::Vertex;

/// Poses per second at which [`MeshLevels`](super::MeshLevels) and [`Extent`](super::Extent) sample a clip. This is
/// enough to follow motion.
const POSES_A_SECOND: f32 = 60.0;

/// The longest clip that [`poses_of`] accepts, in seconds: one hour, which is 216,001 poses at 60 per second.
pub const LONGEST_LOOK: f32 = 3600.0;

/// The largest number of sampled poses per clip: 60 per second for a clip of [`LONGEST_LOOK`].
const MOST_POSES: usize = 216_001;

/// The number of poses at which to sample a clip for [`MeshLevels`](super::MeshLevels) and [`Extent`](super::Extent).
/// It gives 60 poses per second, start and end included; at least 2.
///
/// # Errors
/// [`InputError`] for a clip of more than an hour.
pub fn poses_of(clip: &Clip) -> Result<usize, InputError> {
    let seconds = clip.duration();
    if seconds > LONGEST_LOOK {
        let bound = format!("must be at most {LONGEST_LOOK} s for a look at {POSES_A_SECOND} poses a second");
        return Err(InputError::new("clip.duration", seconds, bound));
    }
    Ok((POSES_A_SECOND * seconds).max(1.0).ceil() as usize + 1)
}

/// A mesh posed at one moment: its bone transforms, and its vertices after morphing.
pub(super) struct Pose {
    palette: Vec<Affine>,
    vertices: Vec<Vertex>,
}

/// A moment at which a mesh is sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Moment {
    /// The rest pose, without a clip.
    Rest,
    /// Index of a clip, and the moment in it as a fraction of its duration, from 0 to 1.
    In(usize, f32),
}

/// `poses` moments of each clip, evenly spaced from start to end; the rest pose if there are no clips.
///
/// # Errors
/// [`InputError`] in these cases: the model does not have the mesh or a clip; `poses` is 0 or exceeds the limit of the
/// longest clip; the mesh does not match its skin.
pub(super) fn moments(
    model: &Model,
    mesh: usize,
    clips: &[usize],
    poses: usize,
) -> Result<Vec<Moment>, InputError> {
    InputError::check_below("mesh", mesh, model.meshes.len())?;
    let mesh = &model.meshes[mesh];
    InputError::check(poses != 0, "poses", 0, || "must be at least 1, to see what vertices do")?;
    if poses > MOST_POSES && !clips.is_empty() {
        return Err(InputError::new("poses", poses, format!("must be at most {MOST_POSES}")));
    }
    if let Some(at) = clips.iter().position(|clip| *clip >= model.clips.len()) {
        let bound = match model.clips.len() {
            0 => "must not be given: the model has no clips".to_owned(),
            count => format!("must be below {count}"),
        };
        return Err(InputError::new(format!("clips[{at}]"), clips[at], bound));
    }
    mesh.validate(&model.skins)?;
    model.skins[mesh.skin].validate(&model.skeleton)?;
    if clips.is_empty() {
        return Ok(vec![Moment::Rest]);
    }
    Ok(clips.iter().flat_map(|clip| moments_in(*clip, poses)).collect())
}

/// `poses` moments of a clip, evenly spaced from start to end.
pub(super) fn moments_in(clip: usize, poses: usize) -> impl Iterator<Item = Moment> {
    (0..poses).map(move |at| Moment::In(clip, at as f32 / (poses - 1).max(1) as f32))
}

/// The model-space matrices of all bones at a moment.
pub(super) fn bones_at(model: &Model, moment: Moment) -> Vec<Affine> {
    let locals: Vec<Transform> = match moment {
        Moment::Rest => model.skeleton.rest(),
        Moment::In(clip, fraction) => {
            let clip = &model.clips[clip];
            sample(clip, fraction * clip.duration(), RotationPath::Slerp)
        }
    };
    local_to_model(&model.skeleton, &locals)
}

/// The weights of a mesh's morph targets at a moment.
pub(super) fn weights_at(model: &Model, mesh: &Mesh, moment: Moment) -> Vec<f32> {
    match moment {
        Moment::Rest => mesh.weights.clone(),
        Moment::In(clip, fraction) => mesh.weights_at(clip, fraction * model.clips[clip].duration()),
    }
}

/// The positions of some vertices of a mesh at a moment. `vertices` are their indices. `bones` holds the bones'
/// model-space matrices at that moment. The positions equal those from [`Pose::positions`].
pub(super) fn positions_of(
    model: &Model,
    mesh: &Mesh,
    moment: Moment,
    bones: &[Affine],
    vertices: &[u32],
) -> Vec<Vec3> {
    if mesh.targets.is_empty() {
        let palette = palette(&model.skins[mesh.skin], bones);
        let position = |vertex: &u32| {
            let at = *vertex as usize;
            blended(&palette, mesh.positions[at], mesh.influences.of(at))
        };
        return vertices.iter().map(position).collect();
    }
    let pose = Pose::at(model, mesh, bones, &weights_at(model, mesh, moment));
    vertices.iter().map(|vertex| pose.position(mesh, *vertex as usize)).collect()
}

/// A position, transformed by the weighted mean of several bones.
fn blended(palette: &[Affine], position: [f32; 3], influences: &[Influence]) -> Vec3 {
    influences.iter().map(|influence| influence.weight * moved(palette, position, influence)).sum()
}

/// A position, transformed by one bone.
fn moved(palette: &[Affine], [x, y, z]: [f32; 3], influence: &Influence) -> Vec3 {
    let along = |row: &[f32; 4]| row[0] * x + row[1] * y + row[2] * z + row[3];
    Vec3::from(palette[influence.bone as usize].each_ref().map(along))
}

impl Pose {
    pub(super) fn new(model: &Model, mesh: &Mesh, moment: Moment) -> Self {
        Self::at(model, mesh, &bones_at(model, moment), &weights_at(model, mesh, moment))
    }

    /// The pose in which the bones have the model-space matrices `models` and the morph targets have the weights
    /// `weights`.
    pub(super) fn at(model: &Model, mesh: &Mesh, models: &[Affine], weights: &[f32]) -> Self {
        Self { palette: palette(&model.skins[mesh.skin], models), vertices: morph(mesh, weights) }
    }

    /// For each bone of a vertex, the position that the vertex would have if it followed only this bone.
    pub(super) fn points(&self, vertex: usize, influences: &[Influence]) -> Vec<Vec3> {
        let position = self.vertices[vertex].position;
        influences.iter().map(|influence| moved(&self.palette, position, influence)).collect()
    }

    fn position(&self, mesh: &Mesh, vertex: usize) -> Vec3 {
        blended(&self.palette, self.vertices[vertex].position, mesh.influences.of(vertex))
    }

    /// The positions of all vertices.
    pub(super) fn positions(&self, mesh: &Mesh) -> Vec<Vec3> {
        (0..self.vertices.len()).map(|vertex| self.position(mesh, vertex)).collect()
    }

    /// All skinned vertices, in the model's space.
    pub(super) fn vertices(self, mesh: &Mesh) -> Vec<Vertex> {
        skin(&self.vertices, &mesh.influences, &Palette::Linear(self.palette), InstanceLod::FULL)
    }

    /// The normals of all skinned vertices: unit vectors, or 0.
    pub(super) fn normals(self, mesh: &Mesh) -> Vec<[f32; 3]> {
        self.vertices(mesh).into_iter().map(|vertex| vertex.normal).collect()
    }
}

pub(super) fn mean(influences: &[Influence], points: &[Vec3]) -> Vec3 {
    influences.iter().zip(points).map(|(influence, point)| influence.weight * *point).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::clip::BoneKeys;
    use crate::asset::skeleton::{Bone, Skeleton};

    #[test]
    fn clips_are_looked_at_60_times_a_second() {
        let rest = Transform::IDENTITY;
        let bone = Bone { name: String::new(), parent: None, rest };
        let skeleton = Skeleton::of_joints(vec![bone]).expect("valid");
        let poses = |seconds: f32| {
            let clip = Clip::new("", &skeleton, &[BoneKeys::default()], seconds).expect("valid");
            poses_of(&clip)
        };
        assert_eq!([0.0, 0.01, 1.0, 1.01].map(poses), [2, 2, 61, 62].map(Ok));
        // Every clip up to the limit gives a number of poses. Only longer clips are refused.
        assert_eq!([16.75, 60.0, 3600.0].map(poses), [1006, 3601, 216_001].map(Ok));
        assert_eq!(poses(3601.0).expect_err("refused").path, "clip.duration");
    }

    #[test]
    fn models_without_clips_are_looked_at_at_rest() {
        let model = crate::samples::creature().expect("valid");
        assert_eq!(moments(&model, 0, &[], 9), Ok(vec![Moment::Rest]));
        let mesh = &model.meshes[0];
        // The bind pose of the mesh is its rest pose.
        let points = Pose::new(&model, mesh, Moment::Rest).positions(mesh);
        let off = points.iter().zip(&mesh.positions).map(|(a, b)| a.distance(Vec3::from(*b)));
        assert!(off.fold(0.0, f32::max) < 1e-5);
    }
}
