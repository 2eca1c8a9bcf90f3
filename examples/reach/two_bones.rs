//! Inverse kinematics on two bones.

use glam::{DQuat, DVec3};
use relievo::InputError;
use relievo::scene::InstancePose;

/// Two bones and what they carry, by index: upper arm, forearm and hand, or thigh, shin and foot.
#[derive(Debug, Clone, Copy)]
pub struct Limb {
    pub upper: usize,
    pub lower: usize,
    pub end: usize,
}

impl Limb {
    /// Brings the end of the limb to a point of the world, or as near as the limb is long. It bends about the axis about which
    /// the pose bends it.
    pub fn reach(&self, pose: &mut InstancePose, target: DVec3) -> Result<(), InputError> {
        let [shoulder, elbow, hand] =
            [pose.world(self.upper)?, pose.world(self.lower)?, pose.world(self.end)?];
        let (upper, lower) = (shoulder.distance(elbow), elbow.distance(hand));
        // The angle at the elbow where shoulder and hand are so far apart, by the law of cosines.
        let angle = |apart: f64| {
            let cosine = (upper * upper + lower * lower - apart * apart) / (2.0 * upper * lower);
            cosine.clamp(-1.0, 1.0).acos()
        };
        let bend = angle(shoulder.distance(target)) - angle(shoulder.distance(hand));
        let axis = (shoulder - elbow).cross(hand - elbow);
        let axis = axis.try_normalize().unwrap_or_else(|| (hand - elbow).any_orthonormal_vector());
        pose.turn(self.lower, DQuat::from_axis_angle(axis, bend))?;
        let (from, to) = (pose.world(self.end)? - shoulder, target - shoulder);
        pose.turn(self.upper, DQuat::from_rotation_arc(from.normalize(), to.normalize()))
    }
}
