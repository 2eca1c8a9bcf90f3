//! What the instances of characters play.

use crate::animation::Wrap;

/// What an instance plays.
#[derive(Debug, Clone, Copy)]
pub(super) struct Playing {
    pub clip: u32,
    pub wrap: Wrap,
    pub start: f64,
    pub rate: f32,
}

impl Playing {
    /// The first clip, from time 0 on.
    pub const REST: Self = Self { clip: 0, wrap: Wrap::Loop, start: 0.0, rate: 1.0 };
}
