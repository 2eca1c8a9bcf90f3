//! Geomorphs of an object's levels of detail.

use super::Object;
use crate::lod::transition::Transition;

impl Object {
    /// Whether the object's levels of detail can geomorph.
    pub(in crate::scene) fn can_morph(&self) -> bool {
        self.errors.len() > 1 && self.drawables().any(|drawable| drawable.can_morph())
    }

    /// Tells all drawables whether the object's levels geomorph, which decides their pipelines.
    pub(in crate::scene) fn mark_transition(&mut self) {
        let morphed = self.level_of_detail.transition == Transition::Geomorph;
        let next = self.successor.iter_mut().flat_map(|next| &mut next.chunks);
        let drawables = self.chunks.iter_mut().chain(next).flat_map(|chunk| &mut chunk.drawables);
        drawables.for_each(|drawable| drawable.set_morphed(morphed));
    }
}
