//! Objects whose levels of detail another program made: each level shows one model, all transitions but the geomorph work, and
//! the view keeps its pixels.

use std::panic::catch_unwind;
use std::sync::LazyLock;

use glam::Vec3;
use relievo::Error;
use relievo::asset::Model;
use relievo::ops::skinning::join_levels;
use relievo::scene::{Camera, LevelChoice, LevelOfDetail, Placement, Quality, Ray, Transition};
use relievo_lab::measure::DisplacementMeter;
use relievo_samples::rock;

use crate::foreign::{SHARES, files, joined_creature, joined_rock, levels_of, read, walker};
use crate::stage::{SIZE, Shot, Stage, looking_from};
use crate::transitions::{
    Kind, dithers, ends_in_time, hides_background, leaves_no_trace, shows_the_heavier_level,
};

static ROCK: LazyLock<Model> = LazyLock::new(joined_rock);
static CREATURE: LazyLock<Model> = LazyLock::new(joined_creature);

fn of_rock(level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Stage {
    Stage::of_model(&ROCK, level_of_detail, placements)
}

fn of_creature(level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Stage {
    Stage::of_model(&CREATURE, level_of_detail, placements)
}

const KINDS: [Kind; 2] = [of_rock, of_creature];

/// A planted fault: in transitions, the coarsest level has lost every second triangle.
fn of_torn_rock(level_of_detail: &LevelOfDetail, placements: &[Placement]) -> Stage {
    let mut rock = ROCK.clone();
    if matches!(level_of_detail.choice, LevelChoice::By(_)) {
        let coarsest = &mut rock.meshes[3].levels[2].indices;
        *coarsest = coarsest.chunks(6).flat_map(|pair| &pair[..3]).copied().collect();
    }
    Stage::of_model(&rock, level_of_detail, placements)
}

/// Runs a check of both kinds, which must fail for the planted fault.
fn check(check: fn(Kind)) {
    KINDS.into_iter().for_each(check);
    assert!(catch_unwind(|| check(of_torn_rock)).is_err(), "the fault is not found");
}

#[test]
fn joined_levels_dither() {
    check(dithers);
}

#[test]
fn joined_levels_leave_no_trace() {
    check(leaves_no_trace);
    // The creature moves meanwhile.
    ends_in_time(of_rock);
    assert!(catch_unwind(|| ends_in_time(of_torn_rock)).is_err(), "the fault is not found");
}

#[test]
fn joined_levels_hide_the_background() {
    check(hides_background);
}

#[test]
fn layers_show_the_heavier_joined_level() {
    check(shows_the_heavier_level);
}

#[test]
fn joined_levels_do_not_geomorph() {
    for kind in KINDS {
        let mut stage = kind(&LevelOfDetail::default(), &[Placement::at([0.0; 3])]);
        assert!(!stage.scene.can_morph(stage.object).expect("the object"));
        let found = stage.scene.set_level_of_detail(stage.object, &Transition::Geomorph.into());
        let Err(Error::Input(found)) = found else { panic!("not refused") };
        assert_eq!((&*found.path, &*found.value), ("object.levels", "4"));
    }
}

fn forced(level: u32) -> LevelOfDetail {
    LevelOfDetail { choice: LevelChoice::Forced(level), ..LevelOfDetail::default() }
}

/// A picture of an object at a level, exactly.
fn picture(model: &Model, level: u32) -> (image::RgbaImage, u64) {
    let mut stage = Stage::of_model(model, &forced(level), &[Placement::at([0.0; 3])]);
    stage.view.set_quality(Quality::pixels(0.0)).expect("in range");
    stage.view.set(looking_from(4.0)).expect("a camera");
    let shot = Shot::colors(&stage);
    let picture = stage.picture(&shot);
    (picture, stage.statistics().objects[0].levels.iter().map(|level| level.triangles).sum())
}

/// At each level, the picture is that of the level's own model, to the bit.
#[test]
fn each_joined_level_is_drawn_as_its_own_model() {
    let all =
        [(&*ROCK, levels_of(rock().expect("valid"), &SHARES)), (&*CREATURE, levels_of(walker(), &SHARES))];
    for (joined, models) in all {
        let alone: Vec<_> = models.iter().map(|model| picture(model, 0)).collect();
        for (level, alone) in alone.iter().enumerate() {
            let found = picture(joined, level as u32);
            assert!(found.0 == alone.0, "level {level}");
            assert_eq!(found.1, alone.1, "triangles at level {level}");
        }
        // The comparison tells levels apart.
        assert!(alone.windows(2).all(|pair| pair[0].0 != pair[1].0));
    }
}

/// A ray hits the finest level, whatever level is drawn.
#[test]
fn rays_hit_the_finest_joined_level() {
    let models = [ROCK.clone(), rock().expect("valid"), levels_of(rock().expect("valid"), &[0.04]).remove(1)];
    let stage = |at: usize| {
        let level = if at == 0 { 3 } else { 0 };
        Stage::of_model(&models[at], &forced(level), &[Placement::at([0.0; 3])])
    };
    let stages = [0, 1, 2].map(stage);
    let camera =
        Camera::looking_at(Vec3::new(1.0, 2.0, 4.0), Vec3::new(0.0, 0.4, 0.0), 0.5, [0.1, 90.0], SIZE);
    let ray = |at: u16| Ray::through(&camera, [f32::from(32 + 16 * (at % 5)), f32::from(32 + 16 * (at / 5))]);
    let hit = |stage: &Stage, at: u16| {
        let found = stage.scene.pick(&ray(at).expect("a pixel")).expect("valid");
        found.map(|hit| hit.distance)
    };
    let hits = stages.each_ref().map(|stage| (0..25).map(|at| hit(stage, at)).collect::<Vec<_>>());
    assert!(hits[0].iter().flatten().count() > 8 && hits[0] == hits[1] && hits[0] != hits[2], "{hits:?}");
}

/// The largest displacement of instances at many distances, in pixels, and the levels that were drawn.
fn displacement(model: &Model) -> (f64, Vec<u64>) {
    let placements: Vec<Placement> = (0..24)
        .map(|at| {
            let far = 1.5 * 1.25_f32.powi(at);
            Placement::at([0.35 * far * (-1.0_f32).powi(at), 0.0, -far]).turned(0.7 * at as f32)
        })
        .collect();
    let mut stage = Stage::of_model(model, &LevelOfDetail::default(), &placements);
    let mut meter = DisplacementMeter::new();
    meter.watch(&stage.scene, stage.object, model).expect("the object's model");
    let eye = Vec3::new(0.0, 0.8, 1.5);
    let camera = Camera::looking_at(eye, eye - Vec3::Z, 0.9, [0.05, 900.0], [640, 480]);
    stage.view.set(camera).expect("a camera");
    let (mut largest, mut levels) = (0.0_f64, vec![0; 8]);
    for _ in 0..5 {
        stage.record();
        let found = meter.measure(&stage.scene, &stage.view).expect("measured");
        assert!(
            found.samples > 1000 && found.missing == 0 && 1000 * found.left_out <= found.samples,
            "{found:?}"
        );
        largest = largest.max(found.largest);
        levels.iter_mut().zip(found.levels).for_each(|(all, own)| *all += own);
        stage.scene.advance(0.17).expect("finite");
    }
    (largest, levels)
}

fn check_pixels(name: &str, model: &Model) {
    let (largest, levels) = displacement(model);
    println!("{name}: {largest:.3} pixels, instances by level {levels:?}");
    assert!(largest <= 1.0, "{name}: {largest} pixels");
    assert!(levels.iter().filter(|instances| **instances > 0).count() == model.meshes[0].levels.len() + 1);
}

#[test]
fn joined_levels_keep_their_pixels() {
    check_pixels("rock", &ROCK);
    check_pixels("creature", &CREATURE);
    // The measurement finds errors that are a third of what is right.
    let mut wrong = ROCK.clone();
    wrong.meshes.iter_mut().flat_map(|mesh| &mut mesh.levels).for_each(|level| level.error /= 3.0);
    assert!(displacement(&wrong).0 > 1.2);
}

/// `RELIEVO_LEVELS=near.glb:far.glb cargo test --test lod foreign_files -- --ignored --nocapture`
#[test]
#[ignore = "needs files"]
fn foreign_files_keep_their_pixels() {
    check_pixels("files", &join_levels(&read(&files())).expect("joined"));
}
