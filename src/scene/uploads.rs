//! Uploads of what was added, spread over frames.

use crate::gpu::{Gpu, PendingUploads};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::object::Object;
use crate::{Error, InputError};

impl Scene {
    /// Sets how many bytes of what is added each frame uploads; `None`, as at first, is everything with the next frame. It
    /// holds for what is added from now on.
    ///
    /// It is for programs that add objects while they run, where one long frame would be seen. Meshes, clips and textures
    /// then wait on the host, object by object, and an object is neither drawn nor found by rays ([`Scene::pick`]) until all
    /// of it has arrived; it can be changed and spawned meanwhile. A frame uploads whole rows of textures, hence up to a row
    /// more than the budget. What adding an object costs the host (mip levels, bounds of motion), and what the device
    /// computes for it (heights of terrain, maps of reliefs), stays in the call that adds it, and so does all uploading in
    /// `Scene::rebuild`. Render bundles must be made anew when an object appears.
    ///
    /// # Errors
    /// [`InputError`] for 0 bytes.
    pub fn set_upload_budget(&mut self, bytes: Option<usize>) -> Result<(), InputError> {
        if bytes == Some(0) {
            return Err(InputError::new("bytes", 0, "must be at least 1"));
        }
        self.upload_budget = bytes;
        Ok(())
    }

    /// The number of bytes that still wait on the host; see [`Scene::set_upload_budget`].
    pub fn waiting(&self) -> usize {
        self.objects.iter().filter_map(|object| object.pending.as_ref()).map(PendingUploads::len).sum()
    }

    /// Whether a part of an object still waits on the host, so that it is not drawn; see [`Scene::set_upload_budget`].
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn is_waiting(&self, object: ObjectId) -> Result<bool, InputError> {
        Ok(self.object_at(object)?.pending.is_some())
    }

    /// The device on which an object is made, and where its uploads wait, if they do.
    pub(super) fn uploader(&self) -> (Gpu, Option<PendingUploads>) {
        if self.upload_budget.is_none() {
            return (self.gpu.clone(), None);
        }
        let (gpu, pending) = self.gpu.deferring();
        (gpu, Some(pending))
    }

    /// Uploads as much of what waits as a frame may. Returns how many bytes that is.
    pub(super) fn upload(&mut self) -> Result<usize, Error> {
        let most = self.upload_budget.unwrap_or(usize::MAX);
        let mut sent = 0;
        for object in self.objects.iter_mut() {
            if sent >= most {
                break;
            }
            sent += object.upload(&self.gpu, most - sent)?;
        }
        Ok(sent)
    }
}

impl Object {
    /// Whether it is shown, and all of it has arrived on the device.
    pub(super) fn is_drawn(&self) -> bool {
        self.is_shown && self.pending.is_none()
    }

    /// Uploads about so many bytes of what waits.
    fn upload(&mut self, gpu: &Gpu, most: usize) -> Result<usize, Error> {
        let Some(pending) = &self.pending else { return Ok(0) };
        let sent = pending.send(gpu, most)?;
        if pending.len() == 0 {
            self.pending = None;
            self.is_retuned = true;
        }
        Ok(sent)
    }
}
