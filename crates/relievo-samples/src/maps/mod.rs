//! Generated height maps with matching colours, for tests, demonstrations and first steps without a file.
//!
//! Each map is a square tile of any size. It repeats without a seam under
//! [`Address::Wrap`](relievo::ops::surface::Address::Wrap), and is the same bits on every machine. The code uses only `+ − × ÷`,
//! square roots and comparisons, which IEEE 754 defines to the last bit. Randomness is counter-based ([`relievo::ops::hash`]).
//!
//! | map | what it shows |
//! |---|---|
//! | [`Bricks`](BuiltInMap::Bricks) | running bond with bevelled edges: flat tops, steep flanks, deep joints |
//! | [`Cobbles`](BuiltInMap::Cobbles) | rounded stones: slopes of every steepness, almost no flat parts |
//! | [`Text`](BuiltInMap::Text) | raised and carved letters: fine detail, as in B's close-ups |
//! | [`Posts`](BuiltInMap::Posts) | posts of 2 to 4 texels at size 256, which a search in steps misses (B figure 3.6) |
//!
//! The letters are from the typeface Hack (MIT and Bitstream Vera licences: `fonts/Hack-LICENSE.txt`).

use std::str::FromStr;

use image::{Rgba, RgbaImage};
use relievo::InputError;
use relievo::ops::surface::map::{HeightMap, MAP_EDGE};
use relievo::parallel::map_range;

mod bricks;
mod cobbles;
mod letters;
mod noise;
mod posts;
mod text;

/// A generated height map with matching colours, which needs no file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum BuiltInMap {
    /// A brick wall in running bond: eight courses of four bricks.
    Bricks,
    /// A pavement of a hundred rounded stones (10 × 10).
    Cobbles,
    /// A slab with a raised word, a carved line of text below it, and a carved frame.
    Text,
    /// Thin tall posts on a low floor, 8 × 8 of them.
    Posts,
}

/// Height and colour of a map at one point.
#[derive(Debug, Clone, Copy)]
struct Sample {
    /// Height from 0 to 1; rounding may exceed this range slightly.
    height: f64,
    /// Colour in sRGB, 0 to 255.
    color: [f64; 3],
}

/// A map as a function of position. It repeats with period 1 in `u` (to the right) and `v` (down).
trait Pattern: Sync {
    fn at(&self, u: f64, v: f64) -> Sample;
}

impl BuiltInMap {
    /// All built-in maps.
    pub const ALL: [Self; 4] = [Self::Bricks, Self::Cobbles, Self::Text, Self::Posts];

    /// Name of the map in lower case, as [`FromStr`] accepts it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bricks => "bricks",
            Self::Cobbles => "cobbles",
            Self::Text => "text",
            Self::Posts => "posts",
        }
    }

    /// Heights of the map, as a tile of `size` × `size` texels.
    ///
    /// # Errors
    /// [`InputError`] for a size that is not in 1..=[`MAP_EDGE`].
    pub fn height_map(self, size: u32) -> Result<HeightMap, InputError> {
        let heights = self.samples(size, |sample| sample.height.clamp(0.0, 1.0) as f32)?;
        HeightMap::new(size, size, heights)
    }

    /// Colours of the map, as a tile of `size` × `size` texels: opaque sRGB without light or shadow, row by row from the top
    /// left.
    ///
    /// # Errors
    /// [`InputError`] as [`BuiltInMap::height_map`].
    pub fn albedo(self, size: u32) -> Result<RgbaImage, InputError> {
        let texels = self.samples(size, |sample| {
            let [r, g, b] = sample.color.map(|channel| (channel + 0.5) as u8);
            Rgba([r, g, b, u8::MAX])
        })?;
        let at = |x: u32, y: u32| texels[y as usize * size as usize + x as usize];
        Ok(RgbaImage::from_fn(size, size, at))
    }

    /// Evaluates the map at the center of every texel, and passes each sample to `texel`. The results are row by row.
    fn samples<T: Send>(self, size: u32, texel: impl Fn(Sample) -> T + Sync) -> Result<Vec<T>, InputError> {
        if !(1..=MAP_EDGE).contains(&size) {
            return Err(InputError::new("size", size, format!("must be in 1..={MAP_EDGE} texels")));
        }
        let pattern = self.pattern(size);
        let center = |index: usize| (index as f64 + 0.5) / f64::from(size);
        let edge = size as usize;
        Ok(map_range(edge * edge, |at| texel(pattern.at(center(at % edge), center(at / edge)))))
    }

    fn pattern(self, size: u32) -> Box<dyn Pattern> {
        match self {
            Self::Bricks => Box::new(bricks::Bricks::new()),
            Self::Cobbles => Box::new(cobbles::Cobbles::new()),
            Self::Text => Box::new(text::Text::new()),
            Self::Posts => Box::new(posts::Posts::new(size)),
        }
    }
}

impl FromStr for BuiltInMap {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|map| map.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            InputError::new("map", name, format!("must be one of {names}"))
        })
    }
}

/// Linear interpolation: `a` for fractions of 0 or less, `b` for fractions of 1 or more.
fn blend(a: f64, b: f64, fraction: f64) -> f64 {
    a + (b - a) * fraction.clamp(0.0, 1.0)
}

/// Linear interpolation of two colours, channel by channel, with the fraction clamped to 0..=1.
fn blend_color(a: [f64; 3], b: [f64; 3], fraction: f64) -> [f64; 3] {
    std::array::from_fn(|channel| blend(a[channel], b[channel], fraction))
}

/// Multiplies a colour by a factor near 1, and clamps its channels to 0..=255.
fn shade(color: [f64; 3], factor: f64) -> [f64; 3] {
    color.map(|channel| (channel * factor).clamp(0.0, 255.0))
}

/// Smooth cubic step: 0 below `from`, 1 above `to`.
fn smooth_step(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use sha2::Digest;
    use sha2::Sha256;

    use super::*;
    use relievo::ops::surface::Address;

    const SIZES: [u32; 4] = [1, 37, 100, 256];

    fn hash(bytes: &[u8]) -> String {
        Sha256::digest(bytes).iter().take(8).map(|byte| format!("{byte:02x}")).collect()
    }

    #[test]
    fn names_are_read_back_and_others_refused() {
        for map in BuiltInMap::ALL {
            assert_eq!(map.name().parse(), Ok(map));
        }
        for wrong in ["", "Bricks", "brick", "rock"] {
            let error = wrong.parse::<BuiltInMap>().expect_err("refused");
            assert_eq!((error.path.as_str(), error.value.as_str()), ("map", wrong));
            assert!(error.bound.contains("bricks, cobbles, text, posts"), "{error}");
        }
    }

    #[test]
    fn sizes_out_of_bounds_are_refused() {
        for size in [0, MAP_EDGE + 1, u32::MAX] {
            let heights = BuiltInMap::Posts.height_map(size).expect_err("refused");
            let albedo = BuiltInMap::Posts.albedo(size).expect_err("refused");
            assert_eq!(heights, albedo);
            assert_eq!((heights.path, heights.value), ("size".to_owned(), size.to_string()));
        }
    }

    #[test]
    fn every_size_gives_heights_that_use_the_range() {
        for map in BuiltInMap::ALL {
            for size in SIZES {
                let heights = map.height_map(size).expect("a map");
                assert_eq!((heights.width(), heights.height()), (size, size));
                let low = heights.heights().iter().copied().fold(1.0, f32::min);
                let high = heights.heights().iter().copied().fold(0.0, f32::max);
                assert!(size < 100 || (low < 0.3 && high > 0.9), "{}: {low} to {high}", map.name());
                assert_eq!(map.albedo(size).expect("colours").dimensions(), (size, size));
            }
        }
    }

    /// Known hashes of all maps, equal on every machine. A change of a hash also changes the input of every user's measurements.
    #[test]
    fn maps_are_the_same_bits_everywhere() {
        let known = [
            (BuiltInMap::Bricks, "36389e0e499cdcf2", "94171fd3030da535"),
            (BuiltInMap::Cobbles, "148b03ad86fdb700", "9d150bcfefa0e55a"),
            (BuiltInMap::Text, "77ab54d359959c21", "2258340b646338c5"),
            (BuiltInMap::Posts, "0846962f9e213b57", "4adaeff69acc1cfe"),
        ];
        for (map, heights, colors) in known {
            let bytes: Vec<u8> = (map.height_map(100).expect("a map").heights().iter())
                .flat_map(|height| height.to_le_bytes())
                .collect();
            let albedo = map.albedo(100).expect("colours");
            assert_eq!([hash(&bytes), hash(albedo.as_raw())], [heights, colors], "{}", map.name());
        }
    }

    /// Across the tile's edge, heights change no more than they change inside the tile.
    #[test]
    fn maps_tile() {
        for map in BuiltInMap::ALL {
            let pattern = map.pattern(256);
            for step in 0..1000 {
                let along = f64::from(step) / 1000.0;
                for [inside, outside] in [[[0.0, along], [1.0, along]], [[along, 0.0], [along, 1.0]]] {
                    let [inside, outside] = [inside, outside].map(|[u, v]| pattern.at(u, v));
                    let difference = (inside.height - outside.height).abs();
                    assert!(difference < 1e-9, "{} at {along}: {difference}", map.name());
                }
            }
            for size in [100, 256] {
                let map = map.height_map(size).expect("a map");
                let jump = |from: i32| {
                    let columns = (0..size as i32).map(|y| (map.texel(from, y, Address::Wrap), y));
                    let jumps = columns.map(|(left, y)| (left - map.texel(from + 1, y, Address::Wrap)).abs());
                    jumps.sum::<f32>() / size as f32
                };
                let largest = (0..size as i32 - 1).map(jump).fold(0.0, f32::max);
                assert!(jump(size as i32 - 1) <= largest, "a seam at size {size}");
            }
        }
    }

    /// Measures runs of texels that are above half of the posts' height, along each row and each column.
    #[test]
    fn posts_are_thin_and_tall() {
        let map = BuiltInMap::Posts.height_map(256).expect("a map");
        let mut widths = std::collections::BTreeMap::new();
        for line in 0..256 {
            for across in [true, false] {
                let at = |along: i32| match across {
                    true => map.texel(along, line, Address::Wrap) > 0.5,
                    false => map.texel(line, along, Address::Wrap) > 0.5,
                };
                for start in (0..256).filter(|start| at(*start) && !at(start - 1)) {
                    let width = (start..).take_while(|along| at(*along)).count();
                    *widths.entry(width).or_insert(0) += 1;
                }
            }
        }
        assert!(widths.keys().eq(&[2, 3, 4]), "runs by width: {widths:?}");
        let high = map.heights().iter().filter(|height| **height > 0.5).count();
        let floor = map.heights().iter().filter(|height| **height < 0.2).count();
        assert_eq!(high + floor, 256 * 256, "posts have vertical flanks");
        assert!((300..1500).contains(&high), "{high} texels of posts");
    }

    #[test]
    fn small_maps_keep_their_posts() {
        for size in [32, 64, 100] {
            let map = BuiltInMap::Posts.height_map(size).expect("a map");
            let high = map.heights().iter().filter(|height| **height > 0.5).count();
            assert!(high >= posts::COUNT, "{high} texels of posts at size {size}");
        }
    }
}
