//! Terrain patches on the device, as a renderer draws them.

use crate::gpu::bindings::render::scene_terrain;
use crate::gpu::{Buffer, Gpu, GpuError, Group, Uniform};
use crate::scene::drawable::{Drawable, Part};
use crate::scene::layouts::SceneLayouts;
use crate::scene::options::TerrainStyle;
use crate::scene::specialization::Specialization;
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::terrain::materials::Materials;

/// Device buffers of a terrain.
#[derive(Debug, Clone)]
pub(crate) struct TerrainGeometry {
    /// Parameters shared by all patches.
    pub params: Uniform<TerrainParams>,
    /// Height windows: the heights of each patch and of the samples around it, in 1/65536 world units.
    pub heights: Buffer<i32>,
    /// The patch that each instance shows.
    pub patches: Buffer<TerrainPatch>,
    /// Triangle indices for one patch, which all patches share ([`patch_indices`]).
    pub indices: Buffer<u32>,
    /// Zones and their textures.
    pub zones: Materials,
    /// Holes of patches, one bit per vertex.
    pub holes: Buffer<u32>,
    /// Normals of nodes at twice their resolution; read only if `params` says so.
    pub normals: Buffer<u32>,
    /// Whether any patch may have holes.
    pub has_holes: bool,
}

/// Terrain patches on the device.
#[derive(Debug, Clone)]
pub(crate) struct TerrainDrawable {
    /// Device buffers of the terrain.
    pub geometry: TerrainGeometry,
    /// Bind group 2, with the terrain's buffers. Bind group 1 is different in each view.
    pub group: Group,
    /// Specialization of the patches' pipelines.
    pub specialization: Specialization,
}

impl TerrainDrawable {
    /// Binds the buffers of a terrain. If a buffer is replaced later, all must be bound again.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        geometry: TerrainGeometry,
        style: TerrainStyle,
    ) -> Result<Self, GpuError> {
        let group = scene_terrain::Group2 {
            terrain: &geometry.params,
            heights: geometry.heights.slice(),
            patches: geometry.patches.slice(),
            zones: geometry.zones.zones.slice(),
            textures: &geometry.zones.view(),
            texture_sampler: &geometry.zones.sampler,
            holes: geometry.holes.slice(),
            normals: geometry.normals.slice(),
        };
        let specialization = Specialization::terrain(style, geometry.has_holes);
        Ok(Self { group: group.bind(gpu, &layouts.terrain)?, geometry, specialization })
    }
}

impl Drawable for TerrainDrawable {
    fn part_count(&self) -> usize {
        1
    }

    fn part(&self, at: usize) -> Option<Part<'_>> {
        (at == 0).then_some(Part { specialization: &self.specialization, group: &self.group })
    }

    fn group(&self) -> Option<&Group> {
        None
    }

    fn indices(&self) -> &wgpu::Buffer {
        self.geometry.indices.raw()
    }
}

/// Triangle indices of a patch of `size` × `size` vertices, row by row, counter-clockwise seen from above. The diagonal of
/// each cell runs from south-west to north-east.
pub(crate) fn patch_indices(size: u32) -> Vec<u32> {
    let cells = || 0..size.saturating_sub(1);
    let corners = |x: u32, y: u32| {
        let north = y * size + x;
        let south = north + size;
        [north, south, north + 1, north + 1, south, south + 1]
    };
    cells().flat_map(|y| cells().flat_map(move |x| corners(x, y))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_has_the_diagonals_of_its_strips() {
        assert_eq!(patch_indices(2), [0, 2, 1, 1, 2, 3]);
        let size = 5;
        // The expected triangles: one strip per row of cells.
        let strip = |row: u32| {
            let corner = move |index: u32| (row + (index & 1)) * size + (index >> 1);
            (0..2 * size - 2).map(move |at| [0, 1, 2].map(|next| corner(at + next)))
        };
        let sorted = |mut triangle: [u32; 3]| {
            triangle.sort_unstable();
            triangle
        };
        let expected: Vec<_> = (0..size - 1).flat_map(strip).map(sorted).collect();
        let indices = patch_indices(size);
        let found: Vec<_> =
            indices.chunks(3).map(|corners| sorted([corners[0], corners[1], corners[2]])).collect();
        assert_eq!(found, expected);
        // Each vertex has the same corner index in all of its triangles, which `vertex_wired` of
        // `wgsl/render/scene_terrain.wgsl` relies on.
        let corner = |vertex: u32| (vertex % size + 2 * (vertex / size)) % 3;
        assert!(indices.chunks(3).all(|corners| {
            let mut own = [0, 1, 2].map(|at| corner(corners[at]));
            own.sort_unstable();
            own == [0, 1, 2]
        }));
        // Seen from above, y points down the page, so this product is positive for counter-clockwise triangles.
        let place = |vertex: u32| [vertex % size, vertex / size].map(|at| at as i32);
        for corners in indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|at| place(corners[at]));
            let [u, v] = [b, c].map(|to| [to[0] - a[0], to[1] - a[1]]);
            assert!(u[1] * v[0] - u[0] * v[1] > 0, "{corners:?}");
        }
    }
}
