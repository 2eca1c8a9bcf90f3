//! Levels of detail of a model that is larger or smaller, or was bound in other units.

use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys, TransformPart};
use relievo::asset::keyframe::RotationPath;
use relievo::asset::skeleton::{Bone, Skeleton};
use relievo::asset::{MeshLevel, bone_radii};
use relievo::asset::{Model, Transform};
use relievo::ops::animation::Wrap;
use relievo::ops::animation::priority::{Priorities, Weights};
use relievo::ops::animation::{BoundTable, ClipSet, ExpectationTable, Order, PriorityTable};
use relievo::ops::skinning::add_levels;

use crate::shapes::model;

const POSES: usize = 13;

/// The quantities that are scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
enum In {
    /// All positions: those of vertices, of bones, and of bones when they were bound.
    Positions,
    /// Bones and inverse bind matrices; vertices keep their positions.
    InverseBinds,
    /// A node above all others.
    Nodes,
    /// Vertices, and inversely the inverse bind matrices: the model is bound in other units and its size does
    /// not change.
    Units,
}

const ALL: [In; 4] = [In::Positions, In::InverseBinds, In::Nodes, In::Units];

/// The built-in creature with a thousand triangles.
fn plain() -> Model {
    let mut model = model();
    add_levels(&mut model, &[0], 2).expect("valid");
    let levels = std::mem::take(&mut model.meshes[0].levels);
    let some = levels.into_iter().find(|level| level.indices.len() < 3 * 1400).expect("there");
    model.meshes[0].indices = some.indices;
    model
}

impl In {
    fn scale(self, plain: &Model, scale: f32) -> Model {
        let mut model = plain.clone();
        let bones = if self == Self::Positions || self == Self::InverseBinds { scale } else { 1.0 };
        let above = (self == Self::Nodes).then_some(scale);
        (model.skeleton, model.clips) = rebuilt(plain, bones, above);
        for skin in &mut model.skins {
            skin.bones.iter_mut().for_each(|bone| *bone += u32::from(above.is_some()));
            for bind in &mut skin.inverse_binds {
                let (turns, moves) = bind.split_at_mut(12);
                match self {
                    Self::Positions => moves[..3].iter_mut().for_each(|x| *x *= scale),
                    Self::InverseBinds => {
                        turns.iter_mut().chain(&mut moves[..3]).for_each(|x| *x *= scale);
                    }
                    Self::Nodes => {}
                    Self::Units => turns.iter_mut().for_each(|x| *x /= scale),
                }
            }
        }
        if self == Self::Positions || self == Self::Units {
            model.meshes[0].positions.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
        }
        model
    }

    /// The factor by which the model's size changes.
    fn of_model(self, scale: f32) -> f32 {
        if self == Self::Units { 1.0 } else { scale }
    }
}

/// The skeleton and clips with scaled translations, and with a root that scales.
fn rebuilt(model: &Model, translations: f32, above: Option<f32>) -> (Skeleton, Vec<Clip>) {
    let moved = |[x, y, z]: [f32; 3]| [translations * x, translations * y, translations * z];
    let root = above.map(|scale| Bone {
        name: "above".into(),
        parent: None,
        rest: Transform { scale: [scale; 3], ..Transform::IDENTITY },
    });
    let first = u32::from(above.is_some());
    let bones = model.skeleton.bones().iter().map(|bone| Bone {
        parent: bone.parent.map(|parent| parent + first).or(root.as_ref().map(|_| 0)),
        rest: Transform { translation: moved(bone.rest.translation), ..bone.rest },
        ..bone.clone()
    });
    let bones: Vec<Bone> = root.iter().cloned().chain(bones).collect();
    let joints = (first..bones.len() as u32).collect();
    let skeleton = Skeleton::new(bones, joints).expect("valid");
    let clip = |clip: &Clip| {
        let none = root.iter().map(|_| BoneKeys::default());
        let bones = (0..clip.bones()).map(|bone| bone_keys(clip, bone, translations));
        let all: Vec<BoneKeys> = none.chain(bones).collect();
        Clip::new(clip.name(), &skeleton, &all, clip.duration()).expect("valid")
    };
    let clips = model.clips.iter().map(clip).collect();
    (skeleton, clips)
}

/// The keys of a bone, with translations scaled by `translations`.
fn bone_keys(clip: &Clip, bone: usize, translations: f32) -> BoneKeys {
    let [mut translation, rotation, scale] = TransformPart::ALL.map(|part| keys(clip, bone, part));
    let values = translation.iter_mut().flat_map(|keys| keys.values.as_flattened_mut());
    values.for_each(|x| *x *= translations);
    BoneKeys { translation, rotation, scale }
}

/// The keys as they were given: a clip stores tangents multiplied by the seconds of their segment.
fn keys(clip: &Clip, bone: usize, part: TransformPart) -> Option<Keys> {
    let track = clip.track(bone, part);
    let (times, interpolation) = (clip.times_of(track).to_vec(), track.interpolation);
    let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    let mut values = clip.values()[track.first_value as usize..][..each * times.len()].to_vec();
    if each == 3 {
        for (key, pair) in times.windows(2).enumerate() {
            for at in [3 * key + 2, 3 * key + 3] {
                values[at] = values[at].map(|x| x / (pair[1] - pair[0]));
            }
        }
    }
    (!times.is_empty()).then_some(Keys { times, values, interpolation })
}

fn levels(mut model: Model) -> Vec<MeshLevel> {
    add_levels(&mut model, &[0], POSES).expect("valid");
    assert_eq!(model.meshes[0].validate(&model.skins), Ok(()));
    model.meshes.remove(0).levels
}

/// All have the same triangles, and errors that are scaled, to the bit.
#[test]
fn models_of_any_size_have_the_same_levels() {
    let plain = plain();
    let wanted = levels(In::Units.scale(&plain, 1.0));
    assert!(wanted.len() > 6, "{} levels", wanted.len());
    for (fade_fraction, scale) in
        ALL.into_iter().flat_map(|fade_fraction| [1.0 / 128.0, 64.0].map(|scale| (fade_fraction, scale)))
    {
        let found = levels(fade_fraction.scale(&plain, scale));
        let larger = |level: &MeshLevel| MeshLevel {
            indices: level.indices.clone(),
            error: fade_fraction.of_model(scale) * level.error,
        };
        assert!(found.into_iter().eq(wanted.iter().map(larger)), "{scale} in {fade_fraction:?}");
    }
}

/// Where scales round, it is the errors that round. Rounding may also break a tie of the two sides of a creature: then
/// other triangles are left, as many as before.
#[test]
fn scales_that_round_change_little() {
    let plain = plain();
    let wanted = levels(In::Units.scale(&plain, 1.0));
    let mut others = 0;
    for (fade_fraction, scale) in
        ALL.into_iter().flat_map(|fade_fraction| [0.01, 100.0].map(|scale| (fade_fraction, scale)))
    {
        let found = levels(fade_fraction.scale(&plain, scale));
        assert_eq!(found.len(), wanted.len(), "{scale} in {fade_fraction:?}");
        let is_same = found.iter().zip(&wanted).all(|(found, wanted)| found.indices == wanted.indices);
        others += usize::from(!is_same);
        let most = if is_same { 5e-5 } else { 0.02 };
        for (found, wanted) in found.iter().zip(&wanted) {
            let count = found.indices.len() as f32 / wanted.indices.len() as f32;
            assert!((count - 1.0).abs() <= most, "{count}: {scale} in {fade_fraction:?}");
            let error = found.error / (fade_fraction.of_model(scale) * wanted.error);
            assert!((error - 1.0).abs() < most, "{error}: {scale} in {fade_fraction:?}");
        }
    }
    assert!(others <= 1, "{others}");
}

/// A rest pose that is far larger or smaller than any pose of the clips has no influence on sizes.
#[test]
fn rest_poses_of_another_size_do_not_matter() {
    let plain = plain();
    let wanted = levels(In::Nodes.scale(&plain, 1.0));
    for scale in [64.0, 1.0 / 64.0] {
        let mut model = In::Nodes.scale(&plain, scale);
        // The clips of the model as it was, which say that nothing above scales.
        let still = |[x, y, z]: [f32; 3]| {
            Some(Keys { times: vec![0.0], values: vec![[x, y, z, 0.0]], interpolation: Interpolation::Step })
        };
        let (skeleton, _) = rebuilt(&plain, 1.0, Some(1.0));
        let above = BoneKeys { scale: still([1.0; 3]), ..BoneKeys::default() };
        let clip = &plain.clips[0];
        let bones = (0..clip.bones()).map(|bone| bone_keys(clip, bone, 1.0));
        let all: Vec<BoneKeys> = std::iter::once(above).chain(bones).collect();
        model.clips = vec![Clip::new("walk", &skeleton, &all, clip.duration()).expect("valid")];
        let found = levels(model);
        assert!(found.len().abs_diff(wanted.len()) < 2, "{} levels, {scale}", found.len());
        // Of one chain a level may be worthwhile that the other leaves out.
        let mut compared = 0;
        for found in &found {
            let alike = |level: &&MeshLevel| (found.error / level.error - 1.0).abs() < 0.1;
            if let Some(wanted) = wanted.iter().find(alike) {
                let [few, many] = [found, wanted].map(|level| level.indices.len() as f64);
                assert!((few / many - 1.0).abs() < 0.1, "{few} of {many}, {scale}");
                compared += 1;
            }
        }
        assert!(4 * compared >= 3 * wanted.len(), "{compared} of {}, {scale}", wanted.len());
    }
}

/// Gates count motion in shares of the largest, and priorities in shares of what the clip has: no unit matters.
#[test]
fn tables_of_models_of_any_size_are_the_same() {
    let plain = plain();
    // All models have a node above that does nothing, so that they have the same number of bones.
    let tables = |fade_fraction: In, scale: f32| {
        let model = if fade_fraction == In::Nodes {
            fade_fraction.scale(&plain, scale)
        } else {
            In::Nodes.scale(&fade_fraction.scale(&plain, scale), 1.0)
        };
        let (skeleton, clips) = (&model.skeleton, [&model.clips[0]]);
        let (order, set) = (Order::new(skeleton), ClipSet::new(&clips).expect("valid"));
        let bone_radii = bone_radii(skeleton.len(), &model.skins, &model.meshes);
        let (weights, user) = (Weights::default(), vec![0.5; skeleton.len()]);
        let priorities = [Priorities::new(skeleton, clips[0], Wrap::Loop, &weights, &user).expect("valid")];
        let path = RotationPath::Slerp;
        (
            PriorityTable::new(&order, &set, &clips, &priorities).expect("valid"),
            BoundTable::new(skeleton, &set, &clips, &bone_radii, path).expect("valid"),
            ExpectationTable::new(skeleton, &set, &clips, &bone_radii, path).expect("valid"),
        )
    };
    let (priorities, bounds, expectations) = tables(In::Units, 1.0);
    for (fade_fraction, scale) in
        ALL.into_iter().flat_map(|fade_fraction| [1.0 / 128.0, 64.0].map(|scale| (fade_fraction, scale)))
    {
        let found = tables(fade_fraction, scale);
        assert!(found.0.rows() == priorities.rows(), "priorities: {scale} in {fade_fraction:?}");
        assert!(found.1.rows() == bounds.rows(), "bounds: {scale} in {fade_fraction:?}");
        assert!(found.2.rows() == expectations.rows(), "expectations: {scale} in {fade_fraction:?}");
        let radius = found.1.radius() / (fade_fraction.of_model(scale) * bounds.radius());
        assert!((radius - 1.0).abs() < 1e-6, "{radius}: {scale} in {fade_fraction:?}");
    }
}
