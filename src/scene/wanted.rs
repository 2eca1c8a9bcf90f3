//! What views need of an object, for programs that load detail while they run.

use crate::InputError;
use crate::lod::select::reference::select;
use crate::scene::Scene;
use crate::scene::chunk::Chunk;
use crate::scene::handles::ObjectId;
use crate::scene::view::View;

/// What views need of an object ([`Scene::wanted`]).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The largest error of a level, in model units, that keeps the error of all visible instances within
    /// [`Quality::pixels`](crate::scene::Quality). Bones and influences of characters have their parts of it
    /// ([`ErrorBudget`](crate::scene::ErrorBudget)).
    pub error: f32,
    /// The area that the bounding spheres of the visible instances cover, in squares with sides of `Quality::pixels`.
    /// What is hidden counts too.
    pub area: f32,
}

impl Scene {
    /// What views with cameras need of an object; `None` if they see no instance. Loaders use it to decide which levels of
    /// detail to load, and in which order. The scene itself chooses levels on the device.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene, and for a view without a camera.
    ///
    /// # Examples
    ///
    /// ```no_run
    /// # use relievo::scene::{ObjectId, Scene, View};
    /// # fn example(scene: &Scene, eye: &View, stone: ObjectId, load: impl Fn(f32)) -> Result<(), relievo::Error> {
    /// if let Some(wanted) = scene.wanted(stone, &[eye])? {
    ///     load(wanted.error); // the coarsest level with at most this error
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn wanted(&self, object: ObjectId, views: &[&View]) -> Result<Option<Wanted>, InputError> {
        let object = self.object_at(object)?;
        let all = Chunk::new(0..object.capacity(), Vec::new());
        let lod = object.lod_object(&all);
        let (mut error, mut area) = (f32::INFINITY, 0.0);
        for view in views {
            let (_, view) = view.select_view(0, true)?;
            for instance in object.instances.all() {
                let Some(selected) = select(&view, &lod, instance, None) else { continue };
                error = error.min(object.mesh_fraction * selected.allowed);
                let radius = instance.bounding_sphere[3] / selected.allowed.max(f32::MIN_POSITIVE);
                area += std::f32::consts::PI * radius * radius;
            }
        }
        Ok((area > 0.0).then_some(Wanted { error, area }))
    }
}
