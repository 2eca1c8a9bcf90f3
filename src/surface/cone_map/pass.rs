//! The GPU pass of `kernels/surface/cone_map.wgsl`.

use glam::UVec2;

use crate::gpu::bindings::surface::cone_map as bindings;
use crate::gpu::{Buffer, Gpu, GpuError, Job, Step, Uniform, pass};
use crate::shared::surface::cone_map::ConeParams;
use crate::surface::height_batch::{HeightMapBatch, REMEDY};
use crate::surface::height_pyramid::Pyramids;
use crate::{Error, InputError};

/// Cone maps of a batch of height maps on the device, one map after another.
#[derive(Debug, Clone)]
pub struct Cones {
    /// Per cell, the height of the highest corner and the cone radius. Each row of a map has `pitch` cones.
    pub cones: Buffer<[f32; 2]>,
    /// Number of cells along x and y.
    pub cells: [u32; 2],
    /// Number of cones per row, padded so that rows can be copied to a texture.
    pub pitch: u32,
    /// Number of cone maps.
    pub count: u32,
}

pass! {
    /// Computes cone maps of height maps on the GPU.
    pub struct ConeMapPass;
}

impl ConeMapPass {
    /// Allocates cone maps for a batch of height maps with these pyramids.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn output(&self, gpu: &Gpu, pyramids: &Pyramids) -> Result<Cones, GpuError> {
        let cells = pyramids.layout.cells;
        // Rows of a texture copy must start at multiples of 256 bytes.
        let pitch = cells[0].next_multiple_of(32);
        let cones = Buffer::new(gpu, "cones", (pitch * cells[1]) as usize * pyramids.count as usize)
            .map_err(|error| error.with_remedy(REMEDY))?;
        Ok(Cones { cones, cells, pitch, count: pyramids.count })
    }

    /// Prepares a job that computes the cone maps of a batch from its height pyramids. It uses the pyramids' address mode.
    ///
    /// # Errors
    /// [`InputError`] if the pyramids or cones do not match the batch in size or number; [`GpuError`] for errors of the device.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        maps: &HeightMapBatch,
        pyramids: &Pyramids,
        cones: &Cones,
    ) -> Result<Job, Error> {
        pyramids.check(maps)?;
        let layout = pyramids.layout;
        if cones.cells != layout.cells {
            let bound = format!("must be {:?}, as the pyramids'", layout.cells);
            return Err(InputError::new("cones.cells", format!("{:?}", cones.cells), bound).into());
        }
        InputError::check_same("cones.count", cones.count, maps.count, "as the height maps'")?;
        let params = ConeParams {
            size: UVec2::from(layout.size),
            cells: UVec2::from(layout.cells),
            pitch: layout.pitch,
            rows: layout.rows,
            cone_pitch: cones.pitch,
            address: pyramids.address.code(),
        };
        let uniform = Uniform::new(gpu, "cones", &params)?;
        let group = bindings::Group {
            params: &uniform,
            heights: maps.heights.slice(),
            pyramids: pyramids.nodes.slice(),
            cones: cones.cones.slice(),
        };
        let [columns, rows] = layout.cells;
        let groups = vec![group.bind(gpu, &self.kernel)?];
        let step = Step::covering(&self.kernel, groups, [columns, rows, maps.count]);
        Ok(Job::new(gpu, "surface/cone_map", vec![step])?)
    }
}

#[cfg(test)]
mod tests {
    use super::ConeMapPass;
    use crate::gpu::{Gpu, Options};
    use crate::surface::height_batch::HeightMapBatch;
    use crate::surface::height_pyramid::Pyramids;
    use crate::surface::{Address, HeightMap};
    use crate::{Error, InputError};

    #[test]
    fn pyramids_and_cones_of_another_batch_are_refused() {
        let gpu = Gpu::headless(&Options::default()).expect("the suite needs an adapter");
        let pass = ConeMapPass::new(&gpu).expect("compiled");
        let made = |size: [u32; 2], count: usize| {
            let map = HeightMap::new(size[0], size[1], vec![0.5; (size[0] * size[1]) as usize]);
            let maps = HeightMapBatch::new(&gpu, &vec![map.expect("valid"); count]).expect("uploaded");
            let pyramids = Pyramids::new(&gpu, &maps, Address::Wrap).expect("allocated");
            let cones = pass.output(&gpu, &pyramids).expect("allocated");
            (maps, pyramids, cones)
        };
        let (maps, pyramids, cones) = made([8, 4], 2);
        let (one, smaller) = (made([8, 4], 1), made([4, 4], 2));
        assert!(pass.prepare(&gpu, &maps, &pyramids, &cones).is_ok());
        let of_size = "must be [8, 4] texels, as the height maps'";
        let of_count = "must be 2, as the height maps'";
        for (pyramids, cones, path, value, bound) in [
            (&smaller.1, &cones, "pyramids.layout.size", "[4, 4]", of_size),
            (&one.1, &cones, "pyramids.count", "1", of_count),
            (&pyramids, &smaller.2, "cones.cells", "[4, 4]", "must be [8, 4], as the pyramids'"),
            (&pyramids, &one.2, "cones.count", "1", of_count),
        ] {
            match pass.prepare(&gpu, &maps, pyramids, cones) {
                Err(Error::Input(error)) => assert_eq!(error, InputError::new(path, value, bound)),
                other => panic!("{path}: {other:?}"),
            }
        }
    }
}
