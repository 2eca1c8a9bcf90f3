//! Materials: base colours with their textures as in glTF, normal maps, and transparency.

use serde::{Deserialize, Serialize};

/// Longest edge of an image in texels: WebGPU's default limit.
pub const MAX_TEXELS: u32 = 8192;

/// Base colour, normal map and transparency of a surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// The material's name in the file.
    pub name: String,
    /// Base colour: linear red, green, blue, and alpha, each 0 to 1. The texture, if there is one, is multiplied by this
    /// colour.
    pub color: [f32; 4],
    /// Texture of the base colour: sRGB colour and linear alpha.
    pub texture: Option<Texture>,
    /// Normal map, sampled at the same texture coordinates as the base colour. Red, green and blue are linear; 0 to 1 stands
    /// for −1 to 1. Red is the component along the tangent, green the component against the bitangent, blue the component along
    /// the normal.
    ///
    /// Green therefore points up in the image, as in glTF, and the bitangent of
    /// [`Mesh::tangents`](crate::asset::Mesh::tangents) points down.
    pub normal: Option<Texture>,
    /// Factor of the normal map's red and green components (tangent and bitangent). The resulting normal is normalized.
    pub normal_scale: f32,
    /// How alpha is used: opaque, masked, dithered or blended.
    pub alpha: Alpha,
    /// Physically based properties, which scenes do not draw.
    pub pbr: Pbr,
}

/// Physically based properties of a surface, as in glTF. They are read, stored and written, but scenes do not draw them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pbr {
    /// Metalness, 0 to 1; multiplied by the blue channel of `metallic_roughness`.
    pub metallic: f32,
    /// Roughness, 0 to 1; multiplied by the green channel of `metallic_roughness`.
    pub roughness: f32,
    /// Texture of roughness (green) and metalness (blue); linear.
    pub metallic_roughness: Option<PbrTexture>,
    /// Texture of ambient occlusion (red); linear. 1 is no occlusion.
    pub occlusion: Option<PbrTexture>,
    /// Strength of the occlusion, 0 to 1.
    pub occlusion_strength: f32,
    /// Emitted light: linear red, green and blue, each 0 to 1; multiplied by `emission`.
    pub emissive: [f32; 3],
    /// Texture of the emitted light; sRGB.
    pub emission: Option<PbrTexture>,
}

/// A texture with the set of texture coordinates at which it is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct PbrTexture {
    /// The image, with its filtering and wrapping.
    pub texture: Texture,
    /// The mesh's texture coordinates.
    pub uv: UvSet,
}

/// One of a mesh's two sets of texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum UvSet {
    /// [`Mesh::uv`](crate::asset::Mesh::uv).
    #[default]
    First,
    /// [`Mesh::second_uv`](crate::asset::Mesh::second_uv).
    Second,
}

impl Default for Pbr {
    /// A rough surface that is not metallic and emits nothing.
    fn default() -> Self {
        Self {
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness: None,
            occlusion: None,
            occlusion_strength: 1.0,
            emissive: [0.0; 3],
            emission: None,
        }
    }
}

impl Material {
    /// Builds an opaque material of one colour, without textures.
    pub fn opaque(name: &str, color: [f32; 4]) -> Self {
        let (name, alpha) = (name.to_owned(), Alpha::Opaque);
        Self { name, color, texture: None, normal: None, normal_scale: 1.0, alpha, pbr: Pbr::default() }
    }

    /// All textures, each with the path of its field.
    #[doc(hidden)]
    pub fn textures(&self) -> impl Iterator<Item = (&'static str, Texture)> {
        let Pbr { metallic_roughness, occlusion, emission, .. } = &self.pbr;
        let pbr = |one: &Option<PbrTexture>| one.map(|one| one.texture);
        let all = [
            ("texture", self.texture),
            ("normal", self.normal),
            ("pbr.metallic_roughness", pbr(metallic_roughness)),
            ("pbr.occlusion", pbr(occlusion)),
            ("pbr.emission", pbr(emission)),
        ];
        all.into_iter().filter_map(|(field, texture)| Some((field, texture?)))
    }

    /// Replaces each texture by the result of `map`.
    #[doc(hidden)]
    pub fn map_textures(&mut self, mut map: impl FnMut(Texture) -> Option<Texture>) {
        self.texture = self.texture.and_then(&mut map);
        self.normal = self.normal.and_then(&mut map);
        for one in [&mut self.pbr.metallic_roughness, &mut self.pbr.occlusion, &mut self.pbr.emission] {
            *one = one.and_then(|one| Some(PbrTexture { texture: map(one.texture)?, ..one }));
        }
    }
}

/// A reference to an image, with its filtering and wrapping.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Texture {
    /// Index of the image in the model.
    pub image: usize,
    /// Filtering between texels, and wrapping beyond the image's edges.
    pub sampling: Sampling,
}

/// Filtering of a texture between its texels, and wrapping beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sampling {
    /// Wrapping along u, then along v.
    pub wrap: [Wrapping; 2],
    /// Filter where texels are larger than pixels.
    pub magnified: Filter,
    /// Filter where texels are smaller than pixels.
    pub minified: Filter,
    /// Filter between mip levels; `None` means that there are no mip levels.
    pub mips: Option<Filter>,
}

impl Default for Sampling {
    /// Repeats along u and v, with linear filters between texels and between mip levels.
    fn default() -> Self {
        let linear = Filter::Linear;
        Self { wrap: [Wrapping::Repeat; 2], magnified: linear, minified: linear, mips: Some(linear) }
    }
}

/// What a texture shows beyond the edge of its image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wrapping {
    /// The image repeats.
    Repeat,
    /// The image repeats, and every second copy is mirrored.
    Mirror,
    /// The texels at the edge continue outwards.
    Clamp,
}

/// Method that computes a value between texels, or between mip levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Filter {
    /// Takes the nearest value.
    Nearest,
    /// Interpolates linearly between neighbouring values.
    Linear,
}

/// How a material uses alpha.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Alpha {
    /// Alpha is ignored: the whole surface is opaque.
    Opaque,
    /// Pixels with an alpha below this threshold are not drawn; all others are opaque.
    Mask(f32),
    /// Screen-door transparency: in each block of 4 × 4 pixels, alpha is the fraction of pixels that are drawn. Triangles need
    /// no sorting, and depth is written. Where two such surfaces overlap, the farther surface shows only if its alpha is
    /// larger.
    Dithered,
    /// Blending with the surfaces behind. In scenes, only the layer `render::Layer::Transparent` draws such surfaces, from back
    /// to front, instance by instance. Without that layer, the surface is drawn as [`Alpha::Dithered`].
    Blended,
}

/// Alpha threshold of a pixel for [`Alpha::Dithered`], between 0 and 1: a pixel with a lower alpha is not drawn. The threshold
/// is the rank of the pixel's position in a 4 × 4 ordered-dither matrix (Bayer 1973).
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
