//! Writes packages.

use std::collections::HashMap;

use super::Package;
use super::coder::Writer;
use super::header::{self, PackageChunk, PackageHeader, PackageLevel, VERSION};
use super::mesh::{Contexts, LeveledMesh, MeshSource};
use super::parts::{MeshParts, Parts};
use super::surface::{Room, Source};
use crate::InputError;
use crate::asset::images::png;
use crate::asset::{Mesh, Model};

/// A model to write as a package.
#[doc(hidden)]
pub struct Packed<'a> {
    /// The model, with its levels of detail.
    pub model: &'a Model,
    /// Errors of the package's levels, without the finest: at least 0, ascending, in the model's units.
    pub errors: &'a [f32],
    /// Largest distance by which quantization moved a vertex, in the model's units.
    pub quantization: f32,
    /// The images of the model as files; images without a file are written as PNG.
    pub images: &'a [Vec<u8>],
}

/// Writes a package. At each level, a mesh has the coarsest of its own levels whose error is at most that of the level.
///
/// # Errors
/// [`InputError`] if the parts of the model do not match each other, and for images that cannot be written.
#[doc(hidden)]
pub fn write(packed: &Packed<'_>) -> Result<Vec<u8>, InputError> {
    let Packed { model, errors, quantization, .. } = *packed;
    model.check().map_err(|error| error.below("model"))?;
    let errors: Vec<f32> = errors.iter().rev().copied().chain([quantization]).collect();
    let steps = |mesh: &Mesh| {
        let own = |level: &usize| match errors.len() - 1 - level {
            0 => 0,
            _ => mesh.levels.partition_point(|own| own.error <= errors[*level]),
        };
        let own: Vec<usize> = (0..errors.len()).map(|level| own(&level)).collect();
        let before = |level: usize| level.checked_sub(1).map_or(mesh.levels.len() + 1, |before| own[before]);
        own.iter().enumerate().map(|(level, own)| (before(level) - own) as u32).collect()
    };
    let parts = Parts::of(model, model.meshes.iter().map(|mesh| MeshParts::of(mesh, steps(mesh))).collect());
    let sources: Vec<Source<'_>> = model.meshes.iter().map(source).collect();
    let mut meshes = Vec::with_capacity(sources.len());
    for ((mesh, source), parts_of) in model.meshes.iter().zip(&sources).zip(&parts.meshes) {
        let own = LeveledMesh::new(parts_of, &parts.skins, errors.len())?;
        meshes.push(own.writing(MeshSource::new(mesh, source)));
    }
    let mut bytes = parts.packed()?;
    let chunk = PackageChunk::new(0, &bytes);
    let mut header = PackageHeader {
        version: VERSION,
        generator: concat!("relievo ", env!("CARGO_PKG_VERSION")).to_owned(),
        quantization,
        model: chunk,
        levels: Vec::new(),
        images: Vec::new(),
    };
    let (mut contexts, mut room) = (Contexts::new(), Room::ENDLESS);
    for (at, error) in errors.iter().enumerate() {
        let mut writer = Writer::new();
        for mesh in &mut meshes {
            mesh.step(at, &mut writer, &mut contexts, &mut room)?;
        }
        let mut chunk = writer.finish();
        let [vertices, triangles] =
            [LeveledMesh::vertices, LeveledMesh::triangles].map(|count| meshes.iter().map(count).sum());
        if at + 1 == errors.len() {
            let before = bytes.len() - header.model.end;
            chunk.resize(chunk.len().max(needed(&room).saturating_sub(before)), 0);
        }
        let place = PackageChunk::new(bytes.len(), &chunk);
        bytes.extend(chunk);
        header.levels.push(PackageLevel {
            triangles,
            vertices,
            error: *error,
            chunk: place,
            hash: String::new(),
        });
    }
    for image in 0..model.images.len() {
        let file = match packed.images.get(image) {
            Some(file) => file.clone(),
            None => png(model, image)?,
        };
        header.images.push(PackageChunk::new(bytes.len(), &file));
        bytes.extend(file);
    }
    // The hashes are those of what a reader gets.
    let whole = [header.clone().written()?, bytes.clone()].concat();
    let mut package = Package::new(&whole)?;
    for level in &mut header.levels {
        let place = package.header().levels[package.levels()].chunk.range();
        package.add_level(&whole[place])?;
        level.hash = package.hash()?;
    }
    Ok([header.written()?, bytes].concat())
}

/// The number of bytes that levels need so that a reader allows what was written.
fn needed(room: &Room) -> usize {
    let used = room.used();
    let fits = |bytes: &usize| {
        used.vertices <= header::most_vertices(*bytes)
            && used.triangles <= header::most_triangles(*bytes)
            && used.moves <= header::most_moves(*bytes)
            && used.tests <= header::most_tests(*bytes)
    };
    // All bounds grow with the number of bytes.
    let (mut low, mut high) = (0, 1 << 30);
    while low < high {
        let middle = (low + high) / 2;
        if fits(&middle) { high = middle } else { low = middle + 1 }
    }
    low
}

/// Groups the vertices of a mesh that have the same position in every pose.
pub(super) fn source(mesh: &Mesh) -> Source<'_> {
    let mut known: HashMap<Vec<u32>, u32> = HashMap::with_capacity(mesh.vertices());
    let mut vertex_of = Vec::new();
    let mut moves: Vec<Vec<u32>> = vec![Vec::new(); mesh.vertices()];
    for (at, target) in (0..).zip(&mesh.targets) {
        for (vertex, delta) in target.vertices.iter().zip(&target.deltas) {
            moves[*vertex as usize].push(at);
            moves[*vertex as usize].extend(delta.position.map(f32::to_bits));
        }
    }
    let point = |(vertex, moves): (usize, Vec<u32>)| {
        let mut key: Vec<u32> = mesh.positions[vertex].map(f32::to_bits).to_vec();
        key.extend(mesh.influences.of(vertex).iter().flat_map(|one| [one.bone, one.weight.to_bits()]));
        key.extend(moves);
        *known.entry(key).or_insert_with(|| {
            vertex_of.push(vertex as u32);
            vertex_of.len() as u32 - 1
        })
    };
    let point_of: Vec<u32> = moves.into_iter().enumerate().map(point).collect();
    let mut counts = vec![0_u32; vertex_of.len()];
    point_of.iter().for_each(|point| counts[*point as usize] += 1);
    let is_single = counts.into_iter().map(|count| count == 1).collect();
    Source { point_of, vertex_of, is_single, partners: &mesh.partners }
}
