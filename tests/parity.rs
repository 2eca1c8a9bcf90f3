//! Runs every parity case on the adapter at hand, and sees every comparator fail on planted faults.
#![cfg(feature = "gpu")]

use relievo::gpu::{Gpu, Options};
use relievo::verify;

#[test]
fn kernels_equal_their_twins() {
    let gpu = Gpu::headless(&Options::default()).expect("an adapter");
    println!("adapter: {}", gpu.adapter());
    let report = verify::run(&gpu, None, &mut |_| ()).expect("the device works");
    let wrong: Vec<_> =
        report.cases.iter().filter(|case| !case.comparison.holds).map(|case| format!("{case:?}")).collect();
    assert!(
        report.holds,
        "{} of {} cases fail on {}:\n{}",
        wrong.len(),
        report.cases.len(),
        report.adapter,
        wrong.join("\n")
    );
}
