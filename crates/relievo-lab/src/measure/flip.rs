//! FLIP: how different two pictures look when one flips between them, 0 to 1 a pixel (Andersson, Nilsson, Akenine-Möller,
//! Oskarsson, Åström and Fairchild 2020; `docs/sources.md`), by the code of the paper's authors.

use image::{DynamicImage, RgbaImage};
use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool};
use relievo::InputError;

/// The mean FLIP of two pictures of the same size; alpha is ignored.
///
/// # Errors
/// [`InputError`] for pictures of different sizes or without pixels.
pub fn mean_flip(a: &RgbaImage, b: &RgbaImage) -> Result<f64, InputError> {
    if a.dimensions() != b.dimensions() || a.is_empty() {
        let value = format!("{:?} and {:?}", a.dimensions(), b.dimensions());
        return Err(InputError::new("pictures", value, "must have the same size, and pixels"));
    }
    let [a, b] = [a, b].map(|image| {
        let rgb = DynamicImage::ImageRgba8(image.clone()).into_rgb8();
        FlipImageRgb8::with_data(rgb.width(), rgb.height(), rgb.as_raw())
    });
    Ok(FlipPool::from_image(&nv_flip::flip(a, b, DEFAULT_PIXELS_PER_DEGREE)).mean().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_grows_with_what_is_seen() {
        let noise = |x: u32, y: u32| ((x * 37 + y * 91).wrapping_mul(2_654_435_761) >> 24) as u8;
        let picture = |shift: u32| {
            RgbaImage::from_fn(90, 60, |x, y| {
                let x = (x + shift).min(89);
                image::Rgba([noise(x / 9, y / 7), noise(x / 5, y / 8), noise(x, y), 255])
            })
        };
        let [first, shifted] = [0, 1].map(picture);
        let [black, white] = [0, 255].map(|level| RgbaImage::from_pixel(90, 60, [level; 4].into()));
        let flip = |a, b| mean_flip(a, b).expect("one size");
        assert!(flip(&first, &first) < 1e-6 && flip(&black, &white) > 0.9);
        assert!((0.05..0.9).contains(&flip(&first, &shifted)), "{}", flip(&first, &shifted));
        assert!(mean_flip(&first, &RgbaImage::new(3, 3)).is_err());
    }
}
