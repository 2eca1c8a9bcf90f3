//! Heights between those of two configurations, for `relievo terrain`.

use std::path::PathBuf;

use clap::Args;
use relievo::Error;
use relievo::gpu::Gpu;
use relievo::terrain::config::Config;
use relievo::terrain::features::Features;
use relievo::terrain::field::field_with;
use relievo::terrain::fields::Fields;
use relievo::terrain::generator::Generator;
use relievo::terrain::morph::reference::morph;
use relievo::terrain::morph::{Morph, MorphedFields, check_target};
use relievo::terrain::recipe::Recipe;

#[derive(Args)]
pub struct TargetArguments {
    /// A second configuration, of the same patchSize and terrainScale: heights are blended between those of both. Erosion is
    /// the same; features and zones belong to the first.
    #[arg(long, value_name = "FILE")]
    target: Option<PathBuf>,
    /// How far the heights are on the way to --target: 0 (those of --config) to 1.
    #[arg(long, value_name = "TIME", default_value_t = 0.5, requires = "target", allow_hyphen_values = true)]
    time: f64,
}

impl TargetArguments {
    /// The batches of patches that are computed.
    pub fn batches(&self) -> u128 {
        1 + u128::from(self.target.is_some())
    }

    /// Reads the target of `recipe`, if there is one. It is eroded as `recipe` is, and has no features.
    pub fn read(&self, recipe: &Recipe, patches: &[[i32; 2]]) -> Result<Target, Error> {
        let Some(path) = &self.target else { return Ok(Target(None)) };
        let morph = Morph { time: self.time };
        morph.validate()?;
        let config = Config::from_file(path)?;
        let of_file = |source| Error::InputFile { path: path.clone(), source };
        check_target(&recipe.config, &config).map_err(of_file)?;
        let recipe = Recipe { config, features: Features::default(), ..recipe.clone() };
        recipe.validate(patches, 1).map_err(of_file)?;
        Ok(Target(Some((recipe, morph))))
    }
}

/// What the heights become, if anything, and how far they are on the way.
pub struct Target(Option<(Recipe, Morph)>);

impl Target {
    /// Blends windows on the host.
    pub fn windows(&self, patches: &[[i32; 2]], from: Vec<Vec<i32>>) -> Result<Vec<Vec<i32>>, Error> {
        let Some((recipe, time)) = &self.0 else { return Ok(from) };
        let to = field_with(recipe, patches, 1, &|| ())?;
        Ok(from.iter().zip(&to).map(|(from, to)| morph(from, to, time.fixed_time())).collect())
    }

    /// Blends fields on the device.
    pub fn fields(&self, gpu: &Gpu, patches: &[[i32; 2]], from: Vec<Fields>) -> Result<Vec<Fields>, Error> {
        let Some((recipe, time)) = &self.0 else { return Ok(from) };
        let to = Generator::new(gpu, recipe.clone())?.generate(gpu, patches, 1, &mut |_| ())?;
        let blend = MorphedFields::new(gpu, &from, &to)?;
        blend.set(gpu, *time)?;
        gpu.run("terrain/morph", |encoder| blend.record(encoder))?;
        Ok(blend.fields().to_vec())
    }
}
