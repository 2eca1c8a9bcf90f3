//! The guarantee of the `bounded` gate for vertices: a largest error on screen.

use relievo::asset::keyframe::RotationPath;
use relievo::asset::mesh::bone_radii;
use relievo::asset::transform::Affine;
use relievo::asset::{Clip, Model};
use relievo::ops::animation::instance::Instance;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::order::Order;
use relievo::ops::animation::{AnimatedBones, BoundTable, ClipSet, Frame, Gate, Projection};
use relievo::ops::skinning::clusters::Clusters;
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::select::reference::{Now, Skinned, select};
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::Blend;
use relievo::ops::skinning::vertex::Vertex;
use relievo_lab::crowd::Crowd;

use crate::shapes::model;

/// Where instances stand in the camera's space, metres: near and far, on the view axis and well off it.
const PLACES: [[f32; 3]; 5] =
    [[0.0, -1.0, 6.0], [4.0, 0.0, 7.0], [-9.0, 2.0, 12.0], [0.5, -1.0, 40.0], [-30.0, -5.0, 60.0]];

struct Stage {
    model: Model,
    set: ClipSet,
    order: Order,
    bounds: BoundTable,
    bounded: Gate,
    off: Gate,
}

impl Stage {
    fn new() -> Self {
        let model = model();
        let clips: Vec<&Clip> = model.clips.iter().collect();
        let set = ClipSet::new(&clips).expect("one skeleton");
        let order = Order::new(&model.skeleton);
        let bone_radii = bone_radii(model.skeleton.len(), &model.skins, &model.meshes);
        let bounds = BoundTable::new(&model.skeleton, &set, &clips, &bone_radii, RotationPath::Slerp);
        let bounds = bounds.expect("fits");
        let off = Gate::Off(AnimatedBones::new(&order, &set, &clips).expect("fits"));
        Self { bounded: Gate::Bounded(bounds.clone()), bounds, off, set, order, model }
    }

    fn crowd<'a>(&'a self, gate: &'a Gate, instances: &[Instance]) -> Crowd<'a> {
        Crowd::new(&self.order, &self.set, gate, RotationPath::Slerp, instances.to_vec()).expect("one path")
    }

    fn vertices(&self, models: &[Affine]) -> Vec<Vertex> {
        let mesh = &self.model.meshes[0];
        let palette = palette_for(&self.model.skins[mesh.skin], models, Blend::Linear);
        skin(&morph(mesh, &mesh.weights), &mesh.influences, &palette, InstanceLod::FULL)
    }
}

/// The largest distance of a vertex from its place on screen, in pixels.
fn off_screen(projection: &Projection, place: [f32; 3], stale: &[Vertex], fresh: &[Vertex]) -> f64 {
    let screen = |vertex: &Vertex| {
        let [x, y, z] = std::array::from_fn(|i| f64::from(vertex.position[i]) + f64::from(place[i]));
        [x / z, y / z].map(|at| at * f64::from(projection.focal_pixels))
    };
    let off = |(stale, fresh): (&Vertex, &Vertex)| {
        let ([ax, ay], [bx, by]) = (screen(stale), screen(fresh));
        (ax - bx).hypot(ay - by)
    };
    stale.iter().zip(fresh).map(off).fold(0.0, f64::max)
}

/// Pixels from 0.25 to 8; loops, clamps, reverse play, changed clips, frames of 1 to 100 ms.
#[test]
fn no_vertex_is_further_off_than_the_pixels_allow() {
    let stage = Stage::new();
    let projection = Projection::new(1080, 1.0, 0.1);
    let mut largest = 0.0_f64;
    for (case, pixels) in [0.25_f32, 0.5, 1.0, 2.0, 4.0, 8.0].into_iter().enumerate() {
        let play = |at: usize, clip: usize| {
            let wrap = if at == 3 { Wrap::Clamp } else { Wrap::Loop };
            Instance::new(clip as u32 % 3, wrap, 0.3 * at as f32, [1.0, -1.0, 0.5, 1.0, 1.75][at])
        };
        let instances: Vec<_> = (0..PLACES.len()).map(|at| play(at, at + case)).collect();
        let mut lazy = stage.crowd(&stage.bounded, &instances);
        let mut full = stage.crowd(&stage.off, &instances);
        for (lod, place) in lazy.lods.iter_mut().zip(PLACES) {
            lod.allowed = stage.bounds.units(projection.allowed(place, stage.bounds.radius(), pixels));
            assert!(lod.allowed > 0, "{place:?} is too near");
        }
        let mut elapsed = 0.0;
        for number in 0..40_u32 {
            elapsed += [0.001, 0.016, 0.033, 0.1, 0.007, 0.05, 0.022][number as usize % 7];
            if number == 20 {
                (lazy.instances[1], full.instances[1]) = (play(1, 2), play(1, 2));
            }
            let ahead = [0.016, 0.05, 0.0, 0.016][case % 4];
            let frame = Frame { ticks: number, frame_ticks: 1, frame: number, ahead };
            lazy.advance(&frame, elapsed);
            full.advance(&frame, elapsed);
            // Each frame checks one instance, because skinning takes most of the time.
            let at = number as usize % PLACES.len();
            let own = at * stage.model.skeleton.len()..(at + 1) * stage.model.skeleton.len();
            let vertices = |models: &[Affine]| stage.vertices(&models[own.clone()]);
            let off = off_screen(
                &projection,
                PLACES[at],
                &vertices(&lazy.model_matrices),
                &vertices(&full.model_matrices),
            );
            assert!(off <= f64::from(pixels) + 0.01, "{pixels} allowed, {off} found, at {:?}", PLACES[at]);
            largest = largest.max(off / f64::from(pixels));
        }
    }
    assert!(largest > 0.3, "far too careful: {largest} of what is allowed");
}

/// Vertices of bones that a gate skips need not be skinned again: its updated bones select the clusters, and
/// the vertices of all others stay unchanged.
#[test]
fn clusters_without_a_dirty_bone_stay() {
    let stage = Stage::new();
    let mesh = &stage.model.meshes[0];
    let clusters = Clusters::new(mesh, &stage.model.skins, &stage.model.skeleton).expect("fits");
    let mut crowd = stage.crowd(&stage.bounded, &[Instance::new(2, Wrap::Loop, 0.0, 1.0)]);
    crowd.lods[0].allowed = stage.bounds.units(0.2);
    let mut before: Option<Vec<Vertex>> = None;
    let mut skipped = 0;
    for number in 0..60_u32 {
        let frame = Frame { ticks: number, frame_ticks: 1, frame: number, ahead: 1.0 / 60.0 };
        let work = crowd.advance(&frame, number as f32 / 60.0);
        let now = stage.vertices(&crowd.model_matrices);
        let current =
            Now { updated_bones: &work.updated_bones, instance_lods: &[InstanceLod::FULL], weights: &[] };
        let last = Skinned { instance_lod: InstanceLod::FULL, ..Skinned::nothing(0) };
        let chosen = select(&clusters, &current, &[last]);
        if let Some(before) = before.replace(now.clone()) {
            for (cluster, vertices) in clusters.order.chunks(64).enumerate() {
                if !chosen.contains(&(cluster as u32)) {
                    skipped += 1;
                    let same = |at: &u32| before[*at as usize] == now[*at as usize];
                    assert!(vertices.iter().all(same), "cluster {cluster} of frame {number} moved");
                }
            }
        }
    }
    assert!(skipped > 20 * clusters.len(), "{skipped} of {}", 59 * clusters.len());
}
