//! A picture of skinned meshes without a GPU, and how it is framed.

mod scene;
pub mod texture;

pub use scene::{Part, Scene};

use glam::{DVec3, Mat4, Vec2, Vec3, camera};

use crate::asset::Model;
use crate::skinning::vertex::{Vertex, vertices_of};

/// Whether a matrix from some space to clip space mirrors: triangles that are counter-clockwise in that space,
/// seen from outside, then run clockwise on the screen. For a parallel view, whose depth must grow with
/// distance, the sign of the determinant of all three axes decides.
pub fn is_mirrored(clip: &Mat4) -> bool {
    // In f64, because the product of three small scales may underflow f32.
    let [right, up, depth, ahead] = [0, 1, 2, 3].map(|row| clip.row(row).truncate().as_dvec3());
    let ahead = if ahead == DVec3::ZERO { depth } else { ahead };
    right.cross(up).dot(ahead) > 0.0
}

/// A matrix from the model's space to clip space that puts all of these vertices in the middle of a square
/// picture, seen from +Z, slightly from the left and from above.
pub fn framing<'a>(vertices: impl Iterator<Item = &'a Vertex> + Clone) -> Mat4 {
    let [view_from_model, clip_from_view] = framing_camera(vertices);
    clip_from_view * view_from_model
}

/// The camera of [`framing`]: the matrix from the model's space to the camera's, and the projection.
pub fn framing_camera<'a>(vertices: impl Iterator<Item = &'a Vertex> + Clone) -> [Mat4; 2] {
    let positions = vertices.map(|vertex| Vec3::from(vertex.position));
    let [view, wide] = around(positions.clone());
    let clip = wide * view;
    let seen = positions.map(|position| clip.project_point3(position).truncate());
    let (low, high) =
        seen.fold((Vec2::MAX, Vec2::MIN), |(low, high), position| (low.min(position), high.max(position)));
    if !low.cmple(high).all() {
        return [view, wide];
    }
    // The contents are centered and fill nine tenths.
    let zoom = 1.8 / (high - low).max_element().max(1e-3);
    let middle = low.midpoint(high) * zoom;
    let crop = Mat4::from_translation(-middle.extend(0.0)) * Mat4::from_scale(Vec3::new(zoom, zoom, 1.0));
    [view, crop * wide]
}

/// The camera of [`framing`] for the first of some models that stand still.
pub(crate) fn framing_of(models: &[&Model]) -> [Mat4; 2] {
    let vertices: Vec<Vertex> =
        models.iter().take(1).flat_map(|model| &model.meshes).flat_map(vertices_of).collect();
    framing_camera(vertices.iter())
}

/// A camera that sees a sphere around the points: the matrix to its space, and the projection.
fn around(positions: impl Iterator<Item = Vec3>) -> [Mat4; 2] {
    let (low, high) = positions
        .fold((Vec3::MAX, Vec3::MIN), |(low, high), position| (low.min(position), high.max(position)));
    let (low, high) = if low.cmple(high).all() { (low, high) } else { (Vec3::ZERO, Vec3::ONE) };
    let center = low.midpoint(high);
    let radius = ((high - low).length() / 2.0).max(1e-6 * center.length()).max(1e-12);
    let field_of_view: f32 = 0.5;
    let distance = radius / (field_of_view / 2.0).sin();
    let eye = center + distance * Vec3::new(-0.45, 0.2, 1.0).normalize();
    let view = camera::rh::view::look_at_mat4(eye, center, Vec3::Y);
    let near = distance - 1.01 * radius;
    let far = distance + 1.01 * radius;
    [view, camera::rh::proj::directx::perspective(field_of_view, 1.0, near, far)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use camera::rh::{proj::directx, view::look_at_mat4};

    #[test]
    fn mirror_images_are_told_from_pictures() {
        let look = look_at_mat4(Vec3::new(3.0, 4.0, 5.0), Vec3::new(0.0, 1.0, -2.0), Vec3::Y);
        for projection in [
            directx::perspective(0.8, 1.5, 0.1, 90.0),
            directx::perspective_infinite_reverse(0.8, 1.5, 0.1),
            directx::frustum(0.3, 0.9, -0.2, 0.1, 0.5, 40.0),
            directx::orthographic(-3.0, 2.0, -1.0, 4.0, -10.0, 50.0),
        ] {
            for turn in [
                Mat4::IDENTITY,
                Mat4::from_rotation_x(2.0),
                Mat4::from_scale(Vec3::new(-1e-13, -1e-13, 2e-13)),
            ] {
                assert!(!is_mirrored(&(projection * look * turn)), "{projection} {turn}");
                let mirror = Mat4::from_scale(Vec3::new(1.0, 1.0, -3.0));
                assert!(is_mirrored(&(projection * look * turn * mirror)), "{projection} {turn}");
                assert!(is_mirrored(
                    &(Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * projection * look * turn)
                ));
            }
        }
    }
}
