//! Creases: how much more terrain bends along the lines of coarse lattices than along those of the finest. Plain means of four
//! leave them, and every shading of hills shows them as crosses.

use image::{GrayImage, Luma};

use relievo::InputError;
use relievo::ops::terrain::config::{Border, HEIGHT_ONE, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::generate;

/// The mean bend along the lines of one lattice.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Crease {
    /// The level of the lattice whose points lie on these columns first; 0 is the base lattice.
    pub level: u32,
    /// The root mean square second difference of heights across these columns, in height units.
    pub bend: f64,
    /// The same, divided by that of the finest level.
    pub ratio: f64,
}

/// The creases of a patch at the origin, level by level, over all rows and over these seeds, which take the place of the
/// configuration's. Level 0 needs `coarseLevels` 0: its columns are the patch's edges then.
///
/// # Errors
/// [`InputError`] for a configuration that is out of bounds or not `seamless`, for one with
/// `coarseLevels`, for flat terrain, and for no seed.
pub fn creases(config: &TerrainConfig, seeds: &[String]) -> Result<Vec<Crease>, InputError> {
    config.validate()?;
    if config.border != Border::Seamless {
        return Err(InputError::new(
            "border",
            format!("{:?}", config.border).to_lowercase(),
            "must be \"seamless\"",
        ));
    }
    if config.coarse_levels != 0 {
        return Err(InputError::new("coarse_levels", config.coarse_levels, "must be 0"));
    }
    if config.scale_factor == 0.0 {
        return Err(InputError::new("scale_factor", 0, "must be above 0: flat terrain bends nowhere"));
    }
    if seeds.is_empty() {
        return Err(InputError::new("seeds.len", 0, "must be at least 1"));
    }
    let levels = config.levels();
    let (width, last) = (config.patch_size as usize + 2, config.patch_size as usize);
    let mut sums = vec![(0.0_f64, 0_usize); levels as usize + 1];
    for seed in seeds {
        let config = TerrainConfig { seed: seed.clone(), ..config.clone() };
        let window = generate(&config, &Features::default(), &[[0, 0]], 1).swap_remove(0);
        for row in window.chunks_exact(width).skip(1).take(last) {
            for (at, heights) in row.windows(3).enumerate() {
                let [a, b, c] = [heights[0], heights[1], heights[2]].map(f64::from);
                let level = level_of(at as u32, levels);
                sums[level].0 += (a - 2.0 * b + c).powi(2);
                sums[level].1 += 1;
            }
        }
    }
    let bends: Vec<f64> = sums.iter().map(|(sum, count)| (sum / *count as f64).sqrt() / HEIGHT_ONE).collect();
    let finest = bends[levels as usize];
    let crease = |(level, bend): (u32, &f64)| Crease { level, bend: *bend, ratio: bend / finest };
    Ok((0..).zip(&bends).map(crease).collect())
}

/// The first level whose points lie on a column of a patch.
fn level_of(column: u32, levels: u32) -> usize {
    levels.saturating_sub(column.trailing_zeros().min(levels)) as usize
}

/// A field of heights, rows of `width` with one sample around the picture on every side, lit from the north-west at 45°.
/// `spacing` is the distance of samples in height units.
///
/// # Errors
/// [`InputError`] for fewer than three columns or rows, and for heights that are not whole rows.
pub fn hill_shaded(heights: &[i32], width: usize, spacing: f64) -> Result<GrayImage, InputError> {
    if width < 3 || heights.len() < 3 * width || !heights.len().is_multiple_of(width) {
        let bound = format!("must be at least three rows of width ({width}), which is at least 3");
        return Err(InputError::new("heights.len", heights.len(), bound));
    }
    let at = |x: usize, y: usize| f64::from(heights[y * width + x]) / HEIGHT_ONE;
    let light = [-0.5, -0.5, std::f64::consts::FRAC_1_SQRT_2];
    Ok(GrayImage::from_fn(width as u32 - 2, (heights.len() / width) as u32 - 2, |x, y| {
        let [x, y] = [x as usize + 1, y as usize + 1];
        let slope =
            [at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)].map(|step| step / (2.0 * spacing));
        let along = light[2] - slope[0] * light[0] - slope[1] * light[1];
        let lit = along / (1.0 + slope[0] * slope[0] + slope[1] * slope[1]).sqrt();
        Luma([(255.0 * lit.clamp(0.0, 1.0)).round() as u8])
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::ops::terrain::config::HeightInterpolation;

    #[test]
    fn columns_belong_to_the_first_level_that_has_them() {
        let levels: Vec<usize> = (0..=8).map(|column| level_of(column, 3)).collect();
        assert_eq!(levels, [0, 3, 2, 3, 1, 3, 2, 3, 0]);
    }

    /// Means of four leave creases, four-point interpolation does not (spec: at most 1.15 at every level).
    #[test]
    fn smooth_terrain_has_no_creases() {
        let seeds: Vec<String> = (0..24).map(|seed| format!("crease {seed}")).collect();
        let largest = |interpolation| {
            let config = TerrainConfig { interpolation, ..TerrainConfig::new(257, 40.0, "").expect("valid") };
            let all = creases(&config, &seeds).expect("creases");
            println!("{interpolation:?}: {all:?}");
            all.iter().map(|crease| crease.ratio).fold(0.0, f64::max)
        };
        let (linear, smooth) = (largest(HeightInterpolation::Linear), largest(HeightInterpolation::Smooth));
        assert!(linear > 1.5 && smooth <= 1.15, "linear {linear}, smooth {smooth}");
        let flat = TerrainConfig::new(257, 0.0, "").expect("valid");
        assert_eq!(creases(&flat, &seeds).expect_err("no bends").path, "scale_factor");
    }

    #[test]
    fn slopes_towards_the_light_are_bright() {
        let slope = |x: i32, y: i32| {
            let heights: Vec<i32> = (0..9).map(|at| 65536 * (x * (at % 3) + y * (at / 3))).collect();
            hill_shaded(&heights, 3, 1.0).expect("three rows").get_pixel(0, 0).0[0]
        };
        assert_eq!(slope(0, 0), 180);
        assert!(slope(1, 1) > 240 && slope(-1, -1) < 10 && slope(1, -1) < 180);
        assert!(hill_shaded(&[0; 8], 3, 1.0).is_err() && hill_shaded(&[0; 4], 2, 1.0).is_err());
    }
}
