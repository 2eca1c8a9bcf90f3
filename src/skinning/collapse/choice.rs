//! Choice of the bones to collapse. Each step chooses the bone whose collapse displaces vertices least.

use glam::{DAffine3, DMat3, DVec3};

use super::compose::{is_constant, signs, signs_in};
use super::rest::{Follower, Rest, bind};
use super::{CollapseOptions, looked_at};
use crate::InputError;
use crate::asset::clip::{Clip, TransformPart};
use crate::asset::transform::column_major;
use crate::asset::{Model, Skeleton};
use crate::parallel;
use crate::skinning::pose::{Moment, bones_at};

/// The largest number of poses per clip in which costs are measured.
const POSES: usize = 64;

/// Displacements below this fraction of the model's size are treated as rounding errors.
const UNSEEN: f64 = 1e-6;

/// The kept bones, and for each collapsed bone the kept bone that its vertices follow.
pub(super) struct Remap {
    /// For each bone: the bone itself if it is kept, otherwise the kept bone that its vertices follow.
    follows: Vec<usize>,
    parents: Vec<Option<usize>>,
}

impl Remap {
    fn new(skeleton: &Skeleton) -> Self {
        let parents = skeleton.bones().iter().map(|bone| bone.parent.map(|parent| parent as usize));
        Self { follows: (0..skeleton.len()).collect(), parents: parents.collect() }
    }

    pub(super) fn is_kept(&self, bone: usize) -> bool {
        self.follows[bone] == bone
    }

    /// The bone itself if it is kept, otherwise the kept bone that its vertices follow.
    pub(super) fn follows(&self, bone: usize) -> usize {
        self.follows[bone]
    }

    /// The indices of the kept bones, ascending.
    pub(super) fn kept(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.follows.len()).filter(|bone| self.is_kept(*bone))
    }

    /// A chain of bones: the collapsed bones between `bone` and the nearest kept bone above it, topmost first, and then
    /// `bone` itself.
    pub(super) fn chain(&self, bone: usize) -> Vec<usize> {
        let above = |bone: &usize| self.parents[*bone].filter(|parent| !self.is_kept(*parent));
        let mut chain: Vec<usize> = std::iter::successors(Some(bone), above).collect();
        chain.reverse();
        chain
    }

    /// For each bone, an index among the kept bones: the bone's own index if it is kept, otherwise the index of the
    /// bone that its vertices follow.
    pub(super) fn indices(&self) -> Vec<u32> {
        let mut indices = vec![0; self.follows.len()];
        self.kept().zip(0..).for_each(|(bone, index)| indices[bone] = index);
        self.follows.iter().map(|bone| indices[*bone]).collect()
    }

    /// The nearest kept bone above a bone; `None` for a root.
    fn kept_above(&self, bone: usize) -> Option<usize> {
        self.parents[bone].map(|parent| self.follows[parent])
    }

    fn collapse(&mut self, bone: usize, into: usize) {
        self.follows.iter_mut().filter(|follows| **follows == bone).for_each(|follows| *follows = into);
    }
}

/// The cost of a collapse: the largest displacement of a vertex, then the largest weighted distance of a vertex from
/// the bone. The second is compared only if the first is equal.
type Cost = [f64; 2];

/// The state of the choice: poses, kept bones and the cost of each collapse.
pub(super) struct Choice<'a> {
    rest: &'a Rest,
    /// For each pose, the model-space matrices of all bones.
    poses: Vec<Vec<DAffine3>>,
    /// For each bone, whether it never collapses.
    stays: Vec<bool>,
    /// For each bone, whether its scale is uniform except for signs, both at rest and in every clip.
    is_even: Vec<bool>,
    remap: Remap,
    costs: Vec<Option<Cost>>,
}

impl<'a> Choice<'a> {
    /// # Errors
    /// [`InputError`] for a name that no bone has, and for a clip that is too long.
    pub(super) fn new(model: &Model, options: &CollapseOptions, rest: &'a Rest) -> Result<Self, InputError> {
        let skeleton = &model.skeleton;
        let is_even = |bone: usize| {
            let at_rest = signs([skeleton.bones()[bone].rest.scale]).is_some();
            at_rest && model.clips.iter().all(|clip| signs_in(clip, bone).is_some())
        };
        let pose = |moment: &Moment| -> Vec<DAffine3> {
            bones_at(model, *moment).iter().map(|bone| bind(&column_major(bone))).collect()
        };
        Ok(Self {
            rest,
            poses: parallel::map(&looked_at(model, POSES)?, pose),
            stays: stays(model, options)?,
            is_even: (0..skeleton.len()).map(is_even).collect(),
            remap: Remap::new(skeleton),
            costs: vec![None; skeleton.len()],
        })
    }

    /// Collapses bones until `count` are left or no other bone can collapse.
    ///
    /// # Errors
    /// [`InputError`] if `count` is below the number of bones that never collapse.
    pub(super) fn collapsed_to(mut self, count: usize) -> Result<Remap, InputError> {
        let least = self.stays.iter().filter(|stays| **stays).count();
        if count < least {
            let bound =
                format!("must be at least {least}: roots, what clips move first, end effectors, bones named");
            return Err(InputError::new("bones", count, bound));
        }
        let mut left = self.remap.follows.len();
        while left > count && self.collapse() {
            left -= 1;
        }
        Ok(self.remap)
    }

    /// Collapses the bone with the least cost. Returns whether there was a candidate. Among equal costs, the last bone
    /// is taken, which is the deepest of its chain.
    fn collapse(&mut self) -> bool {
        let holds = self.holds();
        let is_candidate = |bone: &usize| !self.stays[*bone] && (self.is_even[*bone] || !holds[*bone]);
        let candidates: Vec<usize> = self.remap.kept().filter(is_candidate).collect();
        for bone in &candidates {
            if self.costs[*bone].is_none() {
                self.costs[*bone] = Some(self.cost(*bone));
            }
        }
        let cost = |bone: &usize| self.costs[*bone].unwrap_or([f64::INFINITY; 2]);
        let order = |a: &usize, b: &usize| {
            let [a, b] = [cost(a), cost(b)];
            a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1]))
        };
        let Some(best) = candidates.into_iter().rev().min_by(order) else { return false };
        let Some(into) = self.remap.kept_above(best) else { return false };
        // The costs of some bones are outdated. The bones below have another kept bone above them now, and `into` has
        // gained vertices.
        let below: Vec<usize> =
            self.remap.kept().filter(|bone| self.remap.kept_above(*bone) == Some(best)).collect();
        below.into_iter().chain([into]).for_each(|bone| self.costs[bone] = None);
        self.remap.collapse(best, into);
        true
    }

    /// For each bone, whether at least one kept bone is below it.
    fn holds(&self) -> Vec<bool> {
        let mut holds = vec![false; self.stays.len()];
        for bone in self.remap.kept() {
            if let Some(above) = self.remap.kept_above(bone) {
                holds[above] = true;
            }
        }
        holds
    }

    /// The cost of collapsing a bone. After the collapse, the vertices of the bone and of all bones that collapsed into
    /// it follow the next kept bone above.
    fn cost(&self, bone: usize) -> Cost {
        let Some(above) = self.remap.kept_above(bone) else { return [f64::INFINITY; 2] };
        let group: Vec<usize> =
            (0..self.stays.len()).filter(|other| self.remap.follows(*other) == bone).collect();
        let offsets: Vec<DAffine3> = group.iter().map(|other| self.offset(above, *other)).collect();
        let mut moved: Vec<(usize, &Follower)> = (group.iter().enumerate())
            .flat_map(|(index, other)| self.rest.followers[*other].iter().map(move |one| (index, one)))
            .collect();
        moved.sort_by_key(|(_, follower)| follower.vertex);
        let stray = |models: &Vec<DAffine3>| {
            let changes: Vec<(DMat3, DVec3)> = (group.iter().zip(&offsets))
                .map(|(other, offset)| difference(models[above] * *offset, models[*other]))
                .collect();
            let of_vertex = |moved: &[(usize, &Follower)]| -> f64 {
                let strays = moved.iter().map(|(index, follower)| {
                    let (turn, shift) = changes[*index];
                    follower.weight * (turn * follower.local + shift)
                });
                strays.sum::<DVec3>().length_squared()
            };
            moved.chunk_by(|a, b| a.1.vertex == b.1.vertex).map(of_vertex).fold(0.0, f64::max)
        };
        let stray = parallel::map(&self.poses, stray).into_iter().fold(0.0, f64::max).sqrt();
        let origin = self.rest.models[bone].translation;
        let bone_radius = moved.iter().map(|(index, follower)| {
            let at_rest = self.rest.models[group[*index]].transform_point3(follower.local);
            follower.weight * at_rest.distance(origin)
        });
        let bone_radius = bone_radius.fold(0.0, f64::max);
        [if stray > UNSEEN * self.rest.size { stray } else { 0.0 }, bone_radius]
    }

    /// The rest transform of a bone, relative to a bone above it in the hierarchy.
    fn offset(&self, above: usize, bone: usize) -> DAffine3 {
        let parent = |bone: &usize| self.remap.parents[*bone].filter(|parent| *parent != above);
        let mut chain: Vec<usize> = std::iter::successors(Some(bone), parent).collect();
        chain.reverse();
        self.rest.offset(&chain)
    }
}

fn difference(a: DAffine3, b: DAffine3) -> (DMat3, DVec3) {
    (a.matrix3 - b.matrix3, a.translation - b.translation)
}

/// For each bone, whether it never collapses. These are roots, the uppermost bones that a clip moves, end effectors,
/// and bones kept by name.
pub(super) fn stays(model: &Model, options: &CollapseOptions) -> Result<Vec<bool>, InputError> {
    let bones = model.skeleton.bones();
    let mut stays: Vec<bool> = bones.iter().map(|bone| bone.parent.is_none()).collect();
    let moves = |bone: usize| {
        let tracks = |clip: &Clip| TransformPart::ALL.iter().any(|part| !is_constant(clip, bone, *part));
        model.clips.iter().any(tracks)
    };
    let mut is_moved = vec![false; bones.len()];
    for (index, bone) in bones.iter().enumerate() {
        let above = bone.parent.is_some_and(|parent| is_moved[parent as usize]);
        is_moved[index] = above || moves(index);
        stays[index] |= is_moved[index] && !above;
        stays[index] |= options.keep_end_effectors && model.skeleton.descendants()[index] == 0;
    }
    for (at, name) in options.keep.iter().enumerate() {
        let named = bones.iter().zip(&mut stays).filter(|(bone, _)| bone.name == *name);
        if named.map(|(_, stays)| *stays = true).count() == 0 {
            return Err(InputError::new(format!("keep[{at}]"), name, "must be the name of a bone"));
        }
    }
    Ok(stays)
}
