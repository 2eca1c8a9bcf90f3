//! Meshes to simplify: terrain, blades of grass, and files.

use std::collections::HashMap;
use std::error::Error;
use std::f32::consts::TAU;
use std::path::Path;

use glam::{Vec2, Vec3};
use relievo::asset::model::Model;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::region;
use relievo::ops::terrain::window::Window;

#[path = "../levels/helmet.rs"]
mod helmet;

/// A triangle mesh with a normal at each vertex.
pub struct Mesh {
    pub name: String,
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates; empty for a mesh that has none.
    pub uv: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
}

impl Mesh {
    /// A mesh whose normals are sums of those of the triangles, weighted by their areas.
    fn smooth(name: &str, positions: Vec<[f32; 3]>, indices: Vec<u32>) -> Self {
        let mut sums = vec![Vec3::ZERO; positions.len()];
        for triangle in indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|corner| triangle[corner] as usize);
            let [a, b, c] = corners.map(|corner| Vec3::from(positions[corner]));
            corners.iter().for_each(|corner| sums[*corner] += (b - a).cross(c - a));
        }
        let normals = sums.iter().map(|sum| sum.normalize_or(Vec3::Y).into()).collect();
        Self { name: name.to_owned(), positions, normals, uv: Vec::new(), indices }
    }

    /// All meshes of a model at rest.
    fn of_model(name: &str, model: &Model) -> Self {
        let mut all = Self {
            name: name.to_owned(),
            positions: Vec::new(),
            normals: Vec::new(),
            uv: Vec::new(),
            indices: Vec::new(),
        };
        for mesh in &model.meshes {
            let first = all.positions.len() as u32;
            all.positions.extend(&mesh.positions);
            all.normals.extend(&mesh.normals);
            all.uv.extend(&mesh.uv);
            all.indices.extend(mesh.indices.iter().map(|index| first + index));
        }
        all
    }

    /// The mesh as `skinning::reduce_model` gives it to reducers, with its attributes, five numbers per vertex: vertices that
    /// differ only in their normals are one, with the mean of these by 0.05; and texture coordinates count by how far a
    /// texture slips over the surface. `None` for a mesh without texture coordinates.
    pub fn as_reduced(&self) -> Option<(Self, Vec<f32>)> {
        if self.uv.is_empty() {
            return None;
        }
        let mut known: HashMap<[u32; 5], u32> = HashMap::new();
        let mut welded = Self {
            name: self.name.clone(),
            positions: Vec::new(),
            normals: Vec::new(),
            uv: Vec::new(),
            indices: Vec::new(),
        };
        let mut sums: Vec<Vec3> = Vec::new();
        let slots: Vec<u32> = (0..self.positions.len())
            .map(|at| {
                let ([x, y, z], [u, v]) = (self.positions[at], self.uv[at]);
                let slot = *known
                    .entry([x, y, z, u, v].map(|one| (one + 0.0).to_bits()))
                    .or_insert(sums.len() as u32);
                if slot as usize == sums.len() {
                    sums.push(Vec3::ZERO);
                    welded.positions.push([x, y, z]);
                    welded.uv.push([u, v]);
                }
                sums[slot as usize] += Vec3::from(self.normals[at]);
                slot
            })
            .collect();
        welded.normals = sums.iter().map(|sum| sum.normalize_or(Vec3::Y).into()).collect();
        welded.indices = self.indices.iter().map(|at| slots[*at as usize]).collect();
        let (mut surface, mut texture) = (0.0, 0.0);
        for triangle in welded.indices.as_chunks::<3>().0 {
            let [a, b, c] = triangle.map(|at| Vec3::from(welded.positions[at as usize]));
            let [d, e, f] = triangle.map(|at| Vec2::from(welded.uv[at as usize]));
            surface += (b - a).cross(c - a).length();
            texture += (e - d).perp_dot(f - d).abs();
        }
        let corners = || welded.positions.iter().map(|position| Vec3::from(*position));
        let size = corners().fold(Vec3::MIN, Vec3::max).distance(corners().fold(Vec3::MAX, Vec3::min));
        let factor = (surface / texture).sqrt() / (0.03 * size);
        let factor = if factor.is_finite() { factor } else { 0.0 };
        let attributes = welded.normals.iter().zip(&welded.uv);
        let attributes =
            attributes.flat_map(|([x, y, z], [u, v])| [0.05 * x, 0.05 * y, 0.05 * z, factor * u, factor * v]);
        let attributes = attributes.collect();
        Some((welded, attributes))
    }

    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }
}

/// A square of `cells` × `cells` cells, two triangles each, with the height at (column, row).
fn grid(name: &str, cells: usize, height: impl Fn(usize, usize) -> f32) -> Mesh {
    let side = cells + 1;
    let positions = (0..side * side).map(|at| {
        let [column, row] = [at % side, at / side];
        [column as f32, height(column, row), row as f32]
    });
    let corner = |column: usize, row: usize| (row * side + column) as u32;
    let cell = |at: usize| {
        let [column, row] = [at % cells, at / cells];
        let [a, b] = [corner(column, row), corner(column, row + 1)];
        let [c, d] = [corner(column + 1, row), corner(column + 1, row + 1)];
        [a, b, c, c, b, d]
    };
    Mesh::smooth(name, positions.collect(), (0..cells * cells).flat_map(cell).collect())
}

/// Terrain of this crate's own, of about `triangles` triangles.
pub fn generated(triangles: usize) -> Result<Mesh, Box<dyn Error>> {
    let cells = ((triangles as f64 / 2.0).sqrt().round() as usize).max(2);
    let size = cells.next_power_of_two() as u32 + 1;
    let config = TerrainConfig::new(size, 40.0, "simplify")?;
    let heights = region(&config, &Features::default(), Window { patch: [0, 0], apron: 0 }.region(&config));
    let scale = config.scale_factor as f32 / 65_536.0;
    Ok(grid("terrain", cells, |column, row| heights[row * size as usize + column] as f32 * scale))
}

/// The middle of an elevation map, 16-bit grey, of about `triangles` triangles; samples are 30 units apart, and
/// heights are those of 236 to 1,076 units.
pub fn elevation(path: &Path, triangles: usize) -> Result<Mesh, Box<dyn Error>> {
    let image = image::open(path)?.into_luma16();
    let [width, rows] = [image.width(), image.height()].map(|edge| edge as usize);
    let cells = ((triangles as f64 / 2.0).sqrt().round() as usize).min(width.min(rows) - 1);
    let [left, top] = [width, rows].map(|edge| (edge - 1 - cells) / 2);
    let range = (1076.0 - 236.0) / 65_535.0 / 30.0;
    let at = |column: usize, row: usize| image.get_pixel((left + column) as u32, (top + row) as u32).0[0];
    Ok(grid("elevation", cells, |column, row| f32::from(at(column, row)) * range))
}

/// Blades of grass, open strips that taper to a point; each is 24 triangles.
pub fn grass(blades: usize) -> Mesh {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    let mut state = 1_u64;
    let mut random = || {
        state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    for _ in 0..blades {
        let root = Vec3::new(random() * 10.0, 0.0, random() * 10.0);
        let lean = Vec3::new(random() - 0.5, 0.0, random() - 0.5);
        let side = lean.cross(Vec3::Y).normalize_or(Vec3::X);
        let (length, width) = (0.5 + random(), 0.02 + 0.03 * random());
        let first = positions.len() as u32;
        for step in 0..12 {
            let along = step as f32 / 12.0;
            let middle = root + length * (Vec3::Y * (along - 0.3 * along * along) + lean * along * along);
            let half = side * (width * 0.5 * (1.0 - along * along));
            // A crease along the middle.
            positions.extend([middle - half, middle + half].map(<[f32; 3]>::from));
        }
        let tip = root + length * (Vec3::Y * 0.7 + lean);
        positions.push(tip.into());
        for step in 0..11 {
            let [a, b] = [first + 2 * step, first + 2 * step + 1];
            indices.extend([a, b, a + 2, b, b + 2, a + 2]);
        }
        indices.extend([first + 22, first + 23, first + 24]);
    }
    Mesh::smooth("grass", positions, indices)
}

/// The meshes of a glTF file at rest, or the triangles of an OBJ file.
pub fn file(path: &Path) -> Result<Mesh, Box<dyn Error>> {
    let name = path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    if path.extension().is_some_and(|extension| extension == "obj") {
        return obj(&name, &std::fs::read_to_string(path)?);
    }
    Ok(Mesh::of_model(&name, &Model::from_file(path)?))
}

/// A closed torus of 90,000 triangles.
pub fn torus() -> Mesh {
    let [around, along] = [300, 150];
    let place = |at: usize| {
        let (turn, tube) = (at / along, at % along);
        let [turn, tube] = [turn as f32 / around as f32, tube as f32 / along as f32].map(|part| part * TAU);
        let ripple = 0.4 + 0.01 * (9.0 * turn).sin() * (5.0 * tube).sin();
        let radius = 1.0 + ripple * tube.cos();
        [radius * turn.cos(), ripple * tube.sin(), radius * turn.sin()]
    };
    let corner = |turn: usize, tube: usize| (turn % around * along + tube % along) as u32;
    let quad = |at: usize| {
        let (turn, tube) = (at / along, at % along);
        let [a, b] = [corner(turn, tube), corner(turn, tube + 1)];
        let [c, d] = [corner(turn + 1, tube + 1), corner(turn + 1, tube)];
        [a, b, c, a, c, d]
    };
    let all = 0..around * along;
    Mesh::smooth("torus", all.clone().map(place).collect(), all.flat_map(quad).collect())
}

/// The helmet of the benchmark of levels: six closed parts with hard edges and a seam each, 95,256 triangles.
pub fn helmet() -> Result<Mesh, Box<dyn Error>> {
    Ok(Mesh::of_model("helmet", &helmet::helmet()?))
}

/// A vertex for each pair of position and texture coordinate; polygons become fans.
fn obj(name: &str, text: &str) -> Result<Mesh, Box<dyn Error>> {
    let (mut places, mut positions, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    let mut vertices = HashMap::new();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Vec<f32> = words.take(3).map(str::parse).collect::<Result<_, _>>()?;
                places.push(<[f32; 3]>::try_from(numbers).map_err(|_| "a vertex has three coordinates")?);
            }
            Some("f") => {
                let mut corners = Vec::new();
                for word in words {
                    let mut numbers = word.split('/');
                    let place: usize = numbers.next().unwrap_or_default().parse()?;
                    let key = (place, numbers.next().unwrap_or_default().to_owned());
                    let position = *places.get(place.wrapping_sub(1)).ok_or("an index is out of range")?;
                    corners.push(*vertices.entry(key).or_insert_with(|| {
                        positions.push(position);
                        positions.len() as u32 - 1
                    }));
                }
                corners.windows(2).skip(1).for_each(|pair| indices.extend([corners[0], pair[0], pair[1]]));
            }
            _ => {}
        }
    }
    Ok(Mesh::smooth(name, positions, indices))
}
