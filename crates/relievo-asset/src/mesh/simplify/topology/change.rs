//! Changes of the connectivity: collapses, and updates of triangle lists.

use super::{Change, Corner, Kind, Span, Topology};

impl Topology {
    /// Updates a point's list of triangles. The list is valid until the next collapse.
    #[inline]
    pub(crate) fn refresh(&mut self, point: u32) {
        if !std::mem::take(&mut self.touched[point as usize]) {
            return;
        }
        let change = &mut self.changes[point as usize];
        *change = (*change).max(Change::Around);
        let span = &mut self.spans[point as usize];
        let ring = &mut self.rings[span.range()];
        let remap = &self.remap;
        // Most points have collapsed at most once, so one unconditional step saves a branch.
        let latest = |at: u32| {
            let mut at = remap[at as usize];
            while remap[at as usize] != at {
                at = remap[at as usize];
            }
            at
        };
        let mut at = 0;
        let mut len = ring.len();
        while at < len {
            let before = ring[at];
            let [next, last] = [latest(before[0]), latest(before[1])];
            if next == last || next == point || last == point {
                len -= 1;
                ring[at] = ring[len];
                if !self.numbers.is_empty() {
                    self.numbers[span.start + at] = self.numbers[span.start + len];
                }
                continue;
            }
            ring[at] = [next, last];
            at += 1;
        }
        span.len = len as u32;
    }

    /// Merges a point into its neighbour. `moved` has the replacement of each of the point's vertices. Both lists of
    /// triangles must be up to date. The neighbour's list is up to date afterwards.
    pub(crate) fn collapse(&mut self, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.clear();
        let numbers = self.around(point).iter().copied().chain(std::iter::repeat(0));
        scratch.extend(self.ring(point).iter().copied().zip(numbers));
        self.remap[point as usize] = neighbor;
        self.remove(neighbor, point);
        self.changes[neighbor as usize] = Change::Merged;
        for ([next, last], _) in &scratch {
            self.touched[*next as usize] = true;
            self.touched[*last as usize] = true;
        }
        self.touched[neighbor as usize] = false;
        let before = scratch.len();
        scratch.retain(|([next, last], _)| *next != neighbor && *last != neighbor);
        self.triangles -= before - scratch.len();
        if !self.corners.is_empty() {
            scratch.iter().for_each(|(_, number)| self.move_corner(*number, point, neighbor, moved));
        }
        self.append(neighbor, &scratch);
        self.spans[point as usize].len = 0;
        self.kinds[point as usize] = Kind::Locked;
        self.scratch = scratch;
    }

    /// Merges all points of a part into its first point, and removes their triangles. All lists of triangles must be up
    /// to date.
    pub(crate) fn vanish(&mut self, part: &[u32]) {
        let Some(first) = part.first() else { return };
        let mut corners = 0;
        for &point in part {
            corners += std::mem::take(&mut self.spans[point as usize].len) as usize;
            self.remap[point as usize] = *first;
            self.kinds[point as usize] = Kind::Locked;
        }
        self.triangles -= corners / 3;
    }

    /// Removes the triangles that contain the point `other` from a point's list.
    fn remove(&mut self, point: u32, other: u32) {
        let span = &mut self.spans[point as usize];
        let mut at = span.start;
        while at < span.range().end {
            let [next, last] = self.rings[at];
            if next != other && last != other {
                at += 1;
                continue;
            }
            span.len -= 1;
            let end = span.range().end;
            self.rings[at] = self.rings[end];
            if !self.numbers.is_empty() {
                self.numbers[at] = self.numbers[end];
            }
        }
    }

    fn move_corner(&mut self, number: u32, point: u32, neighbor: u32, moved: &[[u32; 2]]) {
        let Some(corners) = self.corners.get_mut(number as usize) else { return };
        for corner in corners.iter_mut().filter(|corner| corner.point == point) {
            let to = moved.iter().find(|[from, _]| *from == corner.vertex);
            *corner = Corner { vertex: to.map_or(corner.vertex, |[_, to]| *to), point: neighbor };
        }
    }

    /// Adds triangles to a point's list. If its capacity is too small, the list is relocated.
    fn append(&mut self, point: u32, more: &[([u32; 2], u32)]) {
        let is_numbered = !self.numbers.is_empty();
        let span = &mut self.spans[point as usize];
        let len = span.len as usize + more.len();
        if len > span.room as usize {
            let before = span.range();
            let room = len + len / 4 + 1;
            *span = Span { start: self.rings.len(), len: span.len, room: room as u32 };
            self.rings.extend_from_within(before.clone());
            self.rings.resize(span.start + room, [0; 2]);
            if is_numbered {
                self.numbers.extend_from_within(before);
                self.numbers.resize(span.start + room, 0);
            }
        }
        for (others, number) in more {
            let at = span.range().end;
            span.len += 1;
            self.rings[at] = *others;
            if is_numbered {
                self.numbers[at] = *number;
            }
        }
    }
}
