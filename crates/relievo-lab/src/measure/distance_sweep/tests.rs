use relievo::asset::Model;
use relievo_samples::creature;
use relievo_testing::gpu;

use super::*;
use crate::measure::gates::GateName;

/// Near, within the range, and beyond it for every model of both layouts.
const DISTANCES: [f32; 3] = [100.0, 900.0, 2400.0];

/// The largest error in pixels that rounding causes: the device and the host pose bones in another order of operations.
const ROUNDING: f64 = 0.005;

fn small() -> DistanceSweepOptions {
    DistanceSweepOptions {
        instances: 9,
        edge: 300.0,
        distances: DISTANCES.to_vec(),
        frames: 8,
        error_frames: 4,
        drawn_frames: 0,
        ..DistanceSweepOptions::default()
    }
}

fn swept(options: &DistanceSweepOptions) -> DistanceSweepReport {
    let (gpu, model): (_, Model) = (gpu(), creature().expect("built in"));
    let subject = Subject { name: "creature", model: &model, clip: 0 };
    let start = std::time::Instant::now();
    let clock = || start.elapsed().as_secs_f64();
    gpu.block_on(distance_sweep(&gpu, subject, options, &clock, &|_| ())).expect("measured")
}

/// The rows of a mode, by distance.
fn of(layout: &SweepLayout, mode: GateName) -> Vec<SweepRow> {
    layout.rows.iter().filter(|row| row.mode == mode).copied().collect()
}

fn largest(report: &DistanceSweepReport, mode: GateName) -> f64 {
    let rows = report.layouts.iter().flat_map(|layout| of(layout, mode));
    rows.map(|row| row.error.max_pixels).fold(0.0, f64::max)
}

#[test]
fn modes_save_and_err_as_they_say() {
    let report = swept(&DistanceSweepOptions { drawn_frames: 1, ..small() });
    assert_eq!(report.layouts.iter().map(|own| own.layout).collect::<Vec<_>>(), GroupLayout::ALL);
    assert_eq!((report.bones, report.instances), (153, 9));
    for layout in &report.layouts {
        let name = layout.layout.as_str();
        let [off, uniform, skip, bounded] = SWEEP_MODES.map(|mode| of(layout, mode));
        for rows in [&off, &uniform, &skip, &bounded] {
            assert_eq!(rows.iter().map(|row| row.distance).collect::<Vec<_>>(), DISTANCES);
            // Every mode sees the same.
            let visible = |rows: &[SweepRow]| rows.iter().map(|row| row.visible).collect::<Vec<_>>();
            assert_eq!(visible(rows), visible(&off), "{name}");
            assert_eq!(rows[2].visible, 9, "{name}");
            for row in rows {
                assert!(row.error.points > 0 && row.error.rms_pixels <= row.error.max_pixels, "{row:?}");
                assert!(row.update_milliseconds > 0.0 && row.frame_milliseconds > Some(0.0), "{row:?}");
                assert!((row.update_rate * row.update_milliseconds - 1000.0).abs() < 1e-6);
            }
        }
        for row in &off {
            let moving = f64::from(row.visible) * report.animated_bones as f64;
            assert_eq!((row.fraction, row.interpolated), (1.0, moving), "{name}");
            assert!(row.error.max_pixels < ROUNDING, "{name}: {row:?}");
        }
        for rows in [&uniform, &skip] {
            let [near, middle, far] = [0, 1, 2].map(|at| rows[at].fraction);
            assert!(near > middle && middle > far && far == 0.0, "{name}: {near} {middle} {far}");
            assert!(rows[2].error.max_pixels > 1.0, "{name}: nothing moves: {:?}", rows[2]);
        }
        for row in &bounded {
            assert!(row.error.max_pixels <= 1.0 + ROUNDING, "{name}: {row:?}");
        }
        assert!(bounded[2].fraction < 0.9 && bounded[2].error.max_pixels > 0.1, "{name}: far too careful");
    }
    let cube = of(&report.layouts[1], GateName::Off);
    assert!(cube[0].visible < cube[1].visible, "the camera begins inside the cube: {cube:?}");
}

/// A bound that is planted twenty times too large shows more than a pixel, so the comparison can fail.
#[test]
fn an_error_beyond_the_bound_is_found() {
    let report = swept(&DistanceSweepOptions { pixels: 20.0, ..small() });
    let found = largest(&report, GateName::Bounded);
    assert!((2.0..=20.0 + ROUNDING).contains(&found), "{found}");
}

#[test]
fn options_out_of_range_are_refused_by_name() {
    let refused = |options: DistanceSweepOptions| options.validate().expect_err("refused").path;
    let usual = DistanceSweepOptions::default;
    assert_eq!(usual().validate(), Ok(()));
    assert_eq!(refused(DistanceSweepOptions { instances: 0, ..usual() }), "instances");
    assert_eq!(refused(DistanceSweepOptions { spacing: f32::NAN, ..usual() }), "spacing");
    assert_eq!(refused(DistanceSweepOptions { edge: -1.0, ..usual() }), "edge");
    assert_eq!(refused(DistanceSweepOptions { period: 0.0, ..usual() }), "period");
    assert_eq!(refused(DistanceSweepOptions { frames: 0, ..usual() }), "frames");
    assert_eq!(refused(DistanceSweepOptions { measured: 0, ..usual() }), "measured");
    assert_eq!(refused(DistanceSweepOptions { distances: vec![], ..usual() }), "distances.len");
    assert_eq!(refused(DistanceSweepOptions { distances: vec![0.0, -1.0], ..usual() }), "distances[1]");
}

/// A's own description of the grid, which the default spacing reproduces: from 1,400 to 1,500 units on, some models are beyond
/// the range; and all are in the end.
#[test]
fn the_default_group_leaves_the_range_where_the_thesis_says() {
    let options = DistanceSweepOptions::default();
    let furthest = |distance: f32| {
        let behind = options.half_depth(GroupLayout::Grid);
        (distance + behind).hypot(behind)
    };
    assert!(furthest(1400.0) < options.range.max && furthest(1500.0) > options.range.max);
    let last = *options.distances.last().expect("a sweep");
    for layout in GroupLayout::ALL {
        assert!(last - options.half_depth(layout) >= options.range.max, "{}", layout.as_str());
    }
}
