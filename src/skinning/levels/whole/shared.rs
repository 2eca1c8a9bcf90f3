//! Vertices of different meshes that coincide, where the border of one mesh meets another mesh.

use std::collections::{HashMap, HashSet};

use glam::Vec3;

use crate::asset::Model;
use crate::mesh::simplify::weld;
use crate::parallel;
use crate::skinning::pose::{Moment, Pose};

/// Tolerance for coincident positions, as a fraction of the pose's largest coordinate: about eight roundings of an f32.
/// Meshes with different skins or nodes compute the same position in different ways.
const TOLERANCE: f32 = 5e-7;

/// The largest number of positions in a grid cell that are compared with one position. The limit matters for a mesh
/// that is a point in the first pose: all of its positions lie in one cell.
const MAX_COMPARED: usize = 64;

/// For each shared vertex (mesh, vertex), the coincident vertex (mesh, vertex) of an earlier mesh.
pub(crate) type Shared = HashMap<(usize, u32), (usize, u32)>;

/// Finds the vertices that meshes share in all of the given poses, and the groups of meshes that share any vertex.
///
/// The meshes of a group are in ascending order, and groups are ordered by their first mesh. A mesh that shares nothing
/// forms its own group. Vertices that are not at a border of either mesh are not shared, so a copy of a surface remains
/// a separate surface.
pub(crate) fn shared(model: &Model, moments: &[Moment]) -> (Shared, Vec<Vec<usize>>) {
    if model.meshes.len() < 2 {
        return (Shared::new(), (0..model.meshes.len()).map(|mesh| vec![mesh]).collect());
    }
    let places: Vec<Places> = parallel::map_range(model.meshes.len(), |at| Places::new(model, at, moments));
    let tolerances: Vec<f32> = (0..moments.len())
        .map(|pose| {
            let largest = places.iter().map(|places| places.largest(pose)).fold(0.0, f32::max);
            TOLERANCE * largest
        })
        .collect();
    let mut search = Search { tolerances: &tolerances, known: Vec::new(), cells: HashMap::new() };
    let mut found = Shared::new();
    let mut group: Vec<usize> = (0..places.len()).collect();
    for (mesh, own) in places.iter().enumerate() {
        let firsts = own.firsts();
        let to: Vec<Option<usize>> =
            firsts.iter().map(|vertex| search.find(&places, mesh, *vertex)).collect();
        let mut taken: HashMap<u32, (usize, u32)> = HashMap::new();
        for (vertex, to) in firsts.iter().zip(&to) {
            let Some(to) = to else {
                search.add(own, mesh, *vertex);
                continue;
            };
            let other = &mut search.known[*to];
            other.is_border |= own.is_border(*vertex);
            taken.insert(*vertex, (other.mesh, other.vertex));
            join(&mut group, mesh, other.mesh);
        }
        let wedges =
            (0..).zip(&own.point).filter_map(|(wedge, point)| Some(((mesh, wedge), *taken.get(point)?)));
        found.extend(wedges);
    }
    (found, groups(&group))
}

/// The distinct vertex positions of a mesh, called places.
struct Places {
    poses: Vec<Vec<[f32; 3]>>,
    /// For each vertex, the first vertex at the same position.
    point: Vec<u32>,
    /// The positions that triangles use, as the index of the first vertex at each position. The indices are ascending.
    used: Vec<u32>,
    /// The used positions that lie at a border of the mesh.
    border: HashSet<u32>,
}

impl Places {
    fn new(model: &Model, mesh: usize, moments: &[Moment]) -> Self {
        let mesh = &model.meshes[mesh];
        let positions = |moment: &Moment| {
            let all = Pose::new(model, mesh, *moment).positions(mesh);
            all.iter().map(Vec3::to_array).collect::<Vec<_>>()
        };
        let poses: Vec<_> = moments.iter().map(positions).collect();
        let numbers = weld(&poses);
        let mut first = vec![u32::MAX; numbers.len()];
        (0..).zip(&numbers).for_each(|(vertex, number)| {
            let known = &mut first[*number as usize];
            *known = (*known).min(vertex);
        });
        let point: Vec<u32> = numbers.iter().map(|number| first[*number as usize]).collect();
        let used = sorted(mesh.indices.iter().map(|vertex| point[*vertex as usize]));
        let border = border(&mesh.indices, &point);
        Self { poses, point, used, border }
    }

    fn firsts(&self) -> &[u32] {
        &self.used
    }

    fn is_border(&self, vertex: u32) -> bool {
        self.border.contains(&vertex)
    }

    fn largest(&self, pose: usize) -> f32 {
        let used = self.used.iter().flat_map(|vertex| self.poses[pose][*vertex as usize]);
        used.fold(0.0, |largest, x| largest.max(x.abs()))
    }
}

/// The positions at a border: the ends of edges that have a triangle on only one side.
fn border(indices: &[u32], point: &[u32]) -> HashSet<u32> {
    let triangles =
        indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|vertex| point[vertex as usize]));
    let has_area = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let edges: HashSet<[u32; 2]> =
        triangles.filter(has_area).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let open = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a]));
    open.flatten().copied().collect()
}

/// A position that the search has already stored.
struct Known {
    mesh: usize,
    vertex: u32,
    is_border: bool,
}

/// Finds coincident positions with a grid over the first pose.
struct Search<'a> {
    tolerances: &'a [f32],
    known: Vec<Known>,
    cells: HashMap<[i64; 3], Vec<usize>>,
}

impl Search<'_> {
    fn cell(&self, position: [f32; 3], off: [f32; 3]) -> [i64; 3] {
        let edge = f64::from(self.tolerances[0]).max(f64::MIN_POSITIVE) * 4.0;
        let at = |axis: usize| {
            let moved = f64::from(position[axis]) + f64::from(off[axis]) * f64::from(self.tolerances[0]);
            (moved / edge).floor() as i64
        };
        [at(0), at(1), at(2)]
    }

    /// The stored position of another mesh that coincides with a vertex. At least one of the two must be at a border.
    fn find(&self, places: &[Places], mesh: usize, vertex: u32) -> Option<usize> {
        let own = &places[mesh];
        let position = own.poses[0][vertex as usize];
        let signs = [-1.0, 1.0];
        let corners = signs.iter().flat_map(|x| signs.iter().flat_map(move |y| signs.map(|z| [*x, *y, z])));
        let cells = sorted(corners.map(|off| self.cell(position, off)));
        let listed = cells.iter().filter_map(|cell| self.cells.get(cell));
        let fits = |at: &usize| {
            let known = &self.known[*at];
            let other = &places[known.mesh];
            known.mesh != mesh
                && (known.is_border || own.is_border(vertex))
                && self.tolerances.iter().zip(own.poses.iter().zip(&other.poses)).all(
                    |(most, (own, other))| {
                        let (a, b) = (own[vertex as usize], other[known.vertex as usize]);
                        (0..3).all(|axis| (a[axis] - b[axis]).abs() <= *most)
                    },
                )
        };
        listed.flat_map(|list| list.iter().take(MAX_COMPARED)).copied().filter(fits).min()
    }

    fn add(&mut self, own: &Places, mesh: usize, vertex: u32) {
        let cell = self.cell(own.poses[0][vertex as usize], [0.0; 3]);
        self.cells.entry(cell).or_default().push(self.known.len());
        self.known.push(Known { mesh, vertex, is_border: own.is_border(vertex) });
    }
}

/// Merges the groups of the meshes `a` and `b`.
fn join(group: &mut [usize], a: usize, b: usize) {
    let (a, b) = (group[a], group[b]);
    group.iter_mut().filter(|own| **own == a.max(b)).for_each(|own| *own = a.min(b));
}

fn groups(group: &[usize]) -> Vec<Vec<usize>> {
    let members = |first: usize| (0..group.len()).filter(|mesh| group[*mesh] == first).collect::<Vec<_>>();
    (0..group.len()).map(members).filter(|members| !members.is_empty()).collect()
}

/// Sorts a list ascending and removes duplicates.
pub fn sorted<T: Ord>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut all: Vec<T> = all.collect();
    all.sort_unstable();
    all.dedup();
    all
}
