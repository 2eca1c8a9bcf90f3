//! FLIP: how different two pictures look when one flips between them, 0 to 1 a pixel (Andersson, Nilsson, Akenine-Möller,
//! Oskarsson, Åström and Fairchild 2020, for pictures of 8 bits; `docs/sources.md`).

use glam::{DMat3, DVec3};
use image::RgbaImage;
use rayon::prelude::*;
use relievo::{InputError, srgb};

/// Pixels a degree of the observer's view: 0.7 m before a display 0.7 m wide with 3840 pixels, as the paper assumes.
const PIXELS_A_DEGREE: f64 = 67.020_643_276_582_3;

/// Linear red, green and blue to CIE XYZ (D65), by columns: the paper's own fractions.
const XYZ_FROM_RGB: DMat3 = DMat3::from_cols(
    DVec3::new(10_135_552.0 / 24_577_794.0, 2_613_072.0 / 12_288_897.0, 1_425_312.0 / 73_733_382.0),
    DVec3::new(8_788_810.0 / 24_577_794.0, 8_788_810.0 / 12_288_897.0, 8_788_810.0 / 73_733_382.0),
    DVec3::new(4_435_075.0 / 24_577_794.0, 887_015.0 / 12_288_897.0, 70_074_185.0 / 73_733_382.0),
);

/// The contrast sensitivity of each opponent channel: two Gaussians, each with a weight and a width (table 1 of the paper).
const SENSITIVITY: [[[f64; 2]; 2]; 3] =
    [[[1.0, 0.0047], [0.0, 1e-5]], [[1.0, 0.0053], [0.0, 1e-5]], [[34.1, 0.04], [13.5, 0.025]]];

/// Parameters of the color and of the feature difference (sections 4.1.3, 4.2 and 4.3 of the paper).
const COLOR_EXPONENT: f64 = 0.7;
const COLOR_KNEE: f64 = 0.4;
const COLOR_AT_KNEE: f64 = 0.95;
const FEATURE_WIDTH: f64 = 0.082;
const FEATURE_EXPONENT: f64 = 0.5;

/// The mean FLIP of two pictures of the same size, which is symmetric; alpha is ignored.
///
/// # Errors
/// [`InputError`] for pictures of different sizes or without pixels.
pub fn mean_flip(a: &RgbaImage, b: &RgbaImage) -> Result<f64, InputError> {
    if a.dimensions() != b.dimensions() || a.is_empty() {
        let value = format!("{:?} and {:?}", a.dimensions(), b.dimensions());
        return Err(InputError::new("pictures", value, "must have the same size, and pixels"));
    }
    let (a, b) = rayon::join(|| Seen::new(a), || Seen::new(b));
    let largest = color_difference(lab(DVec3::Y), lab(DVec3::Z));
    let error = |at: usize| {
        let color = spread(color_difference(a.lab[at], b.lab[at]), largest);
        let feature = |of: fn(&[[f64; 2]; 2]) -> f64| (of(&a.features[at]) - of(&b.features[at])).abs();
        let [edges, points] =
            [feature(|[edge, _]| edge[0].hypot(edge[1])), feature(|[_, point]| point[0].hypot(point[1]))];
        let feature = (edges.max(points) / std::f64::consts::SQRT_2).powf(FEATURE_EXPONENT);
        color.powf(1.0 - feature)
    };
    let sum: f64 = (0..a.lab.len()).map(error).sum();
    Ok(sum / a.lab.len() as f64)
}

/// A picture as an observer sees it.
struct Seen {
    /// After the filters of contrast sensitivity, in CIELAB with Hunt's adjustment.
    lab: Vec<DVec3>,
    /// Of each pixel, the derivatives of lightness along x and y: the first for edges, the second for points.
    features: Vec<[[f64; 2]; 2]>,
}

impl Seen {
    fn new(image: &RgbaImage) -> Self {
        let size = [image.width() as usize, image.height() as usize];
        let linear = |texel: &image::Rgba<u8>| {
            let [r, g, b] = [0, 1, 2].map(|channel: usize| f64::from(srgb::linear(texel.0[channel])));
            opponent(DVec3::new(r, g, b))
        };
        let pixels: Vec<DVec3> = image.pixels().map(linear).collect();
        let channel = |channel: usize| pixels.iter().map(move |pixel| pixel[channel]).collect::<Vec<f64>>();
        let filtered: Vec<Vec<f64>> =
            (0..3).into_par_iter().map(|at| sensed(&channel(at), size, SENSITIVITY[at])).collect();
        let at = |at: usize| DVec3::new(filtered[0][at], filtered[1][at], filtered[2][at]);
        let lightness: Vec<f64> = pixels.iter().map(|pixel| (pixel.x + 16.0) / 116.0).collect();
        Self {
            lab: (0..pixels.len()).into_par_iter().map(|index| lab(of_opponent(at(index)))).collect(),
            features: features(&lightness, size),
        }
    }
}

fn white() -> DVec3 {
    XYZ_FROM_RGB * DVec3::ONE
}

/// Linear light in the space YCxCz.
fn opponent(rgb: DVec3) -> DVec3 {
    let xyz = XYZ_FROM_RGB * rgb / white();
    DVec3::new(116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z))
}

/// Linear light of a color in YCxCz, as far as a display shows it.
fn of_opponent(color: DVec3) -> DVec3 {
    let y = (color.x + 16.0) / 116.0;
    let xyz = DVec3::new(color.y / 500.0 + y, y, y - color.z / 200.0) * white();
    (XYZ_FROM_RGB.inverse() * xyz).clamp(DVec3::ZERO, DVec3::ONE)
}

/// CIELAB of linear light, with chroma that fades in the dark (Hunt).
fn lab(rgb: DVec3) -> DVec3 {
    const DELTA: f64 = 6.0 / 29.0;
    let curve = |value: f64| match value > DELTA.powi(3) {
        true => value.cbrt(),
        false => value / (3.0 * DELTA * DELTA) + 4.0 / 29.0,
    };
    let [x, y, z] = (XYZ_FROM_RGB * rgb / white()).to_array().map(curve);
    let lightness = 116.0 * y - 16.0;
    let hunt = 0.01 * lightness;
    DVec3::new(lightness, hunt * 500.0 * (x - y), hunt * 200.0 * (y - z))
}

/// The HyAB distance to a power.
fn color_difference(a: DVec3, b: DVec3) -> f64 {
    let off = (a - b).abs();
    (off.x + off.y.hypot(off.z)).powf(COLOR_EXPONENT)
}

/// Maps differences up to the largest one to 0 to 1; those that matter take most of the range.
fn spread(difference: f64, largest: f64) -> f64 {
    let knee = COLOR_KNEE * largest;
    match difference < knee {
        true => COLOR_AT_KNEE / knee * difference,
        false => COLOR_AT_KNEE + (difference - knee) / (largest - knee) * (1.0 - COLOR_AT_KNEE),
    }
}

/// A channel as far as the eye resolves it.
fn sensed(channel: &[f64], size: [usize; 2], gaussians: [[f64; 2]; 2]) -> Vec<f64> {
    use std::f64::consts::PI;
    let widest = SENSITIVITY.as_flattened().iter().map(|[_, width]| *width).fold(0.0, f64::max);
    let radius = (3.0 * (widest / (2.0 * PI * PI)).sqrt() * PIXELS_A_DEGREE).ceil() as i64;
    let mut all = vec![0.0; channel.len()];
    let mut total = 0.0;
    for [weight, width] in gaussians.into_iter().filter(|[weight, _]| *weight > 0.0) {
        let kernel: Vec<f64> = (-radius..=radius)
            .map(|at| (-(PI * at as f64 / PIXELS_A_DEGREE).powi(2) / width).exp())
            .collect();
        let weight = weight * (PI / width).sqrt();
        total += weight * kernel.iter().sum::<f64>().powi(2);
        let filtered = convolved(channel, size, &kernel, &kernel);
        all.iter_mut().zip(filtered).for_each(|(sum, value)| *sum += weight * value);
    }
    all.iter_mut().for_each(|value| *value /= total);
    all
}

/// First and second derivatives along x and y.
fn features(lightness: &[f64], size: [usize; 2]) -> Vec<[[f64; 2]; 2]> {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_A_DEGREE;
    let radius = (3.0 * deviation).ceil() as i64;
    let kernel = |of: fn(f64) -> f64| -> Vec<f64> {
        let places = (-radius..=radius).map(|at| at as f64 / deviation);
        balanced(places.map(|at| of(at) * (-0.5 * at * at).exp()).collect())
    };
    let kernels = [kernel(|_| 1.0), kernel(|at| -at), kernel(|at| at * at - 1.0)];
    let [smooth, first, second] = &kernels;
    let along = [(first, smooth), (smooth, first), (second, smooth), (smooth, second)];
    let all: Vec<Vec<f64>> = along.into_par_iter().map(|(x, y)| convolved(lightness, size, x, y)).collect();
    (0..lightness.len()).map(|at| [[all[0][at], all[1][at]], [all[2][at], all[3][at]]]).collect()
}

/// The kernel whose positive weights add up to 1, and whose negative ones to −1.
fn balanced(kernel: Vec<f64>) -> Vec<f64> {
    let sum = |sign: f64| kernel.iter().map(|weight| (sign * weight).max(0.0)).sum::<f64>();
    let [positive, negative] = [sum(1.0), sum(-1.0)];
    kernel.iter().map(|weight| weight / if *weight > 0.0 { positive } else { negative.max(1e-300) }).collect()
}

/// Convolves along x with one kernel and along y with the other; pixels at the edge go on beyond it.
fn convolved(channel: &[f64], [width, height]: [usize; 2], x: &[f64], y: &[f64]) -> Vec<f64> {
    let radius = (x.len() / 2) as i64;
    let near = |at: usize, offset: usize, length: usize| {
        (at as i64 + offset as i64 - radius).clamp(0, length as i64 - 1) as usize
    };
    let rows: Vec<f64> = (0..channel.len())
        .into_par_iter()
        .map(|index| {
            let (row, column) = (index / width, index % width);
            let at = |offset: usize| channel[row * width + near(column, offset, width)];
            x.iter().enumerate().map(|(offset, weight)| weight * at(offset)).sum()
        })
        .collect();
    let column = |index: usize| {
        let (row, column) = (index / width, index % width);
        let at = |offset: usize| rows[near(row, offset, height) * width + column];
        y.iter().enumerate().map(|(offset, weight)| weight * at(offset)).sum()
    };
    (0..channel.len()).into_par_iter().map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// The reference implementation of the paper's authors.
    fn reference(a: &RgbaImage, b: &RgbaImage) -> f64 {
        let convert = |image: &RgbaImage| {
            let rgb = image::DynamicImage::ImageRgba8(image.clone()).into_rgb8();
            nv_flip::FlipImageRgb8::with_data(rgb.width(), rgb.height(), rgb.as_raw())
        };
        let map = nv_flip::flip(convert(a), convert(b), nv_flip::DEFAULT_PIXELS_PER_DEGREE);
        nv_flip::FlipPool::from_image(&map).mean().into()
    }

    fn image(of: impl Fn(u32, u32) -> [u8; 3]) -> RgbaImage {
        RgbaImage::from_fn(90, 60, |x, y| {
            let [r, g, b] = of(x, y);
            Rgba([r, g, b, 255])
        })
    }

    #[test]
    fn it_is_what_the_authors_compute() {
        let noise =
            |x: u32, y: u32, salt: u32| (x * 37 + y * 91 + salt * 53).wrapping_mul(2_654_435_761) >> 24;
        let first =
            image(|x, y| [noise(x / 9, y / 7, 1), noise(x / 5, y / 8, 2), noise(x, y, 3)].map(|v| v as u8));
        let shifted = image(|x, y| first.get_pixel((x + 1).min(89), y).0[..3].try_into().unwrap_or_default());
        let faint = image(|x, y| {
            let [r, g, b, _] = first.get_pixel(x, y).0;
            [r.saturating_add(4), g, b.saturating_sub(9)]
        });
        let [black, white] = [0, 255].map(|level| image(|_, _| [level; 3]));
        let edge = image(|x, _| if x < 40 { [20, 60, 200] } else { [250, 240, 10] });
        for (a, b) in [
            (&first, &shifted),
            (&first, &faint),
            (&black, &white),
            (&edge, &first),
            (&edge, &black),
            (&first, &first),
        ] {
            let (own, theirs) = (mean_flip(a, b).expect("one size"), reference(a, b));
            // Theirs is f32 and decodes sRGB by its own rounding.
            assert!((own - theirs).abs() < 1e-3, "{own}, not {theirs}");
        }
        assert!(mean_flip(&first, &shifted).expect("one size") > 0.05);
        assert!(mean_flip(&first, &RgbaImage::new(3, 3)).is_err());
    }
}
