//! Texture filtering and wrapping as samplers define them (Vulkan, chapter 16), computed exactly where samplers
//! may round.

use image::RgbaImage;
use relievo::asset::Model;
use relievo::asset::material::{Alpha, Filter, Material, Sampling, Wrapping};
use relievo::ops::surface::mips::Mips;
use relievo::srgb::linear;

/// The base colour of a surface.
#[derive(Debug, Clone)]
pub struct Surface {
    /// The factor of the texture: linear colour and alpha.
    pub factor: [f32; 4],
    /// The texture of colour and alpha.
    pub texture: Option<Texels>,
    /// How alpha is used.
    pub alpha: Alpha,
}

impl Surface {
    /// An opaque surface of one linear colour.
    pub fn plain([r, g, b]: [f32; 3]) -> Self {
        Self { factor: [r, g, b, 1.0], texture: None, alpha: Alpha::Opaque }
    }

    /// The surface of a model's material.
    ///
    /// # Panics
    /// For an image that the model does not have; see [`Model::material`].
    pub fn of(model: &Model, material: &Material) -> Self {
        let texture =
            material.texture.map(|texture| Texels::new(&model.images[texture.image], texture.sampling));
        Self { factor: material.color, texture, alpha: material.alpha }
    }

    /// Linear colour and alpha at `uv`, given the change of uv per pixel along x and along y.
    pub fn at(&self, uv: [f32; 2], steps: [[f32; 2]; 2]) -> [f32; 4] {
        let texel = self.texture.as_ref().map_or([1.0; 4], |texture| texture.sample(uv, steps));
        std::array::from_fn(|channel| texel[channel] * self.factor[channel])
    }
}

/// An image with its mip levels in linear light, and its sampler settings.
#[derive(Debug, Clone)]
pub struct Texels {
    levels: Vec<Level>,
    sampling: Sampling,
}

#[derive(Debug, Clone)]
struct Level {
    size: [usize; 2],
    texels: Vec<[f32; 4]>,
}

impl Texels {
    /// Converts an sRGB image.
    pub fn new(image: &RgbaImage, sampling: Sampling) -> Self {
        let images = match sampling.mips {
            Some(_) => Mips::of_color(image.clone()).levels,
            None => vec![image.clone()],
        };
        let light: Vec<f32> = (0..=255).map(linear).collect();
        let level = |image: &RgbaImage| Level {
            size: [image.width() as usize, image.height() as usize],
            texels: (image.pixels())
                .map(|texel| {
                    let [r, g, b] = [0, 1, 2].map(|channel| light[usize::from(texel.0[channel])]);
                    [r, g, b, f32::from(texel.0[3]) / 255.0]
                })
                .collect(),
        };
        Self { levels: images.iter().map(level).collect(), sampling }
    }

    /// The value at `uv`; see [`Surface::at`].
    pub fn sample(&self, uv: [f32; 2], steps: [[f32; 2]; 2]) -> [f32; 4] {
        let Sampling { magnified, minified, mips, .. } = self.sampling;
        let size = self.levels[0].size.map(|edge| edge as f32);
        let texels = steps.map(|[u, v]| (u * size[0]).hypot(v * size[1]));
        let level = libm::log2f(texels[0].max(texels[1]).max(1e-30));
        if level <= 0.0 {
            return self.read(0, uv, magnified);
        }
        let last = self.levels.len() - 1;
        match mips {
            None => self.read(0, uv, minified),
            Some(Filter::Nearest) => self.read((libm::roundf(level) as usize).min(last), uv, minified),
            Some(Filter::Linear) => {
                let below = (level as usize).min(last);
                let [a, b] = [below, (below + 1).min(last)].map(|level| self.read(level, uv, minified));
                mixed(a, b, level.fract())
            }
        }
    }

    fn read(&self, level: usize, uv: [f32; 2], filter: Filter) -> [f32; 4] {
        let level = &self.levels[level];
        let position = [0, 1].map(|axis| uv[axis] * level.size[axis] as f32);
        let texel = |x: i64, y: i64| {
            let [x, y] = [(x, 0), (y, 1)]
                .map(|(at, axis)| wrapped(at, level.size[axis] as i64, self.sampling.wrap[axis]));
            level.texels[y * level.size[0] + x]
        };
        if filter == Filter::Nearest {
            let [x, y] = position.map(|at| at.floor() as i64);
            return texel(x, y);
        }
        let low = position.map(|at| (at - 0.5).floor());
        let fraction = [0, 1].map(|axis| position[axis] - 0.5 - low[axis]);
        let [x, y] = low.map(|at| at as i64);
        let row = |y: i64| mixed(texel(x, y), texel(x.saturating_add(1), y), fraction[0]);
        mixed(row(y), row(y.saturating_add(1)), fraction[1])
    }
}

fn mixed(a: [f32; 4], b: [f32; 4], fraction: f32) -> [f32; 4] {
    std::array::from_fn(|channel| a[channel] + (b[channel] - a[channel]) * fraction)
}

fn wrapped(at: i64, size: i64, wrapping: Wrapping) -> usize {
    let inside = match wrapping {
        Wrapping::Repeat => at.rem_euclid(size),
        Wrapping::Clamp => at.clamp(0, size - 1),
        Wrapping::Mirror => match at.rem_euclid(2 * size) {
            at if at < size => at,
            at => 2 * size - 1 - at,
        },
    };
    inside as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    fn texels(sampling: Sampling) -> Texels {
        // Black, white; white, black.
        let square = |x: u32, y: u32| Rgba([255 * ((x + y) % 2) as u8; 4]);
        Texels::new(&RgbaImage::from_fn(2, 2, square), sampling)
    }

    fn red(texels: &Texels, uv: [f32; 2], step: f32) -> f32 {
        texels.sample(uv, [[step, 0.0], [0.0, step]])[0]
    }

    #[test]
    fn texels_are_found_and_filtered() {
        let sampling = Sampling { magnified: Filter::Nearest, ..Sampling::default() };
        let nearest = texels(sampling);
        assert_eq!(
            [[0.1, 0.1], [0.6, 0.1], [0.1, 0.6], [0.9, 0.9]].map(|uv| red(&nearest, uv, 0.1)),
            [0.0, 1.0, 1.0, 0.0]
        );
        let linear = texels(Sampling::default());
        assert_eq!(red(&linear, [0.25, 0.25], 0.1), 0.0);
        assert_eq!(red(&linear, [0.5, 0.25], 0.1), 0.5);
        // Averages are taken in linear light.
        assert!((red(&linear, [0.25, 0.25], 1.0) - 0.5).abs() < 0.01);
        // Halfway between two mip levels.
        assert!((red(&linear, [0.25, 0.25], 0.5_f32.sqrt()) - 0.25).abs() < 0.01);
        let plain = texels(Sampling { mips: None, minified: Filter::Nearest, ..sampling });
        assert_eq!(red(&plain, [0.1, 0.1], 5.0), 0.0);
        let stepped = texels(Sampling { mips: Some(Filter::Nearest), ..sampling });
        assert_eq!(red(&stepped, [0.25, 0.25], 0.6), 0.0);
        assert!((red(&stepped, [0.25, 0.25], 0.9) - 0.5).abs() < 0.01);
    }

    #[test]
    fn edges_wrap() {
        // Black, white, white.
        let line = RgbaImage::from_fn(3, 1, |x, _| Rgba([255 * u8::from(x > 0); 4]));
        let row = |wrap| {
            let sampling = Sampling { wrap: [wrap; 2], magnified: Filter::Nearest, ..Sampling::default() };
            let texels = Texels::new(&line, sampling);
            (-4..7).map(|x| red(&texels, [(x as f32 + 0.5) / 3.0, 7.5], 0.1) as u8).collect::<Vec<_>>()
        };
        assert_eq!(row(Wrapping::Repeat), [1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0]);
        assert_eq!(row(Wrapping::Mirror), [1, 1, 1, 0, 0, 1, 1, 1, 1, 0, 0]);
        assert_eq!(row(Wrapping::Clamp), [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1]);
    }

    #[test]
    fn positions_far_away_are_read() {
        for wrap in [Wrapping::Repeat, Wrapping::Mirror, Wrapping::Clamp] {
            let texels = texels(Sampling { wrap: [wrap; 2], ..Sampling::default() });
            for far in [1e18, -1e18] {
                assert!(red(&texels, [far, far], 1.0).is_finite());
            }
        }
    }
}
