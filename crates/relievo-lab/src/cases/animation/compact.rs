//! Parity and benchmark cases of `kernels/animation/compact.wgsl`.

use relievo::Error;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::compact::CompactPass;
use relievo::ops::animation::compact::reference::{Work, accumulated, compact};
use relievo::ops::animation::crowd::Crowd;
use relievo::ops::animation::gate::reference::ChosenBones;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::updated_bones::UpdatedBones;

use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd};
use crate::cases::measure;
use crate::harness::compare::{Comparison, exact};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Bench, Cases};

/// The cases cover no bit, all, every third, single ones and whole instances; half of the bits ahead; and more
/// instances than the sums have threads.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let sizes = SIZES.into_iter().chain([[33, 63], [31, 129], [5, 1000]]);
    for (case, [bones, count]) in sizes.enumerate() {
        let (skeleton, set, instances) = random_crowd(case as u32, bones, count)?;
        let order = Order::new(&skeleton);
        let crowd = Crowd::new(cases.gpu, &set, &instances)?;
        let mut draw = Draw::new(case as u32 ^ 0xc0de);
        for kind in ["none", "all", "a third", "few", "whole instances"] {
            let bits = random_bits(&mut draw, kind, &order, count);
            let ahead = bits.iter().map(|word| word & draw.word()).collect();
            let chosen = ChosenBones { bits, ahead };
            let name = format!("{bones} bones × {count}, {kind}");
            add(cases, &name, &order, &crowd, &chosen).await?;
        }
    }
    Ok(())
}

/// Words of random bits; bits beyond the bones are 0.
fn random_bits(draw: &mut Draw, kind: &str, order: &Order, count: usize) -> Vec<u32> {
    let words = order.words();
    let mut bits = vec![0; count * words];
    for instance in 0..count {
        let whole = draw.word().is_multiple_of(4);
        for slot in 0..order.slots.len() {
            let is_active = match kind {
                "none" => false,
                "all" => true,
                "a third" => draw.word().is_multiple_of(3),
                "few" => draw.word().is_multiple_of(100),
                _ => whole,
            };
            bits[instance * words + slot / 32] |= u32::from(is_active) << (slot % 32);
        }
    }
    bits
}

async fn add(
    cases: &mut Cases<'_>,
    name: &str,
    order: &Order,
    crowd: &Crowd,
    chosen: &ChosenBones,
) -> Result<(), Error> {
    let gpu = cases.gpu;
    let mut active = Active::new(gpu, order, crowd)?;
    let words = chosen.bits.len();
    let bits = Poisoned::<u32>::new(gpu, 3 * words)?;
    bits.buffer.write(gpu, &chosen.words())?;
    active.bits = bits.buffer.clone();
    // Bits of frames before, which stay.
    let before: Vec<u32> = chosen.bits.iter().zip(0..).map(|(word, at)| scattered(*word, at)).collect();
    let updated_bones = Poisoned::<u32>::new(gpu, words)?;
    updated_bones.buffer.write(gpu, &before)?;
    let pairs = Poisoned::<u32>::new(gpu, crowd.pairs())?;
    let instances = Poisoned::<u32>::new(gpu, crowd.len())?;
    active.updated_bones = UpdatedBones::over(updated_bones.buffer.clone());
    active.pairs.pairs = pairs.buffer.clone();
    active.instances = instances.buffer.clone();
    let job = CompactPass::new(gpu)?.prepare(gpu, crowd, &active)?;
    gpu.submit("verify", |encoder| job.record(encoder))?;
    let expected = compact(order, chosen);
    let Work { pairs: expected_pairs, instances: expected_instances, .. } = &expected;
    let listed = padded(expected_pairs, crowd.pairs());
    let shown = padded(expected_instances, crowd.len());
    cases.exact(format!("{name}: pairs"), &pairs, &listed).await?;
    cases.exact(format!("{name}: instances"), &instances, &shown).await?;
    let all = [chosen.words(), expected.updated_bones.clone()].concat();
    cases.exact(format!("{name}: bits"), &bits, &all).await?;
    let accumulated = accumulated(&before, &expected.updated_bones);
    cases.exact(format!("{name}: updated bones"), &updated_bones, &accumulated).await?;
    cases.add(format!("{name}: dispatches"), dispatches(gpu, order, crowd, &active, &expected).await?);
    Ok(())
}

/// Some bits that depend on a word and its place.
fn scattered(word: u32, at: u32) -> u32 {
    (word ^ at).wrapping_mul(0x9e37_79b9) & at.wrapping_mul(0x85eb_ca6b)
}

/// A list, followed by poison.
pub(crate) fn padded(list: &[u32], room: usize) -> Vec<u32> {
    let mut list = list.to_vec();
    list.resize(room, POISON);
    list
}

/// The expected dispatches: workgroups of 64 for pairs, instances, the chains of each level, and cursors.
pub(crate) async fn dispatches(
    gpu: &relievo::gpu::Gpu,
    order: &Order,
    crowd: &Crowd,
    active: &Active,
    expected: &Work,
) -> Result<Comparison, Error> {
    let groups = |threads: usize, last: usize| {
        let groups = threads.div_ceil(64) as u32;
        let x = groups.clamp(1, gpu.device().limits().max_compute_workgroups_per_dimension);
        [x, groups.div_ceil(x), 1, last as u32]
    };
    let mut all = vec![groups(expected.pairs.len(), expected.pairs.len())];
    all.push(groups(expected.instances.len(), expected.instances.len()));
    all.extend(order.levels.windows(2).map(|level| {
        let chains = (level[1] - level[0]) as usize;
        groups(chains * expected.instances.len(), chains)
    }));
    let cursors = crowd.cursors.len() / crowd.len();
    all.push(groups(cursors * expected.instances.len(), cursors));
    let of_pairs = active.pairs.dispatched.read(gpu).await?;
    let mut actual = vec![[of_pairs[0], of_pairs[1], of_pairs[2], of_pairs[3]]];
    actual.extend(active.dispatches.read(gpu).await?);
    Ok(exact(&actual, &all))
}

/// Measures crowds with all bones active, and with a quarter.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = CompactPass::new(gpu)?;
    for (fraction, pattern) in [("all", u32::MAX), ("a quarter", 0x1111_1111)] {
        for count in CROWDS {
            let scene = Scene::new(gpu, count)?;
            let order = scene.order();
            let active = Active::new(gpu, &order, &scene.crowd)?;
            let mut bits = vec![pattern; count * order.words()];
            let unused = order.words() * 32 - scene.skeleton.len();
            bits.iter_mut()
                .skip(order.words() - 1)
                .step_by(order.words())
                .for_each(|word| *word &= u32::MAX >> unused);
            active.bits.write(gpu, &bits)?;
            let bits = ChosenBones { ahead: vec![0; bits.len()], bits };
            let job = pass.prepare(gpu, &scene.crowd, &active)?;
            let chosen: u32 = bits.bits.iter().map(|word| word.count_ones()).sum();
            // The kernel reads bits twice and writes them once, and writes a pair and its slot.
            let words = (3 * bits.bits.len() + 2 * chosen as usize) / 2;
            let name = format!("{count} × 153, {fraction}");
            measure(bench, name, scene.pairs(), "bone", 2 * words, &|encoder| job.record(encoder), || {
                compact(&order, &bits)
            })?;
        }
    }
    Ok(())
}
