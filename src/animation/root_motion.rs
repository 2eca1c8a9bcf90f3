//! Root motion: what moves a character through its world is taken out of a clip and handed to the caller, who moves
//! the character; the clip stays in place.
//!
//! [`RootMotion::extract`] does this once a clip, at load. [`RootMotion::delta`] then answers, for what an instance
//! plays, how it moves between two moments, across loops, many at once, backwards, and up to the ends where it clamps:
//!
//! `world(to) = world(from) · delta(from, to)`
//!
//! The work is a few lookups an instance, on the host, where characters' worlds are kept: it asks physics and
//! navigation before it moves. [`deltas`] serves a crowd without allocation.
//!
//! # What is taken
//!
//! With the root bone's place p and rotation q in the model's space at a moment, and p₀ and q₀ at the clip's start,
//! motion turns about the vertical (+Y) through p₀ by the *yaw* and then moves by those parts of p − p₀ that are
//! [`Taken`]. The yaw is the twist of q · q₀⁻¹ about the vertical: what is left of it when its tilt is undone by the
//! shortest arc. What is not taken stays in the pose, so motion · pose in place = pose, exactly but for rounding; where
//! a rotation both turns and tilts between two keys, within [`YAW_BOUND`], since it is cut into short linear stretches.
//!
//! Bones above the root must not move in the clip; they may turn, mirror and scale it (exporters' axes and units), but
//! for a yaw they must scale evenly and not mirror.

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

/// How far motion · pose in place may turn away from the pose between keys of a rotation whose yaw is taken, in radians,
/// for roots that tilt by less than 60°. Between linear keys that turn about the vertical alone, it does not. Otherwise
/// a stretch is cut into pieces of at most [`PIECE`], or [`SPLINE_PIECES`] of a spline, in which yaw and tilt advance
/// evenly: off by an eighth of the square of a piece times how fast the yaw bends, which tan(tilt) bounds. Measured on
/// random keys: 7e-5 between linear ones, 2.6e-4 on splines with random tangents.
pub const YAW_BOUND: f64 = 5e-4;

/// What a piece turns by at most, in radians: 1°.
pub const PIECE: f64 = std::f64::consts::PI / 180.0;

/// Pieces of a stretch of a cubic spline.
pub const SPLINE_PIECES: u32 = 128;

/// Which parts of a root bone's motion are taken out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Taken {
    /// Along x and z.
    pub horizontal: bool,
    /// Along y: climbing, jumps that physics should know of.
    pub vertical: bool,
    /// About y. Only together with `horizontal`.
    pub yaw: bool,
}

impl Default for Taken {
    /// Horizontal motion alone.
    fn default() -> Self {
        Self { horizontal: true, vertical: false, yaw: false }
    }
}

/// What was taken out of a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct RootMotion {
    duration: f64,
    // Metres in the model's space since the clip's start.
    path: Keys,
    // Key times and radians about the vertical since the clip's start, on straight lines.
    turn_times: Vec<f32>,
    turns: Vec<f64>,
    // Where the bone is at the clip's start: what it turns about.
    pivot: [f64; 3],
    // From start to end.
    whole: Rigid,
}

impl RootMotion {
    /// Takes the motion of `bone` out of a clip: the clip in place, and the motion.
    ///
    /// # Errors
    /// [`InputError`] for a clip of another skeleton, a bone that it lacks, nothing that is taken, a yaw without
    /// horizontal motion, and bones above that move, have no extent, or, for a yaw, mirror or scale unevenly.
    pub fn extract(
        skeleton: &Skeleton,
        clip: &Clip,
        bone: usize,
        taken: Taken,
    ) -> Result<(Clip, Self), InputError> {
        extract::extract(skeleton, clip, bone, taken)
    }

    /// How what `instance` plays moves it from one moment to another, in seconds since its start as
    /// `KeyframeCursorJob::set` counts them; `to` may lie before `from`. A rotation about +Y and a translation in metres, in the
    /// space of the model at `from`.
    ///
    /// # Errors
    /// [`InputError`] for moments, starts and rates that are not finite.
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

    /// The motion from the clip's start to a time inside it.
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
    for (field, value) in [("from", from), ("to", to)] {
        if !value.is_finite() {
            return Err(InputError::new(field, value, "must be finite"));
        }
    }
    Ok(())
}

/// [`RootMotion::delta`] of a whole crowd, without allocation: of one layer of it. Deltas of clips that are blended blend
/// by the same weights ([`blend`](crate::animation::sample::reference::blend)). `motions` has one entry a clip of the set: `None` where
/// nothing was taken out, which does not move.
///
/// # Errors
/// As [`RootMotion::delta`]; [`InputError`] for instances that play none of the clips, and other than one delta an
/// instance.
pub fn deltas(
    motions: &[Option<RootMotion>],
    instances: &[Instance],
    from: f64,
    to: f64,
    deltas: &mut [Transform],
) -> Result<(), InputError> {
    check_times(from, to)?;
    if deltas.len() != instances.len() {
        let bound = format!("must be {}, one an instance", instances.len());
        return Err(InputError::new("deltas.len", deltas.len(), bound));
    }
    for (instance, delta) in instances.iter().zip(deltas) {
        instance.validate(motions.len())?;
        let motion = motions[instance.clip as usize].as_ref();
        *delta = motion.map_or(Transform::IDENTITY, |motion| motion.between(instance, from, to));
    }
    Ok(())
}
