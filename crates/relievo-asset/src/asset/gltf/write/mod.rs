//! Writes a model as binary glTF 2.0.

mod binary;
mod clips;
mod materials;
mod meshes;

use serde_json::{Value, json};

use super::winding::{mirrored, mirrors};
use crate::InputError;
use crate::asset::{Bone, Model, Transform};
use binary::{Binary, push};
use materials::Materials;
use meshes::{Group, groups};

/// Largest size of a GLB in bytes, because the format stores lengths in 32 bits.
const MAX_BYTES: usize = u32::MAX as usize;

/// Largest number of joints of a skin, because vertices store joint indices in 16 bits.
const MAX_JOINTS: usize = 1 << 16;

impl Model {
    /// Writes the model as binary glTF (`.glb`): skeleton, skins, meshes with morph targets, clips, materials and images.
    ///
    /// If the model was read from glTF or OBJ, [`Model::from_gltf`] reads equal meshes, skins and materials back. Positions,
    /// normals, tangents, texture coordinates, triangles and keys of clips are equal to the bit. Influences are also equal, up
    /// to the rounding of weights that do not sum to 1. There are a few differences:
    ///
    /// - Bones that skins, meshes and clips do not need are not read again, and bones may have another order.
    /// - Tangents of cubic splines, and rotations, may differ in the last bit.
    /// - A clip lasts until its last key. Clips without keys are left out.
    /// - [`Alpha::Blended`](crate::asset::material::Alpha::Blended) is written as `BLEND`, which the import reads as
    ///   [`Alpha::Dithered`](crate::asset::material::Alpha::Dithered).
    /// - Levels of detail and lights are not written. Of joined levels, the finest is written.
    ///
    /// Images are PNG. Models have no metallic and roughness factors; these are written as 0 and 1.
    ///
    /// # Errors
    /// [`InputError`] for an invalid mesh, skin or material, for images that PNG cannot hold, and for more than 4 GiB.
    pub fn to_glb(&self) -> Result<Vec<u8>, InputError> {
        (0..self.skins.len()).try_for_each(|skin| self.check_skin(skin))?;
        (0..self.meshes.len()).try_for_each(|mesh| self.check_mesh(mesh))?;
        let mut document = Document::default();
        for Bone { name, parent, rest: Transform { translation, rotation, scale } } in self.skeleton.bones() {
            let node =
                json!({ "name": name, "translation": translation, "rotation": rotation, "scale": scale });
            document.add_node(*parent, node);
        }
        document.add_meshes(self)?;
        document.add_skins(self)?;
        let clips = clips::clips(self, &document.weighted, &mut document.binary);
        document.finish(clips)
    }
}

/// A document under construction. Its first nodes are the bones, in their order; the nodes of meshes follow.
#[derive(Default)]
struct Document {
    binary: Binary,
    nodes: Vec<Value>,
    roots: Vec<usize>,
    meshes: Vec<Value>,
    skins: Vec<Value>,
    materials: Materials,
    /// Nodes whose meshes have animated morph weights, each with the index of its first mesh in the model.
    weighted: Vec<(usize, usize)>,
    /// Number of leading skins that are written. Each of the other skins becomes the matrix of a node.
    shared: usize,
}

impl Document {
    /// Adds a node below the node `parent`, or as a root if that is `None`. Returns the new node's index.
    fn add_node(&mut self, parent: Option<u32>, node: Value) -> usize {
        let at = push(&mut self.nodes, node);
        let Some(parent) = parent else {
            self.roots.push(at);
            return at;
        };
        match &mut self.nodes[parent as usize]["children"] {
            Value::Array(children) => children.push(at.into()),
            none => *none = json!([at]),
        }
        at
    }

    /// Adds a node for each group of meshes: a root if the group has a skin, otherwise a child of the bone that it follows.
    fn add_meshes(&mut self, model: &Model) -> Result<(), InputError> {
        let mirrored = mirrored(&model.skeleton);
        for Group { name, meshes, is_skinned } in groups(model) {
            let first = &model.meshes[meshes.start];
            let skin = &model.skins[first.skin];
            let mirrors = mirrors(&mirrored, skin);
            let primitives = model.meshes[meshes.clone()].iter().map(|mesh| {
                let material = self.materials.index(model, mesh, &mut self.binary)?;
                Ok(meshes::primitive(mesh, is_skinned, &mirrors, material, &mut self.binary))
            });
            let primitives = primitives.collect::<Result<Vec<_>, InputError>>()?;
            let mut mesh = json!({ "name": name, "primitives": primitives });
            if !first.weights.is_empty() {
                mesh["weights"] = json!(first.weights);
            }
            let mut node = json!({ "name": name, "mesh": push(&mut self.meshes, mesh) });
            let bone = skin.bones.first().copied().filter(|_| !is_skinned);
            if bone.is_some() {
                node["matrix"] = json!(skin.inverse_binds[0]);
            } else {
                node["skin"] = json!(first.skin);
                self.shared = self.shared.max(first.skin + 1);
            }
            let at = self.add_node(bone, node);
            if !first.weight_keys.is_empty() {
                self.weighted.push((at, meshes.start));
            }
        }
        Ok(())
    }

    /// Adds the skins that are written, with their inverse bind matrices.
    fn add_skins(&mut self, model: &Model) -> Result<(), InputError> {
        for (at, skin) in model.skins[..self.shared].iter().enumerate() {
            InputError::check_most(format!("skins[{at}].bones.len"), skin.bones.len(), MAX_JOINTS)?;
            let binds = self.binary.floats(&skin.inverse_binds, false);
            self.skins.push(json!({ "name": skin.name, "joints": skin.bones, "inverseBindMatrices": binds }));
        }
        Ok(())
    }

    fn finish(self, clips: Vec<Value>) -> Result<Vec<u8>, InputError> {
        let Self { binary, nodes, roots, meshes, skins, materials, .. } = self;
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("relievo ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": roots }],
            "nodes": nodes,
        });
        // glTF forbids empty lists.
        let lists = [
            ("meshes", meshes),
            ("skins", skins),
            ("animations", clips),
            ("materials", materials.materials),
            ("textures", materials.textures),
            ("samplers", materials.samplers),
            ("images", materials.images),
            ("accessors", binary.accessors),
            ("bufferViews", binary.views),
        ];
        for (name, list) in lists {
            if !list.is_empty() {
                root[name] = Value::Array(list);
            }
        }
        if !binary.bytes.is_empty() {
            root["buffers"] = json!([{ "byteLength": binary.bytes.len() }]);
        }
        container(root.to_string().into_bytes(), binary.bytes)
    }
}

/// Packs a document's JSON and its buffer into a GLB (glTF 2.0, chapter 4).
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, InputError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    InputError::check_most("GLB.length", length, MAX_BYTES)?;
    let mut glb = Vec::with_capacity(length);
    glb.extend_from_slice(b"glTF");
    let words = |glb: &mut Vec<u8>, all: [u32; 2]| all.iter().for_each(|word| glb.extend(word.to_le_bytes()));
    words(&mut glb, [2, length as u32]);
    words(&mut glb, [json.len() as u32, u32::from_le_bytes(*b"JSON")]);
    glb.extend(json);
    if !binary.is_empty() {
        words(&mut glb, [binary.len() as u32, u32::from_le_bytes(*b"BIN\0")]);
        glb.extend(binary);
    }
    Ok(glb)
}
