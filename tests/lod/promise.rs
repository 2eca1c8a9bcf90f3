//! Many objects at once, along a way: what level of detail saves, and that all of them keep the promise of `pixels`.

use std::path::Path;

use glam::Vec3;
use relievo::asset::Model;
use relievo::ops::skinning::add_levels;
use relievo::ops::skinning::bounding_sphere::BoundingSphere;
use relievo::scene::{
    Camera, ObjectId, ObjectStatistics, Placement, Play, Quality, Scene, TerrainConfig, TerrainSource, View,
};
use relievo_lab::measure::DisplacementMeter;

use crate::stage::{character, mesh};

const FRAMES: usize = 24;
const VIEWPORT: [u32; 2] = [480, 270];

/// A rock, the creature, and a model of others in hundredths of a unit.
fn models() -> [Model; 3] {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files/armature.glb");
    let mut foreign = Model::from_file(&path).expect("valid");
    add_levels(&mut foreign, &[0], 9).expect("valid");
    [mesh(), character(), foreign]
}

/// The scene of all models, on ground.
struct Crowd {
    scene: Scene,
    objects: Vec<(ObjectId, Model)>,
}

impl Crowd {
    fn new() -> Self {
        let gpu = relievo_testing::gpu();
        let mut scene = Scene::new(&gpu).expect("compiled");
        let config = TerrainConfig::new(33, 2.0, "promise").expect("valid");
        scene.add_terrain(&TerrainSource::new(config)).expect("generated");
        let mut objects = Vec::new();
        for (kind, model) in models().into_iter().enumerate() {
            let count = [60, 16, 24][kind];
            let is_mesh = model.clips.is_empty();
            let object = match is_mesh {
                true => scene.add_mesh(&model, count).expect("added"),
                false => scene.add_character(&model, count).expect("added"),
            };
            let size = match is_mesh {
                true => 1.0,
                false => 1.0 / BoundingSphere::in_clip(&model, 0).radius,
            };
            for at in 0..count {
                let around = 2.4 * at as f32 + kind as f32;
                let away = 3.0 + 2.0 * (at as f32).sqrt() * (1.0 + kind as f32);
                let place = [16.0 + away * around.cos(), 2.0, 16.0 + away * around.sin()];
                let instance =
                    scene.spawn(object, Placement::at(place).turned(around).scaled(size)).expect("room");
                if !is_mesh {
                    scene
                        .play(instance, &Play { start: -0.3 * at as f64, ..Play::new("0") })
                        .expect("a clip");
                }
            }
            objects.push((object, model));
        }
        scene.set_statistics(true).expect("room");
        Self { scene, objects }
    }

    /// Records a frame: walk, fly up, zoom, turn. Returns the triangles and the bones.
    fn frame(&mut self, view: &mut View, part: f32) -> [u64; 2] {
        let turn = std::f32::consts::TAU * part;
        let eye = Vec3::new(16.0 + 22.0 * turn.cos(), 3.0 + 12.0 * part, 16.0 + 22.0 * turn.sin());
        let target = Vec3::new(16.0, 1.0 + part, 16.0);
        let field = 0.9 - 0.4 * (2.0 * turn).sin().abs();
        view.set(Camera::looking_at(eye, target, field, [0.1, 300.0], VIEWPORT)).expect("a camera");
        self.scene.advance(1.0 / 60.0).expect("finite");
        let gpu = self.scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        self.scene.record(&mut encoder, &mut [view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        gpu.wait().expect("done");
        // The ground has one level.
        let drawn = &view.statistics().expect("arrived").objects[1..];
        let bones = &self.scene.statistics().expect("arrived").characters;
        [
            drawn.iter().map(ObjectStatistics::triangles).sum(),
            bones.iter().map(|character| u64::from(character.bones)).sum(),
        ]
    }
}

#[test]
fn many_objects_keep_the_promise_at_a_fraction_of_the_work() {
    let work = |pixels: f32| {
        let mut crowd = Crowd::new();
        let mut view = crowd.scene.view(Quality::pixels(pixels)).expect("a view");
        let mut meter = DisplacementMeter::new();
        for (object, model) in &crowd.objects {
            meter.watch(&crowd.scene, *object, model).expect("the object's model");
        }
        let mut sums = [0; 2];
        for frame in 0..FRAMES {
            let done = crowd.frame(&mut view, frame as f32 / FRAMES as f32);
            sums = [sums[0] + done[0], sums[1] + done[1]];
            if pixels > 0.0 && frame % 8 < 2 {
                let found = meter.measure(&crowd.scene, &view).expect("measured");
                assert!(found.largest <= f64::from(pixels), "frame {frame}: {found:?}");
                assert!(found.jump <= 2.0 * f64::from(pixels), "frame {frame}: {found:?}");
                assert_eq!((found.left_out, found.missing), (0, 0), "frame {frame}: {found:?}");
            }
        }
        sums
    };
    let (full, within) = (work(0.0), work(1.0));
    let [triangles, bones] = [0, 1].map(|at| full[at] as f64 / within[at] as f64);
    println!("full detail ÷ a pixel: triangles {triangles:.1}, bones {bones:.1}");
    assert!(triangles > 4.0 && bones > 1.5, "{triangles} and {bones}");
}
