//! Pseudorandom positions from a seed. The generator is counter-based, so positions have the same bits on every machine.

use relievo::InputError;
use relievo::ops::hash::{LANES, key_of, threefry2x32};

use super::entries::Scatter;

/// Number of random positions tried per instance. If they do not suffice, the area has too little ground and is refused.
const DRAWS: u64 = 64;

/// Random position of an instance, and its other random values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Drawn {
    pub x: f64,
    /// The height of the ground at this position.
    pub y: f64,
    pub z: f64,
    /// The angle about the vertical axis, 0 to 2π.
    pub turn: f64,
    pub scale: f32,
    /// The fraction of the clip that the character has played by the start time of its entry.
    pub phase: f64,
}

/// Draws random positions in rectangles of equal size, each given as two corners. `height` returns the height of the ground.
/// Positions where it returns `None` are skipped.
///
/// # Errors
/// [`InputError`] for an area with hardly any ground.
pub(super) fn drawn(
    scatter: &Scatter,
    rectangles: &[[[f64; 2]; 2]],
    height: impl Fn(f64, f64) -> Option<f64>,
) -> Result<Vec<Drawn>, InputError> {
    let key = key_of(&scatter.seed);
    let mut all = Vec::with_capacity(scatter.count as usize);
    let most = DRAWS * u64::from(scatter.count);
    for counter in 0..most.min(u32::MAX.into()) {
        if all.len() == scatter.count as usize {
            break;
        }
        all.extend(one(key, counter as u32, scatter, rectangles, &height));
    }
    if all.len() < scatter.count as usize {
        let area = scatter.area.map(|area| format!("{area:?}")).unwrap_or_default();
        return Err(InputError::new("scatter.area", area, "must lie on the terrain's patches"));
    }
    Ok(all)
}

fn one(
    key: [u32; 2],
    counter: u32,
    scatter: &Scatter,
    rectangles: &[[[f64; 2]; 2]],
    height: impl Fn(f64, f64) -> Option<f64>,
) -> Option<Drawn> {
    let lanes: [u32; LANES] = std::array::from_fn(|lane| lane as u32);
    let (first, second) = threefry2x32(key, [counter; LANES], lanes);
    let fraction = |word: u32| f64::from(word) / 4_294_967_296.0;
    // The index is below the number of rectangles, because fractions are below 1.
    let [low, high] = rectangles[(fraction(second[2]) * rectangles.len() as f64) as usize];
    let between = |axis: usize, word: u32| low[axis] + fraction(word) * (high[axis] - low[axis]);
    let (x, z) = (between(0, first[0]), between(1, second[0]));
    let [least, most] = scatter.scale.map(f64::from);
    Some(Drawn {
        x,
        y: height(x, z)?,
        z,
        turn: std::f64::consts::TAU * fraction(first[1]),
        scale: (least + fraction(second[1]) * (most - least)) as f32,
        phase: fraction(first[2]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scatter(count: u32) -> Scatter {
        Scatter { count, seed: "rocks".to_owned(), area: None, scale: [1.0, 3.0], lift: 0.0 }
    }

    const SQUARE: [[f64; 2]; 2] = [[-2.0, 10.0], [6.0, 14.0]];

    #[test]
    fn places_fill_their_rectangles_and_are_the_same_everywhere() {
        let all = drawn(&scatter(4000), &[SQUARE], |_, _| Some(1.0)).expect("ground");
        let inside = |at: &Drawn| {
            (-2.0..6.0).contains(&at.x) && (10.0..14.0).contains(&at.z) && (1.0..=3.0).contains(&at.scale)
        };
        assert!(all.len() == 4000 && all.iter().all(inside));
        let mean = |of: fn(&Drawn) -> f64| all.iter().map(of).sum::<f64>() / 4000.0;
        // The standard error of these means is below 0.05.
        assert!((mean(|at| at.x) - 2.0).abs() < 0.2 && (mean(|at| at.z) - 12.0).abs() < 0.2);
        assert!(
            (mean(|at| f64::from(at.scale)) - 2.0).abs() < 0.1 && (mean(|at| at.phase) - 0.5).abs() < 0.03
        );
        // A larger count does not move the first places.
        let few = drawn(&scatter(7), &[SQUARE], |_, _| Some(1.0)).expect("ground");
        assert_eq!(few, all[..7]);
        let Drawn { x, z, .. } = few[0];
        assert_eq!([x, z].map(f64::to_bits), KNOWN, "{x}, {z}");
    }

    /// The bits of x and z of the first position for the seed "rocks", computed by a separate implementation of Threefry in
    /// Python. These bits must not change, because other positions would change users' scenes.
    const KNOWN: [u64; 2] = [0x4004_cb01_0040_0000, 0x4024_87f3_4130_0000];

    #[test]
    fn places_without_ground_are_skipped_and_areas_without_are_refused() {
        let half = |x: f64, _: f64| (x > 2.0).then_some(x);
        let all = drawn(&scatter(100), &[SQUARE], half).expect("half of it");
        assert!(all.len() == 100 && all.iter().all(|at| at.x > 2.0 && at.y == at.x));
        assert_eq!(drawn(&scatter(3), &[SQUARE], |_, _| None).expect_err("none").path, "scatter.area");
        let two = [[[0.0, 0.0], [1.0, 1.0]], [[5.0, 0.0], [6.0, 1.0]]];
        let all = drawn(&scatter(100), &two, |_, _| Some(0.0)).expect("ground");
        let west = all.iter().filter(|at| at.x < 1.0).count();
        assert!((30..70).contains(&west) && all.iter().all(|at| at.x < 1.0 || at.x >= 5.0));
    }
}
