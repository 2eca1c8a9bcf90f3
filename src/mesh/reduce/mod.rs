//! All reducers behind one interface, for comparison (A sections 4 and 5): the same surface with fewer triangles, whatever the
//! operator is.
//!
//! [`simplify()`](crate::mesh::simplify()) is what most programs want: it records every level in one run. Other operators
//! place new vertices, join separate parts or remove what is small. Triangle collapse and the merging of polygons, which A
//! describes too, are sequences of edge collapses and of vertex removals.
//!
//! | reducer | vertices | topology | seams and attributes |
//! |---|---|---|---|
//! | [`HalfEdge`](Reducer::HalfEdge) | the mesh's own | stays | seams stay |
//!
//! Every reducer gives the same result on every machine: the code uses only `+ − × ÷` and square roots, in a fixed order, and
//! ties go to the lower index.

mod half_edge;
mod reduced;

use std::str::FromStr;

pub use reduced::Reduced;

use crate::InputError;
use crate::mesh::simplify::{Cost, Surface, validate};

/// The operator that takes triangles away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Reducer {
    /// Merges points into their neighbours: [`simplify()`](crate::mesh::simplify()), whose legality holds. Poses count as
    /// they do there.
    HalfEdge {
        /// The cost function of collapses.
        cost: Cost,
    },
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
    pub const ALL: [(&str, Self); 2] = [
        ("quadric", Self::HalfEdge { cost: Cost::Quadric }),
        ("melax", Self::HalfEdge { cost: Cost::Melax { check_normals: false } }),
    ];

    /// The name of the operator, whatever its parameters are.
    pub fn name(&self) -> &'static str {
        match self {
            Self::HalfEdge { cost: Cost::Quadric } => "quadric",
            Self::HalfEdge { cost: Cost::Melax { .. } } => "melax",
        }
    }

    /// Reduces a mesh until a limit is reached.
    ///
    /// ```
    /// use relievo::mesh::{Limits, Reducer, Surface};
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
    /// [`InputError`] as [`simplify()`](crate::mesh::simplify()) for the surface, and for an error that is negative or NaN.
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
        match *self {
            Self::HalfEdge { cost } => half_edge::reduce(surface, cost, limits),
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
