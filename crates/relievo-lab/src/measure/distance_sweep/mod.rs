//! The test of A section 13: a group of animated models before a camera that moves away from the group's centre.
//!
//! [`distance_sweep`] plays the same group in four scenes, one for each of [`SWEEP_MODES`], and measures at each distance how
//! long the bones' update and the whole frame take, how many bones are interpolated, and how many pixels the points that
//! follow bones lie from where full evaluation puts them. A has frame rates only.
//!
//! A does not give the spacing of its grid, nor the edge of its cube. [`DistanceSweepOptions`] has values at which the
//! distances that A names appear.

use relievo::Error;
use relievo::gpu::Gpu;
use relievo::ops::animation::{AnimatedBones, ClipSet, Order};

use crate::measure::extent::Extent;
use crate::measure::options::{PICTURE, Subject};
use crate::measure::progress::{Listener, Steps};

mod error;
mod look;
mod options;
mod place;
mod report;

use look::{Look, Target};
use place::Group;

pub use options::{DistanceSweepOptions, GroupLayout, SWEEP_MODES};
pub use report::{DistanceSweepReport, SweepError, SweepLayout, SweepRow};

/// A clock of the host: seconds since any fixed moment. A browser has `performance.now()`, divided by 1000.
pub type Clock<'a> = &'a dyn Fn() -> f64;

/// Sweeps the camera away from a group of models, and measures each mode at each distance, in both layouts.
///
/// The four scenes take turns at each distance. The camera moves from distance to distance as
/// [`DistanceSweepOptions::distances`] lists them; bones that a mode stops to sample keep the pose of the distance before.
///
/// The times depend on the machine. All other values are the same in every run on one device.
///
/// The future waits for the device as [`Gpu::wait_async`] does: a browser drives it, and elsewhere `Gpu::block_on` does.
///
/// # Errors
/// [`InputError`](relievo::InputError) for options out of their ranges, a clip that the model lacks, and a model without
/// triangles or whose bones all lie in one point at rest; errors of the device.
///
/// # Examples
///
/// The largest error that the thesis' method shows, and the largest that a bound of one pixel leaves:
///
/// ```
/// use relievo::gpu::{Gpu, Options};
/// use relievo_lab::measure::{DistanceSweepOptions, GateName, Subject, distance_sweep};
///
/// let model = relievo_samples::creature()?; // or Model::from_file("fox.glb")?
/// let subject = Subject { name: "creature", model: &model, clip: 0 };
/// let options = DistanceSweepOptions {
///     instances: 4,
///     distances: vec![900.0],
///     frames: 3,
///     drawn_frames: 0,
///     ..DistanceSweepOptions::default()
/// };
/// let (gpu, start) = (Gpu::headless(&Options::default())?, std::time::Instant::now());
/// let clock = || start.elapsed().as_secs_f64();
/// let report = gpu.block_on(distance_sweep(&gpu, subject, &options, &clock, &|_| ()))?;
/// for row in &report.layouts[0].rows {
///     println!("{}: {} pixels", row.mode.as_str(), row.error.max_pixels);
/// }
/// # Ok::<(), relievo::Error>(())
/// ```
pub async fn distance_sweep(
    gpu: &Gpu,
    subject: Subject<'_>,
    options: &DistanceSweepOptions,
    clock: Clock<'_>,
    listener: Listener<'_>,
) -> Result<DistanceSweepReport, Error> {
    options.validate()?;
    let model = subject.with_one_clip()?;
    let extent = Extent::new(&model.skeleton)?;
    let set = ClipSet::new(&[&model.clips[0]])?;
    let order = Order::new(&model.skeleton);
    let animated_bones = AnimatedBones::new(&order, &set, &[&model.clips[0]])?.count(0);
    let target = if options.drawn_frames > 0 { Some(Target::new(gpu)?) } else { None };
    let all = GroupLayout::ALL.len() * options.distances.len() * SWEEP_MODES.len();
    let steps = Steps::new(listener, "distances", all as u64);
    let mut layouts = Vec::new();
    for layout in GroupLayout::ALL {
        let group = Group { model: &model, options, extent: &extent, animated_bones, layout, clock };
        let mut looks = Vec::new();
        for mode in SWEEP_MODES {
            looks.push(Look::new(gpu, &group, mode, target.as_ref()).await?);
        }
        let mut rows = Vec::new();
        for distance in &options.distances {
            for look in &mut looks {
                rows.push(look.measure(&group, *distance).await?);
                steps.step();
            }
        }
        layouts.push(SweepLayout { layout, rows });
    }
    Ok(DistanceSweepReport {
        adapter: gpu.adapter().name.clone(),
        driver: gpu.adapter().driver.clone(),
        timed_by: look::timed_by(gpu),
        model: subject.name.to_owned(),
        clip: model.clips[0].name().to_owned(),
        instances: options.instances,
        bones: model.skeleton.len(),
        animated_bones,
        vertices: model.meshes.iter().map(|mesh| mesh.positions.len()).sum(),
        seed: options.seed,
        size: options.size,
        spacing: options.spacing,
        edge: options.edge,
        range: [options.range.min, options.range.max],
        period: options.period,
        weights: options.weights,
        pixels: options.pixels,
        rate: options.rate,
        frames: options.frames,
        error_frames: options.error_frames,
        measured: options.measured,
        drawn_frames: options.drawn_frames,
        picture: PICTURE,
        layouts,
    })
}

#[cfg(test)]
mod tests;
