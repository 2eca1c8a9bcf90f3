//! Error and cost of every method, over angles.

use std::fmt::Write as _;

use serde::Serialize;

use super::ReliefSquare;
use super::tracer::Tracer;
use crate::gpu::Gpu;
use crate::surface::{March, Measured, Method, Ray, SquareView};
use crate::{Error, InputError};

/// Linear steps, fixed over the angles, of the methods that have them.
const STEPS: [u32; 8] = [4, 8, 16, 32, 64, 128, 256, 512];

/// A method at one angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Entry {
    /// Degrees between the eye and the square's normal.
    pub angle: f64,
    /// The method.
    pub method: Method,
    /// Linear steps, of methods that have them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u32>,
    /// Error and cost.
    #[serde(flatten)]
    pub measured: Measured,
    /// [`Measured::mean_samples`].
    pub samples_per_pixel: f64,
}

/// Every method at every angle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The device's name; none of the CPU.
    pub adapter: Option<String>,
    /// The device's driver.
    pub driver: Option<String>,
    /// `gpu` or `cpu`.
    pub backend: &'static str,
    /// Texels of the map.
    pub map: [u32; 2],
    /// Depth of the relief, in tiles of the texture.
    pub scale: f32,
    /// What lies beyond the map's edge.
    pub address: &'static str,
    /// Degrees of the eye around the normal.
    pub azimuth: f64,
    /// Of methods that have them.
    pub binary_steps: u32,
    /// What was measured: method by method, angle by angle, with more and more steps.
    pub entries: Vec<Entry>,
}

impl ReliefSquare {
    /// Measures every method at each of [`Comparison::ANGLES`], with 4 to 512 linear steps where it has them; the square's
    /// own angle and steps do not count. Without a device, the CPU traces. `progress` hears of each measurement, and how
    /// many there are.
    ///
    /// # Errors
    /// [`InputError`] for a picture so small that no pixel sees the square; [`crate::gpu::GpuError`].
    pub fn compare(&self, gpu: Option<&Gpu>, progress: &dyn Fn(Method, usize)) -> Result<Comparison, Error> {
        let lists = self.lists()?;
        let runs = |method: Method| if method.is_stepped() { STEPS.len() } else { 1 };
        let all = lists.len() * Method::ALL.into_iter().map(runs).sum::<usize>();
        let mut entries = Vec::new();
        for method in Method::ALL {
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

    /// The rays of each angle.
    fn lists(&self) -> Result<[Vec<Ray>; 4], InputError> {
        let lists = Comparison::ANGLES.map(|angle| {
            let rays = SquareView { angle, ..self.view }.rays(self.material.scale, self.material.plane);
            rays.into_iter().flatten().collect::<Vec<Ray>>()
        });
        match lists.iter().position(Vec::is_empty) {
            None => Ok(lists),
            Some(at) => {
                let size = format!("{}x{}", self.view.size[0], self.view.size[1]);
                let angle = Comparison::ANGLES[at];
                let bound = format!("must be larger: no pixel sees the square at {angle}°");
                Err(InputError::new("size", size, bound))
            }
        }
    }
}

impl Comparison {
    /// Degrees between the eye and the square's normal.
    pub const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

    /// Markdown: one row a method and step count, then the cheapest method for an error.
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
            write!(text, " ≤ {bound} texel |").expect("a string");
        }
        text += "\n|---:|---|---|---|---|---|\n";
        for angle in Self::ANGLES {
            write!(text, "| {angle}° |").expect("a string");
            for bound in bounds {
                write!(text, " {} |", self.cheapest(angle, bound)).expect("a string");
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

/// An error, small ones by their order.
fn texels(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error if error < 1e-4 => format!("{error:.0e}"),
        error => format!("{error:.4}"),
    }
}
