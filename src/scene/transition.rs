//! How levels of detail change.

use super::drawable::{Drawable, MeshDrawable};
use super::object::Object;
use super::{ObjectId, Scene};
use crate::shared::lod::object::OBJECT_MORPHS;
use crate::{Error, InputError};

/// How the levels of detail of an object's instances change.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Transition {
    /// At once, as soon as a coarser level's error is allowed.
    #[default]
    Hard,
    /// By a geomorph: the vertices of a level move to their partners in the next coarser one
    /// ([`Mesh::partners`](crate::asset::Mesh::partners)), the further the more is allowed, in each view by itself. Once they
    /// are there, the picture is the coarser level's, and stays so where levels change.
    ///
    /// A level begins to move once the error of the coarser one is allowed, and has arrived when that of the one after it
    /// is. So the level that is drawn is finer by one than with [`Transition::Hard`]: it costs about 1.4 times the triangles,
    /// and of each vertex two are loaded. Instances that are drawn one by one ([`Layer::Transparent`](crate::render::Layer::Transparent))
    /// do not move. Velocities count levels as if they had been in the last frame what they are.
    Geomorph,
}

impl Transition {
    /// The bit in what kernels know of an object.
    pub(super) fn flag(self) -> u32 {
        if self == Self::Geomorph { OBJECT_MORPHS } else { 0 }
    }

    /// From the errors of an object's levels, ascending from 0: the displacement from which on each level is drawn. With a
    /// geomorph it begins to move there, and level 0, which is drawn before, too. The last level then begins at twice its
    /// error.
    pub(super) fn begins(self, errors: &[f32]) -> Vec<f32> {
        match (self, errors.last()) {
            (Self::Geomorph, Some(last)) => errors.iter().skip(1).copied().chain([2.0 * last]).collect(),
            _ => errors.to_vec(),
        }
    }
}

impl Scene {
    /// Sets how the levels of detail of an object change, from the next recording on. Compile renderers for it
    /// ([`Renderer::prepare`](crate::render::Renderer::prepare)). Objects change levels at once unless this is called.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene and, with [`Transition::Geomorph`], for one without levels of
    /// detail or whose meshes have no partners ([`add_levels`](crate::skinning::add_levels) finds them): terrain, reliefs, and
    /// meshes beyond a binding of the device.
    pub fn set_transition(&mut self, object: ObjectId, transition: Transition) -> Result<(), Error> {
        let entry = self.object_mut(object)?;
        if transition == Transition::Geomorph && !entry.can_morph() {
            let bound = "must have levels of detail with partners";
            return Err(InputError::new("object.levels", entry.errors.len(), bound).into());
        }
        if std::mem::replace(&mut entry.transition, transition) != transition {
            entry.mark_transition();
            self.layout = None;
        }
        Ok(())
    }

    /// How the levels of detail of an object change.
    ///
    /// # Errors
    /// [`InputError`] for an object that is not of this scene.
    pub fn transition(&self, object: ObjectId) -> Result<Transition, InputError> {
        Ok(self.object_at(object)?.transition)
    }
}

impl Object {
    fn can_morph(&self) -> bool {
        let has = |drawable: &Drawable| matches!(drawable, Drawable::Mesh(MeshDrawable { geometry, .. }) if geometry.partners > 0);
        self.errors.len() > 1 && self.drawables().any(has)
    }

    /// Tells what is drawn of the object how its levels change.
    pub(super) fn mark_transition(&mut self) {
        let morphs = self.transition == Transition::Geomorph;
        for drawable in self.chunks.iter_mut().flat_map(|chunk| &mut chunk.drawables) {
            if let Drawable::Mesh(mesh) = drawable {
                let own = morphs && mesh.geometry.partners > 0;
                mesh.parts.iter_mut().for_each(|part| part.surface.morphed = own);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_moves_once_the_next_one_is_allowed() {
        let errors = [0.0, 0.1, 0.2, 0.4];
        assert_eq!(Transition::Hard.begins(&errors), errors);
        assert_eq!(Transition::Geomorph.begins(&errors), [0.1, 0.2, 0.4, 0.8]);
        assert_eq!([Transition::Hard, Transition::Geomorph].map(Transition::flag), [0, 2]);
    }
}
