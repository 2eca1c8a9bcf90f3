//! Parity and benchmark cases of `kernels/lod/list.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::lod::list::pass::Threads;
use relievo::lod::list::reference::{before_blocks, lists};
use relievo::lod::list::{ListBuffers, ListPass};
use relievo::lod::select::reference::counts;
use relievo::lod::{BLOCK, OBJECT_LISTS, SceneDraw};
use relievo::shared::lod::object::decision_word;

use crate::cases::animation::Draw;
use crate::cases::lod::{Blocks, SIZES};
use crate::cases::terrain::copy_of;
use crate::harness::compare::Comparison;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// How instances are spread over lists.
const KINDS: [&str; 4] = ["none seen", "all in one list", "some in every list", "few"];

/// The cases cover no instance seen, all of them in one list, and some or few in every list; one object and several, one
/// without instances, blocks of no object with decisions that mean nothing, and objects whose blocks no power of two
/// divides. Memory outside the lists and draws must stay untouched. The last block of the larger scenes is left out.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    for threads in [Threads::Instances, Threads::Blocks] {
        with_threads(cases, threads).await?;
    }
    Ok(())
}

async fn with_threads(cases: &mut Cases<'_>, threads: Threads) -> Result<(), Error> {
    let pass = ListPass::with_threads(cases.gpu, threads)?;
    for (case, sizes) in (0..).zip(SIZES) {
        let blocks = Blocks::new(case, sizes);
        for kind in KINDS {
            let decisions = random_decisions(case, kind, &blocks);
            let (ends, found) = run(cases.gpu, &pass, &blocks, &decisions).await?;
            let name =
                format!("{} blocks, {kind}, a thread for each of {threads:?}", blocks.block_objects.len());
            ends.into_iter().for_each(|(output, end)| cases.add(format!("{name}: the end of {output}"), end));
            let expected = Written::expected(&blocks, &decisions, threads);
            for (what, comparison) in found.compared(&expected) {
                cases.add(format!("{name}: {what}"), comparison);
            }
        }
    }
    Ok(())
}

/// Decisions of all instances, also of those in blocks of no object.
fn random_decisions(case: u32, kind: &str, blocks: &Blocks) -> Vec<u32> {
    let mut draw = Draw::new(case ^ 0x1157);
    // Lists keep what is above, of every other instance.
    let moved = |index: usize, decision: u32| match decision {
        0 => 0,
        decision => decision_word(decision, if index.is_multiple_of(2) { 0x5a3 } else { 0 }),
    };
    let mut decision = |index: usize| match kind {
        _ if blocks.object_of(index).is_none() => 1 + draw.word() % OBJECT_LISTS,
        "none seen" => 0,
        "all in one list" => 1 + case,
        "few" if !draw.word().is_multiple_of(40) => 0,
        _ => draw.word() % (1 + OBJECT_LISTS),
    };
    (0..BLOCK as usize * blocks.block_objects.len()).map(|index| moved(index, decision(index))).collect()
}

/// What the kernel wrote, and in it poison where it did not.
#[derive(Clone)]
struct Written {
    counts: Vec<u32>,
    lists: Vec<u32>,
    arguments: Vec<u32>,
}

/// Whether an output's end is untouched, by its name.
type Ends = Vec<(&'static str, Comparison)>;

async fn run(
    gpu: &Gpu,
    pass: &ListPass,
    blocks: &Blocks,
    decisions: &[u32],
) -> Result<(Ends, Written), Error> {
    let words = OBJECT_LISTS as usize * blocks.block_objects.len();
    let (count, list) = (Poisoned::new(gpu, words)?, Poisoned::new(gpu, blocks.list_words())?);
    let arguments = Poisoned::<SceneDraw>::new(gpu, blocks.draws())?;
    count.buffer.write(gpu, &counts(decisions))?;
    let buffers = ListBuffers {
        objects: &Buffer::from_slice(gpu, "objects", &blocks.objects)?,
        block_objects: &Buffer::from_slice(gpu, "block_objects", &blocks.block_objects)?,
        decisions: &Buffer::from_slice(gpu, "decisions", decisions)?,
        counts: &count.buffer,
        lists: &list.buffer,
        arguments: &arguments.buffer,
    };
    let all = blocks.block_objects.len() as u32;
    let job = pass.prepare(gpu, buffers, blocks.objects.len() as u32, all)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let mut found = Written { counts: vec![], lists: vec![], arguments: vec![] };
    let same = || compare::exact(&[0], &[0]);
    let ends = vec![
        (
            "counts",
            count
                .check(gpu, |all| {
                    found.counts = all.to_vec();
                    same()
                })
                .await?,
        ),
        (
            "lists",
            list.check(gpu, |all| {
                found.lists = all.to_vec();
                same()
            })
            .await?,
        ),
        (
            "arguments",
            arguments
                .check(gpu, |all| {
                    found.arguments = bytemuck::cast_slice(all).to_vec();
                    same()
                })
                .await?,
        ),
    ];
    Ok((ends, found))
}

impl Written {
    /// What the reference writes. Threads for blocks count on in the counts.
    fn expected(blocks: &Blocks, decisions: &[u32], threads: Threads) -> Self {
        let mut written = Self {
            counts: counts(decisions),
            lists: vec![POISON; blocks.list_words()],
            arguments: vec![POISON; size_of::<SceneDraw>() / 4 * blocks.draws()],
        };
        for object in &blocks.objects {
            let own = (OBJECT_LISTS * object.first / BLOCK) as usize..;
            let own = &mut written.counts[own][..(OBJECT_LISTS * object.instances / BLOCK) as usize];
            let before = before_blocks(own);
            match threads {
                Threads::Instances => own.copy_from_slice(&before),
                Threads::Blocks => own.iter_mut().zip(before).for_each(|(own, before)| *own += before),
            }
            for (list, members) in (0..).zip(lists(object, decisions)) {
                written.lists[object.list_begin(list) as usize..][..members.len()].copy_from_slice(&members);
                for part in 0..object.parts {
                    // The second of a draw's words is the number of its instances.
                    let draw = size_of::<SceneDraw>() / 4 * object.draw(part, list) as usize;
                    written.arguments[draw + 1] = members.len() as u32;
                }
            }
        }
        written
    }

    fn compared(&self, expected: &Self) -> [(&'static str, Comparison); 3] {
        [
            ("counts", compare::exact(&self.counts, &expected.counts)),
            ("lists", compare::exact(&self.lists, &expected.lists)),
            ("arguments", compare::exact(&self.arguments, &expected.arguments)),
        ]
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
        let decision = |_| (draw.word() % (3 * OBJECT_LISTS)).saturating_sub(2 * OBJECT_LISTS - 1);
        let decisions: Vec<u32> = (0..count).map(decision).collect();
        let fresh = Buffer::from_slice(gpu, "fresh counts", &counts(&decisions))?;
        let sums = Buffer::new(gpu, "counts", OBJECT_LISTS as usize * all)?;
        let buffers = ListBuffers {
            objects: &Buffer::from_slice(gpu, "objects", &blocks.objects)?,
            block_objects: &Buffer::from_slice(gpu, "block_objects", &blocks.block_objects)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &decisions)?,
            counts: &sums,
            lists: &Buffer::new(gpu, "lists", blocks.list_words())?,
            arguments: &Buffer::new(gpu, "arguments", blocks.draws())?,
        };
        let job = pass.prepare(gpu, buffers, blocks.objects.len() as u32, all as u32)?;
        let seen = decisions.iter().filter(|decision| **decision > 0).count();
        // The kernel reads the counts twice and writes them, reads the decisions, and writes an index of each that is seen.
        // It overwrites the counts, so they are copied anew each time, and that is a part of its time.
        let words = 5 * OBJECT_LISTS as usize * all + count + seen;
        let copied = copy_of(gpu, words / 2)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| {
                encoder.copy_buffer_to_buffer(fresh.raw(), 0, sums.raw(), 0, fresh.bytes());
                job.record(encoder);
            }),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                let all = blocks.objects.iter().map(|object| lists(object, &decisions));
                drop(std::hint::black_box(all.collect::<Vec<_>>()));
            }),
        ];
        bench.case(
            format!("{count} instances, {name}"),
            (count, "instance"),
            4 * words as u64,
            contenders,
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_in_another_order_and_a_foreign_word_are_seen() {
        let blocks = Blocks::new(3, &[3, 2]);
        let decisions = random_decisions(3, "some in every list", &blocks);
        let right = Written::expected(&blocks, &decisions, Threads::Instances);
        let faults = |found: &Written| {
            let compared = found.compared(&right).into_iter();
            compared.filter(|(_, comparison)| !comparison.holds).map(|(what, _)| what).collect::<Vec<_>>()
        };
        assert_eq!(faults(&right), Vec::<&str>::new());
        let object = &blocks.objects[0];
        let begin = object.list_begin(4) as usize;
        let swapped = {
            let mut found = right.clone();
            found.lists.swap(begin, begin + 1);
            found
        };
        assert_eq!(faults(&swapped), ["lists"]);
        // Behind the last member of a list.
        let members = lists(object, &decisions)[4].len();
        let long = {
            let mut found = right.clone();
            found.lists[begin + members] = 0;
            found
        };
        assert_eq!(faults(&long), ["lists"]);
        let totals = {
            let mut found = right.clone();
            found.arguments[5 * object.draw(0, 4) as usize + 1] += 1;
            found
        };
        assert_eq!(faults(&totals), ["arguments"]);
        let sums = {
            let mut found = right.clone();
            found.counts[20] += 1;
            found
        };
        assert_eq!(faults(&sums), ["counts"]);
    }
}
