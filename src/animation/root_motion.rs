//! Root motion: the part of a clip that moves a character through its world. It is removed from the clip, which then plays in
//! place. The caller moves the character by the root motion instead.
//!
//! [`RootMotion::extract`] separates the motion once per clip, at load time. [`RootMotion::delta`] returns the motion of an
//! instance between two times. The interval may span any number of loops, run backwards, and reach the ends of a clamped clip. A
//! delta has this property:
//!
//! `world(to) = world(from) · delta(from, to)`
//!
//! A delta takes a few lookups per instance on the host. It is computed on the host because the host keeps the characters'
//! placements and asks physics and navigation before it moves them. [`deltas`] handles a crowd without allocation.
//!
//! # What is taken
//!
//! Let p and q be the root bone's position and rotation in model space at a given time. Let p₀ and q₀ be the bone's position and
//! rotation at the clip's start. The extracted motion first rotates by the *yaw* about the vertical axis (+Y) through p₀. It then
//! translates by the components of p − p₀ that [`Taken`] selects.
//!
//! The yaw is the twist of q · q₀⁻¹ about the vertical: the rotation that remains after the tilt is undone along the shortest
//! arc. Everything else stays in the pose. Thus motion · pose in place = pose, up to rounding. If a rotation both turns and tilts
//! between two keys, the equation holds within [`YAW_BOUND`], because the rotation is split into short linear segments.
//!
//! The ancestors of the root bone must not move in the clip. They may rotate, mirror and scale the root bone, as exporters do to
//! convert axes and units. If the yaw is taken, their scale must be uniform and must not mirror.

use crate::InputError;
use crate::animation::instance::Instance;
use crate::animation::instance::Wrap;
use crate::animation::sample::reference::vector_at;
use crate::asset::clip::{Clip, Keys};
use crate::asset::keyframe::KeyframeCursor;
use crate::asset::keyframe::keyframe_cursor;
use crate::asset::skeleton::Skeleton;
use crate::asset::transform::Transform;

mod extract;
mod rigid;

use rigid::Rigid;

/// Largest angle, in radians, between motion · pose in place and the original pose. It applies between keys of a rotation whose
/// yaw is taken, for roots that tilt by less than 60°.
///
/// Between linear keys that rotate about the vertical only, the angle is 0. Otherwise, a linear segment is split into pieces of
/// at most [`PIECE`], and a spline segment into [`SPLINE_PIECES`] pieces. In each piece, yaw and tilt advance at constant speed.
/// The error is ⅛ · piece² · curvature of the yaw, and tan(tilt) bounds this curvature. On random keys, the measured error is
/// 7e-5 between linear keys, and 2.6e-4 on splines with random tangents.
pub const YAW_BOUND: f64 = 5e-4;

/// Largest rotation, in radians, of one linear piece of a segment: 1°.
pub const PIECE: f64 = std::f64::consts::PI / 180.0;

/// Number of linear pieces that replace one segment of a cubic spline.
pub const SPLINE_PIECES: u32 = 128;

/// Selects the components of a root bone's motion that are taken out of a clip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Taken {
    /// Take the translation along x and z.
    pub horizontal: bool,
    /// Take the translation along y: for climbing, and for jumps that physics should handle.
    pub vertical: bool,
    /// Take the rotation about y; allowed only together with `horizontal`.
    pub yaw: bool,
}

impl Default for Taken {
    /// Takes horizontal motion only.
    fn default() -> Self {
        Self { horizontal: true, vertical: false, yaw: false }
    }
}

/// Root motion that was taken out of a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct RootMotion {
    duration: f64,
    // Translation since the clip's start, in metres of model space.
    path: Keys,
    // Key times in seconds, and yaw in radians since the clip's start. Values between keys are interpolated linearly.
    turn_times: Vec<f32>,
    turns: Vec<f64>,
    // Position of the bone at the clip's start: the pivot of the yaw.
    pivot: [f64; 3],
    // Motion from the clip's start to its end: one whole loop.
    whole: Rigid,
}

impl RootMotion {
    /// Takes the selected motion of `bone` out of a clip. Returns the clip without this motion, and the motion.
    ///
    /// # Errors
    /// [`InputError`] in these cases:
    ///
    /// - the clip is of another skeleton, or the skeleton has no such bone;
    /// - `taken` selects nothing, or the yaw without horizontal motion;
    /// - an ancestor of the bone moves, or its scale makes the bones below it flat;
    /// - the yaw is taken and an ancestor mirrors or scales unevenly.
    pub fn extract(
        skeleton: &Skeleton,
        clip: &Clip,
        bone: usize,
        taken: Taken,
    ) -> Result<(Clip, Self), InputError> {
        extract::extract(skeleton, clip, bone, taken)
    }

    /// Motion of an instance between two times: a rotation about +Y and a translation in metres, in the instance's model space at
    /// time `from`. Times are in seconds since the instance's start, as in `KeyframeCursorJob::set`. `to` may be before `from`.
    ///
    /// # Errors
    /// [`InputError`] if a time is not finite, or if the instance's start or rate is out of range ([`Instance::validate`]).
    pub fn delta(&self, instance: &Instance, from: f64, to: f64) -> Result<Transform, InputError> {
        check_times(from, to)?;
        instance.validate(usize::MAX)?;
        Ok(self.between(instance, from, to))
    }

    fn between(&self, instance: &Instance, from: f64, to: f64) -> Transform {
        let stands = |elapsed: f64| {
            let time = f64::from(instance.start) + f64::from(instance.rate) * elapsed;
            match instance.wrap() {
                _ if self.duration <= 0.0 => (0.0, 0.0),
                Wrap::Clamp => (0.0, time.clamp(0.0, self.duration)),
                Wrap::Loop => {
                    let loops = (time / self.duration).floor();
                    (loops, (time - loops * self.duration).clamp(0.0, self.duration))
                }
            }
        };
        let ((loops_before, before), (loops_after, after)) = (stands(from), stands(to));
        let loops = self.whole.power((loops_after - loops_before) as i64);
        self.since_start(before).inverse().then(loops).then(self.since_start(after)).transform()
    }

    /// Motion from the clip's start to a time inside the clip.
    fn since_start(&self, time: f64) -> Rigid {
        let at = keyframe_cursor(&self.path.times, time as f32);
        let [x, y, z, _] = vector_at(&self.path.values, self.path.interpolation, at).map(f64::from);
        Rigid::about(self.pivot, self.turn(keyframe_cursor(&self.turn_times, time as f32)), [x, y, z])
    }

    fn turn(&self, cursor: KeyframeCursor) -> f64 {
        let key = cursor.key as usize;
        match (self.turns.get(key), self.turns.get(key + 1)) {
            (Some(before), Some(after)) => before + (after - before) * f64::from(cursor.fraction),
            (before, _) => before.copied().unwrap_or(0.0),
        }
    }
}

fn check_times(from: f64, to: f64) -> Result<(), InputError> {
    InputError::check_finite("from", from)?;
    InputError::check_finite("to", to)
}

/// Computes [`RootMotion::delta`] for all instances of one layer of a crowd, without allocation. `motions` has one entry per clip
/// of the set. An instance whose clip has `None` does not move. For blended clips, blend the deltas by the clips' weights
/// ([`blend`](crate::animation::sample::reference::blend)).
///
/// # Errors
/// [`InputError`] for the errors of [`RootMotion::delta`], if an instance's clip does not exist, and if `deltas` does not have
/// one entry per instance.
pub fn deltas(
    motions: &[Option<RootMotion>],
    instances: &[Instance],
    from: f64,
    to: f64,
    deltas: &mut [Transform],
) -> Result<(), InputError> {
    check_times(from, to)?;
    InputError::check_len("deltas", deltas.len(), instances.len(), "an instance")?;
    for (instance, delta) in instances.iter().zip(deltas) {
        instance.validate(motions.len())?;
        let motion = motions[instance.clip as usize].as_ref();
        *delta = motion.map_or(Transform::IDENTITY, |motion| motion.between(instance, from, to));
    }
    Ok(())
}
