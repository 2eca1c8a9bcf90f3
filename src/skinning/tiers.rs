//! Skeleton tiers of a character (thesis A sections 8.8 and 9.6): the whole skeleton, and reduced skeletons for distant instances.
//! An instance uses the bones, clips and influences of one tier. The mesh and its levels of detail are the same in all tiers.
//!
//! Reduced skeletons are made by [`collapse_bones`](super::collapse_bones). The tiers are joined to one skeleton
//! ([`Skeleton::with_tier`]), so one crowd holds the bones of all tiers. Only the bones of an instance's tier are sampled.

use super::collapse::{CollapseOptions, KeptBones, collapse_bones, fewest_bones, vertex_error};
use super::motion_bounds::stray;
use crate::InputError;
use crate::asset::mesh::bone_radii;
use crate::asset::{Clip, Influence, Influences, Model, Skeleton, Skin};

/// The largest number of tiers, including the whole skeleton.
pub const MAX_TIERS: usize = crate::shared::lod::assign::MAX_TIERS as usize;

/// Factor by which a tier's measured error grows, for poses between the measured ones.
const MARGIN: f32 = 1.01;

/// A reduced skeleton of a character, for distant instances.
///
/// Bones collapse one by one into their parents, always the bone whose collapse displaces vertices least. End effectors (bones
/// without children) stay, unless the tier is rigid. The clips keep their key times.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SkeletonTier {
    /// Largest fraction of the character's bones to keep, above 0 and below 1. Bones that cannot collapse are kept beyond this
    /// fraction: roots, the uppermost bones that a clip moves, and end effectors.
    pub bones: f32,
    /// Whether each vertex follows one bone only (thesis A section 8.8, "geometric imposter"). The vertices of a bone are then one
    /// rigid part with one matrix.
    pub is_rigid: bool,
}

impl SkeletonTier {
    /// Three tiers: half of the bones, a quarter of them, and rigid parts for a tenth.
    pub const DEFAULT: [Self; 3] = [
        Self { bones: 0.5, is_rigid: false },
        Self { bones: 0.25, is_rigid: false },
        Self { bones: 0.1, is_rigid: true },
    ];

    /// Checks the tiers of a character.
    ///
    /// # Errors
    /// [`InputError`] for more than 3 tiers, for a fraction out of range, and for fractions that do not descend.
    pub fn check_all(tiers: &[Self]) -> Result<(), InputError> {
        InputError::check_most("tiers.len", tiers.len(), MAX_TIERS - 1)?;
        let mut most = 1.0;
        for (at, Self { bones, .. }) in tiers.iter().enumerate() {
            let bound = || format!("must be above 0, and below {most}");
            InputError::check(*bones > 0.0 && *bones < most, format!("tiers[{at}].bones"), bones, bound)?;
            most = *bones;
        }
        Ok(())
    }
}

/// The tiers of a model's skeleton, joined to one skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct Tiers {
    /// The bones of all tiers. The bones of tier 0 come first and keep their indices.
    pub skeleton: Skeleton,
    /// The model's clips, with tracks for the bones of all tiers.
    pub clips: Vec<Clip>,
    /// The model's skins, with the bones of all tiers. Those of tier 0 come first and keep their indices.
    pub skins: Vec<Skin>,
    /// For each mesh, the influences of its vertices on the bones of tiers 1, 2 ….
    pub reduced: Vec<Vec<Influences>>,
    /// Radius of each bone, as [`bone_radii`] gives it.
    pub bone_radii: Vec<f32>,
    /// Largest displacement of a vertex in each tier from its place in tier 0, in the model's units, ascending from 0.
    pub errors: Vec<f32>,
    /// Number of bones of each tier.
    pub bones: Vec<usize>,
    /// Number of bones of all skins in each tier.
    pub joints: Vec<usize>,
    /// Size of the keyframes of all clips in each tier, in bytes.
    pub keyframes: Vec<usize>,
    /// Largest displacement of a vertex per unit of influence fade, in any tier ([`Extent::stray`](super::Extent::stray)).
    pub stray: f32,
}

impl Tiers {
    /// Makes the tiers of a model. Errors are measured 60 times a second in every clip, or at rest if there are none. A tier is left
    /// out if a later one has a smaller error, or if its number of bones is that of the tier before and it is not rigid.
    ///
    /// # Errors
    /// [`InputError`] as [`SkeletonTier::check_all`], for a name in `keep` that belongs to no bone, and for models that
    /// [`collapse_bones`] refuses.
    pub fn new(model: &Model, tiers: &[SkeletonTier], keep: &[String]) -> Result<Self, InputError> {
        SkeletonTier::check_all(tiers)?;
        let mut found: Vec<(SkeletonTier, Model, f32)> = Vec::new();
        for tier in tiers {
            let reduced = reduced(model, *tier, keep)?;
            let error = MARGIN * vertex_error(model, &reduced)?;
            found.retain(|(_, _, other)| *other < error);
            found.push((*tier, reduced, error));
        }
        let mut all = Self::whole(model)?;
        for (tier, reduced, error) in &found {
            if tier.is_rigid || reduced.skeleton.len() < all.bones[all.bones.len() - 1] {
                all.add(reduced, *error)?;
            }
        }
        Ok(all)
    }

    fn whole(model: &Model) -> Result<Self, InputError> {
        Ok(Self {
            skeleton: model.skeleton.clone(),
            clips: model.clips.clone(),
            skins: model.skins.clone(),
            reduced: vec![Vec::new(); model.meshes.len()],
            bone_radii: radii(model),
            errors: vec![0.0],
            bones: vec![model.skeleton.len()],
            joints: vec![joints(model)],
            keyframes: vec![keyframes(model)],
            stray: stray(model)?,
        })
    }

    /// Appends a tier. `reduced` is the model with the tier's skeleton.
    fn add(&mut self, reduced: &Model, error: f32) -> Result<(), InputError> {
        let first = self.skeleton.len() as u32;
        for (mesh, own) in reduced.meshes.iter().zip(&mut self.reduced) {
            let first_joint = self.skins[mesh.skin].bones.len() as u32;
            let mut influences = Influences::default();
            influences.append(&mesh.influences, |joint| first_joint + joint);
            own.push(influences);
        }
        for (skin, added) in self.skins.iter_mut().zip(&reduced.skins) {
            skin.bones.extend(added.bones.iter().map(|bone| first + bone));
            skin.inverse_binds.extend(&added.inverse_binds);
        }
        self.skeleton = self.skeleton.with_tier(&reduced.skeleton)?;
        let clips = self.clips.iter().zip(&reduced.clips);
        self.clips = clips.map(|(clip, added)| clip.with_tier(added)).collect::<Result<_, _>>()?;
        self.bone_radii.extend(radii(reduced));
        self.errors.push(error);
        self.bones.push(reduced.skeleton.len());
        self.joints.push(joints(reduced));
        self.keyframes.push(keyframes(reduced));
        self.stray = self.stray.max(stray(reduced)?);
        Ok(())
    }
}

fn joints(model: &Model) -> usize {
    model.skins.iter().map(|skin| skin.bones.len()).sum()
}

fn keyframes(model: &Model) -> usize {
    model.clips.iter().map(Clip::bytes).sum()
}

fn radii(model: &Model) -> Vec<f32> {
    bone_radii(model.skeleton.len(), &model.skins, &model.meshes)
}

/// The model with the skeleton of a tier.
fn reduced(model: &Model, tier: SkeletonTier, keep: &[String]) -> Result<Model, InputError> {
    let options = CollapseOptions {
        bones: KeptBones::Fraction(tier.bones),
        keep: keep.to_vec(),
        keep_end_effectors: !tier.is_rigid,
    };
    let count = (f64::from(tier.bones) * model.skeleton.len() as f64).ceil() as usize;
    let bones = KeptBones::Count(count.max(fewest_bones(model, &options)?));
    let mut reduced = collapse_bones(model, &CollapseOptions { bones, ..options })?.model;
    if tier.is_rigid {
        for (at, mesh) in reduced.meshes.iter_mut().enumerate() {
            let strongest = |vertex| vec![Influence { weight: 1.0, ..mesh.influences.of(vertex)[0] }];
            let path = format!("meshes[{at}].influences");
            let joints = reduced.skins[mesh.skin].bones.len();
            mesh.influences = Influences::new(&path, joints, (0..mesh.vertices()).map(strongest))?;
        }
    }
    Ok(reduced)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animation::local_to_model::reference::local_to_model;
    use crate::animation::sample::reference::sample;
    use crate::asset::Mesh;
    use crate::asset::keyframe::RotationPath;
    use crate::skinning::InstanceLod;
    use crate::skinning::palette::Palette;
    use crate::skinning::palette::reference::palette;
    use crate::skinning::skin::reference::skin;
    use crate::skinning::vertex::vertices_of;

    fn positions(
        tiers: &Tiers,
        mesh: &Mesh,
        influences: &Influences,
        clip: usize,
        time: f32,
    ) -> Vec<glam::Vec3> {
        let locals = sample(&tiers.clips[clip], time, RotationPath::Slerp);
        let matrices = local_to_model(&tiers.skeleton, &locals);
        let palette = Palette::Linear(palette(&tiers.skins[mesh.skin], &matrices));
        let vertices = skin(&vertices_of(mesh), influences, &palette, InstanceLod::FULL);
        vertices.iter().map(|vertex| vertex.position.into()).collect()
    }

    /// In the joined skeleton, each tier displaces vertices by at most its error, and the errors are not far too large.
    #[test]
    fn tiers_stay_within_their_errors() {
        let model = crate::samples::creature().expect("valid");
        let tiers = Tiers::new(&model, &SkeletonTier::DEFAULT, &[]).expect("valid");
        // With all of its fingertips, a quarter of the bones displaces more than rigid parts do.
        assert_eq!((tiers.bones.len(), tiers.bones[0], tiers.bones[1]), (3, 153, 77));
        assert!(tiers.bones[2] < 24 && tiers.errors.is_sorted(), "{:?} {:?}", tiers.bones, tiers.errors);
        assert_eq!(tiers.skeleton.len(), tiers.bones.iter().sum::<usize>());
        assert_eq!((tiers.skeleton.tiers(), tiers.skeleton.tier_of(0)), (3, 0));
        assert_eq!(tiers.skeleton.tier_of(tiers.skeleton.len() as u32 - 1), 2);
        let mut largest = [0.0_f32; 3];
        for (clip, at) in (0..model.clips.len()).flat_map(|clip| (0..20).map(move |at| (clip, at))) {
            let time = model.clips[clip].duration() * at as f32 / 19.0;
            for (mesh, reduced) in model.meshes.iter().zip(&tiers.reduced) {
                let whole = positions(&tiers, mesh, &mesh.influences, clip, time);
                for (tier, influences) in (1..).zip(reduced) {
                    let moved = positions(&tiers, mesh, influences, clip, time);
                    let off = whole.iter().zip(&moved).map(|(a, b)| a.distance(*b));
                    largest[tier] = off.fold(largest[tier], f32::max);
                }
            }
        }
        for (found, error) in largest.iter().zip(&tiers.errors).skip(1) {
            assert!(*found <= *error && *found > 0.5 * error, "{largest:?} of {:?}", tiers.errors);
        }
        // The last tier is rigid.
        assert!(tiers.reduced.iter().all(|reduced| reduced[1].most() == 1));
    }

    #[test]
    fn bad_tiers_are_refused() {
        let model = crate::samples::creature().expect("valid");
        let tier = |bones: f32| SkeletonTier { bones, is_rigid: false };
        let refused = |tiers: &[SkeletonTier]| Tiers::new(&model, tiers, &[]).expect_err("refused").path;
        assert_eq!(refused(&[tier(1.0)]), "tiers[0].bones");
        assert_eq!(refused(&[tier(0.5), tier(0.5)]), "tiers[1].bones");
        assert_eq!(refused(&[tier(f32::NAN)]), "tiers[0].bones");
        assert_eq!(refused(&[0.5, 0.4, 0.3, 0.2].map(tier)), "tiers.len");
        let keep = ["nobody".to_owned()];
        assert_eq!(Tiers::new(&model, &[tier(0.5)], &keep).expect_err("refused").path, "keep[0]");
    }
}
