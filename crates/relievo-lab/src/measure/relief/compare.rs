//! Error and cost of every ray-height method, at several angles.

use relievo::gpu::Gpu;
use relievo::ops::surface::{March, ReliefMethod, ReliefRay};
use relievo::{Error, InputError};
use serde::Serialize;

use crate::measure::relief::tracer::Tracer;
use crate::measure::relief::{Measured, ReliefSquare, SquareView};

/// The numbers of linear steps that are tried at every angle, for methods that have linear steps.
const STEPS: [u32; 8] = [4, 8, 16, 32, 64, 128, 256, 512];

/// The error and cost of a method at one angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Entry {
    /// Degrees between the eye and the square's normal.
    pub angle: f64,
    /// The ray-height method.
    pub method: ReliefMethod,
    /// Number of linear steps; `None` for methods that have none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u32>,
    /// Error and cost of the method.
    #[serde(flatten)]
    pub measured: Measured,
    /// Equal to [`Measured::mean_samples`].
    pub samples_per_pixel: f64,
}

/// The error and cost of every method at every angle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The device's adapter; `None` on the CPU.
    pub adapter: Option<String>,
    /// The device's driver; `None` on the CPU.
    pub driver: Option<String>,
    /// The processor that computed: `gpu` or `cpu`.
    pub backend: &'static str,
    /// Width and height of the map, in texels.
    pub map: [u32; 2],
    /// Depth of the relief, in tiles of the texture.
    pub scale: f32,
    /// What lies beyond the map's edge.
    pub address: &'static str,
    /// Degrees by which the eye is turned around the normal.
    pub azimuth: f64,
    /// Number of binary steps of the methods that have them.
    pub binary_steps: u32,
    /// The measurements: method by method, angle by angle, by increasing number of steps.
    pub entries: Vec<Entry>,
}

impl ReliefSquare {
    /// Measures every method at each of [`Comparison::ANGLES`], with 4 to 512 linear steps if the method has
    /// them; the square's own angle and steps are not used. Without a device, the CPU traces. `progress` is
    /// called for each measurement, with the method and the number of all measurements.
    ///
    /// # Errors
    /// [`InputError`] for a picture so small that no pixel sees the square; [`relievo::gpu::GpuError`] for
    /// errors of the device.
    pub fn compare(
        &self,
        gpu: Option<&Gpu>,
        progress: &dyn Fn(ReliefMethod, usize),
    ) -> Result<Comparison, Error> {
        let lists = self.lists()?;
        let runs = |method: ReliefMethod| if method.is_stepped() { STEPS.len() } else { 1 };
        let all = lists.len() * ReliefMethod::ALL.into_iter().map(runs).sum::<usize>();
        let mut entries = Vec::new();
        for method in ReliefMethod::ALL {
            let tracer = Tracer::new(&self.map, method, self.march.address, gpu)?;
            for (angle, rays) in Comparison::ANGLES.into_iter().zip(&lists) {
                for steps in STEPS.into_iter().take(runs(method)) {
                    let hits = tracer.trace(rays, &March { steps: [steps, steps], ..self.march })?;
                    let measured = Measured::of(&self.map, self.march.address, rays, &hits);
                    let steps = method.is_stepped().then_some(steps);
                    let samples_per_pixel = measured.mean_samples;
                    entries.push(Entry { angle, method, steps, measured, samples_per_pixel });
                    progress(method, all);
                }
            }
        }
        Ok(Comparison {
            adapter: gpu.map(|gpu| gpu.adapter().name.clone()),
            driver: gpu.map(|gpu| gpu.adapter().driver.clone()),
            backend: if gpu.is_some() { "gpu" } else { "cpu" },
            map: [self.map.width(), self.map.height()],
            scale: self.material.scale,
            address: self.march.address.name(),
            azimuth: self.view.azimuth,
            binary_steps: self.march.binary_steps,
            entries,
        })
    }

    /// The rays of the picture at each angle.
    fn lists(&self) -> Result<[Vec<ReliefRay>; 4], InputError> {
        let lists = Comparison::ANGLES.map(|angle| {
            let rays = SquareView { angle, ..self.view }.rays(self.material.scale, self.material.plane);
            rays.into_iter().flatten().collect::<Vec<ReliefRay>>()
        });
        match lists.iter().position(Vec::is_empty) {
            None => Ok(lists),
            Some(at) => {
                let size = format!("{}x{}", self.view.size[0], self.view.size[1]);
                let angle = Comparison::ANGLES[at];
                let bound = format!("must be larger: no pixel sees the square at {angle}°");
                Err(InputError::new("view.size", size, bound))
            }
        }
    }
}

impl Comparison {
    /// The angles that are measured: degrees between the eye and the square's normal.
    pub const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

    /// The measurements as Markdown: one row per method and number of steps, then the cheapest method that
    /// reaches each error.
    pub fn table(&self) -> String {
        let mut text = format!(
            "Relief depth {}, {} × {} texels, {} addressing, {}. Errors in texels against the exact intersection; loads \
             are all texel loads a pixel, acceleration maps included.\n\n\
             | angle | method | steps | mean error | 99 of 100 below | largest | misses | loads |\n\
             |---:|---|---:|---:|---:|---:|---:|---:|\n",
            self.scale,
            self.map[0],
            self.map[1],
            self.address,
            self.adapter.as_deref().unwrap_or("CPU"),
        );
        self.entries.iter().for_each(|entry| text += &entry.row());
        text += "\nThe cheapest method for a mean error:\n\n| angle |";
        let bounds = [10.0, 1.0, 0.25, 0.05, 0.01];
        for bound in bounds {
            text += &format!(" ≤ {bound} texel |");
        }
        text += "\n|---:|---|---|---|---|---|\n";
        for angle in Self::ANGLES {
            text += &format!("| {angle}° |");
            for bound in bounds {
                text += &format!(" {} |", self.cheapest(angle, bound));
            }
            text.push('\n');
        }
        text
    }

    fn cheapest(&self, angle: f64, bound: f64) -> String {
        let fitting = (self.entries.iter())
            .filter(|entry| entry.angle == angle && entry.measured.mean_error_texels <= bound)
            .min_by(|a, b| a.measured.mean_samples.total_cmp(&b.measured.mean_samples));
        fitting.map_or("none".to_owned(), |entry| {
            let steps = entry.steps.map_or(String::new(), |steps| format!(" {steps}"));
            format!("{}{steps}: {:.1} loads", entry.method.name(), entry.measured.mean_samples)
        })
    }
}

impl Entry {
    fn row(&self) -> String {
        let Measured { mean_error_texels, p99_error_texels, max_error_texels, misses, mean_samples, .. } =
            self.measured;
        format!(
            "| {}° | {} | {} | {} | {} | {} | {misses} | {mean_samples:.1} |\n",
            self.angle,
            self.method.name(),
            self.steps.map_or("–".to_owned(), |steps| steps.to_string()),
            texels(mean_error_texels),
            texels(p99_error_texels),
            texels(max_error_texels),
        )
    }
}

/// Formats an error in texels; small errors are rounded to their order of magnitude.
fn texels(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error if error < 1e-4 => format!("{error:.0e}"),
        error => format!("{error:.4}"),
    }
}
