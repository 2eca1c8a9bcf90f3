//! Terrain recipes: the configuration, the features, and the operations after generation.

mod json;

use std::path::Path;

use crate::terrain::config::{Border, TerrainConfig, read_text};
use crate::terrain::despike::Despike;
use crate::terrain::features::Features;
use crate::terrain::hydraulic::Hydraulic;
use crate::terrain::pad;
use crate::terrain::thermal::Thermal;
use crate::terrain::window::Window;
use crate::{Error, InputError};

/// Complete description of a field of patches. Operations run in the order of the struct's fields: generation, borders,
/// despiking, thermal erosion, hydraulic erosion, and thermal erosion once more.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Configuration of the generation.
    pub config: TerrainConfig,
    /// Injected heights.
    pub features: Features,
    /// Removal of spikes; `None` skips it.
    pub despike: Option<Despike>,
    /// Thermal erosion; `None` skips it.
    pub thermal: Option<Thermal>,
    /// Hydraulic erosion; `None` skips it.
    pub hydraulic: Option<Hydraulic>,
    /// Thermal erosion after hydraulic erosion; `None` skips it.
    pub thermal_after: Option<Thermal>,
}

impl Recipe {
    /// A recipe with generation only.
    pub fn new(config: TerrainConfig) -> Self {
        Self {
            config,
            features: Features::default(),
            despike: None,
            thermal: None,
            hydraulic: None,
            thermal_after: None,
        }
    }

    /// Reads a JSON file. Texture paths in its zones are relative to the file.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be read, [`Error::InputFile`] for the errors of [`Recipe::from_json`].
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        let read = Self::from_json(&read_text(path)?);
        let mut recipe = read.map_err(|source| Error::InputFile { path: path.to_owned(), source })?;
        recipe.config.resolve_textures(path);
        Ok(recipe)
    }

    /// Number of samples beyond the patch that generation must provide for a final field with `margin` samples around it.
    pub fn apron(&self, margin: u32) -> u32 {
        let iterations = |thermal: Option<Thermal>| thermal.map_or(0, |thermal| thermal.iterations);
        [
            self.despike.map_or(0, |_| 1),
            iterations(self.thermal),
            self.hydraulic.map_or(0, |hydraulic| hydraulic.iterations),
            iterations(self.thermal_after),
        ]
        .into_iter()
        .fold(margin, u32::saturating_add)
    }

    /// Positions (column, row) of each window's injected points, which despiking leaves alone. The lists are empty without
    /// despiking.
    pub(crate) fn injected(&self, patches: &[[i32; 2]], apron: u32) -> Vec<Vec<(u32, u32)>> {
        match self.despike {
            Some(_) => self.features.in_windows(&self.config, patches, apron),
            None => vec![Vec::new(); patches.len()],
        }
    }

    /// Checks the parameters, and that `patches` with `margin` samples around them can be generated.
    ///
    /// # Errors
    /// The first [`InputError`].
    pub fn validate(&self, patches: &[[i32; 2]], margin: u32) -> Result<(), InputError> {
        self.config.validate()?;
        self.features.check(&self.config)?;
        self.despike.map_or(Ok(()), |despike| despike.validate())?;
        self.thermal.map_or(Ok(()), |thermal| thermal.validate())?;
        self.hydraulic.map_or(Ok(()), |hydraulic| hydraulic.validate())?;
        let after = self.thermal_after.map_or(Ok(()), |thermal| thermal.validate());
        after.map_err(|error| InputError {
            path: error.path.replacen("thermal", "thermal_after", 1),
            ..error
        })?;
        let apron = self.apron(margin);
        if self.config.border != Border::Seamless {
            pad::validate(self.config.patch_size, apron).map_err(|error| self.caused(error))?;
        }
        for &patch in patches {
            Window { patch, apron }.validate(&self.config).map_err(|error| self.caused(error))?;
        }
        Ok(())
    }

    /// Replaces an error about the apron by one about the field that makes it large.
    fn caused(&self, error: InputError) -> InputError {
        match self.hydraulic {
            Some(Hydraulic { iterations, .. }) if error.path == "apron" && iterations > 0 => {
                let bound = format!("makes an apron of {} samples, which {}", error.value, error.bound);
                InputError::new("hydraulic.iterations", iterations, bound)
            }
            _ => error,
        }
    }
}
