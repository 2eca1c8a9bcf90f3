//! Meshes that are attached to bones of characters: what the host keeps of them, and their lists on the device.

use std::collections::{BTreeMap, HashMap};

use glam::{DAffine3, Vec3};

use crate::Error;
use crate::InputError;
use crate::animation::local_to_model::reference::affine;
use crate::asset::Transform;
use crate::asset::transform::AFFINE_IDENTITY;
use crate::gpu::{Buffer, Gpu, Staged, Uniform, Upload as _};
use crate::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};
use crate::lod::{INSTANCE_CARRIES, INSTANCE_FOLLOWS, SceneInstance};
use crate::scene::Scene;
use crate::scene::handles::{InstanceId, ObjectId, Slots};
use crate::scene::instances;
use crate::scene::layout::Layout;
use crate::scene::matrices::affine_of;
use crate::scene::object::{Kind, Object};
use crate::scene::placement::Placement;
use crate::skinning::bone_path::BonePath;
use crate::skinning::bounding_sphere::BoundingSphere;

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

/// The meshes of a character on the device.
#[derive(Debug)]
pub(super) struct List {
    pub params: Uniform<AttachParams>,
    pub attachments: Buffer<Attachment>,
    /// Where bones had taken the meshes.
    pub kept: Buffer<KeptBone>,
    /// The keys of the entries that are not free.
    keys: Vec<Option<u32>>,
    /// The value of `params` but for the frame.
    value: AttachParams,
}

impl Scene {
    /// Attaches a mesh to a bone of a character, given by its name or its index: from the next frame on, the mesh follows the
    /// bone as each frame poses it, with `offset` from the mesh's space to the bone's. Nothing of that passes through the host.
    /// A mesh that is attached already changes to the new bone.
    ///
    /// In views, the mesh is selected together with its character, by a sphere that holds both wherever the clip takes the bone,
    /// and takes a level of detail that [`Quality::pixels`](crate::scene::Quality) allows there. The bones of a character
    /// that carries a mesh are sampled in every frame in which it is seen, so that the mesh is at its place but for
    /// rounding. Where no view of a frame sees the character (it is hidden, or masks leave it out), the mesh is not drawn
    /// either. Despawning the character detaches the mesh.
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
        let Kind::Mesh(_) = object.kind else {
            return Err(InputError::new("mesh", "no mesh", "must be an instance of a mesh"));
        };
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
        self.object_of(mesh)?;
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
        self.object_of(mesh)?;
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
        let Kind::Character(animated) = &object.kind else { return Ok(()) };
        let mut around = animated.sphere_of(character.index);
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
        let Kind::Character(animated) = &self.object_of(*character)?.kind else { return Ok(None) };
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

impl Attachments {
    /// The lists of chunks of characters, by slot and generation of the object and number of the chunk.
    pub fn lists(&self) -> impl Iterator<Item = (([u32; 2], usize), &List)> {
        self.lists.iter().map(|(key, list)| (*key, list))
    }

    /// Forgets all lists: their device is lost.
    pub fn forget_device(&mut self) {
        self.lists.clear();
        self.written = None;
        self.version += 1;
    }

    /// Lets nothing count of what was before the next frame.
    pub fn start_afresh(&mut self) {
        self.starts_afresh = true;
    }

    /// Writes the lists anew, if attachments or the layout have changed, and the number of the frame, if the last one is kept.
    pub fn fit(
        &mut self,
        gpu: &Gpu,
        objects: &Slots<Object>,
        layout: &Layout,
        (staged, frame): (&mut Staged, u64),
    ) -> Result<(), Error> {
        let is_written = self.written == Some(layout.version) || self.lists.is_empty() && self.all.is_empty();
        if !is_written {
            self.write_all(gpu, objects, layout, staged)?;
        }
        let starts_afresh = std::mem::take(&mut self.starts_afresh);
        if layout.keeps_last {
            for list in self.lists.values() {
                let last_frame = if starts_afresh { 0 } else { frame as u32 };
                let value = AttachParams { frame: frame as u32 + 1, last_frame, ..list.value };
                staged.uniform(&list.params, &value)?;
            }
        }
        Ok(())
    }

    fn write_all(
        &mut self,
        gpu: &Gpu,
        objects: &Slots<Object>,
        layout: &Layout,
        staged: &mut Staged,
    ) -> Result<(), Error> {
        let mut of_chunk: BTreeMap<([u32; 2], usize), Vec<Attachment>> =
            self.lists.keys().map(|key| (*key, Vec::new())).collect();
        for (mesh, attached) in &self.all {
            if let Some((key, attachment)) = on_device(objects, *mesh, attached) {
                of_chunk.entry(key).or_default().push(attachment);
            }
        }
        let last_rows = if layout.keeps_last { 3 * layout.instances.len() as u32 } else { 0 };
        for (key, mut attachments) in of_chunk {
            let (object, chunk) = key;
            let Some([first, bones]) = first_of(objects, object, chunk) else {
                self.lists.remove(&key);
                self.version += 1;
                continue;
            };
            attachments.sort_by_key(|attachment| attachment.key);
            let value = AttachParams { attached: 0, bones, first, last_rows, frame: 0, last_frame: 0 };
            self.write(gpu, (key, value), &attachments, staged)?;
        }
        self.written = Some(layout.version);
        Ok(())
    }

    fn write(
        &mut self,
        gpu: &Gpu,
        (key, value): (([u32; 2], usize), AttachParams),
        attachments: &[Attachment],
        staged: &mut Staged,
    ) -> Result<(), Error> {
        let room = self.lists.get(&key).map_or(0, |list| list.attachments.len());
        if room < attachments.len() {
            let room = attachments.len().next_power_of_two().max(16);
            let list = List {
                params: Uniform::new(gpu, "attached meshes", &value)?,
                attachments: Buffer::new(gpu, "attached meshes", room)?,
                kept: Buffer::new(gpu, "bones of the last frame", 2 * room)?,
                keys: vec![None; room],
                value,
            };
            self.lists.insert(key, list);
            self.version += 1;
        }
        if let Some(list) = self.lists.get_mut(&key) {
            let entries = list.arranged(attachments);
            list.value = AttachParams { attached: entries.len() as u32, ..value };
            staged.uniform(&list.params, &list.value)?;
            staged.elements(&list.attachments, 0, &entries)?;
        }
        Ok(())
    }
}

impl List {
    /// All entries up to the last one that is not free: attachments stay where they are, so that what is kept of them stays
    /// theirs, and new ones take the first that are free. There is room for all.
    fn arranged(&mut self, attachments: &[Attachment]) -> Vec<Attachment> {
        let known = |key: Option<u32>| {
            let found = attachments.binary_search_by_key(&key?, |attachment| attachment.key).ok()?;
            Some(&attachments[found])
        };
        let mut entries: Vec<Option<&Attachment>> = self.keys.iter().map(|key| known(*key)).collect();
        let is_new = |attachment: &&Attachment| !self.keys.contains(&Some(attachment.key));
        let mut new = attachments.iter().filter(is_new);
        for free in entries.iter_mut().filter(|entry| entry.is_none()) {
            *free = new.next();
        }
        self.keys = entries.iter().map(|entry| entry.map(|attachment| attachment.key)).collect();
        let used = entries.iter().rposition(Option::is_some).map_or(0, |last| last + 1);
        entries[..used].iter().map(|entry| entry.copied().unwrap_or(FREE)).collect()
    }
}

/// An entry that is free.
const FREE: Attachment = Attachment { mesh: NO_MESH, character: 0, bone: 0, key: 0, offset: AFFINE_IDENTITY };

/// An attachment as kernels see it, with the chunk of the character in which it is listed.
fn on_device(
    objects: &Slots<Object>,
    mesh: InstanceId,
    attached: &Attached,
) -> Option<(([u32; 2], usize), Attachment)> {
    let Attached { character, bone, offset, key, .. } = attached;
    let ObjectId { index, generation, .. } = character.object;
    let slot = character.index as usize;
    let chunks = &objects.existing(*character)?.chunks;
    let chunk = chunks.iter().position(|chunk| chunk.slots.contains(&slot))?;
    let attachment = Attachment {
        mesh: objects.existing(mesh)?.place(mesh.index)? as u32,
        character: (slot - chunks[chunk].slots.start) as u32,
        bone: *bone as u32,
        key: *key,
        offset: affine(offset),
    };
    Some((([index, generation], chunk), attachment))
}

/// The index in the scene of the first instance of a character's chunk, and the number of the character's bones.
fn first_of(objects: &Slots<Object>, object: [u32; 2], chunk: usize) -> Option<[u32; 2]> {
    let object = objects.get(object)?;
    let Kind::Character(character) = &object.kind else { return None };
    let bones = character.model().skeleton.len() as u32;
    Some([object.chunks.get(chunk)?.range.first, bones])
}
