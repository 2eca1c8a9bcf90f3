//! Mesh simplification by half-edge collapses. A point of the surface is merged into one of its neighbours, again and again,
//! the cheapest collapse first. Vertices are neither moved nor created, so that every level uses a subset of the mesh's own
//! vertices, whatever their attributes. One run records every level (B section 3.2, after Hoppe, "Progressive Meshes", SIGGRAPH
//! 1996).
//!
//! Vertices that share one position in every pose are the *wedges* of one *point*: copies that differ in attributes. An edge
//! whose two triangles use different wedges is part of a *seam*.
//!
//! # Legality
//!
//! A collapse is legal only if all of the following hold, whatever its cost:
//! - The link condition holds (Dey, Edelsbrunner, Guha and Nekhayev 1999): the surface keeps its topology. Closed surfaces stay
//!   closed and manifold surfaces stay manifold. Points where the input is not manifold are kept.
//! - No triangle's normal turns by more than 75° in any pose, and no triangle loses its area. (A section 4.1 has 90°, which
//!   several collapses in a row may add up to.) Triangles without area in the input are not restricted.
//! - A point of a border moves only along that border.
//! - Every wedge of the point becomes a wedge with which it shares an edge. Seams therefore collapse only along themselves: no
//!   triangle leaves its chart of the texture, and no holes appear. Where wedges are split at one end of an edge only, as at
//!   the poles of a sphere, adjacent wedges count as one. If every triangle has vertices of its own, nothing can collapse:
//!   index such meshes first, or let seams be crossed ([`Seams::Crossed`]).
//!
//! # Parts
//!
//! A closed part keeps four triangles, however small it is. Unless [`SimplifyOptions::prune`] is off, parts vanish as a whole. A part
//! vanishes when the next collapse would cost more than half of its distance to the other parts. That distance is taken over
//! its points, and over the points of neighbouring parts that vanished before. (meshoptimizer's option `Prune` compares the
//! radius of a part.)
//!
//! # Several poses
//!
//! A skinned mesh is simplified for all given poses: the cost of a collapse is its largest cost in any of them (after DeCoro
//! and Rusinkiewicz, "Pose-Independent Simplification of Articulated Meshes", I3D 2005, who take the sum).
//!
//! # Order
//!
//! Collapses are approximately ordered by cost, the cheapest first. Costs whose squares lie in one quarter of an octave count
//! as equal, and are taken in the order in which they were found. A point's cost is recomputed only when its turn comes, so a
//! point that has become cheaper since then comes late. In seven of eight steps the cost is within a tenth of the smallest of
//! any point. A point goes to the neighbour that is cheapest by the mean term of [`Cost::Quadric`]; the other term is computed
//! afterwards. An exact order takes longer, and gave no smaller error where it was tried.
//!
//! The same input gives the same collapses on every machine ([`Simplified::hash`]): the code uses only `+ − × ÷` and square
//! roots, in a fixed order. Time grows a little faster than the number of triangles, and linearly with poses. Quadrics take 88
//! bytes per point and pose.

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
pub(crate) use points::NO_BODY;
use points::Points;

/// The mesh to simplify.
#[derive(Debug, Clone, Copy)]
pub struct Surface<'a> {
    /// Positions of all vertices in each pose, in the model's units, finite. A rigid mesh has one pose.
    pub poses: &'a [Vec<[f32; 3]>],
    /// Three indices per triangle.
    pub indices: &'a [u32],
    /// Attributes of each vertex: `stride` numbers (normals, texture coordinates, …), finite, in the first pose. An attribute
    /// difference of 1 over a square counts as much as a distance equal to the square's edge. A tenth of a unit normal is a
    /// good start.
    pub attributes: &'a [f32],
    /// Number of attribute values per vertex; may be 0.
    pub stride: usize,
}

/// The cost function of collapses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cost {
    /// Quadric error (Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH 1997): the root mean
    /// square distance from the planes of all triangles that were merged into the point. The weight of a triangle is the square
    /// root of its area, so that details count.
    ///
    /// A mean hides a single spot. The cost is therefore at least 0.35 of the point's own distance from the planes of its
    /// triangles after the collapse; on a border, also of its distance from the border's new edge. Planes perpendicular to
    /// borders and seams hold these in place (their section 6).
    ///
    /// Attributes add a cost of their own, separately for each wedge (Hoppe, "New Quadric Metric for Simplifying Meshes with
    /// Appearance Attributes", Visualization 1999). With attributes, the larger of two distances is added to that cost: 0.63 of
    /// the point's own distance, and 1.26 of the distance between the middle of a new edge and the triangles before.
    #[default]
    Quadric,
    /// Edge length times curvature (Melax, "A Simple, Fast, and Effective Polygon Reduction Algorithm", 1998; B equation 3.1).
    /// The curvature is a measure of how far the normals of the point's triangles turn from those at the edge. It ignores
    /// attributes and earlier collapses, and leaves a larger error than quadrics.
    Melax {
        /// Whether to refuse a collapse where the normals of the two points are more than 90° apart in the
        /// first pose (B section 3.2.3).
        ///
        /// **Decided**: a point's normal is the sum of its triangles' *unit* normals, which B's equation 3.1 compares. B
        /// defines them as cross products (3.2.3), which would weight them by area.
        check_normals: bool,
    },
}

/// Treatment of seams.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Seams {
    /// Seams collapse only along themselves.
    #[default]
    Held,
    /// Some seams may be crossed: seams between wedges that differ only in the first `attributes` numbers of
    /// [`Surface::attributes`]. Each wedge becomes the cheapest vertex of the neighbour that agrees with it in the other
    /// numbers. For example, if texture coordinates follow the normals, `attributes: 3` lets hard edges of normals collapse and
    /// holds texture seams. Crossing costs the difference of the attributes over the affected area. (meshoptimizer's option
    /// `Permissive`.)
    Crossed {
        /// Number of leading attribute values, 0 to [`Surface::stride`].
        attributes: usize,
    },
    /// All seams may be crossed.
    AllCrossed,
}

/// Cost function and limits. Simplification stops at the first limit that is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SimplifyOptions {
    /// The cost function of collapses.
    pub cost: Cost,
    /// Treatment of seams.
    pub seams: Seams,
    /// Target number of triangles. The result may have one less, or fewer where a part vanishes.
    pub triangles: usize,
    /// Largest cost of a collapse, in units of positions; at least 0, may be infinite.
    pub error: f32,
    /// Whether parts that no triangle connects to the rest may vanish as a whole. The cost of a part is half of the largest
    /// distance from its points to the remaining other parts, in the worst pose. The variation of its attributes over its area
    /// is added. A screw thus vanishes with the details of its plate, and a lone rock stays. One part always stays. With tens
    /// of thousands of parts, this search takes longer than all collapses. It has an effect with [`Cost::Quadric`] only, and
    /// not where distances are limited ([`simplify_within`]).
    pub prune: bool,
}

impl Default for SimplifyOptions {
    /// Quadrics without limits; seams are held, parts may vanish.
    fn default() -> Self {
        Self { cost: Cost::Quadric, seams: Seams::Held, triangles: 0, error: f32::INFINITY, prune: true }
    }
}

/// One collapse: a point was merged into its neighbour, or all points of a part into one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Collapse {
    /// End of this collapse's range in [`Simplified::moved`].
    end: u32,
    /// Largest cost of any collapse so far, in units of positions: the error of the mesh as the cost function estimates it.
    pub error: f32,
    /// Distance within which every removed point of the mesh lies from the remaining surface after this collapse, in every
    /// pose. Infinite if distances were not limited.
    pub distance: f32,
    /// Number of triangles after this collapse.
    pub triangles: u32,
}

/// Why simplification stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stopped {
    /// At most [`SimplifyOptions::triangles`] are left.
    Triangles,
    /// The next collapse costs more than [`SimplifyOptions::error`].
    Error,
    /// No collapse is legal. Reducers other than half-edge collapses give no closer reason.
    Exhausted,
    /// No collapse is legal, as for all variants below. Most remaining points are on seams that would be broken, or where
    /// several seams meet. [`Seams::Crossed`] helps.
    Seams,
    /// Most remaining points are on borders that would be broken.
    Borders,
    /// Most remaining points would turn a triangle by more than 75°, or take its area away.
    Flips,
    /// Most remaining points would change the topology, or are where the surface is not manifold.
    Topology,
    /// Most remaining points would bring a point of the mesh further away than [`simplify_within`] allows.
    Distance,
}

impl Stopped {
    /// Name in reports.
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
    /// Collapses in the order in which they happened; errors never decrease.
    pub fn collapses(&self) -> &[Collapse] {
        &self.collapses
    }

    /// Pairs of a removed vertex and its replacement, for one collapse; at least one pair.
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

    /// Largest cost of any collapse; 0 if there was none.
    pub fn error(&self) -> f32 {
        self.collapses.last().map_or(0.0, |last| last.error)
    }

    /// Why simplification stopped.
    pub fn stopped(&self) -> Stopped {
        self.stopped
    }

    /// Number of leading collapses after which at most `triangles` triangles are left; all collapses if that is never reached.
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

    /// Number of leading collapses after which every removed point is within `distance` of the remaining surface; see
    /// [`simplify_within`].
    pub fn collapses_near(&self, distance: f32) -> usize {
        self.collapses.partition_point(|collapse| collapse.distance <= distance)
    }

    /// Point of a vertex: the same number for all wedges at one position.
    ///
    /// # Panics
    /// If there is no such vertex.
    pub(crate) fn point(&self, vertex: u32) -> u32 {
        self.points[vertex as usize]
    }

    /// Whether three vertices belong to three different points.
    pub fn are_apart(&self, vertices: [u32; 3]) -> bool {
        let [a, b, c] = vertices;
        let [a, b, c] = [self.point(a), self.point(b), self.point(c)];
        a != b && b != c && c != a
    }

    /// SHA-256 of the sequence, in hexadecimal digits. For each collapse it covers the number of triangles, the bits of error
    /// and distance, and the vertices with their replacements. It is the same on every machine.
    pub fn hash(&self) -> String {
        let mut words = vec![self.points.len() as u32, self.triangles as u32];
        for (at, collapse) in self.collapses.iter().enumerate() {
            words.extend([collapse.triangles, collapse.error.to_bits(), collapse.distance.to_bits()]);
            words.extend(self.moved(at).as_flattened());
        }
        crate::hash::sha256(&words)
    }

    /// For each vertex, its replacement after the first `collapses` collapses; itself if it is not removed.
    ///
    /// # Panics
    /// If there are fewer collapses.
    pub fn remap(&self, collapses: usize) -> Vec<u32> {
        let mut remap: Vec<u32> = (0..self.points.len() as u32).collect();
        let end = collapses.checked_sub(1).map_or(0, |last| self.collapses[last].end);
        // In reverse order, the final replacement of `to` is already known.
        for &[from, to] in self.moved[..end as usize].iter().rev() {
            remap[from as usize] = remap[to as usize];
        }
        remap
    }

    /// Triangles that are left after the first `collapses` collapses, in the mesh's order: those whose corners are still three
    /// different points. `indices` are the mesh's own.
    ///
    /// # Panics
    /// If there are fewer collapses, or if the indices belong to another mesh.
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
/// [`InputError`] for no pose, poses of different lengths, indices that are out of range or not three per
/// triangle, attributes that are not `stride` per vertex, numbers that are not finite, an error that is
/// negative or NaN, and [`Seams::Crossed`] of more attributes than there are.
pub fn simplify(surface: &Surface<'_>, options: &SimplifyOptions) -> Result<Simplified, InputError> {
    simplify_within(surface, options, &[f32::INFINITY])
}

/// Simplifies a mesh as far as possible within each of `distances` in turn. Every removed point stays within the current
/// distance of the remaining surface, in every pose. Each removed point is close to one triangle, the same in all poses. No
/// part vanishes.
///
/// These distances are measured, whereas [`SimplifyOptions::error`] is an average. At the same number of triangles, [`simplify()`] has
/// the smaller average error, and this function the smaller maximum. It takes a few times longer.
///
/// # Errors
/// As [`simplify()`], and [`InputError`] for distances that are negative or that decrease.
pub fn simplify_within(
    surface: &Surface<'_>,
    options: &SimplifyOptions,
    distances: &[f32],
) -> Result<Simplified, InputError> {
    let mut watch = |_| ControlFlow::<Infallible>::Continue(());
    let ControlFlow::Continue(found) = simplify_watched(surface, options, distances, &[], &mut watch)?;
    Ok(found)
}

/// As [`simplify_within`], with rigid bodies and progress. `bodies` has the rigid body of each vertex or [`NO_BODY`]; it may be
/// empty. Vertices of one body have the same distances from each other in every pose. `watch` is called repeatedly with the
/// fraction of the triangles that is removed, and may break.
///
/// # Errors
/// As [`simplify_within`].
pub(crate) fn simplify_watched<B>(
    surface: &Surface<'_>,
    options: &SimplifyOptions,
    distances: &[f32],
    bodies: &[u32],
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
    Ok(reducer::reduce(surface, options, distances, bodies, watch))
}

/// Point of each vertex: a number per position, in the order of the points' first vertices.
pub fn weld(poses: &[Vec<[f32; 3]>]) -> Vec<u32> {
    Points::new(poses).into_of()
}

/// Checks a surface. Every reducer calls it first.
///
/// # Errors
/// [`InputError`] that names the list and the index.
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

/// Refuses numbers that are not finite; the error names the first one's vertex.
fn finite(field: &str, numbers: &[f32], stride: usize) -> Result<(), InputError> {
    match numbers.iter().position(|number| !number.is_finite()) {
        None => Ok(()),
        Some(at) => {
            let field = format!("{field}[{}][{}]", at / stride, at % stride);
            Err(InputError::new(field, numbers[at], "must be finite"))
        }
    }
}
