//! Materials: glTF base colours with their textures, normal maps, and the use of alpha.

use serde::{Deserialize, Serialize};

/// Longest edge of an image in texels: WebGPU's default limit.
pub const MAX_TEXELS: u32 = 8192;

/// Base colour and normal map of a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The material's name in the file.
    pub name: String,
    /// Linear red, green and blue, and alpha, each 0 to 1. They are multiplied by the texture.
    pub color: [f32; 4],
    /// Texture with sRGB colour and linear alpha.
    pub texture: Option<Texture>,
    /// Normal map, if there is one, sampled at the same texture coordinates as the texture. Linear red, green and blue from 0
    /// to 1 stand for −1 to 1 along the tangent, against the bitangent and along the normal. Green therefore points up in the
    /// image, as in glTF, and the bitangent of [`Mesh::tangents`](crate::asset::Mesh::tangents) points down.
    pub normal: Option<Texture>,
    /// Factor of the normal map's components along the tangent and against the bitangent; the result is normalized.
    pub normal_scale: f32,
    /// Use of alpha.
    pub alpha: Alpha,
}

impl Material {
    /// An opaque colour without textures.
    pub fn opaque(name: &str, color: [f32; 4]) -> Self {
        let (name, alpha) = (name.to_owned(), Alpha::Opaque);
        Self { name, color, texture: None, normal: None, normal_scale: 1.0, alpha }
    }
}

/// A reference to an image, with its sampling.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Texture {
    /// Index of the image in the model.
    pub image: usize,
    /// Filtering and wrapping.
    pub sampling: Sampling,
}

/// Filtering of a texture between its texels, and wrapping beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sampling {
    /// Wrapping along u and v.
    pub wrap: [Wrapping; 2],
    /// Filter where texels are larger than pixels.
    pub magnified: Filter,
    /// Filter where texels are smaller than pixels.
    pub minified: Filter,
    /// Filter between mip levels; `None` means that there are no mip levels.
    pub mips: Option<Filter>,
}

impl Default for Sampling {
    /// Repeats, with linear filters throughout.
    fn default() -> Self {
        let linear = Filter::Linear;
        Self { wrap: [Wrapping::Repeat; 2], magnified: linear, minified: linear, mips: Some(linear) }
    }
}

/// Texture content beyond the edge of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wrapping {
    /// The image repeats.
    Repeat,
    /// The image repeats, and every second copy is mirrored.
    Mirror,
    /// The texel at the edge continues.
    Clamp,
}

/// Method that computes values between texels, or between mip levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Filter {
    /// The nearest value.
    Nearest,
    /// Linear interpolation.
    Linear,
}

/// Use of alpha.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Alpha {
    /// Alpha is ignored: the whole surface is opaque.
    Opaque,
    /// Parts with an alpha below this value are not drawn.
    Mask(f32),
    /// Screen-door transparency: alpha decides how many of each 4 × 4 pixels are drawn. Triangles need no sorting, and depth is
    /// written. Where two such surfaces overlap, the nearer hides the other completely unless the other is denser.
    Dithered,
    /// Blended with what lies behind it. In scenes, only the layer `render::Layer::Transparent` draws such surfaces, from back
    /// to front, instance by instance. Without that layer, the surface is drawn as [`Alpha::Dithered`].
    Blended,
}

/// Threshold for a pixel of [`Alpha::Dithered`], between 0 and 1: pixels with a lower alpha are not drawn. It is the rank of
/// the pixel's position in a 4 × 4 ordered-dither matrix (Bayer 1973).
pub fn dither_threshold([x, y]: [u32; 2]) -> f32 {
    let rank = |x: u32, y: u32| 2 * (x ^ y) + y;
    ((4 * rank(x & 1, y & 1) + rank(x >> 1 & 1, y >> 1 & 1)) as f32 + 0.5) / 16.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_the_screen_has_a_rank_of_its_own() {
        let all = |size: u32| (0..size * size).map(move |at| dither_threshold([at % size, at / size]));
        let mut ranks: Vec<f32> = all(4).collect();
        ranks.sort_by(f32::total_cmp);
        assert_eq!(ranks, (0..16).map(|rank| (rank as f32 + 0.5) / 16.0).collect::<Vec<_>>());
        assert_eq!(dither_threshold([5, 6]), dither_threshold([1, 2]));
        // At an alpha of ½ the drawn pixels form a chequerboard.
        assert!((0..16).all(|at| (dither_threshold([at % 4, at / 4]) < 0.5) == ((at % 4 + at / 4) % 2 == 0)));
    }
}
