//! Benchmark cases of `kernels/lod/attach.wgsl`.

use super::reference::{attached, local};
use super::{AttachBuffers, AttachParams, AttachPass, Attachment};
use crate::Error;
use crate::animation::ModelMatrices;
use crate::asset::transform::AFFINE_IDENTITY;
use crate::gpu::{Buffer, Uniform};
use crate::harness::{Backend, Bench, Contender};
use crate::lod::verify::{frame, random_instances};
use crate::terrain::bench::copy_of;

/// Bones of a character.
const BONES: u32 = 60;

/// Measures characters that each hold one mesh.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = AttachPass::new(gpu)?;
    let view = frame()?[0].1;
    for count in [1_000, 10_000_u32] {
        let instances = random_instances(1, 2 * count as usize);
        let allowed = vec![0.5; instances.len()];
        let matrices = vec![AFFINE_IDENTITY; (count * BONES) as usize];
        let attachment = |character: u32| Attachment {
            mesh: count + character,
            character,
            bone: character % BONES,
            key: character,
            offset: AFFINE_IDENTITY,
        };
        let attachments: Vec<Attachment> = (0..count).map(attachment).collect();
        let params =
            AttachParams { attached: count, bones: BONES, first: 0, last_rows: 0, frame: 1, last_frame: 0 };
        let model_matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &matrices)?);
        let of_scene = Buffer::from_slice(gpu, "instances", &instances)?;
        let buffers = AttachBuffers {
            params: &Uniform::new(gpu, "params", &params)?,
            view: &Uniform::new(gpu, "view", &view)?,
            attachments: &Buffer::from_slice(gpu, "attachments", &attachments)?,
            model_matrices: &model_matrices,
            instances: &of_scene,
            last_instances: &of_scene,
            kept: &Buffer::new(gpu, "kept", 2 * attachments.len())?,
            allowed: &Buffer::from_slice(gpu, "allowed", &allowed)?,
            rows: &Buffer::new(gpu, "rows", 3 * instances.len())?,
        };
        let job = pass.prepare(gpu, buffers)?;
        // The kernel reads an attachment, a bone, an instance and what it is allowed, and writes three rows.
        let words = (16 + 12 + 24 + 1 + 12) * count as usize;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let scene = (&instances[..], &allowed[..]);
                let of = |of| attached(&params, of, view.cell, scene, &local(&params, of, &matrices));
                let all = attachments.iter().map(of);
                drop(std::hint::black_box(all.collect::<Vec<_>>()));
            }),
        ];
        bench.case(format!("{count} meshes"), (count as usize, "mesh"), 4 * words as u64, contenders)?;
    }
    Ok(())
}
