//! Updated bones accumulate until skinning has followed them, however many frames go by and however many meshes follow.

use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Model, bone_radii};
use relievo::gpu::Gpu;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::frame::GatedFrame;
use relievo::ops::animation::{
    AnimatedBones, BoundTable, ClipSet, ExpectationTable, Frame, Gate, Instance, Lod, Order, Wrap,
};
use relievo::ops::skinning::frame::{SkinFrame, SkinOptions};
use relievo::ops::skinning::{Blend, InstanceLod, Vertex};

use crate::harness::gpu;
use crate::shapes::model;

const COUNT: usize = 5;

/// A crowd under a gate, and the meshes that follow it.
struct Player<'a> {
    gpu: &'a Gpu,
    model: &'a Model,
    frame: GatedFrame,
    skins: Vec<SkinFrame>,
}

impl<'a> Player<'a> {
    fn new(gpu: &'a Gpu, model: &'a Model, gate: &Gate, meshes: usize) -> Self {
        let set = ClipSet::new(&[&model.clips[0]]).expect("one skeleton");
        let plays: Vec<_> = (0..COUNT).map(|at| Instance::new(0, Wrap::Loop, 0.3 * at as f32, 1.0)).collect();
        let crowd = Crowd::new(gpu, &set, &plays).expect("fits");
        let clips = ClipBuffers::new(gpu, &set).expect("uploaded");
        let frame = GatedFrame::new(gpu, &model.skeleton, &clips, &crowd, gate).expect("prepared");
        let mut player = Self { gpu, model, frame, skins: Vec::new() };
        (0..meshes).for_each(|_| player.skins.push(player.skin()));
        player
    }

    fn skin(&self) -> SkinFrame {
        let matrices = self.frame.model_matrices();
        let options = SkinOptions { mesh: 0, instances: COUNT, blend: Blend::Linear };
        SkinFrame::new(self.gpu, self.model, matrices, options).expect("prepared")
    }

    /// Plays a frame with these levels of detail, followed by these meshes.
    fn play(&self, number: u32, lod: Lod, followers: &[&SkinFrame]) {
        self.frame.state.write_lods(self.gpu, &[lod; COUNT]).expect("written");
        let frame = Frame { ticks: 2185 * number, frame_ticks: 2185, frame: number, ahead: 1.0 / 30.0 };
        self.frame.set(self.gpu, &frame, number as f32 / 30.0).expect("set");
        for skin in followers {
            skin.crowd.instance_lods.write(self.gpu, &instance_lods(number)).expect("written");
        }
        let record = |encoder: &mut wgpu::CommandEncoder| {
            self.frame.record(encoder);
            followers.iter().for_each(|skin| skin.record_updated_bones(encoder));
        };
        self.gpu.run("frame", record).expect("run");
    }

    /// The vertices of the instances that a frame sees.
    fn seen(&self, number: u32, skin: &SkinFrame) -> Vec<Vertex> {
        let all = skin.skinned.read_blocking(self.gpu).expect("read");
        let vertices = all.len() / COUNT;
        let seen = instance_lods(number).into_iter().zip(all.chunks(vertices));
        seen.filter(|(lod, _)| *lod != InstanceLod::UNSEEN).flat_map(|(_, own)| own.to_vec()).collect()
    }
}

/// In each frame but the first, one instance is not seen.
fn instance_lods(number: u32) -> Vec<InstanceLod> {
    let unseen = |at: usize| number > 0 && (number as usize / 2 + at).is_multiple_of(COUNT);
    (0..COUNT).map(|at| if unseen(at) { InstanceLod::UNSEEN } else { InstanceLod::FULL }).collect()
}

/// Gates that skip bones, and levels of detail at which they do.
fn gates(model: &Model) -> Vec<(Gate, Lod)> {
    let (skeleton, clips) = (&model.skeleton, [&model.clips[0]]);
    let (set, path) = (ClipSet::new(&clips).expect("one skeleton"), RotationPath::Slerp);
    let radii = bone_radii(skeleton.len(), &model.skins, &model.meshes);
    let bones = AnimatedBones::new(&Order::new(skeleton), &set, &clips).expect("fits");
    let bounds = BoundTable::new(skeleton, &set, &clips, &radii, path).expect("fits");
    let table = ExpectationTable::new(skeleton, &set, &clips, &radii, path).expect("fits");
    let allowed = bounds.units(1.0);
    vec![
        (Gate::Random(bones), Lod { omega: 2000, ..Lod::FULL }),
        (Gate::Bounded(bounds), Lod { allowed, ..Lod::FULL }),
        (Gate::Budget { table, bones: 4 }, Lod::FULL),
    ]
}

#[test]
fn frames_may_skip_skinning() {
    let (gpu, model) = (gpu(), model());
    for (gate, lod) in gates(&model) {
        let [always, rarely, forgetful] = [0; 3].map(|_| Player::new(&gpu, &model, &gate, 1));
        let (mut partly, mut differ) = (0, 0);
        for number in 0..24 {
            always.play(number, lod, &[&always.skins[0]]);
            // Once after two frames, once after three, …
            let is_due = [0, 2, 5, 6, 7, 11, 16, 17, 23].contains(&number);
            let due = |player: &'_ Player<'_>| if is_due { vec![player.skins[0].clone()] } else { vec![] };
            rarely.play(number, lod, &due(&rarely).iter().collect::<Vec<_>>());
            // What was done before: bits last one frame.
            let bits = forgetful.frame.active.updated_bones.bits().clone();
            gpu.run("forget", |encoder| encoder.clear_buffer(bits.raw(), 0, None)).expect("run");
            forgetful.play(number, lod, &due(&forgetful).iter().collect::<Vec<_>>());
            if is_due {
                let wanted = always.seen(number, &always.skins[0]);
                let found = [&rarely, &forgetful].map(|player| player.seen(number, &player.skins[0]));
                assert!(found[0] == wanted, "{}, frame {number}", gate.name());
                differ += usize::from(found[1] != wanted);
                let skinned = rarely.skins[0].active.dispatched.read_blocking(&gpu).expect("read")[3];
                partly += usize::from((skinned as usize) < COUNT * rarely.skins[0].clusters.len() / 2);
            }
        }
        assert!(differ > 2, "{}: {differ} frames in which bits mattered", gate.name());
        assert!(partly > 1, "{}: all is skinned in all but {partly} frames", gate.name());
    }
}

/// Meshes follow one crowd, each in frames of its own.
#[test]
fn several_meshes_follow_one_crowd() {
    let (gpu, model) = (gpu(), model());
    let (gate, lod) = gates(&model).remove(0);
    let (always, player) = (Player::new(&gpu, &model, &gate, 1), Player::new(&gpu, &model, &gate, 3));
    for number in 0..25 {
        always.play(number, lod, &[&always.skins[0]]);
        let due = |mesh: &usize| (number as usize).is_multiple_of(mesh + 1);
        let followers: Vec<_> = (0..3).filter(due).map(|mesh| &player.skins[mesh]).collect();
        player.play(number, lod, &followers);
        let wanted = always.seen(number, &always.skins[0]);
        for skin in followers {
            assert!(player.seen(number, skin) == wanted, "frame {number}");
        }
    }
}

/// Bits are cleared as soon as every mesh has followed, and no mesh that is gone is waited for.
#[test]
fn updated_bones_are_cleared_by_the_last() {
    let (gpu, model) = (gpu(), model());
    let (gate, lod) = gates(&model).remove(0);
    let mut player = Player::new(&gpu, &model, &gate, 3);
    let still = Lod { omega: 0, ..lod };
    let updated = |player: &Player<'_>| {
        let bits = player.frame.active.updated_bones.bits().read_blocking(&gpu).expect("read");
        bits.iter().any(|word| *word != 0)
    };
    let all = |player: &Player<'_>, number, lod| {
        player.play(number, lod, &player.skins.iter().collect::<Vec<_>>());
        updated(player)
    };
    assert!(!all(&player, 0, Lod::FULL));
    // Nothing moves, so nothing but the instance that comes back is skinned.
    assert!(!all(&player, 1, still) && !all(&player, 1, still));
    let skinned =
        |player: &Player<'_>| player.skins[0].active.dispatched.read_blocking(&gpu).expect("read")[3];
    assert_eq!(skinned(&player), 0);
    // One mesh is missing, so bits stay.
    player.play(1, Lod::FULL, &[&player.skins[0], &player.skins[2]]);
    assert!(updated(&player));
    player.play(1, still, &[&player.skins[0]]);
    assert!(updated(&player) && skinned(&player) > 0);
    let clone = player.skins.remove(1).clone();
    player.play(1, still, &[&player.skins[0], &player.skins[1]]);
    assert!(updated(&player), "a clone is the same mesh");
    drop(clone);
    assert!(!all(&player, 1, still));
    // A new mesh follows from its first frame on.
    let added = player.skin();
    player.skins.push(added);
    assert!(!all(&player, 1, lod));
}
