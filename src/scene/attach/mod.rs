//! Meshes that are attached to bones of characters.

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

/// A character, its clip, whether layers are above it, a bone, and the bits of the sphere that the bone carries.
type PathKey = (ObjectId, (u32, bool), usize, [u32; 4]);

/// The meshes that are attached.
#[derive(Debug, Default)]
pub(super) struct Attachments {
    all: HashMap<InstanceId, Attached>,
    /// The meshes that each character carries.
    carried: HashMap<InstanceId, Vec<InstanceId>>,
    /// Where bones go.
    paths: HashMap<PathKey, BonePath>,
    /// The list of each chunk of a character that carries a mesh, or has carried one, by slot and generation of the object.
    lists: BTreeMap<([u32; 2], usize), List>,
    /// Counts the times at which a list was allocated: jobs that were prepared for another number are out of date.
    pub version: u64,
    /// The layout for which the lists were written; `None` if attachments have changed since.
    written: Option<u64>,
    /// Number of attachments ever made.
    made: u32,
    /// Whether nothing counts of what was before the next frame.
    starts_afresh: bool,
}

/// A mesh that is attached.
#[derive(Debug, Clone, Copy)]
struct Attached {
    character: InstanceId,
    bone: usize,
    /// From the mesh's space to the bone's.
    offset: Transform,
    /// A sphere around the mesh in the bone's space.
    sphere: BoundingSphere,
    /// Where the mesh stands when it is detached.
    own: Placement,
    /// Its number among all attachments ever made.
    key: u32,
}

impl Scene {
    /// Attaches a mesh to a bone of a character, given by its name or its index in digits: from the next frame on, the mesh follows the
    /// bone as each frame poses it, with `offset` from the mesh's space to the bone's. Nothing of that passes through the host.
    /// A mesh that is attached already changes to the new bone.
    ///
    /// The offset is in the bone's space, so the scales of the character and of its bones act on it: on a character in
    /// centimetres that is placed with a scale of 0.01, a translation of 1 is a centimetre, and a mesh in metres is a hundredth
    /// as large. [`InstancePose::offset_of_world_units`](crate::scene::InstancePose::offset_of_world_units) turns an offset in
    /// world units into one of the bone's space: `scene.pose(character)?.offset_of_world_units(bone, offset)?`.
    ///
    /// In views, the mesh is selected together with its character, by a sphere that holds both wherever the clip takes the bone,
    /// and takes a level of detail that [`Quality::pixels`](crate::scene::Quality) allows there. The bones of a character
    /// that carries a mesh are sampled in every frame in which it is seen, so that the mesh is at its place but for
    /// rounding. [`Scene::world_from_model`] tells where it stands. Where no view of a frame sees the character (it is hidden, or
    /// masks leave it out), the mesh is not drawn either. Despawning the character detaches the mesh.
    ///
    /// [`Layer::Velocity`](crate::render::Layer::Velocity) shows it moving with its bone, and in the frame in which it is
    /// attached from where it stood. When it changes to another bone, when its character was not seen in the last frame, or
    /// when more meshes are attached to characters of the object than ever before, it moves for one frame with its character
    /// alone; when it is detached, it does not move.
    ///
    /// It takes sampling each clip that the character plays, once for each bone.
    ///
    /// # Errors
    /// [`InputError`] for instances that do not exist any more, for a mesh or a character that is none, for a bone that the
    /// model does not have, and for an offset that is not finite, has no rotation, or scales by 0.
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

    /// Detaches a mesh: it stands where its placement says ([`Scene::placement`]), which is where it stood before it was
    /// attached, or where [`Scene::move_to`] has moved it since.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more, or that is not attached.
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

    /// The character and the bone to which a mesh is attached, if it is.
    ///
    /// # Errors
    /// [`InputError`] for an instance that does not exist any more.
    pub fn attached_to(&self, mesh: InstanceId) -> Result<Option<(InstanceId, usize)>, InputError> {
        self.object_of(mesh).map_err(|error| renamed(error, "mesh"))?;
        Ok(self.attachments.all.get(&mesh).map(|attached| (attached.character, attached.bone)))
    }

    /// Where an attached mesh stands when it is detached.
    pub(super) fn detached_placement(&self, mesh: InstanceId) -> Option<Placement> {
        self.attachments.all.get(&mesh).map(|attached| attached.own)
    }

    /// Sets where a mesh stands when it is detached. Returns whether it is attached.
    pub(super) fn move_detached(&mut self, mesh: InstanceId, placement: Placement) -> bool {
        let attached = self.attachments.all.get_mut(&mesh);
        attached.map(|attached| attached.own = placement).is_some()
    }

    /// Takes leave of an instance that goes: what it carries is detached, and it is carried no longer.
    pub(super) fn let_go(&mut self, instance: InstanceId) -> Result<(), InputError> {
        for mesh in self.attachments.carried.get(&instance).cloned().unwrap_or_default() {
            self.detach(mesh)?;
        }
        match self.release(instance) {
            Some(Attached { character, .. }) => self.carry(character),
            None => Ok(()),
        }
    }

    /// Forgets an attachment, if there is one.
    fn release(&mut self, mesh: InstanceId) -> Option<Attached> {
        let attached = self.attachments.all.remove(&mesh)?;
        if let Some(carried) = self.attachments.carried.get_mut(&attached.character) {
            carried.retain(|other| *other != mesh);
        }
        self.attachments.written = None;
        Some(attached)
    }

    /// Lets a character and what it carries be selected together, after either of them, its placement or its clip has changed.
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

    /// The transform of an attached mesh to the world, relative to the corner of a cell, in the pose of the time of the scene.
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

/// Lets a mesh be selected as its character is: with its placement and its sphere, and a scale that says by how much bone and
/// offset enlarge the mesh at most, and whether they mirror it.
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
