//! Runs every parity case on the adapter at hand, and sees every comparator fail on planted faults.
#![cfg(feature = "gpu")]

#[path = "harness/mod.rs"]
mod harness;

use relievo::gpu::Buffer;
use relievo::surface::Hit;
use relievo::terrain::morph::{Morph, MorphPass};
use relievo::verify::compare::{LeftOut, absolute, exact, levels, relative, ulps};
use relievo::verify::poison::{POISON, Poisoned};
use relievo::verify::surface::relief::hits;
use relievo::verify::{self, CaseResult};

#[test]
fn kernels_equal_their_twins() {
    let gpu = harness::gpu();
    let report = verify::run(&gpu, None, &mut |_: &CaseResult| ()).expect("the device works");
    let wrong: Vec<_> =
        report.cases.iter().filter(|case| !case.comparison.holds).map(|case| format!("{case:?}")).collect();
    assert!(report.holds, "{} of {} cases fail:\n{}", wrong.len(), report.cases.len(), wrong.join("\n"));
    assert!(report.cases.len() > 500, "only {} cases ran", report.cases.len());
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
fn ulps_counts_neighbours() {
    let next = f32::from_bits(1.0_f32.to_bits() + 3);
    assert!(ulps(&[next], &[1.0], 3).holds);
    assert!(!ulps(&[next], &[1.0], 2).holds);
    assert!(ulps(&[-0.0], &[0.0], 0).holds);
    assert!(ulps(&[f32::from_bits(1)], &[-f32::from_bits(1)], 2).holds);
    assert!(!ulps(&[f32::NAN], &[1.0], u32::MAX).holds);
}

#[test]
fn relative_sees_errors_beyond_its_share() {
    assert!(relative(&[1.25, 125.0], &[1.0, 100.0], 0.25).holds);
    assert!(!relative(&[1.26], &[1.0], 0.25).holds);
    assert!(!relative(&[f32::NAN], &[1.0], 1e9).holds);
}

/// What is left out is counted and said, and too much of it is a fault, whatever the rest is.
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
fn hits_sees_rays_that_go_astray() {
    let hit = Hit { uv: [0.5, 0.25], height: 0.5, parameter: 0.5, samples: 9, code: 1 };
    let expected = vec![hit; 400];
    let with = |astray: usize, wrong: Hit| {
        let mut actual = expected.clone();
        actual[..astray].fill(wrong);
        hits(&actual, &expected, [64, 64]).holds
    };
    let faults = [
        Hit { uv: [0.51, 0.25], ..hit },
        Hit { uv: [0.5, f32::NAN], ..hit },
        Hit { height: 0.52, ..hit },
        Hit { parameter: 0.52, ..hit },
        Hit { samples: 10, ..hit },
        Hit { code: 2, ..hit },
    ];
    for fault in faults {
        // Two of 400 may touch and go, three may not.
        assert!(with(2, fault) && !with(3, fault), "{fault:?}");
    }
    assert!(!hits(&expected[1..], &expected, [64, 64]).holds);
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
    let unwritten = output.check(&gpu, |actual| exact(actual, &[0; 100])).expect("read");
    assert!(!unwritten.holds, "poison passed for zeros");
    output.buffer.write(&gpu, &[7; 100]).expect("written");
    assert!(output.check(&gpu, |actual| exact(actual, &[7; 100])).expect("read").holds);
    output.buffer.write(&gpu, &[7; 101]).expect("written");
    let beyond = output.check(&gpu, |actual| exact(actual, &[7; 100])).expect("read");
    assert!(beyond.fault.expect("a fault").contains("beyond"));
}

/// A kernel that is given another parameter than its twin does not pass.
#[test]
fn a_kernel_that_computes_something_else_fails() {
    let gpu = harness::gpu();
    let (from, to) =
        (Buffer::from_slice(&gpu, "from", &[0; 64]), Buffer::from_slice(&gpu, "to", &[65_536; 64]));
    let (from, to) = (from.expect("uploaded"), to.expect("uploaded"));
    let heights = Buffer::from_slice(&gpu, "heights", &[POISON as i32; 64]).expect("uploaded");
    let job = MorphPass::new(&gpu)
        .and_then(|pass| pass.prepare(&gpu, &from, &to, &heights).map_err(|error| panic!("{error}")));
    let job = job.expect("prepared");
    job.set(&gpu, Morph { time: 0.5 }).expect("set");
    gpu.run("test", |encoder| job.record(encoder)).expect("run");
    let actual = heights.read_blocking(&gpu).expect("read");
    assert!(exact(&actual, &[32_768; 64]).holds);
    assert!(!exact(&actual, &[32_769; 64]).holds);
}
