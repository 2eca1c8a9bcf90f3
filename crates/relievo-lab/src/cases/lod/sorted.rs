//! Parity and benchmark cases of `kernels/lod/sorted.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu, Job};
use relievo::ops::lod::sorted::reference::draws;
use relievo::ops::lod::sorted::{SortedBuffers, SortedDraw, SortedPass};
use relievo::ops::lod::{LodObject, OBJECT_LISTS, SceneDraw};
use relievo::shared::lod::object::list_entry_instance;

use crate::cases::animation::Draw;
use crate::cases::lod::Blocks;
use crate::cases::lod::list::random_decision;
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// Random sorted draws, decisions (some of unseen instances), and indirect draws.
pub(crate) struct Given {
    pub sorted: Vec<SortedDraw>,
    pub objects: Vec<LodObject>,
    pub decisions: Vec<u32>,
    pub arguments: Vec<SceneDraw>,
}

impl Given {
    /// `count` sorted draws of as many instances and a few parts.
    pub(crate) fn new(count: usize) -> Self {
        let mut draw = Draw::new(count as u32 ^ 0x51b1);
        let parts = 7;
        // Objects with every transition. The instances of an object follow each other.
        let objects = Blocks::new(0, &[1; 8]).objects;
        let object_of = |instance: u32| instance % 8;
        let single = |draw: &mut Draw| {
            let instance = draw.word() % count.max(1) as u32;
            SortedDraw {
                instance,
                first_draw: 3 + OBJECT_LISTS * (draw.word() % parts),
                slot: list_entry_instance(draw.word()),
                object: object_of(instance),
            }
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
            decisions: (0..count as u32)
                .map(|at| match draw.word().is_multiple_of(10) {
                    true => 0,
                    false => random_decision(&mut draw, &objects[object_of(at) as usize]),
                })
                .collect(),
            arguments: (0..3 + OBJECT_LISTS * parts).map(|_| argument(&mut draw)).collect(),
            objects,
        }
    }

    /// The draws and the lists of one, prepared.
    fn prepared(
        &self,
        gpu: &Gpu,
        pass: &SortedPass,
        draws: &Buffer<SceneDraw>,
        entries: &Buffer<u32>,
    ) -> Result<Job, Error> {
        let buffers = SortedBuffers {
            sorted: &Buffer::from_slice(gpu, "sorted", &self.sorted)?,
            objects: &Buffer::from_slice(gpu, "objects", &self.objects)?,
            decisions: &Buffer::from_slice(gpu, "decisions", &self.decisions)?,
            arguments: &Buffer::from_slice(gpu, "arguments", &self.arguments)?,
            draws,
            entries,
        };
        pass.prepare(gpu, buffers, self.sorted.len() as u32)
    }

    /// What the reference writes: draws and entries.
    pub(crate) fn expected(&self) -> (Vec<SceneDraw>, Vec<u32>) {
        draws(&self.sorted, &self.objects, &self.decisions, &self.arguments).into_iter().unzip()
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
        let job = given.prepared(gpu, &pass, &output.buffer, &lists.buffer)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let (expected, entries) = given.expected();
        let same = |actual: &[SceneDraw]| compare::exact(words(actual), words(&expected));
        cases.check(format!("{count} draws"), &output, same).await?;
        cases.exact(format!("{count} lists of one"), &lists, &entries).await?;
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
        let (draws, entries) = (Buffer::new(gpu, "draws", count)?, Buffer::new(gpu, "entries", count)?);
        let job = given.prepared(gpu, &pass, &draws, &entries)?;
        // Three words and a decision are read, a draw of five is read and written, and an entry written.
        let words = 15 * count;
        let name = format!("{count} draws");
        measure(bench, name, count, "draw", words, &|encoder| job.record(encoder), || given.expected())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::shared::lod::object::list_entry_steps;

    #[test]
    fn a_draw_of_what_is_not_seen_or_of_another_list_is_noticed() {
        let given = Given::new(65);
        let (right, lists) = given.expected();
        assert!(compare::exact(words(&right), words(&right)).holds);
        let unseen = given.sorted.iter().position(|single| given.decisions[single.instance as usize] == 0);
        for at in [unseen.expect("one of 65"), 64] {
            let mut wrong = right.clone();
            wrong[at].instance_count ^= 1;
            assert!(!compare::exact(words(&wrong), words(&right)).holds);
        }
        let moved = lists.iter().position(|entry| list_entry_steps(*entry) > 0).expect("one of 65");
        let still = Given { decisions: vec![0; 65], ..Given::new(65) }.expected().1;
        assert!(still[moved] != lists[moved] && !compare::exact(&still, &lists).holds);
        let all = |first_draw: u32| {
            let mut given = Given { decisions: vec![1; 65], ..Given::new(65) };
            given.sorted[3].first_draw += first_draw;
            given.expected().0
        };
        assert!(!compare::exact(words(&all(OBJECT_LISTS)), words(&all(0))).holds);
    }
}
