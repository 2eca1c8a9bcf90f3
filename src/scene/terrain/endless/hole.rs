//! Holes in endless terrain.

use std::sync::Arc;

use crate::InputError;

/// A hole in endless terrain: triangles with a corner in it are left out.
#[derive(Debug, Clone, PartialEq)]
pub enum TerrainHole {
    /// A circle.
    Circle {
        /// World position of the middle: x and z.
        at: [f64; 2],
        /// Radius in world units, above 0.
        radius: f64,
    },
    /// Single samples.
    Samples(SampleMask),
}

impl TerrainHole {
    /// Checks the numbers of a circle: all must be finite, and the radius above 0.
    ///
    /// # Errors
    /// [`InputError`] that names `at` or `radius`.
    pub fn validate(&self) -> Result<(), InputError> {
        let Self::Circle { at: [x, z], radius } = self else { return Ok(()) };
        InputError::check(x.is_finite() && z.is_finite(), "at", format!("[{x}, {z}]"), || "must be finite")?;
        let is_radius = *radius > 0.0 && radius.is_finite();
        InputError::check(is_radius, "radius", radius, || "must be above 0 and finite")
    }

    /// Whether the hole contains a sample. `scale` is the distance between two samples.
    pub(super) fn contains(&self, sample: [i64; 2], scale: f64) -> bool {
        match self {
            Self::Circle { at, radius } => {
                let [x, z] = [0, 1].map(|axis| sample[axis] as f64 * scale - at[axis]);
                x.hypot(z) <= *radius
            }
            Self::Samples(mask) => mask.contains(sample),
        }
    }

    /// Width in world units of what a square of the world without this hole lacks: 0 if the hole does not reach into the square.
    /// `corner` is the square's smallest.
    pub(super) fn width_in(&self, corner: [f64; 2], edge: f64, scale: f64) -> f32 {
        let width = match self {
            Self::Circle { at, radius } => {
                let [x, z] = [0, 1].map(|axis| at[axis].clamp(corner[axis], corner[axis] + edge) - at[axis]);
                if x.hypot(z) <= *radius { 2.0 * (radius + scale) } else { 0.0 }
            }
            Self::Samples(mask) => {
                let reaches = |part: &&[[i64; 2]; 2]| {
                    (0..2).all(|axis| {
                        let [low, high] = [part[0][axis], part[1][axis]].map(|sample| sample as f64 * scale);
                        low <= corner[axis] + edge && high >= corner[axis]
                    })
                };
                let width = |[low, high]: &[[i64; 2]; 2]| (high[0] - low[0]).max(high[1] - low[1]) + 2;
                mask.parts.iter().filter(reaches).map(width).max().unwrap_or(0) as f64 * scale
            }
        };
        width as f32
    }
}

/// A rectangle of the finest samples of endless terrain, some of which are a hole. Clones share the samples.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SampleMask {
    first: [i64; 2],
    size: [u32; 2],
    is_hole: Arc<[bool]>,
    /// For each part whose samples touch each other: its smallest and its largest column and row.
    parts: Arc<[[[i64; 2]; 2]]>,
}

impl SampleMask {
    /// Column and row of the first sample, number of columns and rows, and for each sample, row by row to the south, whether it
    /// is in the hole. Sample 0, 0 lies at the origin of the world.
    ///
    /// # Errors
    /// [`InputError`] that names `size` without samples, or `is_hole` if its length is not the number of samples.
    pub fn new(first: [i32; 2], size: [u32; 2], is_hole: &[bool]) -> Result<Self, InputError> {
        let samples = u64::from(size[0]) * u64::from(size[1]);
        InputError::check(samples > 0, "size", format!("{size:?}"), || "must be at least 1 × 1")?;
        InputError::check_same("is_hole", is_hole.len() as u64, samples, "a flag for each sample")?;
        let first = first.map(i64::from);
        Ok(Self { first, size, is_hole: is_hole.into(), parts: parts(first, size, is_hole).into() })
    }

    fn contains(&self, sample: [i64; 2]) -> bool {
        let [column, row] = [0, 1].map(|axis| sample[axis] - self.first[axis]);
        let [columns, rows] = self.size.map(i64::from);
        (0..columns).contains(&column)
            && (0..rows).contains(&row)
            && self.is_hole[(row * columns + column) as usize]
    }
}

/// The smallest and the largest column and row of each part of a mask whose samples touch each other, also at a corner.
fn parts(first: [i64; 2], size: [u32; 2], is_hole: &[bool]) -> Vec<[[i64; 2]; 2]> {
    let [columns, rows] = size.map(i64::from);
    let mut left = is_hole.to_vec();
    let mut parts = Vec::new();
    for start in 0..left.len() {
        if !std::mem::replace(&mut left[start], false) {
            continue;
        }
        let (mut low, mut high) = ([i64::MAX; 2], [i64::MIN; 2]);
        let mut open = vec![start as i64];
        while let Some(sample) = open.pop() {
            let at = [sample % columns, sample / columns];
            for axis in 0..2 {
                low[axis] = low[axis].min(first[axis] + at[axis]);
                high[axis] = high[axis].max(first[axis] + at[axis]);
            }
            for row in (at[1] - 1).max(0)..(at[1] + 2).min(rows) {
                for column in (at[0] - 1).max(0)..(at[0] + 2).min(columns) {
                    let other = row * columns + column;
                    if std::mem::replace(&mut left[other as usize], false) {
                        open.push(other);
                    }
                }
            }
        }
        parts.push([low, high]);
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_a_mask_count_by_themselves() {
        let rows = ["##...", ".....", "...#.", "..#.."];
        let is_hole: Vec<bool> = rows.concat().bytes().map(|byte| byte == b'#').collect();
        let mask = SampleMask::new([-10, 7], [5, 4], &is_hole).expect("valid");
        assert_eq!(*mask.parts, [[[-10, 7], [-9, 7]], [[-8, 9], [-7, 10]]]);
        let hole = TerrainHole::Samples(mask);
        assert!(
            hole.contains([-10, 7], 2.0) && !hole.contains([-8, 7], 2.0) && !hole.contains([-11, 7], 2.0)
        );
        // A square around the first part, around both, and between them.
        let width = |corner: [f64; 2], edge: f64| hole.width_in(corner, edge, 2.0);
        assert_eq!(width([-20.0, 12.0], 2.0), 6.0);
        assert_eq!(width([-30.0, 0.0], 60.0), 6.0);
        assert_eq!(width([-18.0, 14.5], 1.0), 0.0);
        let refused = SampleMask::new([0; 2], [5, 3], &is_hole).expect_err("too many").path;
        assert_eq!(refused, "is_hole");
        assert_eq!(SampleMask::new([0; 2], [0, 3], &[]).expect_err("empty").path, "size");
    }
}
