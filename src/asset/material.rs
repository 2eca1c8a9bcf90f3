//! What meshes look like: the colours of glTF's materials, with their textures and what becomes of alpha.

/// The longest edge of an image: WebGPU's default limit.
pub const MAX_TEXELS: u32 = 8192;

/// The colour of a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// As the file has it.
    pub name: String,
    /// Linear red, green and blue, and alpha, each 0 to 1. A texture is multiplied with it.
    pub color: [f32; 4],
    /// sRGB colour and alpha.
    pub texture: Option<Texture>,
    /// What becomes of alpha.
    pub alpha: Alpha,
}

/// An image, and how it is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Texture {
    /// Which of the model's images.
    pub image: usize,
    /// Between and beyond its texels.
    pub sampling: Sampling,
}

/// How a texture is read between its texels and beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sampling {
    /// Beyond the edges, along u and v.
    pub wrap: [Wrapping; 2],
    /// Where texels are larger than pixels.
    pub magnified: Filter,
    /// Where they are smaller.
    pub minified: Filter,
    /// Between mip levels; without, there are none.
    pub mips: Option<Filter>,
}

impl Default for Sampling {
    /// Repeats, and is linear in everything.
    fn default() -> Self {
        let linear = Filter::Linear;
        Self { wrap: [Wrapping::Repeat; 2], magnified: linear, minified: linear, mips: Some(linear) }
    }
}

/// What lies beyond an image's edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wrapping {
    /// The image again.
    Repeat,
    /// The image again, every other one turned round.
    Mirror,
    /// Its last texel.
    Clamp,
}

/// What lies between texels, or between mip levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Filter {
    /// The nearest.
    Nearest,
    /// A mean by distance.
    Linear,
}

/// What becomes of alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Alpha {
    /// Nothing: all of the surface is seen.
    Opaque,
    /// What has less than this is not there.
    Mask(f32),
    /// As many of each 4 × 4 pixels are there as alpha says: a screen-door. It needs no order of triangles, and writes
    /// depth. Of two such surfaces, one behind the other, the nearer hides all that is no denser than itself.
    Dithered,
}

/// The alpha below which a pixel of [`Alpha::Dithered`] is not there: the rank of its place among 4 × 4 (Bayer 1973),
/// between 0 and 1.
pub fn dithered([x, y]: [u32; 2]) -> f32 {
    let rank = |x: u32, y: u32| 2 * (x ^ y) + y;
    ((4 * rank(x & 1, y & 1) + rank(x >> 1 & 1, y >> 1 & 1)) as f32 + 0.5) / 16.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_of_the_screen_has_a_rank_of_its_own() {
        let all = |size: u32| (0..size * size).map(move |at| dithered([at % size, at / size]));
        let mut ranks: Vec<f32> = all(4).collect();
        ranks.sort_by(f32::total_cmp);
        assert_eq!(ranks, (0..16).map(|rank| (rank as f32 + 0.5) / 16.0).collect::<Vec<_>>());
        assert_eq!(dithered([5, 6]), dithered([1, 2]));
        // Half of the pixels at an alpha of ½ are a chequerboard.
        assert!((0..16).all(|at| (dithered([at % 4, at / 4]) < 0.5) == ((at % 4 + at / 4) % 2 == 0)));
    }
}
