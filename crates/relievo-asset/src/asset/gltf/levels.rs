//! Levels of detail of nodes (`MSFT_lod`): which nodes take the place of others at each level.

use gltf_json::scene::{Node, Scene};
use gltf_json::{Index, Root};
use serde::Deserialize;

use super::document::Document;
use super::extensions::{LOD, extension};
use crate::InputError;

/// Largest number of levels of an object of a scene, as in `wgsl/lod/object.wgsl`.
#[doc(hidden)]
pub const OBJECT_LEVELS: usize = 8;

/// Largest number of coarser levels of a node.
const MOST: usize = OBJECT_LEVELS - 1;

/// The levels of detail of a document's nodes.
pub struct Lods {
    /// For each node, the nodes that take its place at levels 1, 2 …; empty for a node without levels.
    ids: Vec<Vec<usize>>,
}

#[derive(Deserialize)]
struct Lod {
    ids: Vec<usize>,
}

impl Lods {
    /// Reads and checks the levels of all nodes.
    ///
    /// # Errors
    /// [`InputError`] for lists that are empty or too long, and for nodes that cannot be levels: nodes that do not exist, have
    /// levels themselves, are listed twice, are children, or lie in the scene.
    pub fn new(document: &Document<'_>) -> Result<Self, InputError> {
        let given = document.extensions.lods.iter().enumerate().map(|(node, given)| {
            let Some(given) = given else { return Ok(Vec::new()) };
            Ok(extension::<Lod>(given, LOD, &format!("nodes[{node}]"))?.map_or(Vec::new(), |lod| lod.ids))
        });
        let lods = Self { ids: given.collect::<Result<_, InputError>>()? };
        lods.check(&document.root, &document.extensions.lods)?;
        Ok(lods)
    }

    fn check(&self, root: &Root, given: &[Option<serde_json::Value>]) -> Result<(), InputError> {
        let nodes = root.nodes.len();
        let mut parent = vec![None; nodes];
        for (at, node) in root.nodes.iter().enumerate() {
            children(node).for_each(|child| parent[child] = Some(at));
        }
        let mut in_scene = vec![false; nodes];
        if !root.scenes.is_empty() {
            default_scene(root).into_iter().for_each(|node| in_scene[node] = true);
        }
        let mut listed = vec![None; nodes];
        for (node, ids) in self.ids.iter().enumerate().filter(|(node, _)| given[*node].is_some()) {
            let path = format!("nodes[{node}].extensions.{LOD}.ids");
            InputError::check_within(format!("{path}.len"), ids.len(), 1..=MOST)?;
            for (at, id) in ids.iter().enumerate() {
                let path = format!("{path}[{at}]");
                InputError::check_below(&path, *id, nodes)?;
                let bound = match (parent[*id], listed[*id]) {
                    _ if *id == node => "must be another node".to_owned(),
                    _ if given[*id].is_some() => "must be a node without levels".to_owned(),
                    (_, Some(other)) => format!("must be listed once, and nodes[{other}] lists it"),
                    (Some(parent), _) => format!("must be no child, and nodes[{parent}] is its parent"),
                    _ if in_scene[*id] => {
                        format!("must not be in the scene, where it takes the place of nodes[{node}]")
                    }
                    _ => {
                        listed[*id] = Some(node);
                        continue;
                    }
                };
                return Err(InputError::new(path, id, bound));
            }
        }
        Ok(())
    }

    /// The nodes that lie in the scene and have levels, without those below others. The scene is that of [`Self::choose`].
    fn topmost(&self, root: &Root) -> Vec<usize> {
        let mut waiting = default_scene(root);
        let (mut found, mut seen) = (Vec::new(), vec![false; root.nodes.len()]);
        while let Some(node) = waiting.pop() {
            if std::mem::replace(&mut seen[node], true) {
                continue;
            }
            match self.ids[node].is_empty() {
                true => waiting.extend(children(&root.nodes[node])),
                false => found.push(node),
            }
        }
        found
    }

    /// Number of levels: 1 without the extension.
    pub fn levels(&self, root: &Root) -> usize {
        self.topmost(root).into_iter().map(|node| self.ids[node].len()).max().unwrap_or(0) + 1
    }

    /// Changes the document to one level. A node with fewer levels keeps its last one.
    ///
    /// The nodes of finer levels stay, because skins may name joints below them, but they lose their meshes. The node of the
    /// level becomes their next sibling.
    pub fn choose(&self, root: &mut Root, level: usize) {
        if root.scenes.is_empty() {
            let is_level = |node: &usize| self.ids.iter().flatten().any(|id| id == node);
            let nodes = default_scene(root).into_iter().filter(|node| !is_level(node)).map(index).collect();
            root.scenes.push(Scene { extensions: None, extras: Default::default(), name: None, nodes });
        }
        if level == 0 {
            return;
        }
        for node in self.topmost(root) {
            let mut waiting = vec![node];
            let mut seen = vec![false; root.nodes.len()];
            while let Some(below) = waiting.pop() {
                if !std::mem::replace(&mut seen[below], true) {
                    root.nodes[below].mesh = None;
                    waiting.extend(children(&root.nodes[below]));
                }
            }
            let ids = &self.ids[node];
            let coarse = index(ids[level.min(ids.len()) - 1]);
            let scene = root.scene.map_or(0, |scene| scene.value());
            let lists = root.nodes.iter_mut().filter_map(|node| node.children.as_mut());
            for list in lists.chain(root.scenes.get_mut(scene).map(|scene| &mut scene.nodes)) {
                if let Some(at) = list.iter().position(|other| other.value() == node) {
                    list.insert(at + 1, coarse);
                }
            }
        }
    }
}

fn index(node: usize) -> Index<Node> {
    Index::new(node as u32)
}

fn children(node: &Node) -> impl Iterator<Item = usize> + '_ {
    node.children.iter().flatten().map(|child| child.value())
}

/// The roots of the default scene. Without scenes, all nodes that are no children.
fn default_scene(root: &Root) -> Vec<usize> {
    match root.scenes.get(root.scene.map_or(0, |scene| scene.value())) {
        Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
        None => {
            let mut is_root = vec![true; root.nodes.len()];
            root.nodes.iter().flat_map(children).for_each(|child| is_root[child] = false);
            (0..root.nodes.len()).filter(|node| is_root[*node]).collect()
        }
    }
}
