//! Criteria, hysteresis, forced levels and culling: thesis A's cases.

use glam::{Quat, Vec3};
use relievo::InputError;
use relievo::scene::{
    Criterion, Culling, DistanceTo, LevelChoice, LevelOfDetail, Pace, Perceptual, Placement, SizeOf,
    Transition,
};

use crate::stage::{SIZE, Stage, looking_from};

fn by(criterion: Criterion) -> LevelOfDetail {
    LevelOfDetail { choice: LevelChoice::By(criterion), ..LevelOfDetail::default() }
}

fn distances(from: &[f32]) -> LevelOfDetail {
    by(Criterion::Distance { to: DistanceTo::Center, from: from.to_vec() })
}

#[test]
fn distances_choose_levels() {
    let at = |depth: f32| Placement::at([0.0, 0.0, 10.0 - depth]);
    let depths = [5.0, 9.0, 11.0, 19.0, 21.0, 39.0, 41.0, 400.0];
    let mut stage = Stage::of_mesh(&distances(&[10.0, 20.0, 40.0]), &depths.map(at));
    let found = stage.levels_now();
    // The middle of the rock's sphere is within a unit of its place, and of the camera's height.
    assert_eq!(found, [0, 0, 1, 1, 2, 2, 3, 3].map(Some));
    let listed = stage.listed();
    assert_eq!(listed, [2, 2, 2, 2, 0, 0, 0, 0]);
    // To a point of the model two units ahead, and as if everything were half as far away.
    let to = DistanceTo::Point(Vec3::Z * 2.0);
    let criterion = Criterion::Distance { to, from: vec![10.0, 20.0, 40.0] };
    stage.scene.set_level_of_detail(stage.object, &by(criterion)).expect("valid");
    stage.view.cut();
    assert_eq!(stage.levels_now(), [0, 0, 0, 1, 1, 2, 2, 3].map(Some));
    let near = LevelOfDetail { bias: 0.5, ..distances(&[10.0, 20.0, 40.0]) };
    stage.scene.set_level_of_detail(stage.object, &near).expect("valid");
    stage.view.cut();
    assert_eq!(stage.levels_now(), [0, 0, 0, 0, 1, 1, 2, 3].map(Some));
}

/// An object scaled three times at distance 500: distance does not react, size does (A section 6.5).
#[test]
fn size_sees_scale_and_distance_does_not() {
    let placements = [1.0, 3.0].map(|scale| Placement::at([0.0, 0.0, -490.0]).scaled(scale));
    let mut stage = Stage::of_mesh(&distances(&[100.0, 300.0, 900.0]), &placements);
    assert_eq!(stage.levels_now(), [Some(2); 2]);
    // The areas of both spheres as fractions of the viewport, and one between them.
    for of in [SizeOf::Sphere, SizeOf::Box] {
        let level = |area: f32| {
            let criterion = Criterion::Size { of, below: vec![area] };
            let mut stage = Stage::of_mesh(&by(criterion), &placements);
            stage.levels_now().into_iter().map(|level| level.expect("seen")).collect::<Vec<_>>()
        };
        let least = |wanted: [u32; 2]| {
            (0..60).map(|step| 1e-7 * 1.4_f32.powi(step)).find(|area| level(*area) == wanted)
        };
        let (one, both) = (least([1, 0]).expect("between"), least([1, 1]).expect("above both"));
        assert!((6.0..13.0).contains(&(both / one)), "{of:?}: nine times the area, {one} and {both}");
    }
}

/// A long object turns at a threshold: the area of its box changes, that of its sphere does not (A section 6.2).
#[test]
fn a_turning_object_changes_the_box_and_not_the_sphere() {
    let mut changes = Vec::new();
    for of in [SizeOf::Box, SizeOf::Sphere] {
        let place = |angle: f32| Placement {
            turn: Quat::from_rotation_y(angle),
            scale: Vec3::new(6.0, 1.0, 1.0),
            ..Placement::at([0.0, 0.0, -30.0])
        };
        // A threshold between the areas seen from the side and from the end; the middle of what the box has.
        let mut counted = 0;
        for area in (0..40).map(|step| 2e-4 * 1.2_f32.powi(step)) {
            let level = LevelOfDetail { hysteresis: 0.0, ..by(Criterion::Size { of, below: vec![area] }) };
            let mut stage = Stage::of_mesh(&level, &[place(0.0)]);
            let mut seen = Vec::new();
            for step in 0..12 {
                let placement = place(step as f32 * std::f32::consts::PI / 12.0);
                stage.scene.move_to(stage.instances[0], placement).expect("there");
                seen.push(stage.levels_now()[0].expect("seen"));
            }
            counted += seen.windows(2).filter(|pair| pair[0] != pair[1]).count();
        }
        changes.push(counted);
    }
    assert!(changes[0] > 4, "{changes:?}: the box switches");
    assert_eq!(changes[1], 0, "{changes:?}: the sphere does not");
}

/// Thesis A, section 7.2: a camera that trembles by 1 % at a threshold changes no level after the first cycle; without
/// hysteresis it changes in every one. Of two objects at one place, that were entered from both sides, each keeps its level.
#[test]
fn hysteresis_holds_levels() {
    let criteria = [
        Criterion::Distance { to: DistanceTo::Center, from: vec![100.0] },
        Criterion::Magnification { below: vec![SIZE[1] as f32 / 2.0 / 0.175_f32.tan() / 100.0] },
        Criterion::Error,
    ];
    for criterion in criteria {
        let changes = |hysteresis: f32| {
            let level = LevelOfDetail { hysteresis, ..by(criterion.clone()) };
            let mut stage = Stage::of_mesh(&level, &[Placement::at([0.0; 3])]);
            // Levels change at some distance; the camera trembles around it.
            let mut threshold = 100.0;
            if criterion == Criterion::Error {
                let probe = |stage: &mut Stage, distance: f32| {
                    stage.view.set(looking_from(distance)).expect("a camera");
                    stage.view.cut();
                    stage.levels_now()[0].expect("seen")
                };
                let first = probe(&mut stage, 20.0);
                threshold = (1..400)
                    .map(|step| 20.0 + step as f32)
                    .find(|distance| probe(&mut stage, *distance) != first)
                    .expect("another level")
                    - 0.5;
                stage.view.cut();
            }
            let mut seen = Vec::new();
            for frame in 0..60 {
                let factor = 1.0 + 0.01 * (frame as f32 * std::f32::consts::TAU / 12.0).sin();
                stage.view.set(looking_from(threshold * factor)).expect("a camera");
                seen.push(stage.levels_now()[0].expect("seen"));
            }
            let after_first = seen[12..].windows(2).filter(|pair| pair[0] != pair[1]).count();
            (after_first, stage)
        };
        assert_eq!(changes(0.1).0, 0, "{criterion:?} with hysteresis");
        let without = changes(0.0).0;
        assert!(without >= 6, "{criterion:?} without hysteresis: {without} changes in four cycles");
    }
}

/// Two objects at the same place, of which one came from afar and one from nearby; a cut makes both the same.
#[test]
fn objects_keep_the_level_that_they_came_with() {
    let place = |depth: f32| Placement::at([0.0, 0.0, 10.0 - depth]);
    let mut stage = Stage::of_mesh(&distances(&[100.0]), &[place(80.0), place(120.0)]);
    assert_eq!(stage.levels_now(), [Some(0), Some(1)]);
    for instance in stage.instances.clone() {
        stage.scene.move_to(instance, place(100.5)).expect("there");
    }
    assert_eq!(stage.levels_now(), [Some(0), Some(1)]);
    assert_eq!(stage.levels_now(), [Some(0), Some(1)], "in every frame");
    stage.view.cut();
    assert_eq!(stage.levels_now(), [Some(1); 2]);
    for instance in stage.instances.clone() {
        stage.scene.move_to(instance, place(88.0)).expect("there");
    }
    assert_eq!(stage.levels_now(), [Some(0); 2], "beyond the interval");
}

#[test]
fn forced_levels_and_culling_are_for_debugging() {
    let behind = Placement::at([0.0, 0.0, 500.0]);
    let near = Placement::at([0.0, 0.0, 8.0]);
    for level in [0, 3, 6] {
        let forced = LevelOfDetail { choice: LevelChoice::Forced(level), ..LevelOfDetail::default() };
        let mut stage = Stage::of_mesh(&forced, &[near, behind]);
        assert_eq!(stage.levels_now(), [Some(level), None]);
        let all = LevelOfDetail { culling: Culling::Never, ..forced };
        stage.scene.set_level_of_detail(stage.object, &all).expect("valid");
        assert_eq!(stage.levels_now(), [Some(level); 2]);
        assert_eq!(stage.scene.level_of_detail(stage.object), Ok(&all));
    }
}

/// What crosses the picture or lies at its edge is coarser, as the factor says; and the report says so.
#[test]
fn perceptual_factors_coarsen() {
    let perceptual = Perceptual { motion: 0.0, periphery: 1.0 };
    let level = LevelOfDetail { perceptual, hysteresis: 0.0, ..distances(&[30.0, 60.0]) };
    // In the middle, and half a picture's height above it: twice as far.
    let up = 0.175_f32.tan() * 40.0;
    let placements = [[0.0, 0.0, -30.0], [0.0, up, -30.0]].map(Placement::at);
    let mut stage = Stage::of_mesh(&level, &placements);
    assert_eq!(stage.levels_now(), [Some(1), Some(2)]);
    let pixels = stage.statistics().pixels;
    assert!(pixels > 1.0, "{pixels}: an error may be larger");
    let moving = LevelOfDetail {
        perceptual: Perceptual { motion: 1.0, periphery: 0.0 },
        hysteresis: 0.0,
        ..distances(&[30.0, 60.0])
    };
    let mut stage = Stage::of_mesh(&moving, &[Placement::at([0.0, 0.0, -30.0]); 2]);
    assert_eq!(stage.levels_now(), [Some(1); 2]);
    // A picture's height is 2 · up high; one moves through it in a second, in steps of a tenth.
    for step in 1..4 {
        stage.scene.advance(0.1).expect("finite");
        let placement = Placement::at([0.2 * up * step as f32, 0.0, -30.0]);
        stage.scene.move_to(stage.instances[0], placement).expect("there");
        assert_eq!(stage.levels_now(), [Some(2), Some(1)], "step {step}");
    }
    stage.scene.advance(0.1).expect("finite");
    assert_eq!(stage.levels_now(), [Some(1); 2], "it stands");
}

#[test]
fn mistakes_are_refused_by_field_and_nothing_changes() {
    let mut stage = Stage::of_mesh(&LevelOfDetail::default(), &[Placement::at([0.0; 3])]);
    let size = |below: &[f32]| by(Criterion::Size { of: SizeOf::Box, below: below.to_vec() });
    let ratio = |near, far| by(Criterion::Ratio { to: DistanceTo::Center, near, far });
    let with = |change: fn(&mut LevelOfDetail)| {
        let mut changed = distances(&[10.0]);
        change(&mut changed);
        changed
    };
    let wrong = [
        (distances(&[10.0, 5.0]), "criterion.from[1]", "5"),
        (distances(&[0.0]), "criterion.from[0]", "0"),
        (distances(&[f32::NAN]), "criterion.from[0]", "NaN"),
        (distances(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]), "criterion.from.len", "8"),
        (size(&[0.1, 0.2]), "criterion.below[1]", "0.2"),
        (size(&[-0.1]), "criterion.below[0]", "-0.1"),
        (ratio(-1.0, 2.0), "criterion.near", "-1"),
        (ratio(10.0, 10.0), "criterion.far", "10"),
        (with(|it| it.hysteresis = 1.0), "hysteresis", "1"),
        (with(|it| it.bias = 0.0), "bias", "0"),
        (with(|it| it.rank = Some(8)), "rank", "8"),
        (with(|it| it.perceptual.motion = -1.0), "perceptual.motion", "-1"),
        (with(|it| it.perceptual.periphery = f32::INFINITY), "perceptual.periphery", "inf"),
        (with(|it| it.choice = LevelChoice::Forced(8)), "choice.level", "8"),
        (with(|it| it.transition = Transition::Dither(Pace::Band(1.0))), "transition.band", "1"),
        (with(|it| it.transition = Transition::FadeIn(Pace::Seconds(0.0))), "transition.seconds", "0"),
        (with(|it| it.transition = Transition::Alpha { opaque: 9.0, gone: 8.0 }), "transition.gone", "8"),
        (Transition::Alpha { opaque: 600.0, gone: 800.0 }.into(), "transition", "alpha"),
    ];
    for (level_of_detail, path, value) in wrong {
        let refused = stage.scene.set_level_of_detail(stage.object, &level_of_detail).expect_err(path);
        let relievo::Error::Input(InputError { path: found, value: found_value, bound }) = refused else {
            panic!("{path}: {refused}")
        };
        assert_eq!((&*found, &*found_value), (path, value));
        assert!(bound.len() > 5, "{path}: {bound}");
        assert_eq!(stage.scene.level_of_detail(stage.object), Ok(&LevelOfDetail::default()));
    }
}
