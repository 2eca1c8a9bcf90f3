//! Bytes of packages and the time to read them, beside the finest level alone and beside a file for each level, both encoded by
//! meshoptimizer and zstd as gltfpack does, with the same quantized values. Tangents are left out of all bytes, because gltfpack
//! writes none.
//!
//! ```sh
//! cargo bench --no-default-features --bench package                  # creature, rock, helmet, and the rock with flat shading
//! cargo bench … -- helmet model.glb flat:model.glb          # of these alone: names of the three, and files
//! cargo bench … -- --glb FOLDER NAMES         # also writes each finest level there, for others.mjs
//! ```

#[path = "../levels/helmet.rs"]
mod helmet;

use std::error::Error;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use relievo::asset::package::{Package, PackageHeader};
use relievo::asset::{Influences, Mesh, Model, ModelFile};
use relievo::ops::skinning::{cook, level_errors, own_levels};

/// zstd's level in both encodings.
const ZSTD: i32 = 19;

/// Number of times that a package is read for its time.
const READS: u32 = 20;

fn cooked(file: &ModelFile) -> Result<Vec<u8>, Box<dyn Error>> {
    let made = cook(file, &mut |_| ControlFlow::Continue(()))?;
    Ok(made.unwrap_or_default())
}

/// The bytes of a model's levels without tangents. The model is a package's, so that it is written as it is.
fn level_bytes(model: &Model) -> Result<(usize, usize), Box<dyn Error>> {
    let mut bare = model.clone();
    bare.meshes.iter_mut().for_each(|mesh| mesh.tangents.fill([0.0; 4]));
    let bytes = cooked(&bare.into())?;
    let (header, _) = PackageHeader::read(&bytes)?;
    let end = |level: usize| header.levels[level].chunk.end - header.model.end;
    Ok((end(header.levels.len() - 1), end(0)))
}

/// Numbers of quantized values, four or two a vertex, as meshoptimizer encodes them.
#[derive(Default)]
struct Encoded {
    vertices: Vec<u8>,
    indices: Vec<u8>,
}

impl Encoded {
    fn size(&self) -> Result<usize, Box<dyn Error>> {
        Ok(zstd::bulk::compress(&[&self.indices[..], &self.vertices].concat(), ZSTD)?.len())
    }

    /// Adds one level of a mesh. `step` is the step of its positions.
    fn add(&mut self, mesh: &Mesh, level: u32, step: f64) -> Result<(), Box<dyn Error>> {
        let triangles = mesh.triangles(level);
        if triangles.is_empty() {
            return Ok(());
        }
        let sorted = meshopt::optimize_vertex_cache(triangles, mesh.vertices());
        let places = meshopt::optimize_vertex_fetch_remap(&sorted, mesh.vertices());
        let sorted: Vec<u32> = sorted.iter().map(|vertex| places[*vertex as usize]).collect();
        let mut order = vec![0; places.iter().filter(|place| **place != u32::MAX).count()];
        for (vertex, place) in places.iter().enumerate().filter(|(_, place)| **place != u32::MAX) {
            order[*place as usize] = vertex;
        }
        self.indices.extend(meshopt::encode_index_buffer(&sorted, order.len())?);
        let least =
            |axis: usize| order.iter().map(|at| mesh.positions[*at][axis]).fold(f32::INFINITY, f32::min);
        let least = [0, 1, 2].map(|axis| f64::from(least(axis)));
        let positions = order.iter().map(|at| {
            let [x, y, z] =
                [0, 1, 2].map(|axis| ((f64::from(mesh.positions[*at][axis]) - least[axis]) / step) as u16);
            [x, y, z, 0]
        });
        self.vertices.extend(meshopt::encode_vertex_buffer(&positions.collect::<Vec<[u16; 4]>>())?);
        let normals = order.iter().map(|at| octahedral(mesh.normals[*at]));
        self.vertices.extend(meshopt::encode_vertex_buffer(&normals.collect::<Vec<[i16; 2]>>())?);
        if mesh.uv.iter().any(|uv| *uv != mesh.uv[0]) {
            let uv = order.iter().map(|at| mesh.uv[*at].map(|part| (part * 16_384.0) as i32 as u16));
            self.vertices.extend(meshopt::encode_vertex_buffer(&uv.collect::<Vec<[u16; 2]>>())?);
        }
        let influences = |at: usize| mesh.influences.of(at);
        let is_rigid = order.iter().all(|at| influences(*at) == influences(order[0]));
        for first in (0..mesh.influences.most()).step_by(4).filter(|_| !is_rigid) {
            let part = |at: usize, slot: usize| influences(at).get(first + slot);
            let bones = order
                .iter()
                .map(|at| [0, 1, 2, 3].map(|slot| part(*at, slot).map_or(0, |one| one.bone as u8)));
            self.vertices.extend(meshopt::encode_vertex_buffer(&bones.collect::<Vec<[u8; 4]>>())?);
            let weight =
                |at: usize, slot: usize| part(at, slot).map_or(0, |one| (one.weight * 16_384.0) as u16);
            let weights = order.iter().map(|at| [0, 1, 2, 3].map(|slot| weight(*at, slot)));
            self.vertices.extend(meshopt::encode_vertex_buffer(&weights.collect::<Vec<[u16; 4]>>())?);
        }
        Ok(())
    }
}

/// A normal on an octahedron, with ten bits a component.
fn octahedral([x, y, z]: [f32; 3]) -> [i16; 2] {
    let sum = (x.abs() + y.abs() + z.abs()).max(f32::MIN_POSITIVE);
    let [x, y] = [x / sum, y / sum];
    let [x, y] = if z < 0.0 { [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)] } else { [x, y] };
    [x, y].map(|part| (part * 511.0).round() as i16)
}

/// The step of a mesh's positions: between 2⁻¹⁵ and 2⁻¹⁶ of the extent of all meshes with its skin.
fn step(model: &Model, mesh: &Mesh) -> f64 {
    let extent = |axis: usize| {
        let alike = model.meshes.iter().filter(|other| other.skin == mesh.skin);
        let values = || alike.clone().flat_map(|other| &other.positions).map(|position| position[axis]);
        values().fold(f32::MIN, f32::max) - values().fold(f32::MAX, f32::min)
    };
    let extent = f64::from([0, 1, 2].map(extent).into_iter().fold(0.0, f32::max));
    extent.log2().floor().exp2() / 32_768.0
}

/// Writes the finest level of a model as binary glTF, without clips and materials.
fn write_finest(model: &Model, path: &Path) -> Result<(), Box<dyn Error>> {
    let mut finest = model.clone();
    (finest.clips, finest.materials, finest.images) = Default::default();
    for mesh in &mut finest.meshes {
        (mesh.material, mesh.levels, mesh.partners, mesh.weight_keys) = Default::default();
    }
    Ok(std::fs::write(path, finest.to_glb()?)?)
}

fn report(name: &str, file: &ModelFile, folder: Option<&Path>) -> Result<(), Box<dyn Error>> {
    let bytes = cooked(file)?;
    let model = Model::from_rlv(&bytes)?;
    if let Some(folder) = folder {
        write_finest(&model, &folder.join(format!("{}.finest.glb", name.replace(':', "-"))))?;
    }
    let (header, _) = PackageHeader::read(&bytes)?;
    let (all, first) = level_bytes(&model)?;
    let errors = level_errors(&model.meshes);
    let (mut finest, mut each) = (0, 0);
    for level in 0..header.levels.len() {
        let mut encoded = Encoded::default();
        for mesh in &model.meshes {
            encoded.add(mesh, own_levels(mesh, &errors)[level], step(&model, mesh))?;
        }
        let size = encoded.size()?;
        each += size;
        finest = if level == 0 { size } else { finest };
    }
    let (mut coarsest, mut levels, mut loads) = (0.0, 0.0, 0.0);
    for _ in 0..READS {
        let started = Instant::now();
        let mut package = Package::new(&bytes)?;
        package.add_level(&bytes[header.levels[0].chunk.range()])?;
        coarsest += started.elapsed().as_secs_f64();
        for level in &header.levels[1..] {
            package.add_level(&bytes[level.chunk.range()])?;
        }
        levels += started.elapsed().as_secs_f64();
        let started = Instant::now();
        Model::from_rlv(&bytes)?;
        loads += started.elapsed().as_secs_f64();
    }
    let milliseconds = |seconds: f64| 1e3 * seconds / f64::from(READS);
    let (meshes, triangles) = (model.meshes.len(), header.levels[header.levels.len() - 1].triangles);
    let decoded: usize = header.levels.iter().map(|level| level.triangles).sum();
    let (own, of_finest) = (all as f64 / finest as f64, each as f64 / finest as f64);
    let share = 100.0 * first as f64 / all as f64;
    let coarse = 100.0 * header.levels[0].triangles as f64 / triangles as f64;
    let speed = decoded as f64 * f64::from(READS) / levels / 1e6;
    println!(
        "| {name} | {meshes} | {triangles} | {} | {finest} | {all} | {own:.2} | {of_finest:.2} | {coarse:.1} % | {share:.1} % | \
         {:.1} | {:.1} | {speed:.1} |",
        header.levels.len(),
        milliseconds(coarsest),
        milliseconds(loads),
    );
    Ok(())
}

fn open(name: &str) -> Result<ModelFile, Box<dyn Error>> {
    let model = match name {
        "creature" | "rock" => relievo_samples::model(name)?,
        "helmet" => helmet::helmet()?,
        file => return Ok(ModelFile::open(Path::new(file))?),
    };
    Ok(model.into())
}

/// A model whose triangles have vertices of their own, with the normals of the triangles.
fn flat(mut file: ModelFile) -> Result<ModelFile, Box<dyn Error>> {
    for mesh in &mut file.model.meshes {
        let corners: Vec<usize> = mesh.indices.iter().map(|vertex| *vertex as usize).collect();
        let positions: Vec<_> = corners.iter().map(|corner| mesh.positions[*corner]).collect();
        let indices: Vec<u32> = (0..corners.len() as u32).collect();
        let influences = corners.iter().map(|corner| mesh.influences.of(*corner).to_vec());
        *mesh = Mesh {
            name: mesh.name.clone(),
            skin: mesh.skin,
            material: mesh.material,
            normals: relievo::asset::mesh::smooth_normals(&positions, &indices),
            tangents: corners.iter().map(|corner| mesh.tangents[*corner]).collect(),
            uv: corners.iter().map(|corner| mesh.uv[*corner]).collect(),
            influences: Influences::new("influences", file.model.skins[mesh.skin].bones.len(), influences)?,
            positions,
            indices,
            ..Mesh::default()
        };
    }
    Ok(file)
}

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo passes `--bench` of its own.
    let mut names: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    let folder = match names.iter().position(|name| name == "--glb") {
        Some(at) => names.drain(at..(at + 2).min(names.len())).nth(1).map(PathBuf::from),
        None => None,
    };
    if names.is_empty() {
        names.extend(["creature", "rock", "helmet", "flat:rock"].map(str::to_owned));
    }
    println!(
        "| model | meshes | triangles | levels | finest alone, bytes | package, bytes | ratio | a file a level, ratio | \
         coarsest, triangles | coarsest, bytes | coarsest, ms | whole, ms | triangles of all levels, M/s |"
    );
    println!("|{}", "---|".repeat(13));
    for name in &names {
        let file = match name.strip_prefix("flat:") {
            Some(name) => flat(open(name)?)?,
            None => open(name)?,
        };
        let stem = Path::new(name).file_stem().unwrap_or_default().to_string_lossy();
        let shown = if name.starts_with("flat:") && !stem.starts_with("flat:") {
            format!("flat:{stem}")
        } else {
            stem.into()
        };
        report(&shown, &file, folder.as_deref())?;
    }
    Ok(())
}
