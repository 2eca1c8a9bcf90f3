//! Terrain on the device: heights that are generated or the caller's, and what is drawn of them.

use super::source::{Origin, TerrainSource, check_fields, check_once, check_patches};
use super::{Terrain, extremes, placed};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::drawable::{Drawable, TerrainDrawable, TerrainGeometry, patch_indices};
use crate::scene::instances::Instances;
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::{Drawn, NOTHING};
use crate::shared::lod::object::{OBJECT_LISTS, SceneDraw};
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::terrain::config::{Config, HEIGHT_ONE};
use crate::terrain::fields::Fields;
use crate::terrain::generator::Generator;
use crate::terrain::ground::Ground;
use crate::terrain::materials::Materials;
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::Texture;
use crate::{Error, InputError};

/// The samples around each patch that the scene generates: shading reads one.
const MARGIN: u32 = 1;

/// Makes terrain: what a scene keeps of it, its patches as instances, and how it is drawn.
pub(in crate::scene) async fn made(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    source: &TerrainSource,
) -> Result<(Terrain, Instances, Drawn), Error> {
    let TerrainSource { patches, textures, .. } = source;
    let config = source.config();
    let fields = match &source.origin {
        Origin::Recipe(recipe) => generated(gpu, recipe, patches).await?,
        Origin::Fields { config, fields } => {
            check_fields(config, fields)?;
            check_patches(config, fields, patches)?;
            fields.clone()
        }
    };
    let textures = match textures {
        Some(textures) => textures.clone(),
        None => Texture::of_zones(&config.zones)?,
    };
    let mut ground = Ground::new(config)?;
    let mut instances = Instances::new(fields.count as usize);
    let margin = (fields.width - config.patch_size) / 2;
    for ((at, patch), heights) in patches.iter().enumerate().zip(&fields.read(gpu).await?) {
        ground.insert(*patch, heights, margin)?;
        let (placement, sphere) = placed(config, (at, *patch), extremes(heights))?;
        instances.spawn(&placement, &sphere);
    }
    let (drawable, draws) = drawable((gpu, layouts), source, &fields, &textures)?;
    let (edge, spacing) = (config.edge_length(), config.terrain_scale);
    let terrain = Terrain { ground, edge, spacing, source: source.clone() };
    Ok((terrain, instances, (vec![drawable], draws)))
}

/// Generates the heights of a recipe, which one binding must hold.
async fn generated(gpu: &Gpu, recipe: &Recipe, patches: &[[i32; 2]]) -> Result<Fields, Error> {
    if patches.is_empty() {
        return Err(InputError::new("patches", "none", "must be at least one").into());
    }
    check_once(patches)?;
    let generator = Generator::new(gpu, recipe.clone())?;
    let mut parts = generator.generate_async(gpu, patches, MARGIN, &mut |_| ()).await?;
    if parts.len() > 1 {
        let bound =
            format!("must be at most {}, which one binding holds: add several terrains", parts[0].count);
        return Err(InputError::new("patches.len", patches.len(), bound).into());
    }
    Ok(parts.remove(0))
}

fn drawable(
    (gpu, layouts): (&Gpu, &SceneLayouts),
    source: &TerrainSource,
    fields: &Fields,
    textures: &[Texture],
) -> Result<(Drawable, Vec<SceneDraw>), Error> {
    let config = source.config();
    let zones = Materials::new(gpu, &config.zones, textures)?;
    let size = config.patch_size;
    let params = TerrainParams {
        in_width: fields.width,
        size,
        spacing: config.terrain_scale as f32,
        run: (2.0 * config.terrain_scale * HEIGHT_ONE) as f32,
        tiling: (config.tiles_per_patch() / f64::from(size - 1)) as f32,
        zone_count: zones.zone_count,
        additive: source.shading.weights.code(),
    };
    let patches = Buffer::new(gpu, "patches", fields.count.max(1) as usize)?;
    if !source.patches.is_empty() {
        patches.write(gpu, &listed(config, &source.patches))?;
    }
    let indices = patch_indices(size);
    let draw = SceneDraw { indices: indices.len() as u32, ..NOTHING };
    let geometry = TerrainGeometry {
        params: Uniform::new(gpu, "terrain", &params)?,
        heights: fields.heights.clone(),
        patches,
        indices: Buffer::from_slice(gpu, "triangles of a patch", &indices)?,
        zones,
    };
    let mut draws = vec![NOTHING; OBJECT_LISTS as usize];
    draws[0] = draw;
    let terrain = TerrainDrawable::new(gpu, layouts, geometry, source.style)?;
    Ok((Drawable::Terrain(terrain), draws))
}

/// Patches as shaders see them, the first with the first window.
pub(in crate::scene) fn listed(config: &Config, patches: &[[i32; 2]]) -> Vec<TerrainPatch> {
    let (edge, tiles) = (config.patch_size as i32 - 1, config.tiles_per_patch());
    let patch = |(window, patch): (u32, &[i32; 2])| TerrainPatch {
        origin: patch.map(|index| index.wrapping_mul(edge)),
        uv: patch.map(|index| (f64::from(index) * tiles).rem_euclid(1.0) as f32),
        window,
        unused: 0,
    };
    (0..).zip(patches).map(patch).collect()
}
