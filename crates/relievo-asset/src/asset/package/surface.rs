//! The triangles of a mesh, coded from the coarsest level to the finest.
//!
//! A *point* is a place of the surface, with all that moves it. A *vertex* belongs to one point, and adds what differs along
//! seams: normal, tangent, texture coordinates. A level is refined in four steps:
//!
//! 1. Each point gets a number of children: the points that collapse into it from the finer level.
//! 2. Around a point with children, each triangle keeps the point or takes a child. Neighbours mostly agree, so a fan of
//!    triangles costs little more than the places of its cuts.
//! 3. Triangles are added, each at an open edge. Mostly their third point is the end of a neighbouring open edge. The coarsest
//!    level has nothing to start from and grows from seeds in the same way (after Touma and Gotsman, "Triangle Mesh
//!    Compression", Graphics Interface 1998).
//! 4. Each new corner takes a vertex of its point, mostly that of a neighbouring triangle, or a new one.
//!
//! Any list of triangles can be coded: surfaces that are not manifold cost more.

use std::collections::HashMap;
use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::coder::{Coder, Frequencies, Numbers, damaged};
use crate::InputError;

/// No point, vertex or edge.
pub(super) const NONE: u32 = u32::MAX;

/// Most children that have a symbol of their own, and most that the choices of a fan have frequencies for.
const CHILDREN: usize = 15;

/// Adaptive frequencies of all steps, shared by all meshes and levels.
pub(super) struct SurfaceContexts {
    mode: Frequencies,
    counts: Numbers,
    /// By the number of triangles around the point, at most 7.
    children: Vec<Frequencies>,
    /// By the number of children, at most [`CHILDREN`].
    first_choice: Vec<Frequencies>,
    /// By children (1 or more), switches so far, triangles that are left, and whether the fan is closed.
    stays: Vec<Frequencies>,
    next_choice: Vec<Frequencies>,
    /// By the kind of the open edge, its neighbours, and whether a child has no triangle yet.
    third: Vec<Frequencies>,
    seed: Frequencies,
    /// By whether the last point was single.
    is_single: Vec<Frequencies>,
    corner: Vec<Frequencies>,
    are_likely: Frequencies,
    partner: Frequencies,
}

impl SurfaceContexts {
    pub fn new() -> Self {
        let all = |count: usize, symbols: usize| vec![Frequencies::new(symbols); count];
        Self {
            mode: Frequencies::new(3),
            counts: Numbers::new(),
            children: all(8, CHILDREN + 1),
            first_choice: all(CHILDREN + 1, CHILDREN + 1),
            stays: all(2 * 4 * 8 * 2, 2),
            next_choice: all(CHILDREN + 1, CHILDREN + 1),
            third: all(3 * 5 * 2, 6),
            seed: Frequencies::new(3),
            is_single: all(2, 2),
            corner: all(CORNERS, 5),
            are_likely: Frequencies::new(2),
            partner: Frequencies::new(4),
        }
    }
}

/// How a level is coded.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    /// From the triangles of the coarser level.
    Refined = 0,
    /// From nothing.
    Grown = 1,
    /// The level has the same triangles as the coarser level.
    Same = 2,
}

/// The surface of one mesh at the finest level that was coded so far.
#[derive(Debug, Default)]
pub(super) struct Surface {
    /// For each point, the point into which it collapses, or [`NONE`].
    pub parents: Vec<u32>,
    /// For each point, its first vertex, or [`NONE`].
    first_vertex: Vec<u32>,
    /// For each point with a vertex, whether it has only one at all levels.
    is_single: Vec<bool>,
    /// For each vertex, the point's next vertex, or [`NONE`].
    next_vertex: Vec<u32>,
    /// For each vertex, its point.
    pub point_of: Vec<u32>,
    /// For each vertex, its partner.
    pub partners: Vec<u32>,
    /// The points of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The vertices of each triangle.
    pub corners: Vec<[u32; 3]>,
    /// For each edge of each triangle, the same edge of the neighbouring triangle, or [`NONE`]. Edge 3 t + c leads from
    /// corner c of triangle t to the next corner.
    twins: Vec<u32>,
    /// For each point, the number of triangle corners there.
    corner_counts: Vec<u32>,
    /// Edges without a twin.
    borders: Vec<u32>,
}

/// The points and vertices that a level adds.
#[derive(Debug, Clone)]
pub(super) struct Added {
    pub points: Range<u32>,
    pub vertices: Range<u32>,
    /// Edges that start at a corner with another point than before, ascending. All edges of added triangles are among them.
    pub edges: Vec<u32>,
}

/// What the header leaves for all meshes together.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    pub points: usize,
    pub vertices: usize,
    /// Triangles of all levels.
    pub triangles: usize,
    /// Displacements of vertices by morph targets.
    pub moves: usize,
    /// Vertices times morph targets: the number of tests whether a target moves a vertex.
    pub tests: usize,
}

impl Room {
    /// Room of a writer.
    pub const ENDLESS: Self = Self {
        points: usize::MAX,
        vertices: usize::MAX,
        triangles: usize::MAX,
        moves: usize::MAX,
        tests: usize::MAX,
    };

    /// What was taken from [`Room::ENDLESS`].
    pub fn used(&self) -> Self {
        let Self { points, vertices, triangles, moves, tests } = *self;
        let [points, vertices, triangles, moves, tests] =
            [points, vertices, triangles, moves, tests].map(|left| usize::MAX - left);
        Self { points, vertices, triangles, moves, tests }
    }

    /// Takes elements away.
    pub fn take(left: &mut usize, count: usize) -> Result<(), InputError> {
        *left = left.checked_sub(count).ok_or_else(damaged)?;
        Ok(())
    }
}

fn next(edge: u32) -> u32 {
    if edge % 3 == 2 { edge - 2 } else { edge + 1 }
}

fn previous(edge: u32) -> u32 {
    if edge.is_multiple_of(3) { edge + 2 } else { edge - 1 }
}

/// One list of edges for each point, the latest first. Closed edges stay in a list until they are met there.
#[derive(Debug, Default)]
struct Lists {
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Lists {
    fn push(&mut self, point: u32, edge: u32) {
        if self.first.len() <= point as usize {
            self.first.resize(point as usize + 1, NONE);
        }
        if self.next.len() <= edge as usize {
            self.next.resize(edge as usize + 1, NONE);
        }
        self.next[edge as usize] = std::mem::replace(&mut self.first[point as usize], edge);
    }

    /// The latest open edge of a point, after closed ones were removed.
    fn latest(&mut self, point: u32, is_open: &[bool]) -> u32 {
        let Some(first) = self.first.get_mut(point as usize) else { return NONE };
        while *first != NONE && !is_open[*first as usize] {
            *first = self.next[*first as usize];
        }
        *first
    }

    /// The latest open edge of a point that meets a condition, among the first [`COMPARED`], or [`NONE`].
    fn find(&mut self, point: u32, is_open: &[bool], is_wanted: impl Fn(u32) -> bool) -> u32 {
        let mut edge = self.latest(point, is_open);
        for _ in 0..COMPARED {
            if edge == NONE || is_open[edge as usize] && is_wanted(edge) {
                return edge;
            }
            edge = self.next[edge as usize];
        }
        NONE
    }
}

impl Surface {
    fn point(&self, edge: u32) -> u32 {
        self.triangles[edge as usize / 3][edge as usize % 3]
    }

    fn vertex(&self, edge: u32) -> u32 {
        self.corners[edge as usize / 3][edge as usize % 3]
    }

    /// The edge of the triangle before in the fan around the start of an edge, or [`NONE`].
    fn back(&self, edge: u32) -> u32 {
        match self.twins[edge as usize] {
            NONE => NONE,
            twin => next(twin),
        }
    }

    /// The edge of the next triangle in the fan around the start of an edge, or [`NONE`].
    fn forth(&self, edge: u32) -> u32 {
        self.twins[previous(edge) as usize]
    }

    fn add_point(&mut self, parent: u32) -> u32 {
        self.parents.push(parent);
        self.first_vertex.push(NONE);
        self.is_single.push(false);
        self.corner_counts.push(0);
        self.parents.len() as u32 - 1
    }

    fn add_vertex(&mut self, point: u32) -> u32 {
        let vertex = self.point_of.len() as u32;
        self.point_of.push(point);
        self.next_vertex.push(std::mem::replace(&mut self.first_vertex[point as usize], vertex));
        self.partners.push(vertex);
        vertex
    }

    /// The vertices of a point, the latest first.
    fn vertices_at(&self, point: u32) -> impl Iterator<Item = u32> {
        let first = self.first_vertex.get(point as usize).copied().unwrap_or(NONE);
        let some = |vertex: u32| (vertex != NONE).then_some(vertex);
        std::iter::successors(some(first), move |vertex| some(self.next_vertex[*vertex as usize]))
    }

    /// The vertices of all triangles, in an order in which neighbours follow each other: a device's vertex cache then misses
    /// about one vertex a triangle.
    pub fn indices(&self) -> Vec<u32> {
        let mut indices = Vec::with_capacity(3 * self.triangles.len());
        let mut is_drawn = vec![false; self.triangles.len()];
        let mut stack = Vec::new();
        for start in 0..self.triangles.len() as u32 {
            stack.push(3 * start);
            while let Some(edge) = stack.pop() {
                let triangle = edge as usize / 3;
                if std::mem::replace(&mut is_drawn[triangle], true) {
                    continue;
                }
                indices.extend(self.corners[triangle]);
                let twins = [next(edge), previous(edge)].map(|edge| self.twins[edge as usize]);
                stack.extend(twins.into_iter().filter(|twin| *twin != NONE));
            }
        }
        indices
    }

    /// Codes the next finer level. `truth` has the level when writing. `with_partners` says whether vertices have partners.
    ///
    /// # Errors
    /// When reading: [`InputError`] for bytes that no writer makes, and for more vertices or triangles than `room` has.
    pub fn level(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        room: &mut Room,
        truth: &mut Option<Truth<'_>>,
        partners: Partners,
    ) -> Result<Added, InputError> {
        let (points, vertices) = (self.parents.len() as u32, self.point_of.len() as u32);
        let mode = truth.as_mut().map_or(Mode::Same, |truth| truth.mode(self));
        let mode = match coder.symbol(&mut contexts.mode, mode as usize)? {
            0 => Mode::Refined,
            1 => Mode::Grown,
            _ => Mode::Same,
        };
        let mut coarse = Coarse::default();
        match mode {
            Mode::Same => {
                Room::take(&mut room.triangles, self.triangles.len())?;
                return Ok(Added { points: points..points, vertices: vertices..vertices, edges: Vec::new() });
            }
            Mode::Grown => {
                self.triangles.clear();
                self.twins.clear();
                self.corners.clear();
                self.borders.clear();
                self.corner_counts.fill(0);
            }
            Mode::Refined => {
                coarse.families = self.children(coder, contexts, room, truth)?;
                coarse.changed = self.choices(coder, contexts, &coarse.families, truth)?;
                coarse.cuts = self.cut(&coarse.changed);
            }
        }
        let kept = self.triangles.len();
        Room::take(&mut room.triangles, kept)?;
        let added = truth.as_ref().map_or(0, |truth| truth.triangles.len() - kept);
        let added = usize::try_from(contexts.counts.code(coder, added as i64)?).map_err(|_| damaged())?;
        Room::take(&mut room.triangles, added)?;
        self.grow(coder, contexts, room, added, &coarse, truth)?;
        let first_added = 3 * kept as u32;
        let edges = coarse.changed.iter().map(|changed| changed.edge);
        let edges: Vec<u32> = edges.chain(first_added..3 * self.triangles.len() as u32).collect();
        self.name_corners(coder, contexts, room, &edges, truth)?;
        if partners == Partners::Known {
            self.code_partners(coder, contexts, &coarse, vertices, truth)?;
        }
        let (points_end, vertices_end) = (self.parents.len() as u32, self.point_of.len() as u32);
        Ok(Added { points: points..points_end, vertices: vertices..vertices_end, edges })
    }

    /// Codes the number of children of each point. Returns the first child of each point, and at the end the number of points.
    fn children(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        room: &mut Room,
        truth: &mut Option<Truth<'_>>,
    ) -> Result<Vec<u32>, InputError> {
        let points = self.parents.len() as u32;
        let mut families = vec![points];
        for point in 0..points {
            let corners = self.corner_counts[point as usize] as usize;
            let wanted = truth.as_ref().map_or(0, |truth| truth.children_of(point).len());
            let symbol = match corners {
                0 => 0,
                _ => coder.symbol(&mut contexts.children[corners.min(7)], wanted.min(CHILDREN))?,
            };
            let count = match symbol {
                CHILDREN => {
                    let more = contexts.counts.code(coder, wanted.saturating_sub(CHILDREN) as i64)?;
                    CHILDREN + usize::try_from(more).map_err(|_| damaged())?
                }
                few => few,
            };
            Room::take(&mut room.points, count)?;
            for child in 0..count {
                let coded = self.add_point(point);
                if let Some(truth) = truth {
                    truth.name_child(point, child, coded);
                }
            }
            families.push(self.parents.len() as u32);
        }
        Ok(families)
    }

    /// Codes for each corner of each triangle whether it keeps its point or takes a child. Returns the corners that take one.
    fn choices(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        families: &[u32],
        truth: &Option<Truth<'_>>,
    ) -> Result<Vec<Changed>, InputError> {
        let has_children: Vec<bool> = families.windows(2).map(|ends| ends[0] < ends[1]).collect();
        let mut is_done = vec![false; 3 * self.triangles.len()];
        let (mut changed, mut fan) = (Vec::new(), Vec::new());
        for start in 0..is_done.len() as u32 {
            if is_done[start as usize] || !has_children[self.point(start) as usize] {
                continue;
            }
            let point = self.point(start);
            let children = families[point as usize]..families[point as usize + 1];
            let is_closed = self.fan(start, &mut fan);
            fan.iter().for_each(|edge| is_done[*edge as usize] = true);
            let known = |edge: u32| {
                let point = truth.as_ref().and_then(|truth| truth.point_at(edge).checked_sub(children.start));
                point.map_or(0, |child| child as usize + 1)
            };
            let count = children.len();
            let (mut choice, mut switches) = (0, 0);
            for (at, edge) in fan.iter().enumerate() {
                let wanted = known(*edge);
                if at == 0 {
                    choice = choose(coder, &mut contexts.first_choice, count, wanted)?;
                } else {
                    let left = (fan.len() - at).min(7);
                    let context = ((count.min(2) - 1) * 4 + switches.min(3)) * 8 + left;
                    let context = &mut contexts.stays[2 * context + usize::from(is_closed)];
                    if coder.symbol(context, usize::from(wanted == choice))? == 0 {
                        switches += 1;
                        // The choice is another one of the family: it is counted from the one after this.
                        let further = (wanted + count - choice) % (count + 1);
                        let further = match count {
                            1 => 0,
                            _ => choose(coder, &mut contexts.next_choice, count - 1, further)?,
                        };
                        choice = (choice + 1 + further) % (count + 1);
                    }
                }
                if choice > 0 {
                    changed.push(Changed { edge: *edge, vertex: self.vertex(*edge) });
                    let child = children.start + choice as u32 - 1;
                    self.triangles[*edge as usize / 3][*edge as usize % 3] = child;
                    self.corner_counts[point as usize] -= 1;
                    self.corner_counts[child as usize] += 1;
                }
            }
        }
        changed.sort_unstable_by_key(|changed| changed.edge);
        for Changed { edge, .. } in &changed {
            self.corners[*edge as usize / 3][*edge as usize % 3] = NONE;
        }
        Ok(changed)
    }

    /// The edges of all triangles around the start of an edge, in order. Returns whether the fan is closed.
    fn fan(&self, edge: u32, fan: &mut Vec<u32>) -> bool {
        let mut start = edge;
        let is_closed = loop {
            match self.back(start) {
                NONE => break false,
                before if before == edge => break true,
                before => start = before,
            }
        };
        let start = if is_closed { edge } else { start };
        fan.clear();
        fan.push(start);
        let mut last = self.forth(start);
        while last != NONE && last != start {
            fan.push(last);
            last = self.forth(last);
        }
        is_closed
    }

    /// Separates triangles that no longer share an edge. Returns the edges at which they did.
    fn cut(&mut self, changed: &[Changed]) -> Vec<u32> {
        let mut cuts = Vec::new();
        for edge in changed.iter().flat_map(|changed| [changed.edge, previous(changed.edge)]) {
            let twin = self.twins[edge as usize];
            let is_cut = twin != NONE
                && (self.point(edge) != self.point(next(twin)) || self.point(next(edge)) != self.point(twin));
            if is_cut {
                self.twins[edge as usize] = NONE;
                self.twins[twin as usize] = NONE;
                cuts.extend([edge, twin]);
            }
        }
        cuts
    }

    /// Codes the triangles that a level adds.
    fn grow(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        room: &mut Room,
        mut left: usize,
        coarse: &Coarse,
        truth: &mut Option<Truth<'_>>,
    ) -> Result<(), InputError> {
        let first = 3 * self.triangles.len() as u32;
        let mut front = Front::new(self, coarse);
        while left > 0 {
            left -= 1;
            let Some(edge) = front.pop() else {
                let wanted = truth.as_mut().map(Truth::seed);
                let mut triangle = [0; 3];
                for corner in 0..3 {
                    let wanted = wanted.map(|wanted| wanted[corner]);
                    triangle[corner] = self.seed(coder, contexts, room, wanted, truth)?;
                }
                front.add(self, triangle);
                continue;
            };
            let ends = [self.point(edge), self.point(next(edge))];
            let near = front.near(self, ends);
            let child = front.child(self, &coarse.families, ends);
            let wanted = truth.as_mut().map(|truth| truth.third(ends, near));
            let symbol = wanted.map_or(0, |wanted| match wanted {
                Third::None => BORDER,
                Third::New(_) => FRESH,
                Third::Known(point) if point == near[0] => 0,
                Third::Known(point) if point == near[1] => 1,
                Third::Known(point) if point == child => CHILD,
                Third::Known(_) => EXPLICIT,
            });
            let context = front.context(edge, near, child);
            let third = match coder.symbol(&mut contexts.third[context], symbol)? {
                near_one @ (0 | 1) => near[near_one],
                BORDER => {
                    front.is_open[edge as usize] = false;
                    left += 1;
                    continue;
                }
                CHILD => child,
                FRESH => {
                    Room::take(&mut room.points, 1)?;
                    let point = self.add_point(NONE);
                    if let (Some(truth), Some(Third::New(source))) = (truth.as_mut(), wanted) {
                        truth.name_point(source, point);
                    }
                    point
                }
                _ => {
                    let wanted = match wanted {
                        Some(Third::Known(point)) => point as usize,
                        _ => 0,
                    };
                    coder.below(self.parents.len(), wanted)? as u32
                }
            };
            if third == NONE {
                return Err(damaged());
            }
            front.add(self, [ends[1], ends[0], third]);
        }
        let mut borders = std::mem::take(&mut self.borders);
        borders.extend(&coarse.cuts);
        borders.extend(first..self.twins.len() as u32);
        borders.retain(|edge| self.twins[*edge as usize] == NONE);
        self.borders = borders;
        Ok(())
    }

    /// Codes a corner of a triangle that no open edge touches. `wanted` is the source's point.
    fn seed(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        room: &mut Room,
        wanted: Option<u32>,
        truth: &mut Option<Truth<'_>>,
    ) -> Result<u32, InputError> {
        let known = wanted.zip(truth.as_ref()).map_or(NONE, |(source, truth)| truth.points[source as usize]);
        if coder.symbol(&mut contexts.seed, usize::from(known != NONE))? == 1 {
            return Ok(coder.below(self.parents.len(), known as usize)? as u32);
        }
        Room::take(&mut room.points, 1)?;
        let point = self.add_point(NONE);
        if let Some((source, truth)) = wanted.zip(truth.as_mut()) {
            truth.name_point(source, point);
        }
        Ok(point)
    }

    /// Codes the vertices of corners that have none.
    fn name_corners(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        room: &mut Room,
        edges: &[u32],
        truth: &mut Option<Truth<'_>>,
    ) -> Result<(), InputError> {
        self.corners.resize(self.triangles.len(), [NONE; 3]);
        let mut was_single = false;
        for edge in edges.iter().copied() {
            let point = self.point(edge);
            let is_bare = self.first_vertex[point as usize] == NONE;
            if is_bare {
                let is_single = truth.as_ref().is_some_and(|truth| truth.is_single(edge));
                let context = &mut contexts.is_single[usize::from(was_single)];
                was_single = coder.symbol(context, usize::from(is_single))? == 1;
                self.is_single[point as usize] = was_single;
            } else if self.is_single[point as usize] {
                self.corners[edge as usize / 3][edge as usize % 3] = self.first_vertex[point as usize];
                continue;
            }
            let wanted = truth.as_ref().map_or(NONE, |truth| truth.vertex_at(edge));
            let ([left, right], context) = self.beside(edge);
            let symbol = match wanted {
                NONE => NEW_VERTEX,
                wanted if wanted == left => 0,
                wanted if wanted == right => 1,
                _ => OTHER_VERTEX,
            };
            let symbol = match is_bare {
                true => NEW_VERTEX,
                false => coder.symbol(&mut contexts.corner[context], symbol)?,
            };
            let vertex = match symbol {
                0 => left,
                1 => right,
                NEW_VERTEX => {
                    Room::take(&mut room.vertices, 1)?;
                    let vertex = self.add_vertex(point);
                    if let Some(truth) = truth {
                        truth.name_vertex(edge, vertex);
                    }
                    vertex
                }
                _ => {
                    let at = self.vertices_at(point).position(|vertex| vertex == wanted).unwrap_or(0);
                    let at = contexts.counts.code(coder, at as i64)?;
                    let at = usize::try_from(at).map_err(|_| damaged())?;
                    self.vertices_at(point).nth(at).ok_or_else(damaged)?
                }
            };
            if vertex == NONE {
                return Err(damaged());
            }
            self.corners[edge as usize / 3][edge as usize % 3] = vertex;
        }
        Ok(())
    }

    /// The vertices of the two neighbouring corners at the start of an edge, or [`NONE`], and the context of the corner.
    fn beside(&self, edge: u32) -> ([u32; 2], usize) {
        let compare = |own: u32, other: u32| match (self.vertex(own), self.vertex(other)) {
            (NONE, _) | (_, NONE) => 0,
            (own, other) if own == other => 1,
            _ => 2,
        };
        let mut found = [NONE; 2];
        let mut seams = [0; 2];
        let left = self.twins[previous(edge) as usize];
        if left != NONE {
            found[0] = self.vertex(left);
            seams[0] = compare(previous(edge), next(left));
        }
        let right = self.twins[edge as usize];
        if right != NONE {
            found[1] = self.vertex(next(right));
            seams[1] = compare(next(edge), right);
        }
        let sides = match found {
            [NONE, NONE] => 0,
            [_, NONE] => 1,
            [NONE, _] => 2,
            [left, right] if left == right => 3,
            _ => 4,
        };
        (found, (sides * 3 + seams[0]) * 3 + seams[1])
    }

    /// Codes the partners of the vertices that a level adds.
    fn code_partners(
        &mut self,
        coder: &mut impl Coder,
        contexts: &mut SurfaceContexts,
        coarse: &Coarse,
        first: u32,
        truth: &Option<Truth<'_>>,
    ) -> Result<(), InputError> {
        let vertices = self.point_of.len() as u32;
        let mut likely = vec![NONE; (vertices - first) as usize];
        for Changed { edge, vertex } in &coarse.changed {
            if let Some(likely) = self.vertex(*edge).checked_sub(first).map(|new| &mut likely[new as usize]) {
                *likely = if *likely == NONE { *vertex } else { *likely };
            }
        }
        for (vertex, likely) in (first..vertices).zip(&mut likely) {
            if *likely == NONE {
                let parent = self.parents[self.point_of[vertex as usize] as usize];
                *likely = self.vertices_at(parent).find(|other| *other < first).unwrap_or(vertex);
            }
        }
        let wanted = |vertex: u32| truth.as_ref().map_or(0, |truth| truth.partner_of(vertex));
        let are_likely = (first..vertices).zip(&likely).all(|(vertex, likely)| wanted(vertex) == *likely);
        let are_likely = coder.symbol(&mut contexts.are_likely, usize::from(are_likely))? == 1;
        if are_likely {
            self.partners[first as usize..].copy_from_slice(&likely);
            return Ok(());
        }
        for (vertex, likely) in (first..vertices).zip(likely) {
            let wanted = wanted(vertex);
            let symbol = match wanted {
                wanted if wanted == likely => 0,
                wanted if wanted == vertex => 1,
                _ => 2,
            };
            self.partners[vertex as usize] = match coder.symbol(&mut contexts.partner, symbol)? {
                0 => likely,
                1 => vertex,
                _ => coder.below(vertices as usize, wanted as usize)? as u32,
            };
        }
        Ok(())
    }
}

/// Number of contexts of a corner: five kinds of neighbours, three kinds of seams at both.
const CORNERS: usize = 5 * 3 * 3;

// Symbols of the third point of a triangle at an open edge. 0 and 1 are the ends of the neighbouring open edges.
/// The edge is a border.
const BORDER: usize = 2;
/// A child without triangles.
const CHILD: usize = 3;
/// A new point that is no child.
const FRESH: usize = 4;
/// Any point.
const EXPLICIT: usize = 5;

// Symbols of the vertex of a corner. 0 and 1 are the vertices of the neighbouring corners.
/// A new vertex.
const NEW_VERTEX: usize = 2;
/// Any vertex of the point.
const OTHER_VERTEX: usize = 3;

/// Whether vertices have partners.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Partners {
    Unknown,
    Known,
}

/// What the coarser level was.
#[derive(Default)]
struct Coarse {
    /// The first child of each point, and at the end the number of points.
    families: Vec<u32>,
    /// Corners that take a child, ascending.
    changed: Vec<Changed>,
    /// Edges at which triangles were separated.
    cuts: Vec<u32>,
}

/// A corner that takes a child: the edge that starts there, and the vertex that it had.
struct Changed {
    edge: u32,
    vertex: u32,
}

/// Codes a number from 0 to `most`.
fn choose(
    coder: &mut impl Coder,
    contexts: &mut [Frequencies],
    most: usize,
    number: usize,
) -> Result<usize, InputError> {
    if most > CHILDREN {
        return coder.below(most + 1, number);
    }
    let number = coder.symbol(&mut contexts[most], number)?;
    if number <= most { Ok(number) } else { Err(damaged()) }
}

/// The open edges of a level under construction.
struct Front {
    is_open: Vec<bool>,
    from: Lists,
    to: Lists,
    stack: Vec<u32>,
    /// For each of the first edges, whether triangles were separated there.
    is_cut: Vec<bool>,
    /// For each point of the coarser level, the first child that may have no triangle.
    next_child: Vec<u32>,
}

/// Most open edges of a point that are compared with a new edge.
const COMPARED: usize = 16;

impl Front {
    fn new(surface: &Surface, coarse: &Coarse) -> Self {
        let edges = 3 * surface.triangles.len();
        let mut front = Self {
            is_open: vec![false; edges],
            from: Lists::default(),
            to: Lists::default(),
            stack: Vec::new(),
            is_cut: vec![false; edges],
            next_child: coarse.families.clone(),
        };
        coarse.cuts.iter().for_each(|edge| front.is_cut[*edge as usize] = true);
        surface.borders.iter().chain(&coarse.cuts).for_each(|edge| front.open(surface, *edge));
        front
    }

    fn open(&mut self, surface: &Surface, edge: u32) {
        self.is_open[edge as usize] = true;
        self.from.push(surface.point(edge), edge);
        self.to.push(surface.point(next(edge)), edge);
        self.stack.push(edge);
    }

    fn pop(&mut self) -> Option<u32> {
        while let Some(edge) = self.stack.pop() {
            if self.is_open[edge as usize] {
                return Some(edge);
            }
        }
        None
    }

    /// The points that the open edges before and after an edge lead to.
    fn near(&mut self, surface: &Surface, [start, end]: [u32; 2]) -> [u32; 2] {
        let before = match self.to.latest(start, &self.is_open) {
            NONE => NONE,
            edge => surface.point(edge),
        };
        let after = match self.from.latest(end, &self.is_open) {
            NONE => NONE,
            edge => surface.point(next(edge)),
        };
        [before, after]
    }

    /// A child of the families of two points that has no triangle yet, or [`NONE`].
    fn child(&mut self, surface: &Surface, families: &[u32], ends: [u32; 2]) -> u32 {
        for end in ends {
            let parent = match surface.parents[end as usize] {
                parent if families.first().is_some_and(|first| end >= *first) => parent,
                _ => end,
            };
            let Some([_, family_end]) = families.get(parent as usize..).and_then(|rest| rest.first_chunk())
            else {
                continue;
            };
            let child = &mut self.next_child[parent as usize];
            while *child < *family_end && surface.corner_counts[*child as usize] > 0 {
                *child += 1;
            }
            if *child < *family_end {
                return *child;
            }
        }
        NONE
    }

    fn context(&self, edge: u32, [before, after]: [u32; 2], child: u32) -> usize {
        let kind = self.is_cut.get(edge as usize).map_or(2, |is_cut| usize::from(*is_cut));
        let sides = match (before, after) {
            (NONE, NONE) => 0,
            (_, NONE) => 1,
            (NONE, _) => 2,
            (before, after) if before == after => 3,
            _ => 4,
        };
        (kind * 5 + sides) * 2 + usize::from(child != NONE)
    }

    /// Adds a triangle, and connects it with its neighbours.
    fn add(&mut self, surface: &mut Surface, triangle: [u32; 3]) {
        let first = 3 * surface.triangles.len() as u32;
        surface.triangles.push(triangle);
        surface.twins.extend([NONE; 3]);
        self.is_open.extend([false; 3]);
        triangle.iter().for_each(|point| surface.corner_counts[*point as usize] += 1);
        for edge in first..first + 3 {
            let [start, end] = [surface.point(edge), surface.point(next(edge))];
            match self.from.find(end, &self.is_open, |other| surface.point(next(other)) == start) {
                NONE => self.open(surface, edge),
                twin => {
                    self.is_open[twin as usize] = false;
                    surface.twins[edge as usize] = twin;
                    surface.twins[twin as usize] = edge;
                }
            }
        }
    }
}

/// The third point of a triangle at an open edge.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Third {
    /// The edge is a border.
    None,
    /// A point of the source that is not coded yet.
    New(u32),
    /// A coded point.
    Known(u32),
}

/// A mesh to write: its points, and the names that points and vertices got so far.
pub(super) struct Truth<'a> {
    pub source: &'a Source<'a>,
    /// The vertices of the level's triangles, in the source.
    triangles: Vec<[u32; 3]>,
    /// The vertices of the coarser level's triangles, in the source.
    coarser: Vec<[u32; 3]>,
    /// For each point of the source, its coded name or [`NONE`].
    points: Vec<u32>,
    /// For each coded point, the point of the source.
    pub sources: Vec<u32>,
    vertices: Vec<u32>,
    /// For each coded vertex, the vertex of the source.
    pub vertex_sources: Vec<u32>,
    /// For each coded point of the coarser level, its children in the source.
    children: HashMap<u32, Vec<u32>>,
    /// For each coded triangle, the triangle of the source, and the corner of it that is the first.
    placed: Vec<(u32, usize)>,
    is_placed: Vec<bool>,
    /// The first triangle that may not be placed yet.
    first_left: usize,
    /// For each edge between points of the source, the triangles with this edge and the edge's first corner.
    edges: HashMap<[u32; 2], Vec<(u32, usize)>>,
}

/// The points of a mesh.
pub(super) struct Source<'a> {
    /// For each vertex, its point.
    pub point_of: Vec<u32>,
    /// For each point, a vertex.
    pub vertex_of: Vec<u32>,
    /// For each point, whether it has one vertex.
    pub is_single: Vec<bool>,
    /// For each vertex, its partner; empty if not known.
    pub partners: &'a [u32],
}

impl Source<'_> {
    fn points_of(&self, triangle: [u32; 3]) -> [u32; 3] {
        triangle.map(|vertex| self.point_of[vertex as usize])
    }

    /// The point into which a point collapses.
    fn parent(&self, point: u32) -> u32 {
        let vertex = self.vertex_of[point as usize];
        self.partners.get(vertex as usize).map_or(point, |partner| self.point_of[*partner as usize])
    }
}

impl<'a> Truth<'a> {
    pub fn new(source: &'a Source<'a>) -> Self {
        Self {
            source,
            triangles: Vec::new(),
            coarser: Vec::new(),
            points: vec![NONE; source.vertex_of.len()],
            sources: Vec::new(),
            vertices: vec![NONE; source.point_of.len()],
            vertex_sources: Vec::new(),
            children: HashMap::new(),
            placed: Vec::new(),
            is_placed: Vec::new(),
            first_left: 0,
            edges: HashMap::new(),
        }
    }

    /// Goes to the next finer level, with these triangles.
    pub fn set_level(&mut self, indices: &[u32]) {
        self.coarser = std::mem::replace(&mut self.triangles, indices.as_chunks::<3>().0.to_vec());
        self.is_placed = vec![false; self.triangles.len()];
        self.first_left = 0;
        self.children.clear();
        self.edges.clear();
        for (at, triangle) in (0..).zip(&self.triangles) {
            let points = self.source.points_of(*triangle);
            for corner in 0..3 {
                let edge = [points[corner], points[(corner + 1) % 3]];
                self.edges.entry(edge).or_default().push((at, corner));
            }
        }
    }

    /// Decides how the level is coded.
    fn mode(&mut self, surface: &Surface) -> Mode {
        if self.triangles == self.coarser && !self.triangles.is_empty() {
            return Mode::Same;
        }
        let placed = self.refined(surface);
        let mode = if placed.is_some() { Mode::Refined } else { Mode::Grown };
        self.placed = placed.unwrap_or_default();
        self.placed.iter().for_each(|(triangle, _)| self.is_placed[*triangle as usize] = true);
        if mode == Mode::Refined {
            let mut seen = vec![false; self.points.len()];
            for triangle in &self.triangles {
                for point in self.source.points_of(*triangle) {
                    let parent = self.source.parent(point);
                    let is_new = !std::mem::replace(&mut seen[point as usize], true);
                    if is_new && self.points[point as usize] == NONE && self.points[parent as usize] != NONE {
                        self.children.entry(self.points[parent as usize]).or_default().push(point);
                    }
                }
            }
        }
        mode
    }

    /// For each triangle of the coarser level, the triangle that it becomes. `None` if a triangle becomes none, or if a corner
    /// that stays changes its vertex.
    fn refined(&self, surface: &Surface) -> Option<Vec<(u32, usize)>> {
        // In the coarser level, a point that is not coded is its parent.
        let before = |point: u32| match self.points[point as usize] {
            NONE => self.points[self.source.parent(point) as usize],
            point => point,
        };
        let mut known: HashMap<[u32; 3], Vec<(u32, usize)>> = HashMap::new();
        for (at, triangle) in (0..).zip(&self.triangles) {
            let [a, b, c] = self.source.points_of(*triangle).map(before);
            if a != b && b != c && c != a && ![a, b, c].contains(&NONE) {
                let (key, corner) = rotated([a, b, c]);
                known.entry(key).or_default().push((at, corner));
            }
        }
        let mut placed = Vec::with_capacity(surface.triangles.len());
        for (points, vertices) in surface.triangles.iter().zip(&surface.corners) {
            let (key, corner) = rotated(*points);
            let (at, first) = known.get_mut(&key)?.pop()?;
            // The corner of the fine triangle that becomes the first of the coarse triangle.
            let first = (first + 3 - corner) % 3;
            for corner in 0..3 {
                let vertex = self.triangles[at as usize][(first + corner) % 3];
                let is_kept = self.points[self.source.point_of[vertex as usize] as usize] == points[corner];
                if is_kept && self.vertices[vertex as usize] != vertices[corner] {
                    return None;
                }
            }
            placed.push((at, first));
        }
        Some(placed)
    }

    fn children_of(&self, point: u32) -> &[u32] {
        self.children.get(&point).map_or(&[], Vec::as_slice)
    }

    fn name_child(&mut self, parent: u32, child: usize, point: u32) {
        let source = self.children_of(parent)[child];
        self.name_point(source, point);
    }

    fn name_point(&mut self, source: u32, point: u32) {
        self.points[source as usize] = point;
        self.sources.push(source);
    }

    /// The vertex of the source at the start of a coded edge.
    fn source_at(&self, edge: u32) -> u32 {
        let (triangle, first) = self.placed[edge as usize / 3];
        self.triangles[triangle as usize][(first + edge as usize) % 3]
    }

    /// The coded point at the start of an edge.
    fn point_at(&self, edge: u32) -> u32 {
        self.points[self.source.point_of[self.source_at(edge) as usize] as usize]
    }

    /// The coded vertex at the start of an edge, or [`NONE`] if it has no name yet.
    fn vertex_at(&self, edge: u32) -> u32 {
        self.vertices[self.source_at(edge) as usize]
    }

    /// Whether the point at the start of a coded edge has one vertex.
    fn is_single(&self, edge: u32) -> bool {
        self.source.is_single[self.source.point_of[self.source_at(edge) as usize] as usize]
    }

    fn name_vertex(&mut self, edge: u32, vertex: u32) {
        let source = self.source_at(edge);
        self.vertices[source as usize] = vertex;
        self.vertex_sources.push(source);
    }

    fn partner_of(&self, vertex: u32) -> u32 {
        let partner = self.source.partners[self.vertex_sources[vertex as usize] as usize];
        self.vertices[partner as usize]
    }

    fn place(&mut self, triangle: u32, first: usize) {
        self.is_placed[triangle as usize] = true;
        self.placed.push((triangle, first));
    }

    /// Places any triangle that is left. Returns its points in the source.
    fn seed(&mut self) -> [u32; 3] {
        while self.is_placed[self.first_left] {
            self.first_left += 1;
        }
        let triangle = self.first_left;
        self.place(triangle as u32, 0);
        self.source.points_of(self.triangles[triangle])
    }

    /// Places a triangle at an open edge, preferably with a third point of `near`.
    fn third(&mut self, [start, end]: [u32; 2], near: [u32; 2]) -> Third {
        let [start, end] = [start, end].map(|point| self.sources[point as usize]);
        let third = |truth: &Self, (triangle, first): (u32, usize)| {
            let vertex = truth.triangles[triangle as usize][(first + 2) % 3];
            truth.source.point_of[vertex as usize]
        };
        let left = self.edges.get(&[end, start]).into_iter().flatten().copied();
        let left: Vec<_> = left.filter(|(triangle, _)| !self.is_placed[*triangle as usize]).collect();
        let is_near = |found: &&(u32, usize)| near.contains(&self.points[third(self, **found) as usize]);
        let Some(found) = left.iter().find(is_near).or(left.first()).copied() else { return Third::None };
        self.place(found.0, found.1);
        let point = third(self, found);
        match self.points[point as usize] {
            NONE => Third::New(point),
            coded => Third::Known(coded),
        }
    }
}

/// A triangle with its smallest point first, and the corner where that was.
fn rotated(triangle: [u32; 3]) -> ([u32; 3], usize) {
    let corner = (0..3).min_by_key(|corner| triangle[*corner]).unwrap_or_default();
    (std::array::from_fn(|at| triangle[(corner + at) % 3]), corner)
}
