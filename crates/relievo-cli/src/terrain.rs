//! `relievo terrain`: heights, colour maps and views of patches of terrain.

mod color_maps;
mod erosion;
pub mod export;
mod frames;
mod grid;
mod injected;
mod look;
mod target;

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::ops::terrain::blend::{Shading, WeightMode};
use relievo::ops::terrain::despike::Despike;
use relievo::ops::terrain::export::cropped;
use relievo::ops::terrain::field::field_with;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::scene::TerrainStyle;
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use serde::Serialize;

use crate::Context;
use crate::arguments::{Backend, one_of, pair, size};
use crate::demo::Shown;
use crate::memory;
use crate::output::say;
use crate::progress::bar;
use color_maps::{ColorMaps, fields_of};
use erosion::Erosion;
use export::{Batch, HeightRange, PatchReport};
use frames::Frame;
use grid::Grid;
use look::Look;
use target::{Target, TargetArguments, Way};

const FEATURE_MODES: [(&str, FeatureMode); 2] =
    [("keep", FeatureMode::Keep), ("additive", FeatureMode::Additive)];
const WEIGHT_MODES: [(&str, WeightMode); 2] =
    [("normalized", WeightMode::Normalized), ("additive", WeightMode::Additive)];

/// Generates terrain from a JSON configuration: heights, a colour map and a perspective view. The fields of the
/// configuration are those of Tanca's dissertation (2012).
///
/// Writes `terrain.png` (perspective; needs an adapter), `map.png` (from above, north up, one pixel per sample),
/// `heights_<px>_<py>.png` for each patch (16-bit; report.json and the PNG's text chunk `relievo-heights` have the
/// mapping to heights), `heights_<px>_<py>.i32` (little-endian rows, in 1/65536 height units), and `report.json`; with --frames also
/// `frame_0000.png`, `map_0000.png` and so on.
///
/// A configuration: {"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}. Optional fields: roughness,
/// coarseLevels, offset, interpolation, border, corners, terrainScale, textureTile, triplanar, variation, zones, and erosion:
/// thermal and thermalAfter, such as {"iterations": 20, "talus": 35}, and hydraulic, such as {"iterations": 300}, with rain,
/// evaporation, capacity, threshold, erosion, deposition, talus and creep. A feature file: {"patchCoordinates": [0, 0],
/// "precomputedHeights": [x, y, height, …]}. docs/terrain.md describes every field.
///
/// relievo terrain --config examples/terrain.json --patches 3x3 --out terrain
#[derive(Args)]
pub struct Terrain {
    /// The configuration, a JSON file.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// A feature file of heights to inject; may be given several times.
    #[arg(long, value_name = "FILE")]
    features: Vec<PathBuf>,
    /// keep: injected points keep their heights. additive: the computed value is added to them.
    #[arg(long, value_name = "MODE", default_value = "keep", value_parser = one_of(FEATURE_MODES))]
    feature_mode: FeatureMode,
    /// Injects samples of a 16-bit greyscale PNG; its first sample goes to the first sample of the grid.
    #[arg(long, value_name = "PNG", requires = "every")]
    heights_from: Option<PathBuf>,
    /// Injects every K-th sample of --heights-from, along both axes.
    #[arg(long, value_name = "K", requires = "heights_from")]
    every: Option<u32>,
    /// The heights of black and white in --heights-from. Default: those that the PNG states, else ±
    /// scaleFactor.
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "heights_from", value_parser = heights)]
    heights_range: Option<HeightRange>,
    /// Number of columns and rows of patches.
    #[arg(long, value_name = "WxH", default_value = "1x1",
          value_parser = pair::<u32>("patches", 'x', "must be columns x rows, such as 3x3"))]
    patches: [u32; 2],
    /// Coordinates of the first patch, in patches.
    #[arg(long, value_name = "PX,PY", default_value = "0,0", allow_hyphen_values = true,
          value_parser = pair::<i32>("origin", ',', "must be two patch coordinates, such as -1,2"))]
    origin: [i32; 2],
    #[command(flatten)]
    erosion: Erosion,
    /// Replaces each point that is further than TAU (in height units) from the mean of its neighbours by this
    /// mean.
    #[arg(long, value_name = "TAU", allow_hyphen_values = true)]
    despike: Option<f64>,
    #[command(flatten)]
    target: TargetArguments,
    /// How zone weights blend colours; additive is the method of Tanca's dissertation (2012).
    #[arg(long, value_name = "MODE", default_value = "normalized", value_parser = one_of(WEIGHT_MODES))]
    weights: WeightMode,
    /// The processor that computes; the heights are the same bits on both.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Width and height of terrain.png, in pixels.
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size(4096))]
    size: [u32; 2],
    /// Also writes each patch as a mesh at its place in the world, `patch_<px>_<py>.obj`.
    #[arg(long)]
    obj: bool,
    /// Draws triangle edges in terrain.png instead of textures.
    #[arg(long)]
    wireframe: bool,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct Report<'a> {
    adapter: Option<String>,
    driver: Option<String>,
    backend: Backend,
    patches: Vec<PatchReport>,
    seconds: Seconds,
    height_png: HeightRange,
    features: usize,
    frames: &'a [Frame],
    notes: &'a [String],
}

#[derive(Clone, Copy, Serialize, Default)]
struct Seconds {
    generate: f64,
    render: f64,
}

/// The checked arguments.
struct Plan {
    recipe: Recipe,
    target: Target,
    grid: Grid,
    patches: Vec<[i32; 2]>,
    size: [u32; 2],
    shading: Shading,
    textures: Vec<TerrainTexture>,
}

/// The output of either backend.
#[derive(Default)]
struct Made {
    // One window per patch, with one sample of margin.
    windows: Vec<Vec<i32>>,
    // One map per patch, with one pixel per sample.
    maps: Vec<Vec<u32>>,
    view: Option<RgbaImage>,
    seconds: Seconds,
    // Between which heights these lie, if they lie between two.
    way: Option<Way>,
    // The device, if it computed or drew anything.
    gpu: Option<Gpu>,
    notes: Vec<String>,
}

impl Plan {
    fn maps(&self) -> ColorMaps<'_> {
        let Self { recipe, patches, shading, textures, .. } = self;
        ColorMaps { config: &recipe.config, textures, patches, shading }
    }
}

impl Made {
    /// What a camera sees: the heights, and on the way to others those too, so that the camera stands still.
    fn range(&self) -> HeightRange {
        self.way.as_ref().map_or_else(|| ranged(&self.windows), |way| way.range)
    }
}

/// The smallest range that holds all heights of windows.
fn ranged(windows: &[Vec<i32>]) -> HeightRange {
    let ranges = windows.iter().map(|heights| HeightRange::of(heights));
    ranges.reduce(HeightRange::union).unwrap_or(HeightRange { low: 0.0, high: 0.0 })
}

/// Parses the heights of black and white.
fn heights(text: &str) -> Result<HeightRange, InputError> {
    let bound = "must be two finite heights, such as -20,35.5";
    let [low, high] = pair::<f64>("heights-range", ',', bound)(text)?;
    if (low + high).is_finite() {
        return Ok(HeightRange { low, high });
    }
    Err(InputError::new("heights-range", text, bound))
}

impl Terrain {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let plan = self.plan()?;
        let mut staged = Staged::new(&self.out)?;
        let made = self.make(&plan, context)?;
        let frames = self.write_frames(&plan, &made, &mut staged)?;
        self.write(&plan, &made, &frames, staged)
    }

    /// The view and the map, for `relievo demo`; writes no files.
    pub fn shown(&self, context: &Context) -> Result<Shown, Error> {
        let plan = self.plan()?;
        let made = self.make(&plan, context)?;
        let map = plan.grid.mosaic(plan.recipe.config.patch_size, &made.maps);
        let Seconds { generate, render } = made.seconds;
        let note =
            format!("heights {generate:.3} s, pictures {render:.3} s (first use compiles the kernels)");
        Ok(Shown { picture: made.view, map: Some(map), note })
    }

    fn plan(&self) -> Result<Plan, Error> {
        let read = Recipe::from_file(&self.config)?;
        let despike = self.despike.map(|threshold| Despike { threshold });
        let mut recipe = Recipe { despike, ..self.erosion.applied(read)? };
        recipe.validate(&[], 0).map_err(InputError::in_json)?;
        let [columns, rows] = self.patches;
        let given = format!("{columns}x{rows}");
        if self.patches.contains(&0) {
            return Err(InputError::new("patches", given, "must be at least 1x1").into());
        }
        let grid = Grid { first: self.origin, size: self.patches };
        let width = recipe.config.patch_size.saturating_add(recipe.apron(1).saturating_mul(2));
        // Hydraulic erosion has water and sediment beside the heights.
        let words = self.target.batches() * if recipe.hydraulic.is_some() { 2 } else { 1 };
        memory::check(&given, words * grid.bytes(width, 0))?;
        let patches = grid.patches()?;
        recipe.features = self.read_features(&recipe.config, grid, width)?;
        memory::check(&given, words * grid.bytes(width, recipe.features.len() as u64))?;
        recipe.validate(&patches, 1).map_err(InputError::in_json)?;
        let target = self.target.read(&recipe, &patches)?;
        let textures = TerrainTexture::of_zones(&recipe.config.zones)?;
        let shading = Shading { weights: self.weights, ..Shading::default() };
        Ok(Plan { recipe, target, grid, patches, size: self.size, shading, textures })
    }

    fn make(&self, plan: &Plan, context: &Context) -> Result<Made, Error> {
        let (count, maps) = (plan.patches.len() as u64, plan.maps());
        let gpu = self.backend.gpu(context)?;
        let mut made = Made { gpu, ..Made::default() };
        let start = Instant::now();
        let progress = bar(count, "generating");
        let Some(gpu) = made.gpu.clone() else {
            made.windows = field_with(&plan.recipe, &plan.patches, 1, &|| progress.inc(1))?;
            (made.windows, made.way) = plan.target.windows(&plan.patches, made.windows)?;
            progress.finish_and_clear();
            made.seconds.generate = start.elapsed().as_secs_f64();
            let (start, progress) = (Instant::now(), bar(count, "colouring"));
            made.maps = maps.on_host(&made.windows, &|| progress.inc(1))?;
            progress.finish_and_clear();
            self.draw_on_host(plan, context, &mut made)?;
            made.seconds.render = start.elapsed().as_secs_f64();
            return Ok(made);
        };
        let generator = Generator::new(&gpu, plan.recipe.clone())?;
        let parts = generator.generate(&gpu, &plan.patches, 1, &mut |done| progress.inc(done as u64))?;
        let (parts, way) = plan.target.fields(&gpu, &plan.patches, parts)?;
        made.way = way;
        progress.finish_and_clear();
        for part in &parts {
            made.windows.extend(part.read_blocking(&gpu)?);
        }
        made.seconds.generate = start.elapsed().as_secs_f64();
        let start = Instant::now();
        made.maps = maps.on_device(&gpu, &parts)?;
        made.view = Some(self.look(plan).picture(&gpu, &parts, made.range())?);
        made.seconds.render = start.elapsed().as_secs_f64();
        Ok(made)
    }

    /// Draws heights that the CPU computed, if there is an adapter; the heights themselves need none.
    fn draw_on_host(&self, plan: &Plan, context: &Context, made: &mut Made) -> Result<(), Error> {
        let drawn = context.gpu().and_then(|gpu| {
            let parts = fields_of(&gpu, plan.recipe.config.patch_size + 2, &made.windows)?;
            Ok((self.look(plan).picture(&gpu, &parts, made.range())?, gpu))
        });
        match drawn {
            Err(Error::Gpu(error)) => made.notes.push(format!("terrain.png was not made: {error}")),
            drawn => {
                let (view, gpu) = drawn?;
                (made.view, made.gpu) = (Some(view), Some(gpu));
            }
        }
        Ok(())
    }

    /// How terrain.png is drawn.
    fn look<'a>(&self, plan: &'a Plan) -> Look<'a> {
        let Plan { recipe, grid, patches, size, shading, textures, .. } = plan;
        let style = if self.wireframe { TerrainStyle::Wireframe } else { TerrainStyle::Textured };
        let (config, shading) = (&recipe.config, *shading);
        Look { config, grid: grid.size, patches, size: *size, shading, textures, style }
    }

    fn write(&self, plan: &Plan, made: &Made, frames: &[Frame], mut staged: Staged) -> Result<(), Error> {
        let config = &plan.recipe.config;
        let size = config.patch_size;
        let progress = bar(plan.patches.len() as u64, "writing");
        let heights: Vec<_> =
            made.windows.iter().map(|window| cropped(window, size as usize + 2, 1)).collect();
        let range = ranged(&heights);
        let batch = Batch { config, patches: &plan.patches, heights: &heights, range, obj: self.obj };
        let patches = batch.write(|name| staged.path(name), || progress.inc(1))?;
        progress.finish_and_clear();
        staged.write_png("map.png", &plan.grid.mosaic(size, &made.maps))?;
        match &made.view {
            Some(view) => staged.write_png("terrain.png", view)?,
            // A picture of an earlier run would show other heights.
            None => staged.remove("terrain.png"),
        }
        let adapter = made.gpu.as_ref().map(|gpu| gpu.adapter());
        let report = Report {
            adapter: adapter.map(|adapter| adapter.name.clone()),
            driver: adapter.map(|adapter| adapter.driver.clone()),
            backend: self.backend,
            patches,
            seconds: made.seconds,
            height_png: range,
            features: plan.recipe.features.len(),
            frames,
            notes: &made.notes,
        };
        staged.write_json("report.json", &report)?;
        staged.remove_stale(|name| Batch::is_name(name) || frames::is_name(name));
        staged.publish()?;
        say(format_args!(
            "{} {} of {size}×{size} in {:.3} s, pictures in {:.3} s: {}",
            plan.patches.len(),
            if plan.patches.len() == 1 { "patch" } else { "patches" },
            made.seconds.generate,
            made.seconds.render,
            self.out.display()
        ))?;
        made.notes.iter().try_for_each(say)
    }
}
