//! Parity cases of `kernels/lod/attach.wgsl`.

use glam::IVec3;

use super::reference::{attached, product};
use super::{ATTACH_BOUND, AttachBuffers, AttachParams, AttachPass, Attachment};
use crate::Error;
use crate::animation::ModelMatrices;
use crate::animation::verify::Draw;
use crate::asset::Affine;
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::harness::Cases;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::{POISON, Poisoned};
use crate::lod::verify::{CELL, frame, random_instances};
use crate::lod::{SceneInstance, SelectView};

/// Bones of the characters.
const BONES: u32 = 5;

/// The instances of the scene, and the first of the character.
const INSTANCES: u32 = 192;
const FIRST: u32 = 64;

/// What is attached to what.
struct Case {
    params: AttachParams,
    attachments: Vec<Attachment>,
    instances: Vec<SceneInstance>,
    allowed: Vec<f32>,
    model_matrices: Vec<Affine>,
}

/// The cases cover numbers of attached meshes around a workgroup's, fewer than there is room for, and views in whose cell the
/// instances are and from far away; a third of the characters is not seen.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let view = frame()?[0].1;
    for (number, attached) in (0..).zip([0, 1, 63, 64, 65, 100]) {
        for cell in [CELL, CELL + IVec3::new(-3, 1, 700)] {
            let case = Case::random(number, attached);
            let comparison = case.compared(gpu, &SelectView { cell, ..view })?;
            cases.add(format!("{attached} attached, cell {cell}"), comparison);
        }
    }
    Ok(())
}

impl Case {
    /// Meshes that are attached to bones of characters, all of them other instances.
    fn random(case: u32, attached: u32) -> Self {
        let mut draw = Draw::new(case ^ 0xa77a);
        let instances = random_instances(case, INSTANCES as usize);
        let allowed =
            (0..INSTANCES).map(|_| if draw.word().is_multiple_of(3) { -1.0 } else { 0.5 }).collect();
        let characters = INSTANCES - FIRST;
        let mut affine = || [0; 3].map(|_| [0; 4].map(|_| 2.0 * draw.signed()));
        let model_matrices: Vec<Affine> = (0..characters * BONES).map(|_| affine()).collect();
        let offsets: Vec<Affine> = (0..attached).map(|_| affine()).collect();
        let attachment = |(at, offset): (u32, &Affine)| Attachment {
            // Meshes before the characters, and behind each other in another order.
            mesh: (at * 29 + 7) % INSTANCES,
            character: draw.word() % characters,
            bone: draw.word() % BONES,
            unused: 0,
            offset: *offset,
        };
        let attachments = (0..).zip(&offsets).map(attachment).collect();
        let params = AttachParams { attached, bones: BONES, first: FIRST };
        Self { params, attachments, instances, allowed, model_matrices }
    }

    fn compared(&self, gpu: &Gpu, view: &SelectView) -> Result<Comparison, Error> {
        let rows = Poisoned::<[f32; 4]>::new(gpu, 3 * INSTANCES as usize)?;
        // Room for more than there are.
        let mut room = self.attachments.clone();
        room.resize(
            room.len() + 70,
            Attachment { mesh: 0, character: 0, bone: 0, unused: 0, offset: [[1.0; 4]; 3] },
        );
        let matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &self.model_matrices)?);
        let buffers = AttachBuffers {
            params: &Uniform::new(gpu, "params", &self.params)?,
            view: &Uniform::new(gpu, "view", view)?,
            attachments: &Buffer::from_slice(gpu, "attachments", &room)?,
            model_matrices: &matrices,
            instances: &Buffer::from_slice(gpu, "instances", &self.instances)?,
            allowed: &Buffer::from_slice(gpu, "allowed", &self.allowed)?,
            rows: &rows.buffer,
        };
        let job = AttachPass::new(gpu)?.prepare(gpu, buffers)?;
        gpu.run("verify", |encoder| job.record(encoder))?;
        Ok(rows.check(gpu, |found| self.judged(view.cell, found))?)
    }

    /// Rows of attached meshes must be those of the reference within their bound, and all others untouched.
    fn judged(&self, cell: IVec3, found: &[[f32; 4]]) -> Comparison {
        let mut expected: Vec<Option<(Affine, Affine)>> = vec![None; INSTANCES as usize];
        for attachment in &self.attachments {
            let scene = (&self.instances[..], &self.allowed[..]);
            let right = attached(&self.params, attachment, cell, scene, &self.model_matrices);
            expected[attachment.mesh as usize] = Some((right, self.sizes(attachment, cell)));
        }
        let judge = |(at, entry): (usize, &f32)| {
            let (instance, row, column) = (at / 12, at / 4 % 3, at % 4);
            let Some((right, sizes)) = &expected[instance] else {
                let is_right = entry.to_bits() == POISON;
                return Judgement {
                    ratio: if is_right { 0.0 } else { f64::INFINITY },
                    error: 0.0,
                    touches: false,
                };
            };
            let error = (f64::from(*entry) - f64::from(right[row][column])).abs();
            let bound = f64::from(ATTACH_BOUND) * f64::from(sizes[row][column]);
            Judgement { ratio: if error == 0.0 { 0.0 } else { error / bound }, error, touches: false }
        };
        let judgements: Vec<Judgement> = found.as_flattened().iter().enumerate().map(judge).collect();
        each(&judgements, "entry", 0.0, |at| {
            format!("{:?} instead of {:?}", found[at / 4], expected[at / 12])
        })
    }

    /// The product of the three transforms with the absolute values of all entries.
    fn sizes(&self, attachment: &Attachment, cell: IVec3) -> Affine {
        let size = |affine: &Affine| affine.map(|row| row.map(f32::abs));
        let instance = &self.instances[(FIRST + attachment.character) as usize];
        let (axes, at) = (instance.axes(), instance.position(cell));
        let scale = instance.largest_scale();
        // Entries of a rotation cancel: each is computed from terms of at most its scale.
        let placement = std::array::from_fn(|row| {
            let of_axis = |axis: usize| axes[axis][row].abs().max(scale);
            [of_axis(0), of_axis(1), of_axis(2), at[row].abs().max(instance.offset[row].abs())]
        });
        let bone = &self.model_matrices[(attachment.character * BONES + attachment.bone) as usize];
        product(&placement, &product(&size(bone), &size(&attachment.offset)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_wrong_of_one_mesh_is_seen() {
        let case = Case::random(3, 65);
        let mut rows = vec![[f32::from_bits(POISON); 4]; 3 * INSTANCES as usize];
        for attachment in &case.attachments {
            let scene = (&case.instances[..], &case.allowed[..]);
            let right = attached(&case.params, attachment, CELL, scene, &case.model_matrices);
            rows[3 * attachment.mesh as usize..][..3].copy_from_slice(&right);
        }
        assert!(case.judged(CELL, &rows).holds);
        let is_seen = |attachment: &&Attachment| case.allowed[(FIRST + attachment.character) as usize] >= 0.0;
        let [seen, unseen] = [true, false].map(|seen| {
            let found = case.attachments.iter().find(|attachment| is_seen(attachment) == seen);
            3 * found.expect("some").mesh as usize
        });
        let untouched = rows.iter().position(|row| row[0].to_bits() == POISON).expect("some");
        for (at, wrong) in [(seen, 1.001), (seen + 2, f32::NAN), (unseen, 2.0), (untouched, 0.5)] {
            let mut found = rows.clone();
            found[at][3] = if found[at][3] == 0.0 { 1.0 } else { wrong * found[at][3] };
            assert!(!case.judged(CELL, &found).holds, "{at} {wrong}");
        }
        let mut found = rows.clone();
        found[unseen][0] = 1e-3;
        assert!(!case.judged(CELL, &found).holds, "an unseen mesh that is drawn");
    }
}
