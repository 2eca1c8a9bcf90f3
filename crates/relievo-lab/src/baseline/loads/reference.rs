//! Texel loads: the CPU reference of `kernels/baseline/loads.wgsl`.

use relievo::ops::surface::map::{Address, HeightMap};

/// For each thread, the sum of `loads` texels along its row, starting at its own.
pub fn loads(map: &HeightMap, [columns, rows]: [u32; 2], loads: u32) -> Vec<f32> {
    let threads = (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y)));
    let sum = |(x, y): (u32, u32)| {
        (0..loads).fold(0.0, |sum, load| sum + map.texel((x + load) as i32, y as i32, Address::Wrap))
    };
    threads.map(sum).collect()
}
