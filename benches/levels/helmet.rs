//! A helmet: six parts, each a closed shell with hard edges between its panels and a seam of texture coordinates.

use std::f32::consts::{PI, TAU};

use relievo::InputError;
use relievo::asset::skeleton::Bone;
use relievo::asset::{Influence, Influences, Mesh, Model, Skeleton, Skin, Transform};

/// Panels of a part around its axis, and from pole to pole.
const PANELS: [usize; 2] = [14, 7];
/// Quads of a panel along each of its edges.
const QUADS: usize = 9;

/// What a part looks like: its name, where its middle lies, and its half axes.
const PARTS: [(&str, [f32; 3], [f32; 3]); 6] = [
    ("shell", [0.0, 0.0, 0.0], [1.0, 1.1, 1.2]),
    ("visor", [0.0, -0.1, 0.9], [0.75, 0.45, 0.4]),
    ("left ear", [-1.0, -0.2, 0.0], [0.15, 0.35, 0.35]),
    ("right ear", [1.0, -0.2, 0.0], [0.15, 0.35, 0.35]),
    ("crest", [0.0, 1.1, -0.1], [0.08, 0.35, 0.9]),
    ("chin", [0.0, -0.9, 0.5], [0.5, 0.2, 0.45]),
];

/// The helmet, of 95,256 triangles.
pub fn helmet() -> Result<Model, InputError> {
    let bone = Bone { name: "helmet".to_owned(), parent: None, rest: Transform::IDENTITY };
    let identity = [0, 1, 2, 3].map(|column| [0, 1, 2, 3].map(|row| f32::from(u8::from(row == column))));
    let inverse_binds = vec![identity.as_flattened().try_into().unwrap_or([0.0; 16])];
    Ok(Model {
        skeleton: Skeleton::of_joints(vec![bone])?,
        skins: vec![Skin { name: "helmet".to_owned(), bones: vec![0], inverse_binds }],
        clips: Vec::new(),
        motion: None,
        meshes: PARTS
            .iter()
            .map(|(name, middle, axes)| part(name, *middle, *axes))
            .collect::<Result<_, _>>()?,
        skinned: 0,
        materials: Vec::new(),
        images: Vec::new(),
    })
}

/// A point of a part: `along` goes once around, `down` from pole to pole, both from 0 to 1. Panels bulge a little, and the
/// edges between them are hard.
fn point(middle: [f32; 3], axes: [f32; 3], [along, down]: [f32; 2]) -> [f32; 3] {
    let inside = |at: f32, panels: usize| (PI * (at * panels as f32).fract()).sin();
    let grain = (31.0 * TAU * along).sin() * (17.0 * PI * down).sin();
    let bulge = 1.0 + 0.03 * inside(along, PANELS[0]) * inside(down, PANELS[1]) + 0.0015 * grain;
    let (sine, cosine) = (TAU * along).sin_cos();
    let (ring, height) = (PI * down).sin_cos();
    let unit = [ring * cosine, height, -ring * sine];
    [0, 1, 2].map(|axis| middle[axis] + bulge * axes[axis] * unit[axis])
}

fn part(name: &str, middle: [f32; 3], axes: [f32; 3]) -> Result<Mesh, InputError> {
    let (mut positions, mut uv, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    let [around, down] = PANELS.map(|panels| panels * QUADS);
    // Each panel has vertices of its own, so that its normals are its own.
    for panel in 0..PANELS[0] * PANELS[1] {
        let [column, row] = [panel % PANELS[0] * QUADS, panel / PANELS[0] * QUADS];
        let first = positions.len() as u32;
        for at in 0..(QUADS + 1) * (QUADS + 1) {
            let [x, y] = [column + at % (QUADS + 1), row + at / (QUADS + 1)];
            let place = [(x % around) as f32 / around as f32, y as f32 / down as f32];
            positions.push(if y % down == 0 { pole(middle, axes, y) } else { point(middle, axes, place) });
            uv.push([x as f32 / around as f32, place[1]]);
        }
        for quad in 0..QUADS * QUADS {
            let corner = |x: usize, y: usize| first + (y * (QUADS + 1) + x) as u32;
            let [x, y] = [quad % QUADS, quad / QUADS];
            let [a, b, c, d] = [corner(x, y), corner(x, y + 1), corner(x + 1, y + 1), corner(x + 1, y)];
            indices.extend([a, b, c, a, c, d]);
        }
    }
    let vertices = positions.len();
    let one = Influence { bone: 0, weight: 1.0 };
    Ok(Mesh {
        name: name.to_owned(),
        skin: 0,
        normals: normals(&positions, &indices),
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; vertices],
        uv,
        positions,
        indices,
        double_sided: false,
        material: None,
        influences: Influences::new("influences", 1, (0..vertices).map(|_| vec![one]))?,
        targets: Vec::new(),
        weights: Vec::new(),
        weight_keys: Vec::new(),
        ..Mesh::default()
    })
}

fn pole(middle: [f32; 3], axes: [f32; 3], row: usize) -> [f32; 3] {
    let side = if row == 0 { 1.0 } else { -1.0 };
    [middle[0], middle[1] + side * axes[1], middle[2]]
}

/// The normals of a panel's vertices, from its own triangles.
fn normals(positions: &[[f32; 3]], indices: &[u32]) -> Vec<[f32; 3]> {
    let mut sums = vec![[0.0_f32; 3]; positions.len()];
    for triangle in indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|corner| positions[corner as usize]);
        let [u, v] = [b, c].map(|end| [0, 1, 2].map(|axis| end[axis] - a[axis]));
        let normal = [0, 1, 2].map(|axis| {
            let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
            u[next] * v[last] - u[last] * v[next]
        });
        for corner in triangle {
            (0..3).for_each(|axis| sums[*corner as usize][axis] += normal[axis]);
        }
    }
    let unit = |sum: &[f32; 3]| {
        let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
        if length > 0.0 { sum.map(|x| x / length) } else { [0.0, 1.0, 0.0] }
    };
    sums.iter().map(unit).collect()
}
