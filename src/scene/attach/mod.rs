//! Attaching meshes to bones of characters.

mod lists;

use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, Vec3};

use crate::InputError;
use crate::animation::local_to_model::reference::affine;
use crate::asset::Transform;
use crate::lod::{INSTANCE_CARRIES, INSTANCE_FOLLOWS, SceneInstance};
use crate::scene::Scene;
use crate::scene::handles::{InstanceId, ObjectId};
use crate::scene::instances;
use crate::scene::matrices::affine_of;
use crate::scene::placement::Placement;
use crate::skinning::bone_path::BonePath;
use crate::skinning::bounding_sphere::BoundingSphere;
use lists::List;

/// Cache key of a [`BonePath`]: character, clip, whether layers are blended over the clip, bone, and the bits of the attached
/// mesh's bounding sphere.
type PathKey = (ObjectId, (u32, bool), usize, [u32; 4]);

/// Slot and generation of a character's object, and the index of a chunk in the object.
type ListKey = ([u32; 2], usize);

/// All attached meshes of a scene.
#[derive(Debug, Default)]
pub(super) struct Attachments {
    all: HashMap<InstanceId, Attached>,
    /// The meshes attached to each character instance.
    carried: HashMap<InstanceId, Vec<InstanceId>>,
    /// Cache: for attached meshes, the paths of their bounding spheres as the bones move.
    paths: HashMap<PathKey, BonePath>,
    /// One list per chunk in which any character carries a mesh or has carried one before.
    lists: BTreeMap<ListKey, List>,
    /// Version of `lists`: the number of lists allocated and dropped so far. Jobs prepared for another version are outdated.
    pub version: u64,
    /// Version of the layout that the lists were written for; `None` if attachments have changed since.
    written: Option<u64>,
    /// Number of attachments made so far.
    made: u32,
    /// Whether the next frame ignores the motion history.
    starts_afresh: bool,
}

/// An attached mesh.
#[derive(Debug, Clone, Copy)]
struct Attached {
    character: InstanceId,
    bone: usize,
    /// The transform from mesh space to bone space.
    offset: Transform,
    /// A bounding sphere of the mesh, in bone space.
    sphere: BoundingSphere,
    /// The placement that the mesh takes when it is detached.
    own: Placement,
    /// Serial number of this attachment among all attachments ever made.
    key: u32,
}

impl Scene {
    /// Attaches a mesh to a bone of a character. The bone is given by its name or its index in digits. `offset` is the
    /// transform from mesh space to bone space. From the next frame on, the mesh follows the bone in each frame's pose. The
    /// device computes the pose and the mesh's transform. If the mesh is already attached, it moves to the new bone.
    ///
    /// The offset is in bone space, so the scales of the character and its bones apply to it. Suppose that a character is
    /// modelled in centimetres and placed with a scale of 0.01. A translation of 1 is one centimetre, and a mesh modelled in
    /// metres shrinks to a hundredth of its size.
    /// [`InstancePose::offset_of_world_units`](crate::scene::InstancePose::offset_of_world_units) converts an offset in world
    /// units to bone space: `scene.pose(character)?.offset_of_world_units(bone, offset)?`.
    ///
    /// Views cull the mesh together with its character. They use one sphere that holds both in every pose of the clip. The
    /// mesh's level of detail meets [`Quality::pixels`](crate::scene::Quality) for every pose of the bone. While a
    /// character carries a mesh, all bones of the character are sampled in every frame that shows it. The mesh is therefore
    /// exactly in place, up to rounding. [`Scene::world_from_model`] returns the mesh's transform. If no view of a frame
    /// sees the character, because it is hidden or masked out, the mesh is not drawn either. Despawning the character
    /// detaches the mesh.
    ///
    /// In [`Layer::Velocity`](crate::render::Layer::Velocity), the mesh moves with its bone. In the frame in which it is
    /// attached, it moves from its previous position. In three cases the mesh moves only with its character's placement for
    /// one frame: the mesh changes to another bone, its character was not visible in the last frame, or the object's
    /// characters carry more meshes than ever before. In the frame in which it is detached, the mesh counts as not moving.
    ///
    /// Cost: the host samples each clip that the character plays, once per clip and bone.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more; if `mesh` is no mesh or `character` is no character; for
    /// a bone that the model does not have; and for an offset that is not finite, scales by 0 along all axes, or has a
    /// rotation of length 0.
    ///
    /// # Examples
    ///
    /// A sword in a hand, 10 cm along the bone's +Y axis in the world.
    ///
    /// ```no_run
    /// # use relievo::asset::Transform;
    /// # use relievo::scene::{InstanceId, Scene};
    /// # fn example(scene: &mut Scene, sword: InstanceId, fighter: InstanceId) -> Result<(), relievo::Error> {
    /// let hand = scene.bone(fighter, "hand_right")?;
    /// let offset = Transform { translation: [0.0, 0.1, 0.0], ..Transform::IDENTITY };
    /// let offset = scene.pose(fighter)?.offset_of_world_units(hand, offset)?;
    /// scene.attach(sword, fighter, "hand_right", offset)?;
    /// // … later, it falls where it is:
    /// let (_, _, place) = scene.world_from_model(sword)?.to_scale_rotation_translation();
    /// scene.detach(sword)?;
    /// scene.move_to(sword, relievo::scene::Placement::at_world(place))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn attach(
        &mut self,
        mesh: InstanceId,
        character: InstanceId,
        bone: &str,
        offset: Transform,
    ) -> Result<(), InputError> {
        let bone = self.bone(character, bone).map_err(|error| renamed(error, "character"))?;
        let object = self.object_of(mesh).map_err(|error| renamed(error, "mesh"))?;
        if !object.kind.is_attachable() {
            return Err(InputError::new("mesh", "no mesh", "must be an instance of a mesh"));
        }
        let offset = offset.checked("offset")?;
        let is_flat = offset.scale.iter().all(|scale| *scale == 0.0);
        InputError::check(!is_flat, "offset.scale", 0, || "must not be 0 along all axes")?;
        let sphere = in_bone_space(&object.sphere, &offset);
        let own = self.placement(mesh)?;
        self.release(mesh);
        self.attachments.made = self.attachments.made.wrapping_add(1);
        let key = self.attachments.made;
        self.attachments.all.insert(mesh, Attached { character, bone, offset, sphere, own, key });
        self.attachments.carried.entry(character).or_default().push(mesh);
        self.attachments.written = None;
        self.carry(character)
    }

    /// Detaches a mesh. The mesh returns to its own placement ([`Scene::placement`]): the placement before it was attached,
    /// or the last one set by [`Scene::move_to`] since then.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more or is not attached.
    pub fn detach(&mut self, mesh: InstanceId) -> Result<(), InputError> {
        self.object_of(mesh).map_err(|error| renamed(error, "mesh"))?;
        let Some(Attached { character, own, .. }) = self.release(mesh) else {
            return Err(InputError::new("mesh", "not attached", "must be attached"));
        };
        let object = self.instance_mut(mesh)?;
        let sphere = object.sphere;
        object.instances.change(mesh.index, |instance| {
            instance.flags &= !INSTANCE_FOLLOWS;
            instances::place(instance, &own);
            instances::bound(instance, &sphere);
        });
        self.carry(character)
    }

    /// The character and the bone index that a mesh is attached to; `None` if it is not attached.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn attached_to(&self, mesh: InstanceId) -> Result<Option<(InstanceId, usize)>, InputError> {
        self.object_of(mesh).map_err(|error| renamed(error, "mesh"))?;
        Ok(self.attachments.all.get(&mesh).map(|attached| (attached.character, attached.bone)))
    }

    /// The placement that an attached mesh takes when it is detached; `None` if the mesh is not attached.
    pub(super) fn detached_placement(&self, mesh: InstanceId) -> Option<Placement> {
        self.attachments.all.get(&mesh).map(|attached| attached.own)
    }

    /// Sets the placement that an attached mesh takes when it is detached. Returns whether the mesh is attached.
    pub(super) fn move_detached(&mut self, mesh: InstanceId, placement: Placement) -> bool {
        let attached = self.attachments.all.get_mut(&mesh);
        attached.map(|attached| attached.own = placement).is_some()
    }

    /// Ends all attachments of an instance that is despawned, whether it is the character or the attached mesh.
    pub(super) fn let_go(&mut self, instance: InstanceId) -> Result<(), InputError> {
        for mesh in self.attachments.carried.get(&instance).cloned().unwrap_or_default() {
            self.detach(mesh)?;
        }
        match self.release(instance) {
            Some(Attached { character, .. }) => self.carry(character),
            None => Ok(()),
        }
    }

    /// Removes the attachment of a mesh and returns it; `None` if the mesh is not attached.
    fn release(&mut self, mesh: InstanceId) -> Option<Attached> {
        let attached = self.attachments.all.remove(&mesh)?;
        if let Some(carried) = self.attachments.carried.get_mut(&attached.character) {
            carried.retain(|other| *other != mesh);
        }
        self.attachments.written = None;
        Some(attached)
    }

    /// Gives a character and its attached meshes a common bounding sphere, so that views select them together. Call this
    /// function after the character, a mesh, a placement or a clip has changed.
    pub(super) fn carry(&mut self, character: InstanceId) -> Result<(), InputError> {
        let Some(meshes) = self.attachments.carried.get(&character).cloned() else { return Ok(()) };
        let ObjectId { index, generation, .. } = character.object;
        let Some(object) = self.objects.get_mut([index, generation]) else { return Ok(()) };
        let Some(animated) = object.character() else { return Ok(()) };
        let mut around = animated.sphere_as_played(character.index);
        let mut paths = Vec::new();
        for mesh in &meshes {
            let Some(attached) = self.attachments.all.get(mesh) else { continue };
            let BoundingSphere { center, radius } = attached.sphere;
            let bits = [center.x, center.y, center.z, radius].map(f32::to_bits);
            let key = (character.object, animated.path_key(character.index), attached.bone, bits);
            let path = || animated.path_of(character.index, attached.bone, &attached.sphere);
            let path = *self.attachments.paths.entry(key).or_insert_with(path);
            around = around.with(&path.sphere);
            paths.push((*mesh, path, attached.offset));
        }
        object.instances.change(character.index, |instance| {
            instances::bound(instance, &around);
            instance.flags &= !INSTANCE_CARRIES;
            instance.flags |= if meshes.is_empty() { 0 } else { INSTANCE_CARRIES };
        });
        let leader = object.instances.all()[character.index as usize];
        if meshes.is_empty() {
            self.attachments.carried.remove(&character);
        }
        for (mesh, path, offset) in paths {
            let object = self.instance_mut(mesh)?;
            object.instances.change(mesh.index, |instance| follow(instance, &leader, &path, &offset));
        }
        Ok(())
    }

    /// Gives all attached meshes, and the characters that carry them, the bounding spheres of their models. Call this function
    /// after models were replaced.
    pub(super) fn carry_all(&mut self) -> Result<(), InputError> {
        self.attachments.paths.clear();
        for (mesh, attached) in &mut self.attachments.all {
            let ObjectId { index, generation, .. } = mesh.object;
            if let Some(object) = self.objects.get([index, generation]) {
                attached.sphere = in_bone_space(&object.sphere, &attached.offset);
            }
        }
        let characters: Vec<InstanceId> = self.attachments.carried.keys().copied().collect();
        characters.into_iter().try_for_each(|character| self.carry(character))
    }

    /// The transform of an attached mesh from mesh space to world axes, relative to the corner of `cell`, in the pose at the
    /// scene's time. `None` if the mesh is not attached.
    pub(super) fn attached_placed(
        &self,
        mesh: InstanceId,
        cell: [i32; 3],
    ) -> Result<Option<DAffine3>, InputError> {
        let Some(attached) = self.attachments.all.get(&mesh) else { return Ok(None) };
        let Attached { character, bone, offset, .. } = attached;
        let Some(animated) = self.object_of(*character)?.character() else { return Ok(None) };
        let pose = animated.pose(character.index, self.now)?;
        let bone = affine_of(&pose.model_matrices[*bone]) * affine_of(&affine(offset));
        Ok(Some(self.placed(*character, cell)? * bone))
    }
}

/// A sphere of mesh space in the space of the bone that the mesh is attached to.
fn in_bone_space(sphere: &BoundingSphere, offset: &Transform) -> BoundingSphere {
    let largest = offset.scale.iter().fold(0.0_f32, |largest, scale| largest.max(scale.abs()));
    let center = affine_of(&affine(offset)).transform_point3(sphere.center.as_dvec3()).as_vec3();
    BoundingSphere { center, radius: largest * sphere.radius }
}

/// Gives an attached mesh the placement and the sphere of its character, so that views select both alike. The mesh's scale
/// includes the largest factor by which bone and offset enlarge the mesh. The scale's x is negated if bone and offset
/// together mirror the mesh.
fn follow(mesh: &mut SceneInstance, leader: &SceneInstance, path: &BonePath, offset: &Transform) {
    let largest = offset.scale.iter().fold(0.0_f32, |largest, scale| largest.max(scale.abs()));
    let enlarged = (path.stretch * largest).max(1e-6);
    let mirrors = path.mirrors != (offset.scale.iter().filter(|scale| **scale < 0.0).count() % 2 == 1);
    let factors = Vec3::new(if mirrors { -enlarged } else { enlarged }, enlarged, enlarged);
    let [x, y, z, radius] = leader.bounding_sphere;
    mesh.flags |= INSTANCE_FOLLOWS;
    mesh.cell = leader.cell;
    mesh.offset = leader.offset;
    mesh.rotation = leader.rotation;
    mesh.scale = (Vec3::from(leader.scale) * factors).into();
    let center = Vec3::new(x, y, z) / factors;
    mesh.bounding_sphere = center.extend(radius / enlarged).into();
}

fn renamed(error: InputError, path: &str) -> InputError {
    let path = if error.path == "instance" { path.to_owned() } else { error.path };
    InputError { path, ..error }
}
