//! Device lists of attached meshes: one per chunk (group of instances) of a character that carries meshes.

use std::collections::BTreeMap;

use super::{Attached, Attachments, ListKey};
use crate::Error;
use crate::animation::local_to_model::reference::affine;
use crate::asset::transform::AFFINE_IDENTITY;
use crate::gpu::{Buffer, Gpu, Staged, Uniform, Upload as _};
use crate::lod::attach::{AttachParams, Attachment, KeptBone, NO_MESH};
use crate::scene::handles::{InstanceId, ObjectId, Slots};
use crate::scene::layout::Layout;
use crate::scene::object::Object;

/// The meshes attached to the instances of one chunk of a character, on the device.
#[derive(Debug)]
pub(in crate::scene) struct List {
    pub params: Uniform<AttachParams>,
    pub attachments: Buffer<Attachment>,
    /// Products of bone matrix and mesh offset in the last two frames, for velocities. Two elements per entry of
    /// `attachments`.
    pub kept: Buffer<KeptBone>,
    /// Key of the attachment in each entry of `attachments`; `None` for a free entry.
    keys: Vec<Option<u32>>,
    /// The value last written to `params`, but with both frame numbers 0.
    value: AttachParams,
}

impl Attachments {
    /// All lists.
    pub fn lists(&self) -> impl Iterator<Item = (ListKey, &List)> {
        self.lists.iter().map(|(key, list)| (*key, list))
    }

    /// Drops all lists after their device was lost.
    pub fn forget_device(&mut self) {
        self.lists.clear();
        self.written = None;
        self.version += 1;
    }

    /// Makes the next frame ignore the motion history.
    pub fn start_afresh(&mut self) {
        self.starts_afresh = true;
    }

    /// Rewrites the device lists if attachments or the scene's layout changed. With motion history, also writes the frame
    /// numbers.
    pub fn fit(
        &mut self,
        gpu: &Gpu,
        objects: &Slots<Object>,
        layout: &Layout,
        staged: &mut Staged,
        frame: u64,
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
        let mut of_chunk: BTreeMap<ListKey, Vec<Attachment>> =
            self.lists.keys().map(|key| (*key, Vec::new())).collect();
        for (mesh, attached) in &self.all {
            if let Some((key, attachment)) = on_device(objects, *mesh, attached) {
                of_chunk.entry(key).or_default().push(attachment);
            }
        }
        let first_last = if layout.keeps_last { layout.instances.len() as u32 } else { 0 };
        for (key, mut attachments) in of_chunk {
            let (object, chunk) = key;
            let Some([first, bones]) = first_of(objects, object, chunk) else {
                self.lists.remove(&key);
                self.version += 1;
                continue;
            };
            attachments.sort_by_key(|attachment| attachment.key);
            let value = AttachParams { attached: 0, bones, first, first_last, frame: 0, last_frame: 0 };
            self.write(gpu, key, value, &attachments, staged)?;
        }
        self.written = Some(layout.version);
        Ok(())
    }

    fn write(
        &mut self,
        gpu: &Gpu,
        key: ListKey,
        value: AttachParams,
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
    /// Assigns list entries to `attachments`. Returns all entries up to the last used one. A known attachment keeps its
    /// entry, so that its motion history stays valid. A new attachment takes the first free entry. The list must have enough
    /// entries.
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

/// The content of a free list entry.
const FREE: Attachment = Attachment { mesh: NO_MESH, character: 0, bone: 0, key: 0, offset: AFFINE_IDENTITY };

/// An attachment in device format, and the key of the list that holds it: the character's object and chunk. `None` if the
/// mesh or the character no longer exists.
fn on_device(
    objects: &Slots<Object>,
    mesh: InstanceId,
    attached: &Attached,
) -> Option<(ListKey, Attachment)> {
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

/// Two numbers: the index of a chunk's first instance in the scene's instance buffers, and the character's number of bones.
fn first_of(objects: &Slots<Object>, object: [u32; 2], chunk: usize) -> Option<[u32; 2]> {
    let object = objects.get(object)?;
    let bones = object.character()?.model().skeleton.len() as u32;
    Some([object.chunks.get(chunk)?.range.first, bones])
}
