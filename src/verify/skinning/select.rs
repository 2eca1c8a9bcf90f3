//! Parity of `kernels/skinning/select.wgsl`.

use super::{SHAPES, random_model, random_reductions};
use crate::Error;
use crate::reference::skinning::select::select;
use crate::skinning::buffers::{ActiveClusters, MeshBuffers, SkinnedCrowd};
use crate::skinning::select::{SelectBuffers, SelectPass};
use crate::skinning::skin::Blend;
use crate::skinning::weights::Reduction;
use crate::verify::animation::Draw;
use crate::verify::compare::Comparison;
use crate::verify::poison::Poisoned;
use crate::verify::{Cases, compare};

/// No bone, some and all; reductions that change and such as do not. Three times in a row: the last time without a
/// change. Lists are compared sorted, with their number and the workgroups behind them.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = SelectPass::new(gpu)?;
    for (case, shape) in (0..).zip(SHAPES) {
        let model = random_model(case, shape)?;
        let (mesh, clusters) = MeshBuffers::new(gpu, &model, &model.meshes[0])?;
        let instances = 1 + 29 * (case as usize % 3);
        let crowd = SkinnedCrowd::new(gpu, &mesh, instances, Blend::Linear)?;
        let buffers = SelectBuffers::new(gpu, &mesh, &crowd)?;
        let mut active = ActiveClusters::new(gpu, &mesh, &crowd)?;
        let pairs = clusters.len() * instances;
        let output = Poisoned::<u32>::new(gpu, pairs)?;
        active.pairs = output.buffer.clone();
        let job = pass.prepare(gpu, &mesh, &crowd, &buffers, &active)?;
        let mut known = vec![Reduction { fade: 0.0, most: 0 }; instances];
        let mut draw = Draw::new(case ^ 0xb17);
        for (round, share) in [8, 2, 5].into_iter().enumerate() {
            let reductions = match round {
                2 => known.clone(),
                _ => random_reductions(case + round as u32, instances),
            };
            let mut bits =
                |_| (0..32).fold(0_u32, |word, bit| word | u32::from(draw.word() % 64 < share) << bit);
            let moved: Vec<u32> = (0..instances * clusters.mask_words).map(&mut bits).collect();
            crowd.reductions.write(gpu, &reductions)?;
            buffers.moved.write(gpu, &moved)?;
            output.poison(gpu)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let expected = select(&clusters, &moved, &reductions, &known);
            let dispatched = active.dispatched.read_blocking(gpu)?;
            let comparison = output.check(gpu, |actual| listed(actual, &dispatched, &expected))?;
            cases.add(format!("{} clusters × {instances}, round {round}", clusters.len()), comparison);
            known = reductions;
        }
    }
    Ok(())
}

fn listed(actual: &[u32], dispatched: &[u32], expected: &[u32]) -> Comparison {
    let count = expected.len() as u32;
    let mut all = actual[..actual.len().min(expected.len())].to_vec();
    all.sort_unstable();
    all.extend(dispatched);
    let x = count.clamp(1, 65_535);
    compare::exact(&all, &[expected, &[x, count.div_ceil(x), 1, count]].concat())
}
