//! The bound of `bounded` holds for linear blending only, so nothing may blend the matrices of a crowd under it
//! by dual quaternions. Whichever is prepared first excludes the other, by every route to the crowd's matrices.

use relievo::Error;
use relievo::asset::Model;
use relievo::asset::keyframe::RotationPath;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::animation::active::Active;
use relievo::ops::animation::crowd::{ClipBuffers, Crowd};
use relievo::ops::animation::frame::GatedFrame;
use relievo::ops::animation::gate::GatePass;
use relievo::ops::animation::instance::{Instance, Wrap};
use relievo::ops::animation::local_to_model::LocalToModelPass;
use relievo::ops::animation::sample::SamplePass;
use relievo::ops::animation::{AnimatedBones, BoundTable, ClipSet, Gate, GateState, ModelMatrices, Order};
use relievo::ops::skinning::Blend;
use relievo::ops::skinning::buffers::{MeshBuffers, SkinnedCrowd};
use relievo::ops::skinning::frame::{SkinFrame, SkinOptions};
use relievo::ops::skinning::palette::PalettePass;
use relievo_samples::creature;

use crate::harness::gpu;

/// The objects from which everything is prepared.
struct Rig {
    gpu: Gpu,
    model: Model,
    set: ClipSet,
    order: Order,
    clips: ClipBuffers,
    bounded: Gate,
    uniform: Gate,
    palette: PalettePass,
    gate: GatePass,
}

impl Rig {
    fn new() -> Self {
        let (gpu, model) = (gpu(), creature().expect("valid"));
        let clips = [&model.clips[0]];
        let set = ClipSet::new(&clips).expect("one skeleton");
        let bone_radii = vec![0.1; model.skeleton.len()];
        let order = Order::new(&model.skeleton);
        let table = BoundTable::new(&model.skeleton, &set, &clips, &bone_radii, RotationPath::Slerp);
        let bounded = Gate::Bounded(table.expect("fits"));
        Self {
            clips: ClipBuffers::new(&gpu, &set).expect("uploaded"),
            uniform: Gate::Uniform(AnimatedBones::new(&order, &set, &clips).expect("fits")),
            palette: PalettePass::new(&gpu).expect("compiled"),
            gate: GatePass::new(&gpu, &bounded).expect("compiled"),
            order,
            bounded,
            set,
            gpu,
            model,
        }
    }

    fn crowd(&self) -> Crowd {
        let plays = [Instance::new(0, Wrap::Loop, 0.0, 1.0)];
        Crowd::new(&self.gpu, &self.set, &plays).expect("fits")
    }

    fn active(&self, crowd: &Crowd) -> Active {
        Active::new(&self.gpu, &self.order, crowd).expect("fits")
    }

    fn state(&self, crowd: &Crowd) -> GateState {
        GateState::new(&self.gpu, crowd).expect("allocated")
    }

    fn framed(&self, crowd: &Crowd, gate: &Gate) -> Result<GatedFrame, Error> {
        GatedFrame::new(&self.gpu, &self.model.skeleton, &self.clips, crowd, gate)
    }

    /// Every way to put a crowd under `bounded`.
    fn bound(&self, way: usize, crowd: &Crowd) -> Option<Result<(), Error>> {
        let (gpu, bounded) = (&self.gpu, &self.bounded);
        let (active, state) = (self.active(crowd), self.state(crowd));
        Some(match way {
            0 => self.framed(crowd, bounded).map(drop),
            1 => self.gate.prepare(gpu, crowd, &state, &active).map(drop),
            2 => self.framed(&crowd.clone(), bounded).map(drop),
            _ => return None,
        })
    }

    /// Every way to blend the matrices of a crowd.
    fn skin(&self, way: usize, crowd: &Crowd, blend: Blend) -> Option<Result<(), Error>> {
        let own = crowd.model_matrices();
        let updated = own.with_updated_bones(&self.active(crowd).updated_bones);
        Some(match way {
            0 => self.skinned(own, blend),
            1 => self.skinned(&updated, blend),
            2 => self.blended(own, blend),
            3 => self.blended(crowd.clone().model_matrices(), blend),
            _ => return None,
        })
    }

    fn skinned(&self, matrices: &ModelMatrices, blend: Blend) -> Result<(), Error> {
        let options = SkinOptions { mesh: 0, instances: 1, blend };
        SkinFrame::new(&self.gpu, &self.model, matrices, options).map(drop)
    }

    fn blended(&self, matrices: &ModelMatrices, blend: Blend) -> Result<(), Error> {
        let (mesh, _) = MeshBuffers::new(&self.gpu, &self.model, &self.model.meshes[0]).expect("fits");
        let crowd = SkinnedCrowd::new(&self.gpu, &mesh, 1, blend).expect("fits");
        self.palette.prepare(&self.gpu, &mesh, matrices, &crowd).map(drop)
    }
}

#[track_caller]
fn refuses(refused: Result<(), Error>, field: &str, value: &str) {
    let Err(Error::Input(error)) = refused else { panic!("{refused:?} is no refusal") };
    assert_eq!((error.path.as_str(), error.value.as_str()), (field, value));
    assert!(error.bound.contains("linear blending alone"), "{}", error.bound);
}

#[test]
fn bounded_and_dual_quaternions_exclude_each_other_in_any_order() {
    let rig = Rig::new();
    let (mut gates, mut skins) = (0, 0);
    while let Some(bound) = rig.bound(gates, &rig.crowd()) {
        bound.expect("nothing precedes it");
        skins = 0;
        loop {
            // The gate first.
            let crowd = rig.crowd();
            rig.bound(gates, &crowd).expect("a way").expect("nothing precedes it");
            let Some(refused) = rig.skin(skins, &crowd, Blend::DualQuaternion) else { break };
            refuses(refused, "blend", "DualQuaternion");
            // What was refused claims nothing.
            rig.bound(gates, &crowd).expect("a way").expect("the same again");
            // Skinning first.
            let crowd = rig.crowd();
            rig.skin(skins, &crowd, Blend::DualQuaternion).expect("a way").expect("nothing precedes it");
            refuses(rig.bound(gates, &crowd).expect("a way"), "gate", "Bounded");
            rig.skin(skins, &crowd, Blend::DualQuaternion).expect("a way").expect("the same again");
            skins += 1;
        }
        gates += 1;
    }
    assert_eq!((gates, skins), (3, 4));
}

/// Other gates give no guarantee, the bound holds for linear blending, and the caller's own matrices belong to
/// no crowd.
#[test]
fn nothing_else_is_excluded() {
    let rig = Rig::new();
    let crowd = rig.crowd();
    rig.bound(0, &crowd).expect("a way").expect("nothing precedes it");
    for way in 0.. {
        let Some(skinned) = rig.skin(way, &crowd, Blend::Linear) else { break };
        skinned.expect("linear blending");
    }
    let own = Buffer::new(&rig.gpu, "own", crowd.pairs()).expect("allocated");
    rig.blended(&ModelMatrices::new(&own), Blend::DualQuaternion).expect("matrices of one's own");
    let crowd = rig.crowd();
    let uniform = rig.framed(&crowd, &rig.uniform).expect("prepared");
    rig.skinned(uniform.model_matrices(), Blend::DualQuaternion).expect("no bound is promised");
    rig.framed(&crowd, &rig.uniform).expect("no bound is promised");
    // A refused preparation excludes nothing: here there are fewer matrices than instances need.
    let crowd = rig.crowd();
    let options = SkinOptions { mesh: 0, instances: 2, blend: Blend::DualQuaternion };
    let two = SkinFrame::new(&rig.gpu, &rig.model, crowd.model_matrices(), options);
    assert!(two.is_err());
    rig.bound(0, &crowd).expect("a way").expect("nothing precedes it");
}

/// A gate's list of active bones cannot be used for another crowd, which would not know of the gate.
#[test]
fn lists_of_active_bones_are_of_one_crowd() {
    let rig = Rig::new();
    let (gpu, crowd, other) = (&rig.gpu, rig.crowd(), rig.crowd());
    let active = rig.active(&crowd);
    let sample = SamplePass::new(gpu, RotationPath::Slerp).expect("compiled");
    let local_to_model = LocalToModelPass::new(gpu).expect("compiled");
    let prepared = |crowd: &Crowd| {
        [
            rig.gate.prepare(gpu, crowd, &rig.state(crowd), &active).map(drop),
            sample.prepare_active(gpu, &rig.clips, crowd, &active.pairs).map(drop),
            local_to_model.prepare_active(gpu, &rig.model.skeleton, crowd, &active).map(drop),
        ]
    };
    assert!(prepared(&crowd).iter().all(Result::is_ok));
    for refused in prepared(&other) {
        let Err(Error::Input(error)) = refused else { panic!("{refused:?} is no refusal") };
        assert_eq!(error.path, "crowd");
    }
    rig.blended(other.model_matrices(), Blend::DualQuaternion).expect("what was refused claims nothing");
}
