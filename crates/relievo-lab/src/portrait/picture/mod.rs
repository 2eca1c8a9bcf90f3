//! A picture of skinned meshes without a GPU, and how it is framed.

mod scene;
pub mod texture;

pub use scene::{Part, Scene};

use glam::{Mat4, Vec2, Vec3, camera};
use relievo::asset::Model;
use relievo::ops::skinning::vertex::{Vertex, vertices_of};

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
pub fn framing_of(models: &[&Model]) -> [Mat4; 2] {
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
