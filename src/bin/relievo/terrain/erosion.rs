//! The arguments of `relievo terrain` for erosion.

use clap::Args;
use relievo::InputError;
use relievo::terrain::hydraulic::Hydraulic;
use relievo::terrain::recipe::Recipe;
use relievo::terrain::thermal::Thermal;

#[derive(Args)]
pub struct Erosion {
    /// Number of iterations of thermal erosion, which follows despiking.
    #[arg(long, value_name = "ITERATIONS")]
    thermal: Option<u32>,
    /// The steepest slope that thermal erosion leaves alone, in degrees. Default: 35.
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    talus: Option<f64>,
    /// Number of cycles of hydraulic erosion, which follows thermal erosion. Each patch is computed in a window with as many
    /// samples around it as there are cycles: larger patches erode for less.
    #[arg(long, value_name = "ITERATIONS")]
    hydraulic: Option<u32>,
    /// The depth of the rain in each cycle of hydraulic erosion, in spacings of samples.
    #[arg(long, value_name = "DEPTH", requires = "hydraulic", allow_hyphen_values = true)]
    rain: Option<f64>,
    /// Number of iterations of thermal erosion after hydraulic erosion, with the slope of --talus.
    #[arg(long, value_name = "ITERATIONS")]
    thermal_after: Option<u32>,
}

impl Erosion {
    /// The recipe of a configuration, with what the arguments ask for in the place of its erosion.
    pub fn applied(&self, read: Recipe) -> Result<Recipe, InputError> {
        let thermal = |iterations: Option<u32>, given: Option<Thermal>| {
            let talus = self.talus.unwrap_or(given.unwrap_or_default().talus);
            iterations.or(given.map(|given| given.iterations)).map(|iterations| Thermal { iterations, talus })
        };
        let hydraulic = self.hydraulic.map(|iterations| {
            let given = read.hydraulic.unwrap_or_default();
            Hydraulic { iterations, rain: self.rain.unwrap_or(given.rain), ..given }
        });
        let recipe = Recipe {
            thermal: thermal(self.thermal, read.thermal),
            hydraulic: hydraulic.or(read.hydraulic),
            thermal_after: thermal(self.thermal_after, read.thermal_after),
            ..read
        };
        match (self.talus, recipe.thermal, recipe.thermal_after) {
            (Some(talus), None, None) => {
                Err(InputError::new("talus", talus, "must stand with --thermal or --thermal-after"))
            }
            _ => Ok(recipe),
        }
    }
}
