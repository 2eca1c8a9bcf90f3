//! Parity of `kernels/skinning/morph.wgsl`.

use super::{SHAPES, flat, random_model};
use crate::Error;
use crate::reference::skinning::morph::morph;
use crate::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use crate::skinning::morph::{MORPH_BOUND, MorphPass};
use crate::skinning::skin::{Blend, Vertex};
use crate::verify::animation::Draw;
use crate::verify::poison::Poisoned;
use crate::verify::{Cases, compare};

/// Vertices that no, one or every target moves; weights of 0, of either sign and above 1.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = MorphPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES).filter(|(_, shape)| shape.targets > 0) {
        let model = random_model(case, shape)?;
        let (mesh, clusters) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        for instances in [1, 5] {
            let mut draw = Draw::new(case ^ 0x0f0f);
            let weight = |at| if at % 4 == 3 { 0.0 } else { 1.5 * draw.signed() };
            let weights: Vec<f32> = (0..instances * shape.targets).map(weight).collect();
            let mut crowd = SkinnedCrowd::new(gpu, &mesh, instances, Blend::Linear)?;
            let output = Poisoned::<Vertex>::new(gpu, crowd.morphed.len())?;
            crowd.morphed = output.buffer.clone();
            crowd.weights.write(gpu, &weights)?;
            let job = pass.prepare(gpu, &mesh, &crowd)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let expected: Vec<f32> = weights
                .chunks(shape.targets)
                .flat_map(|weights| flat(&morph(&model.meshes[0], weights)))
                .collect();
            let comparison = output.check(gpu, |actual: &[Vertex]| {
                let ordered =
                    actual.chunks(shape.vertices).flat_map(|actual| flat(&clusters.in_mesh_order(actual)));
                compare::absolute(&ordered.collect::<Vec<_>>(), &expected, MORPH_BOUND)
            })?;
            cases.add(
                format!("{} vertices, {} targets × {instances}", shape.vertices, shape.targets),
                comparison,
            );
        }
    }
    Ok(())
}
