//! Parity and benchmark cases of `kernels/skinning/palette.wgsl`.

use relievo::Error;
use relievo::gpu::Buffer;
use relievo::ops::animation::ModelMatrices;
use relievo::ops::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::palette::reference::{palette, palette_for};
use relievo::ops::skinning::palette::{PALETTE_BOUND, Palette, PalettePass};
use relievo::ops::skinning::vertex::Blend;

use crate::cases::animation::tiered_skeleton;
use crate::cases::measure;
use crate::cases::skinning::{BONES, CROWDS, SHAPES, Scene, poisoned, random_matrices, random_model};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// The cases cover random skins with some of a skeleton's bones, mirrored and stretched, for both kinds of
/// blending. A quaternion may have the opposite sign, its dual part with it. The second instance is not seen,
/// and its palette must stay unchanged.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = PalettePass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES) {
        let mut model = random_model(case, shape)?;
        model.skeleton = tiered_skeleton(case, shape.bones)?;
        let (skin, tiers) = (&model.skins[0], model.skeleton.tiers() as u32);
        for (instances, blend) in [(3, Blend::Linear), (7, Blend::DualQuaternion)] {
            let matrices = random_matrices(case, shape.bones, instances);
            let model_matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &matrices)?);
            let (mesh, _) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
            let mut crowd = SkinnedCrowd::new(gpu, &mesh, instances, blend)?;
            let output = Poisoned::<[f32; 4]>::new(gpu, crowd.palette.len())?;
            crowd.palette = output.buffer.clone();
            let lod = |instance: usize| InstanceLod { tier: instance as u32 % tiers, ..InstanceLod::FULL };
            crowd.instance_lods.write(gpu, &(0..instances).map(lod).collect::<Vec<_>>())?;
            crowd.instance_lods.write_at(gpu, 1, &[InstanceLod::UNSEEN])?;
            let job = pass.prepare(gpu, &mesh, &model_matrices, &crowd)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let mut expected: Vec<[f32; 4]> = matrices
                .chunks(shape.bones)
                .flat_map(|model_matrices| match palette_for(skin, model_matrices, blend) {
                    Palette::Linear(bones) => bones.as_flattened().to_vec(),
                    Palette::Dual(bones) => bytemuck::cast_slice(&bones).to_vec(),
                })
                .collect();
            let largest = expected.as_flattened().iter().fold(1.0, |a: f32, b| a.max(b.abs()));
            let each = expected.len() / instances;
            expected[each..2 * each].fill(poisoned());
            // Bones of another tier are left out.
            for (at, rows) in expected.chunks_mut(each / skin.bones.len()).enumerate() {
                let (instance, bone) = (at / skin.bones.len(), skin.bones[at % skin.bones.len()]);
                if model.skeleton.tier_of(bone) != instance % tiers as usize {
                    rows.fill(poisoned());
                }
            }
            let name = format!("{} of {} bones × {instances}, {blend:?}", skin.bones.len(), shape.bones);
            let near = |actual: &[[f32; 4]]| {
                let turned = (blend != Blend::Linear).then(|| same_side(actual, &expected));
                let actual = turned.as_deref().unwrap_or(actual);
                compare::absolute(actual.as_flattened(), expected.as_flattened(), PALETTE_BOUND * largest)
            };
            cases.check(name, &output, near).await?;
        }
    }
    Ok(())
}

/// Gives quaternions the signs of the expected ones.
fn same_side(actual: &[[f32; 4]], expected: &[[f32; 4]]) -> Vec<[f32; 4]> {
    let bones = actual.chunks_exact(4).zip(expected.chunks_exact(4));
    let turned = |(actual, expected): (&[[f32; 4]], &[[f32; 4]])| {
        let dot: f32 = actual[0].iter().zip(expected[0]).map(|(a, b)| a * b).sum();
        let side = if dot < 0.0 { -1.0 } else { 1.0 };
        [actual[0].map(|x| side * x), actual[1].map(|x| side * x), actual[2], actual[3]]
    };
    bones.flat_map(turned).collect()
}

/// Measures palettes for linear blending.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = PalettePass::new(gpu)?;
    for instances in CROWDS {
        let scene = Scene::new(gpu, 1, 0, instances)?;
        let matrices = random_matrices(1, 2 * BONES, instances);
        let model_matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &matrices)?);
        let job = pass.prepare(gpu, &scene.mesh, &model_matrices, &scene.crowd)?;
        let pairs = BONES * instances;
        // The kernel reads two matrices and an index, and writes a matrix.
        let reference = || {
            for model_matrices in matrices.chunks(2 * BONES) {
                drop(std::hint::black_box(palette(&scene.model.skins[0], model_matrices)));
            }
        };
        let name = format!("{BONES} bones × {instances}");
        measure(bench, name, pairs, "bone", 37 * pairs, &|encoder| job.record(encoder), reference)?;
    }
    Ok(())
}
