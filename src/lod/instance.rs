//! Placements of instances. CPU reference of `wgsl/lod/instance.wgsl`.

use glam::{IVec3, Quat, Vec3};

use super::{CELL_SIZE, INSTANCE_ALIVE, INSTANCE_CASTS, SceneInstance, instance_flags_word};

impl SceneInstance {
    /// An instance that casts shadows and is visible to every view. It lies at the corner of cell 0 and has the model's scale.
    ///
    /// `bounding_sphere` is a sphere around everything that the instance may draw, in the model's space: center and
    /// radius.
    pub fn new(bounding_sphere: [f32; 4]) -> Self {
        Self {
            cell: [0; 3],
            flags: instance_flags_word(INSTANCE_ALIVE | INSTANCE_CASTS, 0xffff),
            offset: [0.0; 3],
            user_data: 0,
            rotation: Quat::IDENTITY.to_array(),
            scale: [1.0; 3],
            tint: u32::MAX,
            bounding_sphere,
        }
    }

    /// The instance's position relative to the corner of `cell`, in world units.
    pub fn position(&self, cell: IVec3) -> Vec3 {
        (IVec3::from_array(self.cell) - cell).as_vec3() * CELL_SIZE + Vec3::from_array(self.offset)
    }

    /// The columns of the linear transform from the model's space to the world: scale, then rotation.
    pub fn axes(&self) -> [Vec3; 3] {
        let [qx, qy, qz, qw] = self.rotation;
        let x =
            Vec3::new(1.0 - 2.0 * (qy * qy + qz * qz), 2.0 * (qx * qy + qw * qz), 2.0 * (qx * qz - qw * qy));
        let y =
            Vec3::new(2.0 * (qx * qy - qw * qz), 1.0 - 2.0 * (qx * qx + qz * qz), 2.0 * (qy * qz + qw * qx));
        let z =
            Vec3::new(2.0 * (qx * qz + qw * qy), 2.0 * (qy * qz - qw * qx), 1.0 - 2.0 * (qx * qx + qy * qy));
        [self.scale[0] * x, self.scale[1] * y, self.scale[2] * z]
    }

    /// Whether the scale mirrors: an odd number of its factors is negative.
    pub fn is_mirrored(&self) -> bool {
        self.scale.iter().filter(|factor| **factor < 0.0).count() % 2 == 1
    }

    /// The largest absolute scale factor of the three axes.
    pub fn largest_scale(&self) -> f32 {
        self.scale.iter().fold(0.0, |largest: f32, factor| largest.max(factor.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_those_of_the_rotation() {
        let rotation = Quat::from_euler(glam::EulerRot::XYZ, 0.3, -1.1, 2.0);
        let scale = [2.0, -0.5, 3.0];
        let instance = SceneInstance {
            rotation: rotation.to_array(),
            scale,
            ..SceneInstance::new([0.0, 0.0, 0.0, 1.0])
        };
        for (axis, (unit, factor)) in
            instance.axes().iter().zip([Vec3::X, Vec3::Y, Vec3::Z].iter().zip(scale))
        {
            assert!(axis.distance(rotation * (factor * *unit)) < 1e-6);
        }
        assert!(instance.is_mirrored() && instance.largest_scale() == 3.0);
        assert!(!SceneInstance { scale: [-1.0, -1.0, 1.0], ..instance }.is_mirrored());
    }

    #[test]
    fn positions_stay_precise_far_from_the_origin() {
        let far = SceneInstance {
            cell: [4_000_000, -3, 7],
            offset: [0.125, 255.5, 1.0],
            ..SceneInstance::new([0.0; 4])
        };
        let relative = far.position(IVec3::new(4_000_001, -3, 7));
        assert_eq!(relative, Vec3::new(-255.875, 255.5, 1.0));
    }
}
