//! Rigid motions: a rotation about the vertical and a translation. They use double precision, so that positions stay exact after
//! an hour of loops.

use glam::{DQuat, DVec3};

use crate::asset::transform::Transform;

/// A rotation by `turn` radians about +Y, followed by a translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rigid {
    turn: f64,
    translation: DVec3,
}

impl Rigid {
    const IDENTITY: Self = Self { turn: 0.0, translation: DVec3::ZERO };

    /// Rotation by `turn` radians about the vertical through `pivot`, followed by a translation.
    pub fn about(pivot: [f64; 3], turn: f64, translation: [f64; 3]) -> Self {
        let [pivot, translation] = [pivot, translation].map(DVec3::from);
        Self { turn, translation: pivot + translation - DQuat::from_rotation_y(turn) * pivot }
    }

    /// This motion, followed by `next`. `next` is in the space that this motion leads to.
    pub fn then(self, next: Self) -> Self {
        let turned = DQuat::from_rotation_y(self.turn) * next.translation;
        Self { turn: self.turn + next.turn, translation: self.translation + turned }
    }

    pub fn inverse(self) -> Self {
        let back = DQuat::from_rotation_y(-self.turn) * -self.translation;
        Self { turn: -self.turn, translation: back }
    }

    /// This motion, repeated `count` times. A negative count repeats the inverse.
    pub fn power(self, count: i64) -> Self {
        let mut square = if count < 0 { self.inverse() } else { self };
        let (mut left, mut product) = (count.unsigned_abs(), Self::IDENTITY);
        while left > 0 {
            if left % 2 == 1 {
                product = product.then(square);
            }
            square = square.then(square);
            left /= 2;
        }
        product
    }

    pub fn transform(self) -> Transform {
        Transform {
            translation: self.translation.as_vec3().to_array(),
            rotation: DQuat::from_rotation_y(self.turn).as_quat().to_array(),
            ..Transform::IDENTITY
        }
    }
}
