//! Parity and benchmark cases of `kernels/surface/tangent.wgsl`.

pub(crate) use meshes::{Owned, torus};
use meshes::{
    fan, literals, mirrored, scaled, soup, thresholds, with_degenerate_triangles, with_strange_normals,
};
use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::surface::tangent::reference::{TangentFrame, frames, tangents};
use relievo::ops::surface::tangent::{TANGENT_BOUND, TangentBuffers, TangentPass};

use crate::cases::terrain::copy_of;
use crate::harness::compare::{Comparison, LeftOut, absolute, exact};
use crate::harness::poison::Poisoned;
use crate::harness::{Backend, Bench, Cases, Contender};

mod meshes;

/// The cases cover literal frames; thresholds from both sides; triangle soups around workgroup boundaries; many
/// triangles at a vertex; large and small units; mirrored, seamed and degenerate meshes.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let pass = TangentPass::new(cases.gpu)?;
    for (name, mesh, expected) in literals() {
        let expected = expected.map(|tangent| TangentFrame { tangent, sensitivity: 1.0 });
        check(cases, &pass, name, &mesh, &expected, None).await?;
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
        check(cases, &pass, &name, &mesh, &expected, Some(left_out)).await?;
    }
    for (name, mesh) in thresholds() {
        let expected = frames(&mesh.mesh())?;
        check(cases, &pass, name, &mesh, &expected, None).await?;
    }
    Ok(())
}

/// Replaces the normals of vertices where rounding decides between a frame and the fallback by one for which it
/// does not. These vertices count as left out; one in 500 is allowed, and one in any case.
fn settled(mut mesh: Owned) -> Result<(Owned, Vec<TangentFrame>, LeftOut), Error> {
    let expected = frames(&mesh.mesh())?;
    let open = |frame: &TangentFrame| !frame.sensitivity.is_finite();
    let count = expected.iter().filter(|frame| open(frame)).count();
    for (normal, _) in mesh.normals.iter_mut().zip(&expected).filter(|(_, frame)| open(frame)) {
        *normal = [0.0; 3];
    }
    let left_out = LeftOut { count, of: expected.len(), most: 1 + expected.len() / 500 };
    let expected = frames(&mesh.mesh())?;
    Ok((mesh, expected, left_out))
}

async fn check(
    cases: &mut Cases<'_>,
    pass: &TangentPass,
    name: &str,
    mesh: &Owned,
    expected: &[TangentFrame],
    left_out: Option<LeftOut>,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let output = Poisoned::<[f32; 4]>::new(gpu, expected.len())?;
    let buffers = TangentBuffers::new(gpu, &mesh.mesh())?;
    let job = pass.prepare(gpu, &buffers, &output.buffer)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let tangents = output.check(gpu, |actual| directions(actual, expected)).await?;
    let tangents = match left_out {
        Some(left_out) => tangents.leaving_out(left_out),
        None => tangents,
    };
    cases.add(format!("{name}: tangents"), tangents);
    let handedness: Vec<f32> = expected.iter().map(|frame| frame.tangent[3]).collect();
    let comparison = output
        .check(gpu, |actual| exact(&actual.iter().map(|tangent| tangent[3]).collect::<Vec<_>>(), &handedness))
        .await?;
    cases.add(format!("{name}: handedness"), comparison);
    Ok(())
}

/// Compares tangents after dividing each error by its sensitivity.
fn directions(actual: &[[f32; 4]], expected: &[TangentFrame]) -> Comparison {
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

/// Measures a torus of half a million triangles. Per vertex the kernel reads 32 bytes, two triangles (24), and
/// the six corners that meet there (24, and an offset of 4); it writes a tangent of 16 bytes.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let torus = torus(512, 512);
    let vertices = torus.positions.len();
    let mesh = TangentBuffers::new(gpu, &torus.mesh())?;
    let output = Buffer::new(gpu, "tangents", vertices)?;
    let job = TangentPass::new(gpu)?.prepare(gpu, &mesh, &output)?;
    let copied = copy_of(gpu, vertices * 100 / 8)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || drop(std::hint::black_box(tangents(&torus.mesh())))),
    ];
    bench.case("512x512 torus", vertices, "vertex", 100 * vertices as u64, contenders)
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::ops::surface::tangent::TangentMesh;

    #[test]
    fn a_turned_tangent_and_an_open_decision_fail() {
        let expected =
            [1.0, 50.0].map(|sensitivity| TangentFrame { tangent: [0.6, 0.0, 0.8, 1.0], sensitivity });
        let turned = |by: f32| [[0.6, 0.0, 0.8, 1.0], [0.6, by, 0.8, 1.0]];
        assert!(directions(&turned(49.0 * TANGENT_BOUND), &expected).holds);
        assert!(!directions(&turned(51.0 * TANGENT_BOUND), &expected).holds);
        assert!(!directions(&turned(f32::NAN), &expected).holds);
        let open = expected.map(|frame| TangentFrame { sensitivity: f64::INFINITY, ..frame });
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

    fn frames_without_triangles(mesh: &Owned) -> Vec<TangentFrame> {
        frames(&TangentMesh { indices: &[], ..mesh.mesh() }).expect("a valid mesh")
    }
}
