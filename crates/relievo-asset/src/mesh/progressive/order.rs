//! The vertex order that makes every level a prefix, and the permutation of meshes into this order.

use std::cmp::Reverse;

use crate::InputError;
use crate::asset::{Influences, Mesh, MeshLevel, MorphTarget};

/// The sorted vertices of a mesh. The keys are: coarsest level (coarse first), strongest bone, number of influences,
/// other bones, time of collapse (latest first), and index. `times` may be empty.
pub(super) fn order(mesh: &Mesh, times: &[u32]) -> Vec<u32> {
    let coarsest = mesh.coarsest_levels();
    let mut order: Vec<u32> = (0..mesh.vertices() as u32).collect();
    order.sort_by_cached_key(|vertex| {
        let at = *vertex as usize;
        let bones: Vec<u32> = mesh.influences.of(at).iter().map(|influence| influence.bone).collect();
        let time = Reverse(times.get(at).copied());
        (Reverse(coarsest[at]), bones.first().copied(), bones.len(), bones, time)
    });
    order
}

/// Permutes the vertices of a mesh. `order` has the old index of each new vertex.
pub(super) fn permuted(mesh: &Mesh, order: &[u32]) -> Result<Mesh, InputError> {
    let mut place = vec![0; order.len()];
    (0..).zip(order).for_each(|(at, vertex)| place[*vertex as usize] = at);
    let placed = |indices: &[u32]| indices.iter().map(|vertex| place[*vertex as usize]).collect::<Vec<u32>>();
    let level = |level: &MeshLevel| MeshLevel { indices: placed(&level.indices), error: level.error };
    let influences = order.iter().map(|vertex| mesh.influences.of(*vertex as usize).to_vec());
    Ok(Mesh {
        name: mesh.name.clone(),
        skin: mesh.skin,
        positions: taken(&mesh.positions, order),
        normals: taken(&mesh.normals, order),
        tangents: taken(&mesh.tangents, order),
        uv: taken(&mesh.uv, order),
        indices: placed(&mesh.indices),
        double_sided: mesh.double_sided,
        material: mesh.material,
        influences: Influences::stored("mesh.influences", influences)?,
        targets: mesh.targets.iter().map(|target| moved(target, &place)).collect(),
        weights: mesh.weights.clone(),
        weight_keys: mesh.weight_keys.clone(),
        error: mesh.error,
        levels: mesh.levels.iter().map(level).collect(),
        partners: if mesh.levels.is_empty() { Vec::new() } else { placed(&taken(&mesh.partners, order)) },
        ..Mesh::default()
    })
}

fn taken<T: Copy>(values: &[T], order: &[u32]) -> Vec<T> {
    order.iter().map(|vertex| values[*vertex as usize]).collect()
}

fn moved(target: &MorphTarget, place: &[u32]) -> MorphTarget {
    let all = target.vertices.iter().zip(&target.deltas);
    let mut all: Vec<_> = all.map(|(vertex, delta)| (place[*vertex as usize], *delta)).collect();
    all.sort_by_key(|(vertex, _)| *vertex);
    let (vertices, deltas) = all.into_iter().unzip();
    MorphTarget { vertices, deltas }
}
