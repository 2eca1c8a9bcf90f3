//! Transitions, in every output: what they draw on their way, and that nothing is left of them in the end.

use relievo::render::{Layer, TargetFormat};
use relievo::scene::{Criterion, DistanceTo, LevelChoice, LevelOfDetail, Pace, Placement, Transition};
use relievo::wgpu;

use crate::stage::{Shot, Stage, TARGET, zoomed_from};

/// Where level 2 becomes level 3; the band reaches from 90 to 110.
const THRESHOLDS: [f32; 3] = [1.0, 2.0, 100.0];

fn with(transition: Transition) -> LevelOfDetail {
    let to = DistanceTo::Point(TARGET);
    let choice = LevelChoice::By(Criterion::Distance { to, from: THRESHOLDS.to_vec() });
    LevelOfDetail { choice, transition, ..LevelOfDetail::default() }
}

fn forced(level: u32) -> LevelOfDetail {
    LevelOfDetail { choice: LevelChoice::Forced(level), ..LevelOfDetail::default() }
}

/// Makes a stage of one object.
pub type Kind = fn(&LevelOfDetail, &[Placement]) -> Stage;

/// What may be drawn: a mesh, and a character.
const KINDS: [Kind; 2] = [Stage::of_mesh, Stage::of_character];

/// The distance at which a fraction of the way is gone.
fn distance_at(way: f32) -> f32 {
    90.0 + 20.0 * way
}

/// An object with a transition between levels 2 and 3, and the same object at either level alone.
struct Trio {
    stages: [Stage; 3],
    outputs: Vec<(TargetFormat, Vec<Layer>, [Shot; 3])>,
}

/// The stages of a trio.
const CHANGING: usize = 0;
const FINER: usize = 1;
const COARSER: usize = 2;

impl Trio {
    fn new(kind: Kind, outputs: Vec<(TargetFormat, Vec<Layer>)>) -> Self {
        let at = [Placement::at([0.0; 3])];
        let mut stages = [
            kind(&with(Transition::Dither(Pace::Band(0.1))), &at),
            kind(&forced(2), &at),
            kind(&forced(3), &at),
        ];
        for stage in &mut stages {
            stage.scene.keep_motion_history(true).expect("room");
        }
        let shots = |format: &TargetFormat| stages.each_ref().map(|stage| Shot::new(stage, format.clone()));
        let outputs = outputs.into_iter().map(|(format, layers)| {
            let shots = shots(&format);
            (format, layers, shots)
        });
        Self { outputs: outputs.collect(), stages }
    }

    /// Gives the object another transition.
    fn set(&mut self, transition: Transition) {
        let stage = &mut self.stages[CHANGING];
        stage.scene.set_level_of_detail(stage.object, &with(transition)).expect("valid");
        for (_, _, shots) in &mut self.outputs {
            shots[CHANGING].prepare(stage);
        }
    }

    fn look(&mut self, distance: f32) {
        for stage in &mut self.stages {
            stage.view.set(zoomed_from(distance)).expect("a camera");
        }
    }

    /// The first attachment of an output, as bytes.
    fn bytes(&mut self, output: usize, stage: usize) -> Vec<u8> {
        let (format, layers, shots) = &self.outputs[output];
        self.stages[stage].shot(&shots[stage], layers);
        let color = format.color[0].as_ref().expect("a colour").format;
        let gpu = &self.stages[stage].gpu;
        gpu.block_on(shots[stage].target.read_color(gpu, 0, color)).expect("read")
    }

    /// The depths of an output.
    fn depths(&mut self, output: usize, stage: usize) -> Vec<f32> {
        let (_, layers, shots) = &self.outputs[output];
        self.stages[stage].shot(&shots[stage], layers);
        shots[stage].target.read_depth(&self.stages[stage].gpu).expect("read")
    }
}

const COLORS: [Layer; 2] = [Layer::Color, Layer::Transparent];

/// A layer's format, and the layers to draw.
fn outputs() -> Vec<(TargetFormat, Vec<Layer>)> {
    vec![
        (TargetFormat::srgb(), COLORS.to_vec()),
        (TargetFormat::srgb(), vec![Layer::Depth, Layer::Color, Layer::Transparent]),
        (TargetFormat::srgb(), vec![Layer::Depth]),
        (TargetFormat::surface(), vec![Layer::Surface]),
        (TargetFormat::velocity(), vec![Layer::Velocity]),
        (TargetFormat::measure(), vec![Layer::Measure]),
        (TargetFormat::levels(), vec![Layer::Levels]),
    ]
}

fn texel(format: &TargetFormat) -> usize {
    let color: wgpu::TextureFormat = format.color[0].as_ref().expect("a colour").format;
    color.block_copy_size(None).expect("plain") as usize
}

/// All fades between levels, at a pace.
fn fades(pace: Pace) -> [Transition; 4] {
    [
        Transition::Dither(pace),
        Transition::CrossFade(pace),
        Transition::FadeIn(pace),
        Transition::TwoPhase(pace),
    ]
}

/// A dither shows in each pixel exactly what one of its levels shows there, in every output and with four samples, each level in
/// its share of the pixels; so no background shows where both cover.
#[test]
fn a_dither_is_one_level_or_the_other_in_each_pixel() {
    KINDS.into_iter().for_each(dithers);
}

pub fn dithers(kind: Kind) {
    let mut all = outputs();
    all.push((TargetFormat::srgb().with_samples(4), COLORS.to_vec()));
    let mut trio = Trio::new(kind, all.clone());
    for way in [0.25, 0.5, 0.8] {
        trio.look(distance_at(way));
        for (at, (format, layers)) in all.iter().enumerate() {
            let [found, finer, coarser] = [CHANGING, FINER, COARSER].map(|stage| trio.bytes(at, stage));
            let size = texel(format);
            let pixels = found.chunks(size).zip(finer.chunks(size)).zip(coarser.chunks(size));
            let (mut fine, mut coarse) = (0, 0);
            for (at, ((found, finer), coarser)) in pixels.enumerate() {
                assert!(found == finer || found == coarser, "{layers:?}, pixel {at}: {found:?}");
                if finer != coarser {
                    fine += u32::from(found == finer);
                    coarse += u32::from(found == coarser);
                }
            }
            if layers[..] == [Layer::Depth] || layers[..] == [Layer::Velocity] {
                continue;
            }
            assert!(fine + coarse > 60, "{layers:?}: the levels differ in {} pixels", fine + coarse);
            let share = coarse as f32 / (fine + coarse) as f32;
            assert!((share - way).abs() < 0.2, "{layers:?}: {share} at {way}");
        }
        let [found, finer, coarser] = [CHANGING, FINER, COARSER].map(|stage| trio.depths(2, stage));
        let pixels = found.iter().zip(&finer).zip(&coarser);
        assert!(pixels.clone().all(|((found, finer), coarser)| found == finer || found == coarser));
        assert!(found != finer && found != coarser, "depth is dithered too");
    }
    assert_eq!(trio.stages[CHANGING].listed().iter().sum::<u32>(), 2, "both levels are listed");
}

/// Before and after its band, and after its time, a transition leaves no trace: the picture is that of the level alone, to the
/// bit, in every output.
#[test]
fn a_finished_transition_leaves_no_trace() {
    KINDS.into_iter().for_each(leaves_no_trace);
    ends_in_time(Stage::of_mesh);
}

pub fn leaves_no_trace(kind: Kind) {
    let all = outputs();
    let mut trio = Trio::new(kind, all.clone());
    for transition in fades(Pace::Band(0.1)) {
        trio.set(transition);
        for (distance, alone) in [(85.0, FINER), (115.0, COARSER)] {
            trio.look(distance);
            for (at, (_, layers)) in all.iter().enumerate() {
                let is_equal = trio.bytes(at, CHANGING) == trio.bytes(at, alone);
                assert!(is_equal, "{transition:?}, {layers:?} at {distance}");
                assert!(trio.depths(at, CHANGING) == trio.depths(at, alone), "{transition:?}, {layers:?}");
            }
        }
    }
}

pub fn ends_in_time(kind: Kind) {
    let mut trio = Trio::new(kind, outputs()[..1].to_vec());
    for transition in fades(Pace::Seconds(0.2)) {
        trio.set(transition);
        trio.look(80.0);
        trio.stages[CHANGING].view.cut();
        trio.stages[CHANGING].record();
        trio.look(120.0);
        let right = trio.bytes(0, COARSER);
        for frame in 0..14 {
            trio.stages[CHANGING].scene.advance(0.02).expect("finite");
            let picture = trio.bytes(0, CHANGING);
            let both = trio.stages[CHANGING].listed();
            let is_fading = both.iter().sum::<u32>() == 2;
            assert_eq!(is_fading, frame < 9, "{transition:?}, frame {frame}: {both:?}");
            assert_eq!(picture == right, !is_fading, "{transition:?}, frame {frame}");
        }
    }
}

/// During a fade in, a fade in two phases and a dither no background shows where both levels cover; during a cross-fade it does, as
/// documented.
#[test]
fn no_background_shows_where_both_levels_cover() {
    KINDS.into_iter().for_each(hides_background);
}

pub fn hides_background(kind: Kind) {
    let is_background = |pixel: &[u8]| pixel[..3] == [255, 0, 255];
    let mut trio = Trio::new(kind, outputs()[..1].to_vec());
    for transition in fades(Pace::Band(0.1)) {
        trio.set(transition);
        let mut shown = 0;
        for way in [0.1, 0.3, 0.5, 0.7, 0.9] {
            trio.look(distance_at(way));
            let [found, finer, coarser] = [CHANGING, FINER, COARSER].map(|stage| trio.bytes(0, stage));
            // How purple a pixel is: the background is as purple as can be.
            let purple = |pixel: &[u8]| i32::midpoint(pixel[0].into(), pixel[2].into()) - i32::from(pixel[1]);
            let of_levels = finer.chunks(4).chain(coarser.chunks(4)).filter(|pixel| !is_background(pixel));
            let most = of_levels.map(purple).max().expect("something is drawn");
            assert!(most < 60, "{most}: no object is purple");
            let pixels = found.chunks(4).zip(finer.chunks(4)).zip(coarser.chunks(4));
            let mut covered = 0;
            for (at, ((found, finer), coarser)) in pixels.enumerate() {
                if is_background(finer) || is_background(coarser) {
                    continue;
                }
                covered += 1;
                let is_purple = purple(found) > most + 3;
                shown += u32::from(is_purple);
                let may_show = matches!(transition, Transition::CrossFade(_));
                assert!(!is_purple || may_show, "{transition:?} at {way}, pixel {at}: {found:?}");
            }
            assert!(covered > 500, "{covered} pixels are covered");
        }
        if matches!(transition, Transition::CrossFade(_)) {
            assert!(shown > 100, "what is behind shows through in {shown} pixels");
        }
    }
}

/// Opaque depth is that of the opaque level at every step, and layers other than colour show it alone: the one with the larger
/// weight, and with a fade in the level itself. A cross-fade has no opaque depth.
#[test]
fn other_layers_show_the_heavier_level() {
    KINDS.into_iter().for_each(shows_the_heavier_level);
}

pub fn shows_the_heavier_level(kind: Kind) {
    let all = outputs();
    let mut trio = Trio::new(kind, all.clone());
    for transition in fades(Pace::Band(0.1)).into_iter().skip(1) {
        trio.set(transition);
        for way in [0.2, 0.45, 0.55, 0.8] {
            trio.look(distance_at(way));
            // A level that fades in stays blended until it is whole.
            let is_coarser = way > 0.5 && !matches!(transition, Transition::FadeIn(_));
            let alone = if is_coarser { COARSER } else { FINER };
            for (at, (_, layers)) in all.iter().enumerate() {
                let is_color = layers.contains(&Layer::Color);
                let is_equal = trio.bytes(at, CHANGING) == trio.bytes(at, alone);
                assert!(
                    is_color != is_equal || layers[..] == [Layer::Depth],
                    "{transition:?} at {way}, {layers:?}"
                );
                // Nothing of a cross-fade is opaque.
                let is_cross = matches!(transition, Transition::CrossFade(_));
                let depths = trio.depths(at, CHANGING);
                if is_cross && layers[..] == [Layer::Depth] {
                    assert!(depths.iter().all(|depth| *depth == 1.0), "{way}: nothing is opaque");
                } else if !is_cross || !is_color {
                    let is_equal = depths == trio.depths(at, alone);
                    assert!(is_equal, "{transition:?} at {way}, {layers:?}: depth");
                }
            }
        }
    }
}

/// A cross-fade is λ of the one level over 1 − λ of the other over what is behind, also where depth was drawn first. Neither
/// level's inside shows.
#[test]
fn a_cross_fade_blends_with_its_weights() {
    let format = TargetFormat::new(wgpu::TextureFormat::Rgba8Unorm);
    let prepass = [Layer::Depth, Layer::Color, Layer::Transparent];
    for kind in KINDS {
        let mut trio =
            Trio::new(kind, vec![(format.clone(), COLORS.to_vec()), (format.clone(), prepass.to_vec())]);
        trio.set(Transition::CrossFade(Pace::Band(0.1)));
        for (output, way) in [(0, 0.25_f32), (0, 0.6), (1, 0.6)] {
            trio.look(distance_at(way));
            let [found, finer, coarser] = [CHANGING, FINER, COARSER].map(|stage| trio.bytes(output, stage));
            let (mut off, mut covered) = (0, 0);
            for ((found, finer), coarser) in found.chunks(4).zip(finer.chunks(4)).zip(coarser.chunks(4)) {
                // Either level may be in front.
                let mix = |a: f32, b: f32, part: f32| a + (b - a) * part;
                let channel = |at: usize| {
                    let behind = [255.0, 0.0, 255.0][at];
                    let [finer, coarser] = [finer[at], coarser[at]].map(f32::from);
                    let first = mix(mix(behind, finer, 1.0 - way), coarser, way);
                    let second = mix(mix(behind, coarser, way), finer, 1.0 - way);
                    let found = f32::from(found[at]);
                    (found - first).abs().min((found - second).abs())
                };
                off += u32::from((0..3).map(channel).fold(0.0, f32::max) > 6.0);
                covered += u32::from(finer[1] > 0 || coarser[1] > 0);
            }
            // Where a level hides itself a little behind its surface, it is blended twice.
            assert!(8 * off < covered && covered > 1000, "{off} of {covered} pixels at {way}");
        }
    }
}

/// An instance that fades out is as its opaque picture in every pixel, over what is behind: its inside does not show.
#[test]
fn an_instance_that_fades_out_hides_its_inside() {
    let level = |gone: f32| LevelOfDetail {
        choice: LevelChoice::By(Criterion::Distance { to: DistanceTo::Point(TARGET), from: Vec::new() }),
        transition: Transition::Alpha { opaque: 600.0, gone },
        ..LevelOfDetail::default()
    };
    for kind in KINDS {
        let at = [Placement::at([0.0; 3])];
        let mut stages = [kind(&level(800.0), &at), kind(&forced(0), &at)];
        let format = TargetFormat::new(wgpu::TextureFormat::Rgba8Unorm);
        let mut picture = |stage: usize, distance: f32| {
            let stage = &mut stages[stage];
            let shot = Shot::new(stage, format.clone());
            stage.view.set(zoomed_from(distance)).expect("a camera");
            stage.shot(&shot, &COLORS);
            let read = shot.target.read_color(&stage.gpu, 0, wgpu::TextureFormat::Rgba8Unorm);
            stage.gpu.block_on(read).expect("read")
        };
        for distance in [640.0, 700.0, 780.0] {
            let weight = (800.0 - distance) / 200.0;
            let (found, opaque) = (picture(0, distance), picture(1, distance));
            let (mut covered, mut off) = (0, 0);
            for (found, opaque) in found.chunks(4).zip(opaque.chunks(4)) {
                covered += u32::from(opaque[1] > 0);
                let is_off = |(channel, behind): (usize, f32)| {
                    let right = behind + weight * (f32::from(opaque[channel]) - behind);
                    (f32::from(found[channel]) - right).abs() > 4.0
                };
                off += u32::from([255.0, 0.0, 255.0].into_iter().enumerate().any(is_off));
            }
            // Where two surfaces coincide, both are blended.
            assert!(covered > 500 && 50 * off < covered, "at {distance}: {off} of {covered} pixels are off");
        }
    }
}

/// Thesis A's alpha level of detail: (600, 1) to (800, 0). Nothing is drawn beyond, and half is blended between.
#[test]
fn instances_fade_out_between_two_distances() {
    let level = LevelOfDetail {
        choice: LevelChoice::By(Criterion::Distance { to: DistanceTo::Center, from: Vec::new() }),
        transition: Transition::Alpha { opaque: 600.0, gone: 800.0 },
        ..LevelOfDetail::default()
    };
    for kind in KINDS {
        let mut stage = kind(&level, &[Placement::at([0.0; 3])]);
        let shot = Shot::colors(&stage);
        let mut covered = Vec::new();
        for distance in [500.0, 650.0, 700.0, 750.0, 850.0] {
            stage.view.set(zoomed_from(distance)).expect("a camera");
            let picture = stage.picture(&shot);
            // The green of what is drawn, which the background lacks.
            covered.push(picture.pixels().map(|pixel| f64::from(pixel[1])).sum::<f64>());
            assert_eq!(stage.listed().iter().sum::<u32>(), u32::from(distance < 800.0), "{distance}");
        }
        assert!(covered.windows(2).all(|pair| pair[1] < pair[0]), "{covered:?}");
        assert_eq!(covered[4], 0.0, "{covered:?}");
        // A prepass has it while it is opaque, other layers until it is half gone.
        let measure = Shot::new(&stage, TargetFormat::measure());
        let layers = [(&shot, Layer::Depth, 590.0, 610.0), (&measure, Layer::Measure, 690.0, 710.0)];
        for (shot, layer, shown, gone) in layers {
            for (distance, is_shown) in [(shown, true), (gone, false)] {
                stage.view.set(zoomed_from(distance)).expect("a camera");
                stage.shot(shot, &[layer]);
                let depth = shot.target.read_depth(&stage.gpu).expect("read");
                assert_eq!(depth.iter().any(|depth| *depth < 1.0), is_shown, "{layer:?} at {distance}");
            }
        }
    }
}

/// A fade in time turns back where it is, and a third level waits for its end.
#[test]
fn a_fade_in_time_turns_back() {
    let mut stage = Stage::of_mesh(&with(Transition::Dither(Pace::Seconds(1.0))), &[Placement::at([0.0; 3])]);
    let mut at = |distance: f32, seconds: f32| {
        stage.view.set(zoomed_from(distance)).expect("a camera");
        stage.scene.advance(seconds).expect("finite");
        stage.record();
        stage.listed()
    };
    let steady = |level: usize| (0..8).map(|at| u32::from(at == level)).collect::<Vec<_>>();
    let fading =
        |one: usize, two: usize| (0..8).map(|at| u32::from(at == one || at == two)).collect::<Vec<_>>();
    assert_eq!(at(50.0, 0.1), steady(2));
    assert_eq!(at(150.0, 0.3), fading(2, 3));
    // Back: 0.3 of the way is gone, so 0.3 seconds are left.
    assert_eq!(at(50.0, 0.2), fading(2, 3));
    assert_eq!(at(50.0, 0.2), steady(2));
    // Another level: first the fade ends, then it begins.
    assert_eq!(at(150.0, 0.3), fading(2, 3));
    assert_eq!(at(1.5, 0.3), fading(2, 3));
    assert_eq!(at(1.5, 0.5), steady(3));
    assert_eq!(at(1.5, 0.5), fading(3, 1));
    assert_eq!(at(1.5, 0.6), steady(1));
}
