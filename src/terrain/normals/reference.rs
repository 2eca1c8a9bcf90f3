//! Slopes and unit normals: the CPU reference of `kernels/terrain/normals.wgsl`.

use crate::terrain::config::HEIGHT_ONE;

/// Central differences and unit normals of a window with `width` samples per row, for all samples inside its outermost ring.
/// Differences are (h(x+1) − h(x−1), h(y+1) − h(y−1)) in 1/65536 units; normals are (x, up, z).
pub fn normals(window: &[i32], width: usize, terrain_scale: f64) -> (Vec<[i32; 2]>, Vec<[f32; 3]>) {
    let at = |x: usize, y: usize| window[y * width + x];
    let mut gradients = Vec::with_capacity((width - 2) * (width - 2));
    for y in 1..width - 1 {
        for x in 1..width - 1 {
            gradients.push([at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)]);
        }
    }
    let normals = gradients.iter().map(|gradient| unit_normal(*gradient, terrain_scale)).collect();
    (gradients, normals)
}

/// Unit normal (x, up, z) for a pair of central differences, computed in f64 and rounded once.
pub(crate) fn unit_normal(gradient: [i32; 2], terrain_scale: f64) -> [f32; 3] {
    // The kernel receives this value as an f32, so the reference rounds it to f32 too.
    let run = f64::from((2.0 * terrain_scale * HEIGHT_ONE) as f32);
    let [dx, dy] = gradient.map(f64::from);
    let length = (dx * dx + run * run + dy * dy).sqrt();
    [-dx / length, run / length, -dy / length].map(|component| component as f32)
}
