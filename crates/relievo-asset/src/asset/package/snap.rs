//! Quantization: attributes move to grids on which they take few bytes.

use std::collections::HashMap;

use super::attributes::WEIGHTS;
use super::grid::{Grid, angle_of, normal_of, octahedral, tangent_of};
use crate::InputError;
use crate::asset::morph::MorphDelta;
use crate::asset::{Influence, Influences, Mesh, Model, MorphTarget};

/// Positions have a step between 2⁻¹⁵ and 2⁻¹⁶ of the extent of all meshes with the same skin.
const POSITION_BITS: i32 = 15;

/// Texture coordinates have a step of 2⁻¹⁴, unless they are very large.
const UV_BITS: i32 = 14;

/// Colours of vertices have a step of 2⁻¹⁰, unless they are very large.
const COLOR_BITS: i32 = 10;

/// Normals and tangents of morph targets have a step of 2⁻¹⁰.
const DIRECTIONS: Grid = Grid::Step(-10);

/// A model without levels of detail whose attributes lie on grids. Vertices and triangles keep their order.
///
/// # Errors
/// [`InputError`] for weights that do not sum to 1.
#[doc(hidden)]
pub fn snapped(model: &Model) -> Result<Model, InputError> {
    let mut snapped = model.clone();
    for mesh in &mut snapped.meshes {
        // Meshes that share a border must keep it closed, so all meshes of a skin have the same step.
        let alike = model.meshes.iter().filter(|other| other.skin == mesh.skin);
        let positions = || alike.clone().flat_map(|other| &other.positions);
        let mut extent = 0.0_f32;
        for axis in 0..3 {
            let values = || positions().map(|position| position[axis]);
            extent = extent.max(values().fold(f32::MIN, f32::max) - values().fold(f32::MAX, f32::min));
        }
        let largest = |values: &mut dyn Iterator<Item = f32>| {
            values.fold(0.0, |most: f32, value| most.max(value.abs()))
        };
        let grid = Grid::fitting(extent, largest(&mut positions().flatten().copied()), POSITION_BITS);
        mesh.positions.as_flattened_mut().iter_mut().for_each(|value| *value = grid.snapped(*value));
        let uv = Grid::fitting(1.0, largest(&mut mesh.uv.as_flattened().iter().copied()), UV_BITS);
        mesh.uv.as_flattened_mut().iter_mut().for_each(|value| *value = uv.snapped(*value));
        let second = Grid::fitting(1.0, largest(&mut mesh.second_uv.as_flattened().iter().copied()), UV_BITS);
        mesh.second_uv.as_flattened_mut().iter_mut().for_each(|value| *value = second.snapped(*value));
        let colors = Grid::fitting(1.0, largest(&mut mesh.colors.as_flattened().iter().copied()), COLOR_BITS);
        mesh.colors.as_flattened_mut().iter_mut().for_each(|value| *value = colors.snapped(*value));
        for (normal, tangent) in mesh.normals.iter_mut().zip(&mut mesh.tangents) {
            // A normal of 0 has no direction.
            if *normal != [0.0; 3] {
                *normal = normal_of(octahedral(*normal));
                *tangent = tangent_of(*normal, angle_of(*normal, *tangent), 1.0_f32.copysign(tangent[3]));
            }
        }
        let influences = (0..mesh.vertices()).map(|vertex| weights(mesh.influences.of(vertex)));
        mesh.influences = Influences::stored("mesh.influences", influences)?;
        for delta in mesh.targets.iter_mut().flat_map(|target| &mut target.deltas) {
            delta.position = delta.position.map(|value| grid.snapped(value));
            delta.normal = delta.normal.map(|value| DIRECTIONS.snapped(value));
            delta.tangent = delta.tangent.map(|value| DIRECTIONS.snapped(value));
        }
    }
    Ok(snapped)
}

/// Influences whose weights lie on the grid and sum to 1 exactly, the strongest first.
fn weights(influences: &[Influence]) -> Vec<Influence> {
    let mut own: Vec<(u32, i32)> =
        influences.iter().map(|one| (one.bone, WEIGHTS.whole(one.weight))).collect();
    let sum: i32 = own.iter().map(|(_, weight)| weight).sum();
    if let Some((_, strongest)) = own.first_mut() {
        *strongest += WEIGHTS.whole(1.0) - sum;
    }
    own.retain(|(_, weight)| *weight > 0);
    own.sort_by_key(|(_, weight)| std::cmp::Reverse(*weight));
    own.into_iter().map(|(bone, weight)| Influence { bone, weight: WEIGHTS.float(weight) }).collect()
}

/// A model without levels of detail in which equal vertices are one, and without vertices and triangles that show nothing:
/// vertices that no triangle uses, and triangles with two corners that have the same position in every pose.
///
/// # Errors
/// [`InputError`] for influences that no vertex can have.
#[doc(hidden)]
pub fn welded(model: &Model) -> Result<Model, InputError> {
    let mut welded = model.clone();
    for mesh in &mut welded.meshes {
        *mesh = welded_mesh(mesh)?;
    }
    Ok(welded)
}

fn welded_mesh(mesh: &Mesh) -> Result<Mesh, InputError> {
    let points = super::write::source(mesh).point_of;
    let mut deltas: Vec<Vec<u32>> = vec![Vec::new(); mesh.vertices()];
    for (at, target) in (0..).zip(&mesh.targets) {
        for (vertex, MorphDelta { normal, tangent, .. }) in target.vertices.iter().zip(&target.deltas) {
            let own = &mut deltas[*vertex as usize];
            own.push(at);
            own.extend([*normal, *tangent].as_flattened().iter().map(|value| value.to_bits()));
        }
    }
    let mut known: HashMap<Vec<u32>, u32> = HashMap::new();
    let mut order: Vec<u32> = Vec::new();
    let mut indices = Vec::with_capacity(mesh.indices.len());
    for triangle in mesh.indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|vertex| points[vertex as usize]);
        if a == b || b == c || c == a {
            continue;
        }
        for vertex in triangle {
            let at = *vertex as usize;
            let mut key = vec![points[at]];
            let (normal, tangent) = (mesh.normals[at].iter(), mesh.tangents[at].iter());
            let second = mesh.second_uv.get(at).into_iter().flatten();
            let others = second.chain(mesh.colors.get(at).into_iter().flatten());
            key.extend(normal.chain(tangent).chain(&mesh.uv[at]).chain(others).map(|value| value.to_bits()));
            key.extend(&deltas[at]);
            indices.push(*known.entry(key).or_insert_with(|| {
                order.push(*vertex);
                order.len() as u32 - 1
            }));
        }
    }
    let mut place = vec![None; mesh.vertices()];
    (0..).zip(&order).for_each(|(at, vertex)| place[*vertex as usize] = Some(at));
    let target = |target: &MorphTarget| {
        let all = target.vertices.iter().zip(&target.deltas);
        let mut all: Vec<(u32, MorphDelta)> =
            all.filter_map(|(vertex, delta)| Some((place[*vertex as usize]?, *delta))).collect();
        all.sort_by_key(|(vertex, _)| *vertex);
        let (vertices, deltas) = all.into_iter().unzip();
        MorphTarget { vertices, deltas }
    };
    let influences = order.iter().map(|vertex| mesh.influences.of(*vertex as usize).to_vec());
    Ok(Mesh {
        positions: taken(&mesh.positions, &order),
        normals: taken(&mesh.normals, &order),
        tangents: taken(&mesh.tangents, &order),
        uv: taken(&mesh.uv, &order),
        second_uv: taken(&mesh.second_uv, &order),
        colors: taken(&mesh.colors, &order),
        indices,
        influences: Influences::stored("mesh.influences", influences)?,
        targets: mesh.targets.iter().map(target).collect(),
        ..mesh.clone()
    })
}

/// The values of some vertices; none if there are no values.
fn taken<T: Copy>(values: &[T], order: &[u32]) -> Vec<T> {
    order.iter().filter_map(|vertex| values.get(*vertex as usize).copied()).collect()
}
