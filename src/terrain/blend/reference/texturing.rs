//! Mapping of textures onto the ground: the CPU reference of `wgsl/terrain/texturing.wgsl`.

use crate::terrain::cover::{Cover, MapZone, TILES_PERIOD};

/// Weights of the three projections in triplanar mapping, for a unit normal: from above, from east or west, from north or south.
/// Their sum is 1.
pub fn triplanar_weights([x, y, z]: [f32; 3]) -> [f32; 3] {
    let squared = [y, x, z].map(|part| (part.abs() - 0.3).max(0.0).powi(2));
    squared.map(|part| part / (squared[0] + squared[1] + squared[2]))
}

/// Texture position (east, up, south) of a sample, in 2^-22 tiles, modulo [`TILES_PERIOD`] tiles. The sample is `columns` east
/// and `rows` south of the sample at `place`. The vertical position is rounded down.
pub fn tiles_of(cover: &Cover, place: [u32; 2], [columns, rows]: [usize; 2], height: i32) -> [u32; 3] {
    let [step, per_unit] = cover.steps();
    let [east, south] = [(place[0], columns), (place[1], rows)]
        .map(|(first, at)| first.wrapping_add((at as u32).wrapping_mul(step)));
    [east, ((i64::from(height) * i64::from(per_unit)) >> 16) as u32, south]
}

/// Indices into [`Cover::texels`] for a zone at a texture position, one index per projection plane.
pub fn texel_indices(cover: &Cover, zone: &MapZone, [east, up, south]: [u32; 3]) -> Vec<usize> {
    let index = |at: [u32; 2]| {
        let edge = 1 << zone.edge_log2;
        let [x, y] = at.map(|tiles| {
            let repeated = u64::from(tiles) * zone.zone.repeats as u64;
            (repeated >> (22 - zone.edge_log2)) as usize % edge
        });
        zone.first as usize + y * edge + x
    };
    let down = up.wrapping_neg();
    let planes = [[east, south], [south, down], [east, down]];
    planes[..if cover.triplanar { 3 } else { 1 }].iter().copied().map(index).collect()
}

/// Linear colour (red, green, blue) and height of a zone's texture at a texture position.
pub fn texel(cover: &Cover, zone: &MapZone, normal: [f32; 3], tiles: [u32; 3]) -> [f32; 4] {
    let texel = |index: usize| cover.texels[index].map(|channel| f32::from(channel) / 65_535.0);
    let planes: Vec<[f32; 4]> = texel_indices(cover, zone, tiles).into_iter().map(texel).collect();
    let [above] = planes[..] else {
        let weights = triplanar_weights(normal);
        return std::array::from_fn(|channel| {
            (0..3).map(|plane| weights[plane] * planes[plane][channel]).sum()
        });
    };
    above
}

/// Random word for a cell of the colour variation's noise.
fn word(x: u32, y: u32) -> u32 {
    let mut word = x.wrapping_mul(0x9e37_79b1).wrapping_add(y.wrapping_mul(0x85eb_ca77));
    word = (word ^ (word >> 16)).wrapping_mul(0x7feb_352d);
    word = (word ^ (word >> 15)).wrapping_mul(0x846c_a68b);
    word ^ (word >> 16)
}

/// Noise of the colour variation at top-down texture coordinates, in tiles: brightness and warmth, each −1 to 1.
pub fn color_variation(tiles: [f32; 2]) -> [f32; 2] {
    let mut sum = [0.0_f32; 2];
    for octave in 0..3 {
        let width = [2.0, 8.0, 32.0][octave as usize];
        let period = TILES_PERIOD / width as u32;
        let cells = tiles.map(|tiles| tiles / width);
        let inside = cells.map(|at| at - at.floor());
        let [s, t] = inside.map(|at| at * at * (3.0 - 2.0 * at));
        let [x, y] = cells.map(|at| at.floor() as i32 as u32);
        let corner = |dx: u32, dy: u32| {
            let [x, y] = [x.wrapping_add(dx), y.wrapping_add(dy)].map(|at| at % period);
            let word = word(x + octave * 4096, y);
            [word >> 16, word & 0xffff].map(|half| half as f32)
        };
        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        for (at, sum) in sum.iter_mut().enumerate() {
            let (west, east) = (a[at] + (c[at] - a[at]) * t, b[at] + (d[at] - b[at]) * t);
            *sum += west + (east - west) * s;
        }
    }
    sum.map(|sum| sum * (2.0 / 196_605.0) - 1.0)
}

/// Applies the colour variation to a linear colour. `brightness` and `warmth` are −1 to 1, `strength` is 0 to 1.
pub fn varied(color: [f32; 3], [brightness, warmth]: [f32; 2], strength: f32) -> [f32; 3] {
    let tint = [0.2, 0.05, -0.25];
    std::array::from_fn(|channel| {
        color[channel] * (1.0 + strength * (0.5 * brightness + tint[channel] * warmth))
    })
}
