//! A batch of height maps on the device.

use super::map::HeightMap;
use crate::gpu::{Buffer, Gpu};
use crate::{Error, InputError};

/// Height maps of one size on the device, one after another.
#[derive(Debug, Clone)]
pub struct HeightMapBatch {
    /// Heights, row by row, map by map.
    pub heights: Buffer<f32>,
    /// Texels of each map along x and y.
    pub size: [u32; 2],
    /// Number of maps.
    pub count: u32,
}

impl HeightMapBatch {
    /// Uploads maps of one size.
    ///
    /// # Errors
    /// [`InputError`] for an empty list or different sizes; [`GpuError`](crate::gpu::GpuError).
    pub fn new(gpu: &Gpu, maps: &[HeightMap]) -> Result<Self, Error> {
        let size_of = |map: &HeightMap| [map.width(), map.height()];
        let Some(size) = maps.first().map(size_of) else {
            return Err(InputError::new("maps.len", 0, "must be at least 1").into());
        };
        if let Some(at) = maps.iter().position(|map| size_of(map) != size) {
            let bound = format!("must be {size:?} texels as the first");
            return Err(InputError::new(
                format!("maps[{at}].size"),
                format!("{:?}", size_of(&maps[at])),
                bound,
            )
            .into());
        }
        let all: Vec<f32> = maps.iter().flat_map(HeightMap::heights).copied().collect();
        let heights =
            Buffer::from_slice(gpu, "height maps", &all).map_err(|error| error.with_remedy(REMEDY))?;
        Ok(Self { heights, size, count: maps.len() as u32 })
    }
}

/// Advice in errors about maps larger than a binding.
pub(crate) const REMEDY: &str =
    "use smaller or fewer height maps, or compute on the CPU with the functions in the `reference` modules";
