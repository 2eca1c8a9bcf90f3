//! Height maps: the input of all relief methods.

use std::path::Path;

use crate::asset::{decode_image, open_image};
use crate::shared::surface::ray;
use crate::{Error, InputError};

/// Largest edge length of a height map in texels: WebGPU's default limit for a texture.
pub const MAP_EDGE: u32 = 8192;

/// Address mode: how a height map continues beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
#[repr(u32)]
pub enum Address {
    /// The map repeats in both directions.
    #[default]
    Wrap = ray::SURFACE_WRAP,
    /// The texels at the edge are repeated without end.
    Clamp = ray::SURFACE_CLAMP,
}

impl Address {
    /// Name of the address mode in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wrap => "wrap",
            Self::Clamp => "clamp",
        }
    }

    /// Number of the address mode in the shaders.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(self) -> u32 {
        self as u32
    }
}

/// Height map of one tile: heights from 0 (lowest) to 1 (highest), row by row from the top left. The center of texel (i, j) is at
/// uv ((i + ½) / width, (j + ½) / height). Between texel centers, heights are interpolated bilinearly.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightMap {
    width: u32,
    height: u32,
    heights: Vec<f32>,
}

impl HeightMap {
    /// Builds a height map of `width` × `height` texels. `heights` has the rows from top to bottom.
    ///
    /// # Errors
    /// [`InputError`] for an edge outside 1 to [`MAP_EDGE`] texels, for a wrong number of heights, and for a height outside
    /// 0..=1.
    pub fn new(width: u32, height: u32, heights: Vec<f32>) -> Result<Self, InputError> {
        for (field, edge) in [("heights.width", width), ("heights.height", height)] {
            if !(1..=MAP_EDGE).contains(&edge) {
                return Err(InputError::new(field, edge, format!("must be in 1..={MAP_EDGE} texels")));
            }
        }
        if heights.len() != width as usize * height as usize {
            let bound = format!("must be {width} × {height} heights");
            return Err(InputError::new("heights.len", heights.len(), bound));
        }
        let is_fraction = |height: &f32| (0.0..=1.0).contains(height);
        InputError::check_each("heights", &heights, is_fraction, "must be in 0..=1")?;
        Ok(Self { width, height, heights })
    }

    /// Reads a height map from the brightness of an image file, with black as 0 and white as 1. The file's full bit depth is
    /// used.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read, [`InputError`] if the image has an unsupported size.
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Self::of_brightness(open(path)?).map_err(|source| Error::InputFile { path: path.to_owned(), source })
    }

    /// Builds a height map from the brightness of an image, with black as 0 and white as 1. The image's full bit depth is used.
    ///
    /// # Errors
    /// [`InputError`] if an edge of the image is outside 1 to [`MAP_EDGE`] texels.
    pub fn of_brightness(image: image::DynamicImage) -> Result<Self, InputError> {
        Self::of_samples(image.width(), image.height(), image.into_luma16().into_raw())
    }

    /// Reads a height map from the alpha channel of an image file. Also returns the decoded image.
    ///
    /// # Errors
    /// [`Error::File`] if the file cannot be read or has no alpha channel, [`InputError`] if the image has an unsupported size.
    pub fn from_alpha(path: &Path) -> Result<(Self, image::DynamicImage), Error> {
        let image = open(path)?;
        if !image.color().has_alpha() {
            return Err(Error::file(path, NO_ALPHA));
        }
        let map =
            Self::of_alpha(&image).map_err(|source| Error::InputFile { path: path.to_owned(), source })?;
        Ok((map, image))
    }

    /// Builds a height map from the alpha channel of an image. The image's full bit depth is used.
    ///
    /// # Errors
    /// [`InputError`] if the image has no alpha channel, or if an edge is outside 1 to [`MAP_EDGE`] texels.
    pub fn of_alpha(image: &image::DynamicImage) -> Result<Self, InputError> {
        if !image.color().has_alpha() {
            return Err(InputError::new("heights.image", format!("{:?}", image.color()), NO_ALPHA));
        }
        let alpha = image.to_rgba16().pixels().map(|pixel| pixel.0[3]).collect();
        Self::of_samples(image.width(), image.height(), alpha)
    }

    fn of_samples(width: u32, height: u32, samples: Vec<u16>) -> Result<Self, InputError> {
        Self::new(width, height, samples.into_iter().map(|sample| f32::from(sample) / 65_535.0).collect())
    }

    /// Number of texels per row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Number of rows of texels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All heights, 0 to 1, row by row from the top left.
    pub fn heights(&self) -> &[f32] {
        &self.heights
    }

    /// Returns the next mip level. Both edges are halved, rounded down but at least 1. Each texel is the mean of four texels of
    /// this level.
    #[cfg(feature = "gpu")]
    pub(crate) fn halved(&self) -> Self {
        let (width, height) = ((self.width / 2).max(1), (self.height / 2).max(1));
        let mean = |x: u32, y: u32| {
            let four = [[0, 0], [1, 0], [0, 1], [1, 1]];
            let texel =
                |[dx, dy]: [u32; 2]| self.texel((2 * x + dx) as i32, (2 * y + dy) as i32, Address::Clamp);
            four.map(texel).iter().sum::<f32>() / 4.0
        };
        let heights = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| mean(x, y));
        Self { width, height, heights: heights.collect() }
    }

    /// Height of the texel in column `x` and row `y`. Beyond the edges, `address` tells how the map continues.
    pub fn texel(&self, x: i32, y: i32, address: Address) -> f32 {
        let at = |index: i32, edge: u32| match address {
            Address::Wrap => index.rem_euclid(edge as i32),
            Address::Clamp => index.clamp(0, edge as i32 - 1),
        };
        self.heights[at(y, self.height) as usize * self.width as usize + at(x, self.width) as usize]
    }
}

const NO_ALPHA: &str = "has no alpha channel to take heights from";

/// Reads an image file. The size is checked first: no edge may be longer than [`MAP_EDGE`].
///
/// # Errors
/// [`Error::File`] if the file cannot be read or decoded.
pub fn open(path: &Path) -> Result<image::DynamicImage, Error> {
    open_image(path, limits())
}

/// Decodes an image from bytes. The size is checked first: no edge may be longer than [`MAP_EDGE`].
///
/// # Errors
/// Errors of the crate `image`: invalid data, or an edge that is too long.
pub fn decode(bytes: &[u8]) -> Result<image::DynamicImage, image::ImageError> {
    decode_image(bytes, limits())
}

fn limits() -> image::Limits {
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MAP_EDGE);
    limits.max_image_height = Some(MAP_EDGE);
    limits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_refuse_what_is_no_height_map() {
        let refused = |width, height, heights: Vec<f32>| {
            HeightMap::new(width, height, heights).expect_err("refused").path
        };
        assert_eq!(refused(0, 1, vec![]), "heights.width");
        assert_eq!(refused(1, MAP_EDGE + 1, vec![0.5]), "heights.height");
        assert_eq!(refused(2, 2, vec![0.5; 3]), "heights.len");
        for wrong in [-0.1, 1.1, f32::NAN, f32::INFINITY] {
            assert_eq!(refused(2, 1, vec![0.5, wrong]), "heights[1]");
        }
        assert!(HeightMap::new(1, 1, vec![1.0]).is_ok());
    }

    #[test]
    fn addresses_beyond_the_edge() {
        let map = HeightMap::new(3, 1, vec![0.1, 0.2, 0.3]).expect("a map");
        assert_eq!([-1, 3, 7].map(|x| map.texel(x, 5, Address::Wrap)), [0.3, 0.1, 0.2]);
        assert_eq!([-1, 3, 7].map(|x| map.texel(x, -5, Address::Clamp)), [0.1, 0.3, 0.3]);
    }
}
