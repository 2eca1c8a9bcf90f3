//! The guarantees of gates, on random clips and on the creature's.

use relievo::asset::clip::BoneKeys;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::asset::{Clip, Skeleton};
use relievo::ops::animation::budget::reference::rank_of;
use relievo::ops::animation::compact::reference::Work;
use relievo::ops::animation::gate::reference::{gate, is_skipped, scramble};
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::lod::OMEGA_ONE;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::priority::{Priorities, USER_DEFAULT, Weights};
use relievo::ops::animation::{
    AnimatedBones, BoneSampling, BoundTable, ClipSet, ExpectationTable, Frame, Gate, Lod, PriorityTable,
};
use relievo_lab::cases::animation::{Draw, random_clips, random_skeleton};
use relievo_lab::crowd::Crowd;
use relievo_samples::creature;

/// The skeleton, clips and tables that a test plays.
struct Stage {
    skeleton: Skeleton,
    clips: Vec<Clip>,
    order: Order,
    set: ClipSet,
    bone_radii: Vec<f32>,
}

impl Stage {
    fn new(skeleton: Skeleton, clips: Vec<Clip>) -> Self {
        let set = ClipSet::new(&clips.iter().collect::<Vec<_>>()).expect("one skeleton");
        let order = Order::new(&skeleton);
        let bone_radii = (0..skeleton.len()).map(|bone| 0.05 + 0.1 * (bone % 4) as f32).collect();
        Self { skeleton, clips, order, set, bone_radii }
    }

    fn random(case: u32, bones: usize) -> Self {
        let skeleton = random_skeleton(case, bones).expect("valid");
        let clips = random_clips(case, &skeleton, 3).expect("valid");
        Self::new(skeleton, clips)
    }

    fn creature() -> Self {
        let model = creature().expect("valid");
        Self::new(model.skeleton, model.clips)
    }

    fn clips(&self) -> Vec<&Clip> {
        self.clips.iter().collect()
    }

    fn bounds(&self, path: RotationPath) -> BoundTable {
        BoundTable::new(&self.skeleton, &self.set, &self.clips(), &self.bone_radii, path).expect("fits")
    }

    fn bounded(&self, path: RotationPath) -> Gate {
        Gate::Bounded(self.bounds(path))
    }

    fn expectations(&self, path: RotationPath) -> ExpectationTable {
        ExpectationTable::new(&self.skeleton, &self.set, &self.clips(), &self.bone_radii, path).expect("fits")
    }

    fn animated_bones(&self) -> AnimatedBones {
        AnimatedBones::new(&self.order, &self.set, &self.clips()).expect("fits")
    }

    fn off(&self) -> Gate {
        Gate::Off(self.animated_bones())
    }

    fn crowd<'a>(&'a self, gate: &'a Gate, path: RotationPath, instances: &[Instance]) -> Crowd<'a> {
        Crowd::new(&self.order, &self.set, gate, path, instances.to_vec()).expect("one path")
    }

    /// The largest distance between a point that follows one bone only and its position under full evaluation,
    /// for the ends of the bone's axes at the bone's radius.
    fn error(&self, stale: &[Affine], fresh: &[Affine]) -> f64 {
        let mut worst = 0.0_f64;
        for (pair, (stale, fresh)) in stale.iter().zip(fresh).enumerate() {
            let bone_radius = f64::from(self.bone_radii[pair % self.skeleton.len()]);
            for (axis, side) in (0..3).flat_map(|axis| [(axis, -bone_radius), (axis, bone_radius)]) {
                let off = |row: usize| {
                    let minus = |column: usize| f64::from(stale[row][column]) - f64::from(fresh[row][column]);
                    minus(3) + side * minus(axis)
                };
                worst = worst.max((off(0).powi(2) + off(1).powi(2) + off(2).powi(2)).sqrt());
            }
        }
        worst
    }
}

fn frame(number: u32) -> Frame {
    Frame { ticks: number * 1092, frame_ticks: 1092, frame: number, ahead: 1.0 / 60.0 }
}

/// Plays instances with changing clips, directions and rates at uneven frame times, permitted to miss `times`
/// the permitted motion, beside instances that are evaluated in full. Returns the largest error divided by the
/// permitted one, and the fraction of bones that were sampled.
fn bounded_run(stage: &Stage, path: RotationPath, allowed: f32, times: u32, case: u32) -> (f64, f64) {
    let mut draw = Draw::new(case ^ 0xb0de);
    let instance = |draw: &mut Draw| {
        let wrap = if draw.word().is_multiple_of(4) { Wrap::Clamp } else { Wrap::Loop };
        let clip = draw.word() % stage.clips.len() as u32;
        Instance::new(clip, wrap, 2.0 * draw.signed(), [1.0, -1.0, 0.25, 2.5][draw.word() as usize % 4])
    };
    let instances: Vec<Instance> = (0..6).map(|_| instance(&mut draw)).collect();
    let (bounds, off) = (stage.bounds(path), stage.off());
    let bounded = Gate::Bounded(bounds.clone());
    let mut lazy = stage.crowd(&bounded, path, &instances);
    let mut full = stage.crowd(&off, path, &instances);
    lazy.lods.iter_mut().for_each(|lod| lod.allowed = times * bounds.units(allowed));
    let (mut elapsed, mut worst, mut sampled) = (0.0, 0.0_f64, 0);
    let frames = 150;
    for number in 0..frames {
        // Frames last 1 to 100 ms, and now and then many turns of the clip.
        let leap = if draw.word().is_multiple_of(40) { 29.0 } else { 0.0 };
        elapsed += leap + 0.001 + 0.099 * (draw.word() % 1000) as f32 / 1000.0;
        if draw.word().is_multiple_of(8) {
            let (at, new) = (draw.word() as usize % instances.len(), instance(&mut draw));
            (lazy.instances[at], full.instances[at]) = (new, new);
        }
        sampled += lazy.advance(&frame(number), elapsed).pairs.len();
        full.advance(&frame(number), elapsed);
        worst = worst.max(stage.error(&lazy.model_matrices, &full.model_matrices));
    }
    let pairs = frames as usize * instances.len() * stage.skeleton.len();
    (worst / f64::from(allowed), sampled as f64 / pairs as f64)
}

/// The guarantee of `bounded`: no point is further off than permitted, with 1e-4 for the rounding of matrices.
#[test]
fn no_point_is_further_off_than_bounded_allows() {
    let (mut closest, mut least) = (0.0_f64, 1.0_f64);
    let stages = (0..6).map(|case| (Stage::random(case, [1, 2, 7, 20, 40, 65][case as usize]), case));
    for (stage, case) in stages.chain([(Stage::creature(), 9)]) {
        for path in [RotationPath::Slerp, RotationPath::Nlerp] {
            for allowed in [0.01, 0.05, 0.3, 2.0, 10.0] {
                let (worst, sampled) = bounded_run(&stage, path, allowed, 1, case);
                assert!(worst <= 1.0 + 1e-4 / f64::from(allowed), "{case} {path:?} {allowed}: {worst} of it");
                (closest, least) = (closest.max(worst), least.min(sampled));
            }
        }
    }
    assert!(closest > 0.5 && least < 0.3, "far too careful: {closest} of what is allowed, {least} sampled");
}

/// The test above detects a gate that lets bones miss four times as much.
#[test]
fn a_gate_that_allows_too_much_is_seen() {
    let stage = Stage::random(0, 1);
    let found: Vec<f64> =
        (0..8).map(|case| bounded_run(&stage, RotationPath::Slerp, 0.05, 4, case).0).collect();
    assert!(found.iter().any(|worst| *worst > 1.01), "{found:?}");
}

/// If nothing may be missed, `bounded` and full evaluation are equal to the bit.
#[test]
fn nothing_allowed_is_nothing_missed() {
    let stage = Stage::creature();
    let (bounded, off) = (stage.bounded(RotationPath::Slerp), stage.off());
    let instances: Vec<_> =
        (0..5).map(|at| Instance::new(at % 3, Wrap::Loop, 0.3 * at as f32, 1.0)).collect();
    let mut lazy = stage.crowd(&bounded, RotationPath::Slerp, &instances);
    let mut full = stage.crowd(&off, RotationPath::Slerp, &instances);
    for number in 0..90 {
        let elapsed = number as f32 / 60.0;
        lazy.advance(&frame(number), elapsed);
        full.advance(&frame(number), elapsed);
        assert!(lazy.model_matrices == full.model_matrices, "frame {number}");
    }
}

/// Sampling only the bones that move equals full evaluation.
#[test]
fn bones_that_never_move_are_sampled_once() {
    let stage = Stage::creature();
    let off = stage.off();
    let mut crowd = stage.crowd(&off, RotationPath::Slerp, &[Instance::new(0, Wrap::Loop, 0.0, 1.0)]);
    let first = crowd.advance(&frame(0), 0.0);
    let next = crowd.advance(&frame(1), 0.4);
    assert!(first.pairs.len() == 153 && (50..153).contains(&next.pairs.len()), "{}", next.pairs.len());
    let locals =
        relievo::ops::animation::sample::reference::sample(&stage.clips[0], 0.4, RotationPath::Slerp);
    assert_eq!(
        crowd.model_matrices,
        relievo::ops::animation::local_to_model::reference::local_to_model(&stage.skeleton, &locals)
    );
}

fn pairs_a_frame(stage: &Stage, gate: &Gate, lod: Lod, frames: u32) -> Vec<Work> {
    let instances: Vec<_> = (0..20).map(|at| Instance::new(0, Wrap::Loop, 0.618 * at as f32, 1.0)).collect();
    let mut crowd = stage.crowd(gate, RotationPath::Slerp, &instances);
    crowd.lods.fill(lod);
    (0..frames).map(|number| crowd.advance(&frame(number), number as f32 / 60.0)).collect()
}

#[test]
fn uniform_and_random_take_their_share_of_the_bones() {
    let stage = Stage::creature();
    let bones = stage.animated_bones();
    let moving = pairs_a_frame(&stage, &stage.off(), Lod::FULL, 2)[1].pairs.len();
    for fraction in [0.0, 0.1, 0.33, 0.75, 1.0] {
        let lod = Lod { omega: (fraction * f64::from(OMEGA_ONE)) as u32, ..Lod::FULL };
        for gate in [Gate::Uniform(bones.clone()), Gate::Random(bones.clone())] {
            let done = pairs_a_frame(&stage, &gate, lod, 121);
            assert_eq!(done[0].pairs.len(), 20 * 153, "a first frame is full");
            let mean = done[1..].iter().map(|work| work.pairs.len()).sum::<usize>() as f64 / 120.0;
            let found = mean / moving as f64;
            assert!((found - fraction).abs() < 0.01, "{}: {found} of {fraction}", gate.name());
            // Instances update all bones together, or each bone for itself.
            let is_whole = |work: &Work| work.pairs.len() == work.instances.len() * moving / 20;
            let whole = done[1..].iter().all(is_whole);
            let is_together = matches!(gate, Gate::Uniform(_)) || fraction == 0.0 || fraction == 1.0;
            assert_eq!(whole, is_together, "{} {fraction}", gate.name());
        }
    }
}

/// A's rule in integers: an update is skipped if and only if p ≤ t − t_prev or t/p ≠ t_prev/p.
#[test]
fn skip_period_is_the_specifications() {
    let mut draw = Draw::new(1);
    for _ in 0..20_000 {
        let (period, passed) = (draw.word() >> (draw.word() % 32), draw.word() >> (16 + draw.word() % 16));
        let last = draw.word() / 2;
        let ticks = last + passed;
        let expected = period <= passed || ticks / period != last / period;
        assert_eq!(is_skipped(period, ticks, passed), expected, "{period} {last} {passed}");
    }
}

/// A's example (section 12.10): at 16 ms a frame, a level of 48 ms skips every third update, and one of 32 ms every second.
#[test]
fn skip_period_skips_as_often_as_in_the_example_of_a() {
    for (level, every) in [(48, 3), (32, 2)] {
        let skipped: Vec<u32> = (1..=60).filter(|frame| is_skipped(level, 16 * frame, 16)).collect();
        assert_eq!(skipped.len(), 60 / every as usize, "{level}");
        assert!(skipped.windows(2).all(|pair| pair[1] - pair[0] == every), "{level}: {skipped:?}");
    }
}

/// The gate by the priorities of the creature's keys. The period of a second has 65,536 ticks.
fn skip_period(stage: &Stage, weights: &Weights) -> Gate {
    let user = vec![USER_DEFAULT; stage.skeleton.len()];
    let of = |clip| Priorities::new(&stage.skeleton, clip, Wrap::Loop, weights, &user).expect("fits");
    let priorities: Vec<_> = stage.clips.iter().map(of).collect();
    let table = PriorityTable::new(&stage.order, &stage.set, &stage.clips(), &priorities).expect("fits");
    Gate::SkipPeriod { table, period: 65536 }
}

/// All priorities are ½. The clock of an instance is ahead by a hash of its number. A bone skips an update where that clock
/// passes a multiple of the period of the frame, whatever the period was before.
#[test]
fn skip_period_counts_from_multiples_of_the_period() {
    let stage = Stage::creature();
    let gate = skip_period(&stage, &Weights([0.0, 0.0, 0.0, 0.0, 0.0, 1.0]));
    let mut crowd = stage.crowd(&gate, RotationPath::Slerp, &[Instance::new(0, Wrap::Loop, 0.0, 1.0); 20]);
    let mut skipped = vec![Vec::new(); 20];
    for number in 0..200 {
        // Far away for a while, near for a while.
        let omega = if number / 37 % 2 == 0 { OMEGA_ONE / 4 } else { OMEGA_ONE / 3 };
        crowd.lods.fill(Lod { omega, ..Lod::FULL });
        let work = crowd.advance(&frame(number), number as f32 / 60.0);
        if number == 0 {
            continue;
        }
        let period = omega / 2;
        for instance in 0..20 {
            let clock = frame(number).ticks + (scramble(instance) & 0xffff);
            let passes = clock / period != (clock - 1092) / period;
            assert_eq!(!work.instances.contains(&instance), passes, "instance {instance}, frame {number}");
            skipped[instance as usize].push(passes);
        }
    }
    let patterns: std::collections::BTreeSet<_> = skipped.into_iter().collect();
    assert!(patterns.len() > 10, "instances skip in step: {} patterns", patterns.len());
}

/// A's rule skips a bone once per period: never at Ω = 1, always at Ω = 0, and more often at low priorities.
#[test]
fn skip_period_skips_once_a_period() {
    let stage = Stage::creature();
    let gate = skip_period(&stage, &Weights::default());
    let fraction = |omega: u32| {
        let done = pairs_a_frame(&stage, &gate, Lod { omega, ..Lod::FULL }, 241);
        done[1..].iter().map(|work| work.pairs.len()).sum::<usize>() as f64 / (240.0 * 20.0)
    };
    let moving = fraction(OMEGA_ONE);
    let all = pairs_a_frame(&stage, &stage.off(), Lod::FULL, 2)[1].pairs.len();
    assert_eq!(moving, all as f64 / 20.0, "an update was skipped at Ω = 1");
    // Priorities near ½ at Ω = ½ skip once every quarter of a second, which is 15 frames.
    let half = fraction(OMEGA_ONE / 2) / moving;
    assert!((0.8..0.96).contains(&half), "{half}");
    let tenth = fraction(OMEGA_ONE / 10) / moving;
    assert!(tenth < half && tenth > 0.1, "{tenth}");
    assert_eq!(fraction(0), 0.0);
}

#[test]
fn hidden_instances_cost_nothing_and_come_back_whole() {
    let stage = Stage::creature();
    for gate in [Gate::Uniform(stage.animated_bones()), stage.bounded(RotationPath::Slerp)] {
        let instances = [Instance::new(0, Wrap::Loop, 0.0, 1.0); 2];
        let mut crowd = stage.crowd(&gate, RotationPath::Slerp, &instances);
        crowd.lods.fill(Lod { omega: 1000, allowed: u32::MAX >> 1, ..Lod::FULL });
        let done = |crowd: &mut Crowd<'_>, number: u32| {
            crowd.advance(&frame(number), number as f32 / 60.0).pairs.len()
        };
        assert_eq!(done(&mut crowd, 0), 2 * 153);
        crowd.lods[0].sampling = BoneSampling::Hidden;
        assert_eq!(done(&mut crowd, 1), 0);
        crowd.lods[0].sampling = BoneSampling::Gated;
        assert_eq!(done(&mut crowd, 2), 153, "came back");
        crowd.lods[1].sampling = BoneSampling::Forced;
        assert_eq!(done(&mut crowd, 3), 153, "asked for");
        crowd.lods[1].sampling = BoneSampling::Gated;
        crowd.instances[1].clip = 1;
        assert_eq!(done(&mut crowd, 4), 153, "another clip");
        assert_eq!(done(&mut crowd, 5), 0);
    }
}

#[test]
fn budgets_are_kept_and_spent_on_what_missed_most() {
    let stage = Stage::creature();
    let table = stage.expectations(RotationPath::Slerp);
    let budget = |bones| Gate::Budget { table: table.clone(), bones };
    let moving = pairs_a_frame(&stage, &budget(u32::MAX), Lod::FULL, 2)[1].pairs.len();
    for most in [0, 1, 500, 1500] {
        let done = pairs_a_frame(&stage, &budget(most), Lod::FULL, 60);
        // Every bone that moves has missed something.
        assert!(done[1..].iter().all(|work| work.pairs.len() == (most as usize).min(moving)), "{most}");
    }
    // An instance twice as large on screen gets more samples.
    let instances: Vec<_> = (0..20).map(|at| Instance::new(0, Wrap::Loop, 0.618 * at as f32, 1.0)).collect();
    let gate = budget(600);
    let mut crowd = stage.crowd(&gate, RotationPath::Slerp, &instances);
    for (at, lod) in crowd.lods.iter_mut().enumerate() {
        lod.weight = if at < 10 { 65535 } else { 20000 };
    }
    let mut near = [0; 2];
    for number in 0..60 {
        let work = crowd.advance(&frame(number), number as f32 / 60.0);
        for pair in work.pairs.iter().filter(|_| number > 0) {
            near[usize::from(*pair >= 10 * 153)] += 1;
        }
    }
    assert!(near[0] as f64 > 1.4 * near[1] as f64, "{near:?}");
}

/// Ranks are in the order of the products, and within a sixteenth of an octave of each other.
#[test]
fn ranks_are_logarithms() {
    let mut draw = Draw::new(2);
    for _ in 0..20_000 {
        let (missed, weight) =
            (draw.word() >> (1 + draw.word() % 31), draw.word() >> (16 + draw.word() % 16));
        let product = f64::from(missed) * f64::from(weight);
        let octaves = if product > 0.0 { product.log2() } else { 0.0 };
        let rank = f64::from(rank_of(missed, weight) - 1) / 16.0;
        assert!((rank - octaves).abs() < 0.15 && rank_of(missed, weight) < 1024, "{missed} {weight}");
        assert!(rank_of(missed, weight) <= rank_of(missed.saturating_add(1).min(u32::MAX >> 1), weight));
    }
}

/// A table for one path between keys does not hold for the other: between two keys nlerp turns up to 1.27 times
/// as fast.
#[test]
fn tables_of_motion_hold_for_their_own_path_alone() {
    let stage = Stage::creature();
    let instances = [Instance::new(0, Wrap::Loop, 0.0, 1.0)];
    let refused = |gate: &Gate, path| {
        Crowd::new(&stage.order, &stage.set, gate, path, instances.to_vec()).err().map(|error| {
            assert!(error.bound.contains(&format!("{:?}", gate.path().expect("has motion"))), "{error}");
            (error.path, error.value)
        })
    };
    let wrong = |path| Some(("crowd.path".to_owned(), format!("{path:?}")));
    let (slerp, nlerp) = (RotationPath::Slerp, RotationPath::Nlerp);
    for (path, other) in [(slerp, nlerp), (nlerp, slerp)] {
        let budget = Gate::Budget { table: stage.expectations(path), bones: 9 };
        for gate in [stage.bounded(path), budget] {
            assert_eq!((refused(&gate, path), refused(&gate, other)), (None, wrong(other)));
        }
    }
    let off = stage.off();
    assert_eq!(off.path(), None);
    assert_eq!([slerp, nlerp].map(|path| refused(&off, path)), [None, None]);
}

/// A table of another clip, and invalid radii, are refused by name.
#[test]
fn tables_refuse_what_does_not_fit() {
    let stage = Stage::creature();
    fn field<T: std::fmt::Debug>(result: Result<T, relievo::InputError>) -> String {
        result.expect_err("refused").path
    }
    let (clips, path) = (stage.clips(), RotationPath::Slerp);
    assert_eq!(field(AnimatedBones::new(&stage.order, &stage.set, &clips[..1])), "clips.len");
    // The same number of clips, but in another order, or with another clip among them.
    let slow: Vec<BoneKeys> = (0..stage.skeleton.len()).map(|_| BoneKeys::default()).collect();
    let slow = Clip::new("slow", &stage.skeleton, &slow, clips[1].duration()).expect("valid");
    for (others, wrong) in
        [([clips[1], clips[0], clips[2]], "clips[0]"), ([clips[0], &slow, clips[2]], "clips[1]")]
    {
        assert_eq!(field(AnimatedBones::new(&stage.order, &stage.set, &others)), wrong);
    }
    assert_eq!(field(PriorityTable::new(&stage.order, &stage.set, &clips, &[])), "priorities.len");
    let bounds = |bone_radii: &[f32]| BoundTable::new(&stage.skeleton, &stage.set, &clips, bone_radii, path);
    assert_eq!(field(bounds(&[])), "bone_radii.len");
    let mut bone_radii = stage.bone_radii.clone();
    bone_radii[3] = f32::NAN;
    assert_eq!(field(bounds(&bone_radii)), "bone_radii[3]");
    let other = Stage::random(0, 7);
    assert_eq!(field(AnimatedBones::new(&other.order, &stage.set, &clips)), "skeleton.len");
    // The reference alone, without clip clocks, has nothing to decide.
    assert!(gate(&stage.off(), &frame(0), &[], &[], &mut []).bits.is_empty());
}
