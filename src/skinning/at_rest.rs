//! Static models: meshes at rest, or in a given pose, whose vertices are baked into the model's space. Drawing them
//! needs no skinning.

use super::pose::{Moment, Pose};
use super::vertex::{Vertex, check_range};
use crate::InputError;
use crate::asset::skeleton::Bone;
use crate::asset::{Influences, Mesh, Model, Skeleton, Skin, Transform};

/// Bakes a model at rest into a static model. Positions, normals and tangents of all meshes get the values that
/// skinning computes in the rest pose, with the morph weights at rest.
///
/// The result has one bone and one skin, whose transforms are identities, so skinning does not change the positions.
/// Vertices and triangles keep their order. Triangles are counter-clockwise in the rest pose ([`Mesh::indices`]). The
/// result has no clips, morph targets or levels of detail. It keeps the model's materials and images.
///
/// # Errors
/// [`InputError`] for a mesh or a skin that does not match the model, and for baked positions outside the range of
/// coordinates, which large scales can cause.
pub fn at_rest(model: &Model) -> Result<Model, InputError> {
    let vertices = (0..model.meshes.len()).map(|mesh| resting(model, mesh));
    still(model, &vertices.collect::<Result<Vec<_>, _>>()?)
}

/// The vertices of a mesh at rest, in the model's space.
fn resting(model: &Model, index: usize) -> Result<Vec<Vertex>, InputError> {
    let mesh = &model.meshes[index];
    model.check_mesh(index)?;
    Ok(Pose::new(model, mesh, Moment::Rest).vertices(mesh))
}

/// Makes a static model with the given vertices: one list per mesh, in the order of the mesh's vertices. Everything
/// else is as in [`at_rest`]. A scene draws the result as a static mesh.
///
/// # Errors
/// [`InputError`] if the number of lists or of vertices differs from the model's, and for positions outside the range
/// of coordinates.
pub fn still(model: &Model, vertices: &[Vec<Vertex>]) -> Result<Model, InputError> {
    InputError::check_len("vertices", vertices.len(), model.meshes.len(), "list for each mesh")?;
    let bone = Bone { name: "model".to_owned(), parent: None, rest: Transform::IDENTITY };
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let meshes = model.meshes.iter().zip(vertices).enumerate();
    Ok(Model {
        skeleton: Skeleton::of_joints(vec![bone])?,
        skins: vec![Skin { name: "model".to_owned(), bones: vec![0], inverse_binds: vec![identity] }],
        clips: Vec::new(),
        motion: None,
        meshes: meshes.map(|(at, (mesh, own))| baked(mesh, at, own)).collect::<Result<_, _>>()?,
        skinned: 0,
        materials: model.materials.clone(),
        images: model.images.clone(),
    })
}

fn baked(mesh: &Mesh, index: usize, vertices: &[Vertex]) -> Result<Mesh, InputError> {
    let path = format!("vertices[{index}].len");
    InputError::check_same(path, vertices.len(), mesh.vertices(), "as many as the mesh has")?;
    check_range(index, vertices)?;
    Ok(Mesh {
        name: mesh.name.clone(),
        positions: vertices.iter().map(|vertex| vertex.position).collect(),
        normals: vertices.iter().map(|vertex| vertex.normal).collect(),
        tangents: vertices.iter().map(|vertex| vertex.tangent).collect(),
        uv: mesh.uv.clone(),
        second_uv: mesh.second_uv.clone(),
        colors: mesh.colors.clone(),
        indices: mesh.indices.clone(),
        double_sided: mesh.double_sided,
        material: mesh.material,
        influences: Influences::rigid(vertices.len()),
        error: mesh.error,
        ..Mesh::default()
    })
}
