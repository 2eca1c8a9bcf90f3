//! Parity and benchmark cases of `kernels/animation/drive.wgsl`.

use relievo::Error;
use relievo::ops::animation::active::Active;
use relievo::ops::animation::crowd::Crowd;
use relievo::ops::animation::drive::reference::drive;
use relievo::ops::animation::drive::{DrivePass, DrivenBones, DrivenWord, driven_words};
use relievo::ops::animation::gate_state::GateState;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::{BoneSampling, Lod};

use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd};
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// The cases cover no driven bone, one, all bones of some instances, and random ones; a third of the instances is hidden, and
/// half of the bits are ahead.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = DrivePass::new(gpu)?;
    for (case, [bones, count]) in (0..).zip(SIZES) {
        let (skeleton, set, instances) = random_crowd(case, bones, count)?;
        let order = Order::new(&skeleton);
        let crowd = Crowd::new(gpu, &set, &instances)?;
        let mut draw = Draw::new(case ^ 0xd12e);
        let state = GateState::new(gpu, &crowd)?;
        let hidden: Vec<bool> = (0..count).map(|_| draw.word().is_multiple_of(3)).collect();
        let sampling = |hidden: &bool| if *hidden { BoneSampling::Hidden } else { BoneSampling::Forced };
        let lods: Vec<Lod> =
            hidden.iter().map(|hidden| Lod { sampling: sampling(hidden), ..Lod::FULL }).collect();
        state.write_lods(gpu, &lods)?;
        for kind in ["none", "one", "whole instances", "a third"] {
            let driven = random_driven(&mut draw, kind, &order, count);
            let words = count * order.words();
            let before: Vec<u32> = (0..3 * words).map(|_| draw.word()).collect();
            let bits = Poisoned::<u32>::new(gpu, 3 * words)?;
            bits.buffer.write(gpu, &before)?;
            let mut active = Active::new(gpu, &order, &crowd)?;
            active.bits = bits.buffer.clone();
            let job = pass.prepare(gpu, &driven, &crowd, &state, &active)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let mut expected = before;
            let (sampled, rest) = expected.split_at_mut(words);
            drive(&driven, order.words(), &hidden, [sampled, &mut rest[..words]]);
            cases.exact(format!("{bones} bones × {count}, {kind}"), &bits, &expected).await?;
        }
    }
    Ok(())
}

/// Driven bones of instances.
fn random_driven(draw: &mut Draw, kind: &str, order: &Order, count: usize) -> Vec<DrivenWord> {
    let bones = order.slots.len() as u32;
    let of_instance = |instance: u32| {
        let whole = draw.word().is_multiple_of(2);
        let is_driven = |bone: &u32| match kind {
            "none" => false,
            "one" => instance == 0 && *bone == bones - 1,
            "whole instances" => whole,
            _ => draw.word().is_multiple_of(3),
        };
        (instance, (0..bones).filter(is_driven).collect::<Vec<_>>())
    };
    let all: Vec<_> = (0..count as u32).map(of_instance).collect();
    driven_words(order, all.iter().map(|(instance, bones)| DrivenBones { instance: *instance, bones }))
}

/// Measures crowds of which each instance has a driven limb of eight bones.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = DrivePass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let order = scene.order();
        let active = Active::new(gpu, &order, &scene.crowd)?;
        let state = GateState::new(gpu, &scene.crowd)?;
        let limb: Vec<u32> = (40..48).collect();
        let driven =
            driven_words(&order, (0..count as u32).map(|instance| DrivenBones { instance, bones: &limb }));
        let job = pass.prepare(gpu, &driven, &scene.crowd, &state, &active)?;
        // The kernel reads a word of driven bones, the flags of an instance, and reads and writes two words of bits.
        let words = 4 * driven.len();
        let hidden = vec![false; count];
        let mut bits = vec![0; count * order.words()];
        let mut ahead = bits.clone();
        let name = format!("{count} × 153");
        measure(bench, name, 8 * count, "bone", 2 * words, &|encoder| job.record(encoder), || {
            drive(&driven, order.words(), &hidden, [&mut bits, &mut ahead]);
            std::hint::black_box(&mut bits);
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::compare::exact;

    /// Every word that differs is found: a bone that is not added, one that stays ahead, and one of a hidden instance.
    #[test]
    fn what_is_wrong_of_one_bone_is_seen() {
        let driven = [DrivenWord { at: 1, bones: 0b110 }, DrivenWord { at: 2, bones: 0b1 }];
        let (mut bits, mut ahead) = (vec![0b10, 0b10, 0], vec![0b10, 0b10, 0b1]);
        drive(&driven, 1, &[false, false, true], [&mut bits, &mut ahead]);
        assert_eq!((&bits[..], &ahead[..]), (&[0b10, 0b110, 0][..], &[0b10, 0, 0b1][..]));
        for at in 0..3 {
            let mut found = bits.clone();
            found[at] ^= 0b100;
            assert!(!exact(&found, &bits).holds);
        }
    }
}
