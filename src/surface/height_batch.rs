//! Batches of height maps on the device.

use super::map::HeightMap;
use crate::gpu::{Buffer, Gpu};
use crate::{Error, InputError};

/// Height maps of equal size on the device, one map after another.
#[derive(Debug, Clone)]
pub struct HeightMapBatch {
    /// Heights of all texels, 0 to 1, map by map and row by row.
    pub heights: Buffer<f32>,
    /// Number of texels of each map along x and y.
    pub size: [u32; 2],
    /// Number of height maps.
    pub count: u32,
}

impl HeightMapBatch {
    /// Uploads height maps of equal size.
    ///
    /// # Errors
    /// [`InputError`] if `maps` is empty or the maps differ in size; [`GpuError`](crate::gpu::GpuError) for errors of the device.
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

/// Advice that is added to errors about maps that exceed the device's binding size.
pub(crate) const REMEDY: &str =
    "use smaller or fewer height maps, or compute on the CPU with the functions in the `reference` modules";
