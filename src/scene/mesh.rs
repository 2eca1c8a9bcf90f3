//! Meshes of objects on the device: those of a model at rest, and those of a character, which its bones move.

use crate::asset::{Mesh, Model};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::Shares;
use crate::scene::character::Character;
use crate::scene::drawable::{Drawable, MeshDrawable, MeshPart, SurfaceKind};
use crate::scene::instances::Instances;
use crate::scene::layout::ObjectRange;
use crate::scene::material::PartMaterials;
use crate::scene::object::{Kind, Object};
use crate::shared::lod::object::{OBJECT_LEVELS, OBJECT_LISTS, SceneDraw};
use crate::shared::render::scene_mesh::MeshParams;
use crate::skinning::at_rest::at_rest;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::buffers::MeshBuffers;
use crate::skinning::clusters::Clusters;
use crate::skinning::merged::{Merged, Part, merged};
use crate::skinning::vertex::Vertex;
use crate::{Error, InputError};

/// An object of a model's meshes at rest.
pub(super) fn object(gpu: &Gpu, model: &Model, capacity: usize) -> Result<Object, Error> {
    check(model, capacity)?;
    let mut rest = at_rest(model)?;
    if model.clips.is_empty() {
        // The levels were made for this pose. Vertices and their order are the same.
        for (mesh, from) in rest.meshes.iter_mut().zip(&model.meshes) {
            mesh.levels.clone_from(&from.levels);
        }
    }
    let merged = merged(&rest, OBJECT_LEVELS as usize)?;
    let corners = merged.model.meshes.iter().flat_map(|mesh| &mesh.positions);
    let sphere = BoundingSphere::around(corners.map(|position| (*position).into()));
    let mut drawables = Vec::new();
    let mut draws = Vec::new();
    for (index, mesh) in merged.model.meshes.iter().enumerate() {
        let (buffers, clusters) = MeshBuffers::new(gpu, &merged.model, mesh)?;
        draws.extend(part_draws(&merged, index, &buffers));
        let vertices = buffers.vertices.clone();
        drawables.push(drawable(gpu, &merged, index, (&buffers, &clusters), vertices, false)?);
    }
    Ok(Object {
        kind: Kind::Mesh,
        instances: Instances::new(capacity),
        sphere,
        errors: errors(&merged),
        mesh_fraction: 1.0,
        is_shown: true,
        drawables,
        draws,
        range: ObjectRange::default(),
    })
}

/// An object of a model that has clips.
pub(super) fn character(gpu: &Gpu, model: &Model, capacity: usize, shares: Shares) -> Result<Object, Error> {
    check(model, capacity)?;
    let merged = merged(model, OBJECT_LEVELS as usize)?;
    let instances = Instances::new(capacity);
    let character = Character::new(gpu, merged, instances.capacity())?;
    let (drawables, draws) = (character.drawables(gpu)?, character.draws());
    Ok(Object {
        instances,
        sphere: character.sphere(),
        errors: character.errors(),
        mesh_fraction: shares.mesh,
        is_shown: true,
        drawables,
        draws,
        range: ObjectRange::default(),
        kind: Kind::Character(Box::new(character)),
    })
}

fn check(model: &Model, capacity: usize) -> Result<(), InputError> {
    if model.meshes.iter().all(|mesh| mesh.indices.is_empty()) {
        return Err(InputError::new("model.meshes", "none", "must have a triangle"));
    }
    if !(1..=1 << 20).contains(&capacity) {
        return Err(InputError::new("capacity", capacity, "must be in 1..=1048576"));
    }
    Ok(())
}

/// The errors of all levels, the mesh itself included.
pub(super) fn errors(merged: &Merged) -> Vec<f32> {
    std::iter::once(0.0).chain(merged.errors.iter().copied()).collect()
}

/// The draws of the parts of a merged mesh: for each part and level two, for instances that are not mirrored and for those
/// that are.
pub(super) fn part_draws(merged: &Merged, mesh: usize, buffers: &MeshBuffers) -> Vec<SceneDraw> {
    let of_part = |part: &Part| {
        let draw = |list: u32| {
            let level = list / 2;
            let Some(range) = part.indices.get(level as usize) else { return NOTHING };
            let first_index = buffers.level(level).first_index + range.start;
            SceneDraw { indices: range.len() as u32, first_index, ..NOTHING }
        };
        (0..OBJECT_LISTS).map(draw).collect::<Vec<_>>()
    };
    merged.parts.iter().filter(|part| part.mesh == mesh).flat_map(of_part).collect()
}

/// A draw of nothing.
pub(super) const NOTHING: SceneDraw =
    SceneDraw { indices: 0, instances: 0, first_index: 0, base_vertex: 0, first_instance: 0 };

/// A merged mesh, to be drawn from its own `vertices` or from those of each instance.
pub(super) fn drawable(
    gpu: &Gpu,
    merged: &Merged,
    index: usize,
    (buffers, clusters): (&MeshBuffers, &Clusters),
    vertices: Buffer<Vertex>,
    is_skinned: bool,
) -> Result<Drawable, Error> {
    let mesh = &merged.model.meshes[index];
    let own: Vec<&Part> = merged.parts.iter().filter(|part| part.mesh == index).collect();
    let part_of = parts_of_vertices(mesh, &own);
    let mut tables: Vec<Vec<Option<usize>>> = vec![Vec::new(); own.len()];
    let entries: Vec<u32> = (part_of.iter().zip(&merged.materials[index]))
        .map(|(part, material)| entry(&mut tables[*part], *material))
        .collect();
    let placed: Vec<u32> = clusters.order.iter().map(|vertex| entries[*vertex as usize]).collect();
    let parts = (own.iter().zip(&tables))
        .map(|(part, table)| {
            let surface =
                SurfaceKind { cut_out: part.key.cut_out, double_sided: part.key.double_sided };
            Ok(MeshPart { surface, materials: PartMaterials::new(gpu, &merged.model, table)? })
        })
        .collect::<Result<_, Error>>()?;
    let params = MeshParams { first_instance: 0, stride: if is_skinned { mesh.vertices() as u32 } else { 0 } };
    Ok(Drawable::Mesh(MeshDrawable {
        params: Uniform::new(gpu, "mesh", &params)?,
        stride: params.stride,
        vertices,
        uv: buffers.uv.clone(),
        material_of: Buffer::from_slice(gpu, "materials of vertices", &placed)?,
        indices: buffers.indices.clone(),
        parts,
    }))
}

/// For each vertex, the part whose triangles use it.
fn parts_of_vertices(mesh: &Mesh, parts: &[&Part]) -> Vec<usize> {
    let mut part_of = vec![0; mesh.vertices()];
    for (at, part) in parts.iter().enumerate() {
        let range = part.indices[0].clone();
        for vertex in &mesh.indices[range.start as usize..range.end as usize] {
            part_of[*vertex as usize] = at;
        }
    }
    part_of
}

/// The index of a material in a table, which it joins if it is not there.
fn entry(table: &mut Vec<Option<usize>>, material: Option<usize>) -> u32 {
    let known = table.iter().position(|other| *other == material);
    known.unwrap_or_else(|| {
        table.push(material);
        table.len() - 1
    }) as u32
}
