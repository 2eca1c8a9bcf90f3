//! Levels of detail of parts that are drawn one by one.

use relievo::asset::material::Alpha;

use super::{Stage, difference, models};
use crate::frame::device;
use relievo::scene::Transition;

/// Blended surfaces move as others do: no pixel changes at a change of level, and in between they are on their way.
#[test]
fn transparent_parts_move_too() {
    let gpu = device();
    for (mut model, size) in models() {
        if model.materials.is_empty() {
            model.materials.push(crate::rays::plain([0.8, 0.5, 0.3, 1.0], Alpha::Opaque));
            model.meshes.iter_mut().for_each(|mesh| mesh.material = Some(0));
        }
        assert!(model.meshes.iter().all(|mesh| mesh.material.is_some()), "a part that is opaque");
        for material in &mut model.materials {
            (material.alpha, material.color[3]) = (Alpha::Blended, 0.5);
        }
        let mut stage = Stage::new(&gpu, &model, size, Transition::Geomorph);
        let mut hard = Stage::new(&gpu, &model, size, Transition::Hard);
        let levels = stage.errors.len();
        let mut last = stage.draw(0.0);
        assert!(last == hard.draw(0.0), "level 0");
        let mut opaque = model.clone();
        opaque.materials.iter_mut().for_each(|material| material.alpha = Alpha::Opaque);
        assert!(last != Stage::new(&gpu, &opaque, size, Transition::Hard).draw(0.0), "nothing is blended");
        for level in 0..levels {
            let [begin, end] = [level, level + 1].map(|level| stage.begin(level));
            let after = stage.draw(begin + 1e-4 * (end - begin));
            assert!(after == last, "level {level} begins with a jump of {}", difference(&after, &last));
            let middle = stage.draw(0.5 * (begin + end));
            last = stage.draw(begin + 0.9999 * (end - begin));
            assert!(middle != after && middle != last, "level {level} does not move");
            let reached = hard.draw(begin + 1e-4 * (end - begin));
            assert!(last == reached, "level {} is off by {}", level + 1, difference(&last, &reached));
        }
    }
}
