//! Simplification by half-edge collapses: a point of the surface becomes one of its neighbours, again and again, the
//! cheapest first. Vertices are never moved or made, so that every level uses some of the mesh's own, whatever their
//! attributes, and one run records every level (B section 3.2, after Hoppe, "Progressive Meshes", SIGGRAPH 1996).
//!
//! Vertices at one place in every pose are the *wedges* of one *point*: copies that differ in attributes. Where the two
//! triangles of an edge use different wedges runs a *seam*.
//!
//! # Legality
//!
//! Whatever the cost:
//! - The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999): the surface keeps its topology. What is closed
//!   stays closed, what is manifold stays manifold. Points where the input is not manifold stay.
//! - No triangle's normal turns by more than 90° in any pose (A section 4.1), nor does a triangle lose its area; those
//!   without area may do anything.
//! - Points of a border move along it alone.
//! - Every wedge of a point becomes a wedge that it shares an edge with, so seams collapse only along themselves: no
//!   triangle leaves its chart, and there are no holes. Where wedges are split at one end of an edge alone, as at the
//!   poles of a sphere, those beside each other count as one. So where every triangle has vertices of its own nothing
//!   collapses: such meshes want to be indexed first.
//!
//! # Several poses
//!
//! A skinned mesh is simplified for all poses that count: a collapse costs what it costs in the worst of them (after
//! DeCoro and Rusinkiewicz, "Pose-Independent Simplification of Articulated Meshes", I3D 2005, who take the sum).
//!
//! The same input gives the same collapses on every machine: only `+ − × ÷` and square roots, in a fixed order, and
//! ties go to the lower index. Time grows as n log n in triangles, and in proportion to poses. Quadrics take 88 bytes a
//! point and pose.

mod attributes;
mod melax;
mod neighbors;
mod points;
mod quadric;
mod quadrics;
mod queue;
mod reducer;
mod topology;
mod tracked_samples;
mod turned;

use crate::InputError;
use points::Points;
use topology::Topology;

/// What is simplified.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// The places of all vertices in each of the poses that count; a rigid mesh has one. Finite.
    pub poses: &'a [Vec<[f32; 3]>],
    /// Three a triangle.
    pub indices: &'a [u32],
    /// `stride` numbers a vertex (normals, texture coordinates, …), each scaled so that 1 counts as much as a distance
    /// of 1. Finite. They belong to the first pose.
    pub attributes: &'a [f32],
    /// May be 0.
    pub stride: usize,
}

/// What a collapse costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// The root mean square distance from the planes of all triangles that the point has stood for (Garland and
    /// Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997), weighted by area; borders and
    /// seams are held by planes across them (their section 6). Attributes add their own (Hoppe, "New Quadric Metric for
    /// Simplifying Meshes with Appearance Attributes", Visualization 1999), each wedge for itself.
    #[default]
    Quadric,
    /// Length of the edge × how far the normals of the point's triangles are from those at the edge (Melax, "A Simple,
    /// Fast, and Effective Polygon Reduction Algorithm", 1998; B equation 3.1). Knows no attributes and remembers
    /// nothing: leaves more error than quadrics.
    Melax {
        /// Refuse a collapse where the normals of the two points, in the first pose, are more than 90° apart (B section
        /// 3.2.3).
        check_normals: bool,
    },
}

/// What to do, and when to stop: whatever comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// What a collapse costs.
    pub cost: Cost,
    /// Stop at so many triangles, or one below.
    pub triangles: usize,
    /// Stop before a collapse costs more; units of positions, at least 0, may be infinite.
    pub error: f32,
}

impl Default for Options {
    /// Quadrics, as far as it goes.
    fn default() -> Self {
        Self { cost: Cost::Quadric, triangles: 0, error: f32::INFINITY }
    }
}

/// A point became its neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collapse {
    /// Where its part of [`Simplified::moved`] ends.
    end: u32,
    /// The most that a collapse has cost so far, in units of positions: what the mesh is off by, as the cost sees it.
    pub error: f32,
    /// No point of the mesh that is gone was further from what is left than this after it, in any pose; infinite where
    /// that was not limited.
    pub distance: f32,
    /// Triangles left after it.
    pub triangles: u32,
}

/// Why it went no further.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// [`Options::triangles`] are left.
    Triangles,
    /// The next collapse costs more than [`Options::error`].
    Error,
    /// No collapse is legal.
    Exhausted,
}

/// Every level of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    collapses: Vec<Collapse>,
    moved: Vec<[u32; 2]>,
    points: Vec<u32>,
    triangles: usize,
    stopped: Stopped,
}

impl Simplified {
    /// In the order in which they happened; errors do not descend.
    pub fn collapses(&self) -> &[Collapse] {
        &self.collapses
    }

    /// Every vertex that went in a collapse, and the vertex that it became; there is one vertex at least.
    ///
    /// # Panics
    /// Without such a collapse.
    pub fn moved(&self, collapse: usize) -> &[[u32; 2]] {
        let start = collapse.checked_sub(1).map_or(0, |before| self.collapses[before].end);
        &self.moved[start as usize..self.collapses[collapse].end as usize]
    }

    /// Triangles left after the last collapse.
    pub fn triangles_left(&self) -> usize {
        self.collapses.last().map_or(self.triangles, |last| last.triangles as usize)
    }

    /// The most that a collapse has cost; 0 where there was none.
    pub fn error(&self) -> f32 {
        self.collapses.last().map_or(0.0, |last| last.error)
    }

    /// Why it went no further.
    pub fn stopped(&self) -> Stopped {
        self.stopped
    }

    /// How many collapses leave at most so many triangles; all of them, where none does.
    pub fn collapses_to(&self, triangles: usize) -> usize {
        if self.triangles <= triangles {
            return 0;
        }
        let above = self.collapses.partition_point(|collapse| collapse.triangles as usize > triangles);
        (above + 1).min(self.collapses.len())
    }

    /// How many collapses cost at most so much.
    pub fn collapses_within(&self, error: f32) -> usize {
        self.collapses.partition_point(|collapse| collapse.error <= error)
    }

    /// How many collapses leave no place further from what is left than this: see [`simplify_within`].
    pub fn collapses_near(&self, distance: f32) -> usize {
        self.collapses.partition_point(|collapse| collapse.distance <= distance)
    }

    /// The point that a vertex is a wedge of: the same number for all wedges at a place.
    ///
    /// # Panics
    /// For a vertex that there is not.
    pub fn point(&self, vertex: u32) -> u32 {
        self.points[vertex as usize]
    }

    /// Whether three vertices are of three points.
    pub(crate) fn are_apart(&self, vertices: [u32; 3]) -> bool {
        let [a, b, c] = vertices.map(|vertex| self.point(vertex));
        a != b && b != c && c != a
    }

    /// What each vertex is after so many collapses: itself, or what it became.
    ///
    /// # Panics
    /// Beyond the number of collapses.
    pub fn remap(&self, collapses: usize) -> Vec<u32> {
        let mut remap: Vec<u32> = (0..self.points.len() as u32).collect();
        let end = collapses.checked_sub(1).map_or(0, |last| self.collapses[last].end);
        // The last first: what a vertex became has found its own heir by then.
        for &[from, to] in self.moved[..end as usize].iter().rev() {
            remap[from as usize] = remap[to as usize];
        }
        remap
    }

    /// The triangles after so many collapses, in the mesh's order: those left that have three different points.
    /// `indices` are those of the mesh.
    ///
    /// # Panics
    /// Beyond the number of collapses, and for indices of another mesh.
    pub fn triangles(&self, indices: &[u32], collapses: usize) -> Vec<u32> {
        let remap = self.remap(collapses);
        let mut left = Vec::new();
        for triangle in indices.chunks_exact(3) {
            let remap = [0, 1, 2].map(|corner| remap[triangle[corner] as usize]);
            if self.are_apart(remap) {
                left.extend(remap);
            }
        }
        left
    }
}

/// Simplifies a mesh as far as the options say, and records how.
///
/// ```
/// use relievo::mesh::{Options, Stopped, Surface, simplify};
///
/// // A square of four triangles around its middle.
/// let places = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
/// let indices = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
/// let surface = Surface { poses: &[places], indices: &indices, attributes: &[], stride: 0 };
/// let simplified = simplify(&surface, &Options { error: 0.01, ..Options::default() })?;
/// assert_eq!(simplified.triangles(&indices, 1).len(), 2 * 3);
/// assert_eq!((simplified.error(), simplified.stopped()), (0.0, Stopped::Error));
/// # Ok::<(), relievo::InputError>(())
/// ```
///
/// # Errors
/// [`InputError`] for no pose, poses of different lengths, indices that are not three a triangle or out of range,
/// attributes that are not `stride` a vertex, numbers that are not finite, and an error below 0 or not a number.
pub fn simplify(surface: &Surface<'_>, options: &Options) -> Result<Simplified, InputError> {
    simplify_within(surface, options, &[f32::INFINITY])
}

/// Simplifies a mesh as far as can be with every point that is gone within a distance of what is left, in every pose;
/// then, from there on, within the next distance, and so on. Each point is near one and the same triangle in all poses.
/// That is measured, where [`Options::error`] is an average: of as many triangles, those have less of an average error,
/// these less of a largest one. Takes a few times longer.
///
/// # Errors
/// As [`simplify()`]; for distances that are below 0 or descend.
pub fn simplify_within(
    surface: &Surface<'_>,
    options: &Options,
    distances: &[f32],
) -> Result<Simplified, InputError> {
    validate(surface)?;
    let mut least = 0.0;
    for (at, distance) in distances.iter().enumerate() {
        if !(least..=f32::INFINITY).contains(distance) {
            let bound = format!("must be at least {least}");
            return Err(InputError::new(format!("distances[{at}]"), distance, bound));
        }
        least = *distance;
    }
    if options.error.is_nan() || options.error < 0.0 {
        return Err(InputError::new("error", options.error, "must be at least 0"));
    }
    let points = Points::new(surface.poses);
    let topology = Topology::new(&points, surface.indices);
    Ok(reducer::reduce(surface, points, topology, options, distances))
}

/// The point of each vertex, numbered by their first vertices: see [`Simplified::point`].
pub(crate) fn weld(poses: &[Vec<[f32; 3]>]) -> Vec<u32> {
    Points::new(poses).into_of()
}

fn validate(surface: &Surface<'_>) -> Result<(), InputError> {
    let Some(first) = surface.poses.first() else {
        return Err(InputError::new("poses.len", 0, "must be at least 1"));
    };
    let vertices = first.len();
    let most = u32::MAX as usize;
    for (field, len) in [("poses[0].len", vertices), ("indices.len", surface.indices.len())] {
        if len >= most {
            return Err(InputError::new(field, len, format!("must be below {most}")));
        }
    }
    for (pose, places) in surface.poses.iter().enumerate() {
        if places.len() != vertices {
            let bound = format!("must be {vertices}, as of the first pose");
            return Err(InputError::new(format!("poses[{pose}].len"), places.len(), bound));
        }
        finite(&format!("poses[{pose}]"), places.as_flattened(), 3)?;
    }
    crate::asset::indices::check_triangles("indices", surface.indices, vertices)?;
    if vertices.checked_mul(surface.stride) != Some(surface.attributes.len()) {
        let bound = format!("must be {vertices} vertices × {}", surface.stride);
        return Err(InputError::new("attributes.len", surface.attributes.len(), bound));
    }
    finite("attributes", surface.attributes, surface.stride)
}

/// Refuses what is not finite among the numbers of each vertex.
fn finite(field: &str, numbers: &[f32], stride: usize) -> Result<(), InputError> {
    match numbers.iter().position(|number| !number.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let field = format!("{field}[{}][{}]", at / stride, at % stride);
            Err(InputError::new(field, numbers[at], "must be finite"))
        }
    }
}
