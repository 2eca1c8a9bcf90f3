//! Parity and benchmark cases of `kernels/lod/sorted.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu, Job};
use relievo::ops::lod::sorted::reference::{draws, entries};
use relievo::ops::lod::sorted::{SortedBuffers, SortedDraw, SortedPass};
use relievo::ops::lod::{OBJECT_LISTS, SceneDraw};
use relievo::shared::lod::object::{decision_word, list_entry_instance};

use crate::cases::animation::Draw;
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// Random sorted draws, decisions (some of unseen instances), and indirect draws.
pub(crate) struct Given {
    pub sorted: Vec<SortedDraw>,
    pub decisions: Vec<u32>,
    pub arguments: Vec<SceneDraw>,
}

impl Given {
    /// `count` sorted draws of as many instances and a few parts.
    pub(crate) fn new(count: usize) -> Self {
        let mut draw = Draw::new(count as u32 ^ 0x51b1);
        let parts = 7;
        let single = |draw: &mut Draw| SortedDraw {
            instance: draw.word() % count.max(1) as u32,
            first_draw: 3 + OBJECT_LISTS * (draw.word() % parts),
            slot: list_entry_instance(draw.word()),
        };
        let argument = |draw: &mut Draw| SceneDraw {
            index_count: draw.word() % 1000,
            instance_count: draw.word(),
            first_index: draw.word(),
            base_vertex: draw.word(),
            first_instance: draw.word(),
        };
        Self {
            sorted: (0..count).map(|_| single(&mut draw)).collect(),
            decisions: (0..count)
                .map(|_| match (draw.word() % (3 + OBJECT_LISTS)).saturating_sub(2) {
                    0 => 0,
                    list => decision_word(list, draw.word() & 0xfff),
                })
                .collect(),
            arguments: (0..3 + OBJECT_LISTS * parts).map(|_| argument(&mut draw)).collect(),
        }
    }

    /// The draws and the lists of one, prepared.
    fn prepared(
        &self,
        gpu: &Gpu,
        pass: &SortedPass,
        (draws, entries): (&Buffer<SceneDraw>, &Buffer<u32>),
    ) -> Result<Job, Error> {
        let buffers = SortedBuffers {
            sorted: &Buffer::from_slice(gpu, "sorted", &self.sorted)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &self.decisions)?,
            arguments: &Buffer::from_slice(gpu, "arguments", &self.arguments)?,
            draws,
            entries,
        };
        pass.prepare(gpu, buffers, self.sorted.len() as u32)
    }

    /// What the reference writes.
    pub(crate) fn expected(&self) -> Vec<SceneDraw> {
        draws(&self.sorted, &self.decisions, &self.arguments)
    }
}

/// The cases cover numbers of draws around a workgroup's, instances that are not seen and those in each list.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = SortedPass::new(gpu)?;
    for count in [1, 63, 64, 65, 500] {
        let given = Given::new(count);
        let output = Poisoned::<SceneDraw>::new(gpu, count)?;
        let lists = Poisoned::<u32>::new(gpu, count)?;
        let job = given.prepared(gpu, &pass, (&output.buffer, &lists.buffer))?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let expected = given.expected();
        let same = |actual: &[SceneDraw]| compare::exact(words(actual), words(&expected));
        cases.check(format!("{count} draws"), &output, same).await?;
        let expected = entries(&given.sorted, &given.decisions);
        cases.exact(format!("{count} lists of one"), &lists, &expected).await?;
    }
    Ok(())
}

fn words(draws: &[SceneDraw]) -> &[u32] {
    bytemuck::cast_slice(draws)
}

/// Measures a thousand draws and a hundred thousand.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SortedPass::new(gpu)?;
    for count in [1_000, 100_000] {
        let given = Given::new(count);
        let outputs = (&Buffer::new(gpu, "draws", count)?, &Buffer::new(gpu, "entries", count)?);
        let job = given.prepared(gpu, &pass, outputs)?;
        // Three words and a decision are read, a draw of five is read and written, and an entry written.
        let words = 15 * count;
        let name = format!("{count} draws");
        measure(bench, name, (count, "draw"), words, &|encoder| job.record(encoder), || {
            (given.expected(), entries(&given.sorted, &given.decisions))
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draw_of_what_is_not_seen_or_of_another_list_is_noticed() {
        let given = Given::new(65);
        let right = given.expected();
        assert!(compare::exact(words(&right), words(&right)).holds);
        let unseen = given.sorted.iter().position(|single| given.decisions[single.instance as usize] == 0);
        for at in [unseen.expect("one of 65"), 64] {
            let mut wrong = right.clone();
            wrong[at].instance_count ^= 1;
            assert!(!compare::exact(words(&wrong), words(&right)).holds);
        }
        let lists = entries(&given.sorted, &given.decisions);
        let moved = lists.iter().position(|entry| entry >> 20 > 0).expect("one of 65");
        let still = entries(&given.sorted, &[0; 65]);
        assert!(still[moved] != lists[moved] && !compare::exact(&still, &lists).holds);
        let mut other = given.sorted.clone();
        other[3].first_draw += OBJECT_LISTS;
        let other = draws(&other, &vec![2; 65], &given.arguments);
        let all = draws(&given.sorted, &vec![2; 65], &given.arguments);
        assert!(!compare::exact(words(&other), words(&all)).holds);
    }
}
