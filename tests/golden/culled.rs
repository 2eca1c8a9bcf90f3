//! A crowd that walks in and out of view: instances that are not seen are not skinned, and the picture equals that of a crowd
//! in which all are.

use glam::Vec3;
use relievo::gpu::Gpu;
use relievo::scene::{Camera, InstanceId, Placement, Play, Quality, Scene, View};
use relievo_samples::creature;

use crate::harness::gpu;
use crate::stage::picture;

/// Creatures that walk abreast from left to right through a narrow view.
const CREATURES: usize = 9;

const FRAMES: usize = 24;

/// A crowd, a narrow view of it, and one that sees all of it.
struct Crowd {
    scene: Scene,
    instances: Vec<InstanceId>,
    narrow: View,
    wide: View,
}

impl Crowd {
    fn new(gpu: &Gpu) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        scene.set_statistics(true).expect("room");
        let object = scene.add_character(&creature().expect("valid"), CREATURES).expect("added");
        let spawned = (0..CREATURES).map(|_| scene.spawn(object, Placement::default()).expect("room"));
        let instances: Vec<_> = spawned.collect();
        let view = |field_of_view: f32, size: [u32; 2]| {
            let (eye, target) = (Vec3::new(0.0, 1.0, 9.0), Vec3::new(0.0, 0.8, 0.0));
            let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
            let camera = Camera::looking_at(eye, target, field_of_view, [0.2, 100.0], size);
            view.set(camera).expect("a camera");
            view
        };
        let (narrow, wide) = (view(0.3, [320, 192]), view(2.2, [640, 192]));
        Self { instances, narrow, wide, scene }
    }

    /// Creatures of odd index keep their pose; all walk out of view and back, the whole way in both directions.
    fn pose(&mut self, frame: usize) {
        let way = (frame as f32 / FRAMES as f32 * std::f32::consts::TAU).sin();
        for (at, instance) in self.instances.iter().enumerate() {
            let x = 8.0 * way + 0.9 * (at as f32 - 4.0);
            let place = Placement::at([x, 0.0, 0.3 * at as f32 - 1.5]).turned(1.57);
            self.scene.move_to(*instance, place).expect("there");
            let moves = if at.is_multiple_of(2) { frame as f64 / 30.0 } else { 0.0 };
            let start = -0.13 * at as f64 - moves;
            self.scene.play(*instance, &Play { start, ..Play::new("walk") }).expect("the clip");
        }
    }

    /// Number of clusters that the last frame skinned.
    fn clusters(&mut self) -> u32 {
        self.scene.statistics().expect("arrived").characters[0].clusters
    }

    /// Number of creatures that the narrow view saw in its last frame.
    fn seen(&mut self) -> u32 {
        self.narrow.statistics().expect("arrived").objects[0].instances()
    }
}

#[test]
fn what_is_not_seen_is_not_skinned_and_comes_back_whole() {
    let gpu = gpu();
    let [mut culled, mut whole] = [Crowd::new(&gpu), Crowd::new(&gpu)];
    let (mut skinned, mut all, mut empty, mut back, mut before, mut shown) = (0, 0, 0, 0, 0, 0);
    for frame in 0..FRAMES {
        culled.pose(frame);
        let some = picture(&gpu, &mut culled.scene, &mut culled.narrow);
        let (clusters, seen) = (culled.clusters(), culled.seen());
        whole.pose(frame);
        // The wide view lets every creature be skinned in every frame.
        gpu.run("whole", |encoder| {
            whole.scene.record(encoder, &mut [&mut whole.narrow, &mut whole.wide]).expect("recorded");
        })
        .expect("run");
        all += whole.clusters();
        assert_eq!(whole.seen(), seen, "frame {frame}");
        let full = picture(&gpu, &mut whole.scene, &mut whole.narrow);
        assert!(some == full, "frame {frame}: another picture than that of a crowd that is skinned whole");
        let drawn = full.pixels().filter(|pixel| *pixel != full.get_pixel(0, 0)).count();
        assert!(drawn == 0 || seen > 0, "frame {frame}: {drawn} pixels of no creature");
        shown += usize::from(drawn > 100);
        if seen == 0 {
            assert_eq!(clusters, 0, "frame {frame}");
            empty += 1;
        }
        back += usize::from(seen > before);
        before = seen;
        skinned += clusters;
    }
    assert!(back > 2 && empty >= 2, "creatures came {back} times, {empty} frames without any");
    assert!(shown > 8, "creatures show in {shown} frames");
    assert!(2 * skinned < all, "{skinned} of {all} clusters");
}
