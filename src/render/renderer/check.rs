//! Checks before drawing.

use super::Renderer;
use crate::InputError;
use crate::render::layer::Layer;
use crate::render::output::OutputProgram;
use crate::scene::Scene;
use crate::scene::drawable::{DrawnObject, DrawnView};
use crate::scene::specialization::Specialization;

/// Text of the error for missing pipelines ([`InputError::bound`]). It names the remedy.
const PREPARE: &str = "must be compiled for this renderer: call Renderer::prepare after an object or a SunShadow was added, and \
                       after Scene::set_material or Scene::set_level_of_detail changed the object";

impl Renderer {
    /// Refuses a scene on another device than the renderer's.
    pub(super) fn check_device(&self, scene: &Scene) -> Result<(), InputError> {
        let bound = "must be of the renderer's device: Renderer::rebuild, if the scene was rebuilt";
        match scene.gpu().is_same_device(&self.gpu) {
            true => Ok(()),
            false => Err(InputError::new("scene", "of another device", bound)),
        }
    }

    /// Checks that the caller's texts declare distinct names, because one shader contains all of them.
    pub(super) fn check_names(&self, part: &Specialization) -> Result<(), InputError> {
        let kind = ("the kind", part.program().declared());
        let output = self.format.output().map(|output| ("the output", output.declared()));
        let shading = self.shading.as_ref().map(|shading| ("the shading", shading.declared()));
        let all: Vec<_> = [Some(kind), output, shading].into_iter().flatten().collect();
        for (at, (one, names)) in all.iter().enumerate() {
            for (other, others) in &all[at + 1..] {
                if let Some(name) = names.iter().find(|name| others.contains(name)) {
                    let bound = format!("must be declared by {one} or by {other}, and not by both");
                    let path = format!("{}.name", part.program().name());
                    return Err(InputError::new(path, format!("`{name}`"), bound));
                }
            }
        }
        Ok(())
    }

    /// Checks that a layer of these objects can be drawn in a view.
    pub(super) fn check<'a>(
        &self,
        view: &DrawnView<'_>,
        objects: impl Iterator<Item = DrawnObject<'a>>,
        layer: Layer,
    ) -> Result<(), InputError> {
        if !self.format.layers().any(|known| known == layer) {
            let bound = "must be a layer for which the renderer's format has an attachment";
            return Err(InputError::new("layer", format!("{layer:?}"), bound));
        }
        if self.format.depth.is_some() && view.reversed != self.format.is_reversed() {
            let direction = |reversed| if reversed { "reversed" } else { "forward" };
            let bound =
                format!("must be {}, as the renderer's format says", direction(self.format.is_reversed()));
            return Err(InputError::new("view.camera.depth", direction(view.reversed), bound));
        }
        let own = self.format.output().filter(|_| layer == Layer::Own);
        let moves = own.map_or(layer == Layer::Velocity, OutputProgram::moves);
        if moves && !view.keeps_last {
            let bound = "must keep the last frame: Scene::keep_motion_history";
            return Err(InputError::new("scene", "does not keep the last frame", bound));
        }
        for object in objects {
            let mut parts = object.drawable.parts().map(|part| part.specialization);
            let is_compiled = |part, fade| self.pipeline(layer, part, false, fade, view).is_some();
            let is_ready = |part| {
                self.fades_of(part, object.transition, layer).into_iter().all(|fade| is_compiled(part, fade))
            };
            if !parts.all(is_ready) {
                let value = format!("object {} (ObjectId::number), not compiled", object.number);
                return Err(InputError::new("scene", value, PREPARE));
            }
        }
        Ok(())
    }
}
