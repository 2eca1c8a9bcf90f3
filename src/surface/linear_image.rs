//! Images in linear light, which can be averaged before they are encoded as sRGB.

use crate::srgb;

/// Image with linear red, green and blue, row by row from the top left.
#[derive(Debug, Clone, PartialEq)]
pub struct LinearImage {
    /// Number of pixels along x and y.
    pub size: [u32; 2],
    /// All pixels, `size[0] * size[1]`, each with linear red, green and blue.
    pub pixels: Vec<[f32; 3]>,
}

impl LinearImage {
    /// Returns the image reduced by `factor`: each pixel is the mean of `factor` × `factor` pixels. Incomplete blocks at the
    /// right and bottom edges are cut off.
    pub fn reduced(&self, factor: u32) -> Self {
        let size = self.size.map(|edge| edge / factor);
        let fraction = 1.0 / (factor * factor) as f32;
        let mean = |x: u32, y: u32| {
            let mut sum = [0.0; 3];
            for (dx, dy) in (0..factor).flat_map(|dy| (0..factor).map(move |dx| (dx, dy))) {
                let index = (y * factor + dy) as usize * self.size[0] as usize + (x * factor + dx) as usize;
                sum.iter_mut().zip(self.pixels[index]).for_each(|(sum, channel)| *sum += channel);
            }
            sum.map(|channel| channel * fraction)
        };
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| mean(x, y));
        Self { size, pixels: pixels.collect() }
    }

    /// Encodes the image as opaque 8-bit sRGB.
    pub fn encoded(&self) -> image::RgbaImage {
        let [width, height] = self.size;
        image::RgbaImage::from_fn(width, height, |x, y| {
            let [r, g, b] = self.pixels[y as usize * width as usize + x as usize].map(srgb::byte);
            image::Rgba([r, g, b, 255])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_taken_of_light() {
        let pixels = [0.0, 1.0, 0.5, 0.5, 1.0, 0.0, 0.5, 0.5, 9.0, 9.0, 9.0, 9.0].map(|light| [light; 3]);
        let image = LinearImage { size: [4, 3], pixels: pixels.to_vec() };
        let half = image.reduced(2);
        assert_eq!(half, LinearImage { size: [2, 1], pixels: vec![[0.5; 3], [0.5; 3]] });
        assert_eq!(half.encoded().get_pixel(0, 0).0, [188, 188, 188, 255]);
    }
}
