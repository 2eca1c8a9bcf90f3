//! The same crowd as a program draws it from the library's passes without a scene, for one camera that stands still.

use std::rc::Rc;

use glam::Vec3;
use relievo::animation::crowd::{ClipBuffers, Crowd as Animated};
use relievo::animation::frame::GatedFrame;
use relievo::animation::keyframe_cursor::{KeyframeCursorJob, KeyframeCursorPass};
use relievo::animation::local_to_model::{LocalToModelJob, LocalToModelPass};
use relievo::animation::sample::SamplePass;
use relievo::animation::{BoundTable, ClipSet, Frame as Moment, Gate, Instance, Lod, RotationPath, Wrap};
use relievo::asset::mesh::bone_radii;
use relievo::asset::{Affine, Light};
use relievo::gpu::{Buffer, Gpu, Job, compute_pass};
use relievo::image::{Rgba, RgbaImage};
use relievo::render::{Albedo, Character, ColorTexture, CrowdScene};
use relievo::skinning::{Blend, Extent, FadeRange, level_errors};
use relievo::surface::mips::Mips;

use super::crowd::{COUNT, Crowd, SIZE, STEP};
use crate::frame::{COLOR, Frame};

/// Shares of the permitted pixel for bones, influences and meshes.
const SHARES: [f32; 3] = [0.25, 0.05, 0.7];

/// What animates the crowd.
enum Bones {
    Gated(Box<GatedFrame>),
    Full(Box<(KeyframeCursorJob, Job, LocalToModelJob)>),
}

/// A program that draws a crowd.
pub struct Wired {
    gpu: Gpu,
    bones: Bones,
    crowd: CrowdScene,
    target: Option<Rc<Frame>>,
    number: u32,
}

impl Wired {
    /// With every bone, influence and triangle.
    pub fn full(gpu: &Gpu, crowd: &Crowd) -> Self {
        let (set, animated) = animated(gpu, crowd);
        let clips = ClipBuffers::new(gpu, &set).expect("uploaded");
        let cursors = KeyframeCursorPass::new(gpu).expect("compiled");
        let sample = SamplePass::new(gpu, RotationPath::Slerp).expect("compiled");
        let local_to_model = LocalToModelPass::new(gpu).expect("compiled");
        let bones = Bones::Full(Box::new((
            cursors.prepare(gpu, &clips, &animated).expect("prepared"),
            sample.prepare(gpu, &clips, &animated).expect("prepared"),
            local_to_model.prepare(gpu, &crowd.model.skeleton, &animated).expect("prepared"),
        )));
        Self::new(gpu, crowd, (bones, &animated), (FadeRange::NEVER, &[]))
    }

    /// With as few as one pixel permits.
    pub fn within_a_pixel(gpu: &Gpu, crowd: &Crowd) -> Self {
        let (model, projection) = (&crowd.model, &crowd.projection);
        let (set, animated) = animated(gpu, crowd);
        let clips = ClipBuffers::new(gpu, &set).expect("uploaded");
        let lengths = model.skeleton.lengths().into_iter().map(|length| length as f32);
        let radii: Vec<f32> =
            (bone_radii(model.skeleton.len(), &model.skins, &model.meshes).iter().zip(lengths))
                .map(|(vertex, bone)| vertex.max(bone))
                .collect();
        let path = RotationPath::Slerp;
        let table = BoundTable::new(&model.skeleton, &set, &[&model.clips[0]], &radii, path).expect("valid");
        let allowed =
            |place: &Vec3| projection.allowed([place.x, place.y, -place.z], table.radius(), SHARES[0]);
        let lod = |place: &Vec3| Lod { allowed: table.units(allowed(place)), ..Lod::FULL };
        let lods: Vec<Lod> = crowd.places.iter().map(lod).collect();
        let gate = Gate::Bounded(table);
        let frame = GatedFrame::new(gpu, &model.skeleton, &clips, &animated, &gate).expect("prepared");
        frame.state.write_lods(gpu, &lods).expect("as many");
        let extent = Extent::of_model(model, &[0], crowd.poses).expect("meshes");
        let levels = extent.level_ranges(projection, SHARES[2], level_errors(&model.meshes));
        let fade = extent.fade_range(projection, SHARES[1]);
        Self::new(gpu, crowd, (Bones::Gated(Box::new(frame)), &animated), (fade, &levels))
    }

    fn new(
        gpu: &Gpu,
        crowd: &Crowd,
        (bones, animated): (Bones, &Animated),
        (fade_range, levels): (FadeRange, &[f32]),
    ) -> Self {
        let mut scene = CrowdScene::new(gpu, COLOR, Light::default()).expect("compiled");
        let place = |place: &Vec3| -> Affine {
            [[1.0, 0.0, 0.0, place.x], [0.0, 1.0, 0.0, place.y], [0.0, 0.0, 1.0, place.z]]
        };
        let placements: Vec<Affine> = crowd.places.iter().map(place).collect();
        let clay = Mips::of_color(RgbaImage::from_pixel(1, 1, Rgba([255; 4])));
        let clay: Albedo = ColorTexture::new(gpu, &clay, true).expect("uploaded").into();
        let matrices = match &bones {
            Bones::Gated(frame) => frame.model_matrices(),
            Bones::Full(_) => animated.model_matrices(),
        };
        let character = Character {
            model: &crowd.model,
            matrices,
            placements: &Buffer::from_slice(gpu, "placements", &placements).expect("uploaded"),
            fade_range,
            levels,
            blend: Blend::Linear,
            albedos: &Albedo::of_meshes(gpu, &crowd.model, &clay, ColorTexture::new).expect("uploaded"),
        };
        scene.add(gpu, &character).expect("added");
        let camera = crowd.camera(SIZE, 0.0);
        scene.set_camera(gpu, camera.clip_from_world(), Vec3::ZERO).expect("a camera");
        Self { gpu: gpu.clone(), bones, crowd: scene, target: None, number: 0 }
    }

    /// Drawing into a target.
    pub fn drawing(self, target: &Rc<Frame>) -> Self {
        Self { target: Some(target.clone()), ..self }
    }

    /// Plays a frame, and waits for it.
    pub fn frame(&mut self) {
        self.number += 1;
        let elapsed = self.number as f32 * STEP;
        let mut encoder = self.gpu.encoder("frame");
        match &self.bones {
            Bones::Gated(frame) => {
                let moment = Moment { ticks: 0, frame_ticks: 0, frame: self.number, ahead: STEP };
                frame.set(&self.gpu, &moment, elapsed).expect("set");
                frame.record(&mut encoder);
            }
            Bones::Full(jobs) => {
                let (cursors, sample, local_to_model) = &**jobs;
                cursors.set(&self.gpu, elapsed).expect("set");
                let mut pass = compute_pass(&mut encoder, "bones");
                cursors.dispatch(&mut pass);
                sample.dispatch(&mut pass);
                local_to_model.dispatch(&mut pass);
            }
        }
        self.crowd.record(&mut encoder);
        if let Some(target) = &self.target {
            target.pass(&mut encoder, |pass| self.crowd.draw(pass));
        }
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.wait().expect("done");
    }
}

/// The crowd's clip and instances on the device.
fn animated(gpu: &Gpu, crowd: &Crowd) -> (ClipSet, Animated) {
    let set = ClipSet::new(&[&crowd.model.clips[0]]).expect("valid");
    let instances: Vec<_> = (0..COUNT).map(|at| Instance::new(0, Wrap::Loop, crowd.start(at), 1.0)).collect();
    let animated = Animated::new(gpu, &set, &instances).expect("allocated");
    (set, animated)
}
