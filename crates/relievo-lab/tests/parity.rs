//! Runs every parity case on the adapter at hand, and sees every comparator fail on planted faults.

use relievo_testing as harness;

use std::sync::Mutex;

use glam::Vec4;
use relievo::gpu::Buffer;
use relievo::ops::surface::relief::ReliefPass;
use relievo::ops::surface::relief::reference::ReliefSurface;
use relievo::ops::surface::{HeightMap, March, ReliefHit, ReliefMethod, ReliefRay, SurfaceTextures};
use relievo::ops::terrain::morph::{HeightMorphPass, Morph, MorphBuffers};
use relievo_lab::cases::surface::bounds::{Judged, Source, judge};
use relievo_lab::cases::surface::relief::hits;
use relievo_lab::cases::surface::shade;
use relievo_lab::cases::surface::shade::{JudgedShade, PARTS, Part, compare, perspective, random_points};
use relievo_lab::cases::surface::{Shape, random_map, random_rays};
use relievo_lab::harness::CaseResult;
use relievo_lab::harness::compare::LeftOut;
use relievo_lab::harness::compare::{absolute, exact, levels, relative};
use relievo_lab::harness::poison::{POISON, Poisoned};
use relievo_lab::shade::ShadePass;
use relievo_lab::shade::{Shade, ShadePoint, ShadeView};
use relievo_lab::{OPERATIONS, verify};

#[test]
fn kernels_equal_their_references() {
    let gpu = harness::gpu();
    // Two threads, because many references run on one.
    let left = Mutex::new(OPERATIONS.iter());
    let run = || {
        let operations = std::iter::from_fn(|| left.lock().expect("no thread panicked").next());
        let progress = &mut |_: &CaseResult| ();
        gpu.block_on(verify::run_operations(&gpu, operations, progress)).expect("the device works").cases
    };
    let cases = std::thread::scope(|scope| {
        let other = scope.spawn(run);
        [run(), other.join().expect("no thread panicked")].concat()
    });
    let wrong: Vec<_> =
        cases.iter().filter(|case| !case.comparison.holds).map(|case| format!("{case:?}")).collect();
    assert!(wrong.is_empty(), "{} of {} cases fail:\n{}", wrong.len(), cases.len(), wrong.join("\n"));
    let idle: Vec<_> = (OPERATIONS.iter().map(|stem| stem.name))
        .filter(|name| !cases.iter().any(|case| case.stem == *name))
        .collect();
    assert!(idle.is_empty(), "{idle:?} ran no case");
}

#[test]
fn exact_sees_one_wrong_bit_and_a_wrong_length() {
    assert!(exact(&[1, 2, 3], &[1, 2, 3]).holds);
    let comparison = exact(&[1, 2 ^ (1 << 30), 3], &[1, 2, 3]);
    assert!(!comparison.holds);
    assert!(comparison.fault.expect("a fault").contains("first at 1"));
    assert!(!exact(&[1, 2], &[1, 2, 3]).holds);
    assert!(!exact::<i32>(&[], &[]).holds, "nothing compared is nothing proven");
}

#[test]
fn absolute_sees_errors_beyond_its_bound_and_nan() {
    assert!(absolute(&[1.0, 2.0], &[1.0, 2.125], 0.125).holds);
    assert!(!absolute(&[1.0, 2.0], &[1.0, 2.126], 0.125).holds);
    assert!(!absolute(&[f32::NAN], &[1.0], 1e9).holds);
    assert!(!absolute(&[f32::NAN], &[f32::NAN], 1e9).holds);
}

#[test]
fn relative_sees_errors_beyond_its_share() {
    assert!(relative(&[1.25, 125.0], &[1.0, 100.0], 0.25).holds);
    assert!(!relative(&[1.26], &[1.0], 0.25).holds);
    assert!(!relative(&[f32::NAN], &[1.0], 1e9).holds);
}

/// Noise and rays at all angles, with what they hit and how far that may be off.
fn judged_rays(method: ReliefMethod) -> (HeightMap, March, Vec<ReliefRay>, Vec<Judged>) {
    let map = random_map(4, [64, 64], Shape::Noise).expect("a map");
    let march = March { steps: [6, 28], binary_steps: 14, ..March::default() };
    let rays = random_rays(4, 400);
    let judged = judge(&map, method, &march, &rays, Source::Given).expect("judged");
    (map, march, rays, judged)
}

/// A twentieth of a texel, another height or parameter, another outcome, NaN, another number of loads: each is found
/// on every single ray that does not touch, and those are nearly all.
#[test]
fn hits_sees_one_ray_a_twentieth_of_a_texel_off() {
    for method in ReliefMethod::ALL {
        let (.., judged) = judged_rays(method);
        let expected: Vec<ReliefHit> = judged.iter().map(|judged| judged.expected).collect();
        assert!(hits(&expected, &judged, [64, 64]).holds);
        let ordinary: Vec<usize> = (0..judged.len()).filter(|index| !judged[*index].touches()).collect();
        assert!(ordinary.len() > 340, "{method:?}: only {} rays of 400", ordinary.len());
        for index in ordinary {
            let hit = expected[index];
            let faults = [
                ReliefHit { uv: [hit.uv[0] + 0.05 / 64.0, hit.uv[1]], ..hit },
                ReliefHit { uv: [hit.uv[0], hit.uv[1] - 0.05 / 64.0], ..hit },
                ReliefHit { uv: [hit.uv[0], f32::NAN], ..hit },
                ReliefHit { height: hit.height + 2.0 * judged[index].height as f32, ..hit },
                ReliefHit { parameter: hit.parameter + 2.0 * judged[index].parameter as f32, ..hit },
                ReliefHit { samples: hit.samples + 1, ..hit },
                ReliefHit { outcome_code: hit.outcome_code + 1, ..hit },
            ];
            for fault in faults {
                let mut actual = expected.clone();
                actual[index] = fault;
                let comparison = hits(&actual, &judged, [64, 64]);
                assert!(!comparison.holds, "{method:?}: {fault:?} passes for {:?}", judged[index]);
            }
        }
        assert!(!hits(&expected[1..], &judged, [64, 64]).holds);
    }
}

#[test]
fn hits_sees_too_many_rays_that_prove_little() {
    let (.., mut judged) = judged_rays(ReliefMethod::Quadtree);
    let expected: Vec<ReliefHit> = judged.iter().map(|judged| judged.expected).collect();
    let spread = hits(&expected, &judged, [64, 64]).spread.expect("a spread");
    assert!(spread.touching < spread.may_touch && spread.largest == 0.0, "{spread:?}");
    judged.iter_mut().take(100).for_each(|judged| judged.is_steady = false);
    let comparison = hits(&expected, &judged, [64, 64]);
    assert!(comparison.fault.expect("a fault").contains("touch"));
}

/// A kernel whose rays enter a twentieth of a texel further on, or that marches one step more, does not pass.
#[test]
fn a_kernel_that_traces_other_rays_fails() {
    let gpu = harness::gpu();
    for method in ReliefMethod::ALL {
        let (map, march, rays, judged) = judged_rays(method);
        let textures = SurfaceTextures::new(&gpu, &map, method, march.address).expect("uploaded");
        let pass = ReliefPass::new(&gpu, method).expect("compiled");
        let compared = |rays: &[ReliefRay], march: &March| {
            let input = Buffer::from_slice(&gpu, "rays", rays).expect("uploaded");
            let output = Buffer::new(&gpu, "hits", rays.len()).expect("allocated");
            let job = pass.prepare(&gpu, &textures, march, &input, &output).expect("prepared");
            gpu.run("test", |encoder| job.record(encoder)).expect("run");
            hits(&output.read_blocking(&gpu).expect("read"), &judged, [64, 64])
        };
        let same = compared(&rays, &march);
        assert!(same.holds, "{method:?}: {same:?}");
        let shifted: Vec<ReliefRay> = rays
            .iter()
            .map(|ray| ReliefRay { origin: [ray.origin[0] + 0.05 / 64.0, ray.origin[1]], ..*ray })
            .collect();
        let off = compared(&shifted, &march);
        assert!(!off.holds && off.error > 5.0, "{method:?}: {off:?}");
        if method.is_stepped() {
            assert!(!compared(&rays, &March { steps: [6, 29], ..march }).holds, "{method:?}");
        }
    }
}

/// Shades of one case, judged.
fn judged_shades() -> (HeightMap, March, ShadeView, Vec<ShadePoint>, Vec<JudgedShade>) {
    let map = random_map(9, [64, 64], Shape::Hills).expect("a map");
    let march = March { binary_steps: 16, ..March::default() };
    let view = ShadeView { softness: 1.0, ..perspective() };
    let surface = ReliefSurface::new(&map, ReliefMethod::Quadtree, march.address);
    let points = random_points(9, 400, &surface, ReliefMethod::Quadtree, &march);
    let judged = shade::judged(&map, ReliefMethod::Quadtree, &march, &view, &points).expect("judged");
    (map, march, view, points, judged)
}

/// What a comparison leaves out is counted and reported, and too much of it is a fault, whatever the rest is.
#[test]
fn comparisons_that_leave_out_too_much_fail() {
    let left_out = |count| LeftOut { count, of: 40, most: 2 };
    let few = exact(&[1, 2], &[1, 2]).leaving_out(left_out(2));
    assert!(few.holds && few.left_out == Some(left_out(2)), "{few:?}");
    assert!(!exact(&[1, 2], &[1, 3]).leaving_out(left_out(2)).holds);
    let many = exact(&[1, 2], &[1, 2]).leaving_out(left_out(3));
    assert!(!many.holds && many.left_out == Some(left_out(3)), "{many:?}");
    assert_eq!(many.fault.as_deref(), Some("3 of 40 are left out, and at most 2 may be"));
}

#[test]
fn shades_sees_one_point_of_other_light_or_depth() {
    let (.., judged) = judged_shades();
    let expected: Vec<Shade> = judged.iter().map(|judged| judged.expected).collect();
    let lit = expected.iter().filter(|shade| shade.hard == 1.0).count();
    assert!((100..300).contains(&lit), "{lit} of 400 points are lit");
    let penumbras = expected.iter().filter(|shade| (0.05..0.95).contains(&shade.soft)).count();
    assert!(penumbras > 20, "{penumbras} of 400 points lie in penumbras");
    let with = |index: usize, fault: Shade, part: Part| {
        let mut actual = expected.clone();
        actual[index] = fault;
        compare(&actual, &judged, part).holds
    };
    let mut found = [0; 3];
    for (index, shade) in expected.iter().copied().enumerate() {
        assert!(
            with(index, shade, Part::Hard)
                && with(index, shade, Part::Soft)
                && with(index, shade, Part::Depth)
        );
        let [darker, nearer] =
            [if shade.soft > 0.5 { -0.05 } else { 0.05 }, if shade.depth > 0.5 { -1e-4 } else { 1e-4 }];
        let faults = [
            (Part::Hard, Shade { hard: 1.0 - shade.hard, ..shade }),
            (Part::Soft, Shade { soft: shade.soft + darker, ..shade }),
            (Part::Depth, Shade { depth: shade.depth + nearer, ..shade }),
        ];
        for (found, (part, fault)) in found.iter_mut().zip(faults) {
            *found += usize::from(!with(index, fault, part));
        }
        for nan in [Shade { hard: f32::NAN, ..shade }, Shade { hard: 0.5, ..shade }] {
            assert!(!with(index, nan, Part::Hard));
        }
        assert!(!with(index, Shade { soft: f32::NAN, ..shade }, Part::Soft));
    }
    assert!(found.iter().all(|found| *found > 380), "of 400 points each, {found:?} faults are found");
    assert!(PARTS.iter().all(|(_, part)| !compare(&expected[1..], &judged, *part).holds));
}

/// A kernel with another light, another softness or another camera does not pass; nor does the polygon's depth.
#[test]
fn a_kernel_that_shades_otherwise_fails() {
    let gpu = harness::gpu();
    let (map, march, view, points, judged) = judged_shades();
    let method = ReliefMethod::Quadtree;
    let textures = SurfaceTextures::new(&gpu, &map, method, march.address).expect("uploaded");
    let pass = ShadePass::new(&gpu, method).expect("compiled");
    let holds = |view: &ShadeView, points: &[ShadePoint]| {
        let input = Buffer::from_slice(&gpu, "points", points).expect("uploaded");
        let output = Buffer::new(&gpu, "shades", points.len()).expect("allocated");
        let job = pass.prepare(&gpu, &textures, &march, view, &input, &output).expect("prepared");
        gpu.run("test", |encoder| job.record(encoder)).expect("run");
        let actual = output.read_blocking(&gpu).expect("read");
        PARTS.map(|(_, part)| compare(&actual, &judged, part).holds)
    };
    let changed = |change: fn(&mut ShadePoint)| {
        let mut points = points.clone();
        points.iter_mut().for_each(change);
        points
    };
    assert_eq!(holds(&view, &points), [true; 3]);
    let lower = changed(|point| point.hit.height -= 0.02);
    assert_eq!(
        holds(&view, &lower)[..2],
        [false, true],
        "lower points start from the surface, but for their own ray"
    );
    assert_eq!(holds(&ShadeView { softness: view.softness * 1.1, ..view }, &points), [true, false, true]);
    assert_eq!(
        holds(&ShadeView { shadow_steps: view.shadow_steps + 1, ..view }, &points),
        [true, false, true]
    );
    assert_eq!(holds(&ShadeView { eye: view.eye + 0.05 * Vec4::Y, ..view }, &points), [true, true, false]);
    let flat = changed(|point| point.hit.parameter = point.ray.polygon);
    assert_eq!(holds(&view, &flat), [true, true, false]);
    let elsewhere = changed(|point| point.light[0] = -point.light[0]);
    assert_eq!(holds(&view, &elsewhere)[..2], [false, false]);
}

#[test]
fn levels_sees_each_channel() {
    for channel in 0..4 {
        let one = 0x8080_8080_u32;
        let more = one + (2 << (8 * channel));
        assert!(levels(&[more], &[one], 2).holds);
        assert!(!levels(&[more], &[one], 1).holds, "channel {channel}");
    }
}

#[test]
fn poison_shows_what_was_not_written_and_what_was_written_beyond() {
    let gpu = harness::gpu();
    let output = Poisoned::<i32>::new(&gpu, 100).expect("allocated");
    let unwritten = gpu.block_on(output.check(&gpu, |actual| exact(actual, &[0; 100]))).expect("read");
    assert!(!unwritten.holds, "poison passed for zeros");
    output.buffer.write(&gpu, &[7; 100]).expect("written");
    assert!(gpu.block_on(output.check(&gpu, |actual| exact(actual, &[7; 100]))).expect("read").holds);
    output.buffer.write(&gpu, &[7; 101]).expect("written");
    let beyond = gpu.block_on(output.check(&gpu, |actual| exact(actual, &[7; 100]))).expect("read");
    assert!(beyond.fault.expect("a fault").contains("beyond"));
}

/// A kernel that is given another parameter than its reference does not pass.
#[test]
fn a_kernel_that_computes_something_else_fails() {
    let gpu = harness::gpu();
    let (from, to) =
        (Buffer::from_slice(&gpu, "from", &[0; 64]), Buffer::from_slice(&gpu, "to", &[65_536; 64]));
    let (from, to) = (from.expect("uploaded"), to.expect("uploaded"));
    let heights = Buffer::from_slice(&gpu, "heights", &[POISON as i32; 64]).expect("uploaded");
    let buffers = MorphBuffers { from: &from, to: &to, heights: &heights };
    let job = HeightMorphPass::new(&gpu).expect("compiled").prepare(&gpu, buffers).expect("prepared");
    job.set(&gpu, Morph { time: 0.5 }).expect("set");
    gpu.run("test", |encoder| job.record(encoder)).expect("run");
    let actual = heights.read_blocking(&gpu).expect("read");
    assert!(exact(&actual, &[32_768; 64]).holds);
    assert!(!exact(&actual, &[32_769; 64]).holds);
}
