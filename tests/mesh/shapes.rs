//! Meshes to simplify.

use std::collections::HashMap;

use relievo::ops::mesh::{Simplified, SimplifyOptions, Surface, simplify};

/// A mesh in one or more poses, with texture coordinates.
#[derive(Clone)]
pub struct Shape {
    pub poses: Vec<Vec<[f32; 3]>>,
    pub uv: Vec<[f32; 2]>,
    pub indices: Vec<u32>,
}

impl Shape {
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }

    /// The surface, with texture coordinates that count as much as positions.
    pub fn with_uv(&self) -> Surface<'_> {
        Surface { poses: &self.poses, indices: &self.indices, attributes: self.uv.as_flattened(), stride: 2 }
    }

    pub fn bare(&self) -> Surface<'_> {
        Surface { attributes: &[], stride: 0, ..self.with_uv() }
    }

    /// Simplifies the mesh by positions alone.
    pub fn simplified(&self, options: &SimplifyOptions) -> Simplified {
        simplify(&self.bare(), options).expect("valid")
    }

    /// The first vertex at each vertex's place.
    pub fn points(&self) -> Vec<u32> {
        let mut firsts = HashMap::new();
        let key =
            |vertex: usize| self.poses.iter().flat_map(move |pose| pose[vertex].map(|x| (x + 0.0).to_bits()));
        let vertices = 0..self.uv.len();
        vertices.map(|at| *firsts.entry(key(at).collect::<Vec<_>>()).or_insert(at as u32)).collect()
    }

    /// Adds another mesh.
    pub fn append(&mut self, other: &Self) {
        let first = self.uv.len() as u32;
        self.indices.extend(other.indices.iter().map(|index| first + index));
        self.uv.extend(&other.uv);
        for (pose, others) in self.poses.iter_mut().zip(&other.poses) {
            pose.extend(others);
        }
    }
}

/// A sheet of `[columns, rows]` cells, of two triangles each, counter-clockwise where u, v and the normal are
/// right-handed; `place` of (column, row).
pub fn sheet([columns, rows]: [usize; 2], place: impl Fn(usize, usize) -> [f64; 3]) -> Shape {
    let mut shape = Shape { poses: vec![Vec::new()], uv: Vec::new(), indices: Vec::new() };
    for row in 0..=rows {
        for column in 0..=columns {
            shape.poses[0].push(place(column, row).map(|x| x as f32));
            shape.uv.push([column as f32 / columns as f32, row as f32 / rows as f32]);
        }
    }
    let at = |column: usize, row: usize| (row * (columns + 1) + column) as u32;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [at(column, row), at(column + 1, row)];
            let [c, d] = [at(column + 1, row + 1), at(column, row + 1)];
            shape.indices.extend([a, b, c, a, c, d]);
        }
    }
    shape
}

/// A ground seen from above, with `height` at (x, z) in 0..=1.
pub fn ground(cells: usize, height: impl Fn(f64, f64) -> f64) -> Shape {
    sheet([cells; 2], |column, row| {
        let [x, z] = [column, cells - row].map(|at| at as f64 / cells as f64);
        [x, height(x, z), z]
    })
}

/// Hills of several sizes.
pub fn bumps(x: f64, z: f64) -> f64 {
    0.08 * (5.0 * x).sin() * (4.0 * z + 1.0).cos()
        + 0.02 * (17.0 * x + 9.0 * z).sin()
        + 0.004 * (41.0 * x - 53.0 * z).sin()
}

/// A sphere of radius 1 with its poles above and below, a seam from pole to pole, and at each pole as many
/// wedges as sectors.
pub fn sphere(sectors: usize, rings: usize) -> Shape {
    let mut shape = sheet([sectors, rings], |column, row| {
        let turn = std::f64::consts::TAU * (column % sectors) as f64 / sectors as f64;
        let angle = std::f64::consts::PI * row as f64 / rings as f64;
        let radius = if row == 0 || row == rings { 0.0 } else { angle.sin() };
        [radius * turn.cos(), -angle.cos(), -radius * turn.sin()]
    });
    let points = shape.points();
    let has_area = |triangle: &&[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| points[triangle[corner] as usize]);
        a != b && b != c && c != a
    };
    shape.indices = shape.indices.chunks_exact(3).filter(has_area).flatten().copied().collect();
    shape
}

/// A torus of radii 1 and ⅓, with a seam in each direction.
pub fn torus(sectors: usize, rings: usize) -> Shape {
    sheet([sectors, rings], |column, row| {
        let angle = |at: usize, of: usize| std::f64::consts::TAU * (at % of) as f64 / of as f64;
        let (turn, around) = (angle(column, sectors), angle(row, rings));
        let radius = 1.0 + around.cos() / 3.0;
        [radius * turn.cos(), around.sin() / 3.0, -radius * turn.sin()]
    })
}

/// A cube of six separate sheets, with a seam at every edge.
pub fn cube(cells: usize) -> Shape {
    let face = |axis: usize, side: f64| {
        sheet([cells; 2], |column, row| {
            let [u, v] = [column, row].map(|at| at as f64 / cells as f64 * 2.0 - 1.0);
            let mut place = [side; 3];
            place[(axis + 1) % 3] = u * side;
            place[(axis + 2) % 3] = v;
            place
        })
    };
    let mut shape = face(0, 1.0);
    for (axis, side) in [(0, -1.0), (1, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
        shape.append(&face(axis, side));
    }
    shape
}

/// A mesh whose texture coordinates have no meaning.
pub fn bare(places: Vec<[f32; 3]>, indices: Vec<u32>) -> Shape {
    Shape { uv: vec![[0.0; 2]; places.len()], poses: vec![places], indices }
}

/// Any order of `count` things; another for another seed.
pub fn shuffled(count: usize, seed: u64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..count as u32).collect();
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    for last in (1..count).rev() {
        state = state.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(0x1405_7b7e_f767_814f);
        order.swap(last, ((state >> 33) % (last as u64 + 1)) as usize);
    }
    order
}
