//! Queries about a scene's instances and, for measurements, about the instances that a view draws.

use glam::DAffine3;

use super::handles::missing;
use super::object::Object;
use super::{ClipTime, InstanceId, ObjectId, Placement, Scene};
use crate::InputError;
use crate::shared::lod::instance::SceneInstance;

#[cfg(not(target_arch = "wasm32"))]
pub use drawn::{DrawnAs, DrawnInstance};

impl Scene {
    /// All instances of an object, in the order in which views list them. The instances of terrain are its patches.
    /// Patches can be hidden ([`Scene::set_visibility_mask`]), but not moved, removed or tinted.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    ///
    /// # Examples
    ///
    /// Hides all patches of a terrain except the first.
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene};
    /// # fn example(scene: &mut Scene, land: ObjectId) -> Result<(), relievo::Error> {
    /// for patch in scene.instances(land)?.into_iter().skip(1) {
    ///     scene.set_visibility_mask(patch, 0)?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn instances(&self, object: ObjectId) -> Result<Vec<InstanceId>, InputError> {
        let all = self.object_at(object)?.instances.each();
        Ok(all.map(|[index, generation]| InstanceId { object, index, generation }).collect())
    }

    /// The placement of an instance. For an attached instance, this is the placement that detaching restores;
    /// [`Scene::world_from_model`] returns the present transform.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn placement(&self, instance: InstanceId) -> Result<Placement, InputError> {
        let object = self.object_of(instance)?;
        if let Some(placement) = self.detached_placement(instance) {
            return Ok(placement);
        }
        let SceneInstance { cell, offset, rotation, scale, .. } =
            object.instances.all()[instance.index as usize];
        let turn = glam::Quat::from_array(rotation);
        Ok(Placement { cell, offset: offset.into(), turn, scale: scale.into() })
    }

    /// The transform from an instance's model space to world coordinates, in world units. An attached mesh
    /// ([`Scene::attach`]) follows its bone. The host samples the bone's pose at the scene's time. Bones that were
    /// written in the last frame are treated as in [`Scene::pick`]. For an instance that is not attached, the transform
    /// equals [`Scene::placement`].
    ///
    /// The result is not a [`Placement`], because bones may shear a mesh. Without shear,
    /// `to_scale_rotation_translation()` splits the result into the parts of a placement.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// World coordinates of the tip of a sword, 0.9 units along the model's +Y.
    ///
    /// ```no_run
    /// # use glam::DVec3;
    /// # use relievo::scene::{InstanceId, Scene};
    /// # fn tip(scene: &Scene, sword: InstanceId) -> Result<DVec3, relievo::InputError> {
    /// Ok(scene.world_from_model(sword)?.transform_point3(DVec3::new(0.0, 0.9, 0.0)))
    /// # }
    /// ```
    pub fn world_from_model(&self, instance: InstanceId) -> Result<DAffine3, InputError> {
        let cell = self.object_of(instance)?.instances.all()[instance.index as usize].cell;
        Ok(DAffine3::from_translation(Placement::corner(cell)) * self.placed(instance, cell)?)
    }

    /// The clip that an instance plays, and the time in that clip at the scene's time. `None` if the instance is not a
    /// character.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    ///
    /// # Examples
    ///
    /// Lets a fighter walk after a jump has ended.
    ///
    /// ```no_run
    /// # use relievo::scene::{InstanceId, Play, Scene};
    /// # fn example(scene: &mut Scene, fighter: InstanceId, jump: usize, duration: f32) -> Result<(), relievo::Error> {
    /// // `jump` is the clip's index in the model, and `duration` is `model.clips[jump].duration()`.
    /// let playing = scene.clip_time(fighter)?;
    /// if playing.is_some_and(|at| at.clip == jump && at.seconds >= duration) {
    ///     scene.cross_fade(fighter, 1, &Play { start: scene.time(), ..Play::new("walk") }, 0.2)?;
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn clip_time(&self, instance: InstanceId) -> Result<Option<ClipTime>, InputError> {
        let character = self.object_of(instance)?.character();
        character.map(|character| character.clip_time(instance.index, self.now)).transpose()
    }

    /// The object of an existing instance.
    pub(super) fn object_of(&self, instance: InstanceId) -> Result<&Object, InputError> {
        self.objects.existing(instance).ok_or_else(|| missing(self.objects.scene(), instance))
    }
}

#[cfg(not(target_arch = "wasm32"))]
mod drawn {
    use super::*;
    use crate::Error;
    use crate::asset::Affine;
    use crate::lod::OBJECT_LISTS;
    use crate::scene::View;
    use crate::scene::mesh::MeshDrawable;
    use crate::scene::view::lists::ViewLists;
    use crate::shared::lod::object::{MORPH_STEPS, list_entry_instance, list_entry_steps};
    use crate::skinning::vertex::Vertex;

    /// An instance that a view may show, and how the view drew it in its last frame.
    #[derive(Debug, Clone, Copy)]
    pub struct DrawnInstance {
        /// The instance.
        pub instance: InstanceId,
        /// How the view drew the instance; `None` if the view did not draw it.
        pub drawn: Option<DrawnAs>,
    }

    /// How a view drew an instance.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct DrawnAs {
        /// Index of the list that contains the instance: 2 · level, plus 1 if the instance is mirrored. A fading
        /// instance is in the list of the finer level.
        pub list: u32,
        /// Progress of the geomorph to the next coarser level, 0 to 1.
        pub way: f64,
        /// The transform from model space to the corner of the view's cell.
        pub placement: Affine,
    }

    /// Functions for `relievo-lab`, which measures drawn frames.
    #[doc(hidden)]
    impl Scene {
        /// Whether an object is a character.
        pub fn is_character(&self, object: ObjectId) -> Result<bool, InputError> {
            Ok(self.object_at(object)?.character().is_some())
        }

        /// The instances of an object that a view may show, as drawn in the view's last frame. Submit that frame before
        /// this call, which waits for the device.
        pub fn drawn_instances(&self, view: &View, object: ObjectId) -> Result<Vec<DrawnInstance>, Error> {
            let entry = self.object_at(object)?;
            let buffers = self.lists_of(view)?;
            let draws = buffers.arguments.read_blocking(&self.gpu)?;
            let lists = buffers.lists.read_blocking(&self.gpu)?;
            let placements = buffers.placements.read_blocking(&self.gpu)?;
            let mut drawn = vec![None; entry.instances.capacity()];
            for chunk in &entry.chunks {
                let (range, room) = (chunk.range, chunk.room() as usize);
                for list in 0..2 * entry.errors.len() {
                    let count = draws[range.first_draw as usize + list].instance_count as usize;
                    for entry in &lists[range.first_list as usize + list * room..][..count] {
                        let index = list_entry_instance(*entry);
                        let steps = list_entry_steps(*entry);
                        let way = f64::from(steps) / f64::from(MORPH_STEPS);
                        let placement = placements[(range.first + index) as usize];
                        let drawn_as = DrawnAs { list: list as u32, way, placement };
                        drawn[chunk.slots.start + index as usize] = Some(drawn_as);
                    }
                }
            }
            let all = entry.instances.each();
            let shown = all.filter(|[index, _]| {
                entry.is_drawn() && view.may_show(entry.instances.all()[*index as usize].flags)
            });
            let instance = |[index, generation]: [u32; 2]| DrawnInstance {
                instance: InstanceId { object, index, generation },
                drawn: drawn[index as usize],
            };
            Ok(shown.map(instance).collect())
        }

        fn lists_of<'a>(&self, view: &'a View) -> Result<&'a ViewLists, InputError> {
            let lists = view.lists.as_ref().filter(|_| view.is_of(self.objects.scene()));
            let bound = "must be of this scene, and recorded";
            lists.ok_or_else(|| InputError::new("view", "not recorded", bound))
        }

        /// The triangles that a view draws for one list of an object, for each merged mesh. Each corner is the index of
        /// a vertex in the order of the mesh's clusters. The call waits for the device.
        pub fn drawn_triangles(
            &self,
            view: &View,
            object: ObjectId,
            list: u32,
        ) -> Result<Vec<Vec<[u32; 3]>>, Error> {
            let object = self.object_at(object)?;
            let draws = self.lists_of(view)?.arguments.read_blocking(&self.gpu)?;
            let mut all = Vec::new();
            // All chunks draw the same triangles.
            let chunks = object.chunks.iter().take(1);
            for (drawable, lod) in chunks.flat_map(|chunk| chunk.drawables.iter().zip(&chunk.lods)) {
                let Some(mesh) = drawable.downcast::<MeshDrawable>() else { continue };
                let indices = mesh.geometry.indices.read_blocking(&self.gpu)?;
                let of_part = |part: u32| {
                    let draw = &draws[(lod.first_draw + OBJECT_LISTS * part + list) as usize];
                    indices[draw.first_index as usize..][..draw.index_count as usize].as_chunks::<3>().0
                };
                all.push((0..mesh.parts.len() as u32).flat_map(of_part).copied().collect());
            }
            Ok(all)
        }

        /// The drawn vertices of an object's instances, for each merged mesh. The call waits for the device.
        ///
        /// - Character: for each instance, its skinned vertices in the mesh's own order. A vertex without a page is
        ///   `None`.
        /// - Mesh: the vertices that all instances share, once, in the order of the mesh's clusters.
        pub fn drawn_vertices(
            &self,
            object: ObjectId,
            instances: &[InstanceId],
        ) -> Result<Vec<Vec<Vec<Option<Vertex>>>>, Error> {
            let object = self.object_at(object)?;
            if let Some(character) = object.character() {
                let indices: Vec<u32> = instances.iter().map(|instance| instance.index).collect();
                return character.skinned(&self.gpu, &indices);
            }
            let meshes = object.drawables().filter_map(|drawable| drawable.downcast::<MeshDrawable>());
            let vertices = |mesh: &MeshDrawable| mesh.geometry.vertices.read_blocking(&self.gpu);
            let all = meshes.map(|mesh| Ok(vertices(mesh)?.into_iter().map(Some).collect()));
            Ok(vec![all.collect::<Result<_, Error>>()?])
        }
    }
}
