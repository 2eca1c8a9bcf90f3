//! Points: groups of vertices that share one position.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use glam::DVec3;

/// Vertices grouped by their positions in all poses. Points are numbered in the order of their first vertices.
pub(crate) struct Points {
    of: Vec<u32>,
    starts: Vec<u32>,
    wedges: Vec<u32>,
    poses: usize,
    /// Positions, point by point, each in all poses.
    positions: Vec<[f32; 3]>,
}

impl Points {
    pub(crate) fn new(poses: &[Vec<[f32; 3]>]) -> Self {
        let of = weld(poses);
        let count = of.iter().max().map_or(0, |last| *last as usize + 1);
        let mut starts = vec![0_u32; count + 1];
        of.iter().for_each(|point| starts[*point as usize + 1] += 1);
        for point in 0..count {
            starts[point + 1] += starts[point];
        }
        let mut next = starts.clone();
        let mut wedges = vec![0; of.len()];
        for (vertex, point) in of.iter().enumerate() {
            wedges[next[*point as usize] as usize] = vertex as u32;
            next[*point as usize] += 1;
        }
        let firsts = starts[..count].iter().map(|start| wedges[*start as usize] as usize);
        let positions = firsts.flat_map(|vertex| poses.iter().map(move |pose| pose[vertex])).collect();
        Self { of, starts, wedges, poses: poses.len(), positions }
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    pub(crate) fn poses(&self) -> usize {
        self.poses
    }

    /// The point of a vertex.
    pub(crate) fn of(&self, vertex: u32) -> u32 {
        self.of[vertex as usize]
    }

    /// The vertices of a point, in ascending order.
    pub(crate) fn wedges(&self, point: u32) -> &[u32] {
        &self.wedges[self.starts[point as usize] as usize..self.starts[point as usize + 1] as usize]
    }

    pub(crate) fn position(&self, point: u32, pose: usize) -> DVec3 {
        glam::Vec3::from(self.positions[point as usize * self.poses + pose]).as_dvec3()
    }

    /// The point of each vertex.
    pub(crate) fn into_of(self) -> Vec<u32> {
        self.of
    }
}

/// The point of each vertex.
fn weld(poses: &[Vec<[f32; 3]>]) -> Vec<u32> {
    // Adding 0 turns −0 into +0.
    let bits = |pose: &Vec<[f32; 3]>, vertex: usize| pose[vertex].map(|x| (x + 0.0).to_bits());
    let same = |a: usize, b: usize| poses[1..].iter().all(|pose| bits(pose, a) == bits(pose, b));
    let vertices = poses[0].len();
    // Maps a position in the first pose to its first vertex. From each such vertex a chain leads to the next
    // one that differs in another pose.
    let mut firsts: HashMap<[u32; 3], u32> = HashMap::with_capacity(vertices);
    let mut others = vec![None; vertices];
    let mut of = Vec::with_capacity(vertices);
    let mut count = 0;
    for vertex in 0..vertices {
        let mut at = match firsts.entry(bits(&poses[0], vertex)) {
            Entry::Occupied(first) => *first.get() as usize,
            Entry::Vacant(first) => *first.insert(vertex as u32) as usize,
        };
        while at != vertex && !same(at, vertex) {
            at = *others[at].get_or_insert(vertex as u32) as usize;
        }
        of.push(if at == vertex { count } else { of[at] });
        count += u32::from(at == vertex);
    }
    of
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wedges_are_at_one_position_in_every_pose() {
        let rest = vec![[0.0; 3], [1.0; 3], [-0.0; 3], [0.0; 3], [1.0; 3], [0.0; 3], [0.0; 3]];
        let mut posed = rest.clone();
        posed[3] = [2.0; 3];
        posed[5] = [2.0; 3];
        posed[6] = [3.0; 3];
        let points = Points::new(&[rest, posed]);
        assert_eq!(points.len(), 4);
        assert_eq!([0, 1, 2, 3].map(|point| points.wedges(point)), [&[0, 2][..], &[1, 4], &[3, 5], &[6]]);
        assert_eq!([0, 1].map(|pose| points.position(2, pose)), [DVec3::ZERO, DVec3::splat(2.0)]);
        assert_eq!(points.into_of(), [0, 1, 0, 2, 1, 2, 3]);
    }
}
