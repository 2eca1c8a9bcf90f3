//! Rectangles of patches: the patches in them, the memory that they take, and their colour maps as one image.

use image::{Rgba, RgbaImage};

use relievo::InputError;

/// A rectangle of patches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Grid {
    /// Coordinates of the north-western patch.
    pub first: [i32; 2],
    /// Number of columns and rows of patches.
    pub size: [u32; 2],
}

impl Grid {
    /// The coordinates of the patches, row by row.
    ///
    /// # Errors
    /// [`InputError`] that names `origin` if a coordinate does not fit `i32`.
    pub fn patches(&self) -> Result<Vec<[i32; 2]>, InputError> {
        let coordinate = |index: u32, axis: usize| {
            let first = self.first[axis];
            i32::try_from(i64::from(first) + i64::from(index)).map_err(|_| {
                InputError::new(format!("origin[{axis}]"), first, "patch coordinates must fit i32")
            })
        };
        let [columns, rows] = self.size;
        let places = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
        places.map(|(x, y)| Ok([coordinate(x, 0)?, coordinate(y, 1)?])).collect()
    }

    /// Number of samples of all patches, if each is computed in a window of `width`² samples.
    pub fn samples(&self, width: u32) -> u128 {
        self.size.into_iter().chain([width; 2]).map(u128::from).fold(1, u128::saturating_mul)
    }

    /// About how many bytes the host needs to compute the patches in windows of `width`² samples, with
    /// `features` injected points, and to write them.
    pub fn bytes(&self, width: u32, features: u64) -> u128 {
        // While a patch is computed there are two windows; while it is written, heights, map and the files'
        // bytes. The index of features has eight bytes for every 32 points of every level, on the host and on
        // the device.
        let bytes_a_point = if features == 0 { 24 } else { 25 };
        // The features take a list as they are read, a sorted tree, and their values in a few windows and
        // levels.
        self.samples(width).saturating_mul(bytes_a_point).saturating_add(u128::from(features) * 128)
    }

    /// The colour maps of all patches as one image, north up, one pixel per sample. Each map has
    /// `patch_size`² pixels; maps are in the order of [`Grid::patches`]. Neighbours share a row or column of
    /// pixels.
    pub fn mosaic(&self, patch_size: u32, maps: &[Vec<u32>]) -> RgbaImage {
        let edge = patch_size - 1;
        let mut image = RgbaImage::new(self.size[0] * edge + 1, self.size[1] * edge + 1);
        for (index, map) in maps.iter().enumerate() {
            let (left, top) = (index as u32 % self.size[0] * edge, index as u32 / self.size[0] * edge);
            for (at, pixel) in map.iter().enumerate() {
                let (x, y) = (at as u32 % patch_size, at as u32 / patch_size);
                image.put_pixel(left + x, top + y, Rgba(pixel.to_le_bytes()));
            }
        }
        image
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patches_run_row_by_row_and_fit_i32() {
        let grid = Grid { first: [-1, 2], size: [2, 2] };
        assert_eq!(grid.patches(), Ok(vec![[-1, 2], [0, 2], [-1, 3], [0, 3]]));
        let beyond = Grid { first: [0, i32::MAX], size: [1, 2] };
        assert_eq!(beyond.patches().expect_err("refused").path, "origin[1]");
    }

    #[test]
    fn features_need_room() {
        let grid = Grid { first: [0; 2], size: [2, 3] };
        assert_eq!(grid.bytes(35, 0), 6 * 35 * 35 * 24);
        assert!(grid.bytes(35, 1) > grid.bytes(35, 0));
        assert!(grid.bytes(35, 1 << 30) > 1 << 37);
        let largest = Grid { first: [0; 2], size: [u32::MAX; 2] };
        assert!(largest.bytes(u32::MAX, u64::MAX) > u128::from(u64::MAX));
    }

    #[test]
    fn maps_share_their_edges() {
        let grid = Grid { first: [0; 2], size: [2, 1] };
        let image = grid.mosaic(3, &[vec![1; 9], vec![2; 9]]);
        assert_eq!(image.dimensions(), (5, 3));
        let reds: Vec<u8> = (0..5).map(|x| image.get_pixel(x, 1).0[0]).collect();
        assert_eq!(reds, [1, 1, 2, 2, 2]);
    }
}
