//! Static models: meshes at rest, or in a given pose, baked into the model's space, so that drawing them needs no
//! skinning.

use super::pose::{Moment, Pose};
use super::vertex::{Vertex, check_range};
use crate::InputError;
use crate::asset::skeleton::Bone;
use crate::asset::{Influences, Mesh, Model, Skeleton, Skin, Transform};

/// The model at rest, without animation. Positions, normals and tangents of all meshes are baked: they are what
/// skinning computes without a clip, with the morph weights at rest.
///
/// Its only bone and its only skin are identities, so skinning gives the same positions again. Vertices and triangles
/// keep their order; triangles are counter-clockwise once bones have transformed them ([`Mesh::indices`]). There are no
/// clips, morph targets or levels of detail. Materials and images are those of the model.
///
/// # Errors
/// [`InputError`] for a mesh or a skin that does not match the model, and for vertices outside the range of
/// coordinates, as large scales produce.
pub fn at_rest(model: &Model) -> Result<Model, InputError> {
    let vertices = (0..model.meshes.len()).map(|mesh| resting(model, mesh));
    still(model, &vertices.collect::<Result<Vec<_>, _>>()?)
}

/// The vertices of a mesh at rest.
fn resting(model: &Model, index: usize) -> Result<Vec<Vertex>, InputError> {
    let mesh = &model.meshes[index];
    model.check_mesh(index)?;
    Ok(Pose::new(model, mesh, Moment::Rest).vertices(mesh))
}

/// A static model with these vertices, one list per mesh, in the mesh's own order; otherwise as [`at_rest`]. A scene
/// draws it as a static mesh, however the vertices were computed.
///
/// # Errors
/// [`InputError`] for another number of meshes or vertices than the model has, and for vertices outside the range of
/// coordinates.
pub fn still(model: &Model, vertices: &[Vec<Vertex>]) -> Result<Model, InputError> {
    InputError::check_len("vertices", vertices.len(), model.meshes.len(), "list for each mesh")?;
    let bone = Bone { name: "model".to_owned(), parent: None, rest: Transform::IDENTITY };
    let identity = glam::Mat4::IDENTITY.to_cols_array();
    let meshes = model.meshes.iter().zip(vertices).enumerate();
    Ok(Model {
        skeleton: Skeleton::of_joints(vec![bone])?,
        skins: vec![Skin { name: "model".to_owned(), bones: vec![0], inverse_binds: vec![identity] }],
        clips: Vec::new(),
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
        indices: mesh.indices.clone(),
        double_sided: mesh.double_sided,
        material: mesh.material,
        influences: Influences::rigid(vertices.len()),
        ..Mesh::default()
    })
}
