//! Placements of instances, and the clips that they play.

use glam::{DVec3, Quat, Vec3};

use crate::InputError;
use crate::animation::Wrap;
use crate::animation::instance::check_seconds;
use crate::asset::Transform;
use crate::shared::lod::instance::CELL_SIZE;

/// An instance's transform into the world: position, rotation and scale. A point of the model is scaled, then rotated, then
/// translated. The world is right-handed: +X east, +Y up, +Z south.
///
/// The position consists of a cell and an offset from the cell's corner, so it is precise at any distance from the
/// origin. A cell is a cube with an edge of [`Placement::CELL`] world units.
///
/// # Examples
///
/// ```
/// use glam::{Quat, Vec3};
/// use relievo::scene::Placement;
///
/// // A million units east, half a unit is still represented exactly.
/// let far = Placement::at_world([1e6 + 0.5, 0.0, 0.0]);
/// assert_eq!((far.cell, far.offset), ([3906, 0, 0], Vec3::new(64.5, 0.0, 0.0)));
/// assert_eq!(far.world().x, 1e6 + 0.5);
///
/// // After a quarter turn, a side that faced south (+Z) faces east (+X). The model is drawn at half its size.
/// let place = Placement::at([3.0, 0.0, 4.0]).turned(std::f32::consts::FRAC_PI_2).scaled(0.5);
/// assert!((place.turn * Vec3::Z).distance(Vec3::X) < 1e-6);
///
/// // Any rotation, and one scale factor per axis of the model. A negative factor mirrors the model.
/// let tilted = Placement { turn: Quat::from_rotation_x(0.3), scale: Vec3::new(-1.0, 1.0, 2.0), ..place };
/// tilted.checked()?;
/// # Ok::<(), relievo::InputError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Index of the cell along x, y and z. `offset` is relative to the corner of this cell.
    pub cell: [i32; 3],
    /// The position in world units, relative to the cell's corner. The position may lie outside the cell.
    pub offset: Vec3,
    /// The rotation from the model's axes to the world's axes. The quaternion need not have length 1.
    pub turn: Quat,
    /// World units per unit of the model, for each axis of the model. The scale is applied before the rotation. A
    /// negative factor mirrors.
    pub scale: Vec3,
}

impl Default for Placement {
    /// A placement at the world's origin, without rotation and with scale 1.
    fn default() -> Self {
        Self { cell: [0; 3], offset: Vec3::ZERO, turn: Quat::IDENTITY, scale: Vec3::ONE }
    }
}

impl Placement {
    /// Length of a cell's edge in world units.
    pub const CELL: f32 = CELL_SIZE;

    /// A placement at a position in world coordinates, without rotation and with scale 1. The position has the
    /// precision of `f32`.
    pub fn at(position: impl Into<Vec3>) -> Self {
        Self { offset: position.into(), ..Self::default() }
    }

    /// A placement at a position in world coordinates, without rotation and with scale 1. Functions that use the
    /// placement refuse positions beyond ±549,755,813,888 (2³¹ cells).
    pub fn at_world(position: impl Into<DVec3>) -> Self {
        let position = position.into();
        let edge = f64::from(Self::CELL);
        // The cast to `i32` saturates beyond the last cell.
        let cell = (position / edge).floor().to_array().map(|cell| cell as i32);
        Self { cell, offset: (position - Self::corner(cell)).as_vec3(), ..Self::default() }
    }

    /// World coordinates of a cell's corner with the lowest x, y and z.
    pub fn corner(cell: [i32; 3]) -> DVec3 {
        DVec3::from(cell.map(f64::from)) * f64::from(Self::CELL)
    }

    /// The same placement with another rotation: by `angle` radians about the vertical axis. Positive angles turn
    /// counter-clockwise seen from above. A side that faces +Z at angle 0 faces +X at angle π/2.
    #[must_use]
    pub fn turned(self, angle: f32) -> Self {
        Self { turn: Quat::from_rotation_y(angle), ..self }
    }

    /// The same placement with another scale: one factor for all axes, in world units per unit of the model.
    #[must_use]
    pub fn scaled(self, scale: f32) -> Self {
        Self { scale: Vec3::splat(scale), ..self }
    }

    /// The placement after a motion in model space, such as [`Scene::root_motion`](crate::scene::Scene::root_motion):
    /// this placement times the motion. The motion's scale is ignored. The result is exact if the placement's scale
    /// factors have the same absolute value along all axes.
    #[must_use]
    pub fn moved_by(self, motion: &Transform) -> Self {
        let ahead = self.turn * (self.scale * Vec3::from(motion.translation));
        // In a mirrored model, the rotation runs in the opposite direction.
        let sides = self.scale.signum();
        let [x, y, z, w] = motion.rotation;
        let axis = sides * Vec3::new(x, y, z) * sides.element_product();
        let turn = self.turn * Quat::from_xyzw(axis.x, axis.y, axis.z, w);
        Self { offset: self.offset + ahead, turn, ..self }
    }

    /// The position in world coordinates.
    pub fn world(&self) -> DVec3 {
        Self::corner(self.cell) + self.offset.as_dvec3()
    }

    /// Checks the placement. Returns the same placement with the position inside its cell and a unit rotation.
    ///
    /// # Errors
    /// [`InputError`] for values that are not finite, a rotation of length 0, a scale of 0 along all axes, and a
    /// position beyond ±549,755,813,888 (2³¹ cells) along an axis of the world.
    pub fn checked(self) -> Result<Self, InputError> {
        InputError::check(!self.offset.is_nan(), "placement.offset", self.offset, || "must be finite")?;
        if !self.scale.is_finite() || self.scale == Vec3::ZERO {
            return Err(InputError::new(
                "placement.scale",
                self.scale,
                "must be finite, and not 0 along all axes",
            ));
        }
        // An infinite quaternion has no direction.
        let length = self.turn.length();
        if !(length > 1e-6 && length.is_finite()) {
            return Err(InputError::new("placement.turn", self.turn, "must be finite, and not 0"));
        }
        check_world("placement.world", self.cell, self.offset)?;
        let edge = f64::from(Self::CELL);
        let mut placed = Self { turn: self.turn / length, ..self };
        for axis in 0..3 {
            let at = f64::from(self.offset[axis]);
            let cells = (at / edge).floor();
            placed.cell[axis] = (f64::from(self.cell[axis]) + cells) as i32;
            placed.offset[axis] = (at - cells * edge) as f32;
        }
        Ok(placed)
    }
}

/// Checks that a position lies in one of the world's cells. `path` names the position in errors.
///
/// # Errors
/// [`InputError`] for a coordinate that is NaN or beyond the last cell.
pub(super) fn check_world(path: &str, cell: [i32; 3], offset: Vec3) -> Result<(), InputError> {
    let world = Placement::corner(cell) + offset.as_dvec3();
    // Bounds of the world along an axis: the lower edge of the first cell, and the upper edge of the last cell.
    let [first, end] = [i32::MIN, i32::MAX].map(|cell| Placement::corner([cell; 3]).x);
    let end = end + f64::from(Placement::CELL);
    match world.to_array().iter().position(|value| !(first..end).contains(value)) {
        None => Ok(()),
        Some(axis) => {
            let value = match world[axis].is_infinite() {
                true => "beyond ±3.4e38, the range of f32".to_owned(),
                // The offset was rounded to `f32`. The shortest decimal form of that `f32` is the number that the
                // caller wrote.
                false => (world[axis] as f32).to_string(),
            };
            let bound = format!("must be a number in {first}..{end}, the world's coordinates");
            Err(InputError::new(format!("{path}[{axis}]"), value, bound))
        }
    }
}

/// A clip that a character plays, with its start, rate and wrap mode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Play<'a> {
    /// The clip's name, or the digits of its index in the model (counted from 0). A clip without a name in its file is called
    /// `animation_` followed by its index.
    pub clip: &'a str,
    /// The scene time at which the clip starts, in seconds. A clip with a start in the past is already under way.
    pub start: f64,
    /// Seconds of the clip per second of scene time. A negative rate plays the clip backwards.
    pub rate: f32,
    /// Behaviour at the end of the clip.
    pub wrap: Wrap,
}

impl<'a> Play<'a> {
    /// A looping clip that started at scene time 0, with rate 1. To start it now, set `start` to
    /// [`Scene::time`](crate::scene::Scene::time).
    pub fn new(clip: &'a str) -> Self {
        Self { clip, start: 0.0, rate: 1.0, wrap: Wrap::Loop }
    }

    /// Checks that `start` and `rate` are finite and within ±1e9.
    ///
    /// # Errors
    /// [`InputError`] that names the invalid field.
    pub fn validate(&self) -> Result<(), InputError> {
        check_seconds("play.start", self.start as f32)?;
        check_seconds("play.rate", self.rate)
    }
}

/// The clip that a character plays, and the present time in that clip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClipTime {
    /// Index of the clip in the model.
    pub clip: usize,
    /// Seconds since the clip's start, between 0 and its duration.
    pub seconds: f32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_lie_in_their_cells() {
        let far = Placement::at_world([1e6 + 0.125, -0.5, 255.0]);
        assert_eq!((far.cell, far.offset), ([3906, -1, 0], Vec3::new(64.125, 255.5, 255.0)));
        assert_eq!(far.world(), DVec3::new(1e6 + 0.125, -0.5, 255.0));
        let moved =
            Placement { offset: far.offset + Vec3::new(512.0, 1.0, 0.0), ..far }.checked().expect("valid");
        assert_eq!((moved.cell, moved.offset), ([3908, 0, 0], Vec3::new(64.125, 0.5, 255.0)));
        let turned = Placement { turn: Quat::from_xyzw(0.0, 3.0, 0.0, 4.0), ..far }.checked().expect("valid");
        assert_eq!(turned.turn, Quat::from_xyzw(0.0, 0.6, 0.0, 0.8));
    }

    /// Moving a point in model space and then placing the point gives the same result as the moved placement.
    #[test]
    fn placements_move_by_motions_of_the_model() {
        let rotation = Quat::from_rotation_y(0.6) * Quat::from_rotation_x(0.3);
        let motion =
            Transform { translation: [0.5, -1.0, 2.0], rotation: rotation.to_array(), ..Transform::IDENTITY };
        let place = |placement: &Placement, point: Vec3| {
            (placement.turn * (placement.scale * point)).as_dvec3() + placement.world()
        };
        for mirror in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0), Vec3::new(1.0, -1.0, -1.0)] {
            let far = Placement { scale: 3.0 * mirror, ..Placement::at_world([1e6, 2.0, -9e5]).turned(1.1) };
            let moved = far.moved_by(&motion);
            for point in [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z] {
                let right = place(&far, rotation * point + Vec3::from(motion.translation));
                let found = place(&moved, point);
                assert!(found.distance(right) < 1e-4, "{found} {right}, mirrored by {mirror}");
            }
        }
    }

    #[test]
    fn placements_are_checked_field_by_field() {
        let good = Placement::default();
        let refused = |placement: Placement| placement.checked().expect_err("refused").path;
        assert_eq!(refused(Placement { offset: Vec3::NAN, ..good }), "placement.offset");
        assert_eq!(refused(Placement { scale: Vec3::ZERO, ..good }), "placement.scale");
        assert_eq!(
            refused(Placement { turn: Quat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..good }),
            "placement.turn"
        );
        let beyond = Placement { cell: [0, i32::MAX, 0], offset: Vec3::new(0.0, 300.0, 0.0), ..good };
        assert_eq!(refused(beyond), "placement.world[1]");
        let refused_at =
            |x: f64| Placement::at_world([x, 0.0, 0.0]).checked().expect_err("refused").to_string();
        let bound = "must be a number in -549755813888..549755813888, the world's coordinates";
        assert_eq!(refused_at(6e11), format!("placement.world[0] = 600000000000: {bound}"));
        for endless in [1e300, f64::INFINITY, f64::NEG_INFINITY] {
            let value = "beyond ±3.4e38, the range of f32";
            assert_eq!(refused_at(endless), format!("placement.world[0] = {value}: {bound}"));
        }
        let last =
            Placement::at_world([549_755_813_887.0, -549_755_813_888.0, 0.0]).checked().expect("inside");
        assert_eq!(last.cell, [i32::MAX, i32::MIN, 0]);
        assert!(Placement { scale: Vec3::new(0.0, -1.0, 2.0), ..good }.checked().is_ok());
        let refused = |play: Play<'_>| play.validate().expect_err("refused").path;
        assert_eq!(refused(Play { start: f64::NAN, ..Play::new("walk") }), "play.start");
        assert_eq!(refused(Play { rate: f32::INFINITY, ..Play::new("walk") }), "play.rate");
    }
}
