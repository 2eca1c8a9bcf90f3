//! Bounds on the motion of each bone along a clip. They bound the error of a pose that is not updated. Motion is a path length:
//! the length of the path of a bone's local transform along the clip's common timeline. This length is weighted by how far the
//! bone moves points of the model.
//!
//! The path length of a translation, rotation or scale is the sum of its changes from key to key. It is never shorter than the
//! direct change between two times. `docs/pixel-bounds.md` derives the bound on a point's error and the path lengths of each
//! interpolation.

use super::clip_set::{ClipEntry, ClipSet};
use crate::asset::Bone;
use crate::asset::clip::{Clip, Interpolation, Track, TransformPart};
use crate::asset::keyframe::RotationPath;
use crate::asset::skeleton::Skeleton;

/// Number of samples of a rotation spline between two keys.
const MOMENTS: usize = 64;

/// Smallest quaternion norm along a rotation spline at which the angular speed counts as bounded. Closer to zero, the rotation
/// may jump by any angle.
const SHORTEST: f64 = 0.01;

/// Path length of the translation, rotation or scale of one bone, split at the times of the common timeline.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Path {
    /// Path length from each time to the next, at constant speed; 0 after the last time.
    pub rises: Vec<f64>,
    /// Length of the instantaneous jump at each time.
    pub jumps: Vec<f64>,
    /// Distance from the value at the clip's end to the value at its start.
    pub wrap: f64,
    /// Whether the speed has no known bound somewhere along the clip.
    pub is_boundless: bool,
}

impl Path {
    fn still(times: usize) -> Self {
        Self { rises: vec![0.0; times], jumps: vec![0.0; times], wrap: 0.0, is_boundless: false }
    }

    /// Path length over the whole clip, including the return from its end to its start.
    pub fn total(&self) -> f64 {
        self.rises.iter().chain(&self.jumps).sum::<f64>() + self.wrap
    }
}

/// Motion of one bone along a clip.
#[derive(Debug, Clone, PartialEq)]
pub struct BoneMotion {
    /// Paths of translation (in metres), rotation (in radians) and scale (as factors).
    pub parts: [Path; 3],
    /// Largest distance of the bone's origin from the parent's origin, in metres.
    pub translation: f64,
    /// Largest scale factor of the bone along any axis.
    pub scale: f64,
}

/// Motion of every bone along a clip. `path` is the rotation path between keys.
///
/// # Panics
/// If `clip` is not the clip that `entry` stands for in the set.
pub fn motions(set: &ClipSet, entry: &ClipEntry, clip: &Clip, path: RotationPath) -> Vec<BoneMotion> {
    let times = set.common_times(entry);
    (0..clip.bones()).map(|bone| bone_motion(clip, bone, times, path)).collect()
}

fn bone_motion(clip: &Clip, bone: usize, times: &[f32], path: RotationPath) -> BoneMotion {
    let keys = TransformPart::ALL.map(|part| Keys::new(clip, clip.track(bone, part), part, path));
    let parts = keys.each_ref().map(|keys| keys.path(times));
    let [translations, _, scales] = keys;
    let longest = |points: &[Value], norm: fn(&Value) -> f64| points.iter().map(norm).fold(0.0, f64::max);
    BoneMotion {
        parts,
        translation: longest(&translations.hull(), length),
        scale: longest(&scales.hull(), largest),
    }
}

type Value = [f64; 4];

/// Keys of one track, converted to f64.
struct Keys<'a> {
    part: TransformPart,
    path: RotationPath,
    interpolation: Interpolation,
    times: &'a [f32],
    /// Values in key order: one per key, or three per key of a cubic spline.
    values: Vec<Value>,
}

impl<'a> Keys<'a> {
    fn new(clip: &'a Clip, track: &Track, part: TransformPart, path: RotationPath) -> Self {
        let interpolation = track.interpolation;
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        let count = each * track.keys.max(1) as usize;
        let values = &clip.values()[track.first_value as usize..][..count];
        let values = values.iter().map(|value| value.map(f64::from)).collect();
        Self { part, path, interpolation, times: clip.times_of(track), values }
    }

    fn is_spline(&self) -> bool {
        self.interpolation == Interpolation::CubicSpline
    }

    fn value(&self, key: usize) -> &Value {
        if self.is_spline() { &self.values[3 * key + 1] } else { &self.values[key] }
    }

    /// Distance between two values: metres, radians or the largest difference of scale factors.
    fn distance(&self, a: &Value, b: &Value) -> f64 {
        let minus = |a: &Value, b: &Value| std::array::from_fn(|i| a[i] - b[i]);
        match self.part {
            TransformPart::Translation => length(&minus(a, b)),
            TransformPart::Rotation => {
                let [a, b] = [a, b].map(normalized);
                // Angle along the arc to the nearer of q and −q, from the lengths of both chords.
                let plus: Value = std::array::from_fn(|i| a[i] + b[i]);
                let (near, far) = (length(&minus(&a, &b)), length(&plus));
                4.0 * near.min(far).atan2(near.max(far))
            }
            TransformPart::Scale => largest(&minus(a, b)),
        }
    }

    fn path(&self, times: &[f32]) -> Path {
        let mut path = Path::still(times.len());
        let last = self.times.len().saturating_sub(1);
        if last == 0 {
            return path;
        }
        let row = |time: f32| times.partition_point(|other| *other < time);
        for key in 0..last {
            let [from, to] = [self.times[key], self.times[key + 1]];
            let way = self.distance(self.value(key), self.value(key + 1));
            if from == to || self.interpolation == Interpolation::Step {
                path.jumps[row(to)] += way;
                continue;
            }
            let speed = self.speed(key, way);
            path.is_boundless |= speed.is_none();
            let speed = speed.unwrap_or(std::f64::consts::PI);
            for at in row(from)..row(to) {
                let fraction = f64::from(times[at + 1] - times[at]) / f64::from(to - from);
                path.rises[at] += speed * fraction;
            }
        }
        path.wrap = self.distance(self.value(last), self.value(0));
        path
    }

    /// Largest speed between `key` and the next key: distance per unit of the fraction, which runs from 0 to 1 between the keys.
    /// `None` if there is no bound. `way` is the distance between the values of both keys.
    fn speed(&self, key: usize, way: f64) -> Option<f64> {
        if self.is_spline() {
            let bezier = self.bezier(key);
            let edges: [Value; 3] =
                std::array::from_fn(|edge| std::array::from_fn(|i| bezier[edge + 1][i] - bezier[edge][i]));
            let longest =
                |norm: fn(&Value) -> f64| 3.0 * edges.each_ref().map(norm).into_iter().fold(0.0, f64::max);
            return match self.part {
                TransformPart::Scale => Some(longest(largest)),
                TransformPart::Translation => Some(longest(length)),
                TransformPart::Rotation => turn_of_spline(&bezier, longest(length)),
            };
        }
        let quarter = way / 4.0;
        let is_chord = self.part == TransformPart::Rotation && self.path == RotationPath::Nlerp;
        Some(if is_chord && quarter > 0.0 { way * quarter.tan() / quarter } else { way })
    }

    /// Bézier control points of the spline between `key` and the next key. The stored tangents are already multiplied by the
    /// duration of the segment.
    fn bezier(&self, key: usize) -> [Value; 4] {
        let [start, leaving, arriving, end] = [1, 2, 3, 4].map(|at| self.values[3 * key + at]);
        let off = |point: Value, tangent: Value, side: f64| -> Value {
            std::array::from_fn(|i| point[i] + side * tangent[i] / 3.0)
        };
        [start, off(start, leaving, 1.0), off(end, arriving, -1.0), end]
    }

    /// Returns points whose convex hull contains all values of the track.
    fn hull(&self) -> Vec<Value> {
        if !self.is_spline() {
            return self.values.clone();
        }
        let keys = self.values.len() / 3;
        let mut points: Vec<Value> = (0..keys).map(|key| *self.value(key)).collect();
        points.extend((1..keys).flat_map(|key| self.bezier(key - 1)));
        points
    }
}

/// Largest angular speed of a normalized quaternion spline, in radians per unit of the fraction. `speed` is the largest speed of
/// the spline before normalization. `None` if the spline may come too close to zero.
fn turn_of_spline(bezier: &[Value; 4], speed: f64) -> Option<f64> {
    let at = |t: f64| -> Value {
        let u = 1.0 - t;
        let weights = [u * u * u, 3.0 * u * u * t, 3.0 * u * t * t, t * t * t];
        std::array::from_fn(|i| (0..4).map(|point| weights[point] * bezier[point][i]).sum())
    };
    let moments = (0..=MOMENTS).map(|moment| length(&at(moment as f64 / MOMENTS as f64)));
    // Between two samples, every point of the spline is at most half a step from one of them.
    let least = moments.fold(f64::INFINITY, f64::min) - speed / (2 * MOMENTS) as f64;
    (least > SHORTEST).then(|| 2.0 * speed / least)
}

fn length(value: &Value) -> f64 {
    value.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn largest(value: &Value) -> f64 {
    value.iter().map(|x| x.abs()).fold(0.0, f64::max)
}

fn normalized(value: &Value) -> Value {
    let length = length(value);
    value.map(|x| x / length)
}

/// Lever arms of each bone: factors that convert the [`Path`]s of its translation, rotation and scale to metres. They tell how
/// far points move per unit of each path.
pub type Levers = Vec<[f64; 3]>;

/// Upper bounds of the lever arms, for any point that follows the bone. `bone_radii` gives, for each bone, the largest distance
/// in metres from its origin to a point that follows only this bone.
pub fn bounding_levers(skeleton: &Skeleton, motions: &[BoneMotion], bone_radii: &[f32]) -> Levers {
    let bone_radius = subtree_radii(skeleton, motions, bone_radii);
    let mut above = vec![1.0; motions.len()];
    let mut levers = Levers::with_capacity(motions.len());
    for (bone, node) in skeleton.bones().iter().enumerate() {
        if let Some(parent) = node.parent {
            above[bone] = above[parent as usize] * motions[parent as usize].scale;
        }
        let sigma: f64 = above[bone];
        levers.push([sigma, sigma * motions[bone].scale * bone_radius[bone], sigma * bone_radius[bone]]);
    }
    levers
}

/// Radius of each bone's subtree: the largest distance, in metres, from the bone's origin to a point that follows the bone or a
/// descendant. The bone's own scale is not applied.
pub fn subtree_radii(skeleton: &Skeleton, motions: &[BoneMotion], bone_radii: &[f32]) -> Vec<f64> {
    let mut whole: Vec<f64> = bone_radii.iter().copied().map(f64::from).collect();
    for (bone, node) in skeleton.bones().iter().enumerate().rev() {
        if let Some(parent) = node.parent {
            let below = motions[bone].translation + motions[bone].scale * whole[bone];
            whole[parent as usize] = whole[parent as usize].max(below);
        }
    }
    whole
}

/// Typical lever arms of the bones: how far the points of a bone's subtree move per unit of the bone's translation, rotation or
/// scale. The displacements of the points are combined as the root of the sum of their squares. For rotation and scale, the
/// squares are averaged over all directions of the axis. Each bone of the subtree counts as one point, at the distance
/// `bone_radii` from that bone's origin. Positions are in the rest pose, in the model's units.
pub fn typical_levers(skeleton: &Skeleton, bone_radii: &[f32]) -> Levers {
    let model_matrices =
        crate::animation::local_to_model::reference::local_to_model(skeleton, &skeleton.rest());
    let origin = |bone: usize| glam::DVec3::from_array(model_matrices[bone].map(|row| f64::from(row[3])));
    let scales_above = skeleton.scales_above();
    // Per bone: the number of points, then the sums of squared distances across and along an axis.
    let mut sums = vec![[0.0; 3]; model_matrices.len()];
    for (bone, bone_radius) in bone_radii.iter().enumerate() {
        let own = (f64::from(*bone_radius) * scales_above[bone] * skeleton.bones()[bone].scale()).powi(2);
        let path = std::iter::successors(Some(bone), |bone| {
            skeleton.bones()[*bone].parent.map(|parent| parent as usize)
        });
        for above in path {
            let square = origin(bone).distance_squared(origin(above)) + own;
            let [points, across, along] = &mut sums[above];
            // Of the three axis directions, two lie across any given axis and one lies along it.
            (*points, *across, *along) = (*points + 1.0, *across + square * 2.0 / 3.0, *along + square / 3.0);
        }
    }
    let lever = |((sums, above), bone): (([f64; 3], f64), &Bone)| {
        let [points, across, along] = sums.map(f64::sqrt);
        [points * above, across, along / bone.scale()]
    };
    sums.into_iter().zip(scales_above).zip(skeleton.bones()).map(lever).collect()
}

/// Fraction of the remaining error budget that each bone should take. The remaining budget is the part that the bone's ancestors
/// leave.
///
/// A bone that moves at rate r and gets the part s of the whole budget is sampled r/s times. A subtree with budget b needs at
/// least K/b samples. For a leaf, K = r. For a bone with subtrees below it, let ΣK be the sum of the subtrees' K. Then K = (√r +
/// √ΣK)², and the bone takes the fraction √r/(√r + √ΣK).
pub fn budget_fractions(skeleton: &Skeleton, rates: &[f64]) -> Vec<f64> {
    let bones = skeleton.bones();
    let mut below = vec![0.0; rates.len()];
    let mut budget_fractions = vec![0.0; rates.len()];
    for (bone, node) in bones.iter().enumerate().rev() {
        let (own, others) = (rates[bone].sqrt(), f64::sqrt(below[bone]));
        budget_fractions[bone] = if own > 0.0 { own / (own + others) } else { 0.0 };
        if let Some(parent) = node.parent {
            below[parent as usize] += (own + others).powi(2);
        }
    }
    budget_fractions
}
