//! A rock and a wall as generated models. They use only `+ − × ÷`, square roots and counter-based randomness, so that every
//! machine gets the same bits.

use glam::DVec3;
use relievo::InputError;
use relievo::asset::material::{Sampling, Texture};
use relievo::asset::mesh::solved_tangents;
use relievo::asset::skeleton::Bone;
use relievo::asset::{Influences, Material, Mesh, Model, Skeleton, Skin, Transform};
use relievo::ops::hash::{LANES, threefry2x32};
use relievo::ops::terrain::config::BuiltIn;
use relievo::ops::terrain::texture::{TEXTURE_SIZE, TerrainTexture};

/// Number of cells along an edge of each of the rock's six sides.
const ROCK_CELLS: u32 = 24;

/// Width, height and thickness of the wall, in world units.
const WALL: DVec3 = DVec3::new(4.0, 2.0, 0.5);

/// Edge length in world units of one tile of the wall's texture.
const WALL_TILE: f64 = 2.0;

/// Generates a rock with 7,000 triangles and an image of broken rock, without clips and levels of detail. The rock is about two
/// units wide and one and a half high; its foot is slightly below the origin. Texture coordinates go from 0 to 1 on each of its
/// six sides.
///
/// # Errors
/// Never fails in practice: the mesh is checked like the mesh of any other model.
pub fn rock() -> Result<Model, InputError> {
    let mut builder = Builder::default();
    for side in SIDES {
        builder.side(ROCK_CELLS, |u, v| {
            let point = |u: f64, v: f64| rock_point(side.at(u, v));
            let step = 0.25 / f64::from(ROCK_CELLS);
            let along = |a: DVec3, b: DVec3| b - a;
            let normal = along(point(u - step, v), point(u + step, v))
                .cross(along(point(u, v + step), point(u, v - step)));
            (point(u, v), normal.normalize_or(DVec3::Y), [u, v])
        });
    }
    let mut texels = TerrainTexture::built_in(BuiltIn::Hill).mips.swap_remove(0);
    // The rock is opaque, so the heights in the texture's alpha channel are replaced by 255.
    texels.chunks_exact_mut(4).for_each(|texel| texel[3] = 255);
    let image = image::RgbaImage::from_raw(TEXTURE_SIZE, TEXTURE_SIZE, texels);
    builder.model("rock", [1.0, 0.96, 0.9, 1.0], image)
}

/// Generates a wall of 4 × 2 × 0.5 units in a plain colour. It stands on the origin, and its length is along x. Texture
/// coordinates grow by 1 every two units.
///
/// # Errors
/// Never fails in practice: the mesh is checked like the mesh of any other model.
pub fn wall() -> Result<Model, InputError> {
    let mut builder = Builder::default();
    for side in SIDES {
        builder.side(1, |u, v| {
            let place = 0.5 * side.at(u, v) * WALL;
            let [width, height] = [side.along, side.up].map(|axis| (axis * WALL).length() / WALL_TILE);
            (place + 0.5 * WALL.y * DVec3::Y, side.out, [u * width, v * height])
        });
    }
    builder.model("wall", [0.62, 0.60, 0.57, 1.0], None)
}

/// A side of the cube from −1 to 1: outward normal, direction of u, and direction of −v.
struct Side {
    out: DVec3,
    along: DVec3,
    up: DVec3,
}

const SIDES: [Side; 6] = [
    Side { out: DVec3::Z, along: DVec3::X, up: DVec3::Y },
    Side { out: DVec3::NEG_Z, along: DVec3::NEG_X, up: DVec3::Y },
    Side { out: DVec3::X, along: DVec3::NEG_Z, up: DVec3::Y },
    Side { out: DVec3::NEG_X, along: DVec3::Z, up: DVec3::Y },
    Side { out: DVec3::Y, along: DVec3::X, up: DVec3::NEG_Z },
    Side { out: DVec3::NEG_Y, along: DVec3::X, up: DVec3::Z },
];

impl Side {
    fn at(&self, u: f64, v: f64) -> DVec3 {
        self.out + (2.0 * u - 1.0) * self.along + (1.0 - 2.0 * v) * self.up
    }
}

/// Point on the rock's surface, in the direction of a point on the cube.
fn rock_point(cube: DVec3) -> DVec3 {
    let direction = cube.normalize_or(DVec3::Y);
    // The rock is a ball. Planes that cut the ball make edges, and noise makes the edges uneven.
    let cut = |normal: DVec3, distance: f64| {
        let cosine = direction.dot(normal.normalize_or(DVec3::Y));
        if cosine > 0.0 { distance / cosine } else { f64::INFINITY }
    };
    let planes = [
        cut(DVec3::new(0.3, 1.0, 0.1), 0.82),
        cut(DVec3::new(-0.8, 0.9, 0.3), 0.86),
        cut(DVec3::new(0.9, 0.5, 0.6), 0.88),
        cut(DVec3::new(-0.2, 0.3, 1.0), 0.84),
        cut(DVec3::new(-1.0, 0.1, -0.5), 0.9),
        cut(DVec3::new(0.5, 0.2, -1.0), 0.85),
        cut(DVec3::new(1.0, -0.1, -0.2), 0.93),
    ];
    let sharp = planes.into_iter().fold(1.0, f64::min);
    let rough: f64 = [(2.0, 0.10), (5.0, 0.05), (11.0, 0.022)]
        .into_iter()
        .map(|(frequency, height)| height * noise(frequency * direction))
        .sum();
    (sharp + rough) * direction * DVec3::new(1.05, 0.8, 0.9) + 0.55 * DVec3::Y
}

/// Value noise between −1 and 1: random values at integer points, interpolated smoothly.
fn noise(at: DVec3) -> f64 {
    let low = at.floor();
    let part = at - low;
    let smooth = part * part * (DVec3::splat(3.0) - 2.0 * part);
    let corner = |x: usize, y: usize, z: usize| {
        let [x, y, z] =
            (low + DVec3::new(x as f64, y as f64, z as f64)).to_array().map(|at| at as i32 as u32);
        let (first, _) = threefry2x32([0x726f_636b, z], [x; LANES], [y; LANES]);
        f64::from(first[0]) / 2_147_483_648.0 - 1.0
    };
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    let row = |y: usize, z: usize| mix(corner(0, y, z), corner(1, y, z), smooth.x);
    let slice = |z: usize| mix(row(0, z), row(1, z), smooth.y);
    mix(slice(0), slice(1), smooth.z)
}

/// A mesh to which sides are added one after the other.
#[derive(Default)]
struct Builder {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uv: Vec<[f32; 2]>,
    indices: Vec<u32>,
}

impl Builder {
    /// Adds a grid of `cells` × `cells`. `vertex(u, v)` returns position, normal and texture coordinates for u and v from 0 to 1.
    fn side(&mut self, cells: u32, vertex: impl Fn(f64, f64) -> (DVec3, DVec3, [f64; 2])) {
        let first = self.positions.len() as u32;
        let part = |index: u32| f64::from(index) / f64::from(cells);
        for (row, column) in (0..=cells).flat_map(|row| (0..=cells).map(move |column| (row, column))) {
            let (position, normal, uv) = vertex(part(column), part(row));
            self.positions.push(position.as_vec3().into());
            self.normals.push(normal.as_vec3().into());
            self.uv.push(uv.map(|coordinate| coordinate as f32));
        }
        for (row, column) in (0..cells).flat_map(|row| (0..cells).map(move |column| (row, column))) {
            let north = first + row * (cells + 1) + column;
            let south = north + cells + 1;
            self.indices.extend([north, south, north + 1, north + 1, south, south + 1]);
        }
    }

    fn model(
        self,
        name: &str,
        color: [f32; 4],
        image: Option<image::RgbaImage>,
    ) -> Result<Model, InputError> {
        let bone = Bone { name: name.to_owned(), parent: None, rest: Transform::IDENTITY };
        let tangents = solved_tangents(&self.positions, &self.normals, &self.uv, &self.indices)?;
        let mesh = Mesh {
            name: name.to_owned(),
            tangents,
            influences: Influences::rigid(self.positions.len()),
            positions: self.positions,
            normals: self.normals,
            uv: self.uv,
            indices: self.indices,
            material: Some(0),
            ..Mesh::default()
        };
        let texture = image.is_some().then(|| Texture { image: 0, sampling: Sampling::default() });
        let material = Material { texture, ..Material::opaque(name, color) };
        Ok(Model {
            skeleton: Skeleton::of_joints(vec![bone])?,
            skins: vec![Skin {
                name: name.to_owned(),
                bones: vec![0],
                inverse_binds: vec![glam::Mat4::IDENTITY.to_cols_array()],
            }],
            clips: Vec::new(),
            motion: None,
            meshes: vec![mesh],
            skinned: 0,
            materials: vec![material],
            images: image.into_iter().map(Into::into).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn shapes_are_closed_and_face_outwards() {
        for (model, height) in [(rock(), 1.1..1.7), (wall(), 1.99..2.01)] {
            let model = model.expect("valid");
            let mesh = &model.meshes[0];
            assert_eq!(mesh.validate(&model.skins), Ok(()));
            let at = |vertex: u32| Vec3::from(mesh.positions[vertex as usize]);
            let (mut volume, mut facing) = (0.0, 1.0_f32);
            for corners in mesh.indices.as_chunks::<3>().0 {
                let [a, b, c] = corners.map(at);
                volume += a.dot(b.cross(c)) / 6.0;
                let face = (b - a).cross(c - a).normalize();
                let normal = |vertex: u32| Vec3::from(mesh.normals[vertex as usize]);
                facing = corners.iter().map(|vertex| face.dot(normal(*vertex))).fold(facing, f32::min);
            }
            assert!(volume > 1.0 && facing > 0.0, "{}: {volume}, {facing}", mesh.name);
            let heights = mesh.positions.iter().map(|position| position[1]);
            let (low, high) = heights.fold((f32::MAX, f32::MIN), |(low, high), y| (low.min(y), high.max(y)));
            assert!(height.contains(&(high - low)) && low <= 0.0 && low > -0.4, "{low} to {high}");
        }
    }
}
