//! Selection of instances: the CPU reference of `kernels/lod/select.wgsl`.

use glam::{IVec3, Vec3};

use crate::asset::Affine;
use crate::lod::allowed::allowed_by;
use crate::lod::criterion::metric;
use crate::lod::transition::decision;
use crate::lod::{
    BLOCK, INSTANCE_ALIVE, INSTANCE_CASTS, LodCamera, LodObject, SceneInstance, SelectView,
    instance_flags_mask,
};
use crate::shared::lod::allowed::MAX_ALLOWED;
use crate::shared::lod::object::{decision_list, object_flags_shown};
use crate::shared::lod::select::{MAX_METRIC, UNSEEN_ALLOWED};
use crate::shared::lod::view::POSITION_SLACK;

/// A view's decision for one visible instance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selected {
    /// The decision word ([`decision`]).
    pub decision: u32,
    /// The displacement that the view allows, in the model's units.
    pub allowed: f32,
    /// The transform from the model's space to the corner of the view's cell.
    pub placement: Affine,
}

/// The bounding sphere of an instance, relative to the corner of a cell: center and radius. The radius includes the
/// center's rounding error.
pub fn placed_sphere(instance: &SceneInstance, cell: IVec3) -> (Vec3, f32) {
    let ([x, y, z], at, scale) = (instance.axes(), instance.position(cell), instance.largest_scale());
    let [cx, cy, cz, radius] = instance.bounding_sphere;
    let rounding = POSITION_SLACK * (at.length() + scale * Vec3::new(cx, cy, cz).length());
    (x * cx + y * cy + z * cz + at, radius * scale + rounding)
}

/// Whether flags and masks let a view see an instance, regardless of its position.
pub fn is_shown(view: &SelectView, object: &LodObject, instance: &SceneInstance) -> bool {
    let is_alive = object_flags_shown(object.flags) != 0 && instance.flags & INSTANCE_ALIVE != 0;
    let casts = view.casters == 0 || instance.flags & INSTANCE_CASTS != 0;
    is_alive && casts && instance_flags_mask(instance.flags) & view.mask != 0
}

/// How far a sphere reaches into the view volume; negative if it is outside.
pub fn depth_inside(view: &SelectView, center: Vec3, radius: f32) -> f32 {
    let lengths = center.length() + radius;
    let depth = |side: &glam::Vec4| {
        side.truncate().dot(center) + side.w + radius + POSITION_SLACK * (lengths + side.w.abs())
    };
    view.planes.iter().map(depth).fold(MAX_ALLOWED, f32::min)
}

/// Whether a view may see a sphere, with a margin of a thousandth of its radius. A device that rounds differently then
/// shows no instance that the host did not expect.
#[cfg(feature = "gpu")]
pub(crate) fn nearly_seen(view: &SelectView, center: Vec3, radius: f32) -> bool {
    depth_inside(view, center, 1.001 * radius) >= -1e-3 * radius
}

/// A view's decision for an instance; `None` if the view does not see it.
pub fn select(view: &SelectView, object: &LodObject, instance: &SceneInstance) -> Option<Selected> {
    let (center, radius) = placed_sphere(instance, view.cell);
    if !is_shown(view, object, instance) || depth_inside(view, center, radius) < 0.0 {
        return None;
    }
    let scale = instance.largest_scale();
    let allowed = allowed_by(view.cameras(), center, radius, scale);
    let metric_of = |camera: &LodCamera| {
        let allowed = allowed_by(std::slice::from_ref(camera), center, radius, scale);
        metric(object, camera, center, allowed)
    };
    let metric = view.cameras().iter().map(metric_of).fold(MAX_METRIC, f32::min);
    let ([x, y, z], at) = (instance.axes(), instance.position(view.cell));
    let placement = std::array::from_fn(|axis| [x[axis], y[axis], z[axis], at[axis]]);
    Some(Selected { decision: decision(object, instance.is_mirrored(), metric), allowed, placement })
}

/// The allowed displacement of an instance after one more view of the frame. `before` is the value after the earlier
/// views, `None` for the first view.
pub fn merged(before: Option<f32>, selected: Option<&Selected>) -> f32 {
    match (before.filter(|before| *before >= 0.0), selected) {
        (Some(before), Some(selected)) => before.min(selected.allowed),
        (None, Some(selected)) => selected.allowed,
        (Some(before), None) => before,
        (None, None) => UNSEEN_ALLOWED,
    }
}

/// Instance counts per block and list, from the decisions of all instances.
pub fn counts(decisions: &[u32]) -> Vec<u32> {
    let mut counts = Vec::with_capacity(decisions.len() / 4);
    for block in decisions.chunks(BLOCK as usize) {
        let mut tally = [0; crate::lod::OBJECT_LISTS as usize];
        block
            .iter()
            .filter(|decision| **decision > 0)
            .for_each(|decision| tally[decision_list(*decision) as usize - 1] += 1);
        counts.extend(tally);
    }
    counts
}
