//! The displacement of levels of detail that move into each other.

use relievo::measure::{Displacement, DisplacementMeter};
use relievo::scene::Transition;

use super::{Stage, models};
use crate::frame::device;

/// A stage, and who measures it.
struct Measured {
    stage: Stage,
    meter: DisplacementMeter,
}

impl Measured {
    fn new(stage: Stage, model: &relievo::asset::Model) -> Self {
        let mut meter = DisplacementMeter::new();
        meter.watch(&stage.scene, stage.object, model).expect("the object's model");
        Self { stage, meter }
    }

    fn at(&mut self, allowed: f32) -> Displacement {
        self.stage.draw(allowed);
        self.meter.measure(&self.stage.scene, &self.stage.view).expect("measured")
    }
}

/// On its way, a surface is hardly further off than what is allowed; at its end it is as far off as the coarser level, of which it
/// has all samples, and those of triangles that have lost their area; and what is measured does not jump where levels change.
#[test]
fn displacement_on_the_way_is_measured() {
    let gpu = device();
    for (model, size) in models() {
        let stage = |transition| Measured::new(Stage::new(&gpu, &model, size, transition), &model);
        let (mut soft, mut hard) = (stage(Transition::Geomorph), stage(Transition::Hard));
        let mut beyond = 0.0_f64;
        let (mut moved, mut worst, levels) = (0, 0.0_f64, soft.stage.errors.len());
        for level in 0..levels {
            let [begin, end] = [level, level + 1].map(|level| soft.stage.begin(level));
            let at = |part: f32| begin + part * (end - begin);
            let [first, second, last] = [1e-4, 0.5, 0.9999].map(|part| soft.at(at(part)));
            for found in [first, second, last] {
                assert_eq!(found.levels[level], 1, "level {level}: {found:?}");
                beyond = beyond.max(found.largest / f64::from(found.pixels));
            }
            assert!(first.jump < 1e-2, "level {level} begins with a jump: {first:?}");
            moved += usize::from((second.largest - first.largest).abs() > 1e-4 && second.jump > 1e-4);
            let reached = hard.at(at(1e-4));
            assert_eq!(reached.levels[level + 1], 1, "{reached:?}");
            let least = reached.largest - 1e-3;
            assert!(last.largest >= least, "level {level}: {last:?}, not {reached:?}");
            worst = worst.max(last.largest / reached.largest);
        }
        println!("at the ends at most {worst} of the coarser level's displacement");
        println!("on the way at most {beyond} of what is allowed");
        assert!(worst < 1.3 && beyond < 1.25, "{worst}, {beyond}");
        assert!(moved + 2 > levels, "what moves is not measured: {moved} of {levels}");
    }
}
