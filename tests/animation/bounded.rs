//! The bound of `bounded`, on clips that are designed to break it.

use relievo::asset::clip::{BoneKeys, Interpolation, Keys};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Affine, Bone, Clip, Skeleton, Transform};
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::{AnimatedBones, BoundTable, ClipSet, Frame, Gate};
use relievo_lab::cases::animation::Draw;
use relievo_lab::crowd::Crowd;

fn skeleton(parents: &[Option<u32>]) -> Skeleton {
    let bone =
        |parent: &Option<u32>| Bone { name: String::new(), parent: *parent, rest: Transform::IDENTITY };
    Skeleton::of_joints(parents.iter().map(bone).collect()).expect("valid")
}

fn keys(times: &[f32], values: &[[f32; 4]], interpolation: Interpolation) -> Option<Keys> {
    Some(Keys { times: times.to_vec(), values: values.to_vec(), interpolation })
}

fn clip(skeleton: &Skeleton, bones: &[BoneKeys], duration: f32) -> Clip {
    Clip::new("clip", skeleton, bones, duration).expect("valid")
}

/// Instances of a skeleton, under `bounded` and in full.
struct Run<'a> {
    skeleton: &'a Skeleton,
    clips: &'a [Clip],
    bone_radii: &'a [f32],
    path: RotationPath,
    allowed: f32,
}

impl Run<'_> {
    /// The largest error, minus the rounding of matrices, divided by the permitted one. `step` changes
    /// instances and returns the duration of a frame.
    fn worst(
        &self,
        instances: &[Instance],
        frames: u32,
        mut step: impl FnMut(&mut [Instance]) -> f32,
    ) -> f64 {
        let clips: Vec<&Clip> = self.clips.iter().collect();
        let (set, order) = (ClipSet::new(&clips).expect("fits"), Order::new(self.skeleton));
        let bounds = BoundTable::new(self.skeleton, &set, &clips, self.bone_radii, self.path).expect("fits");
        let off = Gate::Off(AnimatedBones::new(&order, &set, &clips).expect("fits"));
        let bounded = Gate::Bounded(bounds.clone());
        let crowd = |gate| Crowd::new(&order, &set, gate, self.path, instances.to_vec()).expect("one path");
        let (mut lazy, mut full) = (crowd(&bounded), crowd(&off));
        lazy.lods.iter_mut().for_each(|lod| lod.allowed = bounds.units(self.allowed));
        let (mut worst, mut elapsed) = (0.0_f64, 0.0);
        for number in 0..frames {
            let seconds = step(&mut lazy.instances);
            elapsed += seconds;
            full.instances.clone_from(&lazy.instances);
            // The time ahead is sometimes more or less than a frame, sometimes back in time, and sometimes
            // zero.
            let ahead = [1.0, 0.0, 2.0, 1.0, 0.3, -1.0][number as usize % 6] * seconds;
            let frame = Frame { ticks: number, frame_ticks: 1, frame: number, ahead };
            lazy.advance(&frame, elapsed);
            full.advance(&frame, elapsed);
            worst =
                worst.max(self.error(&lazy.model_matrices, &full.model_matrices) / f64::from(self.allowed));
        }
        worst
    }

    fn error(&self, stale: &[Affine], fresh: &[Affine]) -> f64 {
        let (mut worst, mut size) = (0.0_f64, 0.0_f64);
        for (pair, (stale, fresh)) in stale.iter().zip(fresh).enumerate() {
            let bone_radius = f64::from(self.bone_radii[pair % self.bone_radii.len()]);
            for (axis, side) in (0..3).flat_map(|axis| [(axis, -bone_radius), (axis, bone_radius)]) {
                let at = |model: &Affine, row: usize| {
                    f64::from(model[row][3]) + side * f64::from(model[row][axis])
                };
                let off = (0..3).map(|row| (at(stale, row) - at(fresh, row)).powi(2)).sum::<f64>().sqrt();
                worst = worst.max(off);
                size = (0..3).fold(size, |size, row| size.max(at(fresh, row).abs()));
            }
        }
        worst - 1e-5 * size
    }
}

fn one(keys: BoneKeys, duration: f32) -> (Skeleton, Vec<Clip>) {
    let skeleton = skeleton(&[None]);
    let clip = clip(&skeleton, &[keys], duration);
    (skeleton, vec![clip])
}

fn looping() -> [Instance; 1] {
    [Instance::new(0, Wrap::Loop, 0.0, 1.0)]
}

/// A jump at the clip's very first key, after the start.
#[test]
fn a_jump_at_the_first_key_is_seen() {
    let x = |x: f32| [x, 0.0, 0.0, 0.0];
    for (times, values, duration) in [
        (vec![0.5, 0.5, 1.0], vec![x(0.0), x(1.0), x(1.01)], 0.0),
        (vec![0.5, 0.5], vec![x(0.0), x(1.0)], 1.0),
    ] {
        let translation = keys(&times, &values, Interpolation::Linear);
        let (skeleton, clips) = one(BoneKeys { translation, ..BoneKeys::default() }, duration);
        let run = Run {
            skeleton: &skeleton,
            clips: &clips,
            bone_radii: &[0.1],
            path: RotationPath::Slerp,
            allowed: 0.1,
        };
        let worst = run.worst(&looping(), 60, |_| 0.05);
        assert!(worst <= 1.0, "{worst} of what is allowed");
    }
}

/// Motion smaller than a 16-bit fraction resolves.
#[test]
fn slow_stretches_hide_nothing() {
    let translation = keys(&[0.0, 100.0], &[[0.0; 4], [100.0, 0.0, 0.0, 0.0]], Interpolation::Linear);
    let (skeleton, clips) = one(BoneKeys { translation, ..BoneKeys::default() }, 0.0);
    for allowed in [0.0001, 0.0005, 0.01] {
        let run = Run {
            skeleton: &skeleton,
            clips: &clips,
            bone_radii: &[0.1],
            path: RotationPath::Slerp,
            allowed,
        };
        let worst = run.worst(&looping(), 900, |_| 0.001);
        assert!(worst <= 1.0, "{worst} of {allowed}");
    }
}

/// A spline from q to nearly −q rotates by almost half a turn in an instant.
#[test]
fn splines_through_nothing_are_always_sampled() {
    for (off, seconds) in [(0.02_f32, 1.0), (0.002, 10.0), (0.0004, 1.0)] {
        let end = [0.0, 0.0, -off.sin(), -off.cos()];
        let values = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [0.0; 4], [0.0; 4], end, [0.0; 4]];
        let rotation = keys(&[0.0, seconds], &values, Interpolation::CubicSpline);
        let (skeleton, clips) = one(BoneKeys { rotation, ..BoneKeys::default() }, 0.0);
        let run = Run {
            skeleton: &skeleton,
            clips: &clips,
            bone_radii: &[1.0],
            path: RotationPath::Slerp,
            allowed: 1.2,
        };
        let worst = run.worst(&looping(), (seconds * 1000.0) as u32, |_| 0.001);
        assert!(worst <= 1.0, "{worst} of what is allowed");
    }
}

/// Keys of one part: every interpolation, tangents up to five times the values, jumps, scales beyond 1 and mirrored.
fn random_keys(draw: &mut Draw, part: usize, size: f32) -> Option<Keys> {
    if draw.word().is_multiple_of(4) {
        return None;
    }
    let mut time = 0.3 * f32::from(draw.word().is_multiple_of(4));
    let times: Vec<f32> = (0..[1, 2, 2, 5][draw.word() as usize % 4])
        .map(|_| {
            let here = time;
            time += [0.0, 0.5, 0.03, 2.0][draw.word() as usize % 4];
            here
        })
        .collect();
    let interpolation =
        [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline][draw.word() as usize % 3];
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let mirror = [1.0, -1.0][draw.word() as usize % 2];
    let values = (0..each * times.len()).map(|at| {
        let is_tangent = each == 3 && at % 3 != 1;
        let mut vector =
            |factor: f32| [draw.signed() * factor, draw.signed() * factor, draw.signed() * factor];
        match (part, is_tangent) {
            (0, _) => [vector(size * if is_tangent { 5.0 } else { 1.0 }), [0.0; 3]].concat(),
            (1, false) => draw.rotation().to_vec(),
            (1, true) => [vector(3.0), [3.0; 3]].concat(),
            (_, true) => [vector(0.6), [0.0; 3]].concat(),
            (_, false) => {
                let [x, y, z] = vector(0.2);
                vec![1.2 + x, mirror * (1.2 + y), 1.1 + z, 0.0]
            }
        }
    });
    let values: Vec<[f32; 4]> = values.map(|value| [value[0], value[1], value[2], value[3]]).collect();
    keys(&times, &values, interpolation)
}

fn random_instance(draw: &mut Draw) -> Instance {
    let wrap = if draw.word().is_multiple_of(4) { Wrap::Clamp } else { Wrap::Loop };
    let rate = [1.0, -1.0, 0.25, 0.0, 8.0][draw.word() as usize % 5];
    Instance::new(draw.word() % 3, wrap, 40.0 * draw.signed(), rate)
}

/// Chains and forests of random clips that start, reverse and change at random, in frames from 0 s to many
/// turns.
#[test]
fn random_clips_keep_the_promise() {
    let mut closest = 0.0_f64;
    for case in 0..80 {
        let mut draw = Draw::new(case ^ 0x5eed);
        let bones = [1, 2, 5, 12, 33][draw.word() as usize % 5];
        let is_chain = draw.word().is_multiple_of(2);
        let parents: Vec<_> = (0..bones)
            .map(|bone| match draw.word() {
                _ if bone == 0 => None,
                _ if is_chain => Some(bone - 1),
                word => (!word.is_multiple_of(7)).then_some(word / 7 % bone),
            })
            .collect();
        let skeleton = skeleton(&parents);
        let size = [1.0, 1.0, 0.1, 100.0][draw.word() as usize % 4];
        let clips: Vec<Clip> = (0..3)
            .map(|_| {
                let bones: Vec<BoneKeys> = (0..bones)
                    .map(|_| BoneKeys {
                        translation: random_keys(&mut draw, 0, size),
                        rotation: random_keys(&mut draw, 1, size),
                        scale: random_keys(&mut draw, 2, size),
                    })
                    .collect();
                clip(&skeleton, &bones, 7.0 * f32::from(draw.word().is_multiple_of(3)))
            })
            .collect();
        let bone_radii: Vec<f32> = (0..bones).map(|_| draw.signed().abs()).collect();
        let path = [RotationPath::Slerp, RotationPath::Nlerp][case as usize % 2];
        let instances: Vec<_> = (0..4).map(|_| random_instance(&mut draw)).collect();
        for allowed in [0.003, 0.1, 1.0, 10.0] {
            let run = Run {
                skeleton: &skeleton,
                clips: &clips,
                bone_radii: &bone_radii,
                path,
                allowed: allowed * size,
            };
            let worst = run.worst(&instances, 60, |instances| {
                let at = draw.word() as usize % instances.len();
                match draw.word() % 20 {
                    0 | 1 => instances[at] = random_instance(&mut draw),
                    2 | 3 => instances[at].start = 10.0 * draw.signed(),
                    4 | 5 => instances[at].rate = -instances[at].rate,
                    _ => {}
                }
                match draw.word() % 8 {
                    0 => 0.0,
                    1 => 11.3,
                    2 => 0.000_02,
                    3 => 0.1,
                    _ => 0.001 + 0.03 * draw.signed().abs(),
                }
            });
            assert!(worst <= 1.0, "case {case}: {worst} of {}", allowed * size);
            closest = closest.max(worst);
        }
    }
    assert!(closest > 0.9, "far too careful: {closest}");
}
