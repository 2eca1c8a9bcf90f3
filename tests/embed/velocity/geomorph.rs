//! Velocities of levels of detail that move into each other, against surfaces of two frames that the host moves.

use glam::{DMat4, DVec3, Vec3, Vec4Swizzles as _};
use relievo::asset::clip::{BoneKeys, Interpolation, Keys};
use relievo::asset::{Clip, Mesh, Model};
use relievo::gpu::Gpu;
use relievo::ops::mesh::ProgressiveMesh;
use relievo::ops::skinning::add_levels;
use relievo::ops::skinning::merged::merged;
use relievo::scene::{Camera, ErrorBudget, Placement, Quality, Scene, Transition, View};
use relievo_samples::rock;

use super::{Eye, SIZE, Scenery};
use crate::frame::device;
use crate::rays::Triangle;

/// Half of the height that the camera sees.
const HALF: f32 = 0.9;

/// Steps from a level to the next one.
const STEPS: f64 = 511.0;

/// A parallel camera, which allows the same displacement everywhere.
fn camera() -> Camera {
    let target = Vec3::new(0.0, 0.6, 0.0);
    let wide = HALF * SIZE[0] as f32 / SIZE[1] as f32;
    Camera {
        clip_from_view: glam::camera::rh::proj::directx::orthographic(-wide, wide, -HALF, HALF, 0.5, 20.0),
        ..Camera::looking_at(target + Vec3::new(4.0, 1.5, 3.0), target, 0.8, [0.05, 100.0], SIZE)
    }
}

/// A rock with levels of detail; as a character it moves by a clip.
fn stone(is_character: bool) -> Model {
    let mut model = rock().expect("valid");
    add_levels(&mut model, &[], 1).expect("valid");
    if is_character {
        let vector = |x: f32, y: f32| [x, y, 0.0, 0.0];
        let values = vec![vector(0.0, 0.0), vector(0.3, 0.1)];
        let keys = Keys { interpolation: Interpolation::Linear, times: vec![0.0, 1.0], values };
        let bone = BoneKeys { translation: Some(keys), rotation: None, scale: None };
        model.clips = vec![Clip::new("move", &model.skeleton, &[bone], 1.0).expect("valid")];
    }
    model
}

/// A level, how many steps it has moved, and the seconds that the clip has played.
type State = (usize, u32, f32);

struct Stage {
    scene: Scene,
    view: View,
    eye: Eye,
    /// The errors of levels 1, 2 …
    errors: Vec<f32>,
    mesh: Mesh,
    coarsest: Vec<u32>,
}

impl Stage {
    fn new(gpu: &Gpu, model: &Model) -> Self {
        let (mut scene, mut view) = super::scene(gpu);
        scene.set_error_budget(ErrorBudget { mesh: 1.0, bones: 0.0, influences: 0.0 }).expect("valid");
        let object = match model.clips.is_empty() {
            true => scene.add_mesh(model, 1),
            false => scene.add_character(model, 1),
        };
        let object = object.expect("added");
        scene.spawn(object, Placement::at([0.0; 3])).expect("room");
        scene.set_level_of_detail(object, &Transition::Geomorph.into()).expect("with partners");
        view.set(camera()).expect("a camera");
        let eye = Eye::new(gpu, &scene);
        let merged = merged(model, 8).expect("valid");
        let mesh = ProgressiveMesh::of_levels(&merged.model.meshes[0]).expect("valid").mesh().clone();
        let coarsest = mesh.coarsest_levels();
        Self { scene, view, eye, errors: merged.errors, mesh, coarsest }
    }

    /// The displacement from which on a level moves.
    fn begin(&self, level: usize) -> f32 {
        1.2 * self.errors.get(level).copied().unwrap_or_else(|| 2.0 * self.errors[self.errors.len() - 1])
    }

    /// The velocities of a frame in a state.
    fn frame(&mut self, (level, steps, seconds): State) -> Vec<[f32; 2]> {
        let [begin, end] = [level, level + 1].map(|level| self.begin(level));
        // The last level does not move, whatever is allowed.
        let allowed = match level < self.errors.len() {
            true => begin + (steps as f32 + 0.25) / STEPS as f32 * (end - begin),
            false => 1.1 * begin,
        };
        // 0.9999 is what a camera keeps back.
        let pixels = allowed * (SIZE[1] as f32 / (2.0 * HALF)) / 0.9999;
        self.view.set_quality(Quality::pixels(pixels)).expect("valid");
        let step = seconds - self.scene.time() as f32;
        self.scene.advance(step).expect("finite");
        self.eye.frame(&mut self.scene, &mut self.view)
    }

    /// Where a vertex of a level is on the screen's side of a state: at that of the state's level that stands for it, and from
    /// there on its way.
    fn place(&self, vertex: u32, (level, steps, seconds): State) -> DVec3 {
        let point = |vertex: u32| Vec3::from(self.mesh.positions[vertex as usize]).as_dvec3();
        let mut standing = vertex;
        while (self.coarsest[standing as usize] as usize) < level {
            standing = self.mesh.partners[standing as usize];
        }
        let way = match self.coarsest[standing as usize] as usize == level && level < self.errors.len() {
            true => f64::from(steps) / STEPS,
            false => 0.0,
        };
        let moved = DVec3::new(0.3, 0.1, 0.0) * f64::from(seconds);
        point(standing).lerp(point(self.mesh.partners[standing as usize]), way) + moved
    }

    /// The triangles of a state, and how each came from another.
    fn scenery(&self, now: State, last: State) -> Scenery {
        let mut scenery = Scenery { now: Vec::new(), to_last: Vec::new() };
        for (tag, corners) in self.mesh.triangles(now.0 as u32).as_chunks::<3>().0.iter().enumerate() {
            let [here, there] = [now, last].map(|state| corners.map(|vertex| self.place(vertex, state)));
            let frame = |[a, b, c]: [DVec3; 3]| {
                let across = (b - a).cross(c - a).normalize_or(DVec3::X);
                DMat4::from_cols((b - a).extend(0.0), (c - a).extend(0.0), across.extend(0.0), a.extend(1.0))
            };
            if frame(here).determinant().abs() > 1e-12 {
                scenery.now.push(Triangle { corners: here, tag, double_sided: false });
                scenery.to_last.push(frame(there) * frame(here).inverse());
            }
        }
        assert!(scenery.to_last.iter().all(|matrix| matrix.col(3).xyz().is_finite()));
        scenery
    }
}

/// Last positions are those of the last frame's level and of how far it had moved: within a level, from a finer one to a
/// coarser one, and back, past several levels too.
#[test]
fn last_positions_are_of_the_last_level() {
    let gpu = device();
    for is_character in [false, true] {
        let mut stage = Stage::new(&gpu, &stone(is_character));
        assert!(stage.errors.len() == 7 && stage.errors.is_sorted_by(|a, b| a < b), "{:?}", stage.errors);
        let mut largest_of_all = 0.0_f64;
        let all = [
            [(2, 100), (2, 400)],
            [(2, 400), (3, 100)],
            [(3, 100), (2, 400)],
            [(0, 300), (5, 60)],
            [(5, 60), (1, 200)],
            [(6, 500), (7, 0)],
            [(7, 0), (3, 256)],
        ];
        let mut seconds = 0.0;
        for [last, now] in all {
            let mut state = |(level, steps): (usize, u32)| {
                seconds += if is_character { 0.03125 } else { 0.0 };
                (level, steps, seconds)
            };
            let (last, now) = (state(last), state(now));
            stage.frame(last);
            let found = stage.frame(now);
            let (seen, largest) = stage.scenery(now, last).check(&found, [&camera(); 2]);
            println!("{last:?} to {now:?}: {seen} pixels, at most {largest}");
            assert!(seen > 500, "{seen} pixels");
            largest_of_all = largest_of_all.max(largest);
            // A surface that had been as it is, but for the clip, is another; the last level's vertices stay.
            let wrong = stage.scenery(now, (now.0, now.1, last.2));
            let is_wrong = std::panic::AssertUnwindSafe(|| wrong.check(&found, [&camera(); 2]));
            let is_noticed = std::panic::catch_unwind(is_wrong).is_err();
            assert!(is_noticed || now.0 == stage.errors.len(), "{last:?} to {now:?}: no motion is needed");
        }
        assert!(largest_of_all > 0.005, "{largest_of_all}");
    }
}

/// Where one level becomes the next nothing has moved, and neither has what the view did not show before.
#[test]
fn a_change_of_level_is_no_motion() {
    let gpu = device();
    let mut stage = Stage::new(&gpu, &stone(false));
    let largest = |found: &[[f32; 2]]| {
        let seen: Vec<_> = found.iter().filter(|found| found[0] != 7.0).flatten().collect();
        assert!(seen.len() > 1000, "{} pixels", seen.len() / 2);
        seen.into_iter().fold(0.0_f32, |largest, value| largest.max(value.abs()))
    };
    for level in 0..7 {
        for [last, now] in [[(level, 511), (level + 1, 0)], [(level + 1, 0), (level, 511)]] {
            stage.frame((last.0, last.1, 0.0));
            let most = largest(&stage.frame((now.0, now.1, 0.0)));
            assert!(most < 2e-6, "{last:?} to {now:?}: {most}");
        }
    }
    // A view that looked away, and back at another level.
    let away =
        Camera::looking_at(Vec3::new(0.0, 3.0, 9.0), Vec3::new(0.0, 3.0, 90.0), 0.7, [0.5, 60.0], SIZE);
    stage.frame((4, 100, 0.0));
    stage.view.set(away).expect("a camera");
    let nothing = stage.frame((4, 100, 0.0));
    assert!(nothing.iter().all(|found| found[0] == 7.0), "it looks away");
    stage.view.set(camera()).expect("a camera");
    stage.frame((2, 300, 0.0));
    let most = largest(&stage.frame((2, 300, 0.0)));
    assert!(most < 2e-6, "{most}");
}
