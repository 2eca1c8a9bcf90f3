//! Uploads of added objects, spread over frames.

use crate::gpu::{Gpu, PendingUploads};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::object::Object;
use crate::{Error, InputError};

impl Scene {
    /// Sets the largest number of bytes of added data that each frame uploads. With `None`, the default, everything is
    /// uploaded with the next frame. The setting applies to objects added from now on.
    ///
    /// Use it if objects are added while the program runs, where one long frame would be visible. Meshes, clips and
    /// textures then wait on the host, object by object. Until all of an object has arrived, it is neither drawn nor hit by
    /// rays ([`Scene::pick`]), but it can be changed and spawned.
    ///
    /// A frame uploads whole rows of textures, so it may exceed the budget by up to a row. Some costs stay in the call that
    /// adds an object: host work (mip levels, bounds of motion) and device work (heights of terrain, maps of reliefs).
    /// `Scene::rebuild` also uploads everything at once. Render bundles must be made anew when an object appears.
    ///
    /// # Errors
    /// [`InputError`] for 0 bytes.
    ///
    /// # Examples
    ///
    /// A level that is loaded while the program draws, 2 MiB a frame.
    ///
    /// ```no_run
    /// # use relievo::asset::Model;
    /// # use relievo::scene::Scene;
    /// # fn example(scene: &mut Scene, models: &[Model]) -> Result<(), relievo::Error> {
    /// scene.set_upload_budget(Some(2 << 20))?;
    /// for model in models {
    ///     scene.add_mesh(model, 10)?;
    /// }
    /// // In each frame, after Scene::record:
    /// let is_loaded = scene.waiting() == 0;
    /// # Ok(())
    /// # }
    /// ```
    pub fn set_upload_budget(&mut self, bytes: Option<usize>) -> Result<(), InputError> {
        if bytes == Some(0) {
            return Err(InputError::new("bytes", 0, "must be at least 1"));
        }
        self.upload_budget = bytes;
        Ok(())
    }

    /// The number of bytes that wait on the host; see [`Scene::set_upload_budget`].
    pub fn waiting(&self) -> usize {
        self.objects.iter().filter_map(|object| object.pending.as_ref()).map(PendingUploads::len).sum()
    }

    /// Whether a part of an object waits on the host, so that the object is not drawn; see [`Scene::set_upload_budget`].
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn is_waiting(&self, object: ObjectId) -> Result<bool, InputError> {
        Ok(self.object_at(object)?.pending.is_some())
    }

    /// The device to create an object on, and the queue of its uploads if they are spread.
    pub(super) fn uploader(&self) -> (Gpu, Option<PendingUploads>) {
        if self.upload_budget.is_none() {
            return (self.gpu.clone(), None);
        }
        let (gpu, pending) = self.gpu.deferring();
        (gpu, Some(pending))
    }

    /// Uploads waiting data, up to the budget of a frame. Returns the number of bytes.
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
    /// Whether it is visible and has arrived on the device completely.
    pub(super) fn is_drawn(&self) -> bool {
        self.is_shown && self.pending.is_none()
    }

    /// Uploads about `most` bytes of waiting data.
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
