//! Animation of the creature: sine waves that move, turn or scale bones, sampled into keys.

use std::f64::consts::TAU;

use relievo::asset::clip::{BoneKeys, Interpolation, Keys};

use super::bones::{Kind, Part, Side, turn};

/// Function that gives the motion of each bone in a clip.
type MotionOf = fn(Kind) -> Motion;

/// Clips of the creature: name, duration in seconds, and the motion of each bone.
pub const CLIPS: [(&str, f64, MotionOf); 3] =
    [("walk", 1.0, walk), ("idle", 4.0, idle), ("wave", 2.0, greet)];

/// Sine wave `offset + amplitude · sin(2π(cycles·t + phase))` along or about an axis. t runs from 0 to 1 over the clip.
#[derive(Clone, Copy)]
struct Wave {
    axis: [f64; 3],
    offset: f64,
    amplitude: f64,
    cycles: f64,
    phase: f64,
}

impl Wave {
    fn at(&self, t: f64) -> f64 {
        self.offset + self.amplitude * libm::sin(TAU * (self.cycles * t + self.phase))
    }

    /// The same wave with its offset set to `offset`.
    fn shifted(self, offset: f64) -> Self {
        Self { offset, ..self }
    }

    fn times(self, cycles: f64) -> Self {
        Self { cycles, ..self }
    }
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Y: [f64; 3] = [0.0, 1.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn wave(axis: [f64; 3], amplitude: f64, phase: f64) -> Wave {
    Wave { axis, offset: 0.0, amplitude, cycles: 1.0, phase }
}

/// Number of segments between keys, and the waves that are added up. With 0 segments there is no track.
type Waves = (usize, Vec<Wave>);

/// Motion of one bone in a clip: rotation, translation, scale, and whether the bone blinks.
#[derive(Default)]
pub struct Motion {
    turns: Waves,
    moves: Waves,
    swells: Waves,
    blinks: bool,
}

impl Motion {
    fn turning(keys: usize, turns: impl Into<Vec<Wave>>) -> Self {
        Self { turns: (keys, turns.into()), ..Self::default() }
    }

    fn moving(self, keys: usize, moves: impl Into<Vec<Wave>>) -> Self {
        Self { moves: (keys, moves.into()), ..self }
    }

    /// Adds a motion of scale. Its keys are splines, because swelling is smooth.
    fn swelling(self, keys: usize, swells: impl Into<Vec<Wave>>) -> Self {
        Self { swells: (keys, swells.into()), ..self }
    }

    /// Tracks of the bone `part` in a clip of `duration` seconds.
    pub fn keys(&self, duration: f64, part: &Part) -> BoneKeys {
        let [translation, scale] = [part.rest.translation, part.rest.scale].map(|rest| rest.map(f64::from));
        let Self {
            turns: (turned_by, turns),
            moves: (moved_by, moves),
            swells: (swelled_by, swells),
            blinks,
        } = self;
        let swelling =
            || (*swelled_by > 0).then(|| spline(duration, *swelled_by, |t| along(scale, swells, t)));
        BoneKeys {
            translation: (*moved_by > 0).then(|| line(duration, *moved_by, |t| along(translation, moves, t))),
            rotation: (*turned_by > 0)
                .then(|| line(duration, *turned_by, |t| turned(part.rest.rotation, turns, t))),
            scale: if *blinks { Some(blink(duration)) } else { swelling() },
        }
    }
}

/// Evenly spaced keys with linear interpolation. The last key equals the first, so that clips loop.
fn line(duration: f64, stretches: usize, value: impl Fn(f64) -> [f64; 4]) -> Keys {
    let at = |key: usize| value((key % stretches) as f64 / stretches as f64).map(|v| v as f32);
    Keys {
        times: (0..=stretches).map(|key| (duration * key as f64 / stretches as f64) as f32).collect(),
        values: (0..=stretches).map(at).collect(),
        interpolation: Interpolation::Linear,
    }
}

/// Keys with spline interpolation and the motion's own tangents. Distances between keys grow, to exercise uneven times.
fn spline(duration: f64, stretches: usize, value: impl Fn(f64) -> [f64; 4]) -> Keys {
    let time = |key: usize| {
        let even = key as f64 / stretches as f64;
        even * (0.75 + 0.25 * even)
    };
    let mut keys = Keys { times: Vec::new(), values: Vec::new(), interpolation: Interpolation::CubicSpline };
    for key in 0..=stretches {
        let t = if key == stretches { 0.0 } else { time(key) };
        let (before, after) = (value(t - 1e-4), value(t + 1e-4));
        let tangent = std::array::from_fn(|i| ((after[i] - before[i]) / (2e-4 * duration)) as f32);
        keys.times.push((duration * time(key)) as f32);
        keys.values.extend([tangent, value(t).map(|v| v as f32), tangent]);
    }
    keys
}

/// Scale track of an eye, with step interpolation: closed for a tenth of a second, otherwise open.
fn blink(duration: f64) -> Keys {
    let [open, closed] = [[1.0, 1.0, 1.0, 0.0], [1.0, 0.1, 1.0, 0.0]];
    Keys {
        times: [0.0, 0.61 * duration, 0.61 * duration + 0.1, duration].map(|time| time as f32).to_vec(),
        values: vec![open, closed, open, open],
        interpolation: Interpolation::Step,
    }
}

fn along(rest: [f64; 3], waves: &[Wave], t: f64) -> [f64; 4] {
    let mut value = [rest[0], rest[1], rest[2], 0.0];
    for wave in waves {
        let by = wave.at(t);
        (0..3).for_each(|i| value[i] += wave.axis[i] * by);
    }
    value
}

/// Rotation in the parent's space: the rest rotation, then one rotation per wave in order.
fn turned(rest: [f32; 4], waves: &[Wave], t: f64) -> [f64; 4] {
    waves.iter().fold(rest.map(f64::from), |rotation, wave| product(turn(wave.axis, wave.at(t)), rotation))
}

fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    ]
}

/// Phase of a leg's swing, in cycles. The legs are half a cycle apart: one is in front when the other is behind.
fn step(side: Side) -> f64 {
    if side == Side::Left { 0.0 } else { 0.5 }
}

/// Walking: one stride of each leg. Legs point down at rest, so a negative rotation about x swings them forward.
fn walk(kind: Kind) -> Motion {
    let small = |at: usize| 0.01 * at as f64;
    match kind {
        // The creature walks in place: the pelvis sways, but the root does not move.
        Kind::Root => Motion::default(),
        Kind::Pelvis => Motion::turning(16, [wave(Y, 0.08, 0.25), wave(Z, 0.04, 0.0)])
            .moving(16, [wave(Y, 0.02, 0.0).times(2.0).shifted(0.01), wave(X, 0.015, 0.0)]),
        Kind::Spine(at) => Motion::turning(
            16,
            [
                wave(Y, -0.035, 0.25 - small(at)),
                wave(Z, -0.012, -small(at)),
                wave(X, 0.01, small(at)).times(2.0).shifted(0.01),
            ],
        ),
        Kind::Crest(at) => Motion::turning(8, [wave(X, 0.08, -0.03 * at as f64).times(2.0)]),
        Kind::Belly(at) => {
            Motion::default().swelling(6, [wave([1.0, 0.0, 0.6], 0.03, 0.05 * at as f64).times(2.0)])
        }
        Kind::Neck(at) => {
            Motion::turning(12, [wave(Y, 0.03, 0.25 - small(at)), wave(X, 0.02, 0.3).times(2.0)])
        }
        Kind::Head => Motion::turning(12, [wave(X, 0.03, 0.4).times(2.0), wave(Z, 0.02, 0.1)]),
        Kind::Ear(_, at) => {
            Motion::turning(16, [wave(X, 0.06 + 0.05 * at as f64, -0.06 * at as f64).times(2.0)])
        }
        Kind::Feeler(_, at) => Motion::turning(16, [wave(X, 0.08, -0.07 * at as f64).times(2.0)]),
        Kind::Clavicle(side) => Motion::turning(8, [wave(Y, 0.05, step(side) + 0.25)]),
        Kind::UpperArm(side) => Motion::turning(20, [wave(X, 0.45, step(side) + 0.25)]),
        Kind::Forearm(side) => {
            let s = side.sign();
            Motion::turning(20, [wave(Y, -0.2 * s, step(side) + 0.75).shifted(-0.35 * s)])
        }
        Kind::UpperArmTwist(side) | Kind::ForearmTwist(side) => {
            Motion::turning(8, [wave(X, 0.08, step(side))])
        }
        Kind::Hand(side) => Motion::turning(12, [wave(Z, 0.1, step(side) + 0.15)]),
        Kind::Finger(side, digit, at) => {
            let curl = -side.sign() * (0.12 + 0.02 * digit as f64) * f64::from(at > 0);
            Motion::turning(if at == 0 { 2 } else { 6 }, [wave(Z, 0.3 * curl, step(side)).shifted(curl)])
        }
        Kind::Thigh(side) => {
            Motion::turning(32, [wave(X, -0.45, step(side)).shifted(-0.08), wave(Z, 0.02, step(side))])
        }
        Kind::Shin(side) => Motion::turning(32, [wave(X, 0.42, step(side) - 0.2).shifted(0.47)]),
        Kind::ThighTwist(side) => Motion::turning(8, [wave(Y, 0.05, step(side))]),
        Kind::ShinTwist(_) => Motion::default(),
        Kind::Foot(side) => Motion::turning(32, [wave(X, 0.3, step(side) - 0.35).shifted(-0.25)]),
        Kind::Toe(side, _, 0) => Motion::turning(12, [wave(X, -0.2, step(side) + 0.4).shifted(-0.1)]),
        Kind::Tail(at) => {
            let phase = -0.06 * at as f64;
            Motion::turning(24, [wave(Y, 0.06 + 0.006 * at as f64, phase), wave(X, 0.02, phase).times(2.0)])
        }
        _ => Motion::default(),
    }
}

/// Idling: the creature breathes and looks around.
fn idle(kind: Kind) -> Motion {
    let breath = |amplitude: f64, phase: f64| wave(X, amplitude, phase).times(2.0);
    match kind {
        Kind::Pelvis => Motion::turning(8, [wave(Z, 0.015, 0.0)]).moving(8, [wave(X, 0.02, 0.0)]),
        Kind::Spine(at) => Motion::turning(12, [breath(-0.008, 0.01 * at as f64), wave(Z, -0.006, 0.0)]),
        Kind::Crest(at) => Motion::turning(8, [breath(0.04, -0.02 * at as f64)]),
        Kind::Belly(at) => {
            let out = Wave { axis: [1.0, 0.3, 1.0], ..breath(0.05, 0.02 * at as f64) };
            Motion::default().swelling(10, [out]).moving(8, [Wave { axis: Z, ..breath(0.008, 0.0) }])
        }
        Kind::Neck(at) => Motion::turning(10, [wave(Y, 0.08, 0.05 * at as f64)]),
        Kind::Head => Motion::turning(16, [wave(Y, 0.15, 0.1), breath(0.03, 0.2)]),
        Kind::Eye(_) => Motion { blinks: true, ..Motion::turning(10, [wave(Y, 0.2, 0.0)]) },
        Kind::Ear(side, at) => {
            let twitch = wave(Z, 0.08 * side.sign(), 0.1 * at as f64).times(3.0);
            Motion::turning(24, [twitch])
        }
        Kind::Feeler(side, at) => {
            Motion::turning(20, [wave(Y, 0.12, 0.3 * step(side) - 0.05 * at as f64).times(2.0)])
        }
        Kind::Clavicle(side) => Motion::turning(8, [Wave { axis: Z, ..breath(0.02 * side.sign(), 0.0) }]),
        Kind::UpperArm(side) => Motion::turning(8, [breath(0.02, 0.1), wave(Z, 0.02 * side.sign(), 0.3)]),
        Kind::Forearm(side) => Motion::turning(8, [wave(Y, -0.04, 0.1).shifted(-0.2 * side.sign())]),
        Kind::Hand(_) => Motion::turning(6, [wave(Z, 0.03, 0.2)]),
        Kind::Finger(side, digit, at) if at > 0 => {
            let curl = -side.sign() * 0.15;
            Motion::turning(6, [wave(Z, 0.3 * curl, 0.1 * digit as f64).shifted(curl)])
        }
        Kind::Thigh(_) => Motion::turning(8, [wave(Z, -0.02, 0.0)]),
        Kind::Foot(_) => Motion::turning(8, [wave(Z, 0.005, 0.0)]),
        Kind::Tail(at) => Motion::turning(20, [wave(Y, 0.09, -0.05 * at as f64)]),
        Kind::Tongue(at) => Motion::turning(6, [breath(0.03, 0.1 * at as f64)]),
        _ => Motion::default(),
    }
}

/// Greeting: the right arm is raised, and its forearm and fingers wave. The other bones breathe faster than in `idle`.
fn greet(kind: Kind) -> Motion {
    let is_right = |side: Side| side == Side::Right;
    match kind {
        Kind::Clavicle(side) if is_right(side) => Motion::turning(8, [wave(Z, 0.03, 0.0).shifted(-0.15)]),
        Kind::UpperArm(side) if is_right(side) => {
            Motion::turning(16, [wave(Z, 0.06, 0.0).times(3.0).shifted(-1.9), wave(Y, 0.05, 0.2)])
        }
        Kind::Forearm(side) if is_right(side) => {
            Motion::turning(32, [wave(Z, 0.45, 0.05).times(3.0).shifted(-0.7)])
        }
        Kind::Hand(side) if is_right(side) => Motion::turning(32, [wave(Z, 0.3, -0.05).times(3.0)]),
        Kind::ForearmTwist(side) if is_right(side) => Motion::turning(16, [wave(X, 0.15, 0.1).times(3.0)]),
        Kind::Finger(side, digit, at) if is_right(side) && at > 0 => {
            Motion::turning(24, [wave(Z, 0.12, -0.08 * at as f64 - 0.02 * digit as f64).times(3.0)])
        }
        Kind::Head => Motion::turning(16, [wave(Z, 0.06, 0.0), wave(Y, 0.03, 0.0).shifted(-0.15)]),
        Kind::Jaw => Motion::turning(12, [wave(X, 0.08, 0.0).times(2.0).shifted(0.1)]),
        Kind::Tail(at) => Motion::turning(24, [wave(Y, 0.12, -0.07 * at as f64).times(2.0)]),
        other => idle(other),
    }
}
