//! Parity cases of `kernels/animation/budget.wgsl`.

use crate::Error;
use crate::animation::active::Active;
use crate::animation::budget::BudgetPass;
use crate::animation::budget::reference::budget;
use crate::animation::crowd::Crowd;
use crate::animation::gate::verify::random_state;
use crate::animation::gate_state::GateState;
use crate::animation::gate_table::ExpectationTable;
use crate::animation::order::Order;
use crate::animation::verify::{Draw, SIZES, random_clips, random_crowd};
use crate::asset::keyframe::RotationPath;
use crate::harness::poison::Poisoned;
use crate::harness::{Cases, compare};

/// The cases cover sequences of frames, budgets from 0 to more than all bones, and weights of every size, also
/// equal ones, which give many bones the same rank. The integer results must be equal to the bit.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for (case, [bones, count]) in SIZES.into_iter().chain([[5, 1000]]).enumerate() {
        let case = case as u32;
        let (skeleton, set, instances) = random_crowd(case, bones, count)?;
        let clips = random_clips(case, &skeleton, 3)?;
        let clips: Vec<_> = clips.iter().collect();
        let crowd = Crowd::new(gpu, &set, &instances)?;
        let bone_radii = vec![0.5; bones];
        let table = ExpectationTable::new(&skeleton, &set, &clips, &bone_radii, RotationPath::Slerp)?;
        let mut state = GateState::new(gpu, &crowd)?;
        let order = Order::new(&skeleton);
        let mut active = Active::new(gpu, &order, &crowd)?;
        let output = Poisoned::<u32>::new(gpu, 2 * count * order.words())?;
        active.bits = output.buffer.clone();
        let sums = Poisoned::<u32>::new(gpu, bones * count)?;
        state.sampled = sums.buffer.clone();
        let mut sampled = vec![0; bones * count];
        sums.buffer.write(gpu, &sampled)?;
        let job = BudgetPass::new(gpu, &table, u32::MAX)?.prepare(gpu, &crowd, &state, &active)?;
        let mut draw = Draw::new(case ^ 0xb0d6);
        let pairs = (bones * count) as u32;
        for (frame, most) in [pairs, pairs / 2, 0, pairs / 3 + 1, pairs - 1, u32::MAX].into_iter().enumerate()
        {
            let (mut lods, clip_clocks) = random_state(&mut draw, &set, count, frame == 0);
            let weight = |draw: &mut Draw| draw.word() >> (16 + draw.word() % 17).min(31);
            lods.iter_mut()
                .for_each(|lod| lod.weight = if frame % 2 == 0 { 65535 } else { weight(&mut draw) });
            state.write_lods(gpu, &lods)?;
            state.clip_clocks.write(gpu, &clip_clocks)?;
            job.set(gpu, most)?;
            output.poison(gpu)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let mut expected = budget(&table, most, &lods, &clip_clocks, &mut sampled);
            // No bone is sampled ahead.
            expected.resize(2 * count * order.words(), 0);
            let name = format!("{most} of {bones} bones × {count}, frame {frame}");
            cases.add(name, output.check(gpu, |actual| compare::exact(actual, &expected))?);
        }
        let name = format!("{bones} bones × {count}, sums of motion");
        cases.add(name, sums.check(gpu, |actual| compare::exact(actual, &sampled))?);
    }
    Ok(())
}
