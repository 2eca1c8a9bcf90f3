//! Thesis B's JSON of a level of detail (table 4.5), and of the difference between two levels (§4.3).
//!
//! All meshes of a model are one mesh here, in the rest pose. Level 0 is the finest, as in thesis B. Vertices have the order in
//! which levels add them, the coarsest level first: so a finer level appends vertices, and replaces the list of indices.

use relievo::InputError;
use relievo::asset::Mesh;
use relievo::asset::package::{Package, PackageHeader};
use relievo::ops::skinning::at_rest;
use serde::{Deserialize, Serialize};

/// A mesh at one level of detail.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MeshJson {
    /// x, y and z of each vertex, in the model's units.
    pub vertex_positions: Vec<f32>,
    /// x, y and z of each vertex's normal.
    pub vertex_normals: Vec<f32>,
    /// u and v of each vertex; v points down the image.
    pub vertex_texture_coords: Vec<f32>,
    /// Three vertices per triangle.
    pub indices: Vec<u32>,
}

/// What changes a mesh at a coarser level into the mesh at a finer one.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct MeshDifference {
    /// Vertices of the coarser level whose attributes change, ascending.
    pub substituted: Vec<u32>,
    /// Attributes of the substituted vertices, then those of the appended ones.
    pub vertex_positions: Vec<f32>,
    /// As [`MeshJson::vertex_normals`].
    pub vertex_normals: Vec<f32>,
    /// As [`MeshJson::vertex_texture_coords`].
    pub vertex_texture_coords: Vec<f32>,
    /// The indices of the finer level, which replace those of the coarser one.
    pub indices: Vec<u32>,
}

impl MeshJson {
    /// Reads level `level` of a package, 0 for the finest. Later bytes of the package may be missing.
    ///
    /// # Errors
    /// [`InputError`] for a level that the package does not have, and for missing or damaged bytes.
    pub fn of_package(bytes: &[u8], level: usize) -> Result<Self, InputError> {
        let (header, _) = PackageHeader::read(bytes)?;
        let count = header.levels.len();
        check(level < count, "level", level, || format!("must be below {count}"))?;
        let mut package = Package::new(bytes)?;
        let mut added = Vec::new();
        for (at, level) in header.levels[..count - level].iter().enumerate() {
            let Some(chunk) = bytes.get(level.chunk.range()) else {
                let bound =
                    format!("must be at least {}, the end of level {}", level.chunk.end, count - 1 - at);
                return Err(InputError::new("package.len", bytes.len(), bound));
            };
            package.add_level(chunk)?;
            added.push(package.mesh_vertices());
        }
        Ok(Self::of_meshes(&at_rest(&package.model()?)?.meshes, &added))
    }

    /// One mesh of all meshes of a model. `added` has, for each level from the coarsest on, the number of vertices of each mesh.
    fn of_meshes(meshes: &[Mesh], added: &[Vec<usize>]) -> Self {
        let mut all = Self::default();
        let mut numbers: Vec<Vec<u32>> = vec![Vec::new(); meshes.len()];
        for counts in added {
            for ((mesh, numbers), end) in meshes.iter().zip(&mut numbers).zip(counts) {
                for vertex in numbers.len()..*end {
                    numbers.push(all.vertices() as u32);
                    all.vertex_positions.extend(mesh.positions[vertex]);
                    all.vertex_normals.extend(mesh.normals[vertex]);
                    all.vertex_texture_coords.extend(mesh.uv[vertex]);
                }
            }
        }
        for (mesh, numbers) in meshes.iter().zip(&numbers) {
            all.indices.extend(mesh.indices.iter().map(|vertex| numbers[*vertex as usize]));
        }
        all
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.vertex_positions.len() / 3
    }

    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// Checks that the lists have matching lengths, and that indices are below the number of vertices.
    ///
    /// # Errors
    /// [`InputError`] with the name of the list in JSON.
    pub fn validate(&self) -> Result<(), InputError> {
        let vertices = self.vertices();
        check_lengths(vertices, &self.vertex_positions, &self.vertex_normals, &self.vertex_texture_coords)?;
        check_indices(&self.indices, vertices)
    }

    /// The difference from a coarser level to this one.
    ///
    /// # Errors
    /// [`InputError`] if the coarser level has more vertices.
    pub fn difference_from(&self, coarser: &Self) -> Result<MeshDifference, InputError> {
        let (from, to) = (coarser.vertices(), self.vertices());
        let bound = || format!("must be at most {to}, the number of the finer level");
        check(from <= to, "coarser.vertices", from, bound)?;
        let is_same = |at: usize| {
            let bits = |mesh: &Self| mesh.vertex(at).map(f32::to_bits);
            bits(self) == bits(coarser)
        };
        let substituted: Vec<u32> = (0..from).filter(|at| !is_same(*at)).map(|at| at as u32).collect();
        let mut difference =
            MeshDifference { substituted, indices: self.indices.clone(), ..MeshDifference::default() };
        let changed = difference.substituted.iter().map(|at| *at as usize).chain(from..to);
        for at in changed.collect::<Vec<_>>() {
            let [x, y, z, a, b, c, u, v] = self.vertex(at);
            difference.vertex_positions.extend([x, y, z]);
            difference.vertex_normals.extend([a, b, c]);
            difference.vertex_texture_coords.extend([u, v]);
        }
        Ok(difference)
    }

    /// Changes this level into a finer one. After an error, the level is unchanged.
    ///
    /// # Errors
    /// [`InputError`] for lists whose lengths do not match, and for vertices that do not exist.
    pub fn apply(&mut self, difference: &MeshDifference) -> Result<(), InputError> {
        let MeshDifference { substituted, vertex_positions, vertex_normals, vertex_texture_coords, indices } =
            difference;
        let changed = vertex_positions.len() / 3;
        check_lengths(changed, vertex_positions, vertex_normals, vertex_texture_coords)?;
        let bound = || format!("must be at most {changed}, the number of vertices");
        check(substituted.len() <= changed, "substituted.len", substituted.len(), bound)?;
        for (at, vertex) in substituted.iter().enumerate() {
            let bound = || format!("must be below {}, the number of vertices", self.vertices());
            check(
                (*vertex as usize) < self.vertices(),
                &format!("substituted[{at}]"),
                *vertex as usize,
                bound,
            )?;
        }
        let appended = changed - substituted.len();
        check_indices(indices, self.vertices() + appended)?;
        for (at, vertex) in substituted.iter().enumerate() {
            let vertex = *vertex as usize;
            self.vertex_positions[3 * vertex..][..3].copy_from_slice(&vertex_positions[3 * at..][..3]);
            self.vertex_normals[3 * vertex..][..3].copy_from_slice(&vertex_normals[3 * at..][..3]);
            self.vertex_texture_coords[2 * vertex..][..2]
                .copy_from_slice(&vertex_texture_coords[2 * at..][..2]);
        }
        let first = substituted.len();
        self.vertex_positions.extend(&vertex_positions[3 * first..]);
        self.vertex_normals.extend(&vertex_normals[3 * first..]);
        self.vertex_texture_coords.extend(&vertex_texture_coords[2 * first..]);
        self.indices.clone_from(indices);
        Ok(())
    }

    /// Position, normal and texture coordinates of a vertex.
    fn vertex(&self, at: usize) -> [f32; 8] {
        std::array::from_fn(|field| match field {
            0..3 => self.vertex_positions[3 * at + field],
            3..6 => self.vertex_normals[3 * at + field - 3],
            _ => self.vertex_texture_coords[2 * at + field - 6],
        })
    }
}

fn check_lengths(vertices: usize, positions: &[f32], normals: &[f32], uv: &[f32]) -> Result<(), InputError> {
    let lists = [
        ("vertexPositions", positions.len(), 3),
        ("vertexNormals", normals.len(), 3),
        ("vertexTextureCoords", uv.len(), 2),
    ];
    lists.into_iter().try_for_each(|(name, length, each)| {
        let bound = || format!("must be {}, {each} numbers for each vertex", each * vertices);
        check(length == each * vertices, &format!("{name}.len"), length, bound)
    })
}

fn check_indices(indices: &[u32], vertices: usize) -> Result<(), InputError> {
    let bound = || "must be a multiple of 3".to_owned();
    check(indices.len().is_multiple_of(3), "indices.len", indices.len(), bound)?;
    match indices.iter().position(|index| *index as usize >= vertices) {
        Some(at) => {
            let bound = format!("must be below {vertices}, the number of vertices");
            Err(InputError::new(format!("indices[{at}]"), indices[at], bound))
        }
        None => Ok(()),
    }
}

fn check(is_good: bool, path: &str, value: usize, bound: impl FnOnce() -> String) -> Result<(), InputError> {
    if is_good { Ok(()) } else { Err(InputError::new(path, value, bound())) }
}
