//! `relievo relief`: draws relief by any ray-height method, and measures its error and cost.

mod plot;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::ops::surface::{
    Address, Green, HeightMap, March, Mips, Outcome, ReliefMaterial, ReliefMethod, ReliefShadow,
};
use relievo::{Error, InputError};
use relievo_lab::files::Staged;
use relievo_lab::measure::relief::{
    Comparison, Drawn, Measured, ReliefSquare, Seconds, SquareView, towards_light,
};
use relievo_samples::BuiltInMap;
use serde::Serialize;

use crate::Context;
use crate::arguments::{Backend, one_of, pair};
use crate::demo::Shown;
use crate::output::say;
use crate::progress::bar;
use plot::plot;

/// Colour behind the square, in linear light.
const BACKGROUND: [f32; 3] = [0.045, 0.055, 0.07];

/// Samples per pixel along each axis of the picture; with one, jagged edges crawl.
const FINER: u32 = 2;

const GREENS: [(&str, Green); 2] = [("up", Green::Up), ("down", Green::Down)];
const SHADOWS: [(&str, ReliefShadow); 3] =
    [("none", ReliefShadow::None), ("hard", ReliefShadow::Hard), ("soft", ReliefShadow::Soft)];
const ADDRESSES: [(&str, Address); 2] = [("wrap", Address::Wrap), ("clamp", Address::Clamp)];

/// Draws a square of relief with any ray-height method, and measures the method against the exact intersection.
///
/// Writes four files. `relief.png` is the picture. `rays.f32` has six little-endian floats for each pixel, row by
/// row: u, v and height 1 where its ray enters the relief, then the vector from there to height 0; they are zeros
/// where a pixel does not see the square. `hits.f32` has four floats a pixel: u, v, height, and 1 for a hit or 0
/// for a miss. `report.json` has error and cost. The projection is parallel, so that every pixel sees the square at
/// the same angle.
///
/// With `--compare`, measures every method at 0, 30, 60 and 80 degrees instead, and writes `compare.json`,
/// `compare.md` and `compare.png`.
///
/// relievo relief --builtin bricks --method quadtree --shadow hard --out relief
///
/// relievo relief --height map.png --compare --out compared
#[derive(Args)]
pub struct Relief {
    /// The height map: the brightness of a PNG or JPEG, from 0 to 1.
    #[arg(long, value_name = "PNG")]
    height: Option<PathBuf>,
    /// A built-in map of heights and colours instead of files: bricks, cobbles, text or posts.
    #[arg(long, value_name = "NAME", conflicts_with_all = ["height", "albedo"], value_parser = built_in)]
    builtin: Option<BuiltInMap>,
    /// Texels along an edge of a built-in map.
    #[arg(long, value_name = "N", default_value_t = 512, conflicts_with_all = ["height", "albedo"])]
    texels: u32,
    /// The colour map. If --height is absent, its alpha channel is the height.
    #[arg(long, value_name = "PNG")]
    albedo: Option<PathBuf>,
    /// The normal map, in tangent space with x in red. Default: normals that are computed from the heights.
    #[arg(long, value_name = "PNG")]
    normal: Option<PathBuf>,
    /// The direction of green in --normal: up the image (glTF, OpenGL) or down it (Direct3D).
    #[arg(long, value_name = "DIRECTION", default_value = "up", value_parser = one_of(GREENS))]
    normal_green: Green,
    /// The method that intersects rays with the heights: plain, parallax, parallax-limited, relief,
    /// occlusion, cone or quadtree.
    #[arg(long, value_name = "METHOD", default_value = "quadtree")]
    method: ReliefMethod,
    /// Depth of the relief S, in tiles of the texture: 0 to 1.
    #[arg(long, value_name = "S", default_value_t = 0.1, allow_hyphen_values = true)]
    scale: f64,
    /// Where the square lies in the relief: b of Tanca's dissertation (2012), from 0 (at the relief's bottom)
    /// to -S (at its top, the default).
    #[arg(long, value_name = "B", allow_hyphen_values = true)]
    bias: Option<f64>,
    /// Numbers of linear search steps when looking straight down and at the horizon, for relief and
    /// occlusion.
    #[arg(long, value_name = "MIN,MAX", default_value = "16,64", value_parser = steps)]
    steps: [u32; 2],
    /// Number of binary search steps after the linear or cone steps.
    #[arg(long, value_name = "N", default_value_t = 8)]
    binary_steps: u32,
    /// Degrees between the eye and the square's normal, from 0 to below 90. Flatter rays than 89.55 degrees
    /// are marched as if at 89.55.
    #[arg(long, value_name = "DEG", default_value_t = 50.0, allow_hyphen_values = true)]
    angle: f64,
    /// Degrees by which the eye is turned around the normal: 0 below the texture's bottom edge, 90 at its
    /// right.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_hyphen_values = true)]
    azimuth: f64,
    /// Number of times that the texture repeats along the square's edge.
    #[arg(long, value_name = "N", default_value_t = 1.0, allow_hyphen_values = true)]
    tile: f64,
    /// The self-shadow of the relief.
    #[arg(long, default_value = "none", value_parser = one_of(SHADOWS))]
    shadow: ReliefShadow,
    /// The direction towards the light, in degrees: around the normal as --azimuth, and above the square.
    #[arg(long, value_name = "AZ,EL", default_value = "225,45", allow_hyphen_values = true,
          value_parser = pair::<f64>("light", ',', "must be azimuth and elevation in degrees, such as 225,45"))]
    light: [f64; 2],
    /// What lies beyond the map's edge: the map again, or its outermost texels.
    #[arg(long, default_value = "wrap", value_parser = one_of(ADDRESSES))]
    address: Address,
    /// Cuts away what leaves the square, so that its silhouette follows the relief.
    #[arg(long)]
    silhouette: bool,
    /// The processor that computes.
    #[arg(long, default_value_t, value_enum)]
    backend: Backend,
    /// Width and height of relief.png, in pixels.
    #[arg(long, value_name = "WxH", default_value = "960x600",
          value_parser = pair::<u32>("size", 'x', "must be columns x rows, such as 960x600"))]
    size: [u32; 2],
    /// Measures every method at the angles 0, 30, 60 and 80 instead of drawing a picture; --method, --angle
    /// and --steps are ignored.
    #[arg(long)]
    compare: bool,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct Report<'a> {
    method: ReliefMethod,
    #[serde(flatten)]
    measured: Measured,
    /// Equal to `mean_samples`.
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
    shadow: ReliefShadow,
    map: [u32; 2],
    size: [u32; 2],
    seconds: Seconds,
}

impl Relief {
    pub fn run(&self, context: &Context) -> Result<(), Error> {
        let square = self.square()?;
        // An output folder that cannot be written is reported before the work. The files themselves are
        // staged after it, so that an interrupted run leaves nothing behind.
        drop(Staged::new(&self.out)?);
        let gpu = self.backend.gpu(context)?;
        if self.compare {
            let comparison = compared(&square, gpu.as_ref())?;
            let table = comparison.table();
            let mut staged = Staged::new(&self.out)?;
            staged.write_json("compare.json", &comparison)?;
            staged.write("compare.md", table.as_bytes())?;
            staged.write_png("compare.png", &plot(&comparison)?)?;
            staged.publish()?;
            return say(table.trim_end());
        }
        let drawn = self.drawn(&square, gpu.as_ref())?;
        self.write(&square, gpu.as_ref(), &drawn)?;
        let Measured { mean_error_texels, p99_error_texels, mean_samples, .. } = drawn.measured;
        say(format_args!(
            "{}: mean error {mean_error_texels:.4} texels, 99 of 100 below {p99_error_texels:.4}, \
             {mean_samples:.1} texel loads a pixel; {}",
            self.method.name(),
            self.out.join("relief.png").display()
        ))
    }

    /// The picture or the plot only, for `relievo demo`; writes no files.
    pub fn shown(&self, context: &Context, start: Instant) -> Result<Shown, Error> {
        let (square, gpu) = (self.square()?, self.backend.gpu(context)?);
        if self.compare {
            let plot = plot(&compared(&square, gpu.as_ref())?)?;
            return Ok(Shown::new(plot, "errors against the exact intersection"));
        }
        let Drawn { picture, measured, .. } = self.drawn(&square, gpu.as_ref())?;
        let Measured { mean_error_texels, mean_samples, .. } = measured;
        let seconds = start.elapsed().as_secs_f64();
        let note = format!(
            "mean error {mean_error_texels:.4} texels, {mean_samples:.1} texel loads a pixel; {seconds:.3} s with maps and \
             measuring"
        );
        Ok(Shown::new(picture, note))
    }

    /// Checks the arguments and reads the maps: the square to draw or compare.
    fn square(&self) -> Result<ReliefSquare, Error> {
        let march = March { address: self.address, steps: self.steps, binary_steps: self.binary_steps };
        march.validate()?;
        let view = SquareView { angle: self.angle, azimuth: self.azimuth, tiles: self.tile, size: self.size };
        view.validate()?;
        let material = self.material()?;
        let (map, albedo) = self.maps()?;
        Ok(ReliefSquare {
            map,
            albedo: Mips::of_color(albedo),
            normals: self.normal.as_deref().map(open).transpose()?.map(Mips::of_data),
            green: self.normal_green,
            shadow: self.shadow,
            silhouette: self.silhouette,
            march,
            material,
            view,
        })
    }

    fn material(&self) -> Result<ReliefMaterial, InputError> {
        if !(0.0..=1.0).contains(&self.scale) {
            return Err(InputError::new("scale", self.scale, "must be in 0..=1 tiles"));
        }
        let bias = self.bias.unwrap_or(-self.scale);
        if !(-self.scale..=0.0).contains(&bias) {
            let bound =
                format!("must be from {} (the square at the relief's top) to 0 (at its bottom)", -self.scale);
            return Err(InputError::new("bias", bias, bound));
        }
        let [azimuth, elevation] = self.light;
        let light = towards_light(azimuth, elevation)?.map(|axis| axis as f32);
        let material = ReliefMaterial {
            scale: self.scale as f32,
            plane: if self.scale > 0.0 { (-bias / self.scale) as f32 } else { 1.0 },
            light,
            ..ReliefMaterial::default()
        };
        material.validate()?;
        Ok(material)
    }

    fn maps(&self) -> Result<(HeightMap, RgbaImage), Error> {
        if let Some(kind) = self.builtin {
            let refused = |error: InputError| InputError { path: "texels".into(), ..error };
            let map = kind.height_map(self.texels).map_err(refused)?;
            return Ok((map, kind.albedo(self.texels).map_err(refused)?));
        }
        match (&self.height, &self.albedo) {
            (Some(height), albedo) => {
                let stone = || Ok(RgbaImage::from_pixel(1, 1, image::Rgba([168, 160, 150, 255])));
                Ok((HeightMap::from_file(height)?, albedo.as_deref().map_or_else(stone, open)?))
            }
            (None, Some(albedo)) => {
                let (map, image) = HeightMap::from_alpha(albedo)?;
                let mut color = image.into_rgba8();
                // The alpha channel held the heights: make the colours opaque.
                color.pixels_mut().for_each(|pixel| pixel.0[3] = 255);
                Ok((map, color))
            }
            (None, None) => {
                let bound = "must name a height map, or else --albedo one with alpha, or --builtin a name";
                Err(InputError::new("height", "not given", bound).into())
            }
        }
    }
}

/// Opens an image of colours or normals; refuses one that is larger than a texture may be before it is
/// decoded.
fn open(path: &Path) -> Result<RgbaImage, Error> {
    Ok(relievo::ops::surface::map::open(path)?.into_rgba8())
}

fn built_in(name: &str) -> Result<BuiltInMap, InputError> {
    name.parse().map_err(|error| InputError { path: "builtin".into(), ..error })
}

fn steps(text: &str) -> Result<[u32; 2], InputError> {
    let both = if text.contains(',') { text.to_owned() } else { format!("{text},{text}") };
    pair("steps", ',', "must be one number of steps, or MIN,MAX")(&both)
}

impl Relief {
    fn drawn(&self, square: &ReliefSquare, gpu: Option<&Gpu>) -> Result<Drawn, Error> {
        let progress = bar(4, "building maps");
        let drawn = square.draw(self.method, gpu, BACKGROUND, FINER, &|next| {
            progress.inc(1);
            progress.set_message(next);
        })?;
        progress.finish_and_clear();
        Ok(drawn)
    }

    /// Writes the files of a run without `--compare`.
    fn write(&self, square: &ReliefSquare, gpu: Option<&Gpu>, drawn: &Drawn) -> Result<(), Error> {
        let mut staged = Staged::new(&self.out)?;
        staged.write_png("relief.png", &drawn.picture)?;
        let rays = drawn.rays.iter().flat_map(|ray| match ray {
            Some(ray) => [ray.origin[0], ray.origin[1], 1.0, ray.slope[0], ray.slope[1], -1.0],
            None => [0.0; 6],
        });
        staged.write("rays.f32", &bytes(rays))?;
        let hits = drawn.hits.iter().flat_map(|hit| {
            let met = if hit.outcome() == Outcome::Hit { 1.0 } else { 0.0 };
            [hit.uv[0], hit.uv[1], hit.height, met]
        });
        staged.write("hits.f32", &bytes(hits))?;
        let ReliefSquare { map, march, material, view, .. } = square;
        let report = Report {
            method: self.method,
            measured: drawn.measured,
            samples_per_pixel: drawn.measured.mean_samples,
            adapter: gpu.map(|gpu| gpu.adapter().name.as_str()),
            driver: gpu.map(|gpu| gpu.adapter().driver.as_str()),
            backend: self.backend,
            scale: material.scale,
            bias: -material.plane * material.scale,
            march: *march,
            angle: view.angle,
            azimuth: view.azimuth,
            tile: view.tiles,
            shadow: square.shadow,
            map: [map.width(), map.height()],
            size: view.size,
            seconds: drawn.seconds,
        };
        staged.write_json("report.json", &report)?;
        staged.publish()
    }
}

fn compared(square: &ReliefSquare, gpu: Option<&Gpu>) -> Result<Comparison, Error> {
    let progress = bar(1, "comparing");
    let comparison = square.compare(gpu, &|method, all| {
        progress.set_length(all as u64);
        progress.set_message(method.name());
        progress.inc(1);
    })?;
    progress.finish_and_clear();
    Ok(comparison)
}

fn bytes(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}
