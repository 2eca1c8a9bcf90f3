//! A recipe for terrain: the configuration, the features, and the operations after generation.

use crate::InputError;
use crate::terrain::config::{Border, Config};
use crate::terrain::despike::Despike;
use crate::terrain::features::Features;
use crate::terrain::pad;
use crate::terrain::thermal::Thermal;
use crate::terrain::window::Window;

/// How a field of patches is made. The order is generation, borders, despiking, erosion.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// How heights are generated.
    pub config: Config,
    /// Injected heights.
    pub features: Features,
    /// Removal of spikes, if wanted.
    pub despike: Option<Despike>,
    /// Thermal erosion, if wanted.
    pub thermal: Option<Thermal>,
}

impl Recipe {
    /// A recipe that only generates.
    pub fn new(config: Config) -> Self {
        Self { config, features: Features::default(), despike: None, thermal: None }
    }

    /// Samples beyond the patch that generation must provide for a final field with `margin` samples around it.
    pub fn apron(&self, margin: u32) -> u32 {
        let iterations = self.thermal.map_or(0, |thermal| thermal.iterations);
        margin.saturating_add(self.despike.map_or(0, |_| 1)).saturating_add(iterations)
    }

    /// (column, row) of the injected points of each window, which despiking leaves alone. The lists are empty
    /// without despiking.
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
        let apron = self.apron(margin);
        if self.config.border != Border::Seamless {
            pad::validate(self.config.patch_size, apron)?;
        }
        for &patch in patches {
            Window { patch, apron }.validate(&self.config)?;
        }
        Ok(())
    }
}
