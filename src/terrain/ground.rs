//! Ground queries on the CPU: height and normal of the drawn terrain triangles at a world position.

mod ray;

use std::collections::HashMap;

use crate::InputError;
use crate::terrain::config::TerrainConfig;
use crate::terrain::export::cropped;
use crate::terrain::mesh::{FRACTION_ONE, GroundPoint, HeightField, sample_and_fraction};
pub use ray::GroundHit;
#[cfg(feature = "gpu")]
pub(crate) use ray::{slab, within};

/// Heights of patches on the CPU, for queries of the ground. All patches have the same configuration.
///
/// The queries use the same triangles that relievo draws and exports ([`HeightField::write_obj`]), so that objects on the ground
/// neither float nor sink. A patch takes four bytes per sample.
///
/// ```
/// use relievo::ops::terrain::field::field;
/// use relievo::ops::terrain::{config::TerrainConfig, ground::Ground, recipe::Recipe};
///
/// let config = TerrainConfig::new(33, 40.0, "any text")?;
/// let patches = [[-1, 0], [0, 0]];
/// let mut ground = Ground::new(&config)?;
/// for (patch, heights) in patches.iter().zip(field(&Recipe::new(config), &patches, 0)?) {
///     ground.insert(*patch, &heights, 0)?;
/// }
/// let west = ground.point_at(-0.25, 7.5).ok_or("inside")?;
/// assert!(west.height.abs() < 200.0 && west.normal[1] > 0.0);
/// assert_eq!(ground.point_at(-0.25, -7.5), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Ground {
    /// Samples along an edge of a patch.
    size: u32,
    /// World units between neighbouring samples.
    spacing: f64,
    patches: HashMap<[i32; 2], HeightField>,
}

impl Ground {
    /// Creates a ground without patches, for patches of the configuration `config`.
    ///
    /// # Errors
    /// [`InputError`] as [`TerrainConfig::validate`].
    pub fn new(config: &TerrainConfig) -> Result<Self, InputError> {
        config.validate()?;
        Ok(Self { size: config.patch_size, spacing: config.terrain_scale, patches: HashMap::new() })
    }

    /// Adds the patch with coordinates `patch`, or replaces it. `heights` are in 1/65536 height units, row by row, with `margin`
    /// extra samples on each side, which are dropped. [`crate::terrain::field::field`] returns heights in this form, and fields
    /// on the device store them in the same form.
    ///
    /// # Errors
    /// [`InputError`] when the number of heights is not (patchSize + 2 · margin)².
    pub fn insert(&mut self, patch: [i32; 2], heights: &[i32], margin: u32) -> Result<(), InputError> {
        let width = u64::from(self.size) + 2 * u64::from(margin);
        let refused = || {
            let bound = format!("must be {width}² heights: patchSize = {} and margin = {margin}", self.size);
            InputError::new("heights", format!("[{} heights]", heights.len()), bound)
        };
        if width.checked_mul(width) != Some(heights.len() as u64) {
            return Err(refused());
        }
        let inner = cropped(heights, width as usize, margin as usize);
        let field = HeightField::new(inner, self.size as usize, self.spacing).ok_or_else(refused)?;
        self.patches.insert(patch, field);
        Ok(())
    }

    /// Whether the ground has a patch.
    #[cfg(feature = "gpu")]
    pub(crate) fn contains(&self, patch: [i32; 2]) -> bool {
        self.patches.contains_key(&patch)
    }

    /// Removes a patch. Returns whether the ground had that patch.
    pub fn remove(&mut self, patch: [i32; 2]) -> bool {
        self.patches.remove(&patch).is_some()
    }

    /// Lowest and highest height of a patch in world units; `None` if the ground has no such patch.
    pub fn extremes(&self, patch: [i32; 2]) -> Option<[f64; 2]> {
        self.patches.get(&patch).map(HeightField::extremes)
    }

    /// Height and normal of the ground at world position (x east, z south), in world units. Position 0 is the first sample of
    /// patch (0, 0). `None` if the ground has no patch at that position.
    ///
    /// On an edge between two present patches, the eastern or southern patch answers. In `seamless` terrain both patches give the
    /// same height there, bit for bit. In `wrap` terrain each patch has its own edge heights, so the choice of patch matters.
    pub fn point_at(&self, x: f64, z: f64) -> Option<GroundPoint> {
        self.point_from([0, 0], x, z)
    }

    /// Height and normal of the ground at a position relative to the first sample of patch `origin`. Everything else is as in
    /// [`Ground::point_at`]. A viewer far from patch (0, 0) should choose a nearby origin: positions near 0 are precise, however
    /// far away the origin is.
    pub fn point_from(&self, origin: [i32; 2], x: f64, z: f64) -> Option<GroundPoint> {
        let columns = self.cells(origin[0], x)?;
        let rows = self.cells(origin[1], z)?;
        let near = rows
            .into_iter()
            .flatten()
            .flat_map(|row| columns.into_iter().flatten().map(move |column| (column, row)));
        near.filter_map(|(column, row)| {
            let field = self.patches.get(&[column.patch, row.patch])?;
            Some(field.triangle([column.index, row.index], [column.fraction, row.fraction]))
        })
        .next()
    }

    /// Cells along one axis that contain a position. A position on the edge between two patches lies in two cells: first the cell
    /// after the edge, then the cell before it.
    fn cells(&self, origin: i32, position: f64) -> Option<[Option<Cell>; 2]> {
        let edge = i64::from(self.size) - 1;
        let (sample, fraction) = sample_and_fraction(position / self.spacing)?;
        let sample = sample + i64::from(origin) * edge;
        let cell = |sample: i64, fraction: i64| {
            let patch = i32::try_from(sample.div_euclid(edge)).ok()?;
            Some(Cell { patch, index: sample.rem_euclid(edge) as usize, fraction })
        };
        let is_edge = fraction == 0 && sample.rem_euclid(edge) == 0;
        Some([cell(sample, fraction), if is_edge { cell(sample - 1, FRACTION_ONE) } else { None }])
    }
}

/// A cell along one axis, and a position in that cell.
#[derive(Debug, Clone, Copy)]
struct Cell {
    patch: i32,
    index: usize,
    /// Position in the cell, 0 to [`FRACTION_ONE`].
    fraction: i64,
}
