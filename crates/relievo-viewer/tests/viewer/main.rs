//! The viewer, driven without a window.

mod driver;

use driver::Driver;

#[test]
fn look() {
    let which: usize = std::env::var("LOOK").ok().and_then(|at| at.parse().ok()).unwrap_or(1);
    let names = ["Mountains without end", "A creature of 153 bones", "A crowd of 100"];
    let mut driver = Driver::new([800, 520]);
    driver.frames(3);
    let start = std::time::Instant::now();
    driver.choose("Examples and recent files", names[which]);
    driver.settle();
    println!("settled {:?}", start.elapsed());
    driver.frames(10);
    println!("frames {:?}", start.elapsed());
    driver.save(&format!("example-{which}"));
    println!("{:?} {:?}", driver.viewer.notice(), driver.viewer.history().last());
}
