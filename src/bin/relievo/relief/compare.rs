//! `relievo relief --compare`: error and cost of every method, over angles.

use std::fmt::Write as _;
use std::path::Path;

use relievo::surface::{March, Measured, Method, Ray, SquareView};
use relievo::terrain::export::write_bytes;
use relievo::{Error, InputError};
use serde::Serialize;

use super::Plan;
use super::tracer::Tracer;
use crate::Context;
use crate::output::{Staged, json, say};
use crate::plot::{Chart, Series, grid};
use crate::progress::bar;
use crate::terrain::{Backend, save};

const ANGLES: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

/// Linear steps, fixed over the angles, of the methods that have them.
const STEPS: [u32; 8] = [4, 8, 16, 32, 64, 128, 256, 512];

/// A method at one angle.
#[derive(Serialize)]
struct Entry {
    angle: f64,
    method: Method,
    /// Linear steps, of methods that have them.
    #[serde(skip_serializing_if = "Option::is_none")]
    steps: Option<u32>,
    #[serde(flatten)]
    measured: Measured,
    samples_per_pixel: f64,
}

#[derive(Serialize)]
struct Comparison<'a> {
    adapter: Option<&'a str>,
    driver: Option<&'a str>,
    backend: Backend,
    map: [u32; 2],
    scale: f32,
    address: &'static str,
    azimuth: f64,
    binary_steps: u32,
    entries: &'a [Entry],
}

pub fn run(plan: &Plan, context: &Context, out: &Path) -> Result<(), Error> {
    let (entries, adapter) = compared(plan, context)?;
    let mut staged = Staged::new(out)?;
    let [name, driver] = [0, 1].map(|i| adapter.as_ref().map(|names| names[i].as_str()));
    let comparison = Comparison {
        adapter: name,
        driver,
        backend: plan.backend,
        map: [plan.map.width(), plan.map.height()],
        scale: plan.material.scale,
        address: plan.march.address.name(),
        azimuth: plan.view.azimuth,
        binary_steps: plan.march.binary_steps,
        entries: &entries,
    };
    let table = table(&comparison);
    write_bytes(&staged.path("compare.json"), &json(&comparison)?)?;
    write_bytes(&staged.path("compare.md"), table.as_bytes())?;
    save(&staged.path("compare.png"), &plot(&entries)?)?;
    staged.publish()?;
    say(table.trim_end())
}

/// The plot alone, for the demonstration.
#[cfg(feature = "gpu")]
pub fn picture(plan: &Plan, context: &Context) -> Result<image::RgbaImage, Error> {
    Ok(plot(&compared(plan, context)?.0)?)
}

/// Every method at every angle, and the adapter.
fn compared(plan: &Plan, context: &Context) -> Result<(Vec<Entry>, Option<[String; 2]>), Error> {
    let lists = ANGLES.map(|angle| {
        let view = SquareView { angle, ..plan.view };
        view.rays(plan.material.scale, plan.material.plane).into_iter().flatten().collect::<Vec<Ray>>()
    });
    if let Some(at) = lists.iter().position(Vec::is_empty) {
        let size = format!("{}x{}", plan.view.size[0], plan.view.size[1]);
        let bound = format!("must be larger: no pixel sees the square at {}°", ANGLES[at]);
        return Err(InputError::new("size", size, bound).into());
    }
    let runs = |method: Method| if method.is_stepped() { STEPS.len() } else { 1 };
    let progress = bar((ANGLES.len() * Method::ALL.into_iter().map(runs).sum::<usize>()) as u64, "comparing");
    let (mut entries, mut adapter) = (Vec::new(), None);
    for method in Method::ALL {
        progress.set_message(method.name());
        let tracer = Tracer::new(&plan.map, method, plan.march.address, plan.backend, context)?;
        adapter = tracer.adapter();
        for (angle, rays) in ANGLES.into_iter().zip(&lists) {
            for steps in STEPS.into_iter().take(runs(method)) {
                let march = March { steps: [steps, steps], ..plan.march };
                let hits = tracer.trace(rays, &march)?;
                let measured = Measured::of(&plan.map, plan.march.address, rays, &hits);
                let steps = method.is_stepped().then_some(steps);
                let samples_per_pixel = measured.mean_samples;
                entries.push(Entry { angle, method, steps, measured, samples_per_pixel });
                progress.inc(1);
            }
        }
    }
    progress.finish_and_clear();
    Ok((entries, adapter))
}

/// Markdown: one row a method and step count, then the cheapest method for an error.
fn table(comparison: &Comparison<'_>) -> String {
    let mut text = format!(
        "Relief depth {}, {} × {} texels, {} addressing, {}. Errors in texels against the exact intersection; loads \
         are all texel loads a pixel, acceleration maps included.\n\n\
         | angle | method | steps | mean error | 99 of 100 below | largest | misses | loads |\n\
         |---:|---|---:|---:|---:|---:|---:|---:|\n",
        comparison.scale,
        comparison.map[0],
        comparison.map[1],
        comparison.address,
        comparison.adapter.unwrap_or("CPU"),
    );
    for entry in comparison.entries {
        let steps = entry.steps.map_or("–".to_owned(), |steps| steps.to_string());
        let Measured { mean_error_texels, p99_error_texels, max_error_texels, misses, mean_samples, .. } =
            entry.measured;
        writeln!(
            text,
            "| {}° | {} | {steps} | {} | {} | {} | {misses} | {mean_samples:.1} |",
            entry.angle,
            entry.method.name(),
            texels(mean_error_texels),
            texels(p99_error_texels),
            texels(max_error_texels),
        )
        .expect("a string");
    }
    text += "\nThe cheapest method for a mean error:\n\n| angle |";
    let bounds = [10.0, 1.0, 0.25, 0.05, 0.01];
    for bound in bounds {
        write!(text, " ≤ {bound} texel |").expect("a string");
    }
    text += "\n|---:|---|---|---|---|---|\n";
    for angle in ANGLES {
        write!(text, "| {angle}° |").expect("a string");
        for bound in bounds {
            write!(text, " {} |", cheapest(comparison.entries, angle, bound)).expect("a string");
        }
        text.push('\n');
    }
    text
}

/// An error, small ones by their order.
fn texels(error: f64) -> String {
    match error {
        0.0 => "0".to_owned(),
        error if error < 1e-4 => format!("{error:.0e}"),
        error => format!("{error:.4}"),
    }
}

fn cheapest(entries: &[Entry], angle: f64, bound: f64) -> String {
    let fitting = entries
        .iter()
        .filter(|entry| entry.angle == angle && entry.measured.mean_error_texels <= bound)
        .min_by(|a, b| a.measured.mean_samples.total_cmp(&b.measured.mean_samples));
    fitting.map_or("none".to_owned(), |entry| {
        let steps = entry.steps.map_or(String::new(), |steps| format!(" {steps}"));
        format!("{}{steps}: {:.1} loads", entry.method.name(), entry.measured.mean_samples)
    })
}

/// One panel an angle.
fn plot(entries: &[Entry]) -> Result<image::RgbaImage, relievo::InputError> {
    let chart = |angle: f64| {
        let series = Method::ALL.into_iter().map(|method| {
            let here = || entries.iter().filter(move |entry| entry.angle == angle && entry.method == method);
            Series {
                name: method.name().to_owned(),
                points: here()
                    .map(|entry| (entry.measured.mean_samples, entry.measured.mean_error_texels))
                    .collect(),
                labels: here().filter_map(|entry| entry.steps.map(|steps| steps.to_string())).collect(),
            }
        });
        Chart {
            title: format!("{angle}°"),
            x_label: "texel loads a pixel".to_owned(),
            y_label: "mean error in texels".to_owned(),
            log_x: true,
            log_y: true,
            series: series.collect(),
        }
    };
    let title = "Error against cost, by angle from the normal (labels: linear steps)";
    Ok(image::DynamicImage::ImageRgb8(grid(title, &ANGLES.map(chart), 2, (1200, 900))?).into_rgba8())
}
