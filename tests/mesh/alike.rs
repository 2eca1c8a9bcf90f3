//! The same sequence of collapses on every machine: hashes of meshes that are made without functions that differ. The
//! crate of `relievo-web-scene` computes the same hashes in a browser.

use relievo::ops::mesh::{SimplifyOptions, Surface, simplify, simplify_within};
use relievo_lab::reduce::{Limits, Reducer};

/// A whole number below `most` for a place.
fn noise(at: u32, most: u32) -> u32 {
    let mixed = (at ^ (at >> 13)).wrapping_mul(0x5bd1_e995);
    (mixed ^ (mixed >> 15)).wrapping_mul(0x27d4_eb2d) % most
}

/// Hills from whole numbers: a slope, a ridge and noise.
fn hills(cells: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let side = cells + 1;
    let height = |at: u32| {
        let (x, z) = ((at % side) as f32, (at / side) as f32);
        let ridge = (x - 0.5 * z) / cells as f32;
        0.25 * x + 8.0 * ridge * ridge + noise(at, 16) as f32 / 16.0
    };
    let positions = (0..side * side).map(|at| [(at % side) as f32, height(at), (at / side) as f32]);
    let cell = |at: u32| {
        let corner = at / cells * side + at % cells;
        [corner, corner + side, corner + 1, corner + 1, corner + side, corner + side + 1]
    };
    (positions.collect(), (0..cells * cells).flat_map(cell).collect())
}

/// A cube of six sheets that is blown up to a ball: square roots are exact, and every edge of the cube is a seam.
fn ball(cells: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for face in 0..6_usize {
        let first = positions.len() as u32;
        let (sheet, triangles) = hills(cells);
        let side = if face < 3 { 1.0 } else { -1.0 };
        positions.extend(sheet.iter().map(|[u, _, v]| {
            let [u, v] = [u, v].map(|x| x / cells as f32 * 2.0 - 1.0);
            let mut place = [side; 3];
            place[(face + 1) % 3] = u * side;
            place[(face + 2) % 3] = v;
            let length = (place[0] * place[0] + place[1] * place[1] + place[2] * place[2]).sqrt();
            place.map(|x| x / length)
        }));
        indices.extend(triangles.iter().map(|corner| first + corner));
    }
    (positions, indices)
}

/// Hashes of hills by positions, of hills with an attribute, of a ball with seams in two poses, and of hills within
/// distances.
pub fn hashes() -> [String; 4] {
    let (ground, indices) = hills(40);
    let values: Vec<f32> = (0..ground.len() as u32).map(|at| noise(at, 7) as f32 * 0.125).collect();
    let poses = [ground];
    let plain = Surface { poses: &poses, indices: &indices, attributes: &[], stride: 0 };
    let valued = Surface { attributes: &values, stride: 1, ..plain };
    let (round, corners) = ball(10);
    let squeezed = round.iter().map(|[x, y, z]| [x * 0.5, y + 0.25 * x, *z]).collect();
    let both = [round, squeezed];
    let seams = Surface { poses: &both, indices: &corners, attributes: &[], stride: 0 };
    let all = SimplifyOptions::default();
    [
        simplify(&plain, &all),
        simplify(&valued, &all),
        simplify(&seams, &all),
        simplify_within(&plain, &all, &[0.25, 1.0]),
    ]
    .map(|found| found.map_or_else(|error| error.to_string(), |found| found.hash()))
}

/// Each reducer's hashes but the first one's, whose sequence `hashes` has: of hills with an attribute, and of a ball with
/// seams, at several numbers of triangles.
pub fn reduced() -> [String; 6] {
    let (ground, indices) = hills(24);
    let values: Vec<f32> = (0..ground.len() as u32).map(|at| noise(at, 7) as f32 * 0.125).collect();
    let poses = [ground];
    let valued = Surface { poses: &poses, indices: &indices, attributes: &values, stride: 1 };
    let (round, corners) = ball(8);
    let poses = [round];
    let seams = Surface { poses: &poses, indices: &corners, attributes: &[], stride: 0 };
    std::array::from_fn(|at| {
        let (name, reducer) = Reducer::ALL[at + 1];
        let to = |triangles| Limits { triangles, ..Limits::default() };
        let found = [(&valued, [800, 300, 50]), (&seams, [500, 200, 60])].map(|(surface, triangles)| {
            match reducer.reduce_each(surface, &triangles.map(to)) {
                Ok(all) => {
                    all.iter().map(|reduced| reduced.hash()[..12].to_owned()).collect::<Vec<_>>().join(" ")
                }
                Err(error) => error.to_string(),
            }
        });
        format!("{name}: {} | {}", found[0], found[1])
    })
}
