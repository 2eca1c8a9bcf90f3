//! The contender of the references: sampling and concatenation for CPUs in the way in which fast code is
//! usually written first. It has structures of arrays over the bones, in blocks that fill vectors, one timeline
//! for all tracks, linear keys only, no gates and no threads.

use relievo::InputError;
use relievo::asset::clip::Interpolation;
use relievo::asset::keyframe::KeyframeCursor;
use relievo::asset::skeleton::Skeleton;
use relievo::asset::transform::{Affine, Transform};
use relievo::ops::animation::clip_set::{ClipSet, SetTrack};
use relievo::ops::animation::local_to_model::reference::{affine, product};
use relievo::ops::animation::sample::{SLERP_U, SLERP_V};

/// Number of bones in a block.
const LANES: usize = 8;

/// One number for each bone of a block.
type Lanes = [f32; LANES];

/// Numbers per transform: translation, rotation, scale.
const NUMBERS: usize = 10;

/// The keys of a clip, and the skeleton's data.
pub(crate) struct PlainSoa {
    /// Key by key and number by number, with bones in blocks.
    keys: Vec<Lanes>,
    parents: Vec<Option<u32>>,
}

impl PlainSoa {
    /// The keys of a set's first clip.
    ///
    /// # Errors
    /// [`InputError`] for tracks that are not linear, or not all on the clip's first timeline.
    pub(crate) fn new(skeleton: &Skeleton, set: &ClipSet) -> Result<Self, InputError> {
        let tracks = &set.tracks()[..3 * set.bones()];
        let is_common =
            |track: &SetTrack| track.timeline == Some(0) && track.interpolation == Interpolation::Linear;
        if let Some(index) = tracks.iter().position(|track| !is_common(track)) {
            return Err(InputError::new("tracks", index, "must be linear and on the first timeline"));
        }
        let blocks = set.bones().div_ceil(LANES);
        let keys = set.timelines()[0].keys as usize;
        let mut all = vec![[0.0; LANES]; keys * NUMBERS * blocks];
        for key in 0..keys {
            let of_key = &mut all[key * NUMBERS * blocks..][..NUMBERS * blocks];
            // Lanes without a bone get the identity rotation.
            of_key[6 * blocks + blocks - 1] = [1.0; LANES];
            for (bone, tracks) in tracks.chunks_exact(3).enumerate() {
                let [t, r, s] = [0, 1, 2].map(|part| set.values()[tracks[part].first_value as usize + key]);
                for (number, value) in
                    [t[0], t[1], t[2], r[0], r[1], r[2], r[3], s[0], s[1], s[2]].into_iter().enumerate()
                {
                    of_key[number * blocks + bone / LANES][bone % LANES] = value;
                }
            }
        }
        Ok(Self { keys: all, parents: skeleton.bones().iter().map(|bone| bone.parent).collect() })
    }

    fn blocks(&self) -> usize {
        self.parents.len().div_ceil(LANES)
    }

    /// Allocates an instance's local transforms.
    pub(crate) fn locals(&self) -> Vec<Lanes> {
        vec![[0.0; LANES]; NUMBERS * self.blocks()]
    }

    /// Samples an instance's local transforms.
    pub(crate) fn sample(&self, cursor: KeyframeCursor, locals: &mut [Lanes]) {
        let blocks = self.blocks();
        let of_key = |key: usize| &self.keys[key * NUMBERS * blocks..][..NUMBERS * blocks];
        let from = of_key(cursor.key as usize);
        let to = if cursor.fraction > 0.0 { of_key(cursor.key as usize + 1) } else { from };
        let t = cursor.fraction;
        for number in [0, 1, 2, 7, 8, 9] {
            let row = number * blocks..(number + 1) * blocks;
            for ((from, to), local) in from[row.clone()].iter().zip(&to[row.clone()]).zip(&mut locals[row]) {
                *local = each(|l| from[l] + (to[l] - from[l]) * t);
            }
        }
        for block in 0..blocks {
            let of = |keys: &[Lanes]| [3, 4, 5, 6].map(|number| keys[number * blocks + block]);
            let rotations = slerps(&of(from), &of(to), t);
            for (number, rotation) in (3..).zip(rotations) {
                locals[number * blocks + block] = rotation;
            }
        }
    }

    /// Computes an instance's model matrices. Bones depend on their parents, so they are handled one after
    /// another.
    pub(crate) fn local_to_model(&self, locals: &[Lanes], model_matrices: &mut [Affine]) {
        let blocks = self.blocks();
        for (bone, parent) in self.parents.iter().enumerate() {
            let of = |number: usize| locals[number * blocks + bone / LANES][bone % LANES];
            let local = affine(&Transform {
                translation: [of(0), of(1), of(2)],
                rotation: [of(3), of(4), of(5), of(6)],
                scale: [of(7), of(8), of(9)],
            });
            model_matrices[bone] =
                parent.map_or(local, |parent| product(&model_matrices[parent as usize], &local));
        }
    }
}

fn each(value: impl Fn(usize) -> f32) -> Lanes {
    std::array::from_fn(value)
}

/// As in the reference, with one fraction for all lanes.
fn slerps(a: &[Lanes; 4], b: &[Lanes; 4], t: f32) -> [Lanes; 4] {
    let cosine = each(|l| a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l] + a[3][l] * b[3][l]);
    let inverse = each(|l| 1.0 / (2.0 + 2.0 * cosine[l]).sqrt());
    let less_one = each(|l| (1.0 + cosine[l]) * inverse[l] - 1.0);
    let (nearer, farther, way) = if t < 0.5 { (a, b, 2.0 * t) } else { (b, a, 2.0 - 2.0 * t) };
    let (of_middle, rest) = (weights(way, &less_one), weights(1.0 - way, &less_one));
    let of_middle = each(|l| of_middle[l] * inverse[l]);
    let of_nearer = each(|l| rest[l] + of_middle[l]);
    std::array::from_fn(|i| each(|l| nearer[i][l] * of_nearer[l] + farther[i][l] * of_middle[l]))
}

/// `sin(t·θ) / sin(θ)` for `less_one` = cos θ − 1.
fn weights(t: f32, less_one: &Lanes) -> Lanes {
    let terms = SLERP_U.iter().zip(SLERP_V).rev();
    let sums = terms.fold([1.0; LANES], |sums, (u, v)| {
        let factor = u * (t * t) - v;
        each(|l| 1.0 + factor * less_one[l] * sums[l])
    });
    sums.map(|sum| t * sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cases::animation::scene::crowd;
    use crate::cases::animation::scene::dense_creature;
    use relievo::asset::keyframe::RotationPath;
    use relievo::asset::transform::AFFINE_IDENTITY;
    use relievo::ops::animation::keyframe_cursor::reference::cursors;
    use relievo::ops::animation::local_to_model::LOCAL_TO_MODEL_BOUND;
    use relievo::ops::animation::local_to_model::reference::local_to_model;
    use relievo::ops::animation::sample::SAMPLE_BOUND;
    use relievo::ops::animation::sample::reference::sample_set;

    #[test]
    fn it_computes_what_the_references_compute() {
        let (skeleton, _, set) = dense_creature().expect("valid");
        let plain = PlainSoa::new(&skeleton, &set).expect("dense");
        let instances = crowd(50);
        let cursors = cursors(&set, &instances, 0.4);
        let reference = sample_set(&set, &instances, &cursors, RotationPath::Slerp);
        let deepest = 1 + skeleton.depths().iter().max().expect("bones");
        let (mut locals, mut model_matrices) = (plain.locals(), vec![AFFINE_IDENTITY; skeleton.len()]);
        for (cursor, reference) in cursors.iter().zip(reference.chunks(skeleton.len())) {
            plain.sample(*cursor, &mut locals);
            for (bone, reference) in reference.iter().enumerate() {
                let numbers = reference.translation.iter().chain(&reference.rotation).chain(&reference.scale);
                for (number, expected) in numbers.enumerate() {
                    let found = locals[number * plain.blocks() + bone / LANES][bone % LANES];
                    assert!((found - expected).abs() <= SAMPLE_BOUND, "{bone} {number}: {found} {expected}");
                }
            }
            plain.local_to_model(&locals, &mut model_matrices);
            let expected = local_to_model(&skeleton, reference);
            let (found, expected) =
                (model_matrices.as_flattened().as_flattened(), expected.as_flattened().as_flattened());
            let largest = expected.iter().fold(1.0, |a: f32, b| a.max(b.abs()));
            // The bound of local transforms, and that of products.
            let bound = (SAMPLE_BOUND + LOCAL_TO_MODEL_BOUND) * deepest as f32 * largest;
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= bound, "{found} {expected}");
            }
        }
    }

    #[test]
    fn tracks_that_it_cannot_play_are_refused() {
        let model = relievo_samples::creature().expect("valid");
        let set = ClipSet::new(&[&model.clips[0]]).expect("valid");
        assert_eq!(PlainSoa::new(&model.skeleton, &set).err().expect("refused").path, "tracks");
    }
}
