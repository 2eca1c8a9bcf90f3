//! Crowds that exceed a binding of the device, or its memory.

use glam::Vec3;
use relievo::asset::morph::{MorphDelta, MorphTarget};
use relievo::asset::{Mesh, Model};
use relievo::gpu::Gpu;
use relievo::render::{Layer, TargetFormat};
use relievo::scene::{Camera, InstanceId, ObjectId, Placement, Play, Quality, Scene, View};

use crate::frame::{Frame, new_device};
use crate::harness::{Difference, gpu_of_bindings};
use crate::raw::Raw;
use crate::world::{SIZE, model};

const COUNT: usize = 40;

/// A crowd in rows, and a view from a distance.
struct Crowd {
    scene: Scene,
    creature: ObjectId,
    all: Vec<InstanceId>,
    view: View,
}

impl Crowd {
    fn new(gpu: &Gpu, pixels: f32) -> Self {
        Self::of(gpu, &model(), pixels)
    }

    fn of(gpu: &Gpu, model: &Model, pixels: f32) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let creature = scene.add_character(model, COUNT).expect("added");
        let all = (0..COUNT).map(|at| {
            let instance = scene.spawn(creature, placement(at)).expect("room");
            let play = Play { start: -0.31 * at as f64, ..Play::new("walk") };
            scene.play(instance, &play).expect("the clip");
            instance
        });
        let all = all.collect();
        let view = scene.view(Quality::pixels(pixels)).expect("a view");
        Self { scene, creature, all, view }
    }

    fn look(&mut self, distance: f32) {
        let eye = Vec3::new(0.3, 0.5, 1.0) * distance;
        let camera = Camera::looking_at(eye, Vec3::new(0.0, 1.0, -4.0), 0.8, [0.3, 400.0], SIZE);
        self.view.set(camera).expect("a camera");
        self.scene.advance(0.125).expect("finite");
    }

    fn shot(&mut self, frame: &Frame) -> image::RgbaImage {
        let renderer = frame.renderer(&self.scene.gpu().clone(), &self.scene);
        frame.shot(&mut self.scene, &mut self.view, &renderer)
    }

    fn lod_bias(&self) -> f32 {
        self.scene.lod_bias(self.creature).expect("there")
    }

    fn draws(&self) -> usize {
        self.scene.draws(self.creature).expect("there")
    }
}

fn placement(at: usize) -> Placement {
    let (x, z) = ((at % 8) as f32 * 2.0 - 7.0, (at / 8) as f32 * -2.5);
    let mirror = if at % 7 == 3 { -1.0 } else { 1.0 };
    Placement { scale: Vec3::new(mirror, 1.0, 1.0), ..Placement::at([x, 0.0, z]) }.turned(0.7 * at as f32)
}

/// Bindings of 3 MiB hold the vertices of some fifteen creatures: a crowd in full detail is divided, and the pictures are
/// those of a device that holds all of it at once, while the camera moves and instances move, come and go.
#[test]
fn what_exceeds_a_binding_is_divided() {
    let (small, large) = (gpu_of_bindings(3 << 20), new_device());
    let frames = [&small, &large].map(|gpu| Frame::plain(gpu, SIZE));
    let mut crowds = [&small, &large].map(|gpu| Crowd::new(gpu, 0.0));
    for (step, distance) in [60.0, 9.0, 5.0, 12.0, 200.0].into_iter().enumerate() {
        for crowd in &mut crowds {
            let gone = crowd.all[5 * step];
            crowd.scene.despawn(gone).expect("there");
            crowd.all[5 * step] = crowd.scene.spawn(crowd.creature, placement(5 * step)).expect("room");
            crowd.scene.move_to(crowd.all[39 - step], placement(39 - step).turned(0.3)).expect("there");
            crowd.scene.set_tint(crowd.all[20 + step], [1.0, 0.3, 0.2, 1.0]).expect("there");
            crowd.look(distance);
        }
        let [a, b] = &mut crowds;
        let pictures = [a.shot(&frames[0]), b.shot(&frames[1])];
        // Instances may be drawn in another order, and share the depth of a pixel.
        let difference = Difference::of(&pictures[0], &pictures[1], 0);
        assert!(difference.outliers < 0.001, "at {distance}: {difference:?}");
        assert_eq!((a.lod_bias(), b.lod_bias()), (1.0, 1.0), "at {distance}");
    }
    let [divided, whole] = crowds.each_ref().map(Crowd::draws);
    println!("draws: {divided} divided, {whole} whole");
    assert!(whole <= 64 && divided >= 3 * whole, "{divided} draws, {whole}");
    // Afresh, it is divided again.
    for crowd in &mut crowds {
        crowd.scene.refresh().expect("afresh");
        crowd.look(7.0);
    }
    let [a, b] = &mut crowds;
    let difference = Difference::of(&a.shot(&frames[0]), &b.shot(&frames[1]), 0);
    assert!(difference.outliers < 0.001, "afresh: {difference:?}");
}

/// Objects that are divided grow like others.
#[test]
fn divided_objects_grow() {
    let (small, large) = (gpu_of_bindings(3 << 20), new_device());
    let frames = [&small, &large].map(|gpu| Frame::plain(gpu, SIZE));
    let mut crowds = [&small, &large].map(|gpu| Crowd::new(gpu, 0.0));
    for crowd in &mut crowds {
        crowd.look(9.0);
    }
    let [a, b] = &mut crowds;
    a.shot(&frames[0]);
    b.shot(&frames[1]);
    for crowd in &mut crowds {
        for at in COUNT..70 {
            let play = Play { start: -0.2 * at as f64, ..Play::new("walk") };
            let instance = crowd.scene.spawn(crowd.creature, placement(at)).expect("room");
            crowd.scene.play(instance, &play).expect("the clip");
        }
        crowd.look(9.0);
    }
    let [a, b] = &mut crowds;
    let difference = Difference::of(&a.shot(&frames[0]), &b.shot(&frames[1]), 0);
    assert!(difference.outliers < 0.001, "{difference:?}");
}

/// Where memory itself ends, levels of detail are coarser and the scene says so; with memory again, they are not.
#[test]
fn where_memory_ends_levels_are_coarser() {
    let gpu = new_device();
    let frame = Frame::plain(&gpu, SIZE);
    let mut crowd = Crowd::new(&gpu, 0.01);
    crowd.look(200.0);
    crowd.shot(&frame);
    assert_eq!(crowd.lod_bias(), 1.0);
    gpu.memory().set_limit(gpu.memory().now() + (1 << 20));
    crowd.look(6.0);
    let coarse = crowd.shot(&frame);
    let lod_bias = crowd.lod_bias();
    println!("coarser by {lod_bias}");
    assert!(lod_bias > 1.0 && lod_bias < 1e5, "{lod_bias}");
    assert!(gpu.memory().now() <= gpu.memory().limit(), "more memory than there is");
    gpu.memory().set_limit(u64::MAX);
    crowd.scene.refresh().expect("afresh");
    let fine = crowd.shot(&frame);
    assert_eq!(crowd.lod_bias(), 1.0);
    let difference = Difference::of(&coarse, &fine, 3);
    assert!(difference.flip > 0.0 && difference.flip < 0.1, "coarse against fine: {difference:?}");
}

/// By how much a morph target moves vertices along their normals, at a weight of 1.
const SWELLING: f32 = 0.04;

/// The creature, swollen by half of a morph target, or by another shape of its meshes.
fn swollen(by_target: bool) -> Model {
    let swell = |mesh: &mut Mesh| {
        let moved = |normal: &[f32; 3]| normal.map(|axis| SWELLING * axis);
        let delta = |normal| MorphDelta { position: moved(normal), ..MorphDelta::default() };
        if by_target {
            let deltas: Vec<_> = mesh.normals.iter().map(delta).collect();
            (mesh.targets, mesh.weights) = (vec![MorphTarget::new(&deltas)], vec![0.5]);
        } else {
            for (position, normal) in mesh.positions.iter_mut().zip(&mesh.normals) {
                *position = std::array::from_fn(|axis| position[axis] + 0.5 * moved(normal)[axis]);
            }
        }
    };
    let mut model = model();
    model.meshes.iter_mut().for_each(swell);
    model
}

/// Morphed vertices are where they would be in a mesh of that shape, also where chunks of instances have pages of their own.
#[test]
fn morphed_vertices_are_where_they_belong() {
    let gpu = new_device();
    let frame = Frame::plain(&gpu, SIZE);
    let [expected, morphed] = [false, true].map(|by_target| {
        let mut crowd = Crowd::of(&gpu, &swollen(by_target), 0.0);
        crowd.look(7.0);
        crowd.shot(&frame)
    });
    let mut plain = Crowd::new(&gpu, 0.0);
    plain.look(7.0);
    let difference = Difference::of(&plain.shot(&frame), &expected, 3);
    assert!(difference.outliers > 0.01, "nothing is swollen: {difference:?}");
    let small = gpu_of_bindings(3 << 20);
    let mut divided = Crowd::of(&small, &swollen(true), 0.0);
    divided.look(7.0);
    let in_chunks = divided.shot(&Frame::plain(&small, SIZE));
    assert!(divided.draws() >= 3 * plain.draws() && divided.lod_bias() == 1.0, "{}", divided.draws());
    for picture in [&morphed, &in_chunks] {
        let difference = Difference::of(picture, &expected, 1);
        assert!(difference.outliers < 0.002, "{difference:?}");
    }
}

/// Memory for morphed vertices follows what is seen, as that for skinned ones does.
#[test]
fn morphed_vertices_take_memory_where_they_are_seen() {
    let gpu = new_device();
    let model = swollen(true);
    let vertices: usize = model.meshes.iter().map(Mesh::vertices).sum();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let count = 1000;
    let creature = scene.add_character(&model, count).expect("added");
    for at in 0..count {
        let place = [(at % 20) as f32 * 2.0 - 19.0, 0.0, (at / 20) as f32 * -5.0];
        scene.spawn(creature, Placement::at(place).turned(at as f32)).expect("room");
    }
    let mut view = scene.view(Quality::default()).expect("a view");
    let eye =
        Camera::looking_at(Vec3::new(0.0, 2.0, 8.0), Vec3::new(0.0, 1.0, -20.0), 0.9, [0.3, 500.0], SIZE);
    view.set(eye).expect("a camera");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
    let held = gpu.memory().by_label();
    let of = |label: &str| held.iter().find(|(known, _)| *known == label).map_or(0, |(_, bytes)| *bytes);
    let (morphed, skinned) = (of("pages of morphed vertices"), of("pages of vertices"));
    // At full detail, by 40 bytes a vertex.
    let full = (count * vertices * 40) as u64;
    println!(
        "morphed {morphed}, skinned {skinned} bytes of {full} at full detail, {} in all",
        gpu.memory().now()
    );
    assert!(morphed == skinned && morphed > 0 && 4 * morphed < full, "{held:?}");
}

/// Of a crowd in chunks, every instance keeps the number of its handle.
#[test]
fn instances_in_chunks_keep_their_numbers() {
    let numbers = |gpu: &Gpu| {
        let mut crowd = Crowd::new(gpu, 0.0);
        crowd.look(9.0);
        let raw = Raw::new(gpu, TargetFormat::measure(), SIZE);
        let renderer = raw.renderer(gpu, &crowd.scene);
        raw.frame(&mut crowd.scene, &mut crowd.view, &renderer, &[Layer::Measure]);
        raw.words(gpu, 1)
    };
    let (divided, whole) = (numbers(&gpu_of_bindings(3 << 20)), numbers(&new_device()));
    let wrong = divided.iter().zip(&whole).filter(|(a, b)| a != b).count();
    assert!(1000 * wrong < whole.len(), "{wrong} other numbers");
    assert!(divided.iter().any(|[_, instance]| *instance >= 32), "instances of the last chunk are seen");
}
