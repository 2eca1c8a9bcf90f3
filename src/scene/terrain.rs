//! Terrain in a scene: patches of one recipe, generated on the device, each an instance.

use std::collections::HashSet;

use glam::{DVec3, Vec3};

use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::drawable::{Drawable, TerrainDrawable, TerrainGeometry, patch_indices};
use crate::scene::instances::Instances;
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::{Drawn, NOTHING};
use crate::scene::placement::Placement;
use crate::scene::ray::SurfaceHit;
use crate::shared::lod::object::{OBJECT_LISTS, SceneDraw};
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::terrain::blend::Shading;
use crate::terrain::config::{Config, HEIGHT_ONE};
use crate::terrain::fields::Fields;
use crate::terrain::generator::Generator;
use crate::terrain::ground::Ground;
use crate::terrain::materials::Materials;
use crate::terrain::mesh::GroundPoint;
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::Texture;
use crate::{Error, InputError};

/// The samples around each patch: shading reads one.
const MARGIN: u32 = 1;

/// Terrain for [`Scene::add_terrain`](crate::scene::Scene::add_terrain): a recipe, the patches to show, and the textures of
/// its zones. The origin of the world is the first sample of patch (0, 0), in the north-west; an edge of a patch is
/// [`Config::terrain_scale`] · ([`Config::patch_size`] − 1) world units long, and a height unit is a world unit.
#[derive(Debug, Clone)]
pub struct TerrainSource {
    recipe: Recipe,
    patches: Vec<[i32; 2]>,
    textures: Option<Vec<Texture>>,
    pub(super) shading: Shading,
}

impl TerrainSource {
    /// Patch (0, 0) of a configuration, with the textures that its zones name.
    pub fn new(config: Config) -> Self {
        Recipe::new(config).into()
    }

    /// Shows these patches instead, each given once: its column, counted to the east, and its row, counted to the south.
    #[must_use]
    pub fn with_patches(self, patches: &[[i32; 2]]) -> Self {
        Self { patches: patches.to_vec(), ..self }
    }

    /// Takes these textures, one for each zone of the configuration.
    #[must_use]
    pub fn with_textures(self, textures: Vec<Texture>) -> Self {
        Self { textures: Some(textures), ..self }
    }

    /// Blends zones as `shading` says. Its light is not used: a scene has one light.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }
}

impl From<Recipe> for TerrainSource {
    /// Patch (0, 0) of a recipe, with features, despiking and erosion as it says.
    fn from(recipe: Recipe) -> Self {
        Self { recipe, patches: vec![[0, 0]], textures: None, shading: Shading::default() }
    }
}

/// What a view needs to know of a terrain.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SeenTerrain {
    /// World units between samples.
    pub spacing: f64,
    /// The number of the object.
    pub object: u32,
}

/// Terrain in a scene.
#[derive(Debug)]
pub(super) struct Terrain {
    ground: Ground,
    /// The patch of each instance.
    patches: Vec<[i32; 2]>,
    /// World units along an edge of a patch.
    edge: f64,
    /// World units between samples.
    pub spacing: f64,
    /// What it was generated from.
    pub source: TerrainSource,
}

impl Terrain {
    /// The first hit of a patch by a ray with a unit direction, relative to the corner of a cell.
    pub fn hit(
        &self,
        index: u32,
        cell: [i32; 3],
        [at, direction]: [DVec3; 2],
        limit: f64,
    ) -> Option<SurfaceHit> {
        let patch = *self.patches.get(index as usize)?;
        let corner = DVec3::from(cell.map(f64::from)) * f64::from(Placement::CELL);
        let [x, z] = patch.map(|index| f64::from(index) * self.edge);
        let at = at + (corner - DVec3::new(x, 0.0, z));
        let hit = self.ground.hit(patch, [at, direction], limit)?;
        // The ground is seen from both sides.
        Some(SurfaceHit { distance: hit.distance, normal: hit.normal })
    }

    /// The ground at a position of the world, east and south of its origin.
    pub fn point_at(&self, x: f64, z: f64) -> Option<GroundPoint> {
        self.ground.point_at(x, z)
    }
}

/// Generates terrain: what a scene keeps of it, its patches as instances, and how it is drawn.
pub(super) async fn generated(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    source: &TerrainSource,
) -> Result<(Terrain, Instances, Drawn), Error> {
    let TerrainSource { recipe, patches, textures, .. } = source;
    let config = &recipe.config;
    if patches.is_empty() {
        return Err(InputError::new("patches", "none", "must be at least one").into());
    }
    let mut known = HashSet::new();
    if let Some(at) = patches.iter().position(|patch| !known.insert(patch)) {
        let path = format!("patches[{at}]");
        return Err(InputError::new(path, format!("{:?}", patches[at]), "must not be given twice").into());
    }
    let generator = Generator::new(gpu, recipe.clone())?;
    let mut parts = generator.generate_async(gpu, patches, MARGIN, &mut |_| ()).await?;
    if parts.len() > 1 {
        let bound =
            format!("must be at most {}, which one binding holds: add several terrains", parts[0].count);
        return Err(InputError::new("patches.len", patches.len(), bound).into());
    }
    let fields = parts.remove(0);
    let heights = fields.read(gpu).await?;
    let mut ground = Ground::new(config)?;
    let mut instances = Instances::new(patches.len());
    for (patch, heights) in patches.iter().zip(&heights) {
        ground.insert(*patch, heights, MARGIN)?;
        let (placement, sphere) = bounds(config, *patch, heights);
        instances.spawn(&placement.checked()?, &sphere);
    }
    let textures = match textures {
        Some(textures) => textures.clone(),
        None => Texture::of_zones(&config.zones)?,
    };
    let (drawable, draws) = drawable((gpu, layouts), source, &fields, &textures)?;
    let terrain = Terrain {
        ground,
        patches: patches.clone(),
        edge: config.edge_length(),
        spacing: config.terrain_scale,
        source: source.clone(),
    };
    Ok((terrain, instances, (vec![drawable], draws)))
}

fn drawable(
    (gpu, layouts): (&Gpu, &SceneLayouts),
    source: &TerrainSource,
    fields: &Fields,
    textures: &[Texture],
) -> Result<(Drawable, Vec<SceneDraw>), Error> {
    let config = &source.recipe.config;
    let zones = Materials::new(gpu, &config.zones, textures)?;
    let (size, tiles) = (config.patch_size, config.tiles_per_patch());
    let edge = size as i32 - 1;
    let params = TerrainParams {
        in_width: fields.width,
        size,
        spacing: config.terrain_scale as f32,
        run: (2.0 * config.terrain_scale * HEIGHT_ONE) as f32,
        tiling: (tiles / f64::from(edge)) as f32,
        zone_count: zones.zone_count,
        additive: source.shading.weights.code(),
    };
    let patch = |(window, patch): (u32, &[i32; 2])| TerrainPatch {
        origin: patch.map(|index| index.wrapping_mul(edge)),
        uv: patch.map(|index| (f64::from(index) * tiles).rem_euclid(1.0) as f32),
        window,
        unused: 0,
    };
    let patches: Vec<_> = (0..).zip(&source.patches).map(patch).collect();
    let indices = patch_indices(size);
    let draw = SceneDraw { indices: indices.len() as u32, ..NOTHING };
    let geometry = TerrainGeometry {
        params: Uniform::new(gpu, "terrain", &params)?,
        heights: fields.heights.clone(),
        patches: Buffer::from_slice(gpu, "patches", &patches)?,
        indices: Buffer::from_slice(gpu, "triangles of a patch", &indices)?,
        zones,
    };
    let mut draws = vec![NOTHING; OBJECT_LISTS as usize];
    draws[0] = draw;
    Ok((Drawable::Terrain(TerrainDrawable::new(gpu, layouts, geometry)?), draws))
}

/// The middle of a patch on the plane, and a sphere around its heights.
fn bounds(config: &Config, patch: [i32; 2], heights: &[i32]) -> (Placement, BoundingSphere) {
    let edge = config.edge_length();
    let middle = patch.map(|index| (f64::from(index) + 0.5) * edge);
    let lowest = heights.iter().min().map_or(0.0, |height| f64::from(*height) / HEIGHT_ONE);
    let highest = heights.iter().max().map_or(0.0, |height| f64::from(*height) / HEIGHT_ONE);
    let half = DVec3::new(edge / 2.0, (highest - lowest) / 2.0, edge / 2.0);
    let center = Vec3::new(0.0, ((lowest + highest) / 2.0) as f32, 0.0);
    // Larger by a little, for rounding.
    let sphere = BoundingSphere { center, radius: (1.000_01 * half.length()) as f32 };
    (Placement::at_world([middle[0], 0.0, middle[1]]), sphere)
}
