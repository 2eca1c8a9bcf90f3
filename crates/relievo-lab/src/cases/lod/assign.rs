//! Parity and benchmark cases of `kernels/lod/assign.wgsl`.

use relievo::Error;
use relievo::gpu::{Buffer, Uniform};
use relievo::ops::animation::Lod;
use relievo::ops::animation::lod::PackedLod;
use relievo::ops::lod::assign::reference::{AssignInstance, assign};
use relievo::ops::lod::assign::{AssignBuffers, AssignParams, AssignPass};
use relievo::ops::lod::select::Allowed;
use relievo::ops::lod::{INSTANCE_CARRIES, INSTANCE_WHOLE, SceneInstance};
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::shared::animation::gate_state::lod_flags_tier;

use crate::cases::animation::Draw;
use crate::cases::lod::random_instances;
use crate::cases::measure;
use crate::harness::compare::{Comparison, Judgement, each};
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases};

/// How far rounding may move the quotients: products round by 2⁻²³, divisions by 5 · 2⁻²⁴.
const QUOTIENT: f32 = 1e-6;

/// The fraction of instances whose level or fade rounding may decide either way.
const MAY_TOUCH: f64 = 1.0 / 200.0;

/// The cases cover numbers of instances around a workgroup's, behind and before instances of other objects;
/// characters without influences to fade, and displacements from 0 to the largest, or of unseen instances.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = AssignPass::new(gpu)?;
    for (case, instances) in (0..).zip([1, 63, 64, 65, 1000]) {
        for has_stray in [false, true] {
            let params = params(64 * case, instances, has_stray);
            let allowed = random_allowed(case, (64 * case + instances) as usize + 64);
            let all = random_carriers(case, allowed.len());
            let (lods, instance_lods) = (
                Poisoned::<PackedLod>::new(gpu, instances as usize)?,
                Poisoned::new(gpu, instances as usize)?,
            );
            lods.buffer.write(gpu, &last_lods(instances))?;
            let buffers = AssignBuffers {
                allowed: &Buffer::from_slice(gpu, "allowed", &allowed)?,
                instances: &Buffer::from_slice(gpu, "instances", &all)?,
                finest: &Buffer::from_slice(gpu, "finest", &finest(allowed.len()))?,
                lods: &lods.buffer,
                instance_lods: &instance_lods.buffer,
            };
            // More threads than instances.
            let job = pass.prepare(gpu, &Uniform::new(gpu, "params", &params)?, buffers, instances)?;
            gpu.submit("verify", |encoder| job.record(encoder))?;
            let of_object = params.first as usize..(params.first + instances) as usize;
            let all = given(&allowed, &all);
            let mut given = all[of_object].to_vec();
            for (given, last) in given.iter_mut().zip(last_lods(instances)) {
                given.last_tier = lod_flags_tier(last.flags);
            }
            let given = &given;
            let name =
                format!("{instances} instances, {} influences", if has_stray { "with" } else { "without" });
            let gates = |found: &[PackedLod]| compared_lods(&params, given, found);
            cases.check(format!("{name}: gates"), &lods, gates).await?;
            let skins = |found: &[InstanceLod]| compared_instance_lods(&params, given, found);
            cases.check(format!("{name}: skins"), &instance_lods, skins).await?;
        }
    }
    Ok(())
}

/// Parameters of a character, with influences to fade or without.
fn params(first: u32, instances: u32, has_stray: bool) -> AssignParams {
    AssignParams {
        first,
        instances,
        bone_fraction: 0.3,
        influence_fraction: 0.2,
        unit: 3.7e-7,
        stray: if has_stray { 0.7 } else { 0.0 },
        max_influences: 4,
        omega_start: 3.0,
        omega_rate: if has_stray { 0.125 } else { 0.0 },
        fade_start: 5.0,
        fade_rate: if has_stray { 0.0 } else { 0.0625 },
        full_weight_allowed: 0.01,
        tier_fraction: 0.25,
        tier_errors: [0.0, 1e-3, 0.03, if has_stray { 0.5 } else { f32::MAX }].into(),
    }
}

/// Levels of detail of the last frame, with every tier.
fn last_lods(instances: u32) -> Vec<PackedLod> {
    let lod = |at: u32| Lod { tier: at % 4, ..Lod::FULL }.packed();
    (0..instances).map(lod).collect()
}

/// An instance that carries nothing and was not seen before.
fn plain(allowed: Allowed, finest: u32) -> AssignInstance {
    AssignInstance { allowed, finest, carries: false, is_whole: false, last_tier: 0 }
}

/// Finest levels of so many instances.
fn finest(count: usize) -> Vec<u32> {
    (0..count as u32).map(|at| at * 5 % 8).collect()
}

/// The instances of a case.
fn given(allowed: &[Allowed], instances: &[SceneInstance]) -> Vec<AssignInstance> {
    let given = allowed.iter().zip(finest(allowed.len())).zip(instances);
    given
        .map(|((allowed, finest), instance)| AssignInstance {
            allowed: *allowed,
            finest,
            carries: instance.flags & INSTANCE_CARRIES != 0,
            is_whole: instance.flags & INSTANCE_WHOLE != 0,
            last_tier: 0,
        })
        .collect()
}

/// An instance that may be off `factor` times as far.
fn scaled(given: AssignInstance, factor: f32) -> AssignInstance {
    let displacement = factor * given.allowed.displacement;
    AssignInstance { allowed: Allowed { displacement, ..given.allowed }, ..given }
}

/// Displacements from 1e-6 to 1e4, and some that are 0, as large as possible, or of unseen instances. Distances are quarters, so
/// that steps of Ω and of fades are exact.
fn random_allowed(case: u32, count: usize) -> Vec<Allowed> {
    let mut draw = Draw::new(case ^ 0xa551);
    let mut random = |_| {
        let displacement = match draw.word() % 16 {
            0 => 0.0,
            1 => 1e9,
            2 | 3 => -1.0,
            _ => libm::exp2f(-3.0 + 14.0 * draw.signed()),
        };
        Allowed { displacement, distance: (draw.word() % 128) as f32 / 4.0 }
    };
    (0..count).map(&mut random).collect()
}

/// Instances of which some carry a mesh.
fn random_carriers(case: u32, count: usize) -> Vec<SceneInstance> {
    let mut draw = Draw::new(case ^ 0xca44);
    let mut all = random_instances(case, count);
    for instance in all.iter_mut().filter(|_| draw.word().is_multiple_of(5)) {
        instance.flags |= INSTANCE_CARRIES;
    }
    for instance in all.iter_mut().filter(|_| draw.word().is_multiple_of(7)) {
        instance.flags |= INSTANCE_WHOLE;
    }
    all
}

/// The right results, as the kernel writes them.
fn packed(params: &AssignParams, given: AssignInstance) -> (PackedLod, InstanceLod) {
    let (lod, instance_lod) = assign(params, &given);
    (lod.packed(), instance_lod)
}

/// The right results for the displacement as it is, and for the least and the largest to which rounding may change it.
fn around(params: &AssignParams, given: AssignInstance) -> [(PackedLod, InstanceLod); 3] {
    [1.0, 1.0 - QUOTIENT, 1.0 + QUOTIENT].map(|factor| packed(params, scaled(given, factor)))
}

/// Units must lie between those of the least and the largest displacement, and so must the weight and the tier; everything else must
/// be equal.
fn compared_lods(params: &AssignParams, given: &[AssignInstance], found: &[PackedLod]) -> Comparison {
    let judge = |(found, given): (&PackedLod, &AssignInstance)| {
        let [(right, _), (least, _), (largest, _)] = around(params, *given);
        // At the edge of a tier, the units are those of either tier.
        let [least_tier, tier] = [least, largest].map(|lod| lod_flags_tier(lod.flags));
        let units = [least.allowed.min(largest.allowed), least.allowed.max(largest.allowed)];
        let is_right = (units[0]..=units[1]).contains(&found.allowed)
            && (least_tier..=tier).contains(&lod_flags_tier(found.flags))
            && (largest.weight..=least.weight).contains(&found.weight)
            && (least_tier != tier || found.flags == right.flags)
            && found.omega == right.omega;
        let error = f64::from(found.allowed.abs_diff(right.allowed));
        Judgement::exact(is_right, error, least_tier != tier)
    };
    let judgements: Vec<Judgement> = found.iter().zip(given).map(judge).collect();
    each(&judgements, "units", MAY_TOUCH, |at| {
        format!("{:?} instead of {:?}", found[at], packed(params, given[at]).0)
    })
}

/// A fade may be that of the least or of the largest displacement, if these differ.
fn compared_instance_lods(
    params: &AssignParams,
    given: &[AssignInstance],
    found: &[InstanceLod],
) -> Comparison {
    let judge = |(found, given): (&InstanceLod, &AssignInstance)| {
        let [(_, right), (_, least), (_, largest)] = around(params, *given);
        let is_right = (least.influence_fade..=largest.influence_fade).contains(&found.influence_fade)
            && found.mesh_lod == right.mesh_lod
            && found.max_influences == right.max_influences
            && (least.tier..=largest.tier).contains(&found.tier)
            // Fades are whole steps, exact in f32.
            && libm::truncf(64.0 * found.influence_fade) == 64.0 * found.influence_fade;
        let error = f64::from((found.influence_fade - right.influence_fade).abs());
        Judgement::exact(is_right, error, least != largest)
    };
    let judgements: Vec<Judgement> = found.iter().zip(given).map(judge).collect();
    each(&judgements, "fade", MAY_TOUCH, |at| {
        format!("{:?} instead of {:?}", found[at], packed(params, given[at]).1)
    })
}

/// Measures characters of which three quarters are seen.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = AssignPass::new(gpu)?;
    for count in [1_000, 100_000_usize] {
        let params = params(0, count as u32, true);
        let displacement = |at: usize| if at.is_multiple_of(4) { -1.0 } else { 1e-3 * (at % 1024) as f32 };
        let allowed: Vec<Allowed> =
            (0..count).map(|at| Allowed { displacement: displacement(at), distance: 10.0 }).collect();
        let buffers = AssignBuffers {
            allowed: &Buffer::from_slice(gpu, "allowed", &allowed)?,
            instances: &Buffer::from_slice(gpu, "instances", &random_instances(1, count))?,
            finest: &Buffer::from_slice(gpu, "finest", &finest(count))?,
            lods: &Buffer::new(gpu, "lods", count)?,
            instance_lods: &Buffer::new(gpu, "instance_lods", count)?,
        };
        let job = pass.prepare(gpu, &Uniform::new(gpu, "params", &params)?, buffers, count as u32)?;
        // The kernel reads four words and a Lod, and writes a Lod and an InstanceLod.
        let words = 16 * count;
        let name = format!("{count} instances");
        measure(bench, name, count, "instance", words, &|encoder| job.record(encoder), || {
            allowed.iter().map(|allowed| assign(&params, &plain(*allowed, 0))).collect::<Vec<_>>()
        })?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::shared::animation::gate_state::{LOD_HIDDEN, lod_flags_word};

    #[test]
    fn what_is_wrong_of_one_instance_is_seen() {
        let params = params(0, 200, true);
        let carriers = random_carriers(5, 200);
        let given = given(&random_allowed(5, 200), &carriers);
        let (lods, instance_lods): (Vec<PackedLod>, Vec<InstanceLod>) =
            given.iter().map(|given| packed(&params, *given)).unzip();
        assert!(compared_lods(&params, &given, &lods).holds);
        assert!(compared_instance_lods(&params, &given, &instance_lods).holds);
        let unseen = given.iter().position(|given| given.allowed.displacement < 0.0).expect("some");
        let faded = (0..200)
            .position(|at| (0.1..0.9).contains(&instance_lods[at].influence_fade) && !given[at].carries);
        let faded = faded.expect("some");
        let carrier =
            given.iter().position(|given| given.allowed.displacement > 0.1 && given.carries).expect("some");
        let gate = |at: usize, change: fn(&mut PackedLod)| {
            let mut found = lods.clone();
            change(&mut found[at]);
            compared_lods(&params, &given, &found).holds
        };
        assert!(!gate(unseen, |lod| lod.flags = 0) && !gate(faded, |lod| lod.flags = LOD_HIDDEN));
        assert!(!gate(faded, |lod| lod.allowed += lod.allowed / 1000));
        assert!(!gate(carrier, |lod| lod.allowed = 1));
        assert!(
            !gate(faded, |lod| lod.omega ^= 1) && !gate(faded, |lod| lod.weight -= lod.weight / 1000 + 1)
        );
        assert!(!gate(faded, |lod| lod.flags ^= lod_flags_word(0, 1)));
        let skin = |at: usize, change: fn(&mut InstanceLod)| {
            let mut found = instance_lods.clone();
            change(&mut found[at]);
            compared_instance_lods(&params, &given, &found).holds
        };
        assert!(!skin(unseen, |lod| lod.max_influences = 4) && !skin(faded, |lod| lod.max_influences = 0));
        assert!(!skin(faded, |lod| lod.influence_fade += 1.0 / 64.0));
        assert!(!skin(faded, |lod| lod.influence_fade = f32::NAN));
        assert!(!skin(faded, |lod| lod.mesh_lod += 1) && !skin(faded, |lod| lod.tier ^= 1));
    }

    /// A displacement at the very edge of a step of the fade may give either step.
    #[test]
    fn an_edge_may_go_either_way() {
        let params = params(0, 1, true);
        let edge = 0.25 * params.stray / params.influence_fraction;
        let given = plain(Allowed { displacement: edge, distance: 0.0 }, 3);
        let (_, right) = packed(&params, scaled(given, 1.0 + QUOTIENT));
        let fade = |steps: f32| {
            let influence_fade = right.influence_fade - steps / 64.0;
            compared_instance_lods(&params, &[given], &[InstanceLod { influence_fade, ..right }])
        };
        assert!(fade(0.0).holds && fade(1.0).holds && !fade(2.0).holds);
        assert_eq!(fade(0.0).spread.expect("given").touching, 1);
        let two = compared_instance_lods(&params, &[given; 2], &[right; 2]);
        assert!(!two.holds && two.fault.expect("a fault").contains("2 of 2 touch"));
    }
}
