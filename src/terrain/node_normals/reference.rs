//! Normals of nodes: the CPU reference of `kernels/terrain/node_normals.wgsl`.

use crate::terrain::node::{NODE_MARGIN, NodeShape};
use crate::terrain::normals::reference::unit_normal;

/// The normals of a node, row by row, from a region of finer heights: [`NodeShape::normals_width`]² unit normals at twice the node's
/// resolution. `spacing` is the distance between samples of the region, in world units. The shape must have finer heights.
pub fn node_normals(shape: NodeShape, spacing: f64, region: &[i32]) -> Vec<[f32; 3]> {
    let (width, step) = (shape.region_width() as usize, 1_usize << (shape.finer - 1));
    let (first, size) = ((NODE_MARGIN << shape.finer) as usize, shape.normals_width() as usize);
    let normal = |at: usize| {
        let [x, y] = [at % size, at / size].map(|at| first + at * step);
        let height = |x: usize, y: usize| region[y * width + x];
        let gradient = [height(x + step, y) - height(x - step, y), height(x, y + step) - height(x, y - step)];
        unit_normal(gradient, step as f64 * spacing)
    };
    (0..size * size).map(normal).collect()
}

/// A unit normal as the kernel stores it: x in the low half and z in the high half of a word, in 1/32767.
pub fn packed_normal([x, _, z]: [f32; 3]) -> u32 {
    let half = |part: f32| u32::from((part.clamp(-1.0, 1.0) * 32_767.0).round_ties_even() as i16 as u16);
    half(x) | half(z) << 16
}
