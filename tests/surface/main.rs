//! Surface mapping on the CPU.

mod bounds;
mod compared;
mod crossings;
mod decided;
mod errors;
mod tangents;

use relievo::ops::surface::{Address, HeightMap, ReliefRay};

/// The bilinear height of a map at a parameter of a ray, in f64.
fn height(map: &HeightMap, ray: &ReliefRay, parameter: f64, address: Address) -> f64 {
    let [x, y] = [0, 1].map(|i| {
        let edge = f64::from([map.width(), map.height()][i]);
        (f64::from(ray.origin[i]) + parameter * f64::from(ray.slope[i])) * edge - 0.5
    });
    let texel =
        |dx: i32, dy: i32| f64::from(map.texel(x.floor() as i32 + dx, y.floor() as i32 + dy, address));
    let (right, below) = (x - x.floor(), y - y.floor());
    (texel(0, 0) * (1.0 - right) + texel(1, 0) * right) * (1.0 - below)
        + (texel(0, 1) * (1.0 - right) + texel(1, 1) * right) * below
}
