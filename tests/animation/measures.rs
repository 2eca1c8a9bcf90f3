//! `measure`, as a user of the library measures a model of their own: a rig of nine meshes, from a file.

use std::sync::Mutex;

use relievo::Error;
use relievo::asset::Model;
use relievo_lab::measure::{
    AnimationReport, CrowdOptions, Detail, DrawnOptions, GateMode, GateName, LodOptions, ParetoOptions,
    ParetoPoint, ParetoReport, Progress, Subject, animation, drawn, pareto, scene,
};

use crate::harness::gpu;

/// The rounding of positions on screen, in pixels.
const ROUNDING: f64 = 1e-3;

fn model() -> Model {
    Model::from_file("tests/truth/files/rig.glb".as_ref()).expect("a model")
}

fn subject(model: &Model) -> Subject<'_> {
    Subject { name: "rig", model, clip: 0 }
}

fn options(gate: GateMode) -> LodOptions {
    let crowd = CrowdOptions { instances: 5, frames: 12, ..CrowdOptions::default() };
    LodOptions { crowd, gate, distances: vec![200.0, 900.0, 2000.0] }
}

fn measured(gate: GateMode) -> AnimationReport {
    animation(None, subject(&model()), &options(gate), &|_| ()).expect("measured")
}

#[test]
fn a_gate_that_is_off_saves_nothing_and_errs_nowhere() {
    let report = measured(GateMode::Off);
    let setting = &report.setting;
    assert_eq!((setting.model.as_str(), report.backend, &setting.adapter), ("rig", "cpu", &None));
    let (bones, moving) = (setting.bones as u64, report.animated_bones as u64);
    assert!(bones > moving && moving > 0);
    for row in &report.distances {
        assert_eq!((row.interpolated, row.skipped, row.fraction), (moving * 5 * 12, 0, 1.0));
        assert_eq!((row.error.max_metres, row.jump.max_metres), (0.0, 0.0));
        assert_eq!((row.error.points, row.error.unseen), (bones * 5 * 12 * 6, 0));
        assert!(row.full_nanoseconds_per_bone.total > 0.0);
    }
}

#[test]
fn bounded_errors_stay_below_their_pixels() {
    let mut saved = 0;
    for pixels in [0.25, 1.0, 4.0] {
        for row in measured(GateMode::Bounded { pixels }).distances {
            let worst = row.error.max_pixels;
            assert!(worst <= f64::from(pixels) + ROUNDING, "{worst} of {pixels} at {}", row.distance);
            assert!(row.error.rms_pixels <= worst && row.error.p99_pixels <= worst);
            saved += row.skipped;
        }
    }
    assert!(saved > 0, "far too careful");
}

fn compared() -> ParetoReport {
    let crowd = CrowdOptions { instances: 3, frames: 24, ..CrowdOptions::default() };
    let options = ParetoOptions { crowd, ..ParetoOptions::default() };
    pareto(subject(&model()), &options, &|_| ()).expect("measured")
}

#[test]
fn curves_fall_and_points_keep_what_they_promise() {
    let report = compared();
    let of = |gate: GateName| report.points.iter().filter(move |point| point.gate == gate);
    for point in of(GateName::Bounded) {
        assert!(point.error.max_pixels <= point.parameter + ROUNDING, "{point:?}");
    }
    let bounded: Vec<&ParetoPoint> = of(GateName::Bounded).collect();
    let [strictest, laxest] = [bounded[0], bounded[bounded.len() - 1]];
    assert!(laxest.cost < strictest.cost && laxest.error.rms_pixels > strictest.error.rms_pixels);
    for point in of(GateName::Uniform) {
        // All bones are sampled in a share Ω of the frames, up to one turn of each instance.
        assert!((point.cost - point.parameter).abs() <= 1.0 / 24.0 + 1e-9, "{point:?}");
    }
    for rows in [&report.comparisons.bounded_max_pixels, &report.comparisons.budget_rms_pixels] {
        assert!(rows.len() > 3, "{rows:?}");
        for pair in rows.windows(2) {
            let [dear, cheap] = [pair[1], pair[0]].map(|row| [row.gate, row.uniform, row.random]);
            assert!(pair[0].cost < pair[1].cost);
            assert!(dear.iter().zip(cheap).all(|(dear, cheap)| *dear <= cheap), "{pair:?}");
        }
    }
}

#[test]
fn the_device_measures_as_the_cpu_does_and_draws() {
    let (gpu, model) = (gpu(), model());
    let pixels = 1.0;
    let options = LodOptions { distances: vec![900.0], ..options(GateMode::Bounded { pixels }) };
    let part = Detail::Bounded { pixels: 0.25 };
    let quarter = DrawnOptions { skinning: part, mesh: part, ..DrawnOptions::default() };
    let cpu = animation(None, subject(&model), &options, &|_| ()).expect("measured");
    let on_gpu = animation(Some(&gpu), subject(&model), &options, &|_| ()).expect("measured");
    let [a, b] = [&cpu, &on_gpu].map(|report| report.distances[0]);
    assert_eq!((a.interpolated, a.concatenated), (b.interpolated, b.concatenated));
    assert!((a.error.rms_pixels - b.error.rms_pixels).abs() < ROUNDING);
    let (report, pictures) = drawn(&gpu, subject(&model), &options, &quarter, &|_| ()).expect("measured");
    let row = report.distances[0].drawn.expect("it is drawn");
    // The bound is the sum of the gate's pixels and a quarter pixel each for influences and triangles.
    assert_eq!(row.gated.pixels, 1.5);
    assert!(row.gated.displacement.largest <= 1.5 && row.gated.displacement.largest > 0.05, "{row:?}");
    assert!(row.gated.displacement.jump <= 3.0 && row.gated.displacement.missing == 0, "{row:?}");
    assert!(row.gated.frame_nanoseconds > 0.0 && row.full_frame_nanoseconds > 0.0);
    assert_eq!((pictures.len(), pictures[0].dimensions()), (1, (1920, 1080)));
    assert!(pictures[0].pixels().any(|pixel| pixel != pictures[0].get_pixel(0, 0)));
    let (report, _) = scene(&gpu, subject(&model), &options, &quarter, &|_| ()).expect("measured");
    let row = report.distances[0];
    let all = row.all.expect("with levels");
    for (way, pixels) in
        [(row.off, 0.0), (row.animation, 1.0), (row.skinning, 0.25), (row.both, 1.25), (all, 1.5)]
    {
        assert!(way.displacement.largest <= pixels + ROUNDING, "{way:?}");
    }
    assert!(row.animation.displacement.largest > ROUNDING && row.off.bones > row.animation.bones, "{row:?}");
    assert!(all.triangle_fraction < 1.0 && row.both.triangle_fraction == 1.0, "{row:?}");
    // Other gates are drawn as well, but for the random one, which scenes do not have.
    let uniform = LodOptions { gate: GateMode::Uniform, ..options.clone() };
    let (report, _) = scene(&gpu, subject(&model), &uniform, &quarter, &|_| ()).expect("measured");
    let row = report.distances[0];
    assert!(row.animation.bones < row.off.bones && row.animation.displacement.largest > ROUNDING, "{row:?}");
    let other = LodOptions { gate: GateMode::Random, ..options };
    assert_eq!(refused(scene(&gpu, subject(&model), &other, &quarter, &|_| ())), "gate");
    assert_eq!(refused(drawn(&gpu, subject(&model), &other, &quarter, &|_| ())), "gate");
}

#[test]
fn progress_counts_the_frames() {
    let told = Mutex::new(Vec::new());
    let options = options(GateMode::Uniform);
    animation(None, subject(&model()), &options, &|progress| told.lock().expect("no panic").push(progress))
        .expect("measured");
    let told = told.into_inner().expect("no panic");
    let expected = (0..=39).map(|done| Progress { part: "uniform", done, of: Some(39) });
    assert_eq!(told, expected.collect::<Vec<_>>());
}

/// The path of the field that is refused.
fn refused<T>(measured: Result<T, Error>) -> String {
    match measured {
        Err(Error::Input(error)) => error.path,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("measured"),
    }
}

#[test]
fn options_out_of_their_bounds_are_refused() {
    let model = model();
    let lod = |change: &dyn Fn(&mut LodOptions)| {
        let mut options = options(GateMode::Off);
        change(&mut options);
        refused(animation(None, subject(&model), &options, &|_| ()))
    };
    assert_eq!(lod(&|options| options.crowd.instances = 0), "instances");
    assert_eq!(lod(&|options| options.crowd.frames = 0), "frames");
    assert_eq!(lod(&|options| options.crowd.rate = f64::NAN), "rate");
    assert_eq!(lod(&|options| options.crowd.range.max = 100.0), "range.max");
    assert_eq!(lod(&|options| options.distances.clear()), "distances.len");
    assert_eq!(lod(&|options| options.distances[1] = 0.5), "distances[1]");
    assert_eq!(lod(&|options| options.gate = GateMode::Bounded { pixels: -1.0 }), "pixels");
    let missing = Subject { clip: model.clips.len(), ..subject(&model) };
    let of_options = options(GateMode::Off);
    assert_eq!(refused(animation(None, missing, &of_options, &|_| ())), "subject.clip");
    let tall = ParetoOptions { tall_pixels: 0.0, ..ParetoOptions::default() };
    assert_eq!(refused(pareto(subject(&model), &tall, &|_| ())), "tall_pixels");
    let few = LodOptions { crowd: CrowdOptions { frames: 3, ..of_options.crowd }, ..of_options };
    let full = DrawnOptions { skinning: Detail::Full, mesh: Detail::Full, ..DrawnOptions::default() };
    assert_eq!(refused(drawn(&gpu(), subject(&model), &few, &full, &|_| ())), "frames");
}
