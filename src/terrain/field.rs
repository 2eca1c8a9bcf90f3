//! Complete height fields on the CPU. The reference implementations of all operations run in the order of a recipe.

use super::{border, despike, height, hydraulic, noise, pad, smooth, thermal, wrap};
use crate::InputError;
use crate::parallel;
use crate::terrain::border::neighbours;
use crate::terrain::config::{Border, HeightGenerator, HeightInterpolation, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::lattice::Given;
use crate::terrain::pad::surrounds;
use crate::terrain::recipe::{ErosionStage, Recipe};
use crate::terrain::window::{Region, Span, Window};

/// Final heights of `patches` in 1/65536 height units, one list per patch. A list has rows of patchSize + 2·margin samples: the
/// patch with `margin` samples on every side. Patches are generated in parallel on rayon's threads.
///
/// # Errors
/// [`InputError`] as [`Recipe::validate`].
pub fn field(recipe: &Recipe, patches: &[[i32; 2]], margin: u32) -> Result<Vec<Vec<i32>>, InputError> {
    field_with(recipe, patches, margin, &|| ())
}

/// Returns the same as [`field`], and calls `progress` after each finished patch, on the thread that generated that patch.
///
/// # Errors
/// [`InputError`] as [`Recipe::validate`].
pub fn field_with(
    recipe: &Recipe,
    patches: &[[i32; 2]],
    margin: u32,
    progress: &(dyn Fn() + Sync),
) -> Result<Vec<Vec<i32>>, InputError> {
    recipe.validate(patches, margin)?;
    let apron = recipe.apron(margin);
    let (config, features) = (&recipe.config, &recipe.features);
    let width = (config.patch_size + 2 * apron) as usize;
    let injected = recipe.injected(patches, apron);
    let finished = |at: usize, window: Vec<i32>| {
        let field = finish(recipe, width, &injected[at], window);
        progress();
        field
    };
    // Patches of `blend` depend on each other. All other patches are generated independently from start to end.
    if let Border::Blend(_) = config.border {
        let windows = generate(config, features, patches, apron);
        return Ok(parallel::map_range(windows.len(), |at| finished(at, windows[at].clone())));
    }
    Ok(parallel::map_range(patches.len(), |at| {
        finished(at, generate(config, features, &patches[at..=at], apron).swap_remove(0))
    }))
}

/// Heights of `patches`, each with `apron` samples on every side, before despiking and erosion.
pub fn generate(
    config: &TerrainConfig,
    features: &Features,
    patches: &[[i32; 2]],
    apron: u32,
) -> Vec<Vec<i32>> {
    if config.border == Border::Seamless {
        let window =
            |patch: &[i32; 2]| region(config, features, Window { patch: *patch, apron }.region(config));
        return parallel::map(patches, window);
    }
    let mut fields: Vec<_> = parallel::map(patches, |patch| wrap::reference::wrap(config, features, *patch));
    let size = config.patch_size as usize;
    if let Border::Blend(width) = config.border {
        for (index, around) in neighbours(patches).into_iter().enumerate() {
            let (earlier, rest) = fields.split_at_mut(index);
            let around = around.map(|neighbour| neighbour.map(|index| earlier[index].as_slice()));
            border::reference::border(&mut rest[0], size, width, around);
        }
    }
    parallel::map(&surrounds(config, patches), |around| {
        let around = around.map(|tile| tile.map(|index| fields[index].as_slice()));
        pad::reference::pad(size, apron as usize, around)
    })
}

/// Heights of a region of `seamless` terrain, by the generator of the configuration, before despiking and erosion. The region
/// must be valid ([`Region::validate`]).
pub fn region(config: &TerrainConfig, features: &Features, region: Region) -> Vec<i32> {
    region_of(config, features, None, region)
}

/// The same as [`region`], with given heights. For noise, their lattice must be that of the region.
pub(crate) fn region_of(
    config: &TerrainConfig,
    features: &Features,
    given: Option<&Given<'_>>,
    region: Region,
) -> Vec<i32> {
    match (config.generator, config.interpolation) {
        (HeightGenerator::DiamondSquare, HeightInterpolation::Linear) => {
            height::reference::height(config, features, given, region)
        }
        (HeightGenerator::DiamondSquare, HeightInterpolation::Smooth) => {
            smooth::reference::smooth(config, features, given, region)
        }
        _ => {
            let mut heights = noise::reference::noise(config, region);
            let width = i64::from(region.width);
            let spans = region.first.map(|first| Span { first, last: first + width - 1 });
            Given::replace(given, region.coarser, spans, &mut heights);
            heights
        }
    }
}

/// Despikes and erodes a window. `injected` lists (column, row) of the window's injected points, sorted by row.
pub(crate) fn finish(
    recipe: &Recipe,
    mut width: usize,
    injected: &[(u32, u32)],
    mut window: Vec<i32>,
) -> Vec<i32> {
    if let Some(despike) = recipe.despike {
        window = despike::reference::despike(&window, width, despike.fixed_threshold(), |x, y| {
            injected.binary_search_by_key(&(y as u32, x as u32), |(column, row)| (*row, *column)).is_ok()
        });
        width -= 2;
    }
    let scale = recipe.config.terrain_scale;
    for stage in recipe.erosion() {
        let mut flow = Vec::new();
        for iteration in 0..stage.iterations() {
            match stage {
                ErosionStage::Thermal(thermal) => {
                    window = thermal::reference::thermal(&window, width, thermal.fixed_threshold(scale));
                }
                ErosionStage::Hydraulic(hydraulic) => {
                    let params = hydraulic.params(scale, iteration, width as u32);
                    (window, flow) = hydraulic::reference::hydraulic(&window, &flow, &params);
                }
            }
            // Each iteration drops the outermost ring of samples.
            width -= 2;
        }
    }
    window
}
