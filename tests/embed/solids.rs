//! A closed solid that looks like none of its mirror images.

use glam::Vec3;
use relievo::asset::influences::{Influence, Influences};
use relievo::asset::{Mesh, Model};
use relievo_samples::creature;

/// A tetrahedron with unequal faces, about two units large, mirrored along x if `mirrors`. Its triangles are
/// counter-clockwise seen from outside either way.
pub fn solid(mirrors: bool, double_sided: bool) -> Model {
    let side = if mirrors { -1.0 } else { 1.0 };
    let corners = [[-0.9, -0.7, 0.2], [1.1, -0.6, 0.5], [-0.3, 1.2, -0.1], [-0.2, -0.3, -1.0]];
    let corners = corners.map(|[x, y, z]| Vec3::new(side * x, y, z));
    let middle = corners.iter().sum::<Vec3>() / 4.0;
    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for [a, b, c] in [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]] {
        let [a, b, c] = [a, b, c].map(|corner: usize| corners[corner]);
        let normal = (b - a).cross(c - a).normalize();
        let is_outwards = normal.dot(a - middle) > 0.0;
        positions.extend(if is_outwards { [a, b, c] } else { [a, c, b] }.map(|corner| corner.to_array()));
        normals.extend([if is_outwards { normal } else { -normal }.to_array(); 3]);
    }
    let count = positions.len();
    let mut model = creature().expect("valid");
    let whole = |_| vec![Influence { bone: 0, weight: 1.0 }];
    let mesh = Mesh {
        name: "solid".to_owned(),
        skin: 0,
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; count],
        uv: vec![[0.0; 2]; count],
        indices: (0..count as u32).collect(),
        double_sided,
        material: None,
        influences: Influences::new("solid", 64, (0..count).map(whole)).expect("valid"),
        targets: Vec::new(),
        weights: Vec::new(),
        weight_keys: Vec::new(),
        positions,
        normals,
        ..Mesh::default()
    };
    model.clips.clear();
    (model.meshes, model.skinned) = (vec![mesh], 1);
    model
}
