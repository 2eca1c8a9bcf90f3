//! An instance's pose on the host, for the caller's own kinematics.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use crate::InputError;
use crate::animation::Pose;
use crate::animation::local_to_model::reference::{affine, product};
use crate::asset::{Affine, Skeleton, Transform};
use crate::scene::Scene;
use crate::scene::handles::{InstanceId, no_character};
use crate::scene::matrices::affine_of;

/// A copy of the pose of a character's instance ([`Scene::pose`]), with the transforms of all bones. The caller may change
/// the copy, and may pass its transforms to [`Poses::write`](crate::scene::Poses::write). Bones are given by index
/// ([`Scene::bone`]).
///
/// # Examples
///
/// A head that looks at a point of the world, but turns at most 1.2 radians away from its clip's pose.
///
/// ```no_run
/// use glam::{DQuat, DVec3};
/// use relievo::scene::{InstanceId, InstancePose};
///
/// fn look(pose: &mut InstancePose, head: usize, target: DVec3) -> Result<(), relievo::InputError> {
///     let bone = pose.world_from_bone(head)?;
///     let ahead = bone.transform_vector3(DVec3::Z).normalize(); // this head looks along its +Z
///     let wanted = (target - pose.world(head)?).normalize();
///     let (axis, angle) = DQuat::from_rotation_arc(ahead, wanted).to_axis_angle();
///     pose.turn(head, DQuat::from_axis_angle(axis, angle.min(1.2)))
/// }
/// ```
///
/// `examples/reach` shows inverse kinematics on two bones.
#[derive(Debug, Clone, PartialEq)]
pub struct InstancePose {
    parents: Vec<Option<u32>>,
    pose: Pose,
    world_from_model: DAffine3,
}

impl InstancePose {
    fn new(skeleton: &Skeleton, pose: Pose, world_from_model: DAffine3) -> Self {
        let parents = skeleton.bones().iter().map(|bone| bone.parent).collect();
        Self { parents, pose, world_from_model }
    }

    /// The local transform of each bone, in its parent's space.
    pub fn locals(&self) -> &[Transform] {
        &self.pose.locals
    }

    /// The model matrix of each bone: three rows of the transform from bone space to model space.
    pub fn model_matrices(&self) -> &[Affine] {
        &self.pose.model_matrices
    }

    /// The transform from model space to the world: the instance's placement.
    pub fn world_from_model(&self) -> DAffine3 {
        self.world_from_model
    }

    /// The local transform of a bone, in its parent's space. [`Poses::write`](crate::scene::Poses::write) takes this
    /// transform.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have.
    pub fn local(&self, bone: usize) -> Result<Transform, InputError> {
        self.pose.locals.get(bone).copied().ok_or_else(|| self.missing(bone))
    }

    /// The transform from bone space to the world. It contains the scales of the instance, the bone and the bones above it.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have.
    pub fn world_from_bone(&self, bone: usize) -> Result<DAffine3, InputError> {
        let matrix = self.pose.model_matrices.get(bone).ok_or_else(|| self.missing(bone))?;
        Ok(self.world_from_model * affine_of(matrix))
    }

    /// The world coordinates of a bone's origin, which is its joint.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have.
    pub fn world(&self, bone: usize) -> Result<DVec3, InputError> {
        Ok(self.world_from_bone(bone)?.translation)
    }

    /// Replaces the local transform of a bone, in its parent's space. The bones below it follow.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have, and for a transform that [`Transform::checked`] refuses.
    pub fn set_local(&mut self, bone: usize, local: Transform) -> Result<(), InputError> {
        self.local(bone)?;
        self.pose.locals[bone] = local.checked("local")?;
        // Parents precede their children.
        for at in bone..self.parents.len() {
            let local = affine(&self.pose.locals[at]);
            let parent = self.parents[at].map(|parent| &self.pose.model_matrices[parent as usize]);
            self.pose.model_matrices[at] = parent.map_or(local, |parent| product(parent, &local));
        }
        Ok(())
    }

    /// Turns a bone about its origin by a rotation in world axes. The bones below it follow. The result is exact if the
    /// instance and the bones above have uniform scale. Otherwise, the nearest rotation in the parent's space is used.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have, for a rotation that is not finite or has length 0, and if
    /// the instance or a bone above is scaled by 0.
    pub fn turn(&mut self, bone: usize, rotation: DQuat) -> Result<(), InputError> {
        let local = self.local(bone)?;
        let length = rotation.length();
        if !(length > 0.0 && length.is_finite()) {
            return Err(InputError::new("rotation", rotation, "must be finite, and not 0"));
        }
        let above = match self.parents[bone] {
            Some(parent) => self.world_from_bone(parent as usize)?,
            None => self.world_from_model,
        };
        let above = above.matrix3;
        InputError::check(above.determinant() != 0.0, "bone", bone, || "must not lie below a scale of 0")?;
        let turned = above.inverse() * DMat3::from_quat(rotation / length) * above;
        let own = DQuat::from_array(local.rotation.map(f64::from));
        let turned = (rotation_of(turned) * own).normalize();
        self.set_local(bone, Transform { rotation: turned.to_array().map(|part| part as f32), ..local })
    }

    /// Converts an offset to bone space, for [`Scene::attach`]. `offset` is given along the bone's axes, in world units. A
    /// mesh attached with the result is `offset.translation` world units away from the bone's origin. The mesh's size is
    /// `offset.scale` times the size of its model. This holds for any scale of the instance and of its bones in this pose.
    /// The rotation stays unchanged. If the bone's scale differs between axes, a rotated mesh is sheared, but each of the
    /// mesh's axes has the right length.
    ///
    /// # Errors
    /// [`InputError`] for a bone that the skeleton does not have or that is scaled by 0, and for an offset that
    /// [`Transform::checked`] refuses.
    pub fn offset_of_world_units(&self, bone: usize, offset: Transform) -> Result<Transform, InputError> {
        let offset = offset.checked("offset")?;
        let stretch = self.world_from_bone(bone)?.matrix3;
        let stretch = DVec3::new(stretch.x_axis.length(), stretch.y_axis.length(), stretch.z_axis.length());
        InputError::check(stretch.min_element() != 0.0, "bone", bone, || "must not be scaled by 0")?;
        let translation = DVec3::from(offset.translation.map(f64::from)) / stretch;
        let rotation = DMat3::from_quat(DQuat::from_array(offset.rotation.map(f64::from)));
        let scale = [0, 1, 2].map(|axis| {
            let length = (stretch * rotation.col(axis)).length();
            (f64::from(offset.scale[axis]) / length) as f32
        });
        Ok(Transform { translation: translation.as_vec3().into(), scale, ..offset })
    }

    fn missing(&self, bone: usize) -> InputError {
        InputError::new("bone", bone, format!("must be below {}", self.parents.len()))
    }
}

/// The rotation of a matrix, without its shear and scale.
fn rotation_of(matrix: DMat3) -> DQuat {
    let x = matrix.x_axis.normalize();
    let y = (matrix.y_axis - x * x.dot(matrix.y_axis)).normalize();
    DQuat::from_mat3(&DMat3::from_cols(x, y, x.cross(y)))
}

impl Scene {
    /// The pose of a character's instance at the scene's time, from its clip and layers. The pose is computed on the CPU, in
    /// a few microseconds for a hundred bones, and equals the device's pose within rounding. Writes to driven bones
    /// ([`Poses::write`](crate::scene::Poses::write)) are not included.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is no character.
    pub fn pose(&self, instance: InstanceId) -> Result<InstancePose, InputError> {
        let Some(character) = self.object_of(instance)?.character() else {
            return Err(no_character());
        };
        let world = self.world_from_model(instance)?;
        let pose = character.sampled(instance.index, self.now)?;
        Ok(InstancePose::new(&character.model().skeleton, pose, world))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::Bone;

    /// A chain of three bones, each two units along +Y from its parent. `scale` is the scale of the first bone.
    fn chain(scale: [f32; 3], world_from_model: DAffine3) -> InstancePose {
        let bone = |index: u32| {
            let rest = Transform {
                translation: [0.0, 2.0 * index.min(1) as f32, 0.0],
                rotation: DQuat::from_rotation_z(0.3 * f64::from(index)).to_array().map(|part| part as f32),
                scale: if index == 0 { scale } else { [1.0; 3] },
            };
            Bone { name: format!("{index}"), parent: index.checked_sub(1), rest }
        };
        let skeleton = Skeleton::of_joints((0..3).map(bone).collect()).expect("a chain");
        let locals: Vec<_> = skeleton.bones().iter().map(|bone| bone.rest).collect();
        let model_matrices = crate::animation::local_to_model::reference::local_to_model(&skeleton, &locals);
        InstancePose::new(&skeleton, Pose { locals, model_matrices }, world_from_model)
    }

    /// If a bone turns, the bones below it turn about its joint, by the same rotation in the world. This holds even for a
    /// placement that mirrors.
    #[test]
    fn bones_turn_about_axes_of_the_world() {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -2.0).normalize(), 0.7);
        for mirror in [1.0, -1.0] {
            let placed = DAffine3::from_scale_rotation_translation(
                DVec3::new(3.0 * mirror, 3.0, 3.0),
                DQuat::from_rotation_x(0.4),
                DVec3::new(1e6, 5.0, -3.0),
            );
            let before = chain([0.5; 3], placed);
            let mut after = before.clone();
            after.turn(1, turn).expect("a bone");
            let place = |pose: &InstancePose, bone: usize| pose.world(bone).expect("a bone");
            let right = place(&before, 1) + turn * (place(&before, 2) - place(&before, 1));
            assert!(place(&after, 2).distance(right) < 1e-5, "{} {right}", place(&after, 2));
            assert_eq!(place(&after, 1), place(&before, 1));
            let [axes, turned] =
                [&before, &after].map(|pose| pose.world_from_bone(2).expect("a bone").matrix3);
            let off = (turned - DMat3::from_quat(turn) * axes).to_cols_array();
            assert!(off.iter().all(|entry| entry.abs() < 1e-5), "{off:?}");
        }
    }

    /// An offset in world units keeps its length and size in the world.
    #[test]
    fn offsets_in_world_units_undo_scales() {
        let placed = DAffine3::from_scale_rotation_translation(
            DVec3::splat(0.01),
            DQuat::from_rotation_y(1.0),
            DVec3::new(5.0, 6.0, 7.0),
        );
        let pose = chain([1.0, 2.0, 4.0], placed);
        let offset =
            Transform { translation: [0.3, -0.2, 0.1], scale: [1.0, 2.0, 3.0], ..Transform::IDENTITY };
        let own = pose.offset_of_world_units(0, offset).expect("a bone");
        let world = pose.world_from_bone(0).expect("a bone") * affine_of(&affine(&own));
        let away = world.translation - pose.world(0).expect("a bone");
        assert!((away.length() - 0.14_f64.sqrt()).abs() < 1e-6, "{away}");
        for (axis, right) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            assert!((world.matrix3.col(axis).length() - right).abs() < 1e-5, "axis {axis}");
        }
    }

    #[test]
    fn what_is_refused_is_named() {
        let mut pose = chain([1.0; 3], DAffine3::IDENTITY);
        let refused = |error: InputError| error.to_string();
        assert_eq!(refused(pose.world(3).expect_err("none")), "bone = 3: must be below 3");
        assert!(refused(pose.turn(1, DQuat::NAN).expect_err("no rotation")).starts_with("rotation"));
        let flat = Transform { rotation: [0.0; 4], ..Transform::IDENTITY };
        assert!(refused(pose.set_local(1, flat).expect_err("no rotation")).starts_with("local.rotation"));
        let mut none = chain([0.0; 3], DAffine3::IDENTITY);
        assert!(refused(none.turn(1, DQuat::IDENTITY).expect_err("flat")).contains("scale of 0"));
        assert!(none.offset_of_world_units(1, Transform::IDENTITY).is_err());
    }
}
