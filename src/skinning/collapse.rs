//! Fewer bones for distant characters (A sections 8.8 and 9.6). Bones collapse one by one into the nearest kept bone
//! above them; the bone whose collapse moves skinned vertices least goes first. The result is a complete [`Model`],
//! which every pass accepts like the original.
//!
//! # What becomes of a collapsed bone
//!
//! - **Its motion** is folded into the tracks of the kept bones below it. These keep their model-space transforms:
//!   within rounding at all key times, and between keys within about a thousandth of the model's size (half the
//!   diagonal of its bounding box). Keys are added where linear interpolation would be further off. If the collapsed
//!   bone does not move in a clip, the tracks keep their keys, their interpolation and their tangents.
//! - **Its vertices** follow the kept bone, rigidly as at rest. If two bones take a vertex to the same position, their
//!   influences are added up, so skins get fewer joints. If a skin was not bound at rest, its joints remain separate.
//!
//! A bone with non-uniform scale is kept as long as bones below it are kept: their translation, rotation and scale
//! could not represent the shear. Materials, images, morph targets and their weights, and levels of detail do not
//! change. Bones that provide root motion, roots, and the uppermost bones that a clip moves never collapse.

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

/// The number of bones that [`collapse_bones`] leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeptBones {
    /// This number of bones, from 1 to the model's.
    Count(usize),
    /// This fraction of the model's bones, above 0 and up to 1; rounded up.
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

/// Options of [`collapse_bones`]: how many bones it leaves, and which of them never collapse.
#[derive(Debug, Clone, PartialEq)]
pub struct CollapseOptions {
    /// The number of bones left. It is exceeded if bones with non-uniform scale must be kept.
    pub bones: KeptBones,
    /// Names of bones to keep, such as those that objects are attached to. A name keeps every bone with that name.
    pub keep: Vec<String>,
    /// Whether bones without children, such as the ends of fingers and feet, are kept (A section 9.6.1).
    pub keep_end_effectors: bool,
}

impl CollapseOptions {
    /// Leaves this number of bones, and keeps end effectors.
    pub fn new(bones: KeptBones) -> Self {
        Self { bones, keep: Vec::new(), keep_end_effectors: true }
    }
}

/// The error of a collapsed model against the original, in the model's units.
///
/// Both are sampled 60 times a second in every clip, start and end included, or at rest if there are no clips. Vertices
/// are blended linearly, with the clips' weights of morph targets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollapseError {
    /// The largest distance of a vertex from its position in the original.
    pub largest: f32,
    /// The root mean square of these distances, over all vertices in all poses.
    pub rms: f32,
    /// The largest distance of a kept bone's origin from its position in the original.
    pub kept_bones: f32,
}

/// A model with fewer bones, and its error.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapsed {
    /// The model. Clips, skins, meshes, materials and images have the same number and order as the original's.
    pub model: Model,
    /// For each bone of the original, the index in [`Collapsed::model`] of the bone that it became or collapsed into.
    pub remap: Vec<u32>,
    /// The error of the model against the original.
    pub error: CollapseError,
}

/// Collapses bones of a model.
///
/// Costs are measured in up to 64 poses of each clip, evenly spaced. A bone's cost is the largest displacement of its
/// vertices, or of the vertices of bones that collapsed into it. The bone with the least cost collapses next. If
/// several collapses displace no vertex, as in models without clips, the bone whose vertices lie nearest to its origin
/// goes first. The same model gives the same result.
///
/// # Errors
/// [`InputError`] for a number of bones out of range or below the number of bones that are kept, names that no bone
/// has, clips longer than an hour, and a model whose parts do not fit together.
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
        meshes,
        skinned: model.skinned,
        materials: model.materials.clone(),
        images: model.images.clone(),
    };
    let error = measure::error(model, &collapsed, &remap)?;
    Ok(Collapsed { model: collapsed, remap: remap.indices(), error })
}

/// Moments of every clip, 60 a second, but at most `most` per clip.
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

/// The skeleton of the kept bones, each below the nearest kept bone above it. If a joint collapsed, the bone that
/// received it becomes a joint.
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
