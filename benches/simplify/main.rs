//! Simplification beside meshoptimizer's, in one run: time, memory and levels, in one thread, with the default options of
//! both. meshoptimizer needs a run per level; one run of ours to the smallest records them all, and the line
//! `all of one run` has its time beside theirs.
//!
//! ```sh
//! cargo bench --no-default-features --bench simplify                 # generated terrain
//! cargo bench … -- --elevation map.png --mesh spot.obj --mesh creature.glb --grass      # of your files
//! cargo bench … -- --out DIR      # the levels as OBJ, which tests/truth/simplify.py measures
//! cargo bench … -- --terrain --torus --helmet  # meshes of its own
//! cargo bench … -- --plain                    # without normals and texture coordinates
//! cargo bench … -- --out DIR --within        # those of `simplify_within` too
//! cargo bench … -- --percent 6 --normals 0.25   # other levels, another weight of normals
//! cargo bench … -- --growth       # 10,000 to 2 million triangles, and the peak of memory
//! ```

mod meshes;

use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use meshes::Mesh;
use meshopt::VertexDataAdapter;
use peak_alloc::PeakAlloc;
use relievo::ops::mesh::{Simplified, SimplifyOptions, Surface, simplify, simplify_within};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The weight of normals in meshoptimizer's own example; both programs understand it alike.
const NORMALS: f32 = 0.5;
const ROUNDS: usize = 5;
const PERCENT: [usize; 4] = [50, 20, 10, 2];

/// The attributes that count beside positions.
#[derive(Clone, Copy)]
enum Counted {
    Nothing,
    /// Normals by this weight.
    Normals(f32),
    /// Those of [`Mesh::as_reduced`].
    Model,
}

/// A mesh with what counts beside positions.
struct Task<'a> {
    mesh: &'a Mesh,
    attributes: Vec<f32>,
    /// Numbers of `attributes` per vertex.
    stride: usize,
    /// The end of the names of its files, behind that of the mesh.
    suffix: &'static str,
}

impl Task<'_> {
    fn surface(&self) -> Surface<'_> {
        Surface {
            poses: std::slice::from_ref(&self.mesh.positions),
            indices: &self.mesh.indices,
            attributes: &self.attributes,
            stride: self.stride,
        }
    }
}

/// Triangles to simplify to, by one of two programs.
type Simplify = fn(&Task<'_>, usize) -> Result<Vec<u32>, Box<dyn Error>>;

fn ours(task: &Task<'_>, triangles: usize) -> Result<Vec<u32>, Box<dyn Error>> {
    level(task, |surface| simplify(surface, &SimplifyOptions { triangles, ..SimplifyOptions::default() }))
}

/// Within limited distances instead: the smallest that reaches the number of triangles, of those that double from a
/// hundred-thousandth of the mesh's extent.
fn within(task: &Task<'_>, triangles: usize) -> Result<Vec<u32>, Box<dyn Error>> {
    let along = |axis: usize| {
        let all = || task.mesh.positions.iter().map(|position| position[axis]);
        all().fold(f32::NEG_INFINITY, f32::max) - all().fold(f32::INFINITY, f32::min)
    };
    let extent = along(0).max(along(1)).max(along(2));
    let distances: Vec<f32> = (0..17).map(|doubled| extent * 1e-5 * f32::from(2_u16).powi(doubled)).collect();
    let options = SimplifyOptions { triangles, ..SimplifyOptions::default() };
    level(task, |surface| simplify_within(surface, &options, &distances))
}

/// The triangles that are left of a mesh.
fn level(
    task: &Task<'_>,
    simplify: impl Fn(&Surface<'_>) -> Result<Simplified, relievo::InputError>,
) -> Result<Vec<u32>, Box<dyn Error>> {
    let simplified = simplify(&task.surface())?;
    Ok(simplified.triangles(&task.mesh.indices, simplified.collapses().len()))
}

fn theirs(
    Task { mesh, attributes, stride, .. }: &Task<'_>,
    triangles: usize,
) -> Result<Vec<u32>, Box<dyn Error>> {
    let bytes: Vec<u8> =
        mesh.positions.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
    let vertices = VertexDataAdapter::new(&bytes, 12, 0)?;
    let (count, error, options) = (triangles * 3, f32::MAX, meshopt::SimplifyOptions::None);
    if *stride == 0 {
        return Ok(meshopt::simplify(&mesh.indices, &vertices, count, error, options, None));
    }
    let (weights, locks) = (vec![1.0; *stride], vec![false; mesh.positions.len()]);
    Ok(meshopt::simplify_with_attributes_and_locks(
        &mesh.indices,
        &vertices,
        attributes,
        &weights,
        4 * stride,
        &locks,
        count,
        error,
        options,
        None,
    ))
}

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

/// The arguments.
#[derive(Default)]
struct Asked {
    meshes: Vec<Mesh>,
    out: Option<PathBuf>,
    rounds: Option<usize>,
    percent: Vec<usize>,
    normals: Option<f32>,
    is_growth: bool,
    /// Whether nothing counts beside positions.
    is_plain: bool,
    /// Whether levels within limited distances are written too.
    is_within: bool,
}

impl Asked {
    /// How often each time is taken.
    fn rounds(&self) -> usize {
        self.rounds.unwrap_or(ROUNDS).max(1)
    }

    fn parse() -> Result<Self, Box<dyn Error>> {
        let mut asked = Self::default();
        let mut words = std::env::args().skip(1);
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or(format!("{word} needs a value"));
            match word.as_str() {
                // Cargo's own.
                "--bench" => {}
                "--elevation" => asked.meshes.push(meshes::elevation(Path::new(&value()?), 200_000)?),
                "--mesh" => asked.meshes.push(meshes::file(Path::new(&value()?))?),
                "--torus" => asked.meshes.push(meshes::torus()),
                "--helmet" => asked.meshes.push(meshes::helmet()?),
                "--terrain" => asked.meshes.push(meshes::generated(200_000)?),
                "--grass" => asked.meshes.push(meshes::grass(1000)),
                "--out" => asked.out = Some(value()?.into()),
                "--rounds" => asked.rounds = Some(value()?.parse()?),
                "--percent" => asked.percent.push(value()?.parse()?),
                "--normals" => asked.normals = Some(value()?.parse()?),
                "--plain" => asked.is_plain = true,
                "--within" => asked.is_within = true,
                "--growth" => asked.is_growth = true,
                _ => return Err(format!("no such argument: {word}").into()),
            }
        }
        if asked.meshes.is_empty() {
            asked.meshes.push(meshes::generated(200_000)?);
        }
        if asked.percent.is_empty() {
            asked.percent.extend(PERCENT);
        }
        Ok(asked)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let asked = Asked::parse()?;
    if asked.is_growth {
        return growth(asked.rounds());
    }
    println!("| mesh | triangles | counted | left | ours, ms | meshoptimizer, ms | ratio |");
    println!("|---|---|---|---|---|---|---|");
    for mesh in &asked.meshes {
        for counted in [Counted::Nothing, Counted::Normals(asked.normals.unwrap_or(NORMALS)), Counted::Model]
        {
            let welded = mesh.as_reduced();
            let task = match (counted, &welded) {
                (Counted::Nothing, _) => Task { mesh, attributes: Vec::new(), stride: 0, suffix: "" },
                (Counted::Normals(weight), _) => {
                    let attributes =
                        mesh.normals.as_flattened().iter().map(|number| number * weight).collect();
                    Task { mesh, attributes, stride: 3, suffix: "_normals" }
                }
                (Counted::Model, Some((mesh, attributes))) => {
                    Task { mesh, attributes: attributes.clone(), stride: 5, suffix: "_model" }
                }
                (Counted::Model, None) => continue,
            };
            compare(&task, &asked)?;
        }
    }
    Ok(())
}

/// Compares the levels of a mesh: both programs simplify to the number of triangles that both reach.
fn compare(task: &Task<'_>, asked: &Asked) -> Result<(), Box<dyn Error>> {
    let Task { mesh, suffix, .. } = task;
    let name = format!("{}{suffix}", mesh.name);
    if let Some(out) = &asked.out {
        fs::create_dir_all(out)?;
        write_obj(&out.join(format!("{name}.obj")), mesh, &mesh.indices)?;
    }
    let (mut sums, mut levels) = ([0.0, 0.0], Vec::new());
    for percent in &asked.percent {
        let (times, level) = compare_level(task, *percent, asked)?;
        sums.iter_mut().zip(times).for_each(|(sum, time)| *sum += time);
        levels.push(level);
    }
    let of_one_run = of_one_run(task, &levels, asked.rounds())?;
    let [ours, theirs] = sums;
    for (which, ours) in [("all", ours), ("all of one run", of_one_run)] {
        println!(
            "| {name} | {} | {suffix} | {which} | {ours:.1} | {theirs:.1} | {:.2} |",
            mesh.triangles(),
            ours / theirs
        );
    }
    Ok(())
}

/// The time of one run that makes all levels, in milliseconds; they must be those of a run each.
fn of_one_run(task: &Task<'_>, levels: &[Vec<u32>], rounds: usize) -> Result<f64, Box<dyn Error>> {
    let targets: Vec<usize> = levels.iter().map(|level| level.len() / 3).collect();
    let smallest = targets.iter().copied().min().unwrap_or_default();
    let mut times = Vec::new();
    for _ in 0..rounds {
        let start = Instant::now();
        let simplified = simplify(
            &task.surface(),
            &SimplifyOptions { triangles: smallest, ..SimplifyOptions::default() },
        )?;
        let made: Vec<Vec<u32>> = targets
            .iter()
            .map(|&target| simplified.triangles(&task.mesh.indices, simplified.collapses_to(target)))
            .collect();
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if made != levels {
            return Err("the levels of one run are not those of a run each".into());
        }
    }
    Ok(median(times))
}

/// The times of both programs, in milliseconds, and our level.
fn compare_level(
    task: &Task<'_>,
    percent: usize,
    asked: &Asked,
) -> Result<([f64; 2], Vec<u32>), Box<dyn Error>> {
    let Task { mesh, suffix, .. } = task;
    let target = mesh.triangles() * percent / 100;
    // Either may stop early, where nothing more is legal, or late, where a whole part vanishes: both get the same number.
    let reached = theirs(task, target)?.len() / 3;
    let reached = ours(task, reached)?.len() / 3;
    let target = if reached.abs_diff(target) > 2 { reached } else { target };
    let both: [Simplify; 2] = [ours, theirs];
    let (mut times, mut levels) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    for round in 0..asked.rounds() {
        for turn in 0..2 {
            let who = (round + turn) % 2;
            let start = Instant::now();
            levels[who] = both[who](task, [reached, target][who])?;
            times[who].push(start.elapsed().as_secs_f64() * 1e3);
        }
    }
    let ratio = median(times[0].iter().zip(&times[1]).map(|(ours, theirs)| ours / theirs).collect());
    let [ours, theirs] = times.map(median);
    let left = levels.each_ref().map(|level| level.len() / 3);
    println!(
        "| {} | {} | {suffix} | {} / {} | {ours:.1} | {theirs:.1} | {ratio:.2} |",
        mesh.name,
        mesh.triangles(),
        left[0],
        left[1]
    );
    if let Some(out) = &asked.out {
        let near = if asked.is_within { within(task, target)? } else { Vec::new() };
        let all = [("relievo", &levels[0]), ("meshoptimizer", &levels[1]), ("within", &near)];
        for (name, level) in all.into_iter().filter(|(_, level)| !level.is_empty()) {
            write_obj(&out.join(format!("{}{suffix}_{percent}_{name}.obj", mesh.name)), mesh, level)?;
        }
    }
    let [level, _] = levels;
    Ok(([ours, theirs], level))
}

/// Time and memory from 10,000 to 2 million triangles, to 10 %.
fn growth(rounds: usize) -> Result<(), Box<dyn Error>> {
    println!(
        "| triangles | ours, ms | ns / (n log2 n) | meshoptimizer, ms | ratio | peak beyond the mesh, MiB |"
    );
    println!("|---|---|---|---|---|---|");
    for triangles in [10_000, 50_000, 200_000, 800_000, 2_000_000] {
        let mesh = meshes::generated(triangles)?;
        let task = Task { mesh: &mesh, attributes: Vec::new(), stride: 0, suffix: "" };
        let before = MEMORY.current_usage_as_mb();
        MEMORY.reset_peak_usage();
        let mut times = [Vec::new(), Vec::new()];
        let both: [Simplify; 2] = [ours, theirs];
        let mut peak = 0.0;
        for _ in 0..rounds {
            for who in 0..2 {
                let start = Instant::now();
                both[who](&task, mesh.triangles() / 10)?;
                times[who].push(start.elapsed().as_secs_f64() * 1e3);
                if peak == 0.0 {
                    peak = MEMORY.peak_usage_as_mb() - before;
                }
            }
        }
        let ratio = median(times[0].iter().zip(&times[1]).map(|(ours, theirs)| ours / theirs).collect());
        let [ours, theirs] = times.map(median);
        let n = mesh.triangles() as f64;
        let growth = ours * 1e6 / (n * n.log2());
        println!("| {n} | {ours:.1} | {growth:.2} | {theirs:.1} | {ratio:.2} | {peak:.0} |");
    }
    Ok(())
}

fn write_obj(path: &Path, mesh: &Mesh, indices: &[u32]) -> Result<(), Box<dyn Error>> {
    let mut text = String::new();
    for [x, y, z] in &mesh.positions {
        writeln!(text, "v {x} {y} {z}")?;
    }
    for [x, y, z] in &mesh.normals {
        writeln!(text, "vn {x} {y} {z}")?;
    }
    for triangle in indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| triangle[corner] + 1);
        writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}")?;
    }
    Ok(fs::write(path, text)?)
}
