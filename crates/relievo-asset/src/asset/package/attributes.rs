//! The attributes of points and vertices. Each is predicted from neighbours that are coded before it, and the residual is coded.

use std::ops::Range;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::coder::{Coder, Frequencies, Numbers, damaged, scale};
use super::grid::{
    Across, Directions, Grid, TANGENT_BITS, WEIGHT_BITS, angle_of, near_octahedral, normal_of, octahedral,
    tangent_of,
};
use super::surface::{Added, NONE, Room, Surface};
use crate::InputError;
use crate::asset::influences::MAX_INFLUENCES;
use crate::asset::morph::MorphDelta;
use crate::asset::{Influence, Influences, Mesh, MorphTarget};

/// How the attributes of a mesh become whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Grids {
    pub positions: Grid,
    pub normals: Directions,
    pub tangents: Directions,
    pub uv: Grid,
    /// Second texture coordinates, if there are any.
    pub second_uv: Option<Grid>,
    /// Colours, if there are any.
    pub colors: Option<Grid>,
    /// [`WEIGHTS`], or the bits of the weights.
    pub weights: Grid,
    /// Positions, normals and tangents of morph targets.
    pub deltas: [Grid; 3],
}

/// The grid of weights that sum to 1 exactly.
pub(super) const WEIGHTS: Grid = Grid::Step(-(WEIGHT_BITS as i8));

/// The sum of all weights of a vertex, in steps of [`WEIGHTS`].
const ALL_WEIGHTS: i64 = 1 << WEIGHT_BITS;

impl Grids {
    /// The coarsest grids that have all values of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let has_normal = |normal: &[f32; 3]| bits(normal_of(octahedral(*normal))) == bits(*normal);
        let has_tangent = |(normal, tangent): (&[f32; 3], &[f32; 4])| {
            let sign = tangent[3];
            sign.abs() == 1.0
                && bits(tangent_of(*normal, angle_of(*normal, *tangent), sign)) == bits(*tangent)
        };
        let packed = |is_packed: bool| if is_packed { Directions::Packed } else { Directions::Bits };
        let normals = mesh.normals.iter().all(has_normal);
        let tangents = normals && mesh.normals.iter().zip(&mesh.tangents).all(has_tangent);
        let has_weights = |vertex: usize| {
            let influences = mesh.influences.of(vertex);
            let wholes = influences.iter().map(|influence| WEIGHTS.whole(influence.weight));
            wholes.clone().map(i64::from).sum::<i64>() == ALL_WEIGHTS
                && wholes.zip(influences).all(|(whole, influence)| WEIGHTS.float(whole) == influence.weight)
        };
        let weights = if (0..mesh.vertices()).all(has_weights) { WEIGHTS } else { Grid::Bits };
        let deltas = |part: fn(&MorphDelta) -> &[f32; 3]| {
            Grid::of(mesh.targets.iter().flat_map(|target| &target.deltas).flat_map(part))
        };
        Self {
            positions: Grid::of(mesh.positions.as_flattened().iter()),
            normals: packed(normals),
            tangents: packed(tangents),
            uv: Grid::of(mesh.uv.as_flattened().iter()),
            second_uv: some_grid(mesh.second_uv.as_flattened()),
            colors: some_grid(mesh.colors.as_flattened()),
            weights,
            deltas: [
                deltas(|delta| &delta.position),
                deltas(|delta| &delta.normal),
                deltas(|delta| &delta.tangent),
            ],
        }
    }
}

/// The coarsest grid that has all values, if there are values.
fn some_grid(values: &[f32]) -> Option<Grid> {
    (!values.is_empty()).then(|| Grid::of(values.iter()))
}

fn bits<const N: usize>(values: [f32; N]) -> [u32; N] {
    values.map(f32::to_bits)
}

/// Adaptive frequencies of all attributes, shared by all meshes and levels.
pub(super) struct AttributeContexts {
    positions: Vec<Numbers>,
    rule: Frequencies,
    normals: Vec<Numbers>,
    tangents: Vec<Numbers>,
    sign: Vec<Frequencies>,
    uv: Vec<Numbers>,
    second_uv: Vec<Numbers>,
    colors: Vec<Numbers>,
    are_copies: Frequencies,
    /// By the number of influences of the point that predicts.
    counts: Vec<Frequencies>,
    bones: Vec<Frequencies>,
    weights: Vec<Numbers>,
    is_moved: Vec<Frequencies>,
    deltas: Vec<Numbers>,
}

impl AttributeContexts {
    pub fn new() -> Self {
        let numbers = |count: usize| vec![Numbers::new(); count];
        let symbols = |count: usize, symbols: usize| vec![Frequencies::new(symbols); count];
        Self {
            positions: numbers(3 * SCALES),
            rule: Frequencies::new(2),
            normals: numbers(3 * SCALES),
            tangents: numbers(4),
            sign: symbols(3, 2),
            uv: numbers(2 * SCALES),
            second_uv: numbers(2 * SCALES),
            colors: numbers(4 * SCALES),
            are_copies: Frequencies::new(2),
            counts: symbols(MAX_INFLUENCES + 1, MAX_INFLUENCES),
            bones: symbols(MAX_INFLUENCES, MAX_INFLUENCES + 1),
            weights: numbers(2 * MAX_INFLUENCES),
            is_moved: symbols(2, 2),
            deltas: numbers(9),
        }
    }
}

/// Number of values of [`scale`].
const SCALES: usize = 8;

/// The attributes of one mesh at the levels that were coded so far.
pub(super) struct Attributes {
    pub grids: Grids,
    /// Number of bones of the mesh's skin.
    pub bones: usize,
    /// By point.
    positions: Vec<[i32; 3]>,
    /// By point: the end of its influences in `all`.
    ends: Vec<u32>,
    all: Vec<(u32, i32)>,
    /// By vertex.
    normals: Vec<[f32; 3]>,
    tangents: Vec<[f32; 4]>,
    uv: Vec<[i32; 2]>,
    second_uv: Vec<[i32; 2]>,
    colors: Vec<[i32; 4]>,
    /// By target: the vertices that it moves, ascending, and their deltas.
    targets: Vec<(Vec<u32>, Vec<[i32; 9]>)>,
}

/// A mesh to write, and the vertices of the source in the order of the code.
#[derive(Clone, Copy)]
pub(super) struct Written<'a> {
    pub mesh: &'a Mesh,
    /// For each coded point, a vertex of the source.
    pub points: &'a [u32],
    /// For each coded vertex, the vertex of the source.
    pub vertices: &'a [u32],
}

/// How normals are predicted.
#[derive(Clone, Copy, PartialEq, Eq)]
enum NormalRule {
    /// From the normals of neighbouring vertices.
    Neighbours = 0,
    /// From the vertex's own triangles.
    Triangles = 1,
}

impl Attributes {
    pub fn new(grids: Grids, bones: usize, targets: usize) -> Self {
        Self {
            grids,
            bones,
            positions: Vec::new(),
            ends: Vec::new(),
            all: Vec::new(),
            normals: Vec::new(),
            tangents: Vec::new(),
            uv: Vec::new(),
            second_uv: Vec::new(),
            colors: Vec::new(),
            targets: vec![(Vec::new(), Vec::new()); targets],
        }
    }

    /// Codes the attributes of the points and vertices that a level adds.
    ///
    /// # Errors
    /// When reading: [`InputError`] for bytes that no writer makes.
    pub fn level(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        room: &mut Room,
        surface: &Surface,
        added: &Added,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        let around = Around::new(&surface.triangles, &added.points, &added.edges);
        self.code_positions(coder, contexts, surface, &around, written)?;
        self.code_influences(coder, contexts, surface, &around, written)?;
        let around = Around::new(&surface.corners, &added.vertices, &added.edges);
        self.code_normals(coder, contexts, surface, &around, written)?;
        self.code_tangents(coder, contexts, surface, &around, written)?;
        code_values(coder, &mut contexts.uv, &around, &mut self.uv, |vertex| {
            wanted(written, vertex, self.grids.uv, |mesh| &mesh.uv)
        })?;
        if let Some(grid) = self.grids.second_uv {
            code_values(coder, &mut contexts.second_uv, &around, &mut self.second_uv, |vertex| {
                wanted(written, vertex, grid, |mesh| &mesh.second_uv)
            })?;
        }
        if let Some(grid) = self.grids.colors {
            code_values(coder, &mut contexts.colors, &around, &mut self.colors, |vertex| {
                wanted(written, vertex, grid, |mesh| &mesh.colors)
            })?;
        }
        self.code_targets(coder, contexts, room, surface, &around, written)
    }

    fn code_positions(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        surface: &Surface,
        around: &Around<'_>,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        let mut last = 0;
        for point in around.range.clone() {
            let near = match mean(&self.positions, around.known(point)) {
                Some(mean) => mean,
                None => {
                    let parent = surface.parents[point as usize] as usize;
                    self.positions
                        .get(parent)
                        .or(self.positions.last())
                        .map_or([0; 3], |near| near.map(i64::from))
                }
            };
            let wanted = written.map_or([0; 3], |written| {
                let vertex = written.points[point as usize] as usize;
                written.mesh.positions[vertex].map(|value| self.grids.positions.whole(value))
            });
            self.positions.push(residuals(coder, &mut contexts.positions, &mut last, near, wanted)?);
        }
        Ok(())
    }

    fn code_influences(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        surface: &Surface,
        around: &Around<'_>,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        let near_of = |point: u32| match surface.parents[point as usize] {
            NONE => around.known(point).next().or(point.checked_sub(1)),
            parent => Some(parent),
        };
        let wanted_of = |grids: &Grids, point: u32| -> Vec<(u32, i32)> {
            written.map_or_else(Vec::new, |written| {
                let own = written.mesh.influences.of(written.points[point as usize] as usize);
                own.iter().map(|one| (one.bone, grids.weights.whole(one.weight))).collect()
            })
        };
        let is_copy = |point: u32| {
            near_of(point).is_some_and(|near| wanted_of(&self.grids, near) == wanted_of(&self.grids, point))
        };
        let are_copies = written.is_some() && around.range.clone().all(is_copy);
        if coder.symbol(&mut contexts.are_copies, usize::from(are_copies))? == 1 {
            for point in around.range.clone() {
                let near = near_of(point).ok_or_else(damaged)?;
                self.all.extend_from_within(self.influence_range(near));
                self.ends.push(self.all.len() as u32);
            }
            return Ok(());
        }
        for point in around.range.clone() {
            let near = near_of(point).map_or(0..0, |near| self.influence_range(near));
            let wanted = wanted_of(&self.grids, point);
            let context = &mut contexts.counts[near.len()];
            let count = 1 + coder.symbol(context, wanted.len().saturating_sub(1))?;
            let mut left = ALL_WEIGHTS;
            for at in 0..count {
                let (bone, weight) = wanted.get(at).copied().unwrap_or_default();
                let known = &self.all[near.clone()];
                let place = known.iter().position(|(other, _)| *other == bone).unwrap_or(MAX_INFLUENCES);
                let place = coder.symbol(&mut contexts.bones[at], place)?;
                let (bone, likely) = match known.get(place) {
                    Some(known) => *known,
                    None if place < MAX_INFLUENCES => return Err(damaged()),
                    None => {
                        (coder.below(self.bones, bone as usize)? as u32, (left / (count - at) as i64) as i32)
                    }
                };
                let is_last = at + 1 == count;
                let weight = match self.grids.weights {
                    WEIGHTS if is_last => left,
                    _ => {
                        let context = at + MAX_INFLUENCES * usize::from(place < MAX_INFLUENCES);
                        let context = &mut contexts.weights[context];
                        i64::from(likely) + context.code(coder, i64::from(weight) - i64::from(likely))?
                    }
                };
                left = left.saturating_sub(weight);
                self.all.push((bone, i32::try_from(weight).map_err(|_| damaged())?));
            }
            self.ends.push(self.all.len() as u32);
        }
        Ok(())
    }

    /// The place of a point's influences in `all`.
    fn influence_range(&self, point: u32) -> Range<usize> {
        let start = point.checked_sub(1).map_or(0, |before| self.ends[before as usize]);
        start as usize..self.ends[point as usize] as usize
    }

    fn code_normals(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        surface: &Surface,
        around: &Around<'_>,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        if around.range.is_empty() {
            return Ok(());
        }
        let wanted = |grids: &Grids, vertex: u32| {
            written.map_or([0; 3], |written| {
                let normal = written.mesh.normals[written.vertices[vertex as usize] as usize];
                match grids.normals {
                    Directions::Packed => {
                        let [u, v] = octahedral(normal);
                        [u, v, 0]
                    }
                    Directions::Bits => normal.map(|part| Grid::Bits.whole(part)),
                }
            })
        };
        let mut rule = NormalRule::Neighbours;
        if written.is_some() {
            // The rule with the smaller residuals. Here, all normals before a vertex are those of the source.
            let costs = [NormalRule::Neighbours, NormalRule::Triangles].map(|rule| {
                let before = self.normals.len();
                let cost = around.range.clone().map(|vertex| {
                    let (near, wanted) =
                        (self.likely_normal(rule, surface, around, vertex), wanted(&self.grids, vertex));
                    self.normals.push(self.normal(wanted));
                    near.iter()
                        .zip(wanted)
                        .map(|(near, wanted)| (i64::from(wanted) - near).unsigned_abs().min(64))
                        .sum::<u64>()
                });
                let cost: u64 = cost.collect::<Vec<_>>().into_iter().sum();
                self.normals.truncate(before);
                cost
            });
            if costs[1] < costs[0] {
                rule = NormalRule::Triangles;
            }
        }
        if coder.symbol(&mut contexts.rule, rule as usize)? == 1 {
            rule = NormalRule::Triangles;
        }
        let mut last = 0;
        for vertex in around.range.clone() {
            let near = self.likely_normal(rule, surface, around, vertex);
            let wanted = wanted(&self.grids, vertex);
            let normal = match self.grids.normals {
                Directions::Packed => {
                    let ([u, v, _], [near_u, near_v, _]) = (wanted, near);
                    let [u, v] =
                        residuals(coder, &mut contexts.normals, &mut last, [near_u, near_v], [u, v])?;
                    [u, v, 0]
                }
                Directions::Bits => residuals(coder, &mut contexts.normals, &mut last, near, wanted)?,
            };
            self.normals.push(self.normal(normal));
        }
        Ok(())
    }

    /// The normal of a vertex, predicted by a rule.
    fn likely_normal(
        &self,
        rule: NormalRule,
        surface: &Surface,
        around: &Around<'_>,
        vertex: u32,
    ) -> [i64; 3] {
        let mut sum = DVec3::ZERO;
        match rule {
            NormalRule::Neighbours => {
                for near in around.known(vertex) {
                    sum += DVec3::from(self.normals[near as usize].map(f64::from));
                }
            }
            NormalRule::Triangles => {
                for edge in around.edges(vertex) {
                    let [a, b, c] = surface.triangles[*edge as usize / 3].map(|point| {
                        let position =
                            self.positions[point as usize].map(|part| self.grids.positions.float(part));
                        DVec3::from(position.map(f64::from))
                    });
                    sum += (b - a).cross(c - a);
                }
            }
        }
        match self.grids.normals {
            Directions::Packed => {
                let [u, v] = near_octahedral(sum).map(i64::from);
                [u, v, 0]
            }
            Directions::Bits => {
                let sum = sum.to_array().map(|part| part as f32);
                let length = DVec3::from(sum.map(f64::from)).length();
                sum.map(|part| i64::from(Grid::Bits.whole((f64::from(part) / length.max(1e-30)) as f32)))
            }
        }
    }

    /// The normal of whole numbers.
    fn normal(&self, whole: [i32; 3]) -> [f32; 3] {
        match self.grids.normals {
            Directions::Packed => normal_of([whole[0], whole[1]]),
            Directions::Bits => whole.map(|part| Grid::Bits.float(part)),
        }
    }

    fn code_tangents(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        surface: &Surface,
        around: &Around<'_>,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        const TURN: i64 = 1 << TANGENT_BITS;
        for vertex in around.range.clone() {
            let partner = Some(surface.partners[vertex as usize]).filter(|partner| *partner < vertex);
            let near = around.known(vertex).next().or(partner);
            let wanted = written.map_or([0.0; 4], |written| {
                written.mesh.tangents[written.vertices[vertex as usize] as usize]
            });
            let tangent = match self.grids.tangents {
                Directions::Packed => {
                    let across = Across::new(self.normals[vertex as usize]);
                    let near = near.map(|near| self.tangents[near as usize]);
                    let likely = near.map_or(0, |near| across.angle(near));
                    let context = near.map_or(2, |near| usize::from(near[3] < 0.0));
                    let sign = coder.symbol(&mut contexts.sign[context], usize::from(wanted[3] < 0.0))?;
                    let wanted = written.map_or(likely, |_| across.angle(wanted));
                    let turn = i64::from(wanted - likely);
                    let turn = (turn + TURN / 2).rem_euclid(TURN) - TURN / 2;
                    let turn = contexts.tangents[0].code(coder, turn)?;
                    let angle = (i64::from(likely) + turn).rem_euclid(TURN) as i32;
                    across.tangent(angle, if sign == 1 { -1.0 } else { 1.0 })
                }
                Directions::Bits => {
                    let near = near.map_or([0.0; 4], |near| self.tangents[near as usize]);
                    let mut tangent = [0.0; 4];
                    for part in 0..4 {
                        let [near, wanted] =
                            [near[part], wanted[part]].map(|value| i64::from(Grid::Bits.whole(value)));
                        let whole = near + contexts.tangents[part].code(coder, wanted - near)?;
                        tangent[part] = Grid::Bits.float(i32::try_from(whole).map_err(|_| damaged())?);
                    }
                    tangent
                }
            };
            self.tangents.push(tangent);
        }
        Ok(())
    }

    fn code_targets(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut AttributeContexts,
        room: &mut Room,
        surface: &Surface,
        around: &Around<'_>,
        written: Option<Written<'_>>,
    ) -> Result<(), InputError> {
        Room::take(&mut room.tests, self.targets.len().saturating_mul(around.range.len()))?;
        for (at, (moved, deltas)) in self.targets.iter_mut().enumerate() {
            let target = written.map(|written| &written.mesh.targets[at]);
            for vertex in around.range.clone() {
                let near = around.known(vertex).next();
                let near =
                    near.or(Some(surface.partners[vertex as usize]).filter(|partner| *partner < vertex));
                let near = near.and_then(|near| moved.binary_search(&near).ok());
                let own = written.zip(target).and_then(|(written, target)| {
                    let found = target.vertices.binary_search(&written.vertices[vertex as usize]).ok()?;
                    Some(&target.deltas[found])
                });
                let context = &mut contexts.is_moved[usize::from(near.is_some())];
                if coder.symbol(context, usize::from(own.is_some()))? == 0 {
                    continue;
                }
                Room::take(&mut room.moves, 1)?;
                let near = near.map_or([0; 9], |near| deltas[near]);
                let own = own.copied().unwrap_or_default();
                let own = [own.position, own.normal, own.tangent];
                let mut delta = [0; 9];
                for part in 0..9 {
                    let wanted = self.grids.deltas[part / 3].whole(own[part / 3][part % 3]);
                    let residual = i64::from(wanted) - i64::from(near[part]);
                    let whole = i64::from(near[part]) + contexts.deltas[part].code(coder, residual)?;
                    delta[part] = i32::try_from(whole).map_err(|_| damaged())?;
                }
                moved.push(vertex);
                deltas.push(delta);
            }
        }
        Ok(())
    }

    /// Sets the attributes of all vertices in a mesh.
    ///
    /// # Errors
    /// [`InputError`] for influences that no vertex can have.
    pub fn set(&self, surface: &Surface, mesh: &mut Mesh) -> Result<(), InputError> {
        let points = || surface.point_of.iter().map(|point| *point as usize);
        mesh.positions = points()
            .map(|point| self.positions[point].map(|part| self.grids.positions.float(part)))
            .collect();
        mesh.normals.clone_from(&self.normals);
        mesh.tangents.clone_from(&self.tangents);
        mesh.uv = self.uv.iter().map(|uv| uv.map(|part| self.grids.uv.float(part))).collect();
        if let Some(grid) = self.grids.second_uv {
            mesh.second_uv = self.second_uv.iter().map(|uv| uv.map(|part| grid.float(part))).collect();
        }
        if let Some(grid) = self.grids.colors {
            mesh.colors = self.colors.iter().map(|color| color.map(|part| grid.float(part))).collect();
        }
        let influence = |(bone, weight): &(u32, i32)| Influence {
            bone: *bone,
            weight: self.grids.weights.float(*weight),
        };
        mesh.influences = Influences::default();
        for point in &surface.point_of {
            let own = self.all[self.influence_range(*point)].iter();
            mesh.influences.restore("mesh.influences", own.map(influence))?;
        }
        let delta = |parts: &[i32; 9]| {
            let part = |group: usize| {
                std::array::from_fn(|axis| self.grids.deltas[group].float(parts[3 * group + axis]))
            };
            MorphDelta { position: part(0), normal: part(1), tangent: part(2) }
        };
        let target = |(vertices, deltas): &(Vec<u32>, Vec<[i32; 9]>)| MorphTarget {
            vertices: vertices.clone(),
            deltas: deltas.iter().map(delta).collect(),
        };
        mesh.targets = self.targets.iter().map(target).collect();
        Ok(())
    }
}

/// The triangles around new elements: points or vertices.
struct Around<'a> {
    range: Range<u32>,
    triangles: &'a [[u32; 3]],
    /// For each new element, the start of its edges in `edges`.
    starts: Vec<u32>,
    edges: Vec<u32>,
}

impl<'a> Around<'a> {
    /// `edges` has all edges that start at new elements.
    fn new(triangles: &'a [[u32; 3]], range: &Range<u32>, edges: &[u32]) -> Self {
        let mut starts = vec![0; range.len() + 1];
        let own = |edge: &u32| {
            let element = triangles[*edge as usize / 3][*edge as usize % 3];
            element.checked_sub(range.start).map(|own| own as usize)
        };
        edges.iter().filter_map(own).for_each(|own| starts[own] += 1);
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        let mut sorted = vec![0; end as usize];
        for edge in edges.iter().rev() {
            if let Some(own) = own(edge) {
                starts[own] -= 1;
                sorted[starts[own] as usize] = *edge;
            }
        }
        Self { range: range.clone(), triangles, starts, edges: sorted }
    }

    /// The edges that start at a new element.
    fn edges(&self, element: u32) -> &[u32] {
        let own = (element - self.range.start) as usize;
        &self.edges[self.starts[own] as usize..self.starts[own + 1] as usize]
    }

    /// The neighbours that are coded before a new element, once for each triangle.
    fn known(&self, element: u32) -> impl Iterator<Item = u32> {
        let others = self.edges(element).iter().flat_map(|edge| {
            let triangle = self.triangles[*edge as usize / 3];
            let corner = *edge as usize % 3;
            [triangle[(corner + 1) % 3], triangle[(corner + 2) % 3]]
        });
        others.filter(move |other| *other < element)
    }
}

/// The mean of some values, or `None` for none.
fn mean<const N: usize>(values: &[[i32; N]], of: impl Iterator<Item = u32>) -> Option<[i64; N]> {
    let (mut sum, mut count) = ([0_i64; N], 0_i64);
    for at in of {
        count += 1;
        for part in 0..N {
            sum[part] += i64::from(values[at as usize][part]);
        }
    }
    (count > 0).then(|| sum.map(|sum| (2 * sum + count).div_euclid(2 * count)))
}

/// The whole numbers of a value of a vertex to write; 0 when reading.
fn wanted<const N: usize>(
    written: Option<Written<'_>>,
    vertex: u32,
    grid: Grid,
    values: impl Fn(&Mesh) -> &[[f32; N]],
) -> [i32; N] {
    written.map_or([0; N], |written| {
        values(written.mesh)[written.vertices[vertex as usize] as usize].map(|part| grid.whole(part))
    })
}

/// Codes a value for each new vertex, predicted by the mean of its neighbours.
fn code_values<const N: usize>(
    coder: &mut impl Coder,
    contexts: &mut [Numbers],
    around: &Around<'_>,
    values: &mut Vec<[i32; N]>,
    wanted: impl Fn(u32) -> [i32; N],
) -> Result<(), InputError> {
    let mut last = 0;
    for vertex in around.range.clone() {
        let near = mean(values, around.known(vertex));
        let near = near.or(values.last().map(|near| near.map(i64::from))).unwrap_or([0; N]);
        values.push(residuals(coder, contexts, &mut last, near, wanted(vertex))?);
    }
    Ok(())
}

/// Codes values by their differences from `near`. `last` is the scale of the last residuals.
fn residuals<const N: usize>(
    coder: &mut impl Coder,
    contexts: &mut [Numbers],
    last: &mut usize,
    near: [i64; N],
    wanted: [i32; N],
) -> Result<[i32; N], InputError> {
    let mut values = [0; N];
    let (mut context, mut largest) = (*last, 0);
    for part in 0..N {
        let numbers = &mut contexts[part * SCALES + context];
        let residual = numbers.code(coder, i64::from(wanted[part]) - near[part])?;
        values[part] = i32::try_from(near[part] + residual).map_err(|_| damaged())?;
        largest = residual.unsigned_abs().max(largest);
        context = scale(largest as i64);
    }
    *last = context;
    Ok(values)
}
