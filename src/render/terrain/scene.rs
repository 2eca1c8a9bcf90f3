//! The scene of a terrain renderer: fields that are added, moved and removed as the viewer travels.

use super::{TerrainRenderer, View};
use crate::gpu::{Buffer, Gpu, Group, Uniform, shaders};
use crate::render::camera::Camera;
use crate::render::pipeline::bind;
use crate::shared::render::terrain::{FieldParams, Place};
use crate::terrain::config::{Config, HEIGHT_ONE};
use crate::terrain::fields::Fields;
use crate::{Error, InputError};

/// Identifies fields that were added to a [`TerrainScene`]. An identifier is never used again, even after the
/// fields are removed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FieldsId(u64);

/// The fields of one buffer, with their bind group.
#[derive(Debug, Clone)]
struct Part {
    id: FieldsId,
    group: Group,
    places: Buffer<Place>,
    size: u32,
    /// Texture tiles along a patch's edge.
    tiles: f64,
    capacity: u32,
    patches: u32,
}

impl Part {
    /// Writes the places of the next submission into the existing buffer.
    fn set_places(&mut self, gpu: &Gpu, patches: &[[i32; 2]], origin: [i32; 2]) -> Result<(), Error> {
        if patches.len() > self.capacity as usize {
            let bound = format!("must be at most {}, the fields' count", self.capacity);
            return Err(InputError::new("patches.len", patches.len(), bound).into());
        }
        let places = (patches.iter().enumerate())
            .map(|(at, patch)| place(&format!("patches[{at}]"), self.size, self.tiles, (*patch, origin)))
            .collect::<Result<Vec<_>, _>>()?;
        if !places.is_empty() {
            self.places.write(gpu, &places)?;
        }
        self.patches = patches.len() as u32;
        Ok(())
    }
}

/// A terrain scene: add fields, set the camera, then draw in any render pass.
///
/// A streaming world keeps a set of [`Fields`] and adds them once. As the viewer travels, it generates new
/// patches into them and passes their positions to [`TerrainScene::set_places`], which allocates nothing. World
/// position 0 is the first sample of the patch `origin`: move the origin along with the viewer, so that `f32`
/// positions stay small.
#[derive(Debug, Clone)]
pub struct TerrainScene {
    renderer: TerrainRenderer,
    view: View,
    uniform: Uniform<View>,
    group: Group,
    parts: Vec<Part>,
    added: u64,
}

impl TerrainScene {
    pub(super) fn new(renderer: TerrainRenderer, view: View, uniform: Uniform<View>, group: Group) -> Self {
        Self { renderer, view, uniform, group, parts: Vec::new(), added: 0 }
    }

    /// Adds the fields of `patches`, which must extend at least one sample beyond them. World position 0 is the
    /// first sample of patch `origin`. There is room for as many patches as there are fields; fields without a
    /// patch in `patches` are not drawn.
    ///
    /// # Errors
    /// [`InputError`] for a configuration out of bounds, fields without a margin, or patches so far from the
    /// origin that `f32` cannot resolve their samples; [`crate::gpu::GpuError`].
    pub fn add(
        &mut self,
        gpu: &Gpu,
        config: &Config,
        fields: &Fields,
        patches: &[[i32; 2]],
        origin: [i32; 2],
    ) -> Result<FieldsId, Error> {
        config.validate()?;
        let size = config.patch_size;
        if fields.width < size + 2 || !(fields.width - size).is_multiple_of(2) {
            let bound = format!("must be patchSize = {size} and an even margin of at least 2");
            return Err(InputError::new("fields.width", fields.width, bound).into());
        }
        let tiles = config.tiles_per_patch();
        let params = FieldParams {
            in_width: fields.width,
            size,
            spacing: config.terrain_scale as f32,
            run: (2.0 * config.terrain_scale * HEIGHT_ONE) as f32,
            tiling: (tiles / f64::from(size - 1)) as f32,
        };
        let uniform = Uniform::new(gpu, "field", &params)?;
        let places = Buffer::new(gpu, "places", fields.count as usize)?;
        let resources = [
            uniform.raw().as_entire_binding(),
            fields.heights.raw().as_entire_binding(),
            places.raw().as_entire_binding(),
        ];
        let group = bind(gpu, &shaders::RENDER_TERRAIN, &self.renderer.layouts, 1, &resources)?;
        let id = FieldsId(self.added);
        let mut part = Part { id, group, places, size, tiles, capacity: fields.count, patches: 0 };
        part.set_places(gpu, patches, origin)?;
        self.parts.push(part);
        self.added += 1;
        Ok(id)
    }

    /// From the next submission on, draws the fields `id` as `patches`: at most as many as there are fields,
    /// the first patch from the first field. Allocates nothing on the device; the heights are those that the
    /// fields hold at that time.
    ///
    /// # Errors
    /// [`InputError`] for fields that were removed, for too many patches, and for patches too far from
    /// `origin`; nothing changes then. [`crate::gpu::GpuError`].
    pub fn set_places(
        &mut self,
        gpu: &Gpu,
        id: FieldsId,
        patches: &[[i32; 2]],
        origin: [i32; 2],
    ) -> Result<(), Error> {
        match self.parts.iter_mut().find(|part| part.id == id) {
            Some(part) => part.set_places(gpu, patches, origin),
            None => Err(InputError::new("fields", id.0, "must be fields of this scene").into()),
        }
    }

    /// Removes fields and releases their buffers. Returns whether they were in the scene.
    pub fn remove(&mut self, id: FieldsId) -> bool {
        let before = self.parts.len();
        self.parts.retain(|part| part.id != id);
        self.parts.len() < before
    }

    /// Removes all fields.
    pub fn clear(&mut self) {
        self.parts.clear();
    }

    /// Sets the camera of the next submission.
    ///
    /// # Errors
    /// [`InputError`] for an invalid camera; [`crate::gpu::GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, camera: &Camera, aspect: f32) -> Result<(), Error> {
        self.view.clip_from_world = camera.clip_from_world(aspect)?;
        Ok(self.uniform.write(gpu, &self.view)?)
    }

    /// Draws everything that was added.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_pipeline(&self.renderer.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        for part in &self.parts {
            pass.set_bind_group(1, &part.group, &[]);
            pass.draw(0..2 * part.size, 0..(part.size - 1) * part.patches);
        }
    }
}

/// Where a patch of `size` samples along an edge is drawn; `path` names the patch in errors.
fn place(
    path: &str,
    size: u32,
    tiles: f64,
    (patch, origin): ([i32; 2], [i32; 2]),
) -> Result<Place, InputError> {
    let edge = i64::from(size) - 1;
    let samples = [0, 1].map(|axis| (i64::from(patch[axis]) - i64::from(origin[axis])) * edge);
    // Positions are integers in units of samples, which f32 represents exactly up to 2^24.
    if let Some(axis) = samples.iter().position(|sample| sample.abs() + edge > 1 << 24) {
        let bound = format!("must lie within 2^24 samples of the origin's {} to be drawn", origin[axis]);
        return Err(InputError::new(format!("{path}[{axis}]"), patch[axis], bound));
    }
    let uv = patch.map(|index| (f64::from(index) * tiles).rem_euclid(1.0) as f32);
    Ok(Place { origin: samples.map(|sample| sample as i32), uv })
}

#[cfg(test)]
mod tests {
    use super::place;
    use crate::InputError;

    #[test]
    fn a_patch_too_far_from_the_origin_is_refused() {
        let at = |patch, origin| place("patches[3]", 257, 1.0, (patch, origin));
        assert_eq!(at([65_535, -4], [0, 4]).expect("within reach").origin, [65_535 * 256, -8 * 256]);
        let refused = |axis, value: i32, origin: i32| {
            let bound = format!("must lie within 2^24 samples of the origin's {origin} to be drawn");
            InputError::new(format!("patches[3][{axis}]"), value, bound)
        };
        assert_eq!(at([65_536, 0], [0, 0]).err(), Some(refused(0, 65_536, 0)));
        assert_eq!(at([0, -65_530], [0, 7]).err(), Some(refused(1, -65_530, 7)));
    }
}
