//! Splits meshes that exceed a binding of the device into pieces. A piece holds triangles of one level of detail. If
//! the next triangle would exceed the vertices or indices that a piece may have, a new piece begins. Each piece has
//! vertices of its own.

use std::collections::HashMap;
use std::ops::Range;

use crate::asset::{Influences, Mesh, Model};
use crate::skinning::character_levels::own_levels;
use crate::skinning::merged::{Merged, Part};

/// The largest number of vertices and of indices in a piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Most {
    pub vertices: usize,
    pub indices: usize,
}

impl Most {
    /// Whether a mesh with all of its levels stays within these numbers.
    pub fn holds(self, mesh: &Mesh) -> bool {
        mesh.vertices() <= self.vertices && indices_of_levels(mesh) <= self.indices
    }
}

/// The number of indices of a mesh, summed over all of its levels.
pub(super) fn indices_of_levels(mesh: &Mesh) -> usize {
    mesh.indices.len() + mesh.levels.iter().map(|level| level.indices.len()).sum::<usize>()
}

/// Splits a merged mesh at rest into pieces. A piece is a mesh without levels, and each of its parts is drawn at one
/// level of the whole mesh. The triangles of a level keep their order, and vertices stay identical to the bit.
pub(super) fn pieces(merged: &Merged, index: usize, most: Most) -> Merged {
    let whole = &merged.model.meshes[index];
    let own = own_levels(whole, &merged.errors);
    let mut all = Merged {
        model: Model {
            skeleton: merged.model.skeleton.clone(),
            skins: merged.model.skins.clone(),
            clips: Vec::new(),
            motion: None,
            meshes: Vec::new(),
            skinned: 0,
            materials: Vec::new(),
            images: Vec::new(),
        },
        errors: merged.errors.clone(),
        materials: Vec::new(),
        sources: Vec::new(),
        parts: Vec::new(),
    };
    for (level, own) in own.iter().enumerate() {
        let triangles = whole.triangles(*own);
        let parts = merged.parts.iter().filter(|part| part.mesh == index);
        let mut piece = Piece::default();
        for part in parts {
            let Range { start, end } = part.indices[level];
            for triangle in triangles[start as usize..end as usize].chunks_exact(3) {
                if !piece.has_room(triangle, most) {
                    std::mem::take(&mut piece).finish(merged, index, level, &mut all);
                }
                piece.add(triangle, part);
            }
        }
        piece.finish(merged, index, level, &mut all);
    }
    all
}

/// A piece under construction.
#[derive(Default)]
struct Piece<'a> {
    /// Maps vertices of the whole mesh to vertices of the piece.
    slots: HashMap<u32, u32>,
    /// Maps vertices of the piece to vertices of the whole mesh.
    vertices: Vec<u32>,
    indices: Vec<u32>,
    /// Parts with triangles in the piece, each with the end of its range in `indices`.
    parts: Vec<(&'a Part, u32)>,
}

impl<'a> Piece<'a> {
    fn has_room(&self, triangle: &[u32], most: Most) -> bool {
        let new = triangle.iter().filter(|vertex| !self.slots.contains_key(vertex)).count();
        self.vertices.len() + new <= most.vertices && self.indices.len() + 3 <= most.indices
    }

    fn add(&mut self, triangle: &[u32], part: &'a Part) {
        for vertex in triangle {
            let slot = *self.slots.entry(*vertex).or_insert_with(|| {
                self.vertices.push(*vertex);
                self.vertices.len() as u32 - 1
            });
            self.indices.push(slot);
        }
        let end = self.indices.len() as u32;
        match self.parts.last_mut() {
            Some((last, to)) if std::ptr::eq(*last, part) => *to = end,
            _ => self.parts.push((part, end)),
        }
    }

    /// Appends the piece to `all`, as a mesh whose parts are drawn only at `level`.
    fn finish(self, merged: &Merged, index: usize, level: usize, all: &mut Merged) {
        let (whole, mesh) = (&merged.model.meshes[index], all.model.meshes.len());
        let mut begin = 0;
        for (part, end) in &self.parts {
            let mut indices = vec![0..0; part.indices.len()];
            indices[level] = begin..*end;
            all.parts.push(Part { mesh, key: part.key, indices });
            begin = *end;
        }
        if self.indices.is_empty() {
            return;
        }
        let (materials, sources) = (&merged.materials[index], &merged.sources[index]);
        all.materials.push(self.vertices.iter().map(|vertex| materials[*vertex as usize]).collect());
        all.sources.push(self.vertices.iter().map(|vertex| sources[*vertex as usize]).collect());
        all.model.meshes.push(Mesh {
            name: whole.name.clone(),
            skin: whole.skin,
            positions: self.taken(&whole.positions),
            normals: self.taken(&whole.normals),
            tangents: self.taken(&whole.tangents),
            uv: self.taken(&whole.uv),
            indices: self.indices,
            double_sided: whole.double_sided,
            material: whole.material,
            influences: Influences::rigid(self.vertices.len()),
            ..Mesh::default()
        });
    }

    /// The values of the piece's vertices, taken from the values of all vertices of the whole mesh.
    fn taken<T: Copy>(&self, of_whole: &[T]) -> Vec<T> {
        self.vertices.iter().map(|vertex| of_whole[*vertex as usize]).collect()
    }
}
