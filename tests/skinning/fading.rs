//! Fewer influences with distance, seen on a walking creature.

use glam::Vec3;
use relievo::asset::{Influence, Influences};
use relievo::ops::animation::Projection;
use relievo::ops::skinning::Extent;
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::Palette;
use relievo::ops::skinning::palette::reference::palette;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::Vertex;

use crate::shapes::{model, models};

fn places(vertices: &[Vertex]) -> Vec<Vec3> {
    vertices.iter().map(|vertex| Vec3::from(vertex.position)).collect()
}

/// The largest move between neighbouring λ is bounded: a vertex goes no further than its weights change, times the
/// distance between the places where its bones would have it.
#[test]
fn a_fade_does_not_pop() {
    const STEPS: usize = 256;
    let model = model();
    let mesh = &model.meshes[0];
    let palette = palette(&model.skins[0], &models(&model, "walk", 0.2));
    let vertices = morph(mesh, &[]);
    let whole = Palette::Linear(palette.clone());
    // The place of the vertex if it followed one bone only.
    let alone = |at: usize, bone: u32| {
        let follows = Influences::new("w", 153, [vec![Influence { bone, weight: 1.0 }]]).expect("valid");
        places(&skin(&vertices[at..=at], &follows, &whole, InstanceLod::FULL))[0]
    };
    let bounds: Vec<f32> = (0..mesh.vertices())
        .map(|at| {
            let influences = mesh.influences.of(at);
            let first = alone(at, influences[0].bone);
            let second = influences.get(1).map_or(0.0, |second| second.weight);
            // Every weight but the strongest falls by at most λ's step times the second, and goes to the strongest.
            let moves = influences[1..].iter().map(|other| alone(at, other.bone).distance(first));
            moves.sum::<f32>() * second / STEPS as f32 + 2e-6
        })
        .collect();
    let at = |step: usize| {
        let fade = InstanceLod::fade(step as f32 / STEPS as f32).expect("in range");
        places(&skin(&vertices, &mesh.influences, &whole, fade))
    };
    let mut before = at(0);
    let mut largest = 0.0_f32;
    for step in 1..=STEPS {
        let now = at(step);
        for ((a, b), bound) in before.iter().zip(&now).zip(&bounds) {
            let moved = a.distance(*b);
            assert!(moved <= *bound, "step {step}: {moved} of {bound}");
            largest = largest.max(moved);
        }
        before = now;
    }
    assert!((1e-5..1e-3).contains(&largest), "{largest} m of 1.8 m");
    // Cutting influences off instead of fading moves vertices much further.
    let full = places(&skin(&vertices, &mesh.influences, &whole, InstanceLod::FULL));
    let one = places(&skin(&vertices, &mesh.influences, &whole, InstanceLod::truncate(1).expect("in range")));
    let pop = full.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(pop > 20.0 * largest, "{pop}");
    assert_eq!(before, one, "λ = 1 is rigid");
}

/// The extent of a creature in its clips holds at other times too, and so does the bound of its displacement
/// at every λ.
#[test]
fn extents_hold_all_poses_and_fades() {
    let model = model();
    let mesh = &model.meshes[0];
    let unmorphed = morph(mesh, &[]);
    for (clip, name) in ["walk", "idle", "wave"].into_iter().enumerate() {
        let duration = model.clips[clip].duration();
        let poses = (60.0 * duration) as usize;
        let extent = Extent::new(&model, 0, &[clip], poses).expect("valid");
        let mut largest = [0.0_f32; 2];
        for at in 0..40_u16 {
            let time = duration * (f32::from(at) * 0.618).fract();
            let palette = Palette::Linear(palette(&model.skins[0], &models(&model, name, time)));
            let places_at = |fade: f32| {
                let fade = InstanceLod::fade(fade).expect("in range");
                places(&skin(&unmorphed, &mesh.influences, &palette, fade))
            };
            let full = places_at(0.0);
            for place in &full {
                largest[0] = largest[0].max(place.distance(extent.center) / extent.radius);
            }
            for fade in [1.0, 1.0 / 64.0, 0.3, 0.3 + f32::from(at) / 64.0] {
                let moves = full.iter().zip(places_at(fade)).map(|(a, b)| a.distance(b));
                let stray = moves.fold(0.0, f32::max);
                // A position within 4 m accumulates about 40 roundings.
                assert!(stray <= fade * extent.stray + 1e-5, "{name} at {time}: {stray} at λ = {fade}");
                largest[1] = largest[1].max(stray / (fade * extent.stray));
            }
        }
        assert!((0.9..=1.0).contains(&largest[0]), "{name}: {} of the radius", largest[0]);
        assert!(largest[1] > 0.9, "{name}: {} of what may stray", largest[1]);
    }
}

/// Vertices of creatures at the fade that a range says, anywhere in the picture.
#[test]
fn ranges_keep_the_pixels() {
    let model = model();
    let mesh = &model.meshes[0];
    let unmorphed = morph(mesh, &[]);
    let extent = Extent::new(&model, 0, &[0], 90).expect("valid");
    let projection = Projection::new(1080, 1.047, 0.1);
    let mut largest = 0.0_f32;
    for (pixels, at) in
        [0.25, 0.5, 1.0, 2.0].into_iter().flat_map(|pixels| (0..12).map(move |at| (pixels, at)))
    {
        let range = extent.fade_range(&projection, pixels);
        let depth = [4.0_f32, 9.0, 17.0, 40.0][at % 4];
        // The instance is in the middle of the picture, at an edge, or in a corner.
        let across = [[0.0, 0.0], [960.0, 0.0], [960.0, 540.0]][at / 4];
        let [x, y] = across.map(|edge| edge / projection.focal_pixels * depth);
        let middle = Vec3::new(x, y, depth);
        let time = model.clips[0].duration() * at as f32 / 12.0;
        let palette = Palette::Linear(palette(&model.skins[0], &models(&model, "walk", time)));
        let screen = |instance_lod| {
            let all = places(&skin(&unmorphed, &mesh.influences, &palette, instance_lod));
            let places = all.into_iter().map(|place| place - extent.center + middle);
            places.map(|place| place.truncate() / place.z * projection.focal_pixels).collect::<Vec<_>>()
        };
        let fade = InstanceLod::at_distance(depth * depth / middle.length(), range).expect("in range");
        let full = screen(InstanceLod::FULL);
        for (full, faded) in full.into_iter().zip(screen(fade)) {
            let off = full.distance(faded) / pixels;
            // Positions of thousands of pixels are rounded.
            assert!(off <= 1.0 + 0.002 / pixels, "{off} of {pixels} pixels, {across:?} at {depth}");
            largest = largest.max(off);
        }
    }
    assert!(largest > 0.4, "far too careful: {largest} of what is allowed");
}
