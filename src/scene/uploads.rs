//! Uploads the data of added objects, spread over several frames.

use crate::gpu::{Gpu, PendingUploads};
use crate::scene::Scene;
use crate::scene::handles::ObjectId;
use crate::scene::object::Object;
use crate::{Error, InputError};

impl Scene {
    /// Sets the largest number of bytes of newly added objects that each frame uploads. `None`, the default, uploads
    /// everything with the next frame. The setting applies to objects that are added after this call.
    ///
    /// Use a budget if the program adds objects while it runs, so that no single frame becomes visibly long. Meshes,
    /// clips and textures then wait on the host, object by object. An object is drawn, and hit by rays
    /// ([`Scene::pick`]), once all of its data has arrived. Before that, the object can already be changed, and its
    /// instances can be spawned.
    ///
    /// A frame uploads whole rows of textures, so it may exceed the budget by up to one row. The call that adds an
    /// object still does some work at once: on the host (mip levels, bounds of motion) and on the device (heights of
    /// terrain, maps of reliefs). `Scene::rebuild` also uploads everything at once. When an object appears, render
    /// bundles must be recorded again.
    ///
    /// # Errors
    /// [`InputError`] for 0 bytes.
    ///
    /// # Examples
    ///
    /// Loads a level while the program draws, 2 MiB per frame.
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
        InputError::check(bytes != Some(0), "bytes", 0, || "must be at least 1")?;
        self.upload_budget = bytes;
        Ok(())
    }

    /// The number of bytes of added objects that still wait on the host; see [`Scene::set_upload_budget`].
    pub fn waiting(&self) -> usize {
        let all = self.objects.iter().flat_map(|object| object.uploads());
        all.map(PendingUploads::len).sum()
    }

    /// Whether data of an object still waits on the host. Such an object is not drawn; see
    /// [`Scene::set_upload_budget`].
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn is_waiting(&self, object: ObjectId) -> Result<bool, InputError> {
        Ok(self.object_at(object)?.pending.is_some())
    }

    /// The device on which to create an object. With an upload budget, also the queue of the object's uploads.
    pub(super) fn uploader(&self) -> (Gpu, Option<PendingUploads>) {
        if self.upload_budget.is_none() {
            return (self.gpu.clone(), None);
        }
        let (gpu, pending) = self.gpu.deferring();
        (gpu, Some(pending))
    }

    /// Uploads waiting data of all objects, up to the budget of a frame, and shows the models that are complete. Returns the
    /// number of uploaded bytes.
    pub(super) fn upload(&mut self) -> Result<usize, Error> {
        let most = self.upload_budget.unwrap_or(usize::MAX);
        let mut sent = 0;
        for object in self.objects.iter_mut() {
            if sent >= most {
                break;
            }
            sent += object.upload(&self.gpu, most - sent)?;
            if let Some(next) = object.successor.as_mut().filter(|_| sent < most) {
                sent += next.upload(&self.gpu, most - sent)?;
            }
        }
        self.succeed()?;
        Ok(sent)
    }
}

impl Object {
    /// Whether the object is shown, and all of its data has arrived on the device.
    pub(super) fn is_drawn(&self) -> bool {
        self.is_visible && self.pending.is_none()
    }

    /// The waiting data of the object, and of its successor.
    fn uploads(&self) -> impl Iterator<Item = &PendingUploads> {
        let next = self.successor.as_ref().and_then(|next| next.pending.as_ref());
        self.pending.iter().chain(next)
    }

    /// Uploads about `most` bytes of the object's waiting data. Returns the number of uploaded bytes.
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
