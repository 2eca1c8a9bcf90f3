//! Error and cost of a method: its distance from the exact intersection, and the number of texels that it
//! loads.

use rayon::prelude::*;

use super::exact::exact;
use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::relief::{Outcome, ReliefHit, ReliefRay};

/// Statistics of a list of traced rays.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Number of rays that have an exact intersection.
    pub rays: usize,
    /// Mean distance of the results from the exact intersections, in texels.
    pub mean_error_texels: f64,
    /// The 99th percentile of that distance, in texels.
    pub p99_error_texels: f64,
    /// The largest distance, in texels.
    pub max_error_texels: f64,
    /// Rays without a hit although an exact intersection exists: misses, and rays for which the method ran out
    /// of steps.
    pub misses: usize,
    /// Mean number of texels loaded per ray, including those of acceleration maps.
    pub mean_samples: f64,
    /// The largest number of texels that one ray loaded.
    pub max_samples: u32,
}

impl Measured {
    /// Measures results against the exact intersections of their rays.
    pub fn of(map: &HeightMap, address: Address, rays: &[ReliefRay], hits: &[ReliefHit]) -> Self {
        let found = rays.par_iter().zip(hits).filter_map(|(ray, hit)| {
            exact(map, ray, address).map(|exact| (exact.error(hit, map), hit.outcome() != Outcome::Hit))
        });
        let found: Vec<(f64, bool)> = found.collect();
        let mut errors: Vec<f64> = found.iter().map(|(error, _)| *error).collect();
        errors.par_sort_unstable_by(f64::total_cmp);
        let count = errors.len().max(1) as f64;
        let quantile = |fraction: f64| {
            let rank = (fraction * errors.len() as f64).ceil() as usize;
            errors.get(rank.saturating_sub(1)).copied().unwrap_or(0.0)
        };
        Self {
            rays: errors.len(),
            mean_error_texels: errors.iter().sum::<f64>() / count,
            p99_error_texels: quantile(0.99),
            max_error_texels: quantile(1.0),
            misses: found.iter().filter(|(_, missed)| *missed).count(),
            mean_samples: hits.iter().map(|hit| f64::from(hit.samples)).sum::<f64>()
                / hits.len().max(1) as f64,
            max_samples: hits.iter().map(|hit| hit.samples).max().unwrap_or(0),
        }
    }
}
