//! Partners of vertices. The partner of a vertex replaces it in the first level that lacks the vertex.

use std::collections::HashMap;

/// A level, and the replacements of the previous level's vertices.
#[doc(hidden)]
pub struct Became<'a> {
    /// Triangles of the level, three indices each.
    pub indices: &'a [u32],
    /// For each vertex of the previous level, the vertex into which it has collapsed.
    pub remap: &'a [u32],
}

/// The partner of each vertex ([`Mesh::partners`](crate::asset::Mesh::partners)). `finest` has the triangles of level
/// 0. `levels` has the levels 1, 2, …. `place` returns the mesh of a vertex, and a number for its position. All
/// vertices at one position have the same number.
///
/// A vertex may have collapsed into a target that no triangle of the level uses, or that belongs to another mesh. This
/// happens if all triangles of the vertex vanish. In this case, the partner is another vertex of the same mesh, at the
/// target's position. This is valid because the vanished triangles only need to become degenerate. This depends only on
/// positions. If no such vertex exists, one of the vertices that collapsed to this position becomes the partner of the
/// others.
#[doc(hidden)]
pub fn partners(
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
        // A vertex that already lies at the target's position is preferred as the partner.
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
