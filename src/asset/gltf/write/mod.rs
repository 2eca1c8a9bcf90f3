//! Writes a model as binary glTF 2.0.

mod binary;
mod clips;
mod materials;
mod meshes;

use serde_json::{Value, json};

use super::winding::{mirrored, mirrors};
use crate::InputError;
use crate::asset::Model;
use crate::asset::skeleton::Skin;
use binary::Binary;
use materials::Materials;
use meshes::{Group, groups};

/// The most bytes of a GLB, whose lengths have 32 bits.
const MAX_BYTES: usize = u32::MAX as usize;

/// The most joints of a skin, whose numbers have 16 bits in vertices.
const MAX_JOINTS: usize = 1 << 16;

impl Model {
    /// The model as binary glTF (`.glb`): skeleton, skins, meshes with morph targets, clips, materials and images.
    ///
    /// [`Model::from_gltf`] reads equal meshes, skins and materials back, all numbers to the bit, if the model was read from
    /// glTF or OBJ: positions, normals, tangents, texture coordinates, triangles, influences up to the rounding of weights
    /// that do not sum to 1, keys of clips. Bones that neither skins, meshes nor clips need are not read again, bones may
    /// have another order, tangents of cubic splines and rotations may differ in the last bit, and a clip lasts until its last
    /// key. [`Alpha::Blended`](crate::asset::material::Alpha::Blended) comes back as the pattern of `BLEND`. Images are PNG.
    /// Metal and roughness, which models do not have, are 0 and 1. Levels of detail and lights are not written; clips
    /// without keys are left out.
    ///
    /// # Errors
    /// [`InputError`] for a mesh, a skin or a material that is not valid, for images that PNG cannot hold, and for
    /// more than 4 GiB.
    pub fn to_glb(&self) -> Result<Vec<u8>, InputError> {
        (0..self.skins.len()).try_for_each(|skin| self.check_skin(skin))?;
        (0..self.meshes.len()).try_for_each(|mesh| self.check_mesh(mesh))?;
        let mut document = Document::new(self);
        document.add_meshes(self)?;
        document.add_skins(self)?;
        let clips = clips::clips(self, &document.weighted, &mut document.binary);
        document.finish(clips)
    }
}

/// A document as it grows. Nodes are the bones, in their order, followed by those of meshes.
struct Document {
    binary: Binary,
    nodes: Vec<Value>,
    children: Vec<Vec<usize>>,
    roots: Vec<usize>,
    meshes: Vec<Value>,
    skins: Vec<Value>,
    materials: Materials,
    /// Nodes whose meshes have animated weights, with their first mesh.
    weighted: Vec<(usize, usize)>,
    /// How many skins, from the first on, are written; the others are matrices of nodes.
    shared: usize,
}

impl Document {
    /// A document with a node for each bone.
    fn new(model: &Model) -> Self {
        let bones = model.skeleton.bones();
        let node = |bone: &crate::asset::Bone| {
            let rest = &bone.rest;
            json!({
                "name": bone.name,
                "translation": rest.translation,
                "rotation": rest.rotation,
                "scale": rest.scale,
            })
        };
        let mut children = vec![Vec::new(); bones.len()];
        let mut roots = Vec::new();
        for (at, bone) in bones.iter().enumerate() {
            match bone.parent {
                Some(parent) => children[parent as usize].push(at),
                None => roots.push(at),
            }
        }
        Self {
            binary: Binary::default(),
            nodes: bones.iter().map(node).collect(),
            children,
            roots,
            meshes: Vec::new(),
            skins: Vec::new(),
            materials: Materials::default(),
            weighted: Vec::new(),
            shared: 0,
        }
    }

    /// Adds a node for each group of meshes: at the root if it has a skin of the file, and below its bone otherwise.
    fn add_meshes(&mut self, model: &Model) -> Result<(), InputError> {
        let mirrored = mirrored(&model.skeleton);
        for group in groups(model) {
            let first = &model.meshes[group.meshes.start];
            let skin = &model.skins[first.skin];
            let mirrors = mirrors(&mirrored, skin);
            let primitives = model.meshes[group.meshes.clone()].iter().map(|mesh| {
                let material = self.materials.index(model, mesh, &mut self.binary)?;
                Ok(meshes::primitive(mesh, group.is_skinned, &mirrors, material, &mut self.binary))
            });
            let primitives = primitives.collect::<Result<Vec<_>, InputError>>()?;
            let mut mesh = json!({ "name": group.name, "primitives": primitives });
            if !first.weights.is_empty() {
                mesh["weights"] = json!(first.weights);
            }
            self.meshes.push(mesh);
            self.add_node(&group, skin, first.skin, model);
        }
        Ok(())
    }

    fn add_node(&mut self, group: &Group, skin: &Skin, index: usize, model: &Model) {
        let at = self.nodes.len();
        let mut node = json!({ "name": group.name, "mesh": self.meshes.len() - 1 });
        match (group.is_skinned, skin.bones.first()) {
            (false, Some(bone)) => {
                node["matrix"] = json!(skin.inverse_binds[0]);
                self.children[*bone as usize].push(at);
            }
            _ => {
                node["skin"] = json!(index);
                self.shared = self.shared.max(index + 1);
                self.roots.push(at);
            }
        }
        self.nodes.push(node);
        self.children.push(Vec::new());
        if !model.meshes[group.meshes.start].weight_keys.is_empty() {
            self.weighted.push((at, group.meshes.start));
        }
    }

    /// Adds the skins that meshes share.
    fn add_skins(&mut self, model: &Model) -> Result<(), InputError> {
        for (at, skin) in model.skins[..self.shared].iter().enumerate() {
            if skin.bones.len() > MAX_JOINTS {
                let bound = format!("must be at most {MAX_JOINTS}");
                return Err(InputError::new(format!("skins[{at}].bones.len"), skin.bones.len(), bound));
            }
            let binds = self.binary.floats("MAT4", &skin.inverse_binds, false);
            self.skins.push(json!({ "name": skin.name, "joints": skin.bones, "inverseBindMatrices": binds }));
        }
        Ok(())
    }

    fn finish(self, clips: Vec<Value>) -> Result<Vec<u8>, InputError> {
        let Self { binary, mut nodes, children, roots, meshes, skins, materials, .. } = self;
        for (node, children) in nodes.iter_mut().zip(children) {
            if !children.is_empty() {
                node["children"] = json!(children);
            }
        }
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

/// A GLB of a document and its buffer (glTF 2.0, chapter 4).
fn container(mut json: Vec<u8>, mut binary: Vec<u8>) -> Result<Vec<u8>, InputError> {
    json.resize(json.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + json.len() + if binary.is_empty() { 0 } else { 8 + binary.len() };
    if length > MAX_BYTES {
        return Err(InputError::new("GLB.length", length, format!("must be at most {MAX_BYTES}")));
    }
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
