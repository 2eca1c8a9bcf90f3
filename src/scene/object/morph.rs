//! Whether the levels of detail of an object move into each other.

use super::Object;
use crate::lod::transition::Transition;

impl Object {
    /// Whether its levels can move into each other.
    pub(in crate::scene) fn can_morph(&self) -> bool {
        self.errors.len() > 1 && self.drawables().any(|drawable| drawable.can_morph())
    }

    /// Tells what is drawn of the object how its levels change.
    pub(in crate::scene) fn mark_transition(&mut self) {
        let morphed = self.transition == Transition::Geomorph;
        let drawables = self.chunks.iter_mut().flat_map(|chunk| &mut chunk.drawables);
        drawables.for_each(|drawable| drawable.set_morphed(morphed));
    }
}
