//! Mesh simplification by half-edge collapses. A collapse merges a point of the surface into one of its neighbours.
//! Cheap collapses are made first. Vertices are neither moved nor created, so every level uses a subset of the mesh's
//! own vertices, with their attributes. One run records every level (thesis B section 3.2, after Hoppe, "Progressive Meshes",
//! SIGGRAPH 1996).
//!
//! Vertices that share one position in every pose are grouped into one *point*. These vertices are the *wedges* of the
//! point. They differ in attributes. An edge whose two triangles use different wedges is part of a *seam*.
//!
//! # Legality
//!
//! A collapse is legal only if all of these conditions hold, whatever its cost:
//! - The link condition holds (Dey, Edelsbrunner, Guha and Nekhayev 1999), so the surface keeps its topology. Closed
//!   surfaces stay closed, and manifold surfaces stay manifold. Points where the input is not manifold are kept.
//! - No triangle's normal turns by more than 75° in any pose, and no triangle loses its area. (The limit in thesis A section
//!   4.1 is 90°, but the turns of several collapses in a row can add up to a flip.) Triangles without area in the input
//!   are not restricted.
//! - A point on a border moves only along that border.
//! - Every wedge of the point moves to a wedge with which it shares an edge. Seams therefore collapse only along
//!   themselves: no triangle leaves its texture chart, and no holes appear. At the poles of a sphere, for example,
//!   wedges are split at only one end of an edge. Such adjacent wedges count as one. If every triangle has its own
//!   vertices, nothing can collapse. Merge equal vertices of such a mesh first, or allow seams to be crossed
//!   ([`Seams::Crossed`]).
//!
//! # Parts
//!
//! A part is a connected piece of the surface. A closed part keeps at least four triangles, even if it is tiny. Unless
//! [`SimplifyOptions::prune`] is off, parts can also vanish as a whole. A part vanishes if the next collapse would cost
//! more than half of the part's distance to the other parts. The distance is measured from the part's points, and from
//! the points of neighbouring parts that vanished before. (The option `Prune` of meshoptimizer uses the radius of the
//! part instead of this distance.)
//!
//! # Several poses
//!
//! A skinned mesh is simplified for all given poses. The cost of a collapse is its largest cost in any pose. (DeCoro
//! and Rusinkiewicz, "Pose-Independent Simplification of Articulated Meshes", I3D 2005, take the sum.)
//!
//! # Order
//!
//! Collapses are approximately ordered by cost, the cheapest first. Squared costs within a quarter of an octave count
//! as equal. Among collapses of equal cost, the collapse that was found first is made first. A point's cost is
//! recomputed only when its turn comes, so a point that has become cheaper is taken late. In seven of eight steps, the
//! collapse costs at most a tenth more than the cheapest one. A point collapses into the neighbour for which the mean
//! term of [`Cost::Quadric`] is smallest. The distance terms are computed afterwards. An exact order takes longer, and
//! gave no smaller error in tests.
//!
//! The same input gives the same collapses on every machine ([`Simplified::hash`]): the code uses only `+ − × ÷` and
//! square roots, in a fixed order. The computing time grows slightly faster than the number of triangles, and linearly
//! with the number of poses. Quadrics take 88 bytes per point and pose.

mod attributes;
mod bridged;
mod marks;
mod melax;
mod neighbors;
mod parts;
mod points;
mod quadric;
mod quadrics;
mod queue;
mod reducer;
mod topology;
mod tracked_samples;
mod turned;

use std::convert::Infallible;
use std::ops::ControlFlow;

use crate::InputError;
pub use points::NO_BODY;
use points::Points;

/// A mesh to simplify, in one or several poses.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Positions of all vertices in each pose: finite, in the model's units. A rigid mesh has one pose.
    pub poses: &'a [Vec<[f32; 3]>],
    /// Three indices per triangle.
    pub indices: &'a [u32],
    /// Attributes of all vertices in the first pose: `stride` finite numbers per vertex, such as normals and texture
    /// coordinates. An attribute difference of 1 over a square area costs as much as a displacement by the square's
    /// edge length. For normals, unit vectors scaled by a tenth are a good first choice.
    pub attributes: &'a [f32],
    /// Number of attribute values per vertex; may be 0.
    pub stride: usize,
}

/// The cost function that orders collapses and limits the error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// Quadric error (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997). The
    /// cost is the root mean square distance of the neighbour from the planes of all triangles that were merged into
    /// the point. Each triangle's weight is the square root of its area, so that details count.
    ///
    /// A mean can hide a large error at one spot. The cost is therefore at least 0.35 times the point's own distance
    /// from the planes of its triangles after the collapse. On a border, the distance from the border's new edge also
    /// counts. Additional planes hold borders and seams in place (section 6 of the paper). Each of them contains an
    /// edge of the border or seam, and is perpendicular to the surface.
    ///
    /// Attributes add a cost, computed separately for each wedge (Hoppe, "New Quadric Metric for Simplifying Meshes
    /// with Appearance Attributes", Visualization 1999). With attributes, the minimum above does not apply. Instead,
    /// the larger of two terms is added to the cost: 0.63 times the point's own distance, and 1.26 times the distance
    /// between the middle of a new edge and the previous triangles.
    #[default]
    Quadric,
    /// Edge length times curvature (Melax, "A Simple, Fast, and Effective Polygon Reduction Algorithm", 1998; B
    /// equation 3.1). The curvature measures how far the normals of the point's triangles turn from the normals at the
    /// edge. This cost ignores attributes and earlier collapses, and leaves a larger error than quadrics.
    Melax {
        /// Whether to refuse a collapse between two points whose normals are more than 90° apart in the first pose (B
        /// section 3.2.3).
        ///
        /// **Decided**: a point's normal is the sum of the *unit* normals of its triangles, because thesis B's equation 3.1
        /// compares unit normals. B defines normals as cross products (3.2.3), but these would weight the triangles by
        /// area.
        check_normals: bool,
    },
}

/// Whether collapses may cross seams, where adjacent triangles use different wedges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Seams {
    /// Seams collapse only along themselves.
    #[default]
    Held,
    /// Seams may be crossed if their wedges differ only in the first `attributes` numbers of [`Surface::attributes`].
    /// Each wedge then moves to the cheapest of several vertices of the neighbour: the vertex at the common edge, and
    /// all vertices that differ from it only in these numbers. For example, if normals come before texture coordinates,
    /// `attributes: 3` allows hard edges to collapse and keeps texture seams. Crossing costs the difference of the
    /// attributes over the affected area. (In meshoptimizer, this is the option `Permissive`.)
    Crossed {
        /// Number of leading attributes that may differ, 0 to [`Surface::stride`].
        attributes: usize,
    },
    /// All seams may be crossed.
    AllCrossed,
}

/// Options of [`simplify()`]: cost function and limits. Simplification stops at the first limit that is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimplifyOptions {
    /// The cost function of collapses.
    pub cost: Cost,
    /// Whether collapses may cross seams.
    pub seams: Seams,
    /// Target number of triangles. The result may have one triangle fewer, and still fewer if a part vanishes.
    pub triangles: usize,
    /// Largest cost of a collapse, in the units of positions: at least 0, may be infinite.
    pub error: f32,
    /// Whether disconnected parts of the surface may vanish as a whole. The cost of a part has two terms. The first is
    /// half of the largest distance from its points to the other remaining parts, in the worst pose. The second is the
    /// variation of its attributes over its area. For example, a screw vanishes when its plate loses details of similar
    /// size, but a lone rock stays. One part always stays. With tens of thousands of parts, finding the parts that
    /// vanish takes longer than all collapses. The option works with [`Cost::Quadric`] only, and has no effect in
    /// [`simplify_within`].
    pub prune: bool,
}

impl Default for SimplifyOptions {
    /// Quadric cost without limits. Seams are held, and parts may vanish.
    fn default() -> Self {
        Self { cost: Cost::Quadric, seams: Seams::Held, triangles: 0, error: f32::INFINITY, prune: true }
    }
}

/// One recorded collapse: a point was merged into its neighbour, or all points of a part into one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collapse {
    /// End of the collapse's range in [`Simplified::moved`].
    end: u32,
    /// Largest cost of any collapse so far, in the units of positions. It is the cost function's estimate of the mesh's
    /// error.
    pub error: f32,
    /// After this collapse, every removed point of the mesh lies within this distance of the remaining surface, in
    /// every pose. Infinite if distances were not limited.
    pub distance: f32,
    /// Number of triangles after this collapse.
    pub triangles: u32,
}

/// The reason why simplification stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// The triangle count has reached [`SimplifyOptions::triangles`].
    Triangles,
    /// The next collapse would cost more than [`SimplifyOptions::error`].
    Error,
    /// No collapse is legal, for an unknown reason. Reducers without half-edge collapses report this instead of the
    /// reasons below.
    Exhausted,
    /// No collapse is legal: most remaining points are on seams that would break, or where several seams meet.
    /// [`Seams::Crossed`] helps.
    Seams,
    /// No collapse is legal: most remaining points are on borders that would break.
    Borders,
    /// No collapse is legal: for most remaining points, a triangle would turn by more than 75° or lose its area.
    Flips,
    /// No collapse is legal: for most remaining points, the topology would change, or the surface is not manifold there.
    Topology,
    /// No collapse is legal: for most remaining points, a removed point would end up farther from the surface than
    /// [`simplify_within`] allows.
    Distance,
}

impl Stopped {
    /// Name of the reason in reports, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::Error => "error",
            Self::Exhausted => "exhausted",
            Self::Seams => "seams",
            Self::Borders => "borders",
            Self::Flips => "flips",
            Self::Topology => "topology",
            Self::Distance => "distance",
        }
    }
}

/// A recorded sequence of collapses. It describes every level of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Simplified {
    collapses: Vec<Collapse>,
    moved: Vec<[u32; 2]>,
    points: Vec<u32>,
    triangles: usize,
    stopped: Stopped,
}

impl Simplified {
    /// All collapses, in the order in which they happened. Their errors never decrease.
    pub fn collapses(&self) -> &[Collapse] {
        &self.collapses
    }

    /// The vertices that one collapse removed, each with its replacement; at least one pair.
    ///
    /// # Panics
    /// If there is no collapse with this number.
    pub fn moved(&self, collapse: usize) -> &[[u32; 2]] {
        let start = collapse.checked_sub(1).map_or(0, |before| self.collapses[before].end);
        &self.moved[start as usize..self.collapses[collapse].end as usize]
    }

    /// Number of triangles after the last collapse.
    pub fn triangles_left(&self) -> usize {
        self.collapses.last().map_or(self.triangles, |last| last.triangles as usize)
    }

    /// Largest cost of any collapse, in the units of positions; 0 if there was none.
    pub fn error(&self) -> f32 {
        self.collapses.last().map_or(0.0, |last| last.error)
    }

    /// The reason why simplification stopped.
    pub fn stopped(&self) -> Stopped {
        self.stopped
    }

    /// Smallest number of collapses after which at most `triangles` triangles are left. If this is never reached, the
    /// number of all collapses.
    pub fn collapses_to(&self, triangles: usize) -> usize {
        if self.triangles <= triangles {
            return 0;
        }
        let above = self.collapses.partition_point(|collapse| collapse.triangles as usize > triangles);
        (above + 1).min(self.collapses.len())
    }

    /// Number of leading collapses with a cost of at most `error`.
    pub fn collapses_within(&self, error: f32) -> usize {
        self.collapses.partition_point(|collapse| collapse.error <= error)
    }

    /// Number of leading collapses that keep every removed point within `distance` of the remaining surface; see
    /// [`simplify_within`].
    pub fn collapses_near(&self, distance: f32) -> usize {
        self.collapses.partition_point(|collapse| collapse.distance <= distance)
    }

    /// Index of the point to which a vertex belongs. Vertices that share their position in every pose have the same
    /// index.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[doc(hidden)]
    pub fn point(&self, vertex: u32) -> u32 {
        self.points[vertex as usize]
    }

    /// Whether three vertices belong to three different points.
    pub fn are_apart(&self, vertices: [u32; 3]) -> bool {
        let [a, b, c] = vertices;
        let [a, b, c] = [self.point(a), self.point(b), self.point(c)];
        a != b && b != c && c != a
    }

    /// SHA-256 of the sequence of collapses, in hexadecimal digits, the same on every machine. For each collapse, the
    /// hash covers the number of triangles, the bits of error and distance, and the removed vertices with their
    /// replacements.
    pub fn hash(&self) -> String {
        let mut words = vec![self.points.len() as u32, self.triangles as u32];
        for (at, collapse) in self.collapses.iter().enumerate() {
            words.extend([collapse.triangles, collapse.error.to_bits(), collapse.distance.to_bits()]);
            words.extend(self.moved(at).as_flattened());
        }
        crate::hash::sha256(&words)
    }

    /// For each vertex, its replacement after the first `collapses` collapses. A vertex that is not removed is its own
    /// replacement.
    ///
    /// # Panics
    /// If the sequence has fewer collapses.
    pub fn remap(&self, collapses: usize) -> Vec<u32> {
        let mut remap: Vec<u32> = (0..self.points.len() as u32).collect();
        let end = collapses.checked_sub(1).map_or(0, |last| self.collapses[last].end);
        // In reverse order, the final replacement of `to` is already known.
        for &[from, to] in self.moved[..end as usize].iter().rev() {
            remap[from as usize] = remap[to as usize];
        }
        remap
    }

    /// The triangles left after the first `collapses` collapses, in the mesh's order. Triangles remain if their corners
    /// are still three different points. `indices` are the mesh's triangles.
    ///
    /// # Panics
    /// If the sequence has fewer collapses, or if the indices belong to another mesh.
    pub fn triangles(&self, indices: &[u32], collapses: usize) -> Vec<u32> {
        let remap = self.remap(collapses);
        let mut left = Vec::new();
        for &[a, b, c] in indices.as_chunks().0 {
            let triangle = [remap[a as usize], remap[b as usize], remap[c as usize]];
            if self.are_apart(triangle) {
                left.extend(triangle);
            }
        }
        left
    }
}

/// Simplifies a mesh until a limit of `options` is reached, and records every collapse.
///
/// ```
/// use relievo::ops::mesh::{SimplifyOptions, Stopped, Surface, simplify};
///
/// // A square of four triangles around its middle.
/// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
/// let indices = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
/// let surface = Surface { poses: &[positions], indices: &indices, attributes: &[], stride: 0 };
/// let simplified = simplify(&surface, &SimplifyOptions { error: 0.01, ..SimplifyOptions::default() })?;
/// assert_eq!(simplified.triangles(&indices, 1).len(), 2 * 3);
/// assert_eq!((simplified.error(), simplified.stopped()), (0.0, Stopped::Error));
/// # Ok::<(), relievo::InputError>(())
/// ```
///
/// # Errors
/// [`InputError`] in these cases: there is no pose, or poses differ in length; indices are out of range or not three
/// per triangle; there are not `stride` attributes per vertex; a number is not finite; the error limit is negative or
/// NaN; [`Seams::Crossed`] names more than `stride` attributes.
pub fn simplify(surface: &Surface<'_>, options: &SimplifyOptions) -> Result<Simplified, InputError> {
    simplify_within(surface, options, &[f32::INFINITY])
}

/// Simplifies a mesh as far as possible within each of `distances` in turn. Every removed point stays within the
/// current distance of the remaining surface, in every pose. For each removed point, the same triangle is within this
/// distance in all poses. Parts do not vanish as a whole.
///
/// These distances are measured, whereas [`SimplifyOptions::error`] limits an average. At the same number of triangles,
/// [`simplify()`] gives the smaller average error, and this function the smaller maximum. It takes a few times longer.
///
/// # Errors
/// The errors of [`simplify()`]; also [`InputError`] for distances that are negative or that decrease.
pub fn simplify_within(
    surface: &Surface<'_>,
    options: &SimplifyOptions,
    distances: &[f32],
) -> Result<Simplified, InputError> {
    let mut watch = |_| ControlFlow::<Infallible>::Continue(());
    let groups = Groups::default();
    let ControlFlow::Continue(found) = simplify_watched(surface, options, distances, &groups, &mut watch)?;
    Ok(found)
}

/// Groups of vertices and triangles that simplification respects.
#[derive(Debug, Clone, Copy, Default)]
#[doc(hidden)]
pub struct Groups<'a> {
    /// Rigid body of each vertex, or [`NO_BODY`]; empty if there are no bodies. Vertices of one body keep their
    /// distances from each other in every pose.
    pub bodies: &'a [u32],
    /// Mesh of each triangle; empty if all triangles belong to one mesh. A mesh keeps at least one triangle at every
    /// remaining point that its triangles touch. Otherwise a narrow piece of a mesh could vanish between neighbouring
    /// meshes, although all other triangles of its mesh are far away.
    pub meshes: &'a [u32],
}

/// As [`simplify_within`], with groups and progress reports. `watch` is called repeatedly with the fraction of
/// triangles removed so far. It can stop the simplification by returning `Break`.
///
/// # Errors
/// The same errors as [`simplify_within`].
#[doc(hidden)]
pub fn simplify_watched<B>(
    surface: &Surface<'_>,
    options: &SimplifyOptions,
    distances: &[f32],
    groups: &Groups<'_>,
    watch: &mut dyn FnMut(f64) -> ControlFlow<B>,
) -> Result<ControlFlow<B, Simplified>, InputError> {
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
    if let Seams::Crossed { attributes } = options.seams
        && attributes > surface.stride
    {
        let bound = format!("must be at most {}, the stride", surface.stride);
        return Err(InputError::new("seams.attributes", attributes, bound));
    }
    Ok(reducer::reduce(surface, options, distances, groups, watch))
}

/// For each vertex, the index of its point. Vertices with the same position in every pose share a point. Points are
/// numbered in the order of their first vertices.
pub fn weld(poses: &[Vec<[f32; 3]>]) -> Vec<u32> {
    Points::new(poses).into_of()
}

/// Checks a surface before simplification. Every reducer calls this first.
///
/// # Errors
/// [`InputError`] that names the list and the index of the first fault.
pub fn validate(surface: &Surface<'_>) -> Result<(), InputError> {
    let Some(first) = surface.poses.first() else {
        return Err(InputError::new("poses.len", 0, "must be at least 1"));
    };
    let vertices = first.len();
    let most = u32::MAX as usize;
    for (field, len) in [("poses[0].len", vertices), ("indices.len", surface.indices.len())] {
        InputError::check_below(field, len, most)?;
    }
    for (pose, positions) in surface.poses.iter().enumerate() {
        let path = format!("poses[{pose}].len");
        InputError::check_same(path, positions.len(), vertices, "as of the first pose")?;
        finite(&format!("poses[{pose}]"), positions.as_flattened(), 3)?;
    }
    crate::asset::indices::check_triangles("indices", surface.indices, vertices)?;
    if vertices.checked_mul(surface.stride) != Some(surface.attributes.len()) {
        let bound = format!("must be {vertices} vertices × {}", surface.stride);
        return Err(InputError::new("attributes.len", surface.attributes.len(), bound));
    }
    finite("attributes", surface.attributes, surface.stride)
}

/// Refuses numbers that are not finite. The error names the vertex of the first such number.
fn finite(field: &str, numbers: &[f32], stride: usize) -> Result<(), InputError> {
    match numbers.iter().position(|number| !number.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let field = format!("{field}[{}][{}]", at / stride, at % stride);
            Err(InputError::new(field, numbers[at], "must be finite"))
        }
    }
}
