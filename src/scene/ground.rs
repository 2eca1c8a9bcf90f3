//! The ground of terrain on the host, and heights that the caller's passes change.

use crate::gpu::{Staged, Upload as _};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::object::Object;
use crate::scene::object_kind::ObjectKind;
use crate::scene::terrain::{Terrain, TerrainDrawable, listed};
use crate::terrain::mesh::GroundPoint;
use crate::terrain::morph::Morph;
use crate::{Error, InputError};

impl Scene {
    /// The ground of a terrain at a position of the world, `x` units east and `z` units south of its origin: height in
    /// world units, and normal, of the triangle that is drawn there. `None` where the terrain has no patch. It is computed
    /// on the CPU, from heights that the scene keeps there: those of a terrain made from fields are as they were last read
    /// ([`Scene::read_ground`]), and unknown where [`Scene::set_patches`] has brought a patch since.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, or no terrain, and for a position that is not finite.
    pub fn ground(&self, terrain: ObjectId, x: f64, z: f64) -> Result<Option<GroundPoint>, InputError> {
        for (path, value) in [("x", x), ("z", z)] {
            if !value.is_finite() {
                return Err(InputError::new(path, value, "must be finite"));
            }
        }
        Ok(terrain_of(&*self.object_at(terrain)?.kind)?.point_at(x, z))
    }

    /// Lets the fields of a terrain ([`TerrainSource::from_fields`](crate::scene::TerrainSource::from_fields)) show these
    /// patches, from the next recording on: the first field the first patch, and so on; fields without a patch are not drawn.
    /// A world that streams keeps its fields, lets passes compute the heights of new patches into them, and says so here. That
    /// allocates nothing on the device, and waits for nothing.
    ///
    /// `heights` are two heights in world units between which those of all patches lie: a view that does not see the box
    /// between them does not draw the patch. [`Scene::read_ground`] finds out the exact ones. Handles of patches that stay where
    /// they are stay valid; those of others are stale.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, no terrain, or one that the scene generated; for more patches
    /// than fields, a patch that is given twice or whose samples `i32` does not count; and for heights that are not finite or
    /// out of order. Nothing has changed then. [`crate::gpu::GpuError`].
    pub fn set_patches(
        &mut self,
        terrain: ObjectId,
        patches: &[[i32; 2]],
        heights: [f64; 2],
    ) -> Result<(), Error> {
        let mut staged = std::mem::take(&mut self.staged);
        let entry = self.object_mut(terrain).map_err(Error::from);
        let set = entry.and_then(|entry| entry.set_patches(&mut staged, patches, heights));
        self.staged = staged;
        set
    }

    /// Lets the heights of a terrain with a target ([`TerrainSource::with_target`](crate::scene::TerrainSource::with_target)) be
    /// the blend of its two recipes at another time: from + ⌊(to − from) · time⌋ in integers, so that the picture is that of
    /// terrain made from these heights. The next frame blends on the device, normals with them; [`Scene::ground`] and
    /// [`Scene::pick`] answer by the new heights at once. Without a change of the time nothing is blended. The host takes a
    /// few nanoseconds per sample.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, no terrain, or one without a target; for a time outside 0..=1.
    /// Nothing has changed then.
    pub fn morph_terrain(&mut self, terrain: ObjectId, morph: Morph) -> Result<(), InputError> {
        let entry = self.object_mut(terrain)?;
        terrain_of_mut(&mut *entry.kind)?.morph(&mut entry.instances, morph)
    }

    /// Reads the heights of a terrain made from fields, as the work that was submitted leaves them: [`Scene::ground`] and
    /// [`Scene::pick`] answer by them from now on, and views cull patches by their lowest and highest points. Pictures show
    /// new heights without it. Waits for the device.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, no terrain, or one that the scene generated;
    /// [`crate::gpu::GpuError`].
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_ground(&mut self, terrain: ObjectId) -> Result<(), Error> {
        self.gpu.clone().block_on(self.read_ground_async(terrain))
    }

    /// As `Scene::read_ground`, but completes once the device has finished; see
    /// [`Gpu::wait_async`](crate::gpu::Gpu::wait_async).
    ///
    /// # Errors
    /// As `Scene::read_ground`.
    pub async fn read_ground_async(&mut self, terrain: ObjectId) -> Result<(), Error> {
        let fields = terrain_of(&*self.object_at(terrain)?.kind)?.fields()?;
        let heights = fields.read(&self.gpu).await?;
        let entry = self.object_mut(terrain)?;
        Ok(terrain_of_mut(&mut *entry.kind)?.read(&mut entry.instances, &heights)?)
    }
}

impl Object {
    fn set_patches(
        &mut self,
        staged: &mut Staged,
        patches: &[[i32; 2]],
        heights: [f64; 2],
    ) -> Result<(), Error> {
        let terrain = terrain_of_mut(&mut *self.kind)?;
        terrain.show(&mut self.instances, patches, heights)?;
        let listed = listed(terrain.source.config(), patches);
        for drawable in self.chunks.iter().flat_map(|chunk| &chunk.drawables) {
            if let Some(drawn) = drawable.downcast::<TerrainDrawable>()
                && !listed.is_empty()
            {
                staged.elements(&drawn.geometry.patches, 0, &listed)?;
            }
        }
        Ok(())
    }
}

fn terrain_of(kind: &dyn ObjectKind) -> Result<&Terrain, InputError> {
    kind.downcast().ok_or_else(no_terrain)
}

fn terrain_of_mut(kind: &mut dyn ObjectKind) -> Result<&mut Terrain, InputError> {
    kind.downcast_mut().ok_or_else(no_terrain)
}

fn no_terrain() -> InputError {
    InputError::new("terrain", "a mesh or a character", "must be terrain")
}
