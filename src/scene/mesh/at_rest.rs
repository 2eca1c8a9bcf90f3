//! Static meshes as a kind of object.

use glam::Vec3;

use super::drawn;
use crate::InputError;
use crate::scene::chunk::Chunk;
use crate::scene::material::Looks;
use crate::scene::object_kind::{MakeOn, Making, ObjectKind, OnDevice};
use crate::scene::ray::Surface;
use crate::skinning::merged::Merged;

/// The merged meshes of a model in the rest pose, without images.
#[derive(Debug)]
pub(in crate::scene) struct MeshAtRest(pub Merged);

impl ObjectKind for MeshAtRest {
    fn name(&self) -> &'static str {
        "a mesh"
    }

    fn model_box(&self) -> Option<[Vec3; 2]> {
        let positions = self.0.model.meshes.iter().flat_map(|mesh| &mesh.positions).map(|at| Vec3::from(*at));
        positions.map(|at| [at; 2]).reduce(|[low, high], [at, _]| [low.min(at), high.max(at)])
    }

    fn is_attachable(&self) -> bool {
        true
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, looks, capacity } = target;
        Box::pin(async move {
            let (drawables, _) = drawn(gpu, layouts, &self.0, looks.unwrap_or(&Looks::NONE))?;
            Ok(OnDevice::chunks(vec![Chunk::new(0..capacity, drawables)]))
        })
    }

    fn surfaces(&self, _: u32, _: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let meshes = &self.0.model.meshes;
        let surface = |at: usize| Surface::of_merged(&self.0, at, &meshes[at].positions[..]);
        Ok((0..meshes.len()).map(surface).collect())
    }
}
