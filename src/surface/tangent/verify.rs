//! Parity cases of `kernels/surface/tangent.wgsl`.

use crate::Error;
use crate::harness::Cases;
use crate::harness::compare::LeftOut;
use crate::harness::compare::{Comparison, absolute, exact};
use crate::harness::poison::Poisoned;
use crate::surface::tangent::reference::{Frame, frames};
use crate::surface::tangent::{DEGENERATE, Mesh, TANGENT_BOUND, TangentBuffers, TangentPass, VANISHING};
use crate::terrain::verify::random_words;

/// A mesh that owns its data.
#[derive(Debug, Clone, Default)]
pub struct Owned {
    /// See [`Mesh`].
    pub positions: Vec<[f32; 3]>,
    /// See [`Mesh`].
    pub normals: Vec<[f32; 3]>,
    /// See [`Mesh`].
    pub uv: Vec<[f32; 2]>,
    /// See [`Mesh`].
    pub indices: Vec<u32>,
}

impl Owned {
    /// The mesh in the form that the pass and the reference take.
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh { positions: &self.positions, normals: &self.normals, uv: &self.uv, indices: &self.indices }
    }
}

/// The cases cover literal frames; thresholds from both sides; triangle soups around workgroup boundaries; many
/// triangles at a vertex; large and small units; mirrored, seamed and degenerate meshes.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = TangentPass::new(cases.gpu)?;
    for (name, mesh, expected) in literals() {
        let expected = expected.map(|tangent| Frame { tangent, sensitivity: 1.0 });
        check(cases, &pass, name, &mesh, &expected, None)?;
    }
    let mut meshes = Vec::new();
    for vertices in [1, 2, 63, 64, 65, 127, 128, 129, 5000] {
        meshes.push((format!("soup of {vertices} vertices"), soup(vertices)));
    }
    for (name, mesh) in [("torus", torus(96, 48)), ("torus, mirrored", mirrored(torus(33, 17)))] {
        meshes.push((name.to_owned(), mesh));
    }
    for (size, texture) in [(1e-15, 1.0), (1e15, 1e-12), (1.0, 1e12), (1e-25, 1e-25)] {
        meshes.push((format!("torus of size {size:e}, uv {texture:e}"), scaled(torus(12, 9), size, texture)));
    }
    meshes.push(("2000 triangles at a vertex".to_owned(), fan(2000)));
    meshes.push(("torus with degenerate triangles".to_owned(), with_degenerate_triangles(torus(21, 13))));
    meshes.push(("normals that are none".to_owned(), with_strange_normals(torus(21, 13))));
    for (name, mesh) in meshes {
        let (mesh, expected, left_out) = settled(mesh)?;
        check(cases, &pass, &name, &mesh, &expected, Some(left_out))?;
    }
    for (name, mesh) in thresholds() {
        let expected = frames(&mesh.mesh())?;
        check(cases, &pass, name, &mesh, &expected, None)?;
    }
    Ok(())
}

/// Replaces the normals of vertices where rounding decides between a frame and the fallback by one for which it
/// does not. These vertices count as left out; one in 500 is allowed, and one in any case.
fn settled(mut mesh: Owned) -> Result<(Owned, Vec<Frame>, LeftOut), Error> {
    let expected = frames(&mesh.mesh())?;
    let open = |frame: &Frame| !frame.sensitivity.is_finite();
    let count = expected.iter().filter(|frame| open(frame)).count();
    for (normal, _) in mesh.normals.iter_mut().zip(&expected).filter(|(_, frame)| open(frame)) {
        *normal = [0.0; 3];
    }
    let left_out = LeftOut { count, of: expected.len(), most: 1 + expected.len() / 500 };
    let expected = frames(&mesh.mesh())?;
    Ok((mesh, expected, left_out))
}

fn check(
    cases: &mut Cases<'_>,
    pass: &TangentPass,
    name: &str,
    mesh: &Owned,
    expected: &[Frame],
    left_out: Option<LeftOut>,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let output = Poisoned::<[f32; 4]>::new(gpu, expected.len())?;
    let buffers = TangentBuffers::new(gpu, &mesh.mesh())?;
    let job = pass.prepare(gpu, &buffers, &output.buffer)?;
    gpu.run("verify", |encoder| job.record(encoder))?;
    let tangents = output.check(gpu, |actual| directions(actual, expected))?;
    let tangents = match left_out {
        Some(left_out) => tangents.leaving_out(left_out),
        None => tangents,
    };
    cases.add(format!("{name}: tangents"), tangents);
    let handedness: Vec<f32> = expected.iter().map(|frame| frame.tangent[3]).collect();
    let comparison = output.check(gpu, |actual| {
        exact(&actual.iter().map(|tangent| tangent[3]).collect::<Vec<_>>(), &handedness)
    })?;
    cases.add(format!("{name}: handedness"), comparison);
    Ok(())
}

/// Compares tangents after dividing each error by its sensitivity.
fn directions(actual: &[[f32; 4]], expected: &[Frame]) -> Comparison {
    if let Some(vertex) = expected.iter().position(|frame| !frame.sensitivity.is_finite()) {
        let fault = format!("rounding decides at vertex {vertex}: a case that proves nothing");
        return Comparison::failed(actual.len(), fault);
    }
    let scaled = |tangent: [f32; 4], sensitivity: f64| {
        [0, 1, 2].map(|axis| (f64::from(tangent[axis]) / sensitivity) as f32)
    };
    let actual: Vec<_> = (actual.iter().zip(expected))
        .flat_map(|(actual, expected)| scaled(*actual, expected.sensitivity))
        .collect();
    let expected: Vec<_> =
        expected.iter().flat_map(|expected| scaled(expected.tangent, expected.sensitivity)).collect();
    absolute(&actual, &expected, TANGENT_BOUND)
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
fn literals() -> Vec<(&'static str, Owned, [[f32; 4]; 3])> {
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
fn thresholds() -> Vec<(&'static str, Owned)> {
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
fn soup(vertices: usize) -> Owned {
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
pub fn torus(around: u32, across: u32) -> Owned {
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

fn mirrored(mut mesh: Owned) -> Owned {
    mesh.uv.iter_mut().for_each(|uv| uv[0] = -uv[0]);
    mesh
}

fn scaled(mut mesh: Owned, size: f32, texture: f32) -> Owned {
    mesh.positions.iter_mut().flatten().for_each(|coordinate| *coordinate *= size);
    mesh.uv.iter_mut().flatten().for_each(|coordinate| *coordinate *= texture);
    mesh
}

/// A slightly crumpled disc of triangles around vertex 0.
fn fan(triangles: u32) -> Owned {
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
fn with_degenerate_triangles(mesh: Owned) -> Owned {
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
fn with_strange_normals(mut mesh: Owned) -> Owned {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turned_tangent_and_an_open_decision_fail() {
        let expected = [1.0, 50.0].map(|sensitivity| Frame { tangent: [0.6, 0.0, 0.8, 1.0], sensitivity });
        let turned = |by: f32| [[0.6, 0.0, 0.8, 1.0], [0.6, by, 0.8, 1.0]];
        assert!(directions(&turned(49.0 * TANGENT_BOUND), &expected).holds);
        assert!(!directions(&turned(51.0 * TANGENT_BOUND), &expected).holds);
        assert!(!directions(&turned(f32::NAN), &expected).holds);
        let open = expected.map(|frame| Frame { sensitivity: f64::INFINITY, ..frame });
        assert!(!directions(&turned(0.0), &open).holds);
    }

    #[test]
    fn threshold_cases_lie_on_either_side() {
        let fallback = |mesh: &Owned| {
            let frames = frames(&mesh.mesh()).expect("a valid mesh");
            let alone = frames_without_triangles(mesh);
            frames[0].tangent[..3] == alone[0].tangent[..3]
        };
        let pairs: Vec<_> = thresholds().iter().map(|(name, mesh)| (*name, fallback(mesh))).collect();
        for pair in pairs[..8].chunks_exact(2) {
            assert!(pair[0].1 && !pair[1].1, "{pair:?}");
        }
        let handed = thresholds()[8..].iter().map(|(_, mesh)| mesh.clone()).collect::<Vec<_>>();
        let handed = handed.iter().map(|mesh| frames(&mesh.mesh()).expect("a valid mesh")[0].tangent[3]);
        assert_eq!(handed.collect::<Vec<_>>(), [1.0, -1.0]);
    }

    fn frames_without_triangles(mesh: &Owned) -> Vec<Frame> {
        frames(&Mesh { indices: &[], ..mesh.mesh() }).expect("a valid mesh")
    }
}
