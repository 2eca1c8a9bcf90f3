//! Partners of vertices: where a vertex goes in the first level that lacks it.

use std::collections::HashMap;

/// What became of a level's vertices.
pub(crate) struct Became<'a> {
    /// The triangles of the level, three indices each.
    pub indices: &'a [u32],
    /// For each vertex of the level before, the vertex into which it has collapsed.
    pub remap: &'a [u32],
}

/// The partner of each vertex ([`Mesh::partners`](crate::asset::Mesh::partners)), from the levels 1, 2 …; `finest` are the
/// triangles of level 0. `place` gives the mesh of a vertex, and the place at which it lies, the same number for all vertices
/// there.
///
/// A vertex whose triangles vanish may have collapsed into one without triangles at that level, or into one of another mesh.
/// Another vertex of its own mesh at that place then serves, since places are all that counts for triangles without area. If
/// there is none, one vertex serves for all that go to that place.
pub(crate) fn partners(
    finest: &[u32],
    levels: &[Became<'_>],
    place: impl Fn(u32) -> (u32, u32),
    vertices: usize,
) -> Vec<u32> {
    let mut partners: Vec<u32> = (0..vertices as u32).collect();
    let mut finer = finest;
    for Became { indices, remap } in levels {
        let mut here = vec![false; vertices];
        indices.iter().for_each(|vertex| here[*vertex as usize] = true);
        let target = |vertex: u32| remap[vertex as usize];
        let key = |vertex: u32| (place(vertex).0, place(target(vertex)).1);
        let is_kept = |to: u32, vertex: u32| here[to as usize] && place(to).0 == place(vertex).0;
        let mut standing: HashMap<(u32, u32), u32> = HashMap::new();
        for vertex in *indices {
            let first = standing.entry(place(*vertex)).or_insert(*vertex);
            *first = (*first).min(*vertex);
        }
        let gone = || finer.iter().copied().filter(|vertex| !here[*vertex as usize]);
        // Of those that serve for others, one that lies there already comes first.
        for is_there in [true, false] {
            for vertex in gone().filter(|vertex| !is_kept(target(*vertex), *vertex)) {
                if !is_there || key(vertex) == place(vertex) {
                    standing.entry(key(vertex)).or_insert(vertex);
                }
            }
        }
        for vertex in gone() {
            let to = target(vertex);
            partners[vertex as usize] =
                if is_kept(to, vertex) { to } else { standing.get(&key(vertex)).copied().unwrap_or(vertex) };
        }
        finer = indices;
    }
    partners
}
