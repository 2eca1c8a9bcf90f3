//! Max-mip pyramids: the CPU reference of `kernels/surface/height_pyramid.wgsl`.

use crate::surface::height_pyramid::PyramidLayout;
use crate::surface::map::{Address, HeightMap};

/// Max-mip pyramid of a height map, in the layout of [`PyramidLayout`]. The padding is 0.
pub fn height_pyramid(map: &HeightMap, address: Address) -> Vec<f32> {
    let layout = PyramidLayout::new([map.width(), map.height()], address);
    let mut pyramid = vec![0.0; layout.len()];
    let first = if address == Address::Wrap { 0 } else { -1 };
    for level in 0..layout.levels {
        let [columns, rows] = layout.nodes(level);
        for y in 0..rows {
            for x in 0..columns {
                let four = [[0, 0], [1, 0], [0, 1], [1, 1]];
                let highest = if level == 0 {
                    four.map(|[dx, dy]| map.texel(x as i32 + first + dx, y as i32 + first + dy, address))
                } else {
                    let [width, height] = layout.nodes(level - 1);
                    // Clamping children to the edge does not change the maximum.
                    four.map(|[dx, dy]| {
                        let child = [(2 * x + dx as u32).min(width - 1), (2 * y + dy as u32).min(height - 1)];
                        pyramid[layout.index(level - 1, child)]
                    })
                };
                pyramid[layout.index(level, [x, y])] = highest.into_iter().fold(0.0, f32::max);
            }
        }
    }
    pyramid
}
