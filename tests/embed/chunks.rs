//! Characters whose vertices exceed a binding of the device, or its memory.

use glam::Vec3;
use relievo::gpu::Gpu;
use relievo::scene::{Camera, InstanceId, ObjectId, Placement, Play, Quality, Scene, View};

use crate::frame::{Frame, device};
use crate::harness::{Difference, gpu_of_bindings};
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
        let mut scene = Scene::new(gpu).expect("compiled");
        let creature = scene.add_character(&model(), COUNT).expect("added");
        let all = (0..COUNT).map(|at| {
            let instance = scene.spawn(creature, placement(at)).expect("room");
            let play = Play { start: -0.31 * at as f64, ..Play::new("walk") };
            scene.play(instance, &play).expect("the clip");
            instance
        });
        let all = all.collect();
        let view = scene.view(Quality { pixels }).expect("a view");
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

    fn coarsening(&self) -> f32 {
        self.scene.coarsening(self.creature).expect("there")
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
    let (small, large) = (gpu_of_bindings(3 << 20), device());
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
        assert_eq!((a.coarsening(), b.coarsening()), (1.0, 1.0), "at {distance}");
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
    let (small, large) = (gpu_of_bindings(3 << 20), device());
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
    let gpu = device();
    let frame = Frame::plain(&gpu, SIZE);
    let mut crowd = Crowd::new(&gpu, 0.01);
    crowd.look(200.0);
    crowd.shot(&frame);
    assert_eq!(crowd.coarsening(), 1.0);
    gpu.memory().set_limit(gpu.memory().now() + (1 << 20));
    crowd.look(6.0);
    let coarse = crowd.shot(&frame);
    let coarsening = crowd.coarsening();
    println!("coarser by {coarsening}");
    assert!(coarsening > 1.0 && coarsening < 1e5, "{coarsening}");
    assert!(gpu.memory().now() <= gpu.memory().limit(), "more memory than there is");
    gpu.memory().set_limit(u64::MAX);
    crowd.scene.refresh().expect("afresh");
    let fine = crowd.shot(&frame);
    assert_eq!(crowd.coarsening(), 1.0);
    let difference = Difference::of(&coarse, &fine, 3);
    assert!(difference.flip > 0.0 && difference.flip < 0.1, "coarse against fine: {difference:?}");
}
