//! Parity and benchmark cases of `kernels/lod/list.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu, Job};
use relievo::ops::lod::list::reference::{before_blocks, lists};
use relievo::ops::lod::list::{ListBuffers, ListPass};
use relievo::ops::lod::{BLOCK, LodObject, OBJECT_LISTS, SceneDraw};
use relievo::shared::lod::object::{FADE_PROGRESS, MORPH_STEPS, decision_word, object_flags_transition};
use relievo::shared::lod::transition::{TRANSITION_GEOMORPH, TRANSITION_HARD};

use crate::cases::animation::Draw;
use crate::cases::lod::{Blocks, SIZES};
use crate::cases::measure;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases, compare};

/// How instances are spread over lists.
const KINDS: [&str; 4] = ["none seen", "all in one list", "some in every list", "few"];

/// The cases cover no instance seen, all of them in one list, and some or few in every list; one object and several, one
/// without instances, blocks of no object with decisions that mean nothing, and objects whose blocks no power of two
/// divides. Memory outside the lists and draws must stay untouched. The last block of the larger scenes is left out.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = ListPass::new(gpu)?;
    for (case, sizes) in (0..).zip(SIZES) {
        let blocks = Blocks::new(case, sizes);
        for kind in KINDS {
            let decisions = random_decisions(case, kind, &blocks);
            let words = OBJECT_LISTS as usize * blocks.block_objects.len();
            let (count, list) = (Poisoned::new(gpu, words)?, Poisoned::new(gpu, blocks.list_words())?);
            let arguments = Poisoned::<SceneDraw>::new(gpu, blocks.draws())?;
            count.buffer.write(gpu, &blocks.counts(&decisions))?;
            let (counts, lists, draws) = (&count.buffer, &list.buffer, &arguments.buffer);
            let job = prepared(gpu, &pass, &blocks, &decisions, counts, lists, draws)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let name = format!("{} blocks, {kind}", blocks.block_objects.len());
            let expected = Written::expected(&blocks, &decisions);
            cases.exact(format!("{name}: counts"), &count, &expected.counts).await?;
            cases.exact(format!("{name}: lists"), &list, &expected.lists).await?;
            let compared =
                |all: &[SceneDraw]| compare::exact(bytemuck::cast_slice::<_, u32>(all), &expected.arguments);
            cases.check(format!("{name}: arguments"), &arguments, compared).await?;
        }
    }
    Ok(())
}

/// Decisions of all instances, also of those in blocks of no object.
fn random_decisions(case: u32, kind: &str, blocks: &Blocks) -> Vec<u32> {
    let mut draw = Draw::new(case ^ 0x1157);
    let mut decision = |index: usize| match (kind, blocks.object_of(index)) {
        (_, None) => draw.word() | 1,
        ("none seen", _) => 0,
        ("few", _) if !draw.word().is_multiple_of(40) => 0,
        ("all in one list", Some(object)) => {
            decision_word(1, case % 2, object.levels - 1, object.levels - 1, 0)
        }
        (_, Some(_)) if draw.word().is_multiple_of(5) => 0,
        (_, Some(object)) => random_decision(&mut draw, object),
    };
    (0..BLOCK as usize * blocks.block_objects.len()).map(&mut decision).collect()
}

/// A decision of a visible instance, changing its level or not.
pub(crate) fn random_decision(draw: &mut Draw, object: &LodObject) -> u32 {
    let level = draw.word() % object.levels;
    let is_changing = draw.word().is_multiple_of(2);
    let (next, steps) = match object_flags_transition(object.flags) {
        TRANSITION_HARD => (level, 0),
        _ if !is_changing => (level, 0),
        TRANSITION_GEOMORPH => (level, draw.word() % (MORPH_STEPS + 1)),
        // The levels of a fade differ.
        _ if object.levels > 1 => {
            ((level + 1 + draw.word() % (object.levels - 1)) % object.levels, draw.word() % FADE_PROGRESS)
        }
        _ => (level, 0),
    };
    let next = if steps == 0 { level } else { next };
    decision_word(1, draw.word() % 2, level, next, steps)
}

/// The lists of a scene, prepared with counts, lists and draws as outputs.
fn prepared(
    gpu: &Gpu,
    pass: &ListPass,
    blocks: &Blocks,
    decisions: &[u32],
    counts: &Buffer<u32>,
    lists: &Buffer<u32>,
    arguments: &Buffer<SceneDraw>,
) -> Result<Job, Error> {
    let buffers = ListBuffers {
        objects: &Buffer::from_slice(gpu, "objects", &blocks.objects)?,
        block_objects: &Buffer::from_slice(gpu, "block_objects", &blocks.block_objects)?,
        decisions: &Buffer::from_slice(gpu, "decisions", decisions)?,
        counts,
        lists,
        arguments,
    };
    pass.prepare(gpu, buffers, blocks.objects.len() as u32, blocks.block_objects.len() as u32)
}

/// What the kernel writes, and poison where it does not.
struct Written {
    counts: Vec<u32>,
    lists: Vec<u32>,
    arguments: Vec<u32>,
}

impl Written {
    /// What the reference writes.
    fn expected(blocks: &Blocks, decisions: &[u32]) -> Self {
        let mut written = Self {
            counts: blocks.counts(decisions),
            lists: vec![POISON; blocks.list_words()],
            arguments: vec![POISON; size_of::<SceneDraw>() / 4 * blocks.draws()],
        };
        for object in &blocks.objects {
            let own = (OBJECT_LISTS * object.first / BLOCK) as usize..;
            let own = &mut written.counts[own][..(OBJECT_LISTS * object.instances / BLOCK) as usize];
            own.copy_from_slice(&before_blocks(own));
            let lists = lists(object, decisions);
            assert!(lists[object.lists() as usize..].iter().all(Vec::is_empty), "no such list");
            // Draws of lists that the object does not have get the count 0.
            for (list, members) in (0..).zip(lists) {
                if list < object.lists() {
                    let begin = object.list_begin(list) as usize;
                    written.lists[begin..][..members.len()].copy_from_slice(&members);
                }
                for part in 0..object.parts {
                    // The second of a draw's words is the number of its instances.
                    let draw = size_of::<SceneDraw>() / 4 * object.draw(part, list) as usize;
                    written.arguments[draw + 1] = members.len() as u32;
                }
            }
        }
        written
    }
}

/// Measures one object of which a third is seen in lists of all levels, and a hundred of them.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = ListPass::new(gpu)?;
    for (name, sizes) in [("1 object", vec![16]), ("1 object", vec![1_600]), ("100 objects", vec![16; 100])] {
        let blocks = Blocks::new(0, &sizes);
        let all = blocks.block_objects.len();
        let count = BLOCK as usize * all;
        let mut draw = Draw::new(1);
        let mut decision = |index: usize| match blocks.object_of(index) {
            Some(object) if draw.word().is_multiple_of(3) => random_decision(&mut draw, object),
            _ => 0,
        };
        let decisions: Vec<u32> = (0..count).map(&mut decision).collect();
        let fresh = Buffer::from_slice(gpu, "fresh counts", &blocks.counts(&decisions))?;
        let sums = Buffer::new(gpu, "counts", OBJECT_LISTS as usize * all)?;
        let listed = Buffer::new(gpu, "lists", blocks.list_words())?;
        let arguments = Buffer::new(gpu, "arguments", blocks.draws())?;
        let job = prepared(gpu, &pass, &blocks, &decisions, &sums, &listed, &arguments)?;
        let seen = decisions.iter().filter(|decision| **decision > 0).count();
        // The kernel reads the counts twice and writes them, reads the decisions, and writes an index of each that is seen.
        // It overwrites the counts, so they are copied anew each time, and that is a part of its time.
        let words = 5 * OBJECT_LISTS as usize * all + count + seen;
        let name = format!("{count} instances, {name}");
        let record = |encoder: &mut wgpu::CommandEncoder| {
            encoder.copy_buffer_to_buffer(fresh.raw(), 0, sums.raw(), 0, fresh.bytes());
            job.record(encoder);
        };
        measure(bench, name, count, "instance", words, &record, || {
            blocks.objects.iter().map(|object| lists(object, &decisions)).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}
