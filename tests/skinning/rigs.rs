//! Small characters made by these tests, and the places of their bones and vertices in double precision.

use glam::{DAffine3, DMat3, DQuat, DVec3, DVec4};
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys, TransformPart};
use relievo::asset::skeleton::{Bone, Skeleton};
use relievo::asset::{Influence, Influences, Mesh, Model, Skin, Transform};

/// How a rig differs from the others.
#[derive(Debug, Clone, Copy)]
pub struct Rig {
    /// The scale of the root; everything below is as much larger in its own units.
    pub unit: f32,
    /// Whether the right arm is the left one, mirrored.
    pub is_mirrored: bool,
    pub has_clips: bool,
}

/// The bones below the root: name, parent, and position in metres.
const BONES: &[(&str, usize, [f32; 3])] = &[
    ("hips", 0, [0.0, 0.0, 1.0]),
    ("spine", 1, [0.0, 0.02, 0.2]),
    ("chest", 2, [0.0, -0.01, 0.25]),
    ("neck", 3, [0.0, 0.0, 0.2]),
    ("head", 4, [0.0, 0.01, 0.1]),
    ("left upper", 3, [0.2, 0.0, 0.15]),
    ("left lower", 6, [0.3, 0.02, 0.0]),
    ("left palm", 7, [0.25, 0.0, 0.0]),
    ("left finger", 8, [0.08, 0.0, -0.01]),
    ("right shoulder", 3, [-0.2, 0.0, 0.15]),
    ("right upper", 10, [0.0, 0.0, 0.0]),
    ("right lower", 11, [-0.3, 0.02, 0.0]),
    ("right palm", 12, [-0.25, 0.0, 0.0]),
    ("right finger", 13, [-0.08, 0.0, -0.01]),
    ("thigh", 1, [0.1, 0.0, -0.05]),
    ("shin", 15, [0.0, 0.03, -0.45]),
    ("foot", 16, [0.0, -0.03, -0.42]),
];

/// Numbers in −1 to 1, the same every time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    /// A rotation about the three axes one after another, by at most `most` radians.
    fn turn(&mut self, most: f32) -> [f32; 4] {
        let [x, y, z] = [(); 3].map(|()| most * self.next());
        glam::Quat::from_euler(glam::EulerRot::XYZ, x, y, z).to_array()
    }
}

impl Rig {
    pub const PLAIN: Self = Self { unit: 1.0, is_mirrored: false, has_clips: true };

    pub fn model(self) -> Model {
        let skeleton = self.skeleton();
        let (skins, meshes) = self.meshes(&skeleton);
        let clips = if self.has_clips { vec![self.swing(&skeleton), self.wave(&skeleton)] } else { vec![] };
        Model { skeleton, skins, clips, motion: None, skinned: 3, meshes, materials: vec![], images: vec![] }
    }

    fn skeleton(self) -> Skeleton {
        let turn = glam::Quat::from_rotation_x(-std::f32::consts::FRAC_PI_2).to_array();
        let root = Transform { rotation: turn, scale: [self.unit; 3], ..Transform::IDENTITY };
        let mut bones = vec![Bone { name: "scene".into(), parent: None, rest: root }];
        let mut random = Random(7);
        for (name, parent, place) in BONES {
            let is_mirror = self.is_mirrored && *name == "right shoulder";
            let is_below = self.is_mirrored && name.starts_with("right") && !is_mirror;
            let side = if is_below { -1.0 } else { 1.0 };
            let [x, y, z] = place.map(|value| value / self.unit);
            let rest = Transform {
                translation: [side * x, y, z],
                rotation: random.turn(0.2),
                scale: if is_mirror { [-1.0, 1.0, 1.0] } else { [1.0; 3] },
            };
            bones.push(Bone { name: (*name).into(), parent: Some(*parent as u32), rest });
        }
        Skeleton::new(bones, (1..=BONES.len() as u32).collect()).expect("valid")
    }

    /// Every joint turns, at times of its own; the hips move, the neck jumps, the chest is a spline.
    fn swing(self, skeleton: &Skeleton) -> Clip {
        let mut random = Random(11);
        let mut bones = vec![BoneKeys::default(); skeleton.len()];
        for (bone, keys) in bones.iter_mut().enumerate().skip(1) {
            let rest = skeleton.bones()[bone].rest;
            let step = [1, 2, 4][bone % 3];
            let times: Vec<f32> = (0..=8).step_by(step).map(|at| at as f32 / 8.0).collect();
            let value = |random: &mut Random| {
                let turn = glam::Quat::from_array(random.turn(0.5));
                (glam::Quat::from_array(rest.rotation) * turn).to_array()
            };
            let interpolation = match bone {
                3 => Interpolation::CubicSpline,
                4 => Interpolation::Step,
                _ => Interpolation::Linear,
            };
            let values = times.iter().flat_map(|_| {
                let value = value(&mut random);
                let tangent = [0.3, 0.1, -0.2, 0.0];
                if bone == 3 { vec![tangent, value, tangent] } else { vec![value] }
            });
            keys.rotation = Some(Keys { values: values.collect(), times: times.clone(), interpolation });
            if bone == 1 {
                let place = |at: &f32| {
                    let [x, y, z] = rest.translation;
                    [x + 0.2 * at / self.unit, y, z + 0.1 * at * at / self.unit, 0.0]
                };
                let values = times.iter().map(place).collect();
                keys.translation = Some(Keys { values, times, interpolation: Interpolation::Linear });
            }
        }
        Clip::new("swing", skeleton, &bones, 0.0).expect("valid")
    }

    /// A clip that moves only palms and fingers; the fingers have spline keys.
    fn wave(self, skeleton: &Skeleton) -> Clip {
        let mut random = Random(13);
        let mut bones = vec![BoneKeys::default(); skeleton.len()];
        for bone in [8, 9, 13, 14] {
            let rest = skeleton.bones()[bone].rest;
            let times = vec![0.0, 0.2, 0.7];
            let mut values = Vec::new();
            for _ in &times {
                let value = (glam::Quat::from_array(rest.rotation)
                    * glam::Quat::from_array(random.turn(0.4)))
                .to_array();
                values.extend([[0.1, 0.0, 0.2, 0.0], value, [0.1, 0.0, 0.2, 0.0]]);
            }
            bones[bone].rotation = Some(Keys { times, values, interpolation: Interpolation::CubicSpline });
        }
        Clip::new("wave", skeleton, &bones, 0.0).expect("valid")
    }

    /// Two meshes of a skin of all joints, bound in tenths of a metre; one of a skin of the arms, the last joints first; one
    /// that follows the head as a whole.
    fn meshes(self, skeleton: &Skeleton) -> (Vec<Skin>, Vec<Mesh>) {
        let rests: Vec<DAffine3> = at_rest(skeleton);
        let skin = |bones: Vec<u32>, unit: f64| Skin {
            name: String::new(),
            inverse_binds: (bones.iter())
                .map(|bone| {
                    let bind = rests[*bone as usize].inverse() * DAffine3::from_scale(DVec3::splat(unit));
                    glam::DMat4::from(bind).to_cols_array().map(|value| value as f32)
                })
                .collect(),
            bones,
        };
        let all: Vec<u32> = (1..skeleton.len() as u32).collect();
        let arms: Vec<u32> = (6..=14).rev().collect();
        let head = Skin {
            name: String::new(),
            bones: vec![5],
            inverse_binds: vec![
                glam::Mat4::from_translation(glam::vec3(0.0, 0.0, 0.1 / self.unit)).to_cols_array(),
            ],
        };
        let skins = vec![skin(all.clone(), 0.1), skin(arms.clone(), 1.0), head];
        let body = |seed: u64, bones: &[u32], skin: usize, unit: f64| {
            let mut random = Random(seed);
            let (mut positions, mut influences) = (Vec::new(), Vec::new());
            for (joint, bone) in bones.iter().enumerate() {
                let parent = skeleton.bones()[*bone as usize].parent;
                let above = bones.iter().position(|other| Some(*other) == parent);
                for corner in 0..6 {
                    let off = DVec3::new(random.next().into(), random.next().into(), random.next().into());
                    let place = rests[*bone as usize].translation + 0.05 * off;
                    positions.push((place / unit).as_vec3().to_array());
                    let mut vertex = vec![Influence { bone: joint as u32, weight: 1.0 }];
                    if let Some(above) = above.filter(|_| corner % 2 == 0) {
                        vertex.push(Influence { bone: above as u32, weight: 0.5 });
                    }
                    influences.push(vertex);
                }
            }
            mesh(skin, positions, Influences::new("w", bones.len(), influences).expect("valid"))
        };
        let hat = (0..6).map(|at| {
            let [x, y] = [(at % 2) as f32, (at / 2) as f32].map(|x| 0.1 * x / self.unit);
            [x, y, 0.1 / self.unit]
        });
        let one = |bone| vec![Influence { bone, weight: 1.0 }];
        let hat = mesh(2, hat.collect(), Influences::new("w", 1, (0..6).map(|_| one(0))).expect("valid"));
        let meshes = vec![body(3, &all, 0, 0.1), body(4, &all, 0, 0.1), body(5, &arms, 1, 1.0), hat];
        (skins, meshes)
    }
}

fn mesh(skin: usize, positions: Vec<[f32; 3]>, influences: Influences) -> Mesh {
    Mesh {
        name: String::new(),
        skin,
        normals: vec![[0.0, 0.0, 1.0]; positions.len()],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; positions.len()],
        uv: vec![[0.0; 2]; positions.len()],
        indices: (0..positions.len() as u32).collect(),
        positions,
        double_sided: false,
        material: None,
        influences,
        targets: vec![],
        weights: vec![],
        weight_keys: vec![],
        ..Mesh::default()
    }
}

fn affine(translation: DVec3, rotation: DQuat, scale: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_quat(rotation.normalize()) * DMat3::from_diagonal(scale), translation }
}

fn chained(skeleton: &Skeleton, local: impl Fn(usize) -> DAffine3) -> Vec<DAffine3> {
    let mut models: Vec<DAffine3> = Vec::new();
    for (bone, node) in skeleton.bones().iter().enumerate() {
        let local = local(bone);
        models.push(node.parent.map_or(local, |parent| models[parent as usize] * local));
    }
    models
}

/// The transform of every bone in the model's space at rest.
pub fn at_rest(skeleton: &Skeleton) -> Vec<DAffine3> {
    chained(skeleton, |bone| {
        let Transform { translation, rotation, scale } = skeleton.bones()[bone].rest;
        let [translation, scale] = [translation, scale].map(|v| DVec3::from(v.map(f64::from)));
        affine(translation, DQuat::from_array(rotation.map(f64::from)), scale)
    })
}

/// The transform of every bone in the model's space at a time of a clip.
pub fn posed(skeleton: &Skeleton, clip: &Clip, time: f64) -> Vec<DAffine3> {
    chained(skeleton, |bone| local(clip, bone, time))
}

/// The transform of a bone in its parent's space at a time of a clip.
pub fn local(clip: &Clip, bone: usize, time: f64) -> DAffine3 {
    let [translation, rotation, scale] = TransformPart::ALL.map(|part| value(clip, bone, part, time));
    affine(translation.truncate(), DQuat::from_vec4(rotation), scale.truncate())
}

fn value(clip: &Clip, bone: usize, part: TransformPart, time: f64) -> DVec4 {
    let track = clip.track(bone, part);
    let times: Vec<f64> = clip.times_of(track).iter().map(|time| f64::from(*time)).collect();
    let stored = |at: usize| DVec4::from_array(clip.values()[track.first_value as usize + at].map(f64::from));
    let is_spline = track.interpolation == Interpolation::CubicSpline && track.keys > 0;
    let key = |key: usize| if is_spline { stored(3 * key + 1) } else { stored(key) };
    let after = times.iter().filter(|other| **other <= time).count();
    if after == 0 || after == times.len() || track.interpolation == Interpolation::Step {
        return key(after.saturating_sub(1));
    }
    let t = (time - times[after - 1]) / (times[after] - times[after - 1]);
    let (from, to) = (key(after - 1), key(after));
    if is_spline {
        let (leaving, arriving) = (stored(3 * after - 1), stored(3 * after));
        return from * (2.0 * t.powi(3) - 3.0 * t.powi(2) + 1.0)
            + leaving * (t.powi(3) - 2.0 * t.powi(2) + t)
            + to * (3.0 * t.powi(2) - 2.0 * t.powi(3))
            + arriving * (t.powi(3) - t.powi(2));
    }
    if part != TransformPart::Rotation {
        return from.lerp(to, t);
    }
    let angle = from.normalize().dot(to.normalize()).abs().min(1.0).acos();
    if angle < 1e-9 {
        return from;
    }
    let to = if from.dot(to) < 0.0 { -to } else { to };
    (from * ((1.0 - t) * angle).sin() + to * (t * angle).sin()) / angle.sin()
}

/// The vertices of all meshes, with these transforms of the bones.
pub fn skinned(model: &Model, bones: &[DAffine3]) -> Vec<DVec3> {
    let mut places = Vec::new();
    for mesh in &model.meshes {
        let skin = &model.skins[mesh.skin];
        let palette: Vec<DAffine3> = (skin.bones.iter().zip(&skin.inverse_binds))
            .map(|(bone, bind)| {
                let bind = glam::DMat4::from_cols_array(&bind.map(f64::from));
                bones[*bone as usize] * DAffine3::from_mat4(bind)
            })
            .collect();
        for (vertex, position) in mesh.positions.iter().enumerate() {
            let position = DVec3::from(position.map(f64::from));
            let place = |one: &Influence| {
                f64::from(one.weight) * palette[one.bone as usize].transform_point3(position)
            };
            places.push(mesh.influences.of(vertex).iter().map(place).sum());
        }
    }
    places
}
