//! `relievo relief`

mod compare;
mod tracer;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, ValueEnum};
use image::RgbaImage;
use relievo::samples::BuiltInMap;
use relievo::surface::view::towards_light;
use relievo::surface::{
    Address, Green, HeightMap, Hit, March, Material, Measured, Method, Mips, Outcome, Ray, Shadow, SquareView,
};
use relievo::terrain::export::write_bytes;
use relievo::{Error, InputError};
use serde::Serialize;

use crate::Context;
use crate::output::{Staged, json};
use crate::progress::bar;
use crate::terrain::{Backend, pair, save};
use tracer::Tracer;

/// Linear light behind the square.
const BACKGROUND: [f32; 3] = [0.045, 0.055, 0.07];

/// Samples a pixel along each axis of a picture: one crawls with jagged edges.
const FINER: u32 = 2;

/// Draws a square of relief with any ray-height method, and measures the method against the exact intersection.
///
/// Writes `relief.png`, `rays.f32` (for each pixel, row by row, six little-endian floats: u, v and height 1 where
/// its ray enters the relief, then what it travels until height 0; zeros where no square is seen), `hits.f32` (four
/// a pixel: u, v, height, and 1 for a hit or 0 for a miss) and `report.json` with error and cost. The projection is
/// parallel, so that every pixel sees the square at the same angle.
///
/// With `--compare`: every method at 0, 30, 60 and 80 degrees, as `compare.json`, `compare.md` and `compare.png`.
///
/// Start with `relievo relief --builtin bricks --method quadtree --shadow hard --out relief`.
#[derive(Args)]
pub struct Relief {
    /// Heights: the brightness of a PNG or JPEG, 0 to 1.
    #[arg(long, value_name = "PNG")]
    height: Option<PathBuf>,
    /// Heights and colours of our own making, instead of files: bricks, cobbles, text, posts.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["height", "albedo"])]
    builtin: Option<String>,
    /// Texels along an edge of a built-in map.
    #[arg(long, value_name = "N", default_value_t = 512, conflicts_with_all = ["height", "albedo"])]
    texels: u32,
    /// Colours. Its alpha channel is the height where --height is absent.
    #[arg(long, value_name = "PNG")]
    albedo: Option<PathBuf>,
    /// Normals in tangent space, red to the right. Default: those of the heights.
    #[arg(long, value_name = "PNG")]
    normal: Option<PathBuf>,
    /// Where green of --normal points: up the image (glTF, OpenGL) or down it (Direct3D).
    #[arg(long, value_name = "DIRECTION", default_value = "up")]
    normal_green: GreenKind,
    /// How the surface is found: plain, parallax, parallax-limited, relief, occlusion, cone, quadtree.
    #[arg(long, value_name = "METHOD", default_value = "quadtree")]
    method: String,
    /// Depth of the relief, in tiles of the texture: 0 to 1.
    #[arg(long, value_name = "S", default_value_t = 0.1, allow_hyphen_values = true)]
    scale: f64,
    /// Where the square lies in the relief: B's b, from 0 (at its bottom) to -S (at its top, the default).
    #[arg(long, value_name = "B", allow_hyphen_values = true)]
    bias: Option<f64>,
    /// Linear steps straight down and at the horizon, for relief and occlusion.
    #[arg(long, value_name = "MIN,MAX", default_value = "16,64")]
    steps: String,
    /// Binary steps behind them, and behind cones.
    #[arg(long, value_name = "N", default_value_t = 8)]
    binary_steps: u32,
    /// Degrees between the eye and the square's normal, 0 to below 90. Rays flatter than 89.55 are marched at that.
    #[arg(long, value_name = "DEG", default_value_t = 50.0, allow_hyphen_values = true)]
    angle: f64,
    /// Degrees of the eye around the normal: 0 below the texture's bottom edge, 90 at its right.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    azimuth: f64,
    /// How often the texture repeats along the square's edge.
    #[arg(long, value_name = "N", default_value_t = 1.0, allow_hyphen_values = true)]
    tile: f64,
    /// Self-shadow.
    #[arg(long, default_value = "none")]
    shadow: ShadowKind,
    /// Where light comes from: degrees around the normal as --azimuth, and above the square.
    #[arg(long, value_name = "AZ,EL", default_value = "225,45", allow_hyphen_values = true)]
    light: String,
    /// What lies beyond the map's edge: the map again, or its last texels.
    #[arg(long, default_value = "wrap")]
    address: AddressKind,
    /// Cuts away what leaves the square, so that its far edges follow the relief.
    #[arg(long)]
    silhouette: bool,
    /// What computes.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Pixels of relief.png.
    #[arg(long, value_name = "WxH", default_value = "960x600")]
    size: String,
    /// Every method over the angles 0, 30, 60 and 80, instead of a picture: --method, --angle and --steps do not count.
    #[arg(long)]
    compare: bool,
    /// The folder.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

#[derive(Clone, Copy, ValueEnum)]
enum ShadowKind {
    None,
    Hard,
    Soft,
}

#[derive(Clone, Copy, ValueEnum)]
enum GreenKind {
    Up,
    Down,
}

#[derive(Clone, Copy, ValueEnum)]
enum AddressKind {
    Wrap,
    Clamp,
}

/// What is drawn or compared, checked and read.
struct Plan {
    map: HeightMap,
    albedo: Mips,
    normals: Option<Mips>,
    green: Green,
    shadow: Shadow,
    silhouette: bool,
    method: Method,
    march: March,
    material: Material,
    view: SquareView,
    backend: Backend,
}

/// A picture with what was measured on the way.
pub struct Drawn {
    pub picture: RgbaImage,
    rays: Vec<Option<Ray>>,
    hits: Vec<Hit>,
    measured: Measured,
    adapter: Option<[String; 2]>,
    seconds: Seconds,
}

/// Wall time.
#[derive(Serialize, Clone, Copy)]
struct Seconds {
    maps: f64,
    rays: f64,
    picture: f64,
    exact: f64,
}

#[derive(Serialize)]
struct Report<'a> {
    method: Method,
    #[serde(flatten)]
    measured: Measured,
    /// The same as `mean_samples`.
    samples_per_pixel: f64,
    adapter: Option<&'a str>,
    driver: Option<&'a str>,
    backend: Backend,
    scale: f32,
    bias: f32,
    march: March,
    angle: f64,
    azimuth: f64,
    tile: f64,
    shadow: Shadow,
    map: [u32; 2],
    size: [u32; 2],
    seconds: Seconds,
}

impl Relief {
    pub fn run(&self, context: &Context) -> Result<ExitCode, Error> {
        let plan = self.plan()?;
        // What cannot be written shows before the work; the stage itself comes after it, so that an interrupted run
        // leaves nothing behind.
        drop(Staged::new(&self.out)?);
        if self.compare {
            compare::run(&plan, context, &self.out)?;
        } else {
            let drawn = plan.draw(context)?;
            plan.write(&drawn, Staged::new(&self.out)?)?;
            let Measured { mean_error_texels, p99_error_texels, mean_samples, .. } = drawn.measured;
            crate::output::say(format_args!(
                "{}: mean error {mean_error_texels:.4} texels, 99 of 100 below {p99_error_texels:.4}, \
                 {mean_samples:.1} texel loads a pixel; {}",
                plan.method.name(),
                self.out.join("relief.png").display()
            ))?;
        }
        Ok(ExitCode::SUCCESS)
    }

    /// The picture alone, for the demonstration.
    #[cfg(feature = "gpu")]
    pub fn picture(&self, context: &Context) -> Result<(RgbaImage, Measured, f64), Error> {
        let start = Instant::now();
        let drawn = self.plan()?.draw(context)?;
        Ok((drawn.picture, drawn.measured, start.elapsed().as_secs_f64()))
    }

    /// The plot of `--compare` alone, for the demonstration.
    #[cfg(feature = "gpu")]
    pub fn comparison(&self, context: &Context) -> Result<RgbaImage, Error> {
        compare::picture(&self.plan()?, context)
    }

    fn plan(&self) -> Result<Plan, Error> {
        let method = self.method.parse()?;
        let address = match self.address {
            AddressKind::Wrap => Address::Wrap,
            AddressKind::Clamp => Address::Clamp,
        };
        let march = March { address, steps: steps(&self.steps)?, binary_steps: self.binary_steps };
        march.validate()?;
        let size = pair("size", &self.size, 'x', "must be columns x rows, such as 960x600")?;
        let view = SquareView { angle: self.angle, azimuth: self.azimuth, tiles: self.tile, size };
        view.validate()?;
        let material = self.material()?;
        let (map, albedo) = self.maps()?;
        let normals = self.normal.as_deref().map(open).transpose()?.map(Mips::of_data);
        let albedo = Mips::of_color(albedo);
        let shadow = match self.shadow {
            ShadowKind::None => Shadow::None,
            ShadowKind::Hard => Shadow::Hard,
            ShadowKind::Soft => Shadow::Soft,
        };
        let green = match self.normal_green {
            GreenKind::Up => Green::Up,
            GreenKind::Down => Green::Down,
        };
        let (silhouette, backend) = (self.silhouette, self.backend);
        Ok(Plan { map, albedo, normals, green, shadow, silhouette, method, march, material, view, backend })
    }

    fn material(&self) -> Result<Material, InputError> {
        if !(0.0..=1.0).contains(&self.scale) {
            return Err(InputError::new("scale", self.scale, "must be in 0..=1 tiles"));
        }
        let bias = self.bias.unwrap_or(-self.scale);
        if !(-self.scale..=0.0).contains(&bias) {
            let bound =
                format!("must be from {} (the square at the relief's top) to 0 (at its bottom)", -self.scale);
            return Err(InputError::new("bias", bias, bound));
        }
        let bound = "must be azimuth and elevation in degrees, such as 225,45";
        let [azimuth, elevation] = pair::<f64>("light", &self.light, ',', bound)?;
        let light = towards_light(azimuth, elevation)?.map(|axis| axis as f32);
        let material = Material {
            scale: self.scale as f32,
            plane: if self.scale > 0.0 { (-bias / self.scale) as f32 } else { 1.0 },
            light,
            ..Material::default()
        };
        material.validate()?;
        Ok(material)
    }

    fn maps(&self) -> Result<(HeightMap, RgbaImage), Error> {
        if let Some(name) = &self.builtin {
            let kind: BuiltInMap =
                name.parse().map_err(|error| InputError { path: "builtin".into(), ..error })?;
            let refused = |error: InputError| InputError { path: "texels".into(), ..error };
            let map = kind.height_map(self.texels).map_err(refused)?;
            return Ok((map, kind.albedo(self.texels).map_err(refused)?));
        }
        match (&self.height, &self.albedo) {
            (Some(height), Some(albedo)) => Ok((HeightMap::from_file(height)?, open(albedo)?)),
            (Some(height), None) => {
                let map = HeightMap::from_file(height)?;
                let stone = RgbaImage::from_pixel(1, 1, image::Rgba([168, 160, 150, 255]));
                Ok((map, stone))
            }
            (None, Some(albedo)) => {
                let (map, image) = HeightMap::from_alpha(albedo)?;
                let mut color = image.into_rgba8();
                // The alpha channel was heights.
                color.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
                Ok((map, color))
            }
            (None, None) => {
                let bound = "must name a height map, or else --albedo one with alpha, or --builtin a name";
                Err(InputError::new("height", "nothing", bound).into())
            }
        }
    }
}

/// An image for colours or normals; larger ones than a texture may be are refused before they are decoded.
fn open(path: &Path) -> Result<RgbaImage, Error> {
    Ok(relievo::surface::map::open(path)?.into_rgba8())
}

fn steps(text: &str) -> Result<[u32; 2], InputError> {
    let both = if text.contains(',') { text.to_owned() } else { format!("{text},{text}") };
    pair("steps", &both, ',', "must be one number of steps, or MIN,MAX")
}

impl Plan {
    fn draw(&self, context: &Context) -> Result<Drawn, Error> {
        let rays = self.view.rays(self.material.scale, self.material.plane);
        let seen: Vec<Ray> = rays.iter().flatten().copied().collect();
        if seen.is_empty() {
            let bound = "must be smaller, or --size larger: no pixel sees the square";
            return Err(InputError::new("angle", self.view.angle, bound).into());
        }
        let progress = bar(4, "building maps");
        let step = |what: &str, start: Instant| {
            progress.inc(1);
            progress.set_message(what.to_owned());
            start.elapsed().as_secs_f64()
        };
        let start = Instant::now();
        let tracer = Tracer::new(&self.map, self.method, self.march.address, self.backend, context)?;
        let maps = step("tracing rays", start);
        let start = Instant::now();
        let found = tracer.trace(&seen, &self.march)?;
        let traced = step("drawing", start);
        let start = Instant::now();
        let picture = tracer.picture(self, BACKGROUND, FINER)?;
        let pictured = step("measuring", start);
        let start = Instant::now();
        let measured = Measured::of(&self.map, self.march.address, &seen, &found);
        let exact = step("done", start);
        progress.finish_and_clear();
        let mut found = found.into_iter();
        let hits = rays.iter().map(|ray| ray.and_then(|_| found.next()).unwrap_or_default()).collect();
        let seconds = Seconds { maps, rays: traced, picture: pictured, exact };
        Ok(Drawn { picture, rays, hits, measured, adapter: tracer.adapter(), seconds })
    }

    fn write(&self, drawn: &Drawn, mut staged: Staged) -> Result<(), Error> {
        save(&staged.path("relief.png"), &drawn.picture)?;
        let rays = drawn.rays.iter().flat_map(|ray| match ray {
            Some(ray) => [ray.origin[0], ray.origin[1], 1.0, ray.slope[0], ray.slope[1], -1.0],
            None => [0.0; 6],
        });
        write_bytes(&staged.path("rays.f32"), &bytes(rays))?;
        let hits = drawn.hits.iter().flat_map(|hit| {
            let met = if hit.outcome() == Outcome::Hit { 1.0 } else { 0.0 };
            [hit.uv[0], hit.uv[1], hit.height, met]
        });
        write_bytes(&staged.path("hits.f32"), &bytes(hits))?;
        write_bytes(&staged.path("report.json"), &json(&self.report(drawn))?)?;
        staged.publish()
    }

    fn report<'a>(&self, drawn: &'a Drawn) -> Report<'a> {
        let [adapter, driver] = [0, 1].map(|i| drawn.adapter.as_ref().map(|names| names[i].as_str()));
        Report {
            method: self.method,
            measured: drawn.measured,
            samples_per_pixel: drawn.measured.mean_samples,
            adapter,
            driver,
            backend: self.backend,
            scale: self.material.scale,
            bias: -self.material.plane * self.material.scale,
            march: self.march,
            angle: self.view.angle,
            azimuth: self.view.azimuth,
            tile: self.view.tiles,
            shadow: self.shadow,
            map: [self.map.width(), self.map.height()],
            size: self.view.size,
            seconds: drawn.seconds,
        }
    }
}

fn bytes(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}
