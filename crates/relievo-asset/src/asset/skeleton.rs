//! Skeletons: bones in topological order with their rest pose, and the skins that are bound to them.

use serde::{Deserialize, Serialize};

use super::transform::{Transform, finite};
use crate::InputError;

/// Largest allowed number of bones of a skeleton.
pub const MAX_BONES: usize = 1 << 20;

/// A bone: a node of the skeleton.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bone {
    /// The bone's name in the file; names need not be unique.
    pub name: String,
    /// Index of the parent bone, smaller than the bone's own index; `None` for a root.
    pub parent: Option<u32>,
    /// Transform relative to the parent when no clip moves the bone.
    pub rest: Transform,
}

impl Bone {
    /// Largest absolute scale along any axis in the rest pose; 1 if all scales are 0.
    #[doc(hidden)]
    pub fn scale(&self) -> f64 {
        let largest = self.rest.scale.iter().fold(0.0_f32, |largest, scale| largest.max(scale.abs()));
        if largest > 0.0 { largest.into() } else { 1.0 }
    }
}

/// Bones, ordered so that every parent comes before its children. An ancestor of a joint is also a bone, even if no skin uses
/// it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredSkeleton", into = "StoredSkeleton")]
pub struct Skeleton {
    bones: Vec<Bone>,
    joints: Vec<u32>,
    depths: Vec<u32>,
    descendants: Vec<u32>,
    /// Index of the first bone of each tier, ascending from 0. See [`Skeleton::with_tier`].
    tiers: Vec<u32>,
}

/// Largest allowed difference between the length of a stored rotation and 1.
const OFF_UNIT: f32 = 1e-5;

/// Stored form of a skeleton: bones and joints, from which everything else is computed.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Skeleton")]
struct StoredSkeleton {
    bones: Vec<Bone>,
    joints: Vec<u32>,
}

impl From<Skeleton> for StoredSkeleton {
    fn from(Skeleton { bones, joints, .. }: Skeleton) -> Self {
        Self { bones, joints }
    }
}

impl TryFrom<StoredSkeleton> for Skeleton {
    type Error = InputError;

    /// Builds the skeleton like [`Skeleton::new`], but rotations keep their bits. The length of each rotation must be 1, up to
    /// rounding.
    fn try_from(StoredSkeleton { bones, joints }: StoredSkeleton) -> Result<Self, InputError> {
        let checked = Self::new(bones.clone(), joints)?;
        for (at, bone) in bones.iter().enumerate() {
            let length = glam::Quat::from_array(bone.rest.rotation).length();
            if (length - 1.0).abs() > OFF_UNIT {
                let bound = format!("must be a unit quaternion; its length is {length}");
                let value = format!("{:?}", bone.rest.rotation);
                return Err(InputError::new(format!("bones[{at}].rest.rotation"), value, bound));
            }
        }
        Ok(Self { bones, ..checked })
    }
}

impl Skeleton {
    /// Builds a skeleton of `bones`. `joints` are the indices of the bones that skins use; [`Skeleton::joints`] keeps their
    /// order.
    ///
    /// # Errors
    /// [`InputError`] for no or too many bones, and for a parent that does not come before its child. Also for a rest pose that
    /// is not finite or whose rotation has no direction, and for joints that are not bones or are named twice.
    pub fn new(mut bones: Vec<Bone>, joints: Vec<u32>) -> Result<Self, InputError> {
        InputError::check_within("bones.len", bones.len(), 1..=MAX_BONES)?;
        for (index, bone) in bones.iter_mut().enumerate() {
            if let Some(parent) = bone.parent.filter(|parent| *parent as usize >= index) {
                let bound = format!("must be below {index}: parents come before their children");
                return Err(InputError::new(format!("bones[{index}].parent"), parent, bound));
            }
            bone.rest = bone.rest.checked(&format!("bones[{index}].rest"))?;
        }
        let mut seen = vec![false; bones.len()];
        for (at, joint) in joints.iter().enumerate() {
            match seen.get_mut(*joint as usize) {
                Some(seen) if !*seen => *seen = true,
                _ => {
                    let bound = format!("must be a bone below {}, named once", bones.len());
                    return Err(InputError::new(format!("joints[{at}]"), joint, bound));
                }
            }
        }
        let depths = depths(&bones);
        let descendants = descendants(&bones);
        Ok(Self { bones, joints, depths, descendants, tiers: vec![0] })
    }

    /// Builds a skeleton whose bones are all joints.
    ///
    /// # Errors
    /// The errors of [`Skeleton::new`].
    pub fn of_joints(bones: Vec<Bone>) -> Result<Self, InputError> {
        let joints = (0..bones.len() as u32).collect();
        Self::new(bones, joints)
    }

    /// Appends the bones of another skeleton as one more tier. No bone has a parent in another tier. Gates sample the bones of one
    /// tier per instance.
    ///
    /// # Errors
    /// [`InputError`] for too many bones or more than 255 tiers in total.
    pub fn with_tier(&self, other: &Self) -> Result<Self, InputError> {
        InputError::check_most("tiers.len", self.tiers.len() + other.tiers.len(), 255)?;
        let first = self.bones.len() as u32;
        let moved = |bone: &Bone| Bone { parent: bone.parent.map(|parent| parent + first), ..bone.clone() };
        let bones = self.bones.iter().cloned().chain(other.bones.iter().map(moved)).collect();
        let moved = |bones: &[u32]| bones.iter().map(|bone| first + bone).collect::<Vec<_>>();
        let joints = [self.joints.clone(), moved(&other.joints)].concat();
        Ok(Self { tiers: [self.tiers.clone(), moved(&other.tiers)].concat(), ..Self::new(bones, joints)? })
    }

    /// Number of tiers: 1, and one more for each [`Skeleton::with_tier`].
    pub fn tiers(&self) -> usize {
        self.tiers.len()
    }

    /// Index of the tier that a bone belongs to.
    pub fn tier_of(&self, bone: u32) -> usize {
        self.tiers.partition_point(|first| *first <= bone) - 1
    }

    /// The bones; every parent comes before its children.
    pub fn bones(&self) -> &[Bone] {
        &self.bones
    }

    /// Number of bones.
    pub fn len(&self) -> usize {
        self.bones.len()
    }

    /// Always false: a skeleton has at least one bone.
    pub fn is_empty(&self) -> bool {
        self.bones.is_empty()
    }

    /// Indices of the bones that skins use, each once, in the order of the file. All bones if the file has no skins.
    pub fn joints(&self) -> &[u32] {
        &self.joints
    }

    /// For each bone, the number of steps up to its root; 0 for a root.
    pub fn depths(&self) -> &[u32] {
        &self.depths
    }

    /// For each bone, the number of bones below it in the hierarchy.
    pub fn descendants(&self) -> &[u32] {
        &self.descendants
    }

    /// The rest transform of every bone, relative to its parent.
    pub fn rest(&self) -> Vec<Transform> {
        self.bones.iter().map(|bone| bone.rest).collect()
    }

    /// For each bone, an upper bound on the scale from the parent's space to model space at rest: the product of the largest
    /// scale of each ancestor. An ancestor whose scales are all 0 counts as 1.
    #[doc(hidden)]
    pub fn scales_above(&self) -> Vec<f64> {
        let mut above = Vec::with_capacity(self.bones.len());
        for bone in &self.bones {
            let scale = |parent: u32| above[parent as usize] * self.bones[parent as usize].scale();
            above.push(bone.parent.map_or(1.0, scale));
        }
        above
    }

    /// Length of each bone at rest, in the bone's own units: the distance to its farthest child, or to its parent if it has no
    /// child.
    pub fn lengths(&self) -> Vec<f64> {
        let reach = |bone: &Bone| glam::DVec3::from(bone.rest.translation.map(f64::from)).length();
        let mut lengths = vec![0.0_f64; self.bones.len()];
        for bone in &self.bones {
            if let Some(parent) = bone.parent {
                let length = &mut lengths[parent as usize];
                *length = length.max(reach(bone));
            }
        }
        for (length, bone) in lengths.iter_mut().zip(&self.bones) {
            if *length == 0.0 {
                *length = reach(bone) / bone.scale();
            }
        }
        lengths
    }

    /// For each joint in [`Skeleton::joints`], the nearest ancestor that is also a joint, as an index into the same list.
    pub fn joint_parents(&self) -> Vec<Option<u32>> {
        let mut place = vec![None; self.bones.len()];
        for (joint, at) in self.joints.iter().zip(0..) {
            place[*joint as usize] = Some(at);
        }
        let above = |joint: &u32| {
            let parent = |bone: u32| self.bones[bone as usize].parent;
            std::iter::successors(parent(*joint), |bone| parent(*bone)).find_map(|bone| place[bone as usize])
        };
        self.joints.iter().map(above).collect()
    }
}

fn depths(bones: &[Bone]) -> Vec<u32> {
    let mut depths: Vec<u32> = Vec::with_capacity(bones.len());
    for bone in bones {
        depths.push(bone.parent.map_or(0, |parent| depths[parent as usize] + 1));
    }
    depths
}

fn descendants(bones: &[Bone]) -> Vec<u32> {
    let mut descendants = vec![0; bones.len()];
    for (index, bone) in bones.iter().enumerate().rev() {
        if let Some(parent) = bone.parent {
            descendants[parent as usize] += descendants[index] + 1;
        }
    }
    descendants
}

/// A skin: the bones that vertices follow, with one inverse bind matrix per bone.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Skin {
    /// The skin's name in the file.
    pub name: String,
    /// Indices of bones in the skeleton. Influences of vertices refer to positions in this list.
    pub bones: Vec<u32>,
    /// One column-major matrix per bone. It transforms from the mesh's space to the bone's space in the bind pose.
    pub inverse_binds: Vec<[f32; 16]>,
}

impl Skin {
    /// Checks that the skin matches a skeleton.
    ///
    /// # Errors
    /// [`InputError`] for bones that the skeleton does not have, for a number of matrices that is not one per
    /// bone, and for matrices that are not finite or not affine.
    pub fn validate(&self, skeleton: &Skeleton) -> Result<(), InputError> {
        let bones = skeleton.len();
        let bound = format!("must be below {bones}");
        InputError::check_each("skin.bones", &self.bones, |bone| (*bone as usize) < bones, bound)?;
        InputError::check_len("skin.inverse_binds", self.inverse_binds.len(), self.bones.len(), "a bone")?;
        for (at, matrix) in self.inverse_binds.iter().enumerate() {
            inverse_bind(&format!("skin.inverse_binds[{at}]"), matrix)?;
        }
        Ok(())
    }
}

/// Refuses a matrix that is not finite or not affine.
#[doc(hidden)]
pub fn inverse_bind(path: &str, matrix: &[f32; 16]) -> Result<(), InputError> {
    finite(path, matrix)?;
    // Exporters write the last row with rounding errors, so a deviation of 1e-4 is allowed.
    let row = [3, 7, 11, 15].map(|index| matrix[index]);
    let error = row.iter().zip([0.0, 0.0, 0.0, 1.0]).map(|(value, wanted)| (value - wanted).abs());
    if error.fold(0.0, f32::max) > 1e-4 {
        return Err(InputError::new(path, format!("{row:?}"), "must have 0 0 0 1 as its last row"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bone(parent: Option<u32>) -> Bone {
        Bone { name: String::new(), parent, rest: Transform::IDENTITY }
    }

    #[test]
    fn depths_descendants_and_parents_are_counted() {
        // Bone 0 has child 1, bone 1 has children 2 and 3, bone 2 has child 4. Bone 5 stands alone.
        let parents = [None, Some(0), Some(1), Some(1), Some(2), None];
        let bones = parents.map(bone).to_vec();
        let skeleton = Skeleton::new(bones, vec![4, 1, 5]).expect("valid");
        assert_eq!(skeleton.depths(), [0, 1, 2, 2, 3, 0]);
        assert_eq!(skeleton.descendants(), [4, 3, 1, 0, 0, 0]);
        assert_eq!(skeleton.joint_parents(), [Some(1), None, None]);
    }

    #[test]
    fn what_is_no_skeleton_is_refused() {
        let refused = |bones: Vec<Bone>, joints: Vec<u32>| {
            let error = Skeleton::new(bones, joints).expect_err("refused");
            (error.path, error.value)
        };
        let text = |field: &str, value: &str| (field.to_owned(), value.to_owned());
        assert_eq!(refused(vec![], vec![]), text("bones.len", "0"));
        assert_eq!(refused(vec![bone(Some(0))], vec![]), text("bones[0].parent", "0"));
        assert_eq!(
            refused(vec![bone(None), bone(Some(2)), bone(None)], vec![]),
            text("bones[1].parent", "2")
        );
        assert_eq!(refused(vec![bone(None)], vec![1]), text("joints[0]", "1"));
        assert_eq!(refused(vec![bone(None)], vec![0, 0]), text("joints[1]", "0"));
        let mut wrong = bone(None);
        wrong.rest.scale[1] = f32::INFINITY;
        assert_eq!(refused(vec![wrong], vec![]), text("bones[0].rest.scale[1]", "inf"));
    }

    #[test]
    fn skins_are_checked_field_by_field() {
        let skeleton = Skeleton::of_joints(vec![bone(None)]).expect("valid");
        let identity = glam::Mat4::IDENTITY.to_cols_array();
        let skin = Skin { name: String::new(), bones: vec![0], inverse_binds: vec![identity] };
        assert_eq!(skin.validate(&skeleton), Ok(()));
        let refused = |skin: Skin| skin.validate(&skeleton).expect_err("refused").path;
        assert_eq!(refused(Skin { bones: vec![1], ..skin.clone() }), "skin.bones[0]");
        assert_eq!(refused(Skin { inverse_binds: vec![], ..skin.clone() }), "skin.inverse_binds.len");
        let mut matrix = identity;
        matrix[5] = f32::NAN;
        assert_eq!(refused(Skin { inverse_binds: vec![matrix], ..skin.clone() }), "skin.inverse_binds[0][5]");
        matrix = identity;
        matrix[7] = 1.0;
        assert_eq!(refused(Skin { inverse_binds: vec![matrix], ..skin }), "skin.inverse_binds[0]");
    }
}
