//! Pictures side by side, each above its caption.

use image::{DynamicImage, Rgb, RgbImage, RgbaImage};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use relievo::InputError;

use crate::plot::letters::{register, style};

/// The size of the letters, and the distance of lines, in pixels.
const TEXT: f64 = 15.0;
const LINE: i32 = 20;

/// The distance between pictures and around all of them, in pixels.
const GAP: u32 = 8;

/// The largest width and height, in pixels.
const MAX_EDGE: u32 = 16_384;

/// Draws pictures of one size in rows of `columns`, each above lines of text.
///
/// # Errors
/// [`InputError`] for no pictures, pictures of several sizes, numbers of captions that do not match, 0 columns, and more than
/// 16,384 pixels in width or height.
pub fn strip(
    pictures: &[RgbaImage],
    captions: &[Vec<String>],
    columns: usize,
) -> Result<RgbaImage, InputError> {
    let Some(first) = pictures.first().filter(|_| columns > 0) else {
        let (path, value) = if columns == 0 { ("columns", columns) } else { ("pictures.len", 0) };
        return Err(InputError::new(path, value, "must be at least 1"));
    };
    if captions.len() != pictures.len() {
        let bound = format!("must be {}, one a picture", pictures.len());
        return Err(InputError::new("captions.len", captions.len(), bound));
    }
    if let Some(at) = pictures.iter().position(|picture| picture.dimensions() != first.dimensions()) {
        let value = format!("{:?}", pictures[at].dimensions());
        return Err(InputError::new(format!("pictures[{at}]"), value, "must be as large as the first"));
    }
    let lines = captions.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let cell = [first.width() + GAP, first.height() + lines * LINE as u32 + 2 * GAP];
    let columns = columns.min(pictures.len());
    let rows = pictures.len().div_ceil(columns);
    let size =
        [columns as u32, rows as u32].into_iter().zip(cell).map(|(count, edge)| count.saturating_mul(edge));
    let [width, height] = [0, 1].map(|axis| size.clone().nth(axis).unwrap_or(0).saturating_add(GAP));
    if width.max(height) > MAX_EDGE {
        let bound = format!("must be at most {MAX_EDGE} pixels wide and high");
        return Err(InputError::new("strip", format!("{width} × {height}"), bound));
    }
    let corner = |at: usize| [GAP + (at % columns) as u32 * cell[0], GAP + (at / columns) as u32 * cell[1]];
    let mut all = RgbImage::from_pixel(width, height, Rgb([255; 3]));
    for (at, picture) in pictures.iter().enumerate() {
        let [left, top] = corner(at);
        let rgb = DynamicImage::ImageRgba8(picture.clone()).into_rgb8();
        image::imageops::replace(&mut all, &rgb, left.into(), top.into());
    }
    let places = (0..pictures.len()).map(|at| {
        let [left, top] = corner(at);
        ((left + first.width() / 2) as i32, (top + first.height()) as i32 + LINE)
    });
    write(&mut all, captions.iter().zip(places))
        .map_err(|reason| InputError::new("captions", captions.len(), reason.to_string()))?;
    Ok(DynamicImage::ImageRgb8(all).into_rgba8())
}

/// Writes lines of text, each of which is centered at its place or below.
fn write<'a>(
    all: &mut RgbImage,
    captions: impl Iterator<Item = (&'a Vec<String>, (i32, i32))>,
) -> Result<(), Box<dyn std::error::Error>> {
    register();
    let size = all.dimensions();
    let area = BitMapBackend::with_buffer(all, size).into_drawing_area();
    let style = style(TEXT, HPos::Center, RGBColor(40, 40, 40));
    for (lines, (x, y)) in captions {
        for (line, text) in (0..).zip(lines) {
            area.draw(&Text::new(text.as_str(), (x, y + line * LINE), style.clone()))?;
        }
    }
    Ok(area.present()?)
}

#[cfg(test)]
mod tests {
    use image::Rgba;

    use super::*;

    #[test]
    fn pictures_stand_above_their_captions() {
        let picture = |red: u8| RgbaImage::from_pixel(50, 30, Rgba([red, 0, 0, 9]));
        let captions = |text: &str| vec![text.to_owned(), "two".to_owned()];
        let pictures = [picture(10), picture(20), picture(30)];
        let all = strip(&pictures, &[captions("one"), captions(""), vec![]], 2).expect("valid");
        assert_eq!(all.dimensions(), (2 * 58 + 8, 2 * (30 + 40 + 16) + 8));
        assert_eq!(
            [(8, 8), (66 + 49, 8 + 29), (8, 86 + 8)].map(|(x, y)| all.get_pixel(x, y)[0]),
            [10, 20, 30]
        );
        let dark = |x: std::ops::Range<u32>, y: std::ops::Range<u32>| {
            y.flat_map(|y| x.clone().map(move |x| (x, y)))
                .any(|(x, y)| all.get_pixel(x, y)[1] < 128 && all.get_pixel(x, y)[0] > 30)
        };
        assert!(dark(8..58, 50..68) && dark(66..116, 70..88) && !dark(66..116, 50..66), "captions");
        assert!(!dark(8..116, 128..178), "the third has none");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let picture = |edge: u32| RgbaImage::new(edge, edge);
        let refused = |pictures: &[RgbaImage], captions: usize, columns: usize| {
            strip(pictures, &vec![vec![]; captions], columns).expect_err("refused").path
        };
        assert_eq!(refused(&[], 0, 1), "pictures.len");
        assert_eq!(refused(&[picture(2)], 1, 0), "columns");
        assert_eq!(refused(&[picture(2)], 2, 1), "captions.len");
        assert_eq!(refused(&[picture(2), picture(3)], 2, 1), "pictures[1]");
        assert_eq!(refused(&[picture(9000), picture(9000)], 2, 2), "strip");
    }
}
