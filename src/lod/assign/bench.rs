//! Benchmark cases of `kernels/lod/assign.wgsl`.

use glam::Vec4;

use super::AssignParams;
use crate::Error;
use crate::gpu::{Buffer, Uniform};
use crate::harness::{Backend, Bench, Contender};
use crate::lod::assign::reference::assign;
use crate::lod::assign::{AssignBuffers, AssignPass};
use crate::lod::verify::random_instances;
use crate::terrain::bench::copy_of;

/// Measures characters of which three quarters are seen.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = AssignPass::new(gpu)?;
    for count in [1_000, 100_000_usize] {
        let params = AssignParams {
            first: 0,
            instances: count as u32,
            levels: 8,
            mesh_fraction: 0.5,
            bone_fraction: 0.3,
            influence_fraction: 0.2,
            unit: 1e-6,
            stray: 0.1,
            max_influences: 4,
            errors: [Vec4::new(0.0, 0.01, 0.02, 0.04), Vec4::new(0.08, 0.16, 0.32, 0.64)],
        };
        let allowed: Vec<f32> =
            (0..count).map(|at| if at % 4 == 0 { -1.0 } else { 1e-3 * (at % 1024) as f32 }).collect();
        let buffers = AssignBuffers {
            params: &Uniform::new(gpu, "params", &params)?,
            allowed: &Buffer::from_slice(gpu, "allowed", &allowed)?,
            instances: &Buffer::from_slice(gpu, "instances", &random_instances(1, count))?,
            lods: &Buffer::new(gpu, "lods", count)?,
            instance_lods: &Buffer::new(gpu, "instance_lods", count)?,
        };
        let job = pass.prepare(gpu, buffers, count as u32)?;
        // The kernel reads two words and writes a Lod and an InstanceLod.
        let words = 9 * count;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let all = allowed.iter().map(|allowed| assign(&params, *allowed, false));
                drop(std::hint::black_box(all.collect::<Vec<_>>()));
            }),
        ];
        bench.case(format!("{count} instances"), (count, "instance"), 4 * words as u64, contenders)?;
    }
    Ok(())
}
