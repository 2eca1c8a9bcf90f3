//! The reduction of influences: the part of the skinning kernel that removes weak influences and fades their weights.

use crate::asset::influences::Influence;
use crate::skinning::instance_lod::InstanceLod;

/// The influences that remain at a level of detail, the strongest first; their weights sum to 1. `influences` comes
/// from [`Influences::of`](crate::asset::Influences::of). The strongest weight is not read but computed as 1 minus the
/// others.
///
/// # Panics
/// If `instance_lod` allows 0 influences, which marks an invisible instance.
pub fn reduced(influences: &[Influence], instance_lod: InstanceLod) -> Vec<Influence> {
    assert!(instance_lod.max_influences > 0, "not seen");
    let most = influences.len().min(instance_lod.max_influences as usize);
    let lost = influences[most..].iter().fold(0.0, |sum, influence| sum + influence.weight);
    let scale = 1.0 / (1.0 - lost);
    let taken = instance_lod.influence_fade * influences.get(1).map_or(0.0, |second| second.weight);
    let mut left = vec![influences[0]];
    let mut sum = 0.0;
    for influence in &influences[1..most] {
        if influence.weight <= taken {
            break;
        }
        let weight = (influence.weight - taken) * scale;
        sum += weight;
        left.push(Influence { weight, ..*influence });
    }
    left[0].weight = 1.0 - sum;
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::influences::Influences;
    use crate::skinning::FadeRange;

    fn vertex(weights: &[f32]) -> Vec<Influence> {
        let given = (0..).zip(weights).map(|(bone, weight)| Influence { bone, weight: *weight }).collect();
        Influences::new("w", 8, [given]).expect("valid").of(0).to_vec()
    }

    /// Test vertices: with uneven weights, equal weights, a single weight, and a weight close to 0.
    fn vertices() -> Vec<Vec<Influence>> {
        let mut all = vec![vertex(&[1.0]), vertex(&[0.5, 0.5]), vertex(&[0.125; 8]), vertex(&[1.0, 1e-30])];
        for seed in 0..200_u32 {
            let count = 2 + seed % 7;
            let weight = |at: u32| 0.01 + ((seed * 7919 + at * 104_729) % 1000) as f32 / 1000.0;
            all.push(vertex(&(0..count).map(weight).collect::<Vec<_>>()));
        }
        all
    }

    fn sum(influences: &[Influence]) -> f64 {
        influences.iter().map(|influence| f64::from(influence.weight)).sum()
    }

    #[test]
    fn weights_sum_to_one_and_the_weakest_vanish_first() {
        for vertex in vertices() {
            let mut before = vertex.len();
            for step in 0..=64 {
                let left = reduced(&vertex, InstanceLod::fade(step as f32 / 64.0).expect("in range"));
                // A sum of eight terms is rounded seven times, each time by at most half an ulp of 1.
                assert!((sum(&left) - 1.0).abs() <= 7.0 * f64::from(f32::EPSILON) / 2.0, "{left:?}");
                assert!(left.iter().all(|influence| influence.weight > 0.0), "{left:?}");
                assert!(left.is_sorted_by(|a, b| a.weight >= b.weight) && left.len() <= before);
                assert!(left.iter().zip(&vertex).all(|(left, all)| left.bone == all.bone));
                before = left.len();
            }
            assert_eq!(before, 1, "rigid at 1");
        }
    }

    #[test]
    fn no_fade_is_full_quality_and_full_fade_is_rigid() {
        for vertex in vertices() {
            let full = reduced(&vertex, InstanceLod::FULL);
            assert_eq!(reduced(&vertex, InstanceLod::fade(0.0).expect("in range")), full);
            assert_eq!(full[1..], vertex[1..]);
            assert!((full[0].weight - vertex[0].weight).abs() <= 4.0 * f32::EPSILON);
            let rigid = Influence { weight: 1.0, ..vertex[0] };
            assert_eq!(reduced(&vertex, InstanceLod::fade(1.0).expect("in range")), [rigid]);
            assert_eq!(reduced(&vertex, InstanceLod::truncate(1).expect("in range")), [rigid]);
        }
    }

    #[test]
    fn weights_never_jump_while_they_fade() {
        for vertex in vertices() {
            let at = |step: u32| reduced(&vertex, InstanceLod::fade(step as f32 / 1024.0).expect("in range"));
            let second = vertex.get(1).map_or(0.0, |second| second.weight);
            for step in 0..1024 {
                let (a, b) = (at(step), at(step + 1));
                for (slot, before) in a.iter().enumerate().skip(1) {
                    let change = before.weight - b.get(slot).map_or(0.0, |influence| influence.weight);
                    assert!((0.0..=second / 1024.0 + 1e-6).contains(&change), "{change}");
                }
            }
        }
    }

    #[test]
    fn truncation_keeps_the_strongest() {
        let vertex = vertex(&[0.4, 0.3, 0.2, 0.1]);
        let left = reduced(&vertex, InstanceLod::truncate(2).expect("in range"));
        assert_eq!(left.len(), 2);
        assert!((left[0].weight - 4.0 / 7.0).abs() < 1e-6 && (left[1].weight - 3.0 / 7.0).abs() < 1e-6);
        assert_eq!(
            reduced(&vertex, InstanceLod::truncate(4).expect("in range")),
            reduced(&vertex, InstanceLod::FULL)
        );
    }

    #[test]
    fn reductions_are_checked() {
        let field = |result: Result<InstanceLod, crate::InputError>| result.expect_err("refused").path;
        assert_eq!(field(InstanceLod::fade(1.5)), "influence_fade");
        assert_eq!(field(InstanceLod::fade(f32::NAN)), "influence_fade");
        assert_eq!(field(InstanceLod::truncate(0)), "max_influences");
        assert_eq!(field(InstanceLod::truncate(9)), "max_influences");
        assert_eq!(field(InstanceLod::level(16)), "mesh_lod");
        assert_eq!(InstanceLod::level(15), Ok(InstanceLod { mesh_lod: 15, ..InstanceLod::FULL }));
        assert_eq!(
            field(InstanceLod::at_distance(1.0, FadeRange { start: 5.0, end: 5.0 })),
            "fade_range.start"
        );
        let range = FadeRange { start: 10.0, end: 30.0 };
        let fade = |distance| InstanceLod::at_distance(distance, range).expect("in range").influence_fade;
        assert_eq!([fade(0.0), fade(10.0), fade(15.0), fade(30.0), fade(99.0)], [0.0, 0.0, 0.25, 1.0, 1.0]);
    }
}
