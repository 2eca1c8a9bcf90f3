//! All reducers behind one interface, for comparison (A sections 4 and 5): the same surface with fewer triangles, whatever the
//! operator is.
//!
//! [`simplify()`](relievo::ops::mesh::simplify()) is what most programs want: it records every level in one run. Other operators
//! place new vertices, join separate parts or remove what is small. Triangle collapse and the merging of polygons, which A
//! describes too, are sequences of edge collapses and of vertex removals.
//!
//! | reducer | vertices | topology | triangles | seams and attributes | error |
//! |---|---|---|---|---|---|
//! | [`HalfEdge`](Reducer::HalfEdge) | the mesh's own | stays; parts may vanish | no step turns one | seams stay, or are crossed | estimated mean, or Melax's cost |
//! | [`FullEdge`](Reducer::FullEdge) | new ones | stays | no step turns one | seams stay; interpolated | estimated mean |
//! | [`VertexPair`](Reducer::VertexPair) | new ones | may change | no step turns one | wedges stay apart; interpolated | estimated mean |
//! | [`UniformClustering`](Reducer::UniformClustering) | new ones | may change | may turn | may be lost in a cell | largest distance of a vertex from the one that stands for it |
//! | [`ImportanceClustering`](Reducer::ImportanceClustering) | the mesh's own | may change | may turn | may be lost in a cell | as above |
//! | [`VertexRemoval`](Reducer::VertexRemoval) | the mesh's own | stays | new ones face as the average plane of the hole | seams stay | largest distance of a vertex from the average plane when it went |
//!
//! Where topology stays, closed surfaces stay closed, unless they vanish as a whole, manifold ones stay manifold, and points
//! where the input is not manifold are kept. Where it may change, a closed surface stays closed in a weaker sense: each edge
//! has as many triangles on one side as on the other. All drop triangles of which two corners are at one place.
//!
//! Every reducer gives the same result on every machine: the code uses only `+ − × ÷` and square roots, in a fixed order, and
//! ties go to the lower index.

pub use model::{Normals, ReducedModel, reduce_model};
pub use reduced::Reduced;

use std::str::FromStr;

use crate::reduce::cluster::MAX_CELLS;
use contract::{Contraction, Pairs};
use importance::Graded;
use relievo::InputError;
use relievo::ops::mesh::simplify::{Cost, Seams, Surface, validate};
use removal::Removal;

pub mod cluster;
mod contract;
mod half_edge;
mod importance;
mod mesh;
mod model;
mod plane_quadric;
mod reduced;
mod removal;
mod steps;
mod uniform;

/// The operator that takes triangles away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reducer {
    /// Merges points into their neighbours: [`simplify()`](relievo::ops::mesh::simplify()), whose legality holds. Poses count as
    /// they do there.
    HalfEdge {
        /// The cost function of collapses.
        cost: Cost,
        /// Whether collapses may cross seams.
        seams: Seams,
    },
    /// Contracts edges to the place that is best for the planes of both ends (Garland and Heckbert, "Surface Simplification
    /// Using Quadric Error Metrics", SIGGRAPH 1997). Attributes are interpolated along the edge.
    ///
    /// The link condition holds, and no triangle turns by 90° or more. Borders and seams are contracted along themselves. A
    /// point of the interior may be contracted to one of a border or a seam, which then stays where it is. Points at which
    /// more than two wedges meet stay.
    FullEdge,
    /// As [`Reducer::FullEdge`], for edges without conditions on topology, and for points of separate parts that lie close to
    /// each other (the same source, section 3.1). It joins parts, and closes small holes and handles.
    ///
    /// No triangle turns by 90° or more. Parts are what edges connect; each point makes a pair with the nearest point of
    /// another part. Wedges with different attributes stay apart at one position, so that seams do not open. Two triangles
    /// with the same corners that face each other vanish.
    VertexPair {
        /// The largest distance of such a pair, as a fraction of the diagonal of the bounding box, from 0 to 1.
        distance: f32,
    },
    /// Clusters vertices in the cells of a uniform grid: [`cluster`](crate::reduce::cluster::reference::cluster()), which also
    /// runs on the device, and which says what is promised. The grid is the finest one, as bisection finds it, that leaves
    /// few enough triangles; if its error is too large, the coarsest with an error that is not.
    UniformClustering {
        /// The largest number of cells along the longest edge of the bounding box, from 1 to
        /// [`MAX_CELLS`].
        cells: u32,
    },
    /// Clusters points around those that count most (Rossignac and Borrel 1993, with the grades and floating cells of Low and
    /// Tan, "Model Simplification Using Vertex-Clustering", I3D 1997). A point's grade is the cosine of half the largest angle
    /// between two of its edges, times the length of its longest edge.
    ///
    /// Every point lies within [`Reduced::error`] of the one that stands for it, which is one of the mesh. The radius is the
    /// smallest, as bisection finds it, that leaves few enough triangles.
    ImportanceClustering,
    /// Removes the point that is nearest to the average plane of its triangles, or on a border, a seam or a feature to the
    /// line through its neighbours there, and triangulates the hole again (Schroeder, Zarge and Lorensen, "Decimation of
    /// Triangle Meshes", SIGGRAPH 1992). A feature is a line of edges between triangles that are 45° apart or more.
    ///
    /// No edge gets a third triangle, and each new triangle faces the side to which the average plane of its hole faces.
    /// Points at which a seam ends or more than two wedges meet stay, and so does the one at the other end of an edge that is
    /// split there only; also points with more than 64 triangles.
    VertexRemoval,
}

/// When to stop: at the first limit that is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Stop at this number of triangles, or as little below it as the operator permits.
    pub triangles: usize,
    /// Stop before [`Reduced::error`] exceeds this, in units of positions; at least 0, may be infinite.
    pub error: f32,
}

impl Default for Limits {
    /// No limit: as few triangles as the reducer leaves.
    fn default() -> Self {
        Self { triangles: 0, error: f32::INFINITY }
    }
}

impl Reducer {
    /// Each reducer, with the name that [`FromStr`] reads and [`Reducer::name`] returns.
    ///
    /// **Decided**: `melax` is B's equation 3.1 without the check of normals. In B the check is on, an addition that can be
    /// disabled for each mesh (3.2.3). [`Cost::Melax`] has both.
    pub const ALL: [(&str, Self); 7] = [
        ("quadric", Self::HalfEdge { cost: Cost::Quadric, seams: Seams::Held }),
        ("melax", Self::HalfEdge { cost: Cost::Melax { check_normals: false }, seams: Seams::Held }),
        ("full-edge", Self::FullEdge),
        ("vertex-pair", Self::VertexPair { distance: 0.02 }),
        ("uniform-clustering", Self::UniformClustering { cells: MAX_CELLS }),
        ("importance-clustering", Self::ImportanceClustering),
        ("vertex-removal", Self::VertexRemoval),
    ];

    /// The name of the operator, whatever its parameters are.
    pub fn name(&self) -> &'static str {
        match self {
            Self::HalfEdge { cost: Cost::Quadric, .. } => "quadric",
            Self::HalfEdge { cost: Cost::Melax { .. }, .. } => "melax",
            Self::FullEdge => "full-edge",
            Self::VertexPair { .. } => "vertex-pair",
            Self::UniformClustering { .. } => "uniform-clustering",
            Self::ImportanceClustering => "importance-clustering",
            Self::VertexRemoval => "vertex-removal",
        }
    }

    /// Reduces a mesh until a limit is reached.
    ///
    /// ```
    /// use relievo::ops::mesh::Surface;
    /// use relievo_lab::reduce::{Limits, Reducer};
    ///
    /// // A square of four triangles around its middle.
    /// let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]];
    /// let indices = [0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
    /// let surface = Surface { poses: &[positions], indices: &indices, attributes: &[], stride: 0 };
    /// let reducer: Reducer = "quadric".parse()?;
    /// let reduced = reducer.reduce(&surface, &Limits { triangles: 2, ..Limits::default() })?;
    /// assert_eq!((reduced.indices.len() / 3, reduced.poses[0].len(), reduced.error), (2, 4, 0.0));
    /// # Ok::<(), relievo::InputError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Reducer::reduce_each`].
    pub fn reduce(&self, surface: &Surface<'_>, limits: &Limits) -> Result<Reduced, InputError> {
        let mut all = self.reduce_each(surface, std::slice::from_ref(limits))?;
        all.pop().ok_or_else(|| InputError::new("limits.len", 0, "must be at least 1"))
    }

    /// Reduces a mesh to several limits, each result as [`Reducer::reduce`] gives it, in the order of `limits`. Where results
    /// are stages of one sequence, it is computed once.
    ///
    /// # Errors
    /// [`InputError`] as [`simplify()`](relievo::ops::mesh::simplify()) for the surface, for an error that is negative or NaN, for
    /// parameters outside of their bounds, and for several poses, which [`Reducer::HalfEdge`] alone takes.
    pub fn reduce_each(&self, surface: &Surface<'_>, limits: &[Limits]) -> Result<Vec<Reduced>, InputError> {
        validate(surface)?;
        for (at, limit) in limits.iter().enumerate() {
            if limit.error.is_nan() || limit.error < 0.0 {
                return Err(InputError::new(
                    format!("limits[{at}].error"),
                    limit.error,
                    "must be at least 0",
                ));
            }
        }
        let poses = surface.poses.len();
        if poses > 1 && !matches!(self, Self::HalfEdge { .. }) {
            let bound = format!("must be 1 for the reducer {}", self.name());
            return Err(InputError::new("poses.len", poses, bound));
        }
        match *self {
            Self::HalfEdge { cost, seams } => half_edge::reduce(surface, cost, seams, limits),
            Self::FullEdge => Ok(steps::run(Contraction::new(surface, Pairs::Edges), limits)),
            Self::VertexPair { distance } => {
                if !(0.0..=1.0).contains(&distance) {
                    return Err(InputError::new("distance", distance, "must be 0 to 1"));
                }
                Ok(steps::run(Contraction::new(surface, Pairs::Near(distance)), limits))
            }
            Self::UniformClustering { cells } => {
                limits.iter().map(|limit| uniform::reduce(surface, cells, limit)).collect()
            }
            Self::ImportanceClustering => {
                let graded = Graded::new(surface);
                Ok(limits.iter().map(|limit| graded.reduce(limit)).collect())
            }
            Self::VertexRemoval => Ok(steps::run(Removal::new(surface), limits)),
        }
    }
}

impl FromStr for Reducer {
    type Err = InputError;

    /// The reducer of [`Reducer::ALL`] with this name.
    fn from_str(name: &str) -> Result<Self, InputError> {
        let found = Self::ALL.iter().find(|(known, _)| *known == name);
        found.map(|(_, reducer)| *reducer).ok_or_else(|| {
            let names = Self::ALL.map(|(known, _)| known).join(", ");
            InputError::new("reducer", name, format!("must be one of {names}"))
        })
    }
}
