//! Fewer bones for characters that are far away (A sections 8.8 and 9.6): bones collapse one by one into the nearest
//! bone above them that is kept, first those whose collapse moves skinned vertices least. The result is a whole
//! [`Model`], which every pass takes as it takes the original.
//!
//! # What becomes of a collapsed bone
//!
//! - **Its motion** is folded into the tracks of the kept bones below it. These are where they were: at all key times
//!   within rounding; between keys within about a thousandth of the model's size (half of the diagonal of a box around it),
//!   since keys are added where linear interpolation would be further off. Where the collapsed bone does not move in a
//!   clip, the tracks keep their keys, their interpolation and their tangents.
//! - **Its vertices** follow the kept bone, as they do at rest. Influences of bones that take a vertex to the same place
//!   are added up, so skins get fewer joints; where a skin was not bound at rest, joints stay apart.
//!
//! A bone that scales unevenly stays while bones below it are kept: a translation, rotation and scale of these could not
//! hold the shear. Materials, images, morph targets and their weights, and levels of detail stay as they are. So does
//! what root motion is taken from: roots, and the uppermost bones that a clip moves, never collapse.

mod bind;
mod choice;
mod compose;
mod measure;
mod rest;
mod tracks;

use crate::InputError;
use crate::asset::{Bone, Model, Skeleton};
use choice::{Choice, Remap};
use rest::Rest;

/// How many bones [`collapse_bones`] leaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeptBones {
    /// So many, 1 to all.
    Count(usize),
    /// This part of all, above 0 to 1; rounded up.
    Fraction(f32),
}

impl KeptBones {
    fn count(self, bones: usize) -> Result<usize, InputError> {
        match self {
            Self::Count(count) if (1..=bones).contains(&count) => Ok(count),
            Self::Count(count) => Err(InputError::new("bones", count, format!("must be in 1..={bones}"))),
            Self::Fraction(part) if part > 0.0 && part <= 1.0 => {
                Ok((f64::from(part) * bones as f64).ceil() as usize)
            }
            Self::Fraction(part) => Err(InputError::new("bones", part, "must be above 0, and at most 1")),
        }
    }
}

/// What [`collapse_bones`] does.
#[derive(Debug, Clone, PartialEq)]
pub struct CollapseOptions {
    /// How many bones are left; more, where bones that scale unevenly stay.
    pub bones: KeptBones,
    /// Names of bones that stay, every bone of a name: those that things are attached to, for instance.
    pub keep: Vec<String>,
    /// Whether bones without children stay, the ends of fingers and feet (A section 9.6.1).
    pub keep_end_effectors: bool,
}

impl CollapseOptions {
    /// So many bones; end effectors stay.
    pub fn new(bones: KeptBones) -> Self {
        Self { bones, keep: Vec::new(), keep_end_effectors: true }
    }
}

/// How far a collapsed model is off, in the model's units: in every clip 60 times a second, its start and its end
/// included; at rest, where there are no clips. Blended linearly, with the weights of morph targets that the clips have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollapseError {
    /// The largest distance of a vertex from where the original has it.
    pub largest: f32,
    /// The root of the mean of the squares of the distances, over all vertices in all poses.
    pub rms: f32,
    /// The largest distance of a kept bone's origin from where the original has it.
    pub kept_bones: f32,
}

/// A model of fewer bones.
#[derive(Debug, Clone, PartialEq)]
pub struct Collapsed {
    /// The model. Its clips, skins, meshes, materials and images are as many as the original's, in the same order.
    pub model: Model,
    /// For each bone of the original the bone of [`Collapsed::model`] that it became, or that it collapsed into.
    pub remap: Vec<u32>,
    /// How far it is off.
    pub error: CollapseError,
}

/// A model with fewer bones.
///
/// Which bones collapse is decided in up to 64 poses of each clip, evenly spaced: always the bone whose vertices,
/// together with those of bones that collapsed into it, stray least from where they should be, at the one that strays
/// most. Of bones whose collapse is not seen, as in models without clips, those go first whose vertices lie nearest to
/// their origin. The same model gives the same result.
///
/// # Errors
/// [`InputError`] for a number of bones out of range, or below that of bones that stay, names that no bone has, clips longer than an hour, and a model
/// whose parts do not fit.
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

fn validate(model: &Model) -> Result<(), InputError> {
    let bones = model.skeleton.len();
    if let Some(at) = model.clips.iter().position(|clip| clip.bones() != bones) {
        let bound = format!("must be {bones}, as the skeleton's");
        return Err(InputError::new(format!("clips[{at}].bones"), model.clips[at].bones(), bound));
    }
    model.skins.iter().try_for_each(|skin| skin.validate(&model.skeleton))?;
    model.meshes.iter().try_for_each(|mesh| mesh.validate(&model.skins))
}

/// The kept bones, each below the nearest kept bone above it. A joint that collapsed makes that bone a joint.
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
