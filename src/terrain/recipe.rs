//! Terrain recipes: a configuration, injected features, and the operations that run after generation.

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

/// Complete description of how patches of terrain are made. The order of operations is fixed: generation, borders, despiking,
/// thermal erosion, hydraulic erosion, and thermal erosion once more.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Configuration of the generated heights and borders.
    pub config: TerrainConfig,
    /// Heights that are injected during generation.
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

/// A stage of erosion, with at least one iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ErosionStage {
    Thermal(Thermal),
    Hydraulic(Hydraulic),
}

impl ErosionStage {
    /// Number of iterations.
    pub fn iterations(self) -> u32 {
        match self {
            Self::Thermal(thermal) => thermal.iterations,
            Self::Hydraulic(hydraulic) => hydraulic.iterations,
        }
    }
}

impl Recipe {
    /// Creates a recipe without features, despiking or erosion.
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

    /// Reads a recipe from a JSON file. Texture paths in the file's zones are relative to the file.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be read; [`Error::InputFile`] for the errors of [`Recipe::from_json`].
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        let read = Self::from_json(&read_text(path)?);
        let mut recipe = read.map_err(|source| Error::InputFile { path: path.to_owned(), source })?;
        recipe.config.resolve_textures(path);
        Ok(recipe)
    }

    /// Number of samples that generation must add on each side of a patch, so that `margin` samples remain after all operations.
    /// Despiking and each iteration of erosion use up one sample per side.
    pub fn apron(&self, margin: u32) -> u32 {
        let eroded = self.erosion().map(ErosionStage::iterations).fold(margin, u32::saturating_add);
        eroded.saturating_add(self.despike.map_or(0, |_| 1))
    }

    /// The stages of erosion, in their order.
    pub(crate) fn erosion(&self) -> impl Iterator<Item = ErosionStage> + use<> {
        let thermal = |thermal: Option<Thermal>| thermal.map(ErosionStage::Thermal);
        let hydraulic = self.hydraulic.map(ErosionStage::Hydraulic);
        let all = [thermal(self.thermal), hydraulic, thermal(self.thermal_after)];
        all.into_iter().flatten().filter(|stage| stage.iterations() > 0)
    }

    /// Positions (column, row) of the injected points in each patch's window. Despiking leaves these points unchanged. Without
    /// despiking the lists are empty.
    pub(crate) fn injected(&self, patches: &[[i32; 2]], apron: u32) -> Vec<Vec<(u32, u32)>> {
        match self.despike {
            Some(_) => self.features.in_windows(&self.config, patches, apron),
            None => vec![Vec::new(); patches.len()],
        }
    }

    /// Checks all parameters, and that `patches` can be generated with `margin` samples around each.
    ///
    /// # Errors
    /// [`InputError`] for the first parameter or patch that is out of bounds.
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

    /// Replaces an error about the apron by an error about the number of iterations that makes the apron too large.
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
