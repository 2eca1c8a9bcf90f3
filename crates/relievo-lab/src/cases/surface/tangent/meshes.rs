//! The meshes of the parity cases: literal ones, ones on either side of a threshold, and large ones.

use relievo::ops::surface::tangent::{DEGENERATE, TangentMesh, VANISHING};

use crate::cases::terrain::random_words;

/// A mesh that owns its data.
#[derive(Debug, Clone, Default)]
pub(crate) struct Owned {
    /// See [`TangentMesh`].
    pub positions: Vec<[f32; 3]>,
    /// See [`TangentMesh`].
    pub normals: Vec<[f32; 3]>,
    /// See [`TangentMesh`].
    pub uv: Vec<[f32; 2]>,
    /// See [`TangentMesh`].
    pub indices: Vec<u32>,
}

impl Owned {
    /// The mesh in the form that the pass and the reference take.
    pub(crate) fn mesh(&self) -> TangentMesh<'_> {
        TangentMesh {
            positions: &self.positions,
            normals: &self.normals,
            uv: &self.uv,
            indices: &self.indices,
        }
    }
}

/// A right triangle in the plane z = 0 with corners at (0, 0), (1, 0) and (0, 1) and the given uv.
fn triangle(uv: [[f32; 2]; 3]) -> Owned {
    Owned {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        normals: vec![[0.0, 0.0, 1.0]; 3],
        uv: uv.to_vec(),
        indices: vec![0, 1, 2],
    }
}

/// Frames that were worked out by hand from the definition.
pub(super) fn literals() -> Vec<(&'static str, Owned, [[f32; 4]; 3])> {
    let plain = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let [east, north] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let all = |[x, y, z]: [f32; 3], w: f32| [[x, y, z, w]; 3];
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let with = |change: fn(&mut Owned)| {
        let mut mesh = triangle(plain);
        change(&mut mesh);
        mesh
    };
    vec![
        ("uv along x and y", triangle(plain), all(east, 1.0)),
        ("u mirrored", triangle([[1.0, 0.0], [0.0, 0.0], [1.0, 1.0]]), all([-1.0, 0.0, 0.0], -1.0)),
        ("v mirrored", triangle([[0.0, 1.0], [1.0, 1.0], [0.0, 0.0]]), all(east, -1.0)),
        ("u along y, v along -x", triangle([[0.0, 0.0], [0.0, -3.0], [2.0, 0.0]]), all(north, 1.0)),
        ("uv exchanged", triangle([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), all(north, -1.0)),
        ("u along x and y", triangle([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]), all(east, 1.0)),
        ("uv turned", triangle([[0.0, 0.0], [1.0, -1.0], [1.0, 1.0]]), all([half, half, 0.0], 1.0)),
        ("uv at a point", triangle([[0.25, 0.5]; 3]), all(east, 1.0)),
        ("uv on a line", triangle([[0.1, 0.3], [0.2, 0.6], [0.3, 0.9]]), all(east, 1.0)),
        ("v all the same", triangle([[0.0, 0.7], [1.0, 0.7], [0.0, 0.7]]), all(east, 1.0)),
        ("no triangle", with(|mesh| mesh.indices.clear()), all(east, 1.0)),
        ("one vertex thrice", with(|mesh| mesh.indices = vec![1; 3]), all(east, 1.0)),
        ("positions on a line", with(|mesh| mesh.positions[2] = [0.5, 0.0, 0.0]), all(east, 1.0)),
        ("normals the other way", with(|mesh| mesh.normals = vec![[0.0, 0.0, -2.0]; 3]), all(east, -1.0)),
        (
            "a normal along the tangent",
            with(|mesh| mesh.normals = vec![[9.0, 0.0, 0.0]; 3]),
            all([0.0, 0.0, -1.0], 1.0),
        ),
        (
            "normals in several directions",
            with(|mesh| mesh.normals = vec![[0.0; 3], [-1.0, 0.0, 1.0], [0.0, -5.0, 0.1]]),
            [[1.0, 0.0, 0.0, 1.0], [half, 0.0, half, 1.0], [1.0, 0.0, 0.0, 1.0]],
        ),
    ]
}

/// Meshes a tenth below and a tenth above each threshold; below it, the fallback gives a different frame.
pub(super) fn thresholds() -> Vec<(&'static str, Owned)> {
    // In uv the triangle is a line except for a small extent in v.
    let sliver = |fraction: f32| {
        let mut mesh = triangle([[0.0, 0.0], [1.0, 1.0], [1.0, 1.0 - fraction * DEGENERATE]]);
        mesh.normals = vec![[0.3, 0.2, 1.0]; 3];
        mesh
    };
    // In space the triangle is a line except for a small extent in y; u or v runs along it.
    let flat = |fraction: f32, uv: [[f32; 2]; 3]| {
        let mut mesh = triangle(uv);
        mesh.positions[2] = [1.0, -fraction * DEGENERATE, 0.0];
        mesh.normals = vec![[0.3, 0.2, 1.0]; 3];
        mesh
    };
    let along = [[1.0, 0.0], [0.0, 0.0], [1.0, 1.0]];
    let across = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    // The tangent is +Y, of which a small fraction is left after the normal's part is subtracted.
    let leaning = |fraction: f32| {
        let mut mesh = triangle([[0.0, 0.0], [0.0, -1.0], [1.0, 0.0]]);
        mesh.normals[0] = [0.0, (1.0 - fraction * fraction).sqrt(), fraction];
        mesh
    };
    // The normal of the face is +Z; the normals of the vertices differ from it by slightly more than a right
    // angle.
    let turned = |fraction: f32| {
        let mut mesh = triangle([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        mesh.normals = vec![[0.0, (1.0 - fraction * fraction).sqrt(), -fraction]; 3];
        mesh
    };
    vec![
        ("uv too thin", sliver(0.9)),
        ("uv just wide enough", sliver(1.1)),
        ("too thin", flat(0.9, along)),
        ("just wide enough", flat(1.1, along)),
        ("tangent too short", flat(0.9, across)),
        ("tangent just long enough", flat(1.1, across)),
        ("tangent too near the normal", leaning(0.9 * VANISHING)),
        ("tangent just far enough from the normal", leaning(1.1 * VANISHING)),
        ("handedness just positive", turned(0.9 * VANISHING)),
        ("handedness just negative", turned(1.1 * VANISHING)),
    ]
}

/// Random numbers in −1..1.
fn random(case: u32, count: usize) -> impl Iterator<Item = f32> {
    random_words(case, count).into_iter().map(|word| (word >> 8) as f32 / (1 << 23) as f32 - 1.0)
}

fn vectors<const N: usize>(case: u32, count: usize) -> Vec<[f32; N]> {
    let numbers: Vec<f32> = random(case, N * count).collect();
    numbers.chunks_exact(N).map(|vector| std::array::from_fn(|axis| vector[axis])).collect()
}

/// Twice as many triangles as vertices, with random corners.
pub(super) fn soup(vertices: usize) -> Owned {
    let case = vertices as u32;
    let words = random_words(case ^ 0x5eed, 6 * vertices);
    Owned {
        positions: vectors(case ^ 0x1000, vertices),
        normals: vectors(case ^ 0x2000, vertices),
        uv: vectors(case ^ 0x3000, vertices),
        indices: words.into_iter().map(|word| word % vertices as u32).collect(),
    }
}

/// A torus of `around` × `across` quads, closed except for the seams of uv.
pub(crate) fn torus(around: u32, across: u32) -> Owned {
    let mut torus = Owned::default();
    for j in 0..=across {
        for i in 0..=around {
            let (u, v) = (f64::from(i) / f64::from(around), f64::from(j) / f64::from(across));
            let [(sin, cos), (up, out)] = [u, v].map(|turn| libm::sincos(turn * std::f64::consts::TAU));
            let normal = [out * cos, -out * sin, up];
            let middle = [cos, -sin, 0.0];
            torus.positions.push([0, 1, 2].map(|axis| (middle[axis] + 0.35 * normal[axis]) as f32));
            torus.normals.push(normal.map(|component| component as f32));
            torus.uv.push([u as f32, v as f32]);
        }
    }
    for (j, i) in (0..across).flat_map(|j| (0..around).map(move |i| (j, i))) {
        let [a, b] = [j, j + 1].map(|row| row * (around + 1) + i);
        torus.indices.extend([a, a + 1, b + 1, a, b + 1, b]);
    }
    torus
}

pub(super) fn mirrored(mut mesh: Owned) -> Owned {
    mesh.uv.iter_mut().for_each(|uv| uv[0] = -uv[0]);
    mesh
}

pub(super) fn scaled(mut mesh: Owned, size: f32, texture: f32) -> Owned {
    mesh.positions.iter_mut().flatten().for_each(|coordinate| *coordinate *= size);
    mesh.uv.iter_mut().flatten().for_each(|coordinate| *coordinate *= texture);
    mesh
}

/// A slightly crumpled disc of triangles around vertex 0.
pub(super) fn fan(triangles: u32) -> Owned {
    let mut fan = Owned {
        positions: vec![[0.0; 3]],
        normals: vec![[0.1, -0.2, 1.0]],
        uv: vec![[0.0; 2]],
        ..Owned::default()
    };
    for (index, up) in (0..triangles).zip(random(77, triangles as usize)) {
        let turn = f64::from(index) / f64::from(triangles) * std::f64::consts::TAU;
        let (y, x) = libm::sincos(turn);
        fan.positions.push([x as f32, y as f32, 0.2 * up]);
        fan.normals.push([0.0, 0.0, 1.0]);
        fan.uv.push([x as f32, y as f32]);
        fan.indices.extend([0, 1 + index, 1 + (index + 1) % triangles]);
    }
    fan
}

/// The mesh with degenerate triangles: every third has no area, every fifth none in uv, every seventh is
/// mirrored.
pub(super) fn with_degenerate_triangles(mesh: Owned) -> Owned {
    let mut changed = Owned::default();
    for (index, triangle) in mesh.indices.chunks_exact(3).enumerate() {
        let shared = (0..3).map(|corner| triangle[corner] as usize);
        let mut corners: Vec<usize> = shared.collect();
        if index % 3 == 0 {
            corners[2] = corners[0];
        }
        for corner in &corners {
            let [u, v] = mesh.uv[*corner];
            changed.positions.push(mesh.positions[*corner]);
            changed.normals.push(mesh.normals[*corner]);
            changed.uv.push(match index {
                _ if index % 5 == 0 => [0.5, v],
                _ if index % 7 == 0 => [u, -v],
                _ => [u, v],
            });
        }
    }
    // Neighbouring triangles in the list share vertices, degenerate or not.
    let vertices = changed.positions.len() as u32;
    changed.indices = (0..vertices).collect();
    changed.indices.extend((0..vertices - vertices % 3).map(|index| index / 6 * 6 + index % 3));
    changed
}

/// The mesh with normals that are zero, infinite, tiny, huge or NaN, on every axis.
pub(super) fn with_strange_normals(mut mesh: Owned) -> Owned {
    let strange =
        [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e-40, 1e-38, 1e-31, 1e-30, 1e30, 2e30, f32::MAX, -0.0];
    for (index, normal) in mesh.normals.iter_mut().enumerate() {
        let value = strange[index % strange.len()];
        match index / strange.len() % 5 {
            0 => *normal = [value; 3],
            axis @ 1..4 => normal[axis - 1] = value,
            _ => *normal = normal.map(|component| component * value),
        }
    }
    mesh
}
