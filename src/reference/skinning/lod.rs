//! What is drawn: twin of `kernels/skinning/lod.wgsl`.

use glam::{Vec3, Vec4};

use crate::animation::transform::Affine;
use crate::skinning::lod::LodView;
use crate::skinning::weights::Reduction;

/// How an instance at this place is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// How far the model's ball reaches into the view's volume; negative where it does not.
    pub depth: f32,
    /// The way from the beginning of the fade to its end, 0 to 1, before it is cut into steps.
    pub way: f32,
}

/// How an instance is seen.
pub fn seen(view: &LodView, placement: &Affine) -> Seen {
    let rows = placement.map(Vec4::from_array);
    let center = Vec3::from_array(rows.map(|row| row.dot(view.center.extend(1.0))));
    let columns = rows.iter().map(|row| row.truncate() * row.truncate()).sum::<Vec3>();
    let radius = view.radius * columns.element_sum().sqrt();
    let depths = view.planes().map(|plane| plane.truncate().dot(center) + plane.w + radius);
    let way = (center.distance(view.eye) - view.near) / (view.far - view.near);
    Seen { depth: depths.into_iter().fold(f32::INFINITY, f32::min), way: way.clamp(0.0, 1.0) }
}

/// What an instance is drawn with; [`Reduction::UNSEEN`] where it is not seen.
pub fn lod(view: &LodView, placement: &Affine) -> Reduction {
    let Seen { depth, way } = seen(view, placement);
    let steps = view.steps as f32;
    if depth < 0.0 {
        return Reduction::UNSEEN;
    }
    Reduction { fade: (way * steps).floor() / steps, most: view.most }
}
