//! The built-in creature: a biped with a tail, ears, feelers and a crest. It has 153 bones, like A's test model (A section 13),
//! and the clips `walk`, `idle` and `wave`. The code in this folder generates it, so that tests and demonstrations need no file.
//! The result is the same bits on every machine.
//!
//! The creature is 1.8 m tall, stands at the origin, faces +Z, and has its left side at +X. Its tracks have 3 to 33 keys,
//! depending on the motion. Every track has its own key times and step, linear or spline interpolation. Many bones have fewer
//! than three tracks, and some have none.

use bones::{Part, parts};
use motion::CLIPS;
use relievo::InputError;
use relievo::asset::clip::Clip;
use relievo::asset::model::Model;
use relievo::asset::skeleton::{Bone, Skeleton, Skin};

mod body;
mod bones;
mod motion;
mod tube;

/// Generates the creature: three clips, a skin with all bones, and a mesh of about 5,000 vertices that follows the skin.
///
/// # Errors
/// Never fails in practice: the model is checked like any other model.
pub fn creature() -> Result<Model, InputError> {
    let parts = parts();
    let bone = |part: &Part| Bone { name: part.kind.name(), parent: part.parent, rest: part.rest };
    let skeleton = Skeleton::of_joints(parts.iter().map(bone).collect())?;
    let models = rest_models(&skeleton);
    let positions: Vec<_> = models.iter().map(|model| model.w_axis.truncate()).collect();
    let mesh = body::body(&parts, &positions)?;
    let skin = Skin {
        name: "creature".to_owned(),
        bones: (0..skeleton.len() as u32).collect(),
        inverse_binds: models.iter().map(|model| model.inverse().to_cols_array().map(|x| x as f32)).collect(),
    };
    let clips = CLIPS.map(|(name, duration, motion)| {
        let keys: Vec<_> = parts.iter().map(|part| motion(part.kind).keys(duration, part)).collect();
        Clip::new(name, &skeleton, &keys, 0.0)
    });
    Ok(Model {
        skeleton,
        skins: vec![skin],
        clips: clips.into_iter().collect::<Result<_, _>>()?,
        motion: None,
        meshes: vec![mesh],
        skinned: 1,
        materials: vec![],
        images: vec![],
    })
}

/// Matrix from each bone's space to the model's space, at rest.
fn rest_models(skeleton: &Skeleton) -> Vec<glam::DMat4> {
    let mut models: Vec<glam::DMat4> = Vec::with_capacity(skeleton.len());
    for bone in skeleton.bones() {
        let rest = &bone.rest;
        let local = glam::DMat4::from_scale_rotation_translation(
            glam::DVec3::from(rest.scale.map(f64::from)),
            glam::DQuat::from_array(rest.rotation.map(f64::from)).normalize(),
            glam::DVec3::from(rest.translation.map(f64::from)),
        );
        models.push(bone.parent.map_or(local, |parent| models[parent as usize] * local));
    }
    models
}

#[cfg(test)]
mod tests {
    use super::*;
    use relievo::asset::clip::TransformPart as TrackPart;
    use relievo::asset::keyframe::RotationPath;
    use relievo::asset::transform::Affine;
    use relievo::ops::animation::local_to_model::reference::local_to_model;
    use relievo::ops::animation::sample::reference::sample;

    fn model() -> Model {
        creature().expect("valid")
    }

    fn pose(model: &Model, clip: &str, time: f32) -> Vec<Affine> {
        let clip = model.clip(clip).expect("there");
        local_to_model(&model.skeleton, &sample(clip, time, RotationPath::Slerp))
    }

    fn position(model: &Model, pose: &[Affine], name: &str) -> [f32; 3] {
        let bone = model.skeleton.bones().iter().position(|bone| bone.name == name);
        pose[bone.unwrap_or_else(|| panic!("no bone {name}"))].map(|row| row[3])
    }

    #[test]
    fn it_has_the_bones_of_as_test() {
        let model = model();
        assert_eq!(model.skeleton.len(), 153);
        let names: std::collections::BTreeSet<_> =
            model.skeleton.bones().iter().map(|bone| &bone.name).collect();
        assert_eq!(names.len(), 153, "names differ");
        assert_eq!(model.clips.iter().map(Clip::name).collect::<Vec<_>>(), ["walk", "idle", "wave"]);
        assert!(model.skins[0].validate(&model.skeleton).is_ok());
        // At rest, model matrix times inverse bind matrix is the identity for every bone.
        let rest = local_to_model(&model.skeleton, &model.skeleton.rest());
        for (model, bind) in rest.iter().zip(&model.skins[0].inverse_binds) {
            let [x, y, z] = [bind[12], bind[13], bind[14]];
            let moved = model.map(|row| row[0] * x + row[1] * y + row[2] * z + row[3]);
            assert!(moved.iter().all(|value| value.abs() < 1e-5), "{moved:?}");
        }
    }

    #[test]
    fn it_stands_as_tall_as_a_person() {
        let model = model();
        let rest = local_to_model(&model.skeleton, &model.skeleton.rest());
        let heights = rest.iter().map(|bone| bone[1][3]);
        let [low, high] = [heights.clone().fold(f32::MAX, f32::min), heights.fold(f32::MIN, f32::max)];
        assert!((-0.02..0.1).contains(&low) && (1.6..2.1).contains(&high), "{low} to {high}");
        let [left, right] = ["hand_left", "hand_right"].map(|name| position(&model, &rest, name));
        assert!((left[0] + right[0]).abs() < 1e-5 && left[0] > 0.2 && left[1] < 1.2, "{left:?} {right:?}");
    }

    #[test]
    fn clips_end_as_they_begin() {
        let model = model();
        for clip in &model.clips {
            let (start, end) = (pose(&model, clip.name(), 0.0), pose(&model, clip.name(), clip.duration()));
            for (a, b) in start.iter().flatten().flatten().zip(end.iter().flatten().flatten()) {
                assert!((a - b).abs() < 1e-5, "{}", clip.name());
            }
        }
    }

    #[test]
    fn it_walks() {
        let model = model();
        let feet = |time| {
            let pose = pose(&model, "walk", time);
            ["foot_left", "foot_right"].map(|name| position(&model, &pose, name))
        };
        let mut strides = [f32::MIN; 2];
        for step in 0..60 {
            let [left, right] = feet(step as f32 / 60.0);
            let later = feet((step as f32 / 60.0 + 0.5) % 1.0);
            // Half a cycle later, the right foot is where the left foot is now.
            assert!((left[2] - later[1][2]).abs() < 0.02 && (left[1] - later[1][1]).abs() < 0.02);
            strides = [strides[0].max(left[2] - right[2]), strides[1].max(right[2] - left[2])];
            assert!(left[1] > -0.02 && right[1] > -0.02, "a foot below the ground");
        }
        assert!(strides.iter().all(|stride| (0.4..1.2).contains(stride)), "{strides:?}");
    }

    #[test]
    fn it_waves_with_its_right_hand() {
        let model = model();
        let hand = |name, time| position(&model, &pose(&model, "wave", time), name);
        assert!(hand("hand_right", 1.0)[1] > 1.5 && hand("hand_left", 1.0)[1] < 1.2);
        let sway = (0..40).map(|step| hand("hand_right", step as f32 / 20.0)[0]);
        let (low, high) = sway.fold((f32::MAX, f32::MIN), |(low, high), x| (low.min(x), high.max(x)));
        assert!(high - low > 0.1, "{low} to {high}");
    }

    #[test]
    fn its_tracks_are_of_every_kind() {
        let model = model();
        for clip in &model.clips {
            let keys = |part| {
                (0..clip.bones()).map(move |bone| clip.track(bone, part).keys).filter(|keys| *keys > 0)
            };
            let counts = TrackPart::ALL.map(|part| keys(part).count());
            assert!(counts[1] > 60 && counts[1] < 153, "{}: {counts:?}", clip.name());
            assert!(counts[0] > 0 && counts[2] > 0, "{}: {counts:?}", clip.name());
            assert!(clip.tracks().iter().all(|track| track.keys <= 33));
        }
        let codes: std::collections::BTreeSet<u32> = model
            .clips
            .iter()
            .flat_map(Clip::tracks)
            .filter(|track| track.keys > 0)
            .map(|track| track.interpolation as u32)
            .collect();
        assert_eq!(codes.into_iter().collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn its_skin_is_closed_and_follows_every_bone() {
        let model = model();
        let mesh = &model.meshes[0];
        assert_eq!(mesh.validate(&model.skins), Ok(()));
        assert!((4500..=5500).contains(&mesh.vertices()), "{}", mesh.vertices());
        // The welded surface is closed: each edge belongs to one triangle in each direction.
        let welded = body::weld(&mesh.positions);
        let mut edges = std::collections::HashMap::new();
        for triangle in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|corner| welded[triangle[corner] as usize]);
            assert!(a != b && b != c && c != a, "no area");
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        assert!(edges.iter().all(|([a, b], count)| *count == 1 && edges.get(&[*b, *a]) == Some(&1)));
        // Triangles face outwards: the volume is positive and similar to a person's. Overlaps count twice.
        let volume = |triangle: &[u32]| {
            let [a, b, c] =
                [0, 1, 2].map(|corner| glam::Vec3::from(mesh.positions[triangle[corner] as usize]));
            a.dot(b.cross(c)) / 6.0
        };
        let volume: f32 = mesh.indices.chunks_exact(3).map(volume).sum();
        assert!((0.05..0.12).contains(&volume), "{volume}");
        // Number of vertices that follow each bone.
        let mut followed = vec![0_usize; model.skeleton.len()];
        mesh.influences.all().iter().for_each(|influence| followed[influence.bone as usize] += 1);
        let idle =
            (0..153).filter(|bone| followed[*bone] == 0).map(|bone| &*model.skeleton.bones()[bone].name);
        assert_eq!(idle.collect::<Vec<_>>(), ["root"]);
        assert_eq!(mesh.influences.most(), 4);
        let height = mesh.positions.iter().map(|position| position[1]);
        let [low, high] = [height.clone().fold(f32::MAX, f32::min), height.fold(f32::MIN, f32::max)];
        assert!((-0.03..0.02).contains(&low) && (1.7..2.1).contains(&high), "{low} to {high}");
    }
}
