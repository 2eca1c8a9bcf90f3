//! `relievo creases`: how visible the lattices of terrain are.

mod crease;

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo::ops::terrain::config::{HeightInterpolation, TerrainConfig};
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::generate;
use relievo_lab::files::Staged;
use serde::Serialize;

use crate::output::say;
use crease::{Crease, creases, hill_shaded};

/// Prints how much terrain bends along the lines of each lattice, as a multiple of the finest, for both ways to interpolate
/// ("interpolation" of a configuration): where the ratio is large, shading shows a crease.
///
/// Writes `linear.png` and `smooth.png`, one patch lit from the north-west at 45 degrees, and `report.json`.
///
/// relievo creases --out creases
#[derive(Args)]
pub struct Creases {
    /// Samples along the edge of a patch: 2^n + 1.
    #[arg(long, value_name = "N", default_value_t = 257)]
    size: u32,
    /// The range of random heights, in samples.
    #[arg(long, value_name = "UNITS", default_value_t = 40.0, allow_hyphen_values = true)]
    scale: f64,
    /// H: the range shrinks by the factor 2^-H a level.
    #[arg(long, value_name = "H", default_value_t = 1.0, allow_hyphen_values = true)]
    roughness: f64,
    /// Number of seeds; the figures are of all of them, the pictures of the first.
    #[arg(long, value_name = "N", default_value_t = 24)]
    seeds: u32,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

#[derive(Serialize)]
struct Report {
    size: u32,
    scale: f64,
    roughness: f64,
    seeds: Vec<String>,
    linear: Vec<Crease>,
    smooth: Vec<Crease>,
}

impl Creases {
    pub fn run(&self) -> Result<(), Error> {
        let seeds: Vec<String> = (0..self.seeds).map(|seed| format!("crease {seed}")).collect();
        let config = |interpolation| {
            let first = seeds.first().map_or("", String::as_str);
            let config = TerrainConfig::new(self.size, self.scale, first)?;
            let config = TerrainConfig { roughness: self.roughness, interpolation, ..config };
            config.validate().map(|()| config)
        };
        let both = [config(HeightInterpolation::Linear)?, config(HeightInterpolation::Smooth)?];
        let [linear, smooth] = [creases(&both[0], &seeds)?, creases(&both[1], &seeds)?];
        let mut staged = Staged::new(&self.out)?;
        for (config, name) in both.iter().zip(["linear.png", "smooth.png"]) {
            let window = generate(config, &Features::default(), &[[0, 0]], 1).swap_remove(0);
            let picture = hill_shaded(&window, self.size as usize + 2, 1.0)?;
            staged.write_png(name, &image::DynamicImage::from(picture).to_rgba8())?;
        }
        let rows = linear.iter().zip(&smooth);
        say(format_args!("level   linear   smooth   (bend across its columns, of that across the finest)"))?;
        for (linear, smooth) in rows {
            say(format_args!("{:>5} {:>8.3} {:>8.3}", linear.level, linear.ratio, smooth.ratio))?;
        }
        let (size, scale, roughness) = (self.size, self.scale, self.roughness);
        staged.write_json("report.json", &Report { size, scale, roughness, seeds, linear, smooth })?;
        staged.publish()?;
        say(format_args!("wrote {}", self.out.display()))
    }
}
