//! Level of detail of a character's bones in a scene: gates, influences, priorities, and reduced skeletons.
//!
//! Files of yours: `RELIEVO_MODELS=a.glb:b.glb cargo test --test lod tiers_of_files -- --ignored --nocapture`.

use std::collections::BTreeMap;
use std::path::Path;

use glam::Vec3;
use relievo::asset::clip::{BoneKeys, Clip, Interpolation, Keys};
use relievo::asset::skeleton::{Bone, Skeleton};
use relievo::asset::{Influences, Mesh, Model, Skin, Transform};
use relievo::ops::skinning::bounding_sphere::BoundingSphere;
use relievo::ops::skinning::{add_levels, poses_of};
use relievo::scene::{
    BoneGate, Camera, CharacterOptions, DistanceRange, InfluenceLod, InstanceBone, InstanceId, LayerMask,
    ObjectId, Placement, Play, Quality, Scene, SkeletonTier, View,
};
use relievo_lab::measure::{Displacement, DisplacementMeter};

use crate::stage::character;

const RANGE: DistanceRange = DistanceRange { min: 20.0, max: 60.0 };

/// A crowd of one model on a line away from the eye.
struct Crowd {
    scene: Scene,
    view: View,
    object: ObjectId,
    instances: Vec<InstanceId>,
    parents: Vec<Option<u32>>,
}

impl Crowd {
    /// Instances at these distances.
    fn new(model: &Model, options: &CharacterOptions<'_>, pixels: f32, distances: &[f32]) -> Self {
        let gpu = relievo_testing::gpu();
        let mut scene = Scene::new(&gpu).expect("compiled");
        let object = scene.add_character_with(model, distances.len(), options).expect("added");
        let spawn = |at: &f32| {
            let instance = scene.spawn(object, Placement::at([0.0, 0.0, -at])).expect("room");
            scene.play(instance, &Play { start: -0.3 * f64::from(*at), ..Play::new("0") }).expect("a clip");
            instance
        };
        let instances = distances.iter().map(spawn).collect();
        scene.set_statistics(true).expect("room");
        let mut view = scene.view(Quality::pixels(pixels)).expect("a view");
        let camera = Camera::looking_at(Vec3::ZERO, Vec3::NEG_Z, 0.9, [0.1, 1e4], [1280, 720]);
        view.set(camera).expect("a camera");
        let parents = model.skeleton.bones().iter().map(|bone| bone.parent).collect();
        Self { scene, view, object, instances, parents }
    }

    /// Records a frame a sixtieth of a second later. Returns the numbers of interpolated bones and of skinned clusters.
    fn frame(&mut self) -> [u32; 2] {
        self.scene.advance(1.0 / 60.0).expect("finite");
        let gpu = self.scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        self.scene.record(&mut encoder, &mut [&mut self.view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        let of_all = &self.scene.statistics().expect("arrived").characters[0];
        [of_all.bones, of_all.clusters]
    }

    /// The mean number of bones over `count` frames, after a first one in which everything is new.
    fn bones(&mut self, count: u32) -> f64 {
        self.frame();
        (0..count).map(|_| f64::from(self.frame()[0])).sum::<f64>() / f64::from(count)
    }

    /// The error that the view promises, in pixels.
    fn promised(&mut self) -> f32 {
        self.frame();
        self.view.statistics().expect("arrived").pixels
    }

    /// How far the posed bone of an instance lies from its clip's pose, in model units and radians, relative to its parent.
    fn stale(&self, instance: InstanceId, bone: usize) -> f32 {
        let pose = self.scene.pose(instance).expect("there");
        let drawn = self.scene.drawn_bones(self.object).expect("read");
        let (_, matrices) = drawn.iter().find(|(of, _)| *of == instance).expect("drawn");
        let matrix = |affine: &relievo::asset::Affine| {
            let row = |at: usize| glam::Vec4::from(affine[at]);
            glam::Mat4::from_cols(row(0), row(1), row(2), glam::Vec4::W).transpose()
        };
        let parent = self.parents[bone].expect("not the root") as usize;
        let local = matrix(&matrices[parent]).inverse() * matrix(&matrices[bone]);
        let exact = matrix(&relievo::ops::animation::local_to_model::reference::affine(
            &pose.local(bone).expect("a bone"),
        ));
        (local - exact).to_cols_array().iter().fold(0.0, |most: f32, off| most.max(off.abs()))
    }
}

fn gated(gate: BoneGate) -> CharacterOptions<'static> {
    CharacterOptions { gate, ..CharacterOptions::default() }
}

fn skip_period() -> BoneGate {
    BoneGate::SkipPeriod { range: RANGE, period: 1.0, weights: None }
}

#[test]
fn gates_sample_by_distance_and_say_what_they_do_not_promise() {
    let model = character();
    let moving = Crowd::new(&model, &gated(BoneGate::Off), 1.0, &[10.0]).bones(5);
    for gate in [BoneGate::Uniform(RANGE), skip_period()] {
        let bones = |distance: f32| Crowd::new(&model, &gated(gate), 1.0, &[distance]).bones(20);
        let [near, middle, far, beyond] = [10.0, 35.0, 55.0, 70.0].map(bones);
        assert_eq!((near, beyond), (moving, 0.0), "{gate:?}");
        assert!(moving > middle && middle > far && far > 0.0, "{gate:?}: {moving} {middle} {far}");
        let mut crowd = Crowd::new(&model, &gated(gate), 1.0, &[35.0]);
        assert_eq!(crowd.promised(), f32::INFINITY, "{gate:?}");
    }
    // At most so many bones, over all instances.
    let mut crowd = Crowd::new(&model, &gated(BoneGate::Budget { bones: 100 }), 1.0, &[10.0, 20.0, 40.0]);
    assert_eq!(crowd.frame()[0], 3 * 153);
    assert!((0..20).all(|_| crowd.frame()[0] <= 100));
    assert_eq!(crowd.promised(), f32::INFINITY);
    for gate in [BoneGate::Bounded, BoneGate::Off] {
        assert_eq!(Crowd::new(&model, &gated(gate), 0.5, &[35.0]).promised(), 0.5, "{gate:?}");
    }
    let bounded = Crowd::new(&model, &gated(BoneGate::Bounded), 1.0, &[35.0]).bones(20);
    assert!(bounded < moving, "{bounded} of {moving}");
}

/// Where the body skips, a hand of priority 1 has its exact keyframes under every gate.
#[test]
fn a_hand_of_priority_one_keeps_every_keyframe() {
    let model = character();
    let name = "hand_left";
    let hand = model.skeleton.bones().iter().position(|bone| bone.name == name).expect("a hand");
    let spine =
        model.skeleton.bones().iter().position(|bone| bone.name.starts_with("spine")).expect("a spine");
    let gates = [BoneGate::Uniform(RANGE), skip_period(), BoneGate::Budget { bones: 2 }, BoneGate::Bounded];
    for gate in gates {
        let stale = |priorities: BTreeMap<&str, f32>| {
            let options = CharacterOptions { priorities, ..gated(gate) };
            let mut crowd = Crowd::new(&model, &options, 40.0, &[58.0]);
            let frames = (0..30).map(|_| {
                crowd.frame();
                [hand, spine].map(|bone| crowd.stale(crowd.instances[0], bone))
            });
            frames.skip(2).fold([0.0_f32; 2], |most, stale| [most[0].max(stale[0]), most[1].max(stale[1])])
        };
        let [without, _] = stale(BTreeMap::new());
        let [with, body] = stale(BTreeMap::from([(name, 1.0)]));
        assert!(with < 1e-4 && without > 1e-3 && body > 1e-3, "{gate:?}: {with} {without} {body}");
    }
    // The hand stays in every reduced skeleton, and is all that is sampled beyond the range.
    let far = |priorities: BTreeMap<&str, f32>| {
        let tiers = SkeletonTier::DEFAULT.to_vec();
        let options = CharacterOptions { priorities, tiers, ..gated(BoneGate::Uniform(RANGE)) };
        Crowd::new(&model, &options, 1.0, &[4e3]).bones(4)
    };
    assert_eq!([far(BTreeMap::new()), far(BTreeMap::from([(name, 1.0)]))], [0.0, 1.0]);
}

#[test]
fn influences_are_truncated_or_fade_with_distance() {
    let model = character();
    let largest = |influences: InfluenceLod, distance: f32| {
        let options = CharacterOptions { influences, ..gated(BoneGate::Off) };
        let mut crowd = Crowd::new(&model, &options, 0.0, &[distance]);
        let mut meter = DisplacementMeter::new();
        meter.watch(&crowd.scene, crowd.object, &model).expect("the model");
        let promised = crowd.promised();
        (f64::from(distance) * meter.measure(&crowd.scene, &crowd.view).expect("measured").largest, promised)
    };
    let (all, promised) = largest(InfluenceLod::Truncated(8), 30.0);
    assert!(all < 0.1 && promised == 0.0, "{all}");
    let [four, one] = [2, 1].map(|most| largest(InfluenceLod::Truncated(most), 30.0));
    assert!(one.0 > four.0 && four.0 > 0.5 && one.1 == f32::INFINITY, "{four:?} {one:?}");
    let [near, middle, far] = [15.0, 40.0, 70.0].map(|at| largest(InfluenceLod::Faded(RANGE), at).0);
    // At the end every vertex follows one bone, as if truncated.
    assert!(
        near < 0.1 && middle > 0.5 && far > middle && (far / one.0 - 1.0).abs() < 0.1,
        "{near} {middle} {far} {one:?}"
    );
}

/// What 240 frames along a way show: displacements, bones interpolated and clusters skinned.
struct Way {
    found: Displacement,
    bones: u32,
    clusters: u32,
    memory: Vec<u64>,
}

/// Moves a camera away from instances and back, so that each skeleton is used and left. Displacements are measured in twelve pairs of
/// frames, and jumps within a pair.
fn way(model: &Model, gate: BoneGate, tiers: &[SkeletonTier], frames: usize) -> Way {
    let radius = BoundingSphere::in_clip(model, 0).radius;
    let options = CharacterOptions { tiers: tiers.to_vec(), ..gated(gate) };
    let distances: Vec<f32> = (0..12).map(|at| radius * (4.0 + 5.0 * at as f32)).collect();
    let mut crowd = Crowd::new(model, &options, 1.0, &distances);
    let mut meter = DisplacementMeter::of_at_most(4);
    meter.watch(&crowd.scene, crowd.object, model).expect("the model");
    let (mut found, mut bones, mut clusters): (Option<Displacement>, u32, u32) = (None, 0, 0);
    for frame in 0..frames {
        let part = (std::f32::consts::PI * frame as f32 / frames as f32).sin();
        let eye = Vec3::new(0.3 * radius, 0.2 * radius, 600.0 * radius * part * part);
        let ahead = eye + Vec3::new(0.0, -0.05, -1.0);
        let camera = Camera::looking_at(eye, ahead, 0.7, [0.05 * radius, 1e5 * radius], [1280, 720]);
        crowd.view.set(camera).expect("a camera");
        let counts = crowd.frame();
        if frame > 0 {
            [bones, clusters] = [bones + counts[0], clusters + counts[1]];
        }
        let of_pair = frame % (frames / 12);
        if of_pair == 0 {
            meter.forget_last();
        }
        if of_pair < 2 {
            let here = meter.measure(&crowd.scene, &crowd.view).expect("measured");
            found = Some(found.map_or(here, |all| all.and(here)));
        }
    }
    let skeletons = crowd.scene.skeletons(crowd.object).expect("a character");
    let memory = skeletons.iter().map(|skeleton| skeleton.bytes).collect();
    Way { found: found.expect("frames"), bones, clusters, memory }
}

const HEAD: &str =
    "| model | gate | bones | with tiers | clusters | with tiers | bytes | px | with tiers | jump |";

/// Walks with and without reduced skeletons under two gates, and prints a line for each.
fn compare(name: &str, model: &Model, frames: usize) -> [[Way; 2]; 2] {
    [BoneGate::Off, BoneGate::Bounded].map(|gate| {
        let all = [&[][..], &SkeletonTier::DEFAULT].map(|tiers| way(model, gate, tiers, frames));
        let [without, with] = &all;
        println!(
            "| {name} | {gate:?} | {} | {} | {} | {} | {:?} | {:.3} | {:.3} | {:.3} |",
            without.bones,
            with.bones,
            without.clusters,
            with.clusters,
            with.memory,
            without.found.largest,
            with.found.largest,
            with.found.jump
        );
        for Way { found, .. } in &all {
            assert!(found.largest <= 1.0 && found.jump <= 2.0 && found.missing == 0, "{name}: {found:?}");
        }
        all
    })
}

/// Nineteen rigid boxes on a chain with branches, each on a node of its own, in centimetres.
fn machine() -> Model {
    const COUNT: usize = 19;
    let bone = |at: usize| Bone {
        name: format!("part {at}"),
        parent: at
            .checked_sub(1)
            .map(|last| if at.is_multiple_of(5) { last as u32 / 2 } else { last as u32 }),
        rest: Transform::from_translation([
            if at.is_multiple_of(5) { 30.0 } else { 0.0 },
            if at == 0 { 0.0 } else { 22.0 },
            0.0,
        ]),
    };
    let skeleton = Skeleton::of_joints((0..COUNT).map(bone).collect()).expect("valid");
    let turn = |at: usize, key: usize| {
        let angle = 0.2 * ((at * 7 + key * 3) as f32).sin() / (1.0 + 0.2 * at as f32);
        glam::Quat::from_euler(glam::EulerRot::XYZ, angle, 0.5 * angle, -angle).to_array()
    };
    let keys = |at: usize| {
        let times: Vec<f32> = (0..9).map(|key| 0.25 * key as f32).collect();
        let values = (0..9).map(|key| turn(at, key % 8)).collect();
        let rotation = Some(Keys { times, values, interpolation: Interpolation::Linear });
        BoneKeys { rotation, ..BoneKeys::default() }
    };
    let clip = Clip::new("work", &skeleton, &(0..COUNT).map(keys).collect::<Vec<_>>(), 0.0).expect("valid");
    let skins = (0..COUNT as u32).map(|bone| Skin {
        name: String::new(),
        bones: vec![bone],
        inverse_binds: vec![glam::Mat4::IDENTITY.to_cols_array()],
    });
    Model {
        skins: skins.collect(),
        clips: vec![clip],
        motion: None,
        meshes: (0..COUNT).map(part).collect(),
        skinned: 0,
        materials: vec![],
        images: vec![],
        skeleton,
    }
}

/// A box with hard edges that follows one bone.
fn part(skin: usize) -> Mesh {
    let mut mesh = Mesh { name: format!("box {skin}"), skin, ..Mesh::default() };
    for (axis, side) in (0..3).flat_map(|axis| [-1.0_f32, 1.0].map(|side| (axis, side))) {
        let first = mesh.positions.len() as u32;
        for [u, v] in [[-1.0_f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let mut position = [0.0; 3];
            let mut normal = [0.0; 3];
            normal[axis] = side;
            position[axis] = 8.0 * side;
            position[(axis + 1) % 3] = 8.0 * u * side;
            position[(axis + 2) % 3] = 8.0 * v;
            mesh.positions.push([position[0], position[1] + 8.0, position[2]]);
            mesh.normals.push(normal);
            mesh.tangents.push([1.0, 0.0, 0.0, 1.0]);
            mesh.uv.push([u, v]);
        }
        mesh.indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
    }
    mesh.influences = Influences::rigid(mesh.vertices());
    mesh
}

#[test]
fn reduced_skeletons_keep_the_promise() {
    println!("{HEAD}");
    for (name, model) in [("creature", character()), ("machine", machine())] {
        let [[without, with], _] = compare(name, &model, 18);
        assert!(5 * with.bones < 4 * without.bones, "{name}: {} of {}", with.bones, without.bones);
        assert!(with.memory.len() > 1 && with.memory.iter().all(|bytes| *bytes > 0));
    }
}

#[test]
#[ignore = "needs files"]
fn tiers_of_files() {
    let files = std::env::var_os("RELIEVO_MODELS").expect("RELIEVO_MODELS names files");
    let file = |path: &Path| {
        let mut model = Model::from_file(path).expect("a model");
        let poses = poses_of(&model.clips[0]).expect("short").min(24);
        add_levels(&mut model, &[0], poses).expect("valid");
        (path.file_stem().expect("a file").to_string_lossy().into_owned(), model)
    };
    let own = [("creature".to_owned(), character()), ("machine".to_owned(), machine())];
    println!("{HEAD}");
    for (name, model) in own.into_iter().chain(std::env::split_paths(&files).map(|path| file(&path))) {
        compare(&name, &model, 240);
    }
}

/// An instance keeps its whole skeleton while somebody needs its bones: attached meshes, driven and watched bones, layers.
#[test]
fn instances_whose_bones_are_needed_keep_the_whole_skeleton() {
    let model = character();
    let layers = vec![LayerMask::All];
    let options = CharacterOptions { layers, tiers: SkeletonTier::DEFAULT.to_vec(), ..gated(BoneGate::Off) };
    let far = 4e3;
    let whole = Crowd::new(&model, &gated(BoneGate::Off), 1.0, &[far]).bones(4);
    let mut crowd = Crowd::new(&model, &options, 1.0, &[far]);
    let reduced = crowd.bones(4);
    assert!(reduced > 0.0 && reduced < 0.3 * whole, "{reduced} of {whole}");
    let instance = crowd.instances[0];
    let name = "hand_left";

    crowd.scene.drive(instance, &[name]).expect("a bone");
    assert!(crowd.bones(4) >= whole - 1.0);
    crowd.scene.drive(instance, &[]).expect("a bone");
    assert_eq!(crowd.bones(4), reduced);

    crowd.scene.watch_bones(&[InstanceBone { instance, bone: name }]).expect("a bone");
    assert_eq!(crowd.bones(4), whole);
    let hand = crowd.scene.bone(instance, name).expect("a bone");
    let watched = crowd.scene.watched_bones().expect("arrived").bones[0];
    assert!(watched.is_current && watched.bone == hand);
    crowd.scene.watch_bones(&[]).expect("none");
    assert_eq!(crowd.bones(4), reduced);

    crowd.scene.play_layer(instance, 1, &Play::new("1"), 0.5).expect("a clip");
    assert!(crowd.bones(4) >= whole);
    crowd.scene.fade_layer(instance, 1, 0.0, 0.0).expect("a layer");
    crowd.frame();
    assert_eq!(crowd.bones(4), reduced);

    let block = crowd.scene.add_mesh(&crate::stage::mesh(), 1).expect("added");
    let tool = crowd.scene.spawn(block, Placement::at([0.0; 3])).expect("room");
    crowd.scene.attach(tool, instance, name, Transform::IDENTITY).expect("attached");
    assert_eq!(crowd.bones(4), whole);
}

#[test]
fn mistakes_in_options_are_refused() {
    let gpu = relievo_testing::gpu();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let model = character();
    let mut refused = |options: CharacterOptions<'_>| {
        scene.add_character_with(&model, 1, &options).expect_err("refused").to_string()
    };
    let wrong = DistanceRange { min: 5.0, max: 5.0 };
    let cases = [
        (gated(BoneGate::Uniform(wrong)), "options.gate.range.max"),
        (gated(BoneGate::SkipPeriod { range: RANGE, period: 0.0, weights: None }), "options.gate.period"),
        (
            gated(BoneGate::SkipPeriod {
                range: RANGE,
                period: 1.0,
                weights: Some(relievo::scene::PriorityWeights([0.5; 6])),
            }),
            "options.gate.weights",
        ),
        (
            CharacterOptions { influences: InfluenceLod::Truncated(9), ..CharacterOptions::default() },
            "options.influences",
        ),
        (
            CharacterOptions { influences: InfluenceLod::Faded(wrong), ..CharacterOptions::default() },
            "options.influences.range.max",
        ),
        (
            CharacterOptions {
                priorities: BTreeMap::from([("hand_left", 1.5)]),
                ..CharacterOptions::default()
            },
            "options.priorities.hand_left",
        ),
        (
            CharacterOptions { priorities: BTreeMap::from([("tail", 1.0)]), ..CharacterOptions::default() },
            "options.priorities.tail",
        ),
        (
            CharacterOptions {
                tiers: vec![SkeletonTier { bones: 1.5, is_rigid: false }],
                ..CharacterOptions::default()
            },
            "options.tiers[0].bones",
        ),
    ];
    for (options, path) in cases {
        let message = refused(options);
        assert!(message.starts_with(path), "{message} instead of {path}");
    }
}
