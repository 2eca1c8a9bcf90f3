//! Whether the levels of detail of an object move into each other.

use super::Object;
use crate::lod::transition::Transition;
use crate::scene::drawable::{Drawable, MeshDrawable};

impl Object {
    /// Whether its levels can move into each other.
    pub(in crate::scene) fn can_morph(&self) -> bool {
        let has = |drawable: &Drawable| matches!(drawable, Drawable::Mesh(MeshDrawable { geometry, .. }) if geometry.partners > 0);
        self.errors.len() > 1 && self.drawables().any(has)
    }

    /// Tells what is drawn of the object how its levels change.
    pub(in crate::scene) fn mark_transition(&mut self) {
        let morphs = self.transition == Transition::Geomorph;
        for drawable in self.chunks.iter_mut().flat_map(|chunk| &mut chunk.drawables) {
            if let Drawable::Mesh(mesh) = drawable {
                let own = morphs && mesh.geometry.partners > 0;
                mesh.parts.iter_mut().for_each(|part| part.set_morphed(own));
            }
        }
    }
}
