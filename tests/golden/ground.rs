//! Objects on the ground touch it: the depth of every pixel is that of the triangle which the CPU finds.

use glam::{DMat4, DVec3, Vec3};
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::ground::Ground;
use relievo::ops::terrain::mesh::HeightField;
use relievo::ops::terrain::recipe::Recipe;
use relievo::render::Offscreen;
use relievo::scene::{Camera, ObjectId, Placement, Scene, TerrainSource};

use crate::harness::{gpu, is_coarse};

const EDGE: u32 = 256;
const ORIGIN: [i32; 2] = [-3, 70_000];

/// What a picture of 2×2 patches shows.
struct Seen {
    /// The points of all pixels, from their depths, relative to the first patch.
    points: Vec<DVec3>,
    /// The scene that was drawn, and its terrain.
    scene: Scene,
    land: ObjectId,
    /// The ground on the CPU.
    ground: Ground,
    /// For comparison, the whole as one field.
    whole: HeightField,
    /// World units from the origin to the first patch.
    corner: DVec3,
}

fn seen() -> Seen {
    let gpu = gpu();
    let config =
        TerrainConfig { terrain_scale: 0.25, ..TerrainConfig::new(17, 12.0, "ground").expect("valid") };
    let patches = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [ORIGIN[0] + x, ORIGIN[1] + y]);
    let generator = Generator::new(&gpu, Recipe::new(config.clone())).expect("valid");
    let fields = generator.generate(&gpu, &patches, 1, &mut |_| ()).expect("generated").remove(0);
    let mut scene = Scene::new(&gpu).expect("compiled");
    let source = TerrainSource::from_fields(config.clone(), fields.clone(), &patches);
    let land = scene.add_terrain(&source).expect("added");
    // From above, and a little aside, so that no ray is straight.
    let [x, z] = ORIGIN.map(|index| 4.0 * f64::from(index));
    let corner = DVec3::new(x, 0.0, z);
    let Placement { cell, offset: eye, .. } = Placement::at_world(corner + DVec3::new(3.0, 60.0, 5.0));
    let camera = Camera::looking_at(eye, eye + Vec3::new(1.0, -60.0, -1.0), 0.12, [20.0, 100.0], [EDGE; 2]);
    let camera = Camera { cell, ..camera };
    let target = Offscreen::new(&gpu, [EDGE; 2]).expect("allocated");
    target.draw(&mut scene, camera, [0.0; 3]).expect("drawn");
    let clip_from_world = camera.clip_from_cell().to_cols_array().map(f64::from);
    let world_from_clip = DMat4::from_cols_array(&clip_from_world).inverse();
    let shift = DVec3::from(cell.map(f64::from)) * f64::from(Placement::CELL) - corner;
    let middle = |pixel: usize| (2 * pixel + 1) as f64 / f64::from(EDGE) - 1.0;
    let points = (target.read_depth(&gpu).expect("read").into_iter().enumerate())
        .filter(|(_, depth)| *depth < 1.0)
        .map(|(pixel, depth)| {
            let (x, y) = (pixel % EDGE as usize, pixel / EDGE as usize);
            world_from_clip.project_point3(DVec3::new(middle(x), -middle(y), depth.into())) + shift
        })
        .collect();
    let mut ground = Ground::new(&config).expect("valid");
    let heights = fields.heights.read_blocking(&gpu).expect("read");
    let mut whole = vec![0; 33 * 33];
    for ((index, patch), window) in patches.iter().enumerate().zip(heights.chunks_exact(19 * 19)) {
        ground.insert(*patch, window, 1).expect("19² heights");
        let first = (index % 2 * 16, index / 2 * 16);
        for (y, x) in (0..17).flat_map(|y| (0..17).map(move |x| (y, x))) {
            whole[(first.1 + y) * 33 + first.0 + x] = window[(y + 1) * 19 + x + 1];
        }
    }
    let whole = HeightField::new(whole, 33, 0.25).expect("square");
    Seen { points, scene, land, ground, whole, corner }
}

/// The height between the samples of a cell on a bilinear surface, which is not the one that is drawn.
fn bilinear(field: &HeightField, column: f64, row: f64) -> Option<f64> {
    let (u, v) = (column.fract(), row.fract());
    let corner = |dx: usize, dy: usize| field.point(column as usize + dx, row as usize + dy);
    let top = corner(0, 0)? * (1.0 - u) + corner(1, 0)? * u;
    let bottom = corner(0, 1)? * (1.0 - u) + corner(1, 1)? * u;
    Some(top * (1.0 - v) + bottom * v)
}

#[test]
fn the_picture_shows_the_triangles_that_the_cpu_answers() {
    let Seen { points, scene, land, ground, whole, corner } = seen();
    let (mut inside, mut worst, mut worst_bilinear, mut apart) = (0, 0.0_f64, 0.0_f64, 0.0_f64);
    for point in &points {
        // Rounding may move points on the outer edge of the patches out of them.
        let Some(answer) = ground.point_from(ORIGIN, point.x, point.z) else { continue };
        let own = scene.ground(land, corner.x + point.x, corner.z + point.z).expect("terrain");
        // Far from the origin, adding the corner rounds a position by 2⁻³⁵ units, on slopes below 60.
        let off = own.map_or(f64::INFINITY, |own| (own.height - answer.height).abs());
        apart = apart.max(off);
        inside += 1;
        worst = worst.max((answer.height - point.y).abs());
        let other = bilinear(&whole, point.x / 0.25, point.z / 0.25).unwrap_or(answer.height);
        worst_bilinear = worst_bilinear.max((other - point.y).abs());
    }
    println!(
        "{inside} pixels: triangles within {worst:.5} of the picture, bilinear within {worst_bilinear:.4}"
    );
    assert!(inside > 45_000 && inside + 500 > points.len(), "{inside} of {}", points.len());
    assert!(apart < 1e-6, "the scene's own ground is {apart} off");
    // Slopes here are below 60 (12 units of height on a quarter). A rasterizer with `bits` below the pixel moves vertices by
    // half a step of 2^-bits pixels of 0.03 units each way; Vulkan asks for 4 bits, which SwiftShader has, others have 8.
    // Depth in f32 adds z² / near · 2⁻²⁴ for every rounding.
    let bound = if is_coarse() { 0.08 } else { 5e-3 };
    assert!(worst < bound, "{worst}");
    assert!(worst_bilinear > 0.5, "a bilinear surface would pass: {worst_bilinear}");
}
