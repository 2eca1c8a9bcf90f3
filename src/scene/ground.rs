//! The ground of terrain on the host, and terrain whose heights or patches the caller changes.

use crate::gpu::{Staged, Upload as _};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::object::Object;
use crate::scene::object_kind::ObjectKind;
use crate::scene::terrain::endless::Endless;
use crate::scene::terrain::{EndlessStatistics, Terrain, TerrainDrawable, TerrainHole, listed};
use crate::terrain::features::Features as TerrainFeatures;
use crate::terrain::mesh::GroundPoint;
use crate::terrain::morph::Morph;
use crate::{Error, InputError};

impl Scene {
    /// The ground of a terrain at a world position, `x` units east and `z` units south of the origin. Returns the height in
    /// world units and the normal of the triangle that is drawn there; `None` where the terrain has no patch.
    ///
    /// The ground is computed on the CPU from heights that the scene keeps on the host. For terrain made from fields, these
    /// are the heights last read by [`Scene::read_ground`]. For patches that [`Scene::set_patches`] has added since then,
    /// the heights are unknown, and the result is `None`. Endless terrain makes its finest heights where they are asked for; it has no
    /// ground in holes, and none where a tile of its elevation map is on its way.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene or is not terrain, for a position that is not finite, and for a tile of
    /// an elevation map that cannot be loaded.
    ///
    /// # Examples
    ///
    /// An instance that stands on the ground.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, ObjectId, Placement, Scene};
    /// # fn example(scene: &mut Scene, land: ObjectId, fox: InstanceId) -> Result<(), relievo::Error> {
    /// let (x, z) = (120.0, -45.5);
    /// if let Some(point) = scene.ground(land, x, z)? {
    ///     scene.move_to(fox, Placement::at_world([x, point.height, z]))?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn ground(&self, terrain: ObjectId, x: f64, z: f64) -> Result<Option<GroundPoint>, InputError> {
        for (path, value) in [("x", x), ("z", z)] {
            if !value.is_finite() {
                return Err(InputError::new(path, value, "must be finite"));
            }
        }
        let kind = &*self.object_at(terrain)?.kind;
        match kind.downcast::<Endless>() {
            Some(endless) => endless.point_at(x, z),
            None => Ok(terrain_of(kind)?.point_at(x, z)),
        }
    }

    /// The nodes of an endless terrain ([`TerrainSource::endless`](crate::scene::TerrainSource::endless)) after the last frame: how
    /// many there are, and how much of the detail that the views need is there.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene or is not endless terrain.
    ///
    /// # Examples
    ///
    /// Waits until a new place is there in full detail.
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene, View};
    /// # fn example(scene: &mut Scene, land: ObjectId, view: &mut View) -> Result<(), relievo::Error> {
    /// while scene.terrain_statistics(land)?.ready < 1.0 {
    ///     let gpu = scene.gpu().clone();
    ///     gpu.try_run("loading", |encoder| scene.record(encoder, &mut [&mut *view]))?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn terrain_statistics(&self, terrain: ObjectId) -> Result<EndlessStatistics, InputError> {
        let endless = self.object_at(terrain)?.kind.downcast::<Endless>();
        endless.map(Endless::statistics).ok_or_else(not_endless)
    }

    /// Replaces the holes of an endless terrain ([`TerrainSource::with_holes`](crate::scene::TerrainSource::with_holes)), from the next
    /// frame on.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene or is not endless terrain, for terrain that was added without holes, and
    /// for a hole out of bounds ([`TerrainHole::validate`]). In these cases nothing has changed.
    ///
    /// # Examples
    ///
    /// The mouth of a cave.
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene, TerrainHole};
    /// # fn example(scene: &mut Scene, land: ObjectId) -> Result<(), relievo::Error> {
    /// scene.set_terrain_holes(land, &[TerrainHole::Circle { at: [120.0, -45.5], radius: 3.0 }])?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_terrain_holes(&mut self, terrain: ObjectId, holes: &[TerrainHole]) -> Result<(), InputError> {
        let endless = self.object_mut(terrain)?.kind.downcast_mut::<Endless>();
        endless.ok_or_else(not_endless)?.set_holes(holes)
    }

    /// Replaces the heights that are injected into an endless terrain, such as those of roads and valleys, from the next frame on. The
    /// nodes that they change are made again: all at once if they are at most half of [`EndlessLimits::nodes_per_frame`], and otherwise
    /// coarsest first. [`Scene::ground`] answers for the new heights at once, [`Scene::pick`] from the next frame on. They lie on the
    /// elevation map, if there is one.
    ///
    /// The call takes some 20 µs for each of the heights on the host. The first heights of a terrain compile a pipeline.
    ///
    /// [`EndlessLimits::nodes_per_frame`]: crate::scene::EndlessLimits::nodes_per_frame
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene or is not endless terrain, for terrain of noise, and for heights out of
    /// bounds.
    ///
    /// # Examples
    ///
    /// A dip of three metres at a sample of patch (0, 0).
    ///
    /// ```no_run
    /// # use relievo::scene::{FeatureFile, FeatureMode, ObjectId, Scene, TerrainConfig, TerrainFeatures};
    /// # fn example(scene: &mut Scene, land: ObjectId, config: &TerrainConfig) -> Result<(), relievo::Error> {
    /// let dip = FeatureFile { patch_coordinates: [0, 0], precomputed_heights: vec![20.0, 31.0, -3.0] };
    /// scene.set_terrain_features(land, &TerrainFeatures::new(config, &[dip], FeatureMode::Additive)?)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_terrain_features(
        &mut self,
        terrain: ObjectId,
        features: &TerrainFeatures,
    ) -> Result<(), InputError> {
        let endless = self.object_mut(terrain)?.kind.downcast_mut::<Endless>();
        endless.ok_or_else(not_endless)?.set_features(features)
    }

    /// Sets which patches the fields of a terrain ([`TerrainSource::from_fields`](crate::scene::TerrainSource::from_fields))
    /// show, from the next recording on. The first field shows the first patch, and so on; fields without a patch are not
    /// drawn. A streaming world keeps its fields, computes the heights of new patches into them, and then calls this
    /// function. The call allocates nothing on the device, and does not wait.
    ///
    /// `heights` are a lower and an upper bound of the heights of all patches, in world units. Views cull each patch by the
    /// box between these heights. [`Scene::read_ground`] reads the exact bounds. The handle of a patch remains valid if the
    /// patch keeps its index in `patches`. All other handles become stale.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene, is not terrain, or is terrain that the scene generated; for
    /// more patches than fields; for a patch that is given twice or whose samples exceed the range of `i32`; and for heights
    /// that are not finite or not in ascending order. In these cases nothing has changed. [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// A streaming world of one field, which shows its next patch with heights from −20 to 80 units.
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(
    /// #     scene: &mut Scene,
    /// #     land: ObjectId,
    /// #     compute: impl Fn([i32; 2]) -> wgpu::CommandBuffer,
    /// # ) -> Result<(), relievo::Error> {
    /// let patch = [4, -2];
    /// scene.gpu().queue().submit([compute(patch)]); // writes the heights into the field
    /// scene.set_patches(land, &[patch], [-20.0, 80.0])?;
    /// # Ok(())
    /// # }
    /// ```
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

    /// Sets the time, 0 to 1, at which a terrain with a target
    /// ([`TerrainSource::with_target`](crate::scene::TerrainSource::with_target)) blends its two recipes. The blended
    /// heights are `from + ⌊(to − from) · time⌋` in integers, so the picture equals the picture of terrain made from these
    /// heights. The next frame blends heights and normals on the device. [`Scene::ground`] and [`Scene::pick`] use the new
    /// heights at once. A new time costs the host a few nanoseconds per sample; an unchanged time costs nothing. The error of endless
    /// terrain is bounded at every time; its finest heights are made again where they are asked for.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene, is not terrain, or is terrain without a target, and for a
    /// time outside 0..=1. In these cases nothing has changed.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene, TerrainMorph};
    /// # fn example(scene: &mut Scene, land: ObjectId) -> Result<(), relievo::Error> {
    /// let time = (scene.time() / 10.0).min(1.0); // over the first ten seconds
    /// scene.morph_terrain(land, TerrainMorph { time })?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn morph_terrain(&mut self, terrain: ObjectId, morph: Morph) -> Result<(), InputError> {
        let entry = self.object_mut(terrain)?;
        match entry.kind.downcast_mut::<Endless>() {
            Some(endless) => endless.morph(morph),
            None => terrain_of_mut(&mut *entry.kind)?.morph(&mut entry.instances, morph),
        }
    }

    /// Waits for all submitted work, then reads back the heights of a terrain made from fields. From then on,
    /// [`Scene::ground`] and [`Scene::pick`] use these heights, and views cull each patch by its lowest and highest points.
    /// Drawing does not need this call: pictures show new heights without it.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not in this scene, is not terrain, or is terrain that the scene generated;
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, land: ObjectId, eroded: wgpu::CommandBuffer) -> Result<(), relievo::Error> {
    /// scene.gpu().queue().submit([eroded]); // changes the heights in the terrain's fields
    /// scene.read_ground(land)?;
    /// let new = scene.ground(land, 10.0, 10.0)?;
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(not(target_arch = "wasm32"))]
    pub fn read_ground(&mut self, terrain: ObjectId) -> Result<(), Error> {
        self.gpu.clone().block_on(self.read_ground_async(terrain))
    }

    /// Like `Scene::read_ground`, but does not block. The future completes once the device has finished; see
    /// [`Gpu::wait_async`](crate::gpu::Gpu::wait_async).
    ///
    /// # Errors
    /// The errors of `Scene::read_ground`.
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
    kind.downcast().ok_or_else(|| no_patches(kind))
}

fn terrain_of_mut(kind: &mut dyn ObjectKind) -> Result<&mut Terrain, InputError> {
    let refused = no_patches(kind);
    kind.downcast_mut().ok_or(refused)
}

fn not_endless() -> InputError {
    InputError::new("terrain", "not endless", "must be made by TerrainSource::endless")
}

/// Why an object is not terrain of patches.
fn no_patches(kind: &dyn ObjectKind) -> InputError {
    match kind.downcast::<Endless>() {
        Some(_) => InputError::new("terrain", "endless", "must be terrain of a list of patches"),
        None => InputError::new("terrain", "a mesh or a character", "must be terrain"),
    }
}
