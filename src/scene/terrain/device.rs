//! Terrain on the device: its drawables, and its heights, which the scene generates or the caller provides.

use super::drawable::{TerrainDrawable, TerrainGeometry, patch_indices};
use super::morphing::Morphing;
use super::source::{Origin, TerrainSource, check_fields, check_once, check_patches};
use super::{Terrain, extremes, placed};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::chunk::Chunk;
use crate::scene::instances::Instances;
use crate::scene::layouts::SceneLayouts;
use crate::scene::mesh::NOTHING;
use crate::shared::lod::object::{OBJECT_LEVELS, SceneDraw};
use crate::shared::render::scene_terrain::{TerrainParams, TerrainPatch};
use crate::terrain::config::{HEIGHT_ONE, TerrainConfig};
use crate::terrain::cover::{TILES_PERIOD, planes};
use crate::terrain::fields::Fields;
use crate::terrain::generator::Generator;
use crate::terrain::ground::Ground;
use crate::terrain::materials::Materials;
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::TerrainTexture;
use crate::{Error, InputError};

/// Number of samples beyond each edge of a generated patch. One is enough for shading.
pub(super) const MARGIN: u32 = 1;

/// Creates terrain: data on the host, one instance per patch, and drawables. The heights are in parts that each fit one
/// binding of the device. Each part becomes a chunk.
pub(in crate::scene) async fn made(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    source: &TerrainSource,
) -> Result<(Terrain, Instances, (Vec<Chunk>, Vec<SceneDraw>)), Error> {
    let TerrainSource { patches, .. } = source;
    source.check_target()?;
    let config = source.config();
    let mut morphing = None;
    let parts = match &source.origin {
        Origin::Recipe(recipe) => {
            let parts = generated(gpu, recipe, patches).await?;
            match &source.target {
                Some((target, morph)) => {
                    let target = generated(gpu, target, patches).await?;
                    morphing.insert(Morphing::new(gpu, [parts, target], *morph).await?).fields()
                }
                None => parts,
            }
        }
        Origin::Fields { config, fields } => {
            check_fields(config, fields)?;
            check_patches(config, fields, patches)?;
            vec![fields.clone()]
        }
    };
    let zones = zones_of(gpu, source)?;
    let mut ground = Ground::new(config)?;
    let mut instances = Instances::new(parts.iter().map(|part| part.count as usize).sum());
    let indices = patch_indices(config.patch_size);
    let triangles = Buffer::constant(gpu, "triangles of a patch", &indices)?;
    let (mut chunks, mut first) = (Vec::new(), 0);
    for part in &parts {
        let slots = first..first + part.count as usize;
        let shown = &patches[first.min(patches.len())..slots.end.min(patches.len())];
        let margin = (part.width - config.patch_size) / 2;
        for ((at, patch), heights) in (first..).zip(shown).zip(&part.read(gpu).await?) {
            ground.insert(*patch, heights, margin)?;
            let (placement, sphere) = placed(config, at, *patch, extremes(heights))?;
            instances.spawn(&placement, &sphere);
        }
        let geometry = geometry(gpu, source, &zones, &triangles, part, first, shown)?;
        let drawable = TerrainDrawable::new(gpu, layouts, geometry, source.style)?;
        first = slots.end;
        chunks.push(Chunk::new(slots, vec![Box::new(drawable)]));
    }
    let mut draws = vec![NOTHING; OBJECT_LEVELS as usize];
    draws[0].index_count = indices.len() as u32;
    let (edge, spacing) = (config.edge_length(), config.terrain_scale);
    let terrain = Terrain { ground, edge, spacing, source: source.clone(), morphing };
    Ok((terrain, instances, (chunks, draws)))
}

/// Generates the heights of patches by a recipe.
async fn generated(gpu: &Gpu, recipe: &Recipe, patches: &[[i32; 2]]) -> Result<Vec<Fields>, Error> {
    InputError::check(!patches.is_empty(), "patches", "none", || "must be at least one")?;
    check_once(patches)?;
    let generator = Generator::new(gpu, recipe.clone())?;
    generator.generate_async(gpu, patches, MARGIN, &mut |_| ()).await
}

/// The zones of a terrain with their textures on the device.
pub(super) fn zones_of(gpu: &Gpu, source: &TerrainSource) -> Result<Materials, Error> {
    let zones = &source.config().zones;
    let built_in = || source.textures.is_none().then(|| TerrainTexture::of_zones(zones)).transpose();
    let built_in = built_in()?.unwrap_or_default();
    Materials::new(gpu, zones, source.textures.as_deref().unwrap_or(&built_in))
}

/// The parameters with which a terrain is drawn. A patch has `size` samples along an edge, and its rows have `width` heights.
pub(super) fn params_of(source: &TerrainSource, width: u32, size: u32, zones: &Materials) -> TerrainParams {
    let config = source.config();
    TerrainParams {
        in_width: width,
        size,
        spacing: config.terrain_scale as f32,
        run: (2.0 * config.terrain_scale * HEIGHT_ONE) as f32,
        tiling: (config.tiles_per_patch() / f64::from(config.patch_size - 1)) as f32,
        tiles_per_unit: (1.0 / config.tile()) as f32,
        zone_count: zones.zone_count,
        additive: source.shading.weights.code(),
        planes: planes(config.triplanar),
        variation: config.variation as f32,
        relief_depth: source.relief.map_or(0.0, |relief| relief.depth),
        relief_distance: source.relief.map_or(1.0, |relief| relief.distance),
        first_patch: 0,
        normals_width: 0,
        erosion_depth: 0.0,
        unused: 0.0,
    }
}

/// The geometry of the patches `shown` in one part of the heights. `first` is the index of the first of these patches.
fn geometry(
    gpu: &Gpu,
    source: &TerrainSource,
    zones: &Materials,
    triangles: &Buffer<u32>,
    fields: &Fields,
    first: usize,
    shown: &[[i32; 2]],
) -> Result<TerrainGeometry, Error> {
    let config = source.config();
    let params = TerrainParams {
        first_patch: first as u32,
        ..params_of(source, fields.width, config.patch_size, zones)
    };
    let patches = Buffer::new(gpu, "patches", fields.count.max(1) as usize)?;
    if !shown.is_empty() {
        patches.write(gpu, &listed(config, shown))?;
    }
    Ok(TerrainGeometry {
        params: Uniform::new(gpu, "terrain", &params)?,
        heights: fields.heights.clone(),
        patches,
        indices: triangles.clone(),
        holes: Buffer::new(gpu, "no holes", 1)?,
        has_holes: false,
        normals: Buffer::new(gpu, "no normals", 1)?,
        zones: zones.clone(),
    })
}

/// The patches in shader format. Patch i of the list shows height window i.
pub(in crate::scene) fn listed(config: &TerrainConfig, patches: &[[i32; 2]]) -> Vec<TerrainPatch> {
    let (edge, tiles) = (config.patch_size as i32 - 1, config.tiles_per_patch());
    let patch = |(window, patch): (u32, &[i32; 2])| TerrainPatch {
        origin: patch.map(|index| index.wrapping_mul(edge)),
        uv: patch.map(|index| (f64::from(index) * tiles).rem_euclid(f64::from(TILES_PERIOD)) as f32),
        window,
        level: 0,
        holes: 0,
        eroded: window,
    };
    (0..).zip(patches).map(patch).collect()
}
