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

/// Key of a bone path: character, clip, whether layers are blended over it, bone, and the bits of the carried sphere.
type PathKey = (ObjectId, (u32, bool), usize, [u32; 4]);

/// All attached meshes.
#[derive(Debug, Default)]
pub(super) struct Attachments {
    all: HashMap<InstanceId, Attached>,
    /// Attached meshes of each character.
    carried: HashMap<InstanceId, Vec<InstanceId>>,
    /// Cached bone paths.
    paths: HashMap<PathKey, BonePath>,
    /// List of each chunk that carries a mesh or has carried one. The key is slot and generation of the object, and the
    /// chunk.
    lists: BTreeMap<([u32; 2], usize), List>,
    /// Number of list allocations. Jobs prepared for another number are outdated.
    pub version: u64,
    /// Version of the layout that the lists were written for; `None` if attachments have changed since.
    written: Option<u64>,
    /// Number of attachments ever made.
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
    /// A sphere around the mesh in bone space.
    sphere: BoundingSphere,
    /// The mesh's placement once it is detached.
    own: Placement,
    /// Its number among all attachments ever made.
    key: u32,
}

impl Scene {
    /// Attaches a mesh to a bone of a character. The bone is given by its name or its index in digits. From the next frame
    /// on, the mesh follows the bone in each frame's pose, with `offset` from mesh space to bone space. No pose passes
    /// through the host. If the mesh is already attached, it changes to the new bone.
    ///
    /// The offset is in bone space, so the scales of the character and its bones apply to it. Take a character modelled in
    /// centimetres and placed with a scale of 0.01: a translation of 1 is a centimetre, and a mesh in metres is a hundredth
    /// of its size. [`InstancePose::offset_of_world_units`](crate::scene::InstancePose::offset_of_world_units) converts an
    /// offset in world units to bone space: `scene.pose(character)?.offset_of_world_units(bone, offset)?`.
    ///
    /// Views select the mesh together with its character. They use a sphere that holds both wherever the clip takes the
    /// bone, and a level of detail that [`Quality::pixels`](crate::scene::Quality) allows there. While a character carries
    /// a mesh, its bones are sampled in every frame that sees it, so the mesh is in place except for rounding.
    /// [`Scene::world_from_model`] returns its transform. If no view of a frame sees the character, because it is hidden or
    /// masked out, the mesh is not drawn either. Despawning the character detaches the mesh.
    ///
    /// In [`Layer::Velocity`](crate::render::Layer::Velocity) the mesh moves with its bone. In the frame in which it is
    /// attached, it moves from its previous place. For one frame it moves with its character alone in three cases: it
    /// changes to another bone, its character was not seen in the last frame, or the object's characters carry more meshes
    /// than ever before. When it is detached, it does not move.
    ///
    /// The call samples each clip that the character plays, once per bone.
    ///
    /// # Errors
    /// [`InputError`] for instances that do not exist any more, for a mesh or a character that is not one, for a bone that
    /// the model does not have, and for an offset that is not finite, has no rotation, or scales by 0.
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
        let largest = offset.scale.iter().fold(0.0_f32, |largest, scale| largest.max(scale.abs()));
        if largest == 0.0 {
            return Err(InputError::new("offset.scale", 0, "must not be 0 along all axes"));
        }
        let BoundingSphere { center, radius } = object.sphere;
        let placed = affine_of(&affine(&offset));
        let center = placed.transform_point3(center.as_dvec3()).as_vec3();
        let sphere = BoundingSphere { center, radius: largest * radius };
        let own = self.placement(mesh)?;
        self.release(mesh);
        self.attachments.made = self.attachments.made.wrapping_add(1);
        let key = self.attachments.made;
        self.attachments.all.insert(mesh, Attached { character, bone, offset, sphere, own, key });
        self.attachments.carried.entry(character).or_default().push(mesh);
        self.attachments.written = None;
        self.carry(character)
    }

    /// Detaches a mesh. It returns to its own placement ([`Scene::placement`]): the one from before it was attached, or the
    /// last one set by [`Scene::move_to`] since.
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

    /// An attached mesh's placement once it is detached.
    pub(super) fn detached_placement(&self, mesh: InstanceId) -> Option<Placement> {
        self.attachments.all.get(&mesh).map(|attached| attached.own)
    }

    /// Sets an attached mesh's placement once it is detached. Returns whether the mesh is attached.
    pub(super) fn move_detached(&mut self, mesh: InstanceId, placement: Placement) -> bool {
        let attached = self.attachments.all.get_mut(&mesh);
        attached.map(|attached| attached.own = placement).is_some()
    }

    /// Removes the attachments of an instance that is despawned, as character and as mesh.
    pub(super) fn let_go(&mut self, instance: InstanceId) -> Result<(), InputError> {
        for mesh in self.attachments.carried.get(&instance).cloned().unwrap_or_default() {
            self.detach(mesh)?;
        }
        match self.release(instance) {
            Some(Attached { character, .. }) => self.carry(character),
            None => Ok(()),
        }
    }

    /// Removes an attachment, if there is one.
    fn release(&mut self, mesh: InstanceId) -> Option<Attached> {
        let attached = self.attachments.all.remove(&mesh)?;
        if let Some(carried) = self.attachments.carried.get_mut(&attached.character) {
            carried.retain(|other| *other != mesh);
        }
        self.attachments.written = None;
        Some(attached)
    }

    /// Makes views select a character and its meshes together. Call it after the character, a mesh, a placement or a clip
    /// has changed.
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

    /// An attached mesh's transform to world axes, relative to a cell's corner, in the pose at the scene's time.
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

/// Makes views select a mesh like its character, with the character's placement and sphere. The scale includes the largest
/// enlargement of the mesh by bone and offset; x is negated if they mirror the mesh.
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
