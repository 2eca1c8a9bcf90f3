//! Windows onto the plane of samples. A window is a patch with the samples around it. At every level of subdivision, a window
//! covers a range of lattice points.

use std::iter::successors;

use crate::InputError;
use crate::terrain::config::{Border, HeightInterpolation, TerrainConfig};

/// Largest number of samples by which a window may extend beyond its patch on each side.
pub const MAX_APRON: u32 = 4096;

/// Width in points of the rim around a window with smooth interpolation, at every level but the base lattice. Features in the rim
/// also influence the window.
pub(crate) const SMOOTH_RIM: u32 = 3;

/// A patch and the samples around it: (patchSize + 2·apron)² samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Window {
    /// Patch coordinates.
    pub patch: [i32; 2],
    /// Samples beyond the patch on every side, at most [`MAX_APRON`].
    pub apron: u32,
}

/// A batch of windows with equal aprons.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Windows {
    /// Number of windows.
    pub count: u32,
    /// Samples beyond each patch on every side, at most [`MAX_APRON`].
    pub apron: u32,
}

/// A square of samples of the plane, at the terrain's resolution or coarser. The terrain must be `seamless`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Region {
    /// Column and row of the first sample, counted from the first sample of patch (0, 0), in distances between the region's samples.
    pub first: [i64; 2],
    /// Number of samples along an edge.
    pub width: u32,
    /// The region has every 2^`coarser`-th sample of the terrain's columns and rows, with `coarser` at most
    /// [`TerrainConfig::levels`].
    pub coarser: u32,
}

/// A batch of regions of equal width and resolution; see [`Region`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Regions {
    /// Number of regions.
    pub count: u32,
    /// Number of samples along an edge.
    pub width: u32,
    /// Each region has every 2^`coarser`-th sample of the terrain's columns and rows.
    pub coarser: u32,
}

#[cfg(feature = "gpu")]
impl Windows {
    /// The same batch as regions.
    pub(crate) fn regions(&self, config: &TerrainConfig) -> Regions {
        Regions { count: self.count, width: config.patch_size + 2 * self.apron, coarser: 0 }
    }

    /// Number of samples of all windows together.
    pub fn points(&self, config: &TerrainConfig) -> usize {
        self.regions(config).points()
    }
}

#[cfg(feature = "gpu")]
impl Regions {
    /// Number of samples of all regions together.
    pub(crate) fn points(&self) -> usize {
        self.count as usize * (self.width as usize).pow(2)
    }
}

impl Region {
    /// The region with `apron` more samples on every side.
    #[cfg(feature = "gpu")]
    pub(crate) fn grown(self, apron: u32) -> Self {
        let first = self.first.map(|first| first - i64::from(apron));
        Self { first, width: self.width + 2 * apron, ..self }
    }

    /// Columns and rows of the region at every level of subdivision, starting with the base lattice.
    pub(crate) fn levels(&self, config: &TerrainConfig) -> Vec<[Span; 2]> {
        let coarser: fn(Span) -> Span = match (config.border, config.interpolation) {
            (Border::Seamless, HeightInterpolation::Linear) => Span::coarser,
            (Border::Seamless, HeightInterpolation::Smooth) => Span::coarser_smooth,
            _ => Span::halved,
        };
        let finest = self.first.map(|first| Span { first, last: first + i64::from(self.width) - 1 });
        let subdivisions = config.levels().saturating_sub(self.coarser);
        let coarser = |finer: &[Span; 2]| Some(finer.map(coarser));
        let mut levels: Vec<_> = successors(Some(finest), coarser).take(subdivisions as usize + 1).collect();
        levels.reverse();
        levels
    }

    /// Checks that the region is not coarser than the base lattice and that world coordinates, including halos, fit `i32`.
    ///
    /// # Errors
    /// [`InputError`] that names `coarser` or `first`.
    pub fn validate(&self, config: &TerrainConfig) -> Result<(), InputError> {
        InputError::check_within("coarser", self.coarser, 0..=config.levels())?;
        for (axis, span) in self.levels(config)[0].iter().enumerate() {
            if !is_in_world(config, span) {
                let bound = "world coordinates (4096 a patch) with the region's halo must fit i32";
                return Err(InputError::new(format!("first[{axis}]"), self.first[axis], bound));
            }
        }
        Ok(())
    }
}

/// Whether world coordinates of a span of the base lattice fit `i32`.
fn is_in_world(config: &TerrainConfig, span: &Span) -> bool {
    let base_spacing = config.sample_spacing() << config.levels();
    [span.first, span.last].iter().all(|index| i32::try_from(index.saturating_mul(base_spacing)).is_ok())
}

/// An inclusive range of lattice indices along one axis, in units of the lattice's spacing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Span {
    /// The first index.
    pub first: i64,
    /// The last index.
    pub last: i64,
}

impl Span {
    /// Span of the next coarser lattice from which this span can be computed. It includes one cell of halo on each side.
    pub(crate) fn coarser(self) -> Self {
        Self { first: (self.first + 1).div_euclid(2) - 1, last: self.last.div_euclid(2) + 1 }
    }

    /// Span of the next coarser lattice from which smooth interpolation can compute this span. It includes a halo of three points
    /// on each side.
    fn coarser_smooth(self) -> Self {
        Self { first: self.first.div_euclid(2) - 3, last: (self.last + 1).div_euclid(2) + 3 }
    }

    /// Span of the next coarser lattice for a patch that is generated alone, without a halo. The ends lie on both lattices.
    fn halved(self) -> Self {
        Self { first: self.first / 2, last: self.last / 2 }
    }

    /// Number of indices in the span.
    pub(crate) fn width(self) -> usize {
        (self.last - self.first + 1) as usize
    }
}

impl Window {
    /// Samples along an edge of the window, apron included.
    pub fn width(&self, config: &TerrainConfig) -> u32 {
        config.patch_size + 2 * self.apron
    }

    /// Columns and rows of the window's samples, counted from the first sample of patch (0, 0).
    pub(crate) fn spans(&self, config: &TerrainConfig) -> [Span; 2] {
        let edge = i64::from(config.patch_size) - 1;
        self.patch.map(|patch| {
            let first = i64::from(patch) * edge - i64::from(self.apron);
            Span { first, last: first + i64::from(self.width(config)) - 1 }
        })
    }

    /// The window as a region. For a patch that is generated alone, the apron is excluded.
    pub fn region(&self, config: &TerrainConfig) -> Region {
        let apron = if config.border == Border::Seamless { self.apron } else { 0 };
        let alone = Self { apron, ..*self };
        Region { first: alone.spans(config).map(|span| span.first), width: alone.width(config), coarser: 0 }
    }

    /// Columns and rows of the window at every level, starting with the base lattice.
    pub(crate) fn levels(&self, config: &TerrainConfig) -> Vec<[Span; 2]> {
        self.region(config).levels(config)
    }

    /// Lattice of the window's samples, in the coordinates of the world that holds the window's features.
    pub(crate) fn lattice(&self, config: &TerrainConfig) -> Lattice {
        let spacing = config.sample_spacing();
        let origin = if config.border == Border::Seamless {
            self.spans(config).map(|span| span.first * spacing)
        } else {
            [-i64::from(self.apron) * spacing; 2]
        };
        Lattice { origin, width: self.width(config), spacing }
    }

    /// Checks that the apron and the patch coordinates are in bounds.
    ///
    /// # Errors
    /// [`InputError`] when the apron exceeds [`MAX_APRON`], or when world coordinates, including halos, exceed `i32`.
    pub fn validate(&self, config: &TerrainConfig) -> Result<(), InputError> {
        if self.apron > MAX_APRON {
            return Err(InputError::new("apron", self.apron, format!("must be at most {MAX_APRON} samples")));
        }
        for (axis, span) in self.levels(config)[0].iter().enumerate() {
            if !is_in_world(config, span) {
                let field = format!("patchCoordinates[{axis}]");
                let bound = "world coordinates (4096 a patch) with the patch's halo must fit i32";
                return Err(InputError::new(field, self.patch[axis], bound));
            }
        }
        Ok(())
    }
}

/// A square lattice in world coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Lattice {
    /// World coordinates (X, Y) of the first point; a multiple of `spacing`.
    pub origin: [i64; 2],
    /// Number of points along an edge.
    pub width: u32,
    /// Distance between neighbouring points in world coordinates.
    pub spacing: i64,
}

impl Lattice {
    /// The same lattice, enlarged by `rim` points on every side.
    #[cfg(feature = "gpu")]
    pub(crate) fn grown(self, rim: u32) -> Self {
        let origin = self.origin.map(|start| start - i64::from(rim) * self.spacing);
        Self { origin, width: self.width + 2 * rim, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::features::Features;
    use crate::terrain::height::reference::height;
    use crate::terrain::smooth::reference::smooth;

    /// A coarser region has every second sample of the finer one, to the bit, on both sides of the origin.
    #[test]
    fn coarser_regions_have_every_second_sample() {
        for interpolation in [HeightInterpolation::Linear, HeightInterpolation::Smooth] {
            let config = TerrainConfig {
                coarse_levels: 3,
                interpolation,
                ..TerrainConfig::new(17, 40.0, "regions").expect("valid")
            };
            let made = if interpolation == HeightInterpolation::Linear { height } else { smooth };
            let heights = |first: [i64; 2], width: u32, coarser: u32| {
                let region = Region { first, width, coarser };
                region.validate(&config).expect("inside");
                made(&config, &Features::default(), None, region)
            };
            for coarser in 0..config.levels() {
                let (fine, coarse) = (heights([-14, 6], 21, coarser), heights([-7, 3], 11, coarser + 1));
                for (at, height) in coarse.iter().enumerate() {
                    assert_eq!(*height, fine[at / 11 * 2 * 21 + at % 11 * 2], "{coarser} {at}");
                }
            }
        }
    }
}
