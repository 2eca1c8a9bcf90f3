//! Criteria that choose an instance's level of detail: a metric per instance and camera, and a threshold per level. CPU reference
//! of `wgsl/lod/criterion.wgsl`.

use glam::Vec3;

use super::{LodCamera, LodObject};
use crate::InputError;
#[cfg(feature = "gpu")]
use crate::shared::lod::criterion::CRITERION_ERROR;
use crate::shared::lod::criterion::{
    CRITERION_BOX, CRITERION_DISTANCE, CRITERION_MAGNIFICATION, CRITERION_NEAREST, CRITERION_POINT,
    CRITERION_SPHERE, MAX_METRIC,
};
use crate::shared::lod::object::object_flags_criterion;

/// The criterion by which an object's levels of detail are chosen. In each view, an instance gets the coarsest level that
/// the criterion permits.
///
/// The lists in the variants name the thresholds at which levels 1, 2, … begin. Levels beyond the end of a list are not drawn.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub enum Criterion {
    /// The projected error: an instance gets the coarsest level whose measured error the view allows
    /// ([`Quality::pixels`](crate::scene::Quality::pixels)). Only this criterion keeps the error within these pixels.
    #[default]
    Error,
    /// The distance from the eye (thesis A, section 6.1).
    Distance {
        /// The point of the instance to which the distance is measured.
        to: DistanceTo,
        /// Smallest distances in world units at which levels 1, 2, … are drawn, ascending, above 0.
        from: Vec<f32>,
    },
    /// The instance's area on the screen (thesis A, section 6.2).
    Size {
        /// The shape whose area counts.
        of: SizeOf,
        /// Fractions of the viewport's area below which levels 1, 2, … are drawn, descending, above 0.
        below: Vec<f32>,
    },
    /// The magnification (thesis B, equation 3.3): pixels per world unit at the middle of the bounding sphere.
    Magnification {
        /// Pixels per world unit below which levels 1, 2, … are drawn, descending, above 0.
        below: Vec<f32>,
    },
    /// A target triangle count that falls linearly with the distance (thesis A, section 6.1.1). Up to `near`, it is the finest
    /// level's count. From `far` on, it is the coarsest level's count. The level with the closest count is drawn.
    Ratio {
        /// The point of the instance to which the distance is measured.
        to: DistanceTo,
        /// Distance in world units up to which the finest level is drawn, at least 0.
        near: f32,
        /// Distance in world units beyond which the coarsest level is drawn, above `near`.
        far: f32,
    },
}

/// The point of an instance that a distance is measured to.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum DistanceTo {
    /// The middle of the bounding sphere.
    #[default]
    Center,
    /// A point in the model's space.
    Point(Vec3),
    /// The nearest point of the model's box, whose edges are parallel to the model's axes. A character's box is a cube around the
    /// bounding sphere of its first clip.
    NearestPoint,
}

/// The shape of an instance whose area on the screen counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SizeOf {
    /// The model's box ([`DistanceTo::NearestPoint`]). The area of the box changes as the instance turns.
    Box,
    /// The bounding sphere. Its area does not change as the instance turns.
    #[default]
    Sphere,
}

impl Criterion {
    /// The criterion's code in an object's flags word.
    #[cfg(feature = "gpu")]
    pub(crate) fn code(&self) -> u32 {
        match self {
            Self::Error => CRITERION_ERROR,
            Self::Distance { to, .. } | Self::Ratio { to, .. } => match to {
                DistanceTo::Center => CRITERION_DISTANCE,
                DistanceTo::Point(_) => CRITERION_POINT,
                DistanceTo::NearestPoint => CRITERION_NEAREST,
            },
            Self::Size { of: SizeOf::Box, .. } => CRITERION_BOX,
            Self::Size { of: SizeOf::Sphere, .. } => CRITERION_SPHERE,
            Self::Magnification { .. } => CRITERION_MAGNIFICATION,
        }
    }

    /// The point of [`DistanceTo::Point`], in the model's space; `None` for other criteria.
    pub(crate) fn point(&self) -> Option<Vec3> {
        match self {
            Self::Distance { to: DistanceTo::Point(point), .. }
            | Self::Ratio { to: DistanceTo::Point(point), .. } => Some(*point),
            _ => None,
        }
    }

    /// Threshold per level: the smallest metric at which the level is drawn. Input: errors per level, ascending from 0,
    /// and triangles per level.
    #[cfg(feature = "gpu")]
    pub(crate) fn thresholds(&self, errors: &[f32], triangles: &[u32]) -> Vec<f32> {
        let levels = errors.len();
        let listed = |list: &[f32], metric: fn(f32) -> f32| {
            let listed = list.iter().map(|value| metric(*value)).chain(std::iter::repeat(f32::MAX));
            std::iter::once(0.0).chain(listed).take(levels).collect()
        };
        match self {
            Self::Error => errors.to_vec(),
            Self::Distance { from, .. } => listed(from, |distance| distance),
            Self::Size { below, .. } => listed(below, |area| 1.0 / area.sqrt()),
            Self::Magnification { below } => listed(below, |magnification| 1.0 / magnification),
            Self::Ratio { near, far, .. } => {
                let [most, least] = [triangles.first(), triangles.last()].map(|count| count.map_or(0.0, of));
                let distance = |counts: &[u32]| {
                    let fallen = most - 0.5 * (of(&counts[0]) + of(&counts[1]));
                    near + (far - near) * (fallen / (most - least).max(1.0)).clamp(0.0, 1.0) as f32
                };
                std::iter::once(0.0).chain(triangles.windows(2).map(distance)).take(levels).collect()
            }
        }
    }

    /// Two factors that multiply a threshold. At the first product, an instance returns to the finer level; at the second, it
    /// takes the coarser level. `width` is the hysteresis, as a fraction of the threshold.
    #[cfg(feature = "gpu")]
    pub(crate) fn hysteresis(&self, width: f32) -> [f32; 2] {
        match self {
            Self::Error => [1.0, 1.0 / (1.0 - width)],
            _ => self.band(width),
        }
    }

    /// Two factors that multiply a threshold. A transition begins at the first product, and ends at the second.
    ///
    /// `width` is half the width of the band between the two products, as a fraction of the threshold. The band of
    /// [`Criterion::Error`] lies on the coarser side, so that the allowed error is not exceeded.
    #[cfg(feature = "gpu")]
    pub(crate) fn band(&self, width: f32) -> [f32; 2] {
        match self {
            Self::Error => [1.0, 1.0 + 2.0 * width],
            Self::Distance { .. } | Self::Ratio { .. } => [1.0 - width, 1.0 + width],
            Self::Size { .. } => [1.0 / (1.0 + width).sqrt(), 1.0 / (1.0 - width).sqrt()],
            Self::Magnification { .. } => [1.0 / (1.0 + width), 1.0 / (1.0 - width)],
        }
    }

    /// Converts a value in the criterion's own unit (distance, area or magnification) to the metric. `None` for
    /// [`Criterion::Error`].
    pub(crate) fn metric_of(&self, value: f32) -> Option<f32> {
        match self {
            Self::Error => None,
            Self::Distance { .. } | Self::Ratio { .. } => Some(value),
            Self::Size { .. } => Some(1.0 / value.sqrt()),
            Self::Magnification { .. } => Some(1.0 / value),
        }
    }

    /// Checks the thresholds of an object with `levels` levels.
    ///
    /// # Errors
    /// [`InputError`] for more thresholds than levels after level 0, for a threshold that is not finite or not above 0, and for a
    /// list in the wrong order.
    pub fn validate(&self, levels: usize) -> Result<(), InputError> {
        match self {
            Self::Error => Ok(()),
            Self::Distance { from, .. } => check_list("criterion.from", from, levels, Order::Ascending),
            Self::Size { below, .. } | Self::Magnification { below } => {
                check_list("criterion.below", below, levels, Order::Descending)
            }
            Self::Ratio { near, far, .. } => {
                if !(0.0..f32::INFINITY).contains(near) {
                    return Err(InputError::new("criterion.near", near, "must be finite, and not negative"));
                }
                if far > near && far.is_finite() {
                    return Ok(());
                }
                Err(InputError::new("criterion.far", far, format!("must be finite, and above near, {near}")))
            }
        }?;
        match self.point() {
            Some(point) if !point.is_finite() => {
                Err(InputError::new("criterion.point", point, "must be finite"))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(feature = "gpu")]
fn of(count: &u32) -> f64 {
    f64::from(*count)
}

#[derive(Clone, Copy, PartialEq)]
enum Order {
    Ascending,
    Descending,
}

fn check_list(path: &str, list: &[f32], levels: usize, order: Order) -> Result<(), InputError> {
    if list.len() >= levels.max(1) {
        let bound = format!("must be below {levels}, the number of levels");
        return Err(InputError::new(format!("{path}.len"), list.len(), bound));
    }
    let [named, mut before] = match order {
        Order::Ascending => ["ascend", "0"],
        Order::Descending => ["descend", "inf"],
    }
    .map(str::to_owned);
    let mut last = if order == Order::Ascending { 0.0 } else { f32::INFINITY };
    for (at, value) in list.iter().enumerate() {
        let is_right = if order == Order::Ascending { *value > last } else { *value < last };
        if !(f32::MIN_POSITIVE..f32::INFINITY).contains(value) || !is_right {
            let bound = format!("must be finite and above 0, and {named} from {before}");
            return Err(InputError::new(format!("{path}[{at}]"), value, bound));
        }
        (last, before) = (*value, value.to_string());
    }
    Ok(())
}

/// Placement of an instance in a view. Positions are relative to the corner of the view's cell.
#[derive(Debug, Clone, Copy)]
pub struct Placed {
    /// The columns of the model's linear transform.
    pub axes: [Vec3; 3],
    /// Position of the model's origin.
    pub at: Vec3,
    /// Middle of the bounding sphere.
    pub center: Vec3,
    /// Radius of the bounding sphere, in world units.
    pub radius: f32,
}

impl Placed {
    fn point(&self, [x, y, z]: [f32; 3]) -> Vec3 {
        self.axes[0] * x + self.axes[1] * y + self.axes[2] * z + self.at
    }
}

/// Metric of an instance for one camera, by the object's criterion. `allowed` is the allowed displacement in model units.
pub fn metric(object: &LodObject, camera: &LodCamera, placed: &Placed, allowed: f32) -> f32 {
    match object_flags_criterion(object.flags) {
        CRITERION_DISTANCE => camera.perspective * placed.center.distance(camera.eye),
        CRITERION_POINT => camera.perspective * placed.point(object.point).distance(camera.eye),
        CRITERION_NEAREST => camera.perspective * distance_to_box(object, placed, camera.eye),
        CRITERION_BOX => metric_of_area(camera, box_area(object, placed, camera)),
        CRITERION_SPHERE => {
            let radius = camera.focal * placed.radius / depth_of(camera, placed.center);
            metric_of_area(camera, std::f32::consts::PI * radius * radius)
        }
        CRITERION_MAGNIFICATION => depth_of(camera, placed.center) / camera.focal,
        _ => allowed,
    }
}

fn distance_to_box(object: &LodObject, placed: &Placed, eye: Vec3) -> f32 {
    let towards = eye - placed.point(object.point);
    let mut nearest = Vec3::ZERO;
    for (along, half) in placed.axes.into_iter().zip(object.half_size) {
        nearest += along * (along.dot(towards) / along.dot(along).max(1e-30)).clamp(-half, half);
    }
    (towards - nearest).length()
}

fn box_area(object: &LodObject, placed: &Placed, camera: &LodCamera) -> f32 {
    let middle = placed.point(object.point);
    let half = |axis: usize| object.half_size[axis % 3] * placed.axes[axis % 3];
    let mut area = 0.0;
    for axis in 0..3 {
        let (half, across, along) = (half(axis), half(axis + 1), half(axis + 2));
        let normal = across.cross(along);
        let offset = match camera.perspective == 0.0 {
            true => -normal.dot(camera.ahead) * MAX_METRIC,
            false => normal.dot(camera.eye - middle),
        };
        let reach = normal.dot(half);
        if offset.abs() > reach.abs() {
            let side = if (offset > 0.0) == (reach > 0.0) { 1.0 } else { -1.0 };
            area += face_area(camera, middle + side * half, across, along);
        }
    }
    area
}

fn face_area(camera: &LodCamera, middle: Vec3, across: Vec3, along: Vec3) -> f32 {
    let [a, b, c, d] = [-across - along, across - along, across + along, along - across]
        .map(|corner| on_screen(camera, middle + corner));
    0.5 * (c - a).cross(d - b).length()
}

fn on_screen(camera: &LodCamera, point: Vec3) -> Vec3 {
    let towards = point - camera.eye;
    let depth = towards.dot(camera.ahead);
    let across = camera.focal * (towards - depth * camera.ahead);
    if camera.perspective == 0.0 { across } else { across / depth.max(camera.near.max(1e-9)) }
}

fn depth_of(camera: &LodCamera, center: Vec3) -> f32 {
    if camera.perspective == 0.0 {
        return 1.0;
    }
    camera.ahead.dot(center - camera.eye).max(camera.near.max(1e-9))
}

fn metric_of_area(camera: &LodCamera, area: f32) -> f32 {
    (camera.pixel_count / area.max(1e-30)).sqrt().min(MAX_METRIC)
}
