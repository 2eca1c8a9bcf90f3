//! Culling and level of detail of instances: the CPU reference of `kernels/skinning/lod.wgsl`.

use glam::{Vec3, Vec4};

use crate::asset::transform::Affine;
use crate::shared::skinning::lod::NEARLY_SINGULAR;
use crate::skinning::bounding_sphere::stretch;
use crate::skinning::instance_lod::{FadeRange, InstanceLod};
use crate::skinning::lod::LodView;
use crate::skinning::picture::is_mirrored;

/// How an instance is seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// How far the model's sphere extends into the view volume; negative if it is outside.
    pub depth: f32,
    /// The projected distance of the sphere's center.
    pub projected_distance: f32,
    /// The position between the beginning and the end of the fade, 0 to 1, before it is rounded to steps.
    pub fade_fraction: f32,
}

/// How an instance is seen.
pub fn seen(view: &LodView, placement: &Affine) -> Seen {
    let rows = placement.map(Vec4::from_array);
    let center = Vec3::from_array(rows.map(|row| row.dot(view.center.extend(1.0))));
    let radius = view.radius * stretch(rows.map(Vec4::truncate));
    let depths = view.planes().map(|plane| plane.truncate().dot(center) + plane.w + radius);
    let projected_distance = view.projected_distance(center);
    let FadeRange { start, end } = view.fade_range;
    let fade_fraction = (projected_distance - start) / (end - start);
    Seen {
        depth: depths.into_iter().fold(f32::INFINITY, f32::min),
        projected_distance,
        fade_fraction: fade_fraction.clamp(0.0, 1.0),
    }
}

/// Whether an instance may appear mirrored: its placement mirrors or the view does, but not both. A nearly
/// singular matrix may count as either.
pub fn may_mirror(view: &LodView, placement: &Affine) -> bool {
    let [x, y, z] = placement.map(|row| Vec4::from_array(row).truncate());
    let side = if is_mirrored(&view.clip_from_world) { -1.0 } else { 1.0 };
    side * x.dot(y.cross(z)) < NEARLY_SINGULAR * (x.length() * y.length() * z.length())
}

/// The level of detail of an instance; [`InstanceLod::UNSEEN`] if it is not seen.
pub fn lod(view: &LodView, placement: &Affine) -> InstanceLod {
    let Seen { depth, projected_distance, fade_fraction } = seen(view, placement);
    let steps = view.steps as f32;
    if depth < 0.0 {
        return InstanceLod::UNSEEN;
    }
    InstanceLod {
        influence_fade: (fade_fraction * steps).floor() / steps,
        max_influences: view.max_influences,
        mesh_lod: view.levels.at(projected_distance),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Mat3, Quat};

    #[test]
    fn no_matrix_stretches_further() {
        let unit = |at: usize| {
            let at = at as f32;
            Vec3::new(libm::sinf(1.3 * at), libm::cosf(2.1 * at), libm::sinf(0.7 * at + 1.0)).normalize()
        };
        let turn = |at: usize| Mat3::from_quat(Quat::from_axis_angle(unit(at), 0.37 * at as f32));
        let of = |matrix: Mat3| stretch(matrix.transpose().to_cols_array_2d().map(Vec3::from));
        for at in 0..100 {
            let scale = Vec3::new(0.2 + 0.02 * at as f32, -1.0, 1.5);
            // A scale followed by a rotation is bounded exactly; a scale between two rotations shears.
            assert!((of(turn(at) * Mat3::from_diagonal(scale)) - scale.abs().max_element()).abs() < 1e-5);
            let sheared = turn(at) * Mat3::from_diagonal(scale) * turn(3 * at + 1);
            let found = of(sheared);
            let longest = (0..500).map(|to| (sheared * unit(to)).length()).fold(0.0, f32::max);
            assert!(longest <= found + 1e-5, "{longest} of {found}");
            assert!(found < 1.8 * longest, "{longest} of {found}");
        }
    }
}
