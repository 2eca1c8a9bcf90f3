//! A whole terrain: configuration, features, and what happens after generation.

use crate::InputError;
use crate::terrain::config::{Border, Config};
use crate::terrain::despike::Despike;
use crate::terrain::features::Features;
use crate::terrain::pad;
use crate::terrain::thermal::Thermal;
use crate::terrain::window::Window;

/// What a field of patches is made of, in order: generation, borders, despiking, erosion.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// How heights are generated.
    pub config: Config,
    /// Injected heights.
    pub features: Features,
    /// Removal of spikes, if any.
    pub despike: Option<Despike>,
    /// Thermal erosion, if any.
    pub thermal: Option<Thermal>,
}

impl Recipe {
    /// Generation alone.
    pub fn new(config: Config) -> Self {
        Self { config, features: Features::default(), despike: None, thermal: None }
    }

    /// Samples beyond the final field that generation must give.
    pub fn apron(&self, margin: u32) -> u32 {
        let iterations = self.thermal.map_or(0, |thermal| thermal.iterations);
        margin.saturating_add(self.despike.map_or(0, |_| 1)).saturating_add(iterations)
    }

    /// (column, row) of the injected points of each window: what despiking leaves alone. Empty without it.
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
