//! The scene: the nodes that are imported, and the trees that nodes form (glTF 2.0, section 3.5.2).

use gltf_json::Root;
use gltf_json::scene::Node;

use crate::InputError;

/// The nodes of the default scene.
pub struct Scene {
    /// For each node of the document, its parent. `None` for nodes without a parent, and for nodes that the scene lists as
    /// roots.
    pub parents: Vec<Option<usize>>,
    /// For each node of the document, whether it lies in the scene.
    pub contains: Vec<bool>,
}

impl Scene {
    /// Reads the default scene that the document names, or else its first scene. If the document has no scene, the result
    /// contains all nodes.
    ///
    /// # Errors
    /// [`InputError`] for nodes that do not form trees, and for a scene whose root node has a parent in the scene.
    pub fn new(root: &Root) -> Result<Self, InputError> {
        let mut parents = parents(&root.nodes)?;
        let roots: Vec<usize> = (0..parents.len()).filter(|node| parents[*node].is_none()).collect();
        let reached = below(&root.nodes, &roots);
        // A node that is its own ancestor is not below any root.
        if let Some(node) = reached.iter().position(|reached| !reached) {
            let bound = "must not lie below itself: nodes are trees";
            return Err(InputError::new(format!("nodes[{node}]"), node, bound));
        }
        let default = root.scene.map_or(0, |scene| scene.value());
        let Some(scene) = root.scenes.get(default) else { return Ok(Self { parents, contains: reached }) };
        let roots: Vec<usize> = scene.nodes.iter().map(|node| node.value()).collect();
        let contains = below(&root.nodes, &roots);
        for (at, node) in roots.iter().enumerate() {
            // Some exporters list a node as a root although its parent is a node outside of the scene. Such a
            // parent is ignored, as in three.js.
            if parents[*node].take().is_some_and(|parent| contains[parent]) {
                let bound = "must be a root, and no node's child";
                return Err(InputError::new(format!("scenes[{default}].nodes[{at}]"), node, bound));
            }
        }
        Ok(Self { parents, contains })
    }

    /// For each node, whether it is in `nodes` or is an ancestor of such a node.
    pub fn with_ancestors(&self, nodes: &[usize]) -> Vec<bool> {
        let mut marked = vec![false; self.parents.len()];
        for node in nodes {
            let mut next = Some(*node);
            while let Some(node) = next.filter(|node| !std::mem::replace(&mut marked[*node], true)) {
                next = self.parents[node];
            }
        }
        marked
    }

    /// Children of a node. Nodes that the scene lists as roots are left out.
    pub fn children<'a>(
        &'a self,
        nodes: &'a [Node],
        node: usize,
    ) -> impl DoubleEndedIterator<Item = usize> + 'a {
        let children = nodes[node].children.iter().flatten().map(|child| child.value());
        children.filter(move |child| self.parents[*child] == Some(node))
    }
}

/// For each node, its parent. Refuses a node with two parents.
fn parents(nodes: &[Node]) -> Result<Vec<Option<usize>>, InputError> {
    let mut parents = vec![None; nodes.len()];
    for (parent, node) in nodes.iter().enumerate() {
        for (at, child) in node.children.iter().flatten().enumerate() {
            let child = child.value();
            if let Some(other) = parents[child].replace(parent) {
                let path = format!("nodes[{parent}].children[{at}]");
                let bound = format!("must have one parent, and nodes[{other}] is it");
                return Err(InputError::new(path, child, bound));
            }
        }
    }
    Ok(parents)
}

/// For each node, whether it is in `roots` or is a descendant of such a node.
fn below(nodes: &[Node], roots: &[usize]) -> Vec<bool> {
    let mut reached = vec![false; nodes.len()];
    let mut waiting = roots.to_vec();
    while let Some(node) = waiting.pop() {
        if !std::mem::replace(&mut reached[node], true) {
            waiting.extend(nodes[node].children.iter().flatten().map(|child| child.value()));
        }
    }
    reached
}
