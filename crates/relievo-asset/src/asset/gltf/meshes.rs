//! Reads the meshes of nodes. Each primitive becomes one mesh, with morph weights and weight keys. Primitives without positions
//! are left out.

use gltf_json::mesh::Semantic;
use gltf_json::validation::Checked;

use super::clips::weight_keys;
use super::document::Document;
use super::materials::Materials;
use super::nodes::{Nodes, node_name};
use super::primitive::Reader;
use super::winding::{mirrored, mirrors, turn_mirrored};
use crate::InputError;
use crate::asset::mesh::Mesh;
use crate::asset::transform::finite;

/// Number of elements charged to the budget for every primitive, whatever it contains.
const PRIMITIVE: usize = 32;

/// Reads every primitive of the scene's nodes: first of nodes with a skin, then of nodes without a skin. Each group is in the
/// order of the nodes.
///
/// # Errors
/// [`InputError`] with the path of the fault in the file; also if no primitive has positions.
pub fn meshes(
    document: &Document<'_>,
    nodes: &Nodes,
    materials: &mut Materials,
) -> Result<Vec<Mesh>, InputError> {
    let skinned = nodes.skinned.iter().map(|(node, skin)| (*node, *skin, false));
    let rigid = nodes.rigid.iter().zip(nodes.own_skins()..);
    let rigid = rigid.map(|(rigid, skin)| (rigid.node, skin, true));
    let mirrored = mirrored(&nodes.skeleton);
    let mirrors: Vec<_> = nodes.skins.iter().map(|skin| mirrors(&mirrored, skin)).collect();
    let mut meshes = Vec::new();
    let mut left_out = None;
    for (node, skin, is_rigid) in skinned.chain(rigid) {
        let Some(mesh) = document.root.nodes[node].mesh else { continue };
        let mesh = mesh.value();
        let weights = weights(document, node, mesh)?;
        let weight_keys = weight_keys(document, node, weights.len())?;
        let keys =
            weight_keys.iter().map(|(_, keys)| keys.parts().0.len() + keys.parts().1.len()).sum::<usize>();
        let name = node_name(&document.root, node);
        for (at, primitive) in document.root.meshes[mesh].primitives.iter().enumerate() {
            let path = format!("meshes[{mesh}].primitives[{at}]");
            if !primitive.attributes.contains_key(&Checked::Valid(Semantic::Positions)) {
                left_out.get_or_insert(path);
                continue;
            }
            document.budget.spend(&path, PRIMITIVE + keys)?;
            let is_bare = materials.is_unread;
            let draco = document.extensions.draco[mesh][at].as_ref();
            let decompressed = draco.map(|draco| draco.decompressed(document, &path)).transpose()?;
            let reader = Reader { document, primitive, path, is_rigid, is_bare, decompressed };
            let mut read = reader.mesh(&nodes.skins[skin], weights.len())?;
            turn_mirrored(&mut read, &mirrors[skin]);
            let material =
                primitive.material.filter(|_| !is_bare).map(|material| materials.read(document, material));
            meshes.push(Mesh {
                name: format!("{name}_{at}"),
                skin,
                material: material.transpose()?,
                weights: weights.clone(),
                weight_keys: weight_keys.clone(),
                ..read
            });
        }
    }
    match left_out.filter(|_| meshes.is_empty()) {
        None => Ok(meshes),
        Some(path) => {
            let bound = "must be given: no primitive of the scene has positions";
            Err(InputError::new(format!("{path}.attributes.POSITION"), "missing", bound))
        }
    }
}

/// Morph weights of a node: the node's own weights, or else the weights of its mesh, or else zeros.
fn weights(document: &Document<'_>, node: usize, mesh: usize) -> Result<Vec<f32>, InputError> {
    let (of_node, of_mesh) = (&document.root.nodes[node], &document.root.meshes[mesh]);
    let first = of_mesh.primitives.first().and_then(|primitive| primitive.targets.as_ref());
    let targets = first.map_or(0, Vec::len);
    let (path, weights) = match (&of_node.weights, &of_mesh.weights) {
        (Some(weights), _) => (format!("nodes[{node}].weights"), weights.clone()),
        (None, Some(weights)) => (format!("meshes[{mesh}].weights"), weights.clone()),
        (None, None) => return Ok(vec![0.0; targets]),
    };
    InputError::check_len(&path, weights.len(), targets, "a morph target")?;
    finite(&path, &weights)?;
    Ok(weights)
}
