//! Adding objects to a scene, showing them, and removing them.

use crate::asset::Model;
use crate::gpu::Upload as _;
use crate::lod::transition::Transition;
use crate::scene::Scene;
use crate::scene::handles::{ObjectId, foreign, stale};
use crate::scene::kind::Kind;
use crate::scene::level_of_detail::LevelOfDetail;
use crate::scene::object::Object;
use crate::scene::options::CharacterOptions;
use crate::scene::relief::Relief;
use crate::scene::terrain::TerrainSource;
use crate::{Error, InputError};

impl Scene {
    /// Adds terrain and shows its patches. The device generates the heights, or the caller provides them
    /// ([`TerrainSource::from_fields`]). The call waits until the heights are read back to the host. Views cull patches
    /// by these heights, and [`Scene::ground`] returns them.
    ///
    /// # Errors
    /// [`InputError`] for a configuration or patches out of bounds, for an empty list of patches, and for a patch that
    /// is given twice. [`InputError`] also for fields without a margin, fields whose size does not match the
    /// configuration, and fewer fields than patches. [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// Generates nine patches around the origin. The text is the seed.
    ///
    /// ```no_run
    /// # use relievo::scene::{Scene, TerrainConfig, TerrainSource};
    /// # fn example(scene: &mut Scene) -> Result<(), relievo::Error> {
    /// let config = TerrainConfig::new(257, 80.0, "any text")?;
    /// let patches: Vec<[i32; 2]> = (0..9).map(|at| [at % 3 - 1, at / 3 - 1]).collect();
    /// let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches))?;
    /// # Ok(())
    /// # }
    /// ```
    #[cfg(not(target_arch = "wasm32"))]
    pub fn add_terrain(&mut self, source: &TerrainSource) -> Result<ObjectId, Error> {
        self.gpu.clone().block_on(self.add_terrain_async(source))
    }

    /// Like `Scene::add_terrain`, but the future completes once the device has generated the patches and reported its
    /// errors; see [`Gpu::wait_async`](crate::gpu::Gpu::wait_async).
    ///
    /// # Errors
    /// As for `Scene::add_terrain`.
    pub async fn add_terrain_async(&mut self, source: &TerrainSource) -> Result<ObjectId, Error> {
        let (gpu, pending) = self.uploader();
        let object = Object::of_terrain(&gpu, &self.layouts_of_groups, source).await?;
        self.add_checked(object.awaiting(pending)).await
    }

    /// Adds a static mesh: all meshes of a model in the rest pose, with their materials and levels of detail. A model
    /// without levels ([`add_levels`](crate::skinning::add_levels)) is always drawn in full detail.
    ///
    /// The object has memory for at least `capacity` instances, 1 to 2²⁰, and grows when more are spawned
    /// ([`Scene::spawn`]). One unit of the model is [`Placement::scale`](crate::scene::Placement::scale) world units
    /// long. [`BoundingSphere::in_clips`](crate::skinning::bounding_sphere::BoundingSphere::in_clips) returns the
    /// approximate size of a model.
    ///
    /// # Errors
    /// [`InputError`] for a capacity out of range, and for a model without triangles, with invalid meshes or materials,
    /// or with images that are too large for a texture of the device; [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// Adds a stone with levels of detail, and memory for 50 instances.
    ///
    /// ```no_run
    /// # use relievo::asset::Model;
    /// # use relievo::scene::{Placement, Scene, add_levels};
    /// # fn example(scene: &mut Scene) -> Result<(), relievo::Error> {
    /// let mut stone = Model::from_file("stone.glb".as_ref())?;
    /// add_levels(&mut stone, &[], 1)?;
    /// let stones = scene.add_mesh(&stone, 50)?;
    /// scene.spawn(stones, Placement::at_world([10.0, 0.0, -4.0]))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn add_mesh(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        let object = self.mesh(model, capacity)?;
        Ok(self.add(object))
    }

    /// Like [`Scene::add_mesh`], but the future completes once the device has reported its errors
    /// ([`Gpu::check_async`](crate::gpu::Gpu::check_async)). After an error, nothing is added.
    ///
    /// # Errors
    /// As for [`Scene::add_mesh`].
    pub async fn add_mesh_async(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        let object = self.mesh(model, capacity)?;
        self.add_checked(object).await
    }

    /// Adds a character: an animated model. Bones are sampled from clips, and meshes are morphed and skinned, only as
    /// precisely as the views need. A model without clips becomes a mesh ([`Scene::add_mesh`]). The object has memory
    /// for at least `capacity` instances, 1 to 2²⁰, and grows when more are spawned ([`Scene::spawn`]).
    ///
    /// Call [`add_levels`](crate::skinning::add_levels) on the model first. Without this call, the full mesh is the
    /// only level of detail.
    ///
    /// # Errors
    /// [`InputError`] for a capacity out of range, and for a model without triangles, with invalid meshes or materials,
    /// or with images that are too large for a texture of the device; [`crate::gpu::GpuError`].
    pub fn add_character(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        self.add_character_with(model, capacity, &CharacterOptions::default())
    }

    /// Like [`Scene::add_character`], with options: animation layers above the base layer, root motion extracted from
    /// the clips, and the level of detail of bones. For a model without clips, the options are ignored.
    ///
    /// # Errors
    /// As for [`Scene::add_character`]; [`InputError`] for more than 7 layers, for a bone that the model does not have, for
    /// root motion that cannot be extracted ([`RootMotion::extract`](crate::animation::RootMotion::extract)), for a gate,
    /// influences, a priority or tiers out of range, and for a model whose bones cannot collapse.
    ///
    /// # Examples
    ///
    /// Adds people whose upper body may wave while the legs walk. Walking moves the instance.
    ///
    /// ```no_run
    /// # use relievo::asset::Model;
    /// # use relievo::scene::{CharacterOptions, LayerMask, RootMotionParts, RootOptions, Scene};
    /// # fn example(scene: &mut Scene, model: &Model) -> Result<(), relievo::Error> {
    /// let options = CharacterOptions {
    ///     layers: vec![LayerMask::Below("spine"), LayerMask::All], // layers 1 and 2
    ///     root_motion: Some(RootOptions { bone: "hips", taken: RootMotionParts::default() }),
    ///     ..CharacterOptions::default()
    /// };
    /// let people = scene.add_character_with(model, 100, &options)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn add_character_with(
        &mut self,
        model: &Model,
        capacity: usize,
        options: &CharacterOptions<'_>,
    ) -> Result<ObjectId, Error> {
        let object = self.character(model, capacity, options)?;
        Ok(self.add(object))
    }

    /// Like [`Scene::add_character`], but the future completes once the device has reported its errors
    /// ([`Gpu::check_async`](crate::gpu::Gpu::check_async)). After an error, nothing is added.
    ///
    /// # Errors
    /// As for [`Scene::add_character`].
    pub async fn add_character_async(&mut self, model: &Model, capacity: usize) -> Result<ObjectId, Error> {
        self.add_character_with_async(model, capacity, &CharacterOptions::default()).await
    }

    /// Like [`Scene::add_character_with`], but the future completes once the device has reported its errors
    /// ([`Gpu::check_async`](crate::gpu::Gpu::check_async)). After an error, nothing is added.
    ///
    /// # Errors
    /// As for [`Scene::add_character_with`].
    pub async fn add_character_with_async(
        &mut self,
        model: &Model,
        capacity: usize,
        options: &CharacterOptions<'_>,
    ) -> Result<ObjectId, Error> {
        let object = self.character(model, capacity, options)?;
        self.add_checked(object).await
    }

    pub(super) fn character(
        &self,
        model: &Model,
        capacity: usize,
        options: &CharacterOptions<'_>,
    ) -> Result<Object, Error> {
        if model.clips.is_empty() {
            return self.mesh(model, capacity);
        }
        let (gpu, pending) = self.uploader();
        let (layouts, budget) = (&self.layouts_of_groups, self.budget);
        let object = Object::of_character(&gpu, layouts, model, options, capacity, budget, self.keeps_last)?;
        Ok(object.awaiting(pending))
    }

    pub(super) fn mesh(&self, model: &Model, capacity: usize) -> Result<Object, Error> {
        let (gpu, pending) = self.uploader();
        let object = Object::of_mesh(&gpu, &self.layouts_of_groups, model, capacity)?;
        Ok(object.awaiting(pending))
    }

    fn relief(&self, relief: &Relief, capacity: usize) -> Result<Object, Error> {
        let (gpu, pending) = self.uploader();
        let object = Object::of_relief(&gpu, &self.layouts_of_groups, relief, capacity)?;
        Ok(object.awaiting(pending))
    }

    /// Adds a mesh with relief mapping. The object has memory for at least `capacity` instances, 1 to 2²⁰, and grows
    /// when more are spawned ([`Scene::spawn`]).
    ///
    /// # Errors
    /// [`InputError`] for a capacity out of range, for maps, options or a mesh that do not fit each other, for a mesh with
    /// values that are not finite, and for images without texels or too large for a texture of the device;
    /// [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// A brick wall, 4 units wide, that repeats its maps twice along each edge.
    ///
    /// ```no_run
    /// # use relievo::scene::{HeightMap, Placement, Relief, Scene};
    /// # fn example(scene: &mut Scene, heights: HeightMap, colors: image::RgbaImage) -> Result<(), relievo::Error> {
    /// let wall = scene.add_relief(&Relief::wall(2.0, heights, colors), 1)?;
    /// scene.spawn(wall, Placement::at_world([0.0, 2.0, -10.0]).scaled(4.0))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn add_relief(&mut self, relief: &Relief, capacity: usize) -> Result<ObjectId, Error> {
        let object = self.relief(relief, capacity)?;
        Ok(self.add(object))
    }

    /// Like [`Scene::add_relief`], but the future completes once the device has reported its errors
    /// ([`Gpu::check_async`](crate::gpu::Gpu::check_async)). After an error, nothing is added.
    ///
    /// # Errors
    /// As for [`Scene::add_relief`].
    pub async fn add_relief_async(&mut self, relief: &Relief, capacity: usize) -> Result<ObjectId, Error> {
        let object = self.relief(relief, capacity)?;
        self.add_checked(object).await
    }

    /// Adds an object of a caller-defined kind. The object has memory for at least `capacity` instances, 1 to 2²⁰, and
    /// grows when more are spawned ([`Scene::spawn`]). Its levels of detail change at once ([`Transition::Hard`]).
    ///
    /// # Errors
    /// [`InputError`] for a capacity out of range, and for invalid levels, parts, indices or an invalid sphere of the
    /// kind. The error names the field, such as `kind.parts[0].levels[1]`. [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// Two instances of grass. The grass is a [`Kind`] of the caller, as in `examples/kind`.
    ///
    /// ```no_run
    /// # use relievo::scene::kind::Kind;
    /// # use relievo::scene::{Placement, Scene};
    /// # fn example(scene: &mut Scene, grass: impl Kind) -> Result<(), relievo::Error> {
    /// let meadow = scene.add_kind(grass, 2)?;
    /// scene.spawn(meadow, Placement::at_world([0.0, 0.0, 0.0]))?;
    /// scene.spawn(meadow, Placement::at_world([16.0, 0.0, 0.0]))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn add_kind(&mut self, kind: impl Kind, capacity: usize) -> Result<ObjectId, Error> {
        let (gpu, pending) = self.uploader();
        let object = Object::of_kind(&gpu, &self.layouts_of_groups, Box::new(kind), capacity)?;
        Ok(self.add(object.awaiting(pending)))
    }

    /// Like [`Scene::add_kind`], but the future completes once the device has reported its errors
    /// ([`Gpu::check_async`](crate::gpu::Gpu::check_async)). After an error, nothing is added.
    ///
    /// # Errors
    /// As for [`Scene::add_kind`].
    pub async fn add_kind_async(&mut self, kind: impl Kind, capacity: usize) -> Result<ObjectId, Error> {
        let (gpu, pending) = self.uploader();
        let object = Object::of_kind(&gpu, &self.layouts_of_groups, Box::new(kind), capacity)?;
        self.add_checked(object.awaiting(pending)).await
    }

    /// Waits for the device's errors, and adds the object if there are none.
    async fn add_checked(&mut self, object: Object) -> Result<ObjectId, Error> {
        self.gpu.check_async().await?;
        Ok(self.add(object))
    }

    fn add(&mut self, object: Object) -> ObjectId {
        self.layout = None;
        let [index, generation] = self.objects.insert(object);
        let (id, keeps_last) = (ObjectId { scene: self.objects.scene(), index, generation }, self.keeps_last);
        if let Some(object) = self.objects.get_mut([index, generation]) {
            object.handle = id.number();
            if keeps_last {
                object.instances.keep_last(true);
            }
        }
        self.update_ranks();
        id
    }

    /// Notes in every object whether any object of the scene has a rank.
    fn update_ranks(&mut self) {
        let is_ranked = self.objects.iter().any(|object| object.level_of_detail.rank.is_some());
        for object in self.objects.iter_mut() {
            object.is_retuned |= object.is_ranked != is_ranked;
            object.is_ranked = is_ranked;
        }
    }

    /// Removes an object with all of its instances, and frees its memory.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn remove(&mut self, object: ObjectId) -> Result<(), InputError> {
        for instance in self.instances(object)? {
            self.let_go(instance)?;
        }
        self.object_at(object)?;
        self.objects.remove([object.index, object.generation]);
        self.update_ranks();
        self.layout = None;
        Ok(())
    }

    /// Shows or hides all instances of an object in all views, from the next recording on. Hidden instances are not
    /// sampled, skinned or drawn. The time of their clips still advances.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene; [`crate::gpu::GpuError`].
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, land: ObjectId, is_indoors: bool) -> Result<(), relievo::Error> {
    /// scene.set_visible(land, !is_indoors)?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_visible(&mut self, object: ObjectId, is_visible: bool) -> Result<(), Error> {
        let entry = self.object_mut(object)?;
        if std::mem::replace(&mut entry.is_visible, is_visible) != is_visible {
            // Writes only the entries of this object. A new layout would write the entries of all objects.
            let entries = entry.chunks.iter().map(|chunk| (chunk.number, entry.lod_object(chunk)));
            let entries: Vec<_> = entries.collect();
            if let Some(layout) = &self.layout {
                for (number, value) in entries {
                    self.staged.elements(&layout.objects, number, &[value])?;
                }
            }
        }
        Ok(())
    }

    /// Sets how an object's levels of detail are chosen and change, from the next recording on. After a change of the
    /// transition, prepare the renderers again ([`Renderer::prepare`](crate::render::Renderer::prepare)).
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, and for settings that [`LevelOfDetail::validate`]
    /// refuses. [`Transition::Geomorph`] needs levels of detail, and for each vertex a partner to move towards
    /// ([`add_levels`](crate::skinning::add_levels) finds partners). So geomorphs are always refused for terrain, for
    /// reliefs, and for meshes that exceed a binding of the device.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::render::Renderer;
    /// # use relievo::scene::{ObjectId, Scene, Transition};
    /// # fn example(scene: &mut Scene, renderer: &mut Renderer, crowd: ObjectId) -> Result<(), relievo::Error> {
    /// if scene.can_morph(crowd)? {
    ///     scene.set_level_of_detail(crowd, &Transition::Geomorph.into())?;
    ///     renderer.prepare(scene)?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_level_of_detail(
        &mut self,
        object: ObjectId,
        level_of_detail: &LevelOfDetail,
    ) -> Result<(), Error> {
        let levels = self.object_at(object)?.newest().errors.len();
        self.set_level_of_detail_among(object, level_of_detail, levels)
    }

    /// [`Scene::set_level_of_detail`] for a model that may get as many as `levels` levels later.
    ///
    /// # Errors
    /// As [`Scene::set_level_of_detail`], for a model of `levels` levels.
    pub fn set_level_of_detail_among(
        &mut self,
        object: ObjectId,
        level_of_detail: &LevelOfDetail,
        levels: usize,
    ) -> Result<(), Error> {
        let entry = self.object_mut(object)?;
        level_of_detail.validate(levels)?;
        if level_of_detail.transition == Transition::Geomorph && !entry.newest().can_morph() {
            let bound = "must have levels of detail with partners";
            return Err(InputError::new("object.levels", entry.errors.len(), bound).into());
        }
        let last = std::mem::replace(&mut entry.level_of_detail, level_of_detail.clone());
        entry.is_retuned = true;
        entry.mark_transition();
        // The layout says what is drawn and how it is counted.
        let laid_out = |of: &LevelOfDetail| {
            (of.transition().code(), of.transition.fades(), of.is_bounded(), of.largest_factor())
        };
        if laid_out(&last) != laid_out(level_of_detail) {
            self.layout = None;
        }
        self.update_ranks();
        Ok(())
    }

    /// How an object's levels of detail are chosen and change.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn level_of_detail(&self, object: ObjectId) -> Result<&LevelOfDetail, InputError> {
        Ok(&self.object_at(object)?.level_of_detail)
    }

    /// Whether an object's levels can geomorph. This needs levels of detail, and for each vertex a partner to move
    /// towards.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn can_morph(&self, object: ObjectId) -> Result<bool, InputError> {
        Ok(self.object_at(object)?.newest().can_morph())
    }

    pub(super) fn object_mut(&mut self, object: ObjectId) -> Result<&mut Object, InputError> {
        let ObjectId { scene, index, generation } = object;
        if scene != self.objects.scene() {
            return Err(foreign("object"));
        }
        self.objects.get_mut([index, generation]).ok_or_else(|| stale("object", index, generation))
    }

    pub(super) fn object_at(&self, object: ObjectId) -> Result<&Object, InputError> {
        let ObjectId { scene, index, generation } = object;
        if scene != self.objects.scene() {
            return Err(foreign("object"));
        }
        self.objects.get([index, generation]).ok_or_else(|| stale("object", index, generation))
    }
}
