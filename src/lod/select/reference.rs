//! Selection of instances: the CPU reference of `kernels/lod/select.wgsl`.

use glam::{IVec3, Vec2, Vec3, Vec4};

use crate::asset::Affine;
use crate::lod::allowed::allowed_by;
use crate::lod::criterion::{Placed, metric};
use crate::lod::{
    INSTANCE_ALIVE, INSTANCE_CASTS, LodCamera, LodObject, SceneInstance, SelectView, instance_flags_mask,
};
use crate::shared::lod::allowed::{Allowed, MAX_ALLOWED, UNSEEN_ALLOWED};
use crate::shared::lod::criterion::MAX_METRIC;
use crate::shared::lod::object::{UNSEEN_METRIC, metric_word, object_flags_never_culled, object_flags_shown};
use crate::shared::lod::select::MAX_MOTION;
use crate::shared::lod::view::POSITION_SLACK;

/// Result of the selection for an instance that the view sees.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selected {
    /// Smallest metric of all cameras, by the object's criterion, times the object's factor.
    pub metric: f32,
    /// Allowed displacement of the instance in this view, in model units.
    pub allowed: f32,
    /// Distance from the nearest eye to the middle of the bounding sphere, in world units; 0 in a parallel view.
    pub distance: f32,
    /// Transform from model space to the world, relative to the corner of the view's cell.
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

/// Distance by which a sphere reaches into the view volume, in world units; negative if the sphere is outside.
pub fn depth_inside(view: &SelectView, center: Vec3, radius: f32) -> f32 {
    let lengths = center.length() + radius;
    let depth = |side: &glam::Vec4| {
        side.truncate().dot(center) + side.w + radius + POSITION_SLACK * (lengths + side.w.abs())
    };
    view.planes.iter().map(depth).fold(MAX_ALLOWED, f32::min)
}

/// Whether a view may see a sphere, with a margin of a thousandth of its radius. The margin covers the rounding of devices: if
/// the result is false, no device shows the instance.
#[cfg(feature = "gpu")]
pub(crate) fn nearly_seen(view: &SelectView, center: Vec3, radius: f32) -> bool {
    depth_inside(view, center, 1.001 * radius) >= -1e-3 * radius
}

/// Selects an instance for a view; `None` if the view does not see the instance. `last` is the instance's transform in the view's
/// last frame, if the view saw the instance in that frame.
pub fn select(
    view: &SelectView,
    object: &LodObject,
    instance: &SceneInstance,
    last: Option<&Affine>,
) -> Option<Selected> {
    let (center, radius) = placed_sphere(instance, view.cell);
    let is_culled = object_flags_never_culled(object.flags) == 0 && depth_inside(view, center, radius) < 0.0;
    if !is_shown(view, object, instance) || is_culled {
        return None;
    }
    let scale = instance.largest_scale();
    let (axes, at) = (instance.axes(), instance.position(view.cell));
    let placed = Placed { axes, at, center, radius };
    let allowed = allowed_by(view.cameras(), center, radius, scale);
    let metric_of = |camera: &LodCamera| {
        let allowed = allowed_by(std::slice::from_ref(camera), center, radius, scale);
        metric(object, camera, &placed, allowed)
    };
    let least = view.cameras().iter().map(metric_of).fold(MAX_METRIC, f32::min);
    let distance = |camera: &LodCamera| camera.perspective * center.distance(camera.eye);
    let distance = view.cameras().iter().map(distance).fold(MAX_METRIC, f32::min);
    let factor = object.metric_scale * perceptual_factor(view, object, instance, last);
    let [x, y, z] = axes;
    let placement = std::array::from_fn(|axis| [x[axis], y[axis], z[axis], at[axis]]);
    Some(Selected { metric: (factor * least).min(MAX_METRIC), allowed, distance, placement })
}

/// Position of a point in the picture, relative to the middle, in units of half the picture's height.
fn in_picture(rows: &[Vec4; 3], point: Vec3) -> Vec2 {
    let [x, y, w] = rows.map(|row| row.dot(point.extend(1.0)));
    if w > 0.0 { Vec2::new(x, y) / w } else { Vec2::splat(1e4) }
}

fn perceptual_factor(
    view: &SelectView,
    object: &LodObject,
    instance: &SceneInstance,
    last: Option<&Affine>,
) -> f32 {
    if object.motion == 0.0 && object.periphery == 0.0 {
        return 1.0;
    }
    let now = in_picture(&view.clip_rows, placed_sphere(instance, view.cell).0);
    let [x, y, z, _] = instance.bounding_sphere;
    let point = Vec4::new(x, y, z, 1.0);
    let speed = last.filter(|_| view.is_next != 0 && view.seconds > 0.0).map_or(0.0, |rows| {
        let last_center = Vec3::from(rows.map(|row| Vec4::from(row).dot(point)));
        0.5 * now.distance(in_picture(&view.last_clip_rows, last_center)) / view.seconds
    });
    1.0 + object.motion * speed.min(MAX_MOTION) + object.periphery * now.length().min(1.0)
}

/// Metric word of an instance, from its selection: the metric, and whether the instance is mirrored.
pub fn word(selected: Option<&Selected>, instance: &SceneInstance) -> u32 {
    let word = |selected: &Selected| metric_word(selected.metric.to_bits(), instance.is_mirrored().into());
    selected.map_or(UNSEEN_METRIC, word)
}

/// Allowed displacement and distance of an instance in the views of a frame, updated by one more view. `before` is the result of
/// the earlier views; for the first view, it is `None`.
pub fn merged(before: Option<Allowed>, selected: Option<&Selected>) -> Allowed {
    let before = before.unwrap_or(Allowed { displacement: UNSEEN_ALLOWED, distance: MAX_METRIC });
    let Some(Selected { allowed, distance, .. }) = selected else { return before };
    match before.displacement >= 0.0 {
        true => Allowed {
            displacement: before.displacement.min(*allowed),
            distance: before.distance.min(*distance),
        },
        false => Allowed { displacement: *allowed, distance: *distance },
    }
}
