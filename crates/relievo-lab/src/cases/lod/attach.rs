//! Parity and benchmark cases of `kernels/lod/attach.wgsl`.

use glam::IVec3;
use relievo::Error;
use relievo::asset::Affine;
use relievo::asset::transform::AFFINE_IDENTITY;
use relievo::gpu::{Buffer, Gpu, Job, Uniform};
use relievo::ops::animation::ModelMatrices;
use relievo::ops::lod::attach::reference::{AttachScene, attached, last_local, local, product};
use relievo::ops::lod::attach::{
    ATTACH_BOUND, AttachBuffers, AttachParams, AttachPass, Attachment, KeptBone, NO_MESH,
};
use relievo::ops::lod::select::Allowed;
use relievo::ops::lod::{SceneInstance, SelectView};

use crate::cases::animation::Draw;
use crate::cases::lod::{CELL, frame, random_instances};
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// Bones of the characters.
const BONES: u32 = 5;

/// The instances of the scene, and the first of the character.
const INSTANCES: u32 = 192;
const FIRST: u32 = 64;

/// Entries of the buffer beyond those that are attached.
const ROOM: u32 = 70;

/// What is attached to what.
struct Case {
    params: AttachParams,
    attachments: Vec<Attachment>,
    instances: Vec<SceneInstance>,
    last_instances: Vec<SceneInstance>,
    allowed: Vec<Allowed>,
    model_matrices: Vec<Affine>,
    kept: Vec<[KeptBone; 2]>,
}

/// The cases cover numbers of attached meshes around a workgroup's, fewer than there is room for, and views in whose cell the
/// instances are and from far away; a third of the characters is not seen, and an eighth of the entries is free. The last frame
/// is not kept, or kept, in even frames and odd ones, of some attachments or of none; then the view is recorded twice.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let view = frame()?[0].1;
    for (number, attached) in (0..).zip([0, 1, 63, 64, 65, 100]) {
        for cell in [CELL, CELL + IVec3::new(-3, 1, 700)] {
            for frames in [None, Some([8, 7]), Some([9, 8]), Some([1, 0])] {
                let case = Case::random(number, attached, frames);
                let view = SelectView { cell, ..view };
                let comparison = case.compared(gpu, &view).await?;
                cases.add(format!("{attached} attached, cell {cell}, frames {frames:?}"), comparison);
            }
        }
    }
    Ok(())
}

/// An attachment that is not there.
const FREE: Attachment = Attachment { mesh: NO_MESH, character: 0, bone: 0, key: 0, offset: [[1.0; 4]; 3] };

impl Case {
    /// Meshes that are attached to bones of characters, all of them other instances, in a frame and the one before, if that is
    /// kept.
    fn random(case: u32, attached: u32, frames: Option<[u32; 2]>) -> Self {
        let mut draw = Draw::new(case ^ 0xa77a);
        let count = INSTANCES as usize;
        let [instances, last_instances] = [case, case ^ 0x1a57].map(|seed| random_instances(seed, count));
        let displacement = |draw: &mut Draw| if draw.word().is_multiple_of(3) { -1.0 } else { 0.5 };
        let allowed = (0..INSTANCES)
            .map(|_| Allowed { displacement: displacement(&mut draw), distance: 9.0 })
            .collect();
        let characters = INSTANCES - FIRST;
        let mut affine = || [0; 3].map(|_| [0; 4].map(|_| 2.0 * draw.signed()));
        let model_matrices: Vec<Affine> = (0..characters * BONES).map(|_| affine()).collect();
        let offsets: Vec<Affine> = (0..attached).map(|_| affine()).collect();
        let past: Vec<[Affine; 2]> = (0..attached + ROOM).map(|_| [affine(), affine()]).collect();
        let attachment = |(at, offset): (u32, &Affine)| Attachment {
            // Meshes before the characters, and behind each other in another order.
            mesh: if at % 8 == 5 { NO_MESH } else { (at * 29 + 7) % INSTANCES },
            character: draw.word() % characters,
            bone: draw.word() % BONES,
            key: 1000 + at,
            offset: *offset,
        };
        let attachments = (0..).zip(&offsets).map(attachment).collect();
        let [frame, last_frame] = frames.unwrap_or([5, 4]);
        // Of every third attachment another one's transform is kept, and of every fourth that of an earlier frame.
        let kept = |(at, rows): (u32, &[Affine; 2])| {
            [0, 1].map(|parity| {
                let age = if at % 4 == 1 { 2 } else { 0 };
                let newest = if frame % 2 == parity { frame.wrapping_sub(2) } else { last_frame };
                let key = if at % 3 == 2 { 1 } else { 1000 + at };
                let (rows, frame) = (rows[parity as usize], newest.wrapping_sub(age));
                KeptBone { rows, frame, key, unused_a: 0, unused_b: 0 }
            })
        };
        let kept = (0..).zip(&past).map(kept).collect();
        let first_last = if frames.is_some() { INSTANCES } else { 0 };
        let params = AttachParams { attached, bones: BONES, first: FIRST, first_last, frame, last_frame };
        Self { params, attachments, instances, last_instances, allowed, model_matrices, kept }
    }

    /// The placements of attached meshes, prepared. There is room for more than there are.
    fn prepared(
        &self,
        gpu: &Gpu,
        pass: &AttachPass,
        view: &SelectView,
        placements: &Buffer<Affine>,
        kept: &Buffer<KeptBone>,
    ) -> Result<Job, Error> {
        let mut room = self.attachments.clone();
        room.resize(room.len() + ROOM as usize, Attachment { mesh: 0, ..FREE });
        let matrices = ModelMatrices::new(&Buffer::from_slice(gpu, "model matrices", &self.model_matrices)?);
        let buffers = AttachBuffers {
            view: &Uniform::new(gpu, "view", view)?,
            attachments: &Buffer::from_slice(gpu, "attachments", &room)?,
            model_matrices: &matrices.buffer().cast(),
            instances: &Buffer::from_slice(gpu, "instances", &self.instances)?,
            allowed: &Buffer::from_slice(gpu, "allowed", &self.allowed)?,
            placements,
            last_instances: &Buffer::from_slice(gpu, "last instances", &self.last_instances)?,
            kept,
        };
        pass.prepare(gpu, &Uniform::new(gpu, "params", &self.params)?, buffers)
    }

    async fn compared(&self, gpu: &Gpu, view: &SelectView) -> Result<Comparison, Error> {
        let placements = Poisoned::<Affine>::new(gpu, 2 * INSTANCES as usize)?;
        let kept = Buffer::from_slice(gpu, "kept", self.kept.as_flattened())?;
        let job = self.prepared(gpu, &AttachPass::new(gpu)?, view, &placements.buffer, &kept)?;
        gpu.submit("verify", |encoder| {
            job.record(encoder);
            job.record(encoder);
        })?;
        let found = bytemuck::cast_slice(&kept.read(gpu).await?).to_vec();
        match self.is_kept(&found) {
            true => Ok(placements.check(gpu, |found| self.judged(view.cell, found)).await?),
            false => Ok(Comparison::failed(2 * self.kept.len(), "kept bones are wrong".to_owned())),
        }
    }

    /// The product of bone and offset of an attachment now and, as far as it is known, in the last frame.
    fn locals(&self, at: usize) -> [Affine; 2] {
        let now = local(&self.params, &self.attachments[at], &self.model_matrices);
        [now, last_local(&self.params, &self.attachments[at], &self.kept[at], &now)]
    }

    /// The attachments that are there, with their entries.
    fn there(&self) -> impl Iterator<Item = (usize, &Attachment)> {
        self.attachments.iter().enumerate().filter(|(_, attachment)| attachment.mesh != NO_MESH)
    }

    /// Whether all but the entries of this frame are untouched, and these are the products of bone and offset, of the
    /// meshes whose characters are seen.
    fn is_kept(&self, found: &[[KeptBone; 2]]) -> bool {
        let mut expected = self.kept.clone();
        for (at, attachment) in self.there() {
            let is_seen = self.allowed[(FIRST + attachment.character) as usize].displacement >= 0.0;
            if self.params.first_last != 0 && is_seen {
                let (frame, key) = (self.params.frame, attachment.key);
                let rows = self.locals(at)[0];
                let now = KeptBone { rows, frame, key, unused_a: 0, unused_b: 0 };
                let rows = &found[at][frame as usize % 2].rows;
                let bone = (attachment.character * BONES + attachment.bone) as usize;
                let sizes = product(&size(&self.model_matrices[bone]), &size(&attachment.offset));
                let is_near = (rows.as_flattened().iter())
                    .zip(now.rows.as_flattened())
                    .zip(sizes.as_flattened())
                    .all(|((found, right), size)| (found - right).abs() <= ATTACH_BOUND * size);
                if !is_near {
                    return false;
                }
                expected[at][frame as usize % 2] = KeptBone { rows: *rows, ..now };
            }
        }
        bytemuck::cast_slice::<_, u32>(&expected) == bytemuck::cast_slice::<_, u32>(found)
    }

    /// Placements of attached meshes must be those of the reference within their bound, and all others untouched.
    fn judged(&self, cell: IVec3, found: &[Affine]) -> Comparison {
        let mut expected: Vec<Option<(Affine, Affine)>> = vec![None; 2 * INSTANCES as usize];
        for (at, attachment) in self.there() {
            let all = [&self.instances[..], &self.last_instances[..]];
            let frames = if self.params.first_last == 0 { 1 } else { 2 };
            for (frame, (instances, local)) in all.into_iter().zip(self.locals(at)).enumerate().take(frames) {
                let scene = AttachScene { instances, allowed: &self.allowed };
                let right = attached(&self.params, attachment, cell, scene, &local);
                let instance = &instances[(FIRST + attachment.character) as usize];
                let sizes = self.sizes(instance, attachment, &local, cell);
                expected[frame * INSTANCES as usize + attachment.mesh as usize] = Some((right, sizes));
            }
        }
        let judge = |(at, entry): (usize, &f32)| {
            let (instance, row, column) = (at / 12, at / 4 % 3, at % 4);
            let Some((right, sizes)) = &expected[instance] else {
                return Judgement::exact(entry.to_bits() == POISON, 0.0, false);
            };
            let error = (f64::from(*entry) - f64::from(right[row][column])).abs();
            let bound = f64::from(ATTACH_BOUND) * f64::from(sizes[row][column]);
            Judgement { ratio: if error == 0.0 { 0.0 } else { error / bound }, error, touches: false }
        };
        let judgements: Vec<Judgement> =
            found.as_flattened().as_flattened().iter().enumerate().map(judge).collect();
        each(&judgements, "entry", 0.0, |at| {
            format!("{:?} instead of {:?}", found[at / 12][at / 4 % 3], expected[at / 12])
        })
    }

    /// The product of the transforms with the absolute values of all entries; what was kept counts with its own.
    fn sizes(
        &self,
        instance: &SceneInstance,
        attachment: &Attachment,
        local: &Affine,
        cell: IVec3,
    ) -> Affine {
        let (axes, at) = (instance.axes(), instance.position(cell));
        let scale = instance.largest_scale();
        // Entries of a rotation cancel: each is computed from terms of at most its scale.
        let placement = std::array::from_fn(|row| {
            let of_axis = |axis: usize| axes[axis][row].abs().max(scale);
            [of_axis(0), of_axis(1), of_axis(2), at[row].abs().max(instance.offset[row].abs())]
        });
        let bone = &self.model_matrices[(attachment.character * BONES + attachment.bone) as usize];
        let of_bone = product(&size(bone), &size(&attachment.offset));
        let local = size(local);
        let largest: Affine =
            std::array::from_fn(|row| std::array::from_fn(|at| of_bone[row][at].max(local[row][at])));
        product(&placement, &largest)
    }
}

fn size(affine: &Affine) -> Affine {
    affine.map(|row| row.map(f32::abs))
}

/// Bones of a character.
const MEASURED_BONES: u32 = 60;

/// Measures characters that each hold one mesh.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = AttachPass::new(gpu)?;
    let view = frame()?[0].1;
    for count in [1_000, 10_000_u32] {
        let instances = random_instances(1, 2 * count as usize);
        let attachment = |character: u32| Attachment {
            mesh: count + character,
            character,
            bone: character % MEASURED_BONES,
            key: character,
            offset: AFFINE_IDENTITY,
        };
        let case = Case {
            params: AttachParams {
                attached: count,
                bones: MEASURED_BONES,
                first: 0,
                first_last: 0,
                frame: 1,
                last_frame: 0,
            },
            attachments: (0..count).map(attachment).collect(),
            allowed: vec![Allowed { displacement: 0.5, distance: 9.0 }; instances.len()],
            model_matrices: vec![AFFINE_IDENTITY; (count * MEASURED_BONES) as usize],
            last_instances: instances.clone(),
            instances,
            kept: Vec::new(),
        };
        let (entries, instances) = ((count + ROOM) as usize, case.instances.len());
        let placements = Buffer::new(gpu, "placements", 2 * instances)?;
        let job = case.prepared(gpu, &pass, &view, &placements, &Buffer::new(gpu, "kept", 2 * entries)?)?;
        // The kernel reads an attachment, a bone, an instance and what it is allowed, and writes three rows.
        let words = (16 + 12 + 24 + 1 + 12) * count as usize;
        let name = format!("{count} meshes");
        measure(bench, name, count as usize, "mesh", words, &|encoder| job.record(encoder), || {
            let Case { params, attachments, instances, allowed, model_matrices, .. } = &case;
            let scene = AttachScene { instances, allowed };
            let of = |of| attached(params, of, view.cell, scene, &local(params, of, model_matrices));
            attachments.iter().map(of).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The placements that are right, with poison where nothing is written.
    fn right(case: &Case) -> Vec<Affine> {
        let mut placements = vec![[[f32::from_bits(POISON); 4]; 3]; 2 * INSTANCES as usize];
        for (at, attachment) in case.there() {
            let [now, last] = case.locals(at);
            for (first, instances, local) in
                [(0, &case.instances, now), (INSTANCES, &case.last_instances, last)]
            {
                let scene = AttachScene { instances, allowed: &case.allowed };
                let right = attached(&case.params, attachment, CELL, scene, &local);
                placements[(first + attachment.mesh) as usize] = right;
            }
        }
        placements
    }

    #[test]
    fn what_is_wrong_of_one_mesh_is_seen() {
        let case = Case::random(3, 65, Some([8, 7]));
        let placements = right(&case);
        assert!(case.judged(CELL, &placements).holds);
        let is_seen = |attachment: &Attachment| {
            case.allowed[(FIRST + attachment.character) as usize].displacement >= 0.0
        };
        let [seen, unseen] = [true, false].map(|seen| {
            let found = case.there().find(|(_, attachment)| is_seen(attachment) == seen);
            found.expect("some").1.mesh as usize
        });
        let untouched = placements.iter().position(|rows| rows[0][0].to_bits() == POISON).expect("some");
        let last = INSTANCES as usize + seen;
        for ([at, row], wrong) in [
            ([seen, 0], 1.001),
            ([seen, 2], f32::NAN),
            ([last, 0], 1.001),
            ([unseen, 0], 2.0),
            ([untouched, 0], 0.5),
        ] {
            let mut found = placements.clone();
            let value = &mut found[at][row][3];
            *value = if *value == 0.0 { 1.0 } else { wrong * *value };
            assert!(!case.judged(CELL, &found).holds, "{at} {wrong}");
        }
        let mut found = placements.clone();
        found[unseen][0][0] = 1e-3;
        assert!(!case.judged(CELL, &found).holds, "an unseen mesh that is drawn");
    }

    /// Bones are kept of the last frame, of the same attachment, and nothing else counts as the last frame's.
    #[test]
    fn what_is_kept_wrongly_is_seen() {
        let case = Case::random(3, 65, Some([9, 8]));
        let mut kept = case.kept.clone();
        for (at, attachment) in case.there() {
            if case.allowed[(FIRST + attachment.character) as usize].displacement >= 0.0 {
                kept[at][1] =
                    KeptBone { rows: case.locals(at)[0], frame: 9, key: attachment.key, ..kept[at][1] };
            }
        }
        assert!(case.is_kept(&kept));
        assert!(!case.is_kept(&case.kept), "nothing is kept");
        let first = (0..65).find(|at| kept[*at][1].frame == 9).expect("some are seen");
        let free = (0..65).find(|at| case.attachments[*at].mesh == NO_MESH).expect("some are free");
        let faults: [fn(&mut [KeptBone; 2]); 4] = [
            |entry| entry[1].rows[2][3] += 0.1,
            |entry| entry[1].key += 1,
            |entry| entry[1].frame += 1,
            |entry| entry[0].frame += 1,
        ];
        for (number, fault) in faults.into_iter().enumerate() {
            for at in [first, free] {
                let mut wrong = kept.clone();
                fault(&mut wrong[at]);
                assert!(!case.is_kept(&wrong), "fault {number} of entry {at}");
            }
        }
        let moved = case.there().filter(|(at, _)| case.locals(*at)[0] != case.locals(*at)[1]).count();
        assert!(moved > 15 && moved < case.there().count(), "{moved} have a last frame");
        let first = Case::random(3, 65, Some([1, 0]));
        assert!(first.there().all(|(at, _)| first.locals(at)[0] == first.locals(at)[1]));
    }
}
