//! `relievo terrain`

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use relievo::terrain::blend::reference::blend;
use relievo::terrain::blend::{Shading, WeightMode};
use relievo::terrain::config::Config;
use relievo::terrain::despike::Despike;
use relievo::terrain::export::{HeightImage, HeightRange, cropped, sha256, to_bytes, write_bytes, write_png};
use relievo::terrain::features::{FeatureFile, Features};
use relievo::terrain::field::field_with;
use relievo::terrain::fixed::FeatureMode;
use relievo::terrain::recipe::Recipe;
use relievo::terrain::texture::{Texture, map_zones};
use relievo::terrain::thermal::Thermal;
use relievo::{Error, InputError};
use serde::Serialize;

use crate::Context;
use crate::memory::Load;
use crate::output::{Staged, json, say};
use crate::progress::bar;

/// Generates terrain from B's JSON: heights, a colour map and a perspective view.
///
/// Writes `terrain.png` (perspective; needs an adapter), `map.png` (from above, north up, one pixel a sample),
/// for each patch `heights_<px>_<py>.png` (16-bit; the mapping is in report.json and in the PNG's text chunk
/// `relievo-heights`) and `heights_<px>_<py>.i32` (little-endian rows, 1/65536 units), and `report.json`.
///
/// A configuration: {"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}. Optional fields: roughness,
/// coarseLevels, offset, border, corners, terrainScale, textureTile, zones. A feature file: {"patchCoordinates":
/// [0, 0], "precomputedHeights": [x, y, height, …]}.
#[derive(Args)]
pub struct Terrain {
    /// The configuration.
    #[arg(long, value_name = "FILE")]
    pub config: PathBuf,
    /// Injected heights; may be given several times.
    #[arg(long, value_name = "FILE")]
    features: Vec<PathBuf>,
    /// keep: injected points stay as they are. additive: the computed value is added to them.
    #[arg(long, value_name = "MODE", default_value = "keep")]
    feature_mode: Mode,
    /// Injects samples of a 16-bit greyscale PNG, its first sample at the first of the grid.
    #[arg(long, value_name = "PNG", requires = "every")]
    heights_from: Option<PathBuf>,
    /// Injects every K-th sample of --heights-from, along both axes.
    #[arg(long, value_name = "K", requires = "heights_from")]
    every: Option<u32>,
    /// Heights of black and white in --heights-from. Default: what the PNG states, else ± scaleFactor.
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, requires = "heights_from")]
    heights_range: Option<String>,
    /// Columns and rows of patches.
    #[arg(long, value_name = "WxH", default_value = "1x1")]
    patches: String,
    /// Coordinates of the first patch.
    #[arg(long, value_name = "PX,PY", default_value = "0,0", allow_hyphen_values = true)]
    origin: String,
    /// Iterations of thermal erosion, after despiking.
    #[arg(long, value_name = "ITERATIONS")]
    thermal: Option<u32>,
    /// The steepest slope that thermal erosion leaves alone, in degrees.
    #[arg(
        long,
        value_name = "DEGREES",
        default_value_t = 35.0,
        requires = "thermal",
        allow_hyphen_values = true
    )]
    talus: f64,
    /// Replaces points further than TAU (height units) from the mean of their neighbours by it.
    #[arg(long, value_name = "TAU", allow_hyphen_values = true)]
    despike: Option<f64>,
    /// How zone weights make a colour; additive is B's.
    #[arg(long, value_name = "MODE", default_value = "normalized")]
    weights: Weights,
    /// What computes: the heights are the same bits.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Pixels of terrain.png.
    #[arg(long, value_name = "WxH", default_value = "1280x720")]
    size: String,
    /// Also writes each patch as a mesh at its place in the world, `patch_<px>_<py>.obj`.
    #[arg(long)]
    obj: bool,
    /// Draws triangle edges in terrain.png instead of textures.
    #[arg(long)]
    wireframe: bool,
    /// The folder.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum Mode {
    Keep,
    Additive,
}

#[derive(Clone, Copy, ValueEnum)]
enum Weights {
    Normalized,
    Additive,
}

#[derive(Clone, Copy, PartialEq, Eq, Default, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Backend {
    #[cfg_attr(feature = "gpu", default)]
    Gpu,
    #[cfg_attr(not(feature = "gpu"), default)]
    Cpu,
}

#[derive(Serialize)]
struct Report {
    adapter: Option<String>,
    driver: Option<String>,
    backend: Backend,
    patches: Vec<PatchReport>,
    seconds: Seconds,
    height_png: HeightRange,
    features: usize,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct PatchReport {
    px: i32,
    py: i32,
    size: u32,
    sha256: String,
}

#[derive(Serialize, Default)]
struct Seconds {
    generate: f64,
    render: f64,
}

/// What the arguments mean, checked.
struct Plan {
    recipe: Recipe,
    grid: [u32; 2],
    patches: Vec<[i32; 2]>,
    #[cfg_attr(not(feature = "gpu"), allow(dead_code))]
    size: [u32; 2],
    shading: Shading,
    textures: Vec<Texture>,
}

/// What either backend computes.
struct Made {
    // With one sample of margin.
    windows: Vec<Vec<i32>>,
    // One pixel a sample of each patch.
    maps: Vec<Vec<u32>>,
    view: Option<image::RgbaImage>,
    seconds: Seconds,
    adapter: Option<(String, String)>,
    notes: Vec<String>,
}

/// What the demo shows of a terrain.
#[cfg(feature = "gpu")]
pub struct Pictures {
    pub view: Option<image::RgbaImage>,
    pub map: image::RgbaImage,
    pub seconds: [f64; 2],
}

impl Terrain {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let plan = self.plan()?;
        let staged = Staged::new(&self.out)?;
        let made = self.make(&plan, context)?;
        self.write(&plan, &made, staged)?;
        Ok(ExitCode::SUCCESS)
    }

    fn make(&self, plan: &Plan, context: &Context) -> Result<Made, Error> {
        match self.backend {
            Backend::Cpu => self.on_cpu(plan, context),
            Backend::Gpu => self.on_gpu(plan, context),
        }
    }

    /// The view, the map, and the seconds that heights and pictures took.
    #[cfg(feature = "gpu")]
    pub fn pictures(&self, context: &Context) -> Result<Pictures, Error> {
        let plan = self.plan()?;
        let made = self.make(&plan, context)?;
        let Seconds { generate, render } = made.seconds;
        Ok(Pictures { map: mosaic(&plan, &made.maps), view: made.view, seconds: [generate, render] })
    }

    fn plan(&self) -> Result<Plan, Error> {
        let config = Config::from_file(&self.config)?;
        let grid = pair::<u32>("patches", &self.patches, 'x', "must be columns x rows, such as 3x3")?;
        let origin = pair::<i32>("origin", &self.origin, ',', "must be two patch coordinates, such as -1,2")?;
        let size =
            pair::<u32>("size", &self.size, 'x', "must be width x height in pixels, such as 1280x720")?;
        if size.iter().any(|edge| !(1..=4096).contains(edge)) {
            return Err(
                InputError::new("size", &self.size, "must be 1 to 4096 pixels along each edge").into()
            );
        }
        let thermal = self.thermal.map(|iterations| Thermal { iterations, talus: self.talus });
        thermal.map_or(Ok(()), |thermal| thermal.validate())?;
        if grid.contains(&0) {
            return Err(InputError::new("patches", &self.patches, "must be at least 1x1").into());
        }
        let width = u64::from(config.patch_size) + 2 * self.apron();
        let load = Load { grid, width, features: 0 };
        load.check(&self.patches)?;
        let patches = grid_patches(grid, origin)?;
        let features = self.read_features(&config, load, origin)?;
        Load { features: features.len() as u64, ..load }.check(&self.patches)?;
        let recipe = Recipe {
            despike: self.despike.map(|threshold| Despike { threshold }),
            thermal,
            features,
            config,
        };
        recipe.validate(&patches, 1)?;
        let weights = match self.weights {
            Weights::Normalized => WeightMode::Normalized,
            Weights::Additive => WeightMode::Additive,
        };
        let textures = Texture::of_zones(&recipe.config.zones)?;
        Ok(Plan { recipe, grid, patches, size, shading: Shading { weights, ..Shading::default() }, textures })
    }

    fn apron(&self) -> u64 {
        1 + u64::from(self.thermal.unwrap_or(0)) + u64::from(self.despike.is_some())
    }

    fn read_features(&self, config: &Config, load: Load, origin: [i32; 2]) -> Result<Features, Error> {
        let mode = match self.feature_mode {
            Mode::Keep => FeatureMode::Keep,
            Mode::Additive => FeatureMode::Additive,
        };
        let mut features = Features::new(config, &[], mode)?;
        let mut add = |path: &PathBuf, file: &FeatureFile| {
            let added = features.add(config, file).and_then(|()| features.check(config));
            added.map_err(|source| Error::InputFile { path: path.clone(), source })
        };
        for path in &self.features {
            add(path, &FeatureFile::from_file(path)?)?;
        }
        if let (Some(path), Some(every)) = (&self.heights_from, self.every) {
            let image = HeightImage::from_file(path)?;
            let range = match &self.heights_range {
                Some(text) => height_range(text)?,
                None => image
                    .range
                    .unwrap_or(HeightRange { low: -config.scale_factor, high: config.scale_factor }),
            };
            load.with_samples(image.samples.len(), every).check(&self.patches)?;
            for file in image.features(config, origin, load.grid, every, range)? {
                add(path, &file)?;
            }
        }
        Ok(features)
    }

    fn on_cpu(&self, plan: &Plan, context: &Context) -> Result<Made, Error> {
        let start = Instant::now();
        let progress = bar(plan.patches.len() as u64, "generating");
        let windows = field_with(&plan.recipe, &plan.patches, 1, &|| progress.inc(1))?;
        progress.finish_and_clear();
        let generate = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let config = &plan.recipe.config;
        let zones = map_zones(&config.zones, &plan.textures);
        let width = config.patch_size as usize + 2;
        let progress = bar(plan.patches.len() as u64, "colouring");
        let map = |window: &Vec<i32>| {
            let pixels = blend(window, width, config.terrain_scale, &zones, &plan.shading);
            progress.inc(1);
            pixels
        };
        let maps = windows.par_iter().map(map).collect();
        progress.finish_and_clear();
        let mut made = Made {
            windows,
            maps,
            view: None,
            seconds: Seconds { generate, render: 0.0 },
            adapter: None,
            notes: Vec::new(),
        };
        self.view_of_cpu_heights(plan, context, &mut made)?;
        made.seconds.render = start.elapsed().as_secs_f64();
        Ok(made)
    }

    #[cfg(not(feature = "gpu"))]
    fn on_gpu(&self, _: &Plan, _: &Context) -> Result<Made, Error> {
        Err(InputError::new(
            "backend",
            "gpu",
            "must be cpu: this program was built without the feature `gpu`",
        )
        .into())
    }

    #[cfg(not(feature = "gpu"))]
    fn view_of_cpu_heights(&self, _: &Plan, _: &Context, made: &mut Made) -> Result<(), Error> {
        made.notes
            .push("terrain.png was not made: this program was built without the feature `gpu`".to_owned());
        Ok(())
    }

    fn write(&self, plan: &Plan, made: &Made, mut staged: Staged) -> Result<(), Error> {
        let config = &plan.recipe.config;
        let (size, width) = (config.patch_size, config.patch_size as usize + 2);
        let progress = bar(plan.patches.len() as u64, "writing");
        let fields: Vec<_> = made.windows.iter().map(|window| cropped(window, width, 1)).collect();
        let ranges = fields.iter().map(|heights| HeightRange::of(heights));
        let range = ranges.reduce(HeightRange::union).unwrap_or(HeightRange { low: 0.0, high: 0.0 });
        let mut reports = Vec::new();
        for ([px, py], heights) in plan.patches.iter().zip(&fields) {
            write_png(&staged.path(format!("heights_{px}_{py}.png")), heights, size, range)?;
            write_bytes(&staged.path(format!("heights_{px}_{py}.i32")), &to_bytes(heights))?;
            if self.obj {
                write_obj(&staged.path(format!("patch_{px}_{py}.obj")), heights, config, [*px, *py])?;
            }
            reports.push(PatchReport { px: *px, py: *py, size, sha256: sha256(heights) });
            progress.inc(1);
        }
        progress.finish_and_clear();
        save(&staged.path("map.png"), &mosaic(plan, &made.maps))?;
        match &made.view {
            Some(view) => save(&staged.path("terrain.png"), view)?,
            // One of an earlier run would show other heights.
            None => staged.remove("terrain.png"),
        }
        let (adapter, driver) = made.adapter.clone().unzip();
        let report = Report {
            adapter,
            driver,
            backend: self.backend,
            patches: reports,
            seconds: Seconds { ..made.seconds },
            height_png: range,
            features: plan.recipe.features.len(),
            notes: made.notes.clone(),
        };
        write_bytes(&staged.path("report.json"), &json(&report)?)?;
        staged.remove_stale(is_of_a_patch);
        staged.publish()?;
        say(format_args!(
            "{} patches of {size}×{size} in {:.3} s, pictures in {:.3} s: {}",
            plan.patches.len(),
            made.seconds.generate,
            made.seconds.render,
            self.out.display()
        ))?;
        made.notes.iter().try_for_each(say)
    }
}

#[cfg(feature = "gpu")]
mod on_device {
    use relievo::gpu::{Buffer, Gpu};
    use relievo::render::{Picture, Style, picture::framing};
    use relievo::terrain::blend::BlendPass;
    use relievo::terrain::fields::Fields;
    use relievo::terrain::generator::Generator;

    use super::*;

    impl Terrain {
        pub(super) fn on_gpu(&self, plan: &Plan, context: &Context) -> Result<Made, Error> {
            let gpu = context.gpu()?;
            let start = Instant::now();
            let progress = bar(plan.patches.len() as u64, "generating");
            let generator = Generator::new(&gpu, plan.recipe.clone())?;
            let parts = generator.generate(&gpu, &plan.patches, 1, &mut |done| progress.inc(done as u64))?;
            progress.finish_and_clear();
            let mut windows = Vec::new();
            for part in &parts {
                windows.extend(read_windows(&gpu, part)?);
            }
            let generate = start.elapsed().as_secs_f64();
            let start = Instant::now();
            let pass = BlendPass::new(&gpu)?;
            let mut maps = Vec::new();
            for part in &parts {
                maps.extend(self.maps(&gpu, plan, &pass, part)?);
            }
            let view = self.view(&gpu, plan, &parts, &windows)?;
            let adapter = gpu.adapter();
            Ok(Made {
                windows,
                maps,
                view: Some(view),
                seconds: Seconds { generate, render: start.elapsed().as_secs_f64() },
                adapter: Some((adapter.name.clone(), adapter.driver.clone())),
                notes: Vec::new(),
            })
        }

        fn maps(
            &self,
            gpu: &Gpu,
            plan: &Plan,
            pass: &BlendPass,
            part: &Fields,
        ) -> Result<Vec<Vec<u32>>, Error> {
            let config = &plan.recipe.config;
            let points = (config.patch_size as usize).pow(2);
            let pixels = Buffer::new(gpu, "colour map", points * part.count as usize)?;
            let zones = map_zones(&config.zones, &plan.textures);
            let job = pass.prepare(gpu, config.terrain_scale, &zones, &plan.shading, part, &pixels)?;
            gpu.run("colour map", |encoder| job.record(encoder))?;
            Ok(pixels.read_blocking(gpu)?.chunks_exact(points).map(<[u32]>::to_vec).collect())
        }

        fn view(
            &self,
            gpu: &Gpu,
            plan: &Plan,
            parts: &[Fields],
            windows: &[Vec<i32>],
        ) -> Result<image::RgbaImage, Error> {
            let picture = Picture {
                config: &plan.recipe.config,
                textures: &plan.textures,
                shading: plan.shading,
                style: if self.wireframe { Style::Wireframe } else { Style::Textured },
                camera: framing(&plan.recipe.config, plan.grid, windows.iter().flatten()),
                size: plan.size,
            };
            picture.draw(gpu, parts, &plan.patches)
        }

        /// Draws heights that the CPU made, where there is an adapter.
        pub(super) fn view_of_cpu_heights(
            &self,
            plan: &Plan,
            context: &Context,
            made: &mut Made,
        ) -> Result<(), Error> {
            match context.gpu().and_then(|gpu| self.draw_cpu_heights(plan, &gpu, made)) {
                // The heights need no device.
                Err(Error::Gpu(error)) => made.notes.push(format!("terrain.png was not made: {error}")),
                drawn => drawn?,
            }
            Ok(())
        }

        fn draw_cpu_heights(&self, plan: &Plan, gpu: &Gpu, made: &mut Made) -> Result<(), Error> {
            let width = plan.recipe.config.patch_size + 2;
            let per_part = Fields::most(gpu, width);
            let mut parts = Vec::new();
            for windows in made.windows.chunks(per_part) {
                let fields = Fields::new(gpu, "terrain heights", width, windows.len() as u32)?;
                fields.heights.write(gpu, &windows.concat())?;
                parts.push(fields);
            }
            made.view = Some(self.view(gpu, plan, &parts, &made.windows)?);
            made.adapter = Some((gpu.adapter().name.clone(), gpu.adapter().driver.clone()));
            Ok(())
        }
    }

    fn read_windows(gpu: &Gpu, part: &Fields) -> Result<Vec<Vec<i32>>, Error> {
        let points = (part.width as usize).pow(2);
        let all = part.heights.read_blocking(gpu)?;
        Ok(all.chunks_exact(points).take(part.count as usize).map(<[i32]>::to_vec).collect())
    }
}

/// The patches of a grid, row by row.
fn grid_patches(grid: [u32; 2], origin: [i32; 2]) -> Result<Vec<[i32; 2]>, Error> {
    let coordinate = |origin: i32, index: u32, axis: usize| {
        i32::try_from(i64::from(origin) + i64::from(index))
            .map_err(|_| InputError::new(format!("origin[{axis}]"), origin, "patch coordinates must fit i32"))
    };
    let mut patches = Vec::new();
    for (y, x) in (0..grid[1]).flat_map(|y| (0..grid[0]).map(move |x| (y, x))) {
        patches.push([coordinate(origin[0], x, 0)?, coordinate(origin[1], y, 1)?]);
    }
    Ok(patches)
}

/// Whether a file's name is one that a patch's files have.
fn is_of_a_patch(name: &str) -> bool {
    let Some((stem, extension)) = name.rsplit_once('.') else { return false };
    let coordinates = match extension {
        "png" | "i32" => stem.strip_prefix("heights_"),
        "obj" => stem.strip_prefix("patch_"),
        _ => None,
    };
    let canonical = |text: &str| text.parse::<i32>().is_ok_and(|number| number.to_string() == text);
    coordinates.and_then(|text| text.split_once('_')).is_some_and(|(px, py)| canonical(px) && canonical(py))
}

/// The patches' maps in one image; neighbours share a row or column of pixels.
fn mosaic(plan: &Plan, maps: &[Vec<u32>]) -> image::RgbaImage {
    let size = plan.recipe.config.patch_size;
    let edge = size - 1;
    let mut image = image::RgbaImage::new(plan.grid[0] * edge + 1, plan.grid[1] * edge + 1);
    for (index, map) in maps.iter().enumerate() {
        let (left, top) = (index as u32 % plan.grid[0] * edge, index as u32 / plan.grid[0] * edge);
        for (at, pixel) in map.iter().enumerate() {
            let (x, y) = (at as u32 % size, at as u32 / size);
            image.put_pixel(left + x, top + y, image::Rgba(pixel.to_le_bytes()));
        }
    }
    image
}

/// Writes a PNG.
pub fn save(path: &std::path::Path, image: &image::RgbaImage) -> Result<(), Error> {
    // In memory first: the image crate forgets what the disk says about the last bytes.
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write_to(&mut bytes, image::ImageFormat::Png).map_err(|error| Error::output(path, error))?;
    write_bytes(path, bytes.get_ref())
}

fn write_obj(path: &std::path::Path, heights: &[i32], config: &Config, patch: [i32; 2]) -> Result<(), Error> {
    let first = patch.map(|index| i64::from(index) * (i64::from(config.patch_size) - 1));
    let field = relievo::terrain::mesh::HeightField::new(
        heights.to_vec(),
        config.patch_size as usize,
        config.terrain_scale,
    );
    let mut text = Vec::new();
    if let Some(field) = field {
        field.write_obj(&mut text, first).map_err(|error| Error::output(path, error))?;
    }
    write_bytes(path, &text)
}

pub fn pair<T: std::str::FromStr>(
    field: &str,
    text: &str,
    separator: char,
    bound: &str,
) -> Result<[T; 2], InputError> {
    let (first, second) = text.split_once(separator).unwrap_or((text, ""));
    match (first.trim().parse(), second.trim().parse()) {
        (Ok(first), Ok(second)) => Ok([first, second]),
        _ => Err(InputError::new(field, text, bound)),
    }
}

fn height_range(text: &str) -> Result<HeightRange, InputError> {
    let bound = "must be two finite heights, such as -20,35.5";
    let [low, high] = pair::<f64>("heights-range", text, ',', bound)?;
    if low.is_finite() && high.is_finite() {
        return Ok(HeightRange { low, high });
    }
    Err(InputError::new("heights-range", text, bound))
}
