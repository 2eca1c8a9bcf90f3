//! Terrain looks the same for any origin of its sample coordinates.

use glam::{DVec3, IVec2, Mat4, Vec3};

use super::stage::{FORMAT, SIZE, Stage, differing, drawn, gpu, through};
use crate::asset::transform::AFFINE_IDENTITY;
use crate::gpu::{Buffer, Gpu, Group, Uniform};
use crate::render::{Layer, TargetFormat};
use crate::scene::layouts::SceneLayouts;
use crate::scene::terrain::nowhere;
use crate::scene::terrain::{TerrainDrawable, TerrainGeometry, patch_indices};
use crate::scene::{Camera, Placement, TerrainStyle};
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch, TerrainView};
use crate::shared::render::scene_view::SceneView;
use crate::terrain::blend::Shading;
use crate::terrain::config::{HEIGHT_ONE, TerrainConfig};
use crate::terrain::cover::{TILES_PERIOD, planes};
use crate::terrain::fields::Fields;
use crate::terrain::generator::Generator;
use crate::terrain::materials::Materials;
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::TerrainTexture;

const PATCHES: [[i32; 2]; 4] = [[0, 0], [1, 0], [0, 1], [1, 1]];

/// Four patches of terrain.
pub struct Land {
    pub config: TerrainConfig,
    fields: Fields,
}

impl Land {
    pub fn new(gpu: &Gpu) -> Self {
        let text = r#"{"patchSize": 33, "scaleFactor": 40.0, "seed": "a land"}"#;
        let config = TerrainConfig::from_json(text).expect("valid");
        let generator = Generator::new(gpu, Recipe::new(config.clone())).expect("compiled");
        let mut parts = generator.generate(gpu, &PATCHES, 1, &mut |_| ()).expect("generated");
        Self { config, fields: parts.remove(0) }
    }

    fn zones(&self, gpu: &Gpu) -> Materials {
        let textures = TerrainTexture::of_zones(&self.config.zones).expect("built in");
        Materials::new(gpu, &self.config.zones, &textures).expect("uploaded")
    }

    /// The terrain as a drawable object.
    pub fn drawable(&self, gpu: &Gpu, layouts: &SceneLayouts, style: TerrainStyle) -> (TerrainDrawable, u32) {
        let TerrainConfig { patch_size: size, terrain_scale, .. } = self.config;
        let tiles = self.config.tiles_per_patch();
        let zones = self.zones(gpu);
        let params = TerrainParams {
            in_width: self.fields.width,
            size,
            spacing: terrain_scale as f32,
            run: (2.0 * terrain_scale * HEIGHT_ONE) as f32,
            tiling: (tiles / f64::from(size - 1)) as f32,
            tiles_per_unit: (1.0 / self.config.tile()) as f32,
            zone_count: zones.zone_count,
            additive: Shading::default().weights.code(),
            planes: planes(self.config.triplanar),
            variation: self.config.variation as f32,
            first_patch: 0,
            normals_width: 0,
            relief_depth: 0.0,
            relief_distance: 1.0,
            erosion_depth: 0.0,
            unused: 0.0,
        };
        let patch = |(window, patch): (u32, [i32; 2])| TerrainPatch {
            origin: patch.map(|at| at * (size as i32 - 1)),
            uv: patch.map(|at| (f64::from(at) * tiles).rem_euclid(f64::from(TILES_PERIOD)) as f32),
            window,
            level: 0,
            holes: 0,
            eroded: window,
        };
        let patches: Vec<_> = (0..).zip(PATCHES).map(patch).collect();
        let indices = patch_indices(size);
        let geometry = TerrainGeometry {
            params: Uniform::new(gpu, "terrain", &params).expect("uploaded"),
            heights: self.fields.heights.clone(),
            patches: Buffer::from_slice(gpu, "patches", &patches).expect("uploaded"),
            indices: Buffer::from_slice(gpu, "indices", &indices).expect("uploaded"),
            zones,
            holes: Buffer::new(gpu, "holes", 1).expect("allocated"),
            has_holes: false,
            normals: Buffer::new(gpu, "normals", 1).expect("allocated"),
        };
        let terrain = TerrainDrawable::new(gpu, layouts, geometry, style).expect("bound");
        (terrain, indices.len() as u32)
    }

    /// The ground with sample coordinates counted from `base`, in a view whose cell corner is the first sample.
    pub fn ground(&self, gpu: &Gpu, layouts: &SceneLayouts, base: [i32; 2]) -> Group {
        let rest = base.map(|at| (f64::from(at) * self.config.terrain_scale) as f32);
        let rest = Vec3::new(rest[0], 0.0, rest[1]);
        let ground = TerrainView { base: IVec2::from(base), rest, ..nowhere(1) };
        let nodes = Buffer::new(gpu, "nodes", 1).expect("allocated");
        layouts.ground(gpu, &Uniform::new(gpu, "ground", &ground).expect("uploaded"), &nodes).expect("bound")
    }

    /// The width of the land, in world units.
    fn edge(&self) -> f64 {
        2.0 * f64::from(self.config.patch_size - 1) * self.config.terrain_scale
    }

    /// A view of the whole land, with the light of the default [`Shading`]. The land lies in the camera's cell or below this
    /// cell.
    pub fn view(&self) -> SceneView {
        let high = DVec3::new(self.edge(), 0.2 * self.edge(), self.edge());
        let framed = Camera::framing(DVec3::ZERO, high, SIZE);
        let shift = glam::IVec3::from(framed.cell).as_vec3() * -Placement::CELL;
        let clip_from_world = framed.clip_from_cell() * Mat4::from_translation(shift);
        let shading = Shading::default();
        let light = Vec3::from(shading.light).extend(shading.ambient);
        SceneView { light, ..through(clip_from_world, (framed.eye_offset() - shift).extend(1.0)) }
    }

    pub fn stage(&self, gpu: &Gpu, layouts: &SceneLayouts, indices: u32) -> Stage {
        Stage::new(gpu, layouts, self.view(), &[AFFINE_IDENTITY; 4], &[[0, indices]])
    }
}

/// Another origin of the samples moves edges only by rounding errors, which are a fraction of a pixel. The test also fails if
/// quads are divided along the other diagonal.
#[test]
fn terrain_looks_the_same_from_any_sample() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let land = Land::new(&gpu);
    let format = TargetFormat::new(FORMAT);
    let (drawable, indices) = land.drawable(&gpu, &layouts, TerrainStyle::Textured);
    let stage = land.stage(&gpu, &layouts, indices);
    let from = |drawable: &TerrainDrawable, base| {
        let ground = land.ground(&gpu, &layouts, base);
        drawn(&gpu, &format, drawable, &stage, Some(&ground), &[Layer::Color])
    };
    let expected = from(&drawable, [0, 0]);
    let elsewhere = from(&drawable, [13, -7]);
    assert!(differing(&elsewhere, &expected, 2) < 40, "{}", differing(&elsewhere, &expected, 2));
    let covered = expected.iter().filter(|pixel| **pixel != [0; 4]).count();
    assert!(covered > 5000, "{covered} pixels");
    let mut turned = drawable;
    let cells = patch_indices(land.config.patch_size);
    let other = cells.chunks(6).flat_map(|cell| {
        let [a, b, c, d] = [cell[0], cell[1], cell[2], cell[5]];
        [a, b, d, a, d, c]
    });
    turned.geometry.indices =
        Buffer::from_slice(&gpu, "indices", &other.collect::<Vec<_>>()).expect("uploaded");
    let wrong = from(&turned, [0, 0]);
    assert!(differing(&wrong, &expected, 1) > 200, "{}", differing(&wrong, &expected, 1));
}

/// A wide view of a plane from below the ground shows sky through every crack between patches.
#[test]
fn no_crack_opens_between_patches_far_from_the_origin() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let land = Land::new(&gpu);
    let (drawable, indices) = land.drawable(&gpu, &layouts, TerrainStyle::Textured);
    let edge = land.edge() as f32;
    // Straight down on the middle, where four patches meet, at a coordinate that f32 cannot represent exactly.
    let eye = Vec3::new(0.5 * edge, 0.6 * edge, 0.5 * edge);
    let look = glam::camera::rh::view::look_at_mat4(eye, eye - Vec3::Y, Vec3::NEG_Z);
    let clip = glam::camera::rh::proj::directx::perspective(0.8, 1.5, 1.0, 10.0 * edge) * look;
    let seen = through(clip * Mat4::from_translation(Vec3::new(0.1, 0.0, 0.3)), eye.extend(1.0));
    let stage = Stage::new(&gpu, &layouts, seen, &[AFFINE_IDENTITY; 4], &[[0, indices]]);
    let format = TargetFormat::new(FORMAT);
    for base in [[0, 0], [7, 11], [-4097, 8191]] {
        let ground = land.ground(&gpu, &layouts, base);
        let found = drawn(&gpu, &format, &drawable, &stage, Some(&ground), &[Layer::Color]);
        let sky = found.iter().filter(|pixel| **pixel == [0; 4]).count();
        assert_eq!(sky, 0, "{base:?}");
    }
}
