//! The drawing order of transparent surfaces: instance by instance, from back to front.

use crate::lod::select::reference::{is_shown, nearly_seen, placed_sphere};
use crate::lod::sorted::SortedDraw;
use crate::lod::{OBJECT_LISTS, SelectView};
use crate::scene::camera::Camera;
use crate::scene::chunk::{Chunk, SortedParts};
use crate::scene::object::Object;

impl Chunk {
    /// Appends a draw for each instance of each blended part to `all`, and notes where each part's draws begin.
    pub(super) fn lay_out_sorted(&mut self, all: &mut Vec<SortedDraw>) {
        self.sorted.clear();
        let (instances, mut first_draw) = (self.slots.len() as u32, self.range.first_draw);
        for (drawable, of) in self.drawables.iter().enumerate() {
            let blended = of.parts().enumerate().filter(|(_, part)| part.specialization.state().blended);
            for (part, _) in blended {
                self.sorted.push(SortedParts { drawable, part, first: all.len() as u32 });
                let first_draw = first_draw + OBJECT_LISTS * part as u32;
                let object = self.number as u32;
                let single =
                    |slot| SortedDraw { instance: self.range.first + slot, first_draw, slot, object };
                all.extend((0..instances).map(single));
            }
            first_draw += OBJECT_LISTS * of.part_count() as u32;
        }
    }
}

/// An instance with the key that it is sorted by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Ordered {
    /// In a perspective view: distance from the eye to the middle of the bounding sphere. In a parallel view: distance
    /// along the viewing direction.
    pub distance: f64,
    /// Index of the object in the layout (`object`), and index of the instance in the object (`instance`).
    pub object: usize,
    pub instance: u32,
}

/// Sorts the instances with transparent parts that a view may see, from back to front. Instances at equal distances
/// keep the order of objects and instances. The device then decides which of them are visible.
pub(super) fn back_to_front<'a>(
    order: &mut Vec<Ordered>,
    objects: impl Iterator<Item = &'a Object>,
    view: &SelectView,
    camera: &Camera,
) {
    order.clear();
    let (eye, ahead) = (camera.eye_offset().as_dvec3(), camera.ahead().as_dvec3());
    let is_parallel = camera.clip_from_view.row(3).truncate() == glam::Vec3::ZERO;
    for (object, of) in objects.enumerate() {
        let Some(chunk) = of.chunks.first().filter(|chunk| !chunk.sorted.is_empty()) else { continue };
        let lod = of.lod_object(chunk);
        for (instance, placed) in (0..).zip(of.instances.all()) {
            let (center, radius) = placed_sphere(placed, view.cell);
            if !is_shown(view, &lod, placed) || !nearly_seen(view, center, radius) {
                continue;
            }
            let towards = center.as_dvec3() - eye;
            let distance = if is_parallel { towards.dot(ahead) } else { towards.length() };
            order.push(Ordered { distance, object, instance });
        }
    }
    order.sort_by(|a, b| b.distance.total_cmp(&a.distance));
}
