//! Reducers that go step by step: one run passes all limits.

use glam::DVec3;
use relievo::ops::mesh::simplify::{Stopped, Surface};

use crate::reduce::mesh::{Frame, Mesh};
use crate::reduce::{Limits, Reduced};

/// A mesh, and where its points lie in a frame.
pub(super) struct Solid {
    pub(super) frame: Frame,
    pub(super) mesh: Mesh,
    /// The position of each point in the frame.
    pub(super) places: Vec<DVec3>,
}

impl Solid {
    /// The mesh of a surface's first pose, and the position of each point in it.
    pub(super) fn new(surface: &Surface<'_>) -> (Self, Vec<[f32; 3]>) {
        let (mesh, positions) = Mesh::new(surface);
        let frame = Frame::around(&positions);
        let places = positions.iter().map(|position| frame.of(*position)).collect();
        (Self { frame, mesh, places }, positions)
    }
}

/// A mesh that is being reduced.
pub(super) trait Steps {
    /// What takes triangles away.
    type Step;

    /// The mesh as it is.
    fn solid(&self) -> &Solid;

    /// The next step; `None` if none is legal.
    fn find(&mut self) -> Option<Self::Step>;

    /// The square of a step's error in the frame.
    fn cost(step: &Self::Step) -> f64;

    /// Takes a step that was found, before any other.
    fn take(&mut self, step: Self::Step);

    /// The mesh as it is, with the error that was reached, and why it stopped.
    fn reduced(&self, error: f32, stopped: Stopped) -> Reduced;
}

/// Takes steps until every limit is reached, and returns the mesh at each of them. The error is the largest of all steps.
pub(super) fn run<S: Steps>(mut steps: S, limits: &[Limits]) -> Vec<Reduced> {
    let mut open: Vec<usize> = (0..limits.len()).collect();
    let mut results: Vec<Option<Reduced>> = vec![None; limits.len()];
    let mut error = 0.0_f32;
    while !open.is_empty() {
        let triangles = steps.solid().mesh.triangles();
        let is_wanted = open.iter().any(|at| triangles > limits[*at].triangles);
        let step = if is_wanted { steps.find() } else { None };
        let next = step.as_ref().map(|step| error.max(steps.solid().frame.distance(S::cost(step).sqrt())));
        open.retain(|at| {
            let stopped = match next {
                _ if triangles <= limits[*at].triangles => Stopped::Triangles,
                None => Stopped::Exhausted,
                Some(next) if next > limits[*at].error => Stopped::Error,
                Some(_) => return true,
            };
            results[*at] = Some(steps.reduced(error, stopped));
            false
        });
        if let (Some(step), Some(next), false) = (step, next, open.is_empty()) {
            steps.take(step);
            error = next;
        }
    }
    results.into_iter().flatten().collect()
}
