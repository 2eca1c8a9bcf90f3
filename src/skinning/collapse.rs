//! Bone collapse: fewer bones with distance ("geometric imposters", A sections 8.8 and 9.6). Bones are merged
//! one by one into their parents, those whose motion is least visible first, and the vertices that followed
//! them become rigid.
//!
//! A bone collapses only after all bones below it. The remaining bones are therefore the upper part of the
//! skeleton, keep all of their keys, and move exactly as before, so that pose computation may leave the others
//! out. A collapsed bone keeps its rest pose relative to its nearest remaining ancestor.
//! is at rest below the last bone that is left above it.

use glam::{DMat4, DVec3};

use crate::InputError;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::sample::reference::sample;
use crate::asset::keyframe::RotationPath;
use crate::asset::transform::Affine;
use crate::asset::{Model, Skeleton, Skin, Transform};

/// A level of a model, with fewer bones.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// For each bone of the skeleton, the bone whose motion it follows; a remaining bone follows itself.
    pub follows: Vec<u32>,
    /// Number of remaining bones.
    pub bones: usize,
    /// Replacements of the model's skins: they have the same joints, which follow the remaining bones.
    pub skins: Vec<Skin>,
    /// The largest displacement of any vertex in the sampled poses, in the model's units.
    pub error: f32,
}

/// Levels of a model, each with at most the number of bones that `counts` gives, or more if `kept` bones need
/// them. `kept` bones, for example end effectors, and their ancestors never collapse. Each clip is sampled at
/// `poses` evenly spaced poses.
/// spaced.
///
/// # Errors
/// [`InputError`] for a model without clips or meshes, for 0 poses, for counts that grow, and for kept bones
/// that the model does not have.
pub fn levels(model: &Model, counts: &[usize], kept: &[u32], poses: usize) -> Result<Vec<Level>, InputError> {
    validate(model, counts, kept, poses)?;
    let mut state = State::new(model, kept, poses);
    let mut levels = Vec::with_capacity(counts.len());
    for count in counts {
        while state.left > *count && state.collapse() {}
        levels.push(state.level());
    }
    Ok(levels)
}

fn validate(model: &Model, counts: &[usize], kept: &[u32], poses: usize) -> Result<(), InputError> {
    for (field, len) in [("clips", model.clips.len()), ("meshes", model.meshes.len()), ("poses", poses)] {
        if len == 0 {
            return Err(InputError::new(field, 0, "must be at least 1, to see what collapsing does"));
        }
    }
    model.skins.iter().try_for_each(|skin| skin.validate(&model.skeleton))?;
    model.meshes.iter().try_for_each(|mesh| mesh.validate(&model.skins))?;
    if let Some(at) = counts.windows(2).position(|pair| pair[0] < pair[1]) {
        let bound = format!("must not exceed the count before it, {}", counts[at]);
        return Err(InputError::new(format!("counts[{}]", at + 1), counts[at + 1], bound));
    }
    match kept.iter().position(|bone| *bone as usize >= model.skeleton.len()) {
        None => Ok(()),
        Some(at) => Err(InputError::new(
            format!("kept[{at}]"),
            kept[at],
            format!("must be below {}", model.skeleton.len()),
        )),
    }
}

/// A vertex that follows a bone.
struct Follower {
    /// Index among all vertices of all meshes.
    vertex: usize,
    /// Position in the bone's space, at the time of binding.
    local: DVec3,
    weight: f64,
}

struct State<'a> {
    model: &'a Model,
    /// The model matrix of each bone in each pose.
    models: Vec<Vec<DMat4>>,
    followers: Vec<Vec<Follower>>,
    vertices: usize,
    follows: Vec<u32>,
    left: usize,
    /// For each bone, the number of remaining children; one more for a bone that never collapses.
    holds: Vec<u32>,
    /// The cost of collapsing each bone, if known.
    costs: Vec<Option<f64>>,
}

fn wide(affine: &Affine) -> DMat4 {
    let [x, y, z] = affine.map(|row| glam::DVec4::from_array(row.map(f64::from)));
    DMat4::from_cols(x, y, z, glam::DVec4::W).transpose()
}

fn matrix(transform: &Transform) -> DMat4 {
    let [scale, translation] =
        [transform.scale, transform.translation].map(|v| DVec3::from(v.map(f64::from)));
    let rotation = glam::DQuat::from_array(transform.rotation.map(f64::from)).normalize();
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}

impl<'a> State<'a> {
    fn new(model: &'a Model, kept: &[u32], poses: usize) -> Self {
        let skeleton = &model.skeleton;
        let pose = |clip: &crate::asset::Clip, at: usize| {
            let time = clip.duration() * at as f32 / poses as f32;
            local_to_model(skeleton, &sample(clip, time, RotationPath::Slerp)).iter().map(wide).collect()
        };
        let models = model.clips.iter().flat_map(|clip| (0..poses).map(move |at| pose(clip, at))).collect();
        let mut holds = vec![0; skeleton.len()];
        kept.iter().for_each(|bone| holds[*bone as usize] += 1);
        for bone in skeleton.bones() {
            match bone.parent {
                Some(parent) => holds[parent as usize] += 1,
                // A root has no parent into which it could collapse.
                None => continue,
            }
        }
        let (followers, vertices) = followers(model);
        Self {
            model,
            models,
            followers,
            vertices,
            follows: (0..skeleton.len() as u32).collect(),
            left: skeleton.len(),
            holds,
            costs: vec![None; skeleton.len()],
        }
    }

    fn skeleton(&self) -> &'a Skeleton {
        &self.model.skeleton
    }

    /// Collapses the bone with the least cost, if there is one. Of equal costs the last bone is taken, which
    /// lies deepest in its chain.
    fn collapse(&mut self) -> bool {
        let candidates: Vec<usize> = (0..self.follows.len())
            .filter(|bone| self.follows[*bone] as usize == *bone && self.holds[*bone] == 0)
            .filter(|bone| self.skeleton().bones()[*bone].parent.is_some())
            .collect();
        for bone in &candidates {
            if self.costs[*bone].is_none() {
                self.costs[*bone] = Some(self.cost(*bone));
            }
        }
        let cost = |bone: &usize| self.costs[*bone].unwrap_or(f64::INFINITY);
        let Some(best) = candidates.into_iter().rev().min_by(|a, b| cost(a).total_cmp(&cost(b))) else {
            return false;
        };
        let Some(parent) = self.skeleton().bones()[best].parent else { return false };
        for bone in &mut self.follows {
            if *bone as usize == best {
                *bone = parent;
            }
        }
        self.holds[parent as usize] -= 1;
        self.costs[parent as usize] = None;
        self.left -= 1;
        true
    }

    /// The largest displacement of a vertex if a bone, and the bones that have collapsed into it, follow the
    /// bone's parent.
    fn cost(&self, bone: usize) -> f64 {
        let Some(parent) = self.skeleton().bones()[bone].parent else { return f64::INFINITY };
        let group: Vec<usize> =
            (0..self.follows.len()).filter(|other| self.follows[*other] as usize == bone).collect();
        let rests: Vec<DMat4> = group.iter().map(|other| self.rest(parent as usize, *other)).collect();
        let strays = self.models.iter().map(|models| {
            let mut moved = std::collections::HashMap::<usize, DVec3>::new();
            for (other, rest) in group.iter().zip(&rests) {
                let change = models[parent as usize] * *rest - models[*other];
                for follower in &self.followers[*other] {
                    let stray = follower.weight * (change * follower.local.extend(1.0)).truncate();
                    *moved.entry(follower.vertex).or_default() += stray;
                }
            }
            moved.values().map(|stray| stray.length_squared()).fold(0.0, f64::max)
        });
        strays.fold(0.0, f64::max).sqrt()
    }

    /// The rest matrix of a bone in the space of one of its ancestors.
    fn rest(&self, above: usize, bone: usize) -> DMat4 {
        let bones = self.skeleton().bones();
        let parent = |bone: usize| bones[bone].parent.map(|parent| parent as usize);
        let chain = std::iter::successors(Some(bone), |bone| parent(*bone)).take_while(|bone| *bone != above);
        chain.fold(DMat4::IDENTITY, |below, bone| matrix(&bones[bone].rest) * below)
    }

    fn level(&self) -> Level {
        let skins = self.model.skins.iter().map(|skin| self.skin(skin)).collect();
        Level { follows: self.follows.clone(), bones: self.left, skins, error: self.error() as f32 }
    }

    fn skin(&self, skin: &Skin) -> Skin {
        let joints = skin.bones.iter().zip(&skin.inverse_binds).map(|(bone, bind)| {
            let above = self.follows[*bone as usize];
            if above == *bone {
                return (*bone, *bind);
            }
            let bind =
                self.rest(above as usize, *bone as usize) * DMat4::from_cols_array(&bind.map(f64::from));
            (above, bind.to_cols_array().map(|value| value as f32))
        });
        let (bones, inverse_binds) = joints.unzip();
        Skin { name: skin.name.clone(), bones, inverse_binds }
    }

    /// The largest displacement of a vertex, with all collapses together.
    fn error(&self) -> f64 {
        let collapsed: Vec<(usize, DMat4)> = (0..self.follows.len())
            .filter(|bone| self.follows[*bone] as usize != *bone)
            .map(|bone| (bone, self.rest(self.follows[bone] as usize, bone)))
            .collect();
        let strays = self.models.iter().map(|models| {
            let mut moved = vec![DVec3::ZERO; self.vertices];
            for (bone, rest) in &collapsed {
                let change = models[self.follows[*bone] as usize] * *rest - models[*bone];
                for follower in &self.followers[*bone] {
                    moved[follower.vertex] +=
                        follower.weight * (change * follower.local.extend(1.0)).truncate();
                }
            }
            moved.iter().map(|stray| stray.length_squared()).fold(0.0, f64::max)
        });
        strays.fold(0.0, f64::max).sqrt()
    }
}

/// The followers of each bone, and the number of vertices.
fn followers(model: &Model) -> (Vec<Vec<Follower>>, usize) {
    let mut followers: Vec<Vec<Follower>> = model.skeleton.bones().iter().map(|_| Vec::new()).collect();
    let mut first = 0;
    for mesh in &model.meshes {
        let skin = &model.skins[mesh.skin];
        let binds: Vec<_> =
            skin.inverse_binds.iter().map(|bind| DMat4::from_cols_array(&bind.map(f64::from))).collect();
        for (vertex, position) in mesh.positions.iter().enumerate() {
            for influence in mesh.influences.of(vertex) {
                let local =
                    binds[influence.bone as usize].transform_point3(DVec3::from(position.map(f64::from)));
                followers[skin.bones[influence.bone as usize] as usize].push(Follower {
                    vertex: first + vertex,
                    local,
                    weight: influence.weight.into(),
                });
            }
        }
        first += mesh.vertices();
    }
    (followers, first)
}

#[cfg(all(test, feature = "samples"))]
mod tests {
    use super::*;
    use crate::skinning::instance_lod::InstanceLod;
    use crate::skinning::morph::reference::morph;
    use crate::skinning::palette::Palette;
    use crate::skinning::palette::reference::palette;
    use crate::skinning::skin::reference::skin;

    fn model() -> Model {
        crate::samples::creature().expect("valid")
    }

    /// The vertices as the references compute them.
    fn skinned(model: &Model, skin_of: &Skin, clip: usize, time: f32) -> Vec<glam::Vec3> {
        let models = local_to_model(&model.skeleton, &sample(&model.clips[clip], time, RotationPath::Slerp));
        let mesh = &model.meshes[0];
        let palette = Palette::Linear(palette(skin_of, &models));
        let all = skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL);
        all.iter().map(|vertex| vertex.position.into()).collect()
    }

    #[test]
    fn errors_are_those_of_the_vertices_and_grow() {
        let model = model();
        let levels = levels(&model, &[153, 100, 60, 30], &[], 8).expect("valid");
        assert_eq!(levels.iter().map(|level| level.bones).collect::<Vec<_>>(), [153, 100, 60, 30]);
        assert_eq!((levels[0].error, &levels[0].skins), (0.0, &model.skins));
        for level in &levels {
            let strays = (0..3).flat_map(|clip| (0..8).map(move |at| (clip, at))).map(|(clip, at)| {
                let time = model.clips[clip].duration() * at as f32 / 8.0;
                let [full, fewer] =
                    [&model.skins[0], &level.skins[0]].map(|skin| skinned(&model, skin, clip, time));
                full.iter().zip(&fewer).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max)
            });
            let stray = strays.fold(0.0, f32::max);
            assert!((stray - level.error).abs() < 1e-5, "{stray} instead of {}", level.error);
        }
        assert!(levels.windows(2).all(|pair| pair[0].error < pair[1].error), "{levels:?}");
        // The least visible bones go first: a third of the bones for a displacement of about a finger's width.
        assert!(levels[1].error < 0.02, "{}", levels[1].error);
    }

    #[test]
    fn what_is_left_hangs_together() {
        let model = model();
        for level in levels(&model, &[120, 40, 1], &[], 4).expect("valid") {
            let left = (0..).zip(&level.follows).filter(|(bone, follows)| bone == *follows).count();
            assert_eq!(left, level.bones);
            for (bone, follows) in (0..).zip(&level.follows) {
                let parent = model.skeleton.bones()[bone as usize].parent;
                match parent {
                    // The parent of a remaining bone remains; a collapsed bone follows what its parent follows.
                    Some(parent) if bone == *follows => assert_eq!(level.follows[parent as usize], parent),
                    Some(parent) => assert_eq!(*follows, level.follows[parent as usize]),
                    None => assert_eq!(bone, *follows),
                }
            }
        }
    }

    #[test]
    fn end_effectors_stay() {
        let model = model();
        let hand =
            (0..).zip(model.skeleton.bones()).find(|(_, bone)| bone.name == "hand_right").expect("there").0;
        let levels = levels(&model, &[1], &[hand], 4).expect("valid");
        let mut above = Some(hand);
        let mut chain = 0;
        while let Some(bone) = above {
            assert_eq!(levels[0].follows[bone as usize], bone);
            chain += 1;
            above = model.skeleton.bones()[bone as usize].parent;
        }
        assert_eq!(levels[0].bones, chain);
    }

    #[test]
    fn requests_are_checked() {
        let model = model();
        let field = |counts: &[usize], kept: &[u32], poses| {
            levels(&model, counts, kept, poses).expect_err("refused").path
        };
        assert_eq!(field(&[5, 6], &[], 1), "counts[1]");
        assert_eq!(field(&[5], &[153], 1), "kept[0]");
        assert_eq!(field(&[5], &[], 0), "poses");
        let still = Model { clips: vec![], ..model.clone() };
        assert_eq!(levels(&still, &[5], &[], 1).expect_err("refused").path, "clips");
    }
}
