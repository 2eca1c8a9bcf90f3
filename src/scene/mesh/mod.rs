//! Meshes of objects on the device: static meshes, and meshes of characters, which bones move.

mod at_rest;
mod drawable;

use crate::asset::{Mesh, Model};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::drawable::{Drawable, NO_OBJECT};
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{Looks, PartMaterials};
use crate::scene::pieces::{Most, indices_of_levels, pieces};
use crate::shared::lod::object::{OBJECT_LEVELS, SceneDraw};
use crate::shared::render::scene_vertex::{MeshParams, partner_word};
use crate::skinning::at_rest::at_rest;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::buffers::MeshBuffers;
use crate::skinning::clusters::Clusters;
use crate::skinning::merged::{Merged, Part, PartKey, merged};
use crate::skinning::own_levels;
use crate::skinning::pages::PageBuffers;
use crate::skinning::vertex::Vertex;
use crate::{Error, InputError};
pub(super) use at_rest::MeshAtRest;
pub(crate) use drawable::{Faces, MeshDrawable, MeshGeometry, MeshMaterials, MeshPart};

/// Drawables of an object, and its draws: [`OBJECT_LEVELS`] for each part.
pub(super) type Drawn = (Vec<Box<dyn Drawable>>, Vec<SceneDraw>);

/// The merged meshes of a model in the rest pose, and a sphere around their vertices.
pub fn at_rest_merged(model: &Model) -> Result<(Merged, BoundingSphere), InputError> {
    check(model)?;
    let mut rest = at_rest(model).map_err(|error| error.below("model"))?;
    if model.clips.is_empty() {
        // The levels of a model without clips were made for the rest pose, and vertices keep their order. So the
        // levels stay valid.
        for (mesh, from) in rest.meshes.iter_mut().zip(&model.meshes) {
            mesh.levels.clone_from(&from.levels);
            mesh.partners.clone_from(&from.partners);
        }
    }
    let merged = merged(&rest, OBJECT_LEVELS as usize)?;
    let corners = merged.model.meshes.iter().flat_map(|mesh| &mesh.positions);
    let sphere = BoundingSphere::around(corners.map(|position| (*position).into()));
    Ok((merged, sphere))
}

/// The merged meshes of a model with clips.
pub fn moving_merged(model: &Model) -> Result<Merged, InputError> {
    check(model)?;
    let mut merged = merged(model, OBJECT_LEVELS as usize)?;
    // The merged vertices move like those of the model.
    let motion = model.motion.clone().filter(|motion| motion.fit(model));
    merged.model.motion = motion.map(|motion| motion.with_model(&merged.model));
    Ok(merged)
}

/// Uploads meshes whose vertices are the same for all instances. A mesh that exceeds a binding of the device is split
/// into pieces.
pub(super) fn drawn(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    merged: &Merged,
    looks: &Looks,
) -> Result<Drawn, Error> {
    let (mut drawables, mut draws): Drawn = (Vec::new(), Vec::new());
    let mut upload = |merged: &Merged, index: usize| -> Result<(), Error> {
        let (buffers, clusters) = MeshBuffers::new(gpu, &merged.model, &merged.model.meshes[index])?;
        draws.extend(part_draws(merged, index, &buffers));
        let of = MergedMesh { merged, looks, index };
        let drawn = drawable(gpu, layouts, &of, &buffers, &clusters, None)?;
        drawables.push(Box::new(drawn));
        Ok(())
    };
    let most = |bytes: usize| (gpu.max_binding() / bytes as u64) as usize;
    let most = Most { vertices: most(size_of::<Vertex>()), indices: most(size_of::<u32>()) };
    for (index, mesh) in merged.model.meshes.iter().enumerate() {
        if most.holds(mesh) {
            upload(merged, index)?;
        } else {
            let pieces = pieces(merged, index, most);
            (0..pieces.model.meshes.len()).try_for_each(|piece| upload(&pieces, piece))?;
        }
    }
    Ok((drawables, draws))
}

/// Checks that the vertices of a merged mesh fit one binding of the device, and that its indices fit another.
pub(super) fn check_binding(gpu: &Gpu, mesh: &Mesh) -> Result<(), InputError> {
    let indices = indices_of_levels(mesh);
    let all = [
        ("model.meshes.positions.len", mesh.vertices(), size_of::<Vertex>()),
        ("model.meshes.indices.len", indices, size_of::<u32>()),
    ];
    all.into_iter().try_for_each(|(path, count, bytes)| within_binding(gpu, path, count, bytes))
}

/// Checks that `count` elements, of `bytes` bytes each, together fit one binding of the device. `path` names the count in errors.
pub(super) fn within_binding(gpu: &Gpu, path: &str, count: usize, bytes: usize) -> Result<(), InputError> {
    let most = gpu.max_binding() / bytes as u64;
    if count as u64 <= most {
        return Ok(());
    }
    let bound = format!("must be at most {most}, which one binding of the device holds: add several objects");
    Err(InputError::new(path, count, bound))
}

/// Checks that a model has triangles, and that each mesh is valid with its skin and material.
///
/// # Errors
/// [`InputError`] with the index of the mesh or the skin (`model.meshes[2].indices[1]`).
fn check(model: &Model) -> Result<(), InputError> {
    for mesh in 0..model.meshes.len() {
        model
            .check_mesh(mesh)
            .and_then(|()| model.check_material(mesh))
            .map_err(|error| error.below("model"))?;
    }
    if model.meshes.iter().all(|mesh| mesh.indices.is_empty()) {
        return Err(InputError::new("model.meshes", "none", "must have a triangle"));
    }
    Ok(())
}

/// The error of the finest level in model units.
pub(super) fn finest_error(merged: &Merged) -> f32 {
    merged.model.meshes.iter().map(|mesh| mesh.error).fold(0.0, f32::max)
}

/// The error of each level of detail in model units, ascending. The first is 0: views always allow the full mesh.
pub(super) fn errors(merged: &Merged) -> Vec<f32> {
    std::iter::once(0.0).chain(merged.errors.iter().copied()).collect()
}

/// The draws of all parts of a merged mesh, [`OBJECT_LEVELS`] for each part. Levels that do not exist have empty draws.
pub(super) fn part_draws(merged: &Merged, mesh: usize, buffers: &MeshBuffers) -> Vec<SceneDraw> {
    let of_part = |part: &Part| {
        let draw = |level: u32| {
            let Some(range) = part.indices.get(level as usize) else { return NOTHING };
            let first_index = buffers.level(level).first_index + range.start;
            SceneDraw { index_count: range.len() as u32, first_index, ..NOTHING }
        };
        (0..OBJECT_LEVELS).map(draw).collect::<Vec<_>>()
    };
    merged.parts.iter().filter(|part| part.mesh == mesh).flat_map(of_part).collect()
}

/// A draw without triangles.
pub(super) const NOTHING: SceneDraw =
    SceneDraw { index_count: 0, instance_count: 0, first_index: 0, base_vertex: 0, first_instance: 0 };

/// A mesh of merged meshes, with the object's materials.
#[derive(Debug, Clone, Copy)]
pub(super) struct MergedMesh<'a> {
    pub merged: &'a Merged,
    pub looks: &'a Looks,
    pub index: usize,
}

/// The drawable of a merged mesh. With `pages`, its vertices are in these pages; otherwise they are in `buffers`.
pub(super) fn drawable(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    of: &MergedMesh<'_>,
    buffers: &MeshBuffers,
    clusters: &Clusters,
    pages: Option<&PageBuffers>,
) -> Result<MeshDrawable, Error> {
    let MergedMesh { merged, looks, index } = *of;
    let mesh = &merged.model.meshes[index];
    let own: Vec<&Part> = merged.parts.iter().filter(|part| part.mesh == index).collect();
    let part_of = parts_of_vertices(mesh, &merged.errors, &own);
    let mut tables: Vec<Vec<Option<usize>>> = vec![Vec::new(); own.len()];
    let entries: Vec<u32> = (part_of.iter().zip(&merged.materials[index]))
        .map(|(part, material)| entry(&mut tables[*part], *material))
        .collect();
    let mut placed: Vec<u32> = clusters.order.iter().map(|vertex| entries[*vertex as usize]).collect();
    let words = partner_words(mesh, &merged.errors, clusters);
    let partners = if words.is_empty() { 0 } else { placed.len() as u32 };
    placed.extend(words);
    let parts = (own.iter().zip(&tables))
        .map(|(part, table)| {
            let PartKey { blended, double_sided, sampling, normal_sampling, .. } = part.key;
            let samplings = [sampling, normal_sampling].map(Option::unwrap_or_default);
            let materials = PartMaterials::new(gpu, layouts, looks, table, samplings)?;
            Ok(MeshPart::new(Faces { blended, double_sided }, MeshMaterials::Plain(materials)))
        })
        .collect::<Result<_, Error>>()?;
    let count = if pages.is_some() { buffers.clusters() as u32 } else { 0 };
    let material_of = Buffer::constant(gpu, "materials of vertices", &placed)?;
    let geometry = MeshGeometry {
        object: Uniform::new(gpu, "object", &NO_OBJECT)?,
        params: Uniform::new(gpu, "mesh", &MeshParams { clusters: count, last: 0, partners })?,
        vertices: pages.map_or(&buffers.vertices, |pages| &pages.skinned).clone(),
        last: pages.map_or(0, |pages| pages.last),
        page_table: pages.map_or(&material_of, |pages| &pages.table).clone(),
        uv: buffers.uv.clone(),
        material_of,
        partners,
        indices: buffers.indices.clone(),
    };
    Ok(MeshDrawable::new(gpu, layouts, geometry, count, parts)?)
}

/// A word for each vertex, in the order of `clusters`: the index of the vertex's partner in that order, and the
/// coarsest level of the object that contains the vertex. Empty if the mesh has no levels or no partners.
fn partner_words(mesh: &Mesh, errors: &[f32], clusters: &Clusters) -> Vec<u32> {
    if mesh.levels.is_empty() || mesh.partners.is_empty() {
        return Vec::new();
    }
    let (coarsest, slots) = (coarsest_levels(mesh, errors), clusters.slots());
    let word = |vertex: &u32| {
        let vertex = *vertex as usize;
        partner_word(slots[mesh.partners[vertex] as usize], coarsest[vertex])
    };
    clusters.order.iter().map(word).collect()
}

/// For each vertex of a merged mesh, the coarsest level of the object that contains the vertex. `errors` are the errors
/// of the object's levels.
pub fn coarsest_levels(mesh: &Mesh, errors: &[f32]) -> Vec<u32> {
    let own = own_levels(mesh, errors);
    let of_object = |coarsest: u32| own.iter().rposition(|level| *level <= coarsest).unwrap_or(0) as u32;
    mesh.coarsest_levels().into_iter().map(of_object).collect()
}

/// For each vertex, the index of the part whose triangles use the vertex at any level. `errors` are the errors of the
/// object's levels.
fn parts_of_vertices(mesh: &Mesh, errors: &[f32], parts: &[&Part]) -> Vec<usize> {
    let own = own_levels(mesh, errors);
    let mut part_of = vec![0; mesh.vertices()];
    for (at, part) in parts.iter().enumerate() {
        for (level, range) in own.iter().zip(&part.indices) {
            for vertex in &mesh.triangles(*level)[range.start as usize..range.end as usize] {
                part_of[*vertex as usize] = at;
            }
        }
    }
    part_of
}

/// The index of a material in a table. A new material is appended.
fn entry(table: &mut Vec<Option<usize>>, material: Option<usize>) -> u32 {
    let known = table.iter().position(|other| *other == material);
    known.unwrap_or_else(|| {
        table.push(material);
        table.len() - 1
    }) as u32
}
