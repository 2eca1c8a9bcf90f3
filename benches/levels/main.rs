//! How long `add_levels` takes, in processor time of all threads, for the first clip of each model at 60 poses a second, or at
//! rest. It prints the triangles and errors of the levels too.
//!
//! ```sh
//! cargo bench --no-default-features --bench levels                  # creature, rock and helmet
//! cargo bench … -- helmet model.glb          # of these alone: names of the three above, and files
//! ```

mod helmet;

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use relievo::asset::Model;
use relievo::ops::skinning::{add_levels, poses_of};

/// Processor time of all threads of the program so far, in seconds.
#[cfg(unix)]
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Not known here: the time that passes says more than nothing.
#[cfg(not(unix))]
fn processor_seconds() -> f64 {
    use std::sync::OnceLock;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

fn report(name: &str, model: &mut Model) -> Result<(), Box<dyn Error>> {
    let clips: Vec<usize> = (0..model.clips.len().min(1)).collect();
    let poses = clips.iter().map(|clip| poses_of(&model.clips[*clip])).collect::<Result<Vec<_>, _>>()?;
    let poses = poses.into_iter().max().unwrap_or(1);
    let (started, before) = (Instant::now(), processor_seconds());
    add_levels(model, &clips, poses)?;
    let (processor, passed) = (processor_seconds() - before, started.elapsed().as_secs_f64());
    let vertices: usize = model.meshes.iter().map(|mesh| mesh.vertices()).sum();
    let triangles =
        |level: u32| model.meshes.iter().map(|mesh| mesh.triangles(level).len() / 3).sum::<usize>();
    let meshes = model.meshes.len();
    let all = triangles(0);
    println!("| {name} | {meshes} | {vertices} | {all} | {poses} | {processor:.2} | {passed:.2} |");
    let errors = relievo::ops::skinning::level_errors(&model.meshes);
    let left = |at: usize| {
        let own = model.meshes.iter().map(|mesh| {
            let own = relievo::ops::skinning::own_levels(mesh, &errors);
            mesh.triangles(own[at + 1]).len() / 3
        });
        own.sum::<usize>()
    };
    let levels = errors.iter().enumerate().map(|(at, error)| format!("{} ±{error:.3e}", left(at)));
    eprintln!("{name}: {}", levels.collect::<Vec<_>>().join(", "));
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo passes `--bench` of its own.
    let mut names: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if names.is_empty() {
        names.extend(["creature", "rock", "helmet"].map(str::to_owned));
    }
    println!("| model | meshes | vertices | triangles | poses | processor, s | passed, s |");
    println!("|---|---|---|---|---|---|---|");
    for name in &names {
        let mut model = match name.as_str() {
            "creature" => relievo_samples::creature()?,
            "rock" => relievo_samples::rock()?,
            "helmet" => helmet::helmet()?,
            file => Model::from_file(Path::new(file))?,
        };
        report(&Path::new(name).file_stem().unwrap_or_default().to_string_lossy(), &mut model)?;
    }
    Ok(())
}
