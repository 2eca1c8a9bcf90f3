//! Hydraulic erosion: rain collects in rivers. The rivers carry ground away, and deposit it where they slow down. The method is
//! virtual pipes, computed in integers (after Mei, Decaudin and Hu, "Fast hydraulic erosion simulation and visualization on GPU",
//! Pacific Graphics 2007).

use serde::Deserialize;

use crate::InputError;
use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, finite, whole};

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

pub use crate::shared::terrain::hydraulic::{HydraulicParams, SEDIMENT_LIMIT, WATER_LIMIT};
#[cfg(feature = "gpu")]
pub use pass::{HydraulicBuffers, HydraulicPass};

/// Largest number of erosion cycles.
pub const MAX_ITERATIONS: u32 = 2048;

/// Parameters of hydraulic erosion: rain, rivers and their effect on the ground.
///
/// Each cycle has these steps:
///
/// - water, and the sediment in it, moves to the four neighbours of each sample;
/// - ground creeps, and steep banks slide;
/// - water erodes or deposits;
/// - water evaporates, and rain falls.
///
/// In the last quarter of the cycles the land dries without rain. After the last cycle all sediment settles where it is.
///
/// Lengths are fractions of the distance between samples (terrainScale), so that landscapes of any scale erode alike. The sum of
/// ground and sediment is conserved to the last bit.
///
/// A cycle reads samples at most one sample away. A patch therefore needs one ring of samples around it per cycle. For example,
/// 300 cycles on a patch of 257² samples begin with windows of 857², eleven times the patch. The relative cost is lower for
/// larger patches. For the same reason, water moves at most one sample per cycle, so the length of a river in samples cannot
/// exceed the number of cycles.
///
/// No configuration overflows. A sample holds at most 1024 height units of water and 1024 of sediment. Water or sediment above
/// this limit, and ground above the largest height, stays where it came from. Excess rain is lost.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Hydraulic {
    /// Number of cycles, at most [`MAX_ITERATIONS`]. Default 300.
    #[serde(deserialize_with = "whole::<_, 0, MAX_ITERATIONS>")]
    pub iterations: u32,
    /// Depth of the rain per cycle, as a fraction of the distance between samples, 0 to 1. Default 0.001.
    pub rain: f64,
    /// Fraction of the water that evaporates per cycle, 0 to 1. Default 0.001.
    pub evaporation: f64,
    /// Sediment that water can carry per unit of discharge, at a slope of 1; 0 to 1024. Default 100.
    pub capacity: f64,
    /// Discharge below which water carries no sediment, in multiples of the rain on one sample per cycle; 0 to 65536. Larger
    /// values make valleys begin further from the watershed. A small part of the water spreads to each neighbour, whatever the
    /// slope. The threshold also limits this part. Default 2.
    pub threshold: f64,
    /// Rate of erosion, 0 to 1: if water carries less sediment than it could, this fraction of the difference leaves the ground
    /// per cycle. Default 0.01.
    pub erosion: f64,
    /// Rate of deposition, 0 to 1: if water carries more sediment than it can, this fraction of the excess settles per cycle.
    /// Default 0.02.
    pub deposition: f64,
    /// Slope of the steepest stable bank, in degrees, 0 to 89. Default 40.
    pub talus: f64,
    /// Rate of creep, 0 to 1/16: the fraction of the height difference between two neighbours that moves downhill per cycle.
    /// Creep rounds ridges, and larger values put valleys further apart. Default 0.002.
    pub creep: f64,
}

impl Default for Hydraulic {
    fn default() -> Self {
        Self {
            iterations: 300,
            rain: 0.001,
            evaporation: 0.001,
            capacity: 100.0,
            threshold: 2.0,
            erosion: 0.01,
            deposition: 0.02,
            talus: 40.0,
            creep: 0.002,
        }
    }
}

impl Hydraulic {
    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// [`InputError`] that names the first field out of bounds, such as `hydraulic.rain`.
    pub fn validate(&self) -> Result<(), InputError> {
        InputError::check_most("hydraulic.iterations", self.iterations, MAX_ITERATIONS)?;
        for (field, value, most) in [
            ("rain", self.rain, 1.0),
            ("evaporation", self.evaporation, 1.0),
            ("capacity", self.capacity, 1024.0),
            ("threshold", self.threshold, 65536.0),
            ("erosion", self.erosion, 1.0),
            ("deposition", self.deposition, 1.0),
            ("talus", self.talus, 89.0),
            ("creep", self.creep, 0.0625),
        ] {
            finite(&format!("hydraulic.{field}"), value, 0.0, most)?;
        }
        Ok(())
    }

    /// Parameters for the kernel and its CPU reference in one cycle. `cycle` counts from 0. Windows have `in_width`² samples,
    /// which are `terrain_scale` height units apart.
    pub fn params(&self, terrain_scale: f64, cycle: u32, in_width: u32) -> HydraulicParams {
        let fixed = |value: f64, most: i32| value.round_ties_even().min(f64::from(most)) as i32;
        let fraction = |value: f64| fixed(value * 32768.0, 32768);
        let spacing = terrain_scale * HEIGHT_ONE;
        // Two heights differ by at most twice the height limit.
        let widest = 2 * HEIGHT_LIMIT as i32;
        let steepest = fixed(spacing, widest).max(1);
        let slope_shift = 17_u32.saturating_sub(steepest.leading_zeros());
        let raining = cycle < self.iterations - self.iterations / 4;
        HydraulicParams {
            in_width,
            wet: (cycle > 0).into(),
            settles: (cycle + 1 == self.iterations).into(),
            rain: if raining { fixed(self.rain * spacing, WATER_LIMIT) } else { 0 },
            evaporation: fraction(self.evaporation),
            erosion: fraction(self.erosion),
            deposition: fraction(self.deposition),
            capacity: fixed(self.capacity * 256.0, 1 << 18),
            threshold: fixed(self.threshold * self.rain * spacing, WATER_LIMIT),
            steepest,
            slope_shift,
            slope_factor: (1 << 27) / (steepest >> slope_shift),
            creep: fraction(self.creep),
            talus: fixed(libm::tan(self.talus.to_radians()) * spacing, widest),
        }
    }
}
