//! Heights between those of two configurations, for `relievo terrain`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::Features;
use relievo::ops::terrain::field::field_with;
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::generator::Generator;
use relievo::ops::terrain::morph::reference::morph;
use relievo::ops::terrain::morph::{Morph, MorphedFields, check_target};
use relievo::ops::terrain::recipe::Recipe;
use relievo::{Error, InputError};

use super::export::HeightRange;
use super::ranged;

#[derive(Args)]
pub struct TargetArguments {
    /// A second configuration, of the same patchSize and terrainScale: heights are blended between those of both. Erosion is
    /// the same; features and zones belong to the first.
    #[arg(long, value_name = "FILE")]
    target: Option<PathBuf>,
    /// How far the heights are on the way to --target: 0 (those of --config) to 1. Default: 0.5, with --frames 1.
    #[arg(long, value_name = "TIME", requires = "target", allow_hyphen_values = true)]
    time: Option<f64>,
    /// Also draws N pictures on the way to --target, in equal steps from the heights of --config to those at --time:
    /// frame_0000.png and so on, and their maps, map_0000.png. The camera stands still.
    #[arg(long, value_name = "N", requires = "target", value_parser = RangedU64ValueParser::<u32>::new().range(2..=10_000))]
    frames: Option<u32>,
}

impl TargetArguments {
    /// The batches of patches that are computed.
    pub fn batches(&self) -> u128 {
        1 + u128::from(self.target.is_some())
    }

    /// Reads the target of `recipe`, if there is one. It is eroded as `recipe` is, and has no features.
    pub fn read(&self, recipe: &Recipe, patches: &[[i32; 2]]) -> Result<Target, Error> {
        let Some(path) = &self.target else { return Ok(Target(None)) };
        let time = self.time.unwrap_or(if self.frames.is_some() { 1.0 } else { 0.5 });
        let morph = Morph { time };
        morph.validate()?;
        let config = TerrainConfig::from_file(path)?;
        let of_file = |source: InputError| Error::InputFile { path: path.clone(), source: source.in_json() };
        check_target(&recipe.config, &config).map_err(of_file)?;
        let recipe = Recipe { config, features: Features::default(), ..recipe.clone() };
        recipe.validate(patches, 1).map_err(of_file)?;
        Ok(Target(Some(Aim { recipe, morph, frames: self.frames.unwrap_or(0) })))
    }
}

/// What the heights become, if anything, and how far they are on the way.
pub struct Target(Option<Aim>);

struct Aim {
    recipe: Recipe,
    morph: Morph,
    /// The number of pictures on the way.
    frames: u32,
}

/// The heights at both ends, from which those in between are blended.
pub struct Way {
    ends: Ends,
    /// The heights of both ends.
    pub range: HeightRange,
    /// The times of the pictures on the way.
    pub times: Vec<Morph>,
}

enum Ends {
    Host([Vec<Vec<i32>>; 2]),
    Device(MorphedFields),
}

impl Aim {
    /// Equal steps of time, of which the first is 0.
    fn times(&self) -> Vec<Morph> {
        let last = f64::from(self.frames.max(2) - 1);
        (0..self.frames).map(|frame| Morph { time: self.morph.time * (f64::from(frame) / last) }).collect()
    }
}

impl Target {
    /// Windows on the host at the time that was asked for, and the way there, for pictures.
    pub fn windows(
        &self,
        patches: &[[i32; 2]],
        from: Vec<Vec<i32>>,
    ) -> Result<(Vec<Vec<i32>>, Option<Way>), Error> {
        let Some(aim) = &self.0 else { return Ok((from, None)) };
        let to = field_with(&aim.recipe, patches, 1, &|| ())?;
        let range = ranged(&from).union(ranged(&to));
        let way = Way { ends: Ends::Host([from, to]), range, times: aim.times() };
        Ok((way.windows(aim.morph), Some(way)))
    }

    /// Fields on the device at the time that was asked for, and the way there, for pictures.
    pub fn fields(
        &self,
        gpu: &Gpu,
        patches: &[[i32; 2]],
        from: Vec<Fields>,
    ) -> Result<(Vec<Fields>, Option<Way>), Error> {
        let Some(aim) = &self.0 else { return Ok((from, None)) };
        let to = Generator::new(gpu, aim.recipe.clone())?.generate(gpu, patches, 1, &mut |_| ())?;
        let mut range: Option<HeightRange> = None;
        for part in from.iter().chain(&to) {
            let part = ranged(&part.read_blocking(gpu)?);
            range = Some(range.map_or(part, |range| range.union(part)));
        }
        let range = range.unwrap_or_else(|| ranged(&[]));
        let blend = MorphedFields::new(gpu, &from, &to)?;
        let way = Way { ends: Ends::Device(blend), range, times: aim.times() };
        Ok((way.fields(gpu, aim.morph)?, Some(way)))
    }
}

impl Way {
    /// The windows on the host at a time; none where the heights are on the device.
    pub fn windows(&self, time: Morph) -> Vec<Vec<i32>> {
        let Ends::Host([from, to]) = &self.ends else { return Vec::new() };
        from.iter().zip(to).map(|(from, to)| morph(from, to, time.fixed_time())).collect()
    }

    /// The fields on the device at a time, until the next call; none where the heights are on the host.
    pub fn fields(&self, gpu: &Gpu, time: Morph) -> Result<Vec<Fields>, Error> {
        let Ends::Device(blend) = &self.ends else { return Ok(Vec::new()) };
        blend.set(gpu, time)?;
        gpu.run("terrain/morph", |encoder| blend.record(encoder))?;
        Ok(blend.fields().to_vec())
    }
}
