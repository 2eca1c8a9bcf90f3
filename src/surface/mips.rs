//! Mip levels of colour and normal images.

use image::RgbaImage;

use crate::srgb;

/// An image with all its mip levels. Each texel of a level is the mean of four texels of the level before.
#[derive(Debug, Clone, PartialEq)]
pub struct Mips {
    /// Mip levels, from the image itself down to a single texel.
    pub levels: Vec<RgbaImage>,
    /// Whether red, green and blue are sRGB values. If true, mip levels are averaged in linear light.
    pub is_srgb: bool,
}

impl Mips {
    /// Computes the mip levels of an sRGB image, averaged in linear light.
    pub fn of_color(image: RgbaImage) -> Self {
        Self::new(image, true)
    }

    /// Computes the mip levels of an image whose channels are data, not colours.
    pub fn of_data(image: RgbaImage) -> Self {
        Self::new(image, false)
    }

    fn new(image: RgbaImage, is_srgb: bool) -> Self {
        let light: Vec<f32> = (0..=255).map(srgb::linear).collect();
        let mut levels = vec![image];
        while let Some(next) = levels.last().and_then(|level| halved(level, is_srgb, &light)) {
            levels.push(next);
        }
        Self { levels, is_srgb }
    }
}

/// Returns the next mip level; `None` if `image` is a single texel.
fn halved(image: &RgbaImage, is_srgb: bool, light: &[f32]) -> Option<RgbaImage> {
    let (width, height) = image.dimensions();
    if width * height <= 1 {
        return None;
    }
    let mean = |x: u32, y: u32| {
        let at =
            |dx: u32, dy: u32| image.get_pixel((2 * x + dx).min(width - 1), (2 * y + dy).min(height - 1));
        let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let channel = |channel: usize| {
            if is_srgb && channel < 3 {
                let sum: f32 = four.iter().map(|texel| light[usize::from(texel.0[channel])]).sum();
                return srgb::byte(sum / 4.0);
            }
            let sum: u32 = four.iter().map(|texel| u32::from(texel.0[channel])).sum();
            ((sum + 2) / 4) as u8
        };
        image::Rgba(std::array::from_fn(channel))
    };
    Some(RgbaImage::from_fn((width / 2).max(1), (height / 2).max(1), mean))
}
