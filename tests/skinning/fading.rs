//! Fewer influences with distance, seen on a walking creature.

use glam::Vec3;
use relievo::reference::skinning::morph::morph;
use relievo::reference::skinning::palette::palette;
use relievo::reference::skinning::skin::skin;
use relievo::skinning::palette::Palette;
use relievo::skinning::{Influence, Influences, Reduction, Vertex};

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
    // Where each bone alone would have the vertex.
    let alone = |at: usize, bone: u32| {
        let follows = Influences::new("w", 153, [vec![Influence { bone, weight: 1.0 }]]).expect("valid");
        places(&skin(&vertices[at..=at], &follows, &whole, Reduction::FULL))[0]
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
        let fade = Reduction::fade(step as f32 / STEPS as f32).expect("in range");
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
    // Cutting off pops by far more.
    let full = places(&skin(&vertices, &mesh.influences, &whole, Reduction::FULL));
    let one = places(&skin(&vertices, &mesh.influences, &whole, Reduction::truncate(1).expect("in range")));
    let pop = full.iter().zip(&one).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
    assert!(pop > 20.0 * largest, "{pop}");
    assert_eq!(before, one, "λ = 1 is rigid");
}
