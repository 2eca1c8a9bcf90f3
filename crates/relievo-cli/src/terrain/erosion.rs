//! The arguments of `relievo terrain` for erosion.

use clap::Args;
use relievo::InputError;
use relievo::ops::terrain::hydraulic::Hydraulic;
use relievo::ops::terrain::recipe::Recipe;
use relievo::ops::terrain::thermal::Thermal;

#[derive(Args)]
pub struct Erosion {
    /// Number of iterations of thermal erosion, which follows despiking.
    #[arg(long, value_name = "ITERATIONS", allow_hyphen_values = true)]
    thermal: Option<u32>,
    /// The steepest slope that thermal erosion leaves alone, in degrees. Default: 35.
    #[arg(long, value_name = "DEGREES", allow_hyphen_values = true)]
    talus: Option<f64>,
    /// Number of cycles of hydraulic erosion, which follows thermal erosion. Each patch is computed in a window with as many
    /// samples around it as there are cycles: larger patches erode for less.
    #[arg(long, value_name = "ITERATIONS", allow_hyphen_values = true)]
    hydraulic: Option<u32>,
    /// The depth of the rain in each cycle of hydraulic erosion, in spacings of samples.
    #[arg(long, value_name = "DEPTH", allow_hyphen_values = true)]
    rain: Option<f64>,
    /// Number of iterations of thermal erosion after hydraulic erosion, with the slope of --talus.
    #[arg(long, value_name = "ITERATIONS", allow_hyphen_values = true)]
    thermal_after: Option<u32>,
}

impl Erosion {
    /// The recipe of a configuration, with what the arguments ask for in the place of its erosion.
    pub fn applied(&self, read: Recipe) -> Result<Recipe, InputError> {
        let thermal = |iterations: Option<u32>, given: Option<Thermal>| {
            let talus = self.talus.unwrap_or(given.unwrap_or_default().talus);
            iterations.or(given.map(|given| given.iterations)).map(|iterations| Thermal { iterations, talus })
        };
        let given = read.hydraulic.unwrap_or_default();
        let iterations = self.hydraulic.or(read.hydraulic.map(|given| given.iterations));
        let rain = self.rain.unwrap_or(given.rain);
        let recipe = Recipe {
            thermal: thermal(self.thermal, read.thermal),
            hydraulic: iterations.map(|iterations| Hydraulic { iterations, rain, ..given }),
            thermal_after: thermal(self.thermal_after, read.thermal_after),
            ..read
        };
        if let (Some(rain), None) = (self.rain, recipe.hydraulic) {
            return Err(InputError::new(
                "rain",
                rain,
                "must stand with --hydraulic, or with hydraulic in the configuration",
            ));
        }
        match (self.talus, recipe.thermal, recipe.thermal_after) {
            (Some(talus), None, None) => {
                Err(InputError::new("talus", talus, "must stand with --thermal or --thermal-after"))
            }
            _ => Ok(recipe),
        }
    }
}
