//! Reduction of bones for distant characters (thesis A sections 8.8 and 9.6). Bones collapse one by one into the
//! nearest kept bone above them. The next one is always the bone whose collapse displaces skinned vertices least. The
//! result is a complete [`Model`], which every pass accepts like the original.
//!
//! # What happens to a collapsed bone
//!
//! - **Its motion** is folded into the tracks of the kept bones below it. At all key times, these bones keep their
//!   model-space transforms up to rounding. Between keys, they stay within about a thousandth of the model's size (half
//!   the diagonal of its bounding box). Keys are added where linear interpolation would deviate more. If the collapsed
//!   bone does not move in a clip, the tracks keep their keys, interpolation and tangents.
//! - **Its vertices** follow the kept bone rigidly, at their rest positions relative to that bone. If two bones take a
//!   vertex to the same position, their influences are added up, so skins get fewer joints. If a skin was not bound at
//!   rest, its joints remain separate.
//!
//! A bone with non-uniform scale is kept as long as bones below it are kept. Otherwise, the bones below would be
//! sheared, which translation, rotation and scale cannot represent. Materials, images, morph targets, morph weights and
//! levels of detail do not change. Roots, bones that provide root motion, and the uppermost bones that a clip moves
//! never collapse.

mod bind;
mod choice;
mod compose;
mod measure;
mod rest;
mod tracks;

use crate::InputError;
use crate::asset::{Bone, Model, Skeleton};
use crate::skinning::pose::{Moment, moments_in, poses_of};
use choice::{Choice, Remap};
use rest::Rest;

/// The number of bones that [`collapse_bones`] keeps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeptBones {
    /// This number of bones, from 1 to the number of bones in the model.
    Count(usize),
    /// This fraction of the model's bones, above 0 and at most 1. The resulting number is rounded up.
    Fraction(f32),
}

impl KeptBones {
    fn count(self, bones: usize) -> Result<usize, InputError> {
        match self {
            Self::Count(count) => InputError::check_within("bones", count, 1..=bones).map(|()| count),
            Self::Fraction(part) if part > 0.0 && part <= 1.0 => {
                Ok((f64::from(part) * bones as f64).ceil() as usize)
            }
            Self::Fraction(part) => Err(InputError::new("bones", part, "must be above 0, and at most 1")),
        }
    }
}

/// Options of [`collapse_bones`]: the number of bones to keep, and the bones that never collapse.
#[derive(Debug, Clone, PartialEq)]
pub struct CollapseOptions {
    /// The number of bones to keep. The result has more bones if bones with non-uniform scale cannot collapse.
    pub bones: KeptBones,
    /// Names of bones that never collapse, such as bones with attached objects. A name keeps every bone with that name.
    pub keep: Vec<String>,
    /// Whether bones without children never collapse, such as the ends of fingers and feet (thesis A section 9.6.1).
    pub keep_end_effectors: bool,
}

impl CollapseOptions {
    /// Options that keep this number of bones, including all end effectors (bones without children).
    pub fn new(bones: KeptBones) -> Self {
        Self { bones, keep: Vec::new(), keep_end_effectors: true }
    }
}

/// The error of a model with collapsed bones, compared with the original, in the model's units.
///
/// Both models are sampled 60 times a second in every clip, start and end included, or at rest if there are no clips.
/// Vertices are blended linearly, with the clips' weights of morph targets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollapseError {
    /// The largest distance of a vertex from its position in the original.
    pub largest: f32,
    /// The root mean square of the distances of all vertices in all poses from their positions in the original.
    pub rms: f32,
    /// The largest distance of a kept bone's origin from its position in the original.
    pub kept_bones: f32,
}

/// A model with fewer bones, and its error.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapsed {
    /// The model with fewer bones. Its clips, skins, meshes, materials and images have the same number and order as in
    /// the original.
    pub model: Model,
    /// For each bone of the original, an index in [`Collapsed::model`]: the same bone if kept, else the bone it
    /// collapsed into.
    pub remap: Vec<u32>,
    /// The error compared with the original model.
    pub error: CollapseError,
}

/// Collapses bones of a model until the requested number is left.
///
/// Costs are measured in up to 64 evenly spaced poses of each clip. A bone's cost is the largest displacement of the
/// vertices that follow it, or follow bones that collapsed into it. The bone with the least cost collapses next. If
/// several collapses displace no vertex, as in models without clips, the bone whose vertices are nearest to its origin
/// goes first. The same model always gives the same result.
///
/// # Errors
/// [`InputError`] in these cases: the number of bones is out of range, or below the number of bones that never
/// collapse; a name belongs to no bone; a clip is longer than an hour; the parts of the model do not fit together.
pub fn collapse_bones(model: &Model, options: &CollapseOptions) -> Result<Collapsed, InputError> {
    validate(model)?;
    let count = options.bones.count(model.skeleton.len())?;
    let rest = Rest::new(model);
    let remap = Choice::new(model, options, &rest)?.collapsed_to(count)?;
    let skeleton = reduced(&model.skeleton, &remap)?;
    let clips = model.clips.iter().map(|clip| tracks::clip(model, clip, &remap, &skeleton, &rest));
    let clips = clips.collect::<Result<Vec<_>, InputError>>()?;
    let (skins, meshes) = bind::rebound(model, &remap, &rest)?;
    let collapsed = Model {
        skeleton,
        skins,
        clips,
        motion: None,
        meshes,
        skinned: model.skinned,
        materials: model.materials.clone(),
        images: model.images.clone(),
    };
    let error = measure::error(model, &collapsed, &remap.kept().collect::<Vec<_>>())?;
    Ok(Collapsed { model: collapsed, remap: remap.indices(), error })
}

/// The number of bones that never collapse. `options.bones` does not count.
pub(super) fn fewest_bones(model: &Model, options: &CollapseOptions) -> Result<usize, InputError> {
    Ok(choice::stays(model, options)?.iter().filter(|stays| **stays).count())
}

/// The largest distance of a vertex from its position in `model`, measured as for [`CollapseError`]. `reduced` has the same
/// meshes on another skeleton.
pub(super) fn vertex_error(model: &Model, reduced: &Model) -> Result<f32, InputError> {
    Ok(measure::error(model, reduced, &[])?.largest)
}

/// Moments of every clip: 60 per second, but at most `most` per clip.
fn looked_at(model: &Model, most: usize) -> Result<Vec<Moment>, InputError> {
    let mut moments = Vec::new();
    for (at, clip) in model.clips.iter().enumerate() {
        moments.extend(moments_in(at, poses_of(clip)?.min(most)));
    }
    Ok(moments)
}

fn validate(model: &Model) -> Result<(), InputError> {
    let bones = model.skeleton.len();
    for (at, clip) in model.clips.iter().enumerate() {
        let path = format!("clips[{at}].bones");
        InputError::check_same(path, clip.bones(), bones, "as the skeleton's")?;
    }
    (0..model.skins.len()).try_for_each(|skin| model.check_skin(skin))?;
    (0..model.meshes.len()).try_for_each(|mesh| model.check_mesh(mesh))
}

/// The skeleton of the kept bones. The parent of a bone is the nearest kept bone above it. If a joint collapsed, the
/// bone into which it collapsed becomes a joint.
fn reduced(skeleton: &Skeleton, remap: &Remap) -> Result<Skeleton, InputError> {
    let indices = remap.indices();
    let bone = |bone: usize| {
        let old = &skeleton.bones()[bone];
        let parent = old.parent.map(|parent| indices[parent as usize]);
        Bone { name: old.name.clone(), parent, rest: compose::rest(skeleton, &remap.chain(bone)) }
    };
    let bones: Vec<Bone> = remap.kept().map(bone).collect();
    let mut joints: Vec<u32> = Vec::new();
    for joint in skeleton.joints().iter().map(|joint| indices[*joint as usize]) {
        if !joints.contains(&joint) {
            joints.push(joint);
        }
    }
    Skeleton::new(bones, joints)
}
