//! Scalar fields over the texels of a texture, and operations on these fields: blurs, and colours shaded by heights.

use super::TEXTURE_SIZE;
use crate::parallel;

/// Number of texels along an edge of a texture.
pub const EDGE: usize = TEXTURE_SIZE as usize;

/// One number per texel, row by row.
pub type Field = Vec<f32>;

/// Evaluates `of` at the centre of every texel, in texture coordinates from 0 to 1. The results are row by row.
pub fn made<T: Send>(of: impl Fn([f32; 2]) -> T + Sync) -> Vec<T> {
    let middle = |index: usize| (index as f32 + 0.5) / EDGE as f32;
    parallel::map_range(EDGE * EDGE, |at| of([middle(at % EDGE), middle(at / EDGE)]))
}

/// Box blur: every texel becomes the mean of a square with 2 · `radius` + 1 texels along an edge. Edges wrap around.
pub fn blurred(field: &[f32], radius: usize) -> Field {
    let rows = transposed_means(field, radius);
    transposed_means(&rows, radius)
}

/// Replaces every texel by the mean of 2 · `radius` + 1 texels of its row, and exchanges rows and columns.
fn transposed_means(field: &[f32], radius: usize) -> Field {
    let mut means = vec![0.0; EDGE * EDGE];
    for (y, row) in field.chunks_exact(EDGE).enumerate() {
        let at = |x: usize| f64::from(row[x % EDGE]);
        let mut sum: f64 = (0..=2 * radius).map(|x| at(x + EDGE - radius)).sum();
        for x in 0..EDGE {
            means[x * EDGE + y] = (sum / (2 * radius + 1) as f64) as f32;
            sum += at(x + radius + 1) - at(x + EDGE - radius);
        }
    }
    means
}

/// Rescales all values linearly to the range 0 to 1.
pub fn stretched(mut field: Field) -> Field {
    let low = field.iter().copied().fold(f32::MAX, f32::min);
    let high = field.iter().copied().fold(f32::MIN, f32::max);
    field.iter_mut().for_each(|value| *value = (*value - low) / (high - low).max(1e-6));
    field
}

/// Combines heights and sRGB colours, both 0 to 1, into texels with four bytes. Texels that are deeper than their surroundings
/// become darker; `shade` is the strength. Large-scale differences in colour are reduced, because they would show that the
/// texture repeats.
pub fn texels(heights: &[f32], mut colors: Vec<[f32; 3]>, shade: f32) -> Vec<u8> {
    for (radius, strength) in [(2, 1.6), (8, 1.0)] {
        let around = blurred(heights, radius);
        for ((color, height), around) in colors.iter_mut().zip(heights).zip(&around) {
            let factor = 1.0 + shade * strength * (height - around).clamp(-0.5, 0.16);
            *color = color.map(|channel| channel * factor);
        }
    }
    for channel in 0..3 {
        let values: Field = colors.iter().map(|color| color[channel]).collect();
        let mean = values.iter().map(|value| f64::from(*value)).sum::<f64>() as f32 / values.len() as f32;
        for (color, around) in colors.iter_mut().zip(blurred(&values, 40)) {
            color[channel] *= 1.0 + 0.8 * (mean / around.max(1e-3) - 1.0);
        }
    }
    let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let texel = |([red, green, blue], height): (&[f32; 3], &f32)| [*red, *green, *blue, *height].map(byte);
    colors.iter().zip(heights).flat_map(texel).collect()
}

/// Colour at position `at`, 0 to 1, of a ramp of evenly spaced colours.
pub fn ramp(colors: &[[f32; 3]], at: f32) -> [f32; 3] {
    let scaled = at.clamp(0.0, 1.0) * (colors.len() - 1) as f32;
    let first = (scaled as usize).min(colors.len() - 2);
    mixed(colors[first], colors[first + 1], scaled - first as f32)
}

/// Linear interpolation between two colours: `from` at 0, `to` at 1.
pub fn mixed(from: [f32; 3], to: [f32; 3], at: f32) -> [f32; 3] {
    std::array::from_fn(|channel| from[channel] + (to[channel] - from[channel]) * at)
}
