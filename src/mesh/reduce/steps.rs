//! Reducers that go step by step: one run passes all limits.

use super::{Limits, Reduced};
use crate::mesh::simplify::Stopped;

/// A mesh that is being reduced.
pub(super) trait Steps {
    /// Number of triangles.
    fn triangles(&self) -> usize;

    /// The estimated error after the next step, not below the present one; `None` if no step is legal.
    fn next(&mut self) -> Option<f32>;

    /// Takes the step of which [`Steps::next`] told.
    fn step(&mut self);

    /// The mesh as it is.
    fn reduced(&self, stopped: Stopped) -> Reduced;
}

/// Takes steps until every limit is reached, and returns the mesh at each of them.
pub(super) fn run(mut steps: impl Steps, limits: &[Limits]) -> Vec<Reduced> {
    let mut open: Vec<usize> = (0..limits.len()).collect();
    let mut results: Vec<Option<Reduced>> = vec![None; limits.len()];
    while !open.is_empty() {
        let triangles = steps.triangles();
        let is_wanted = open.iter().any(|at| triangles > limits[*at].triangles);
        let next = if is_wanted { steps.next() } else { None };
        open.retain(|at| {
            let stopped = match next {
                _ if triangles <= limits[*at].triangles => Stopped::Triangles,
                None => Stopped::Exhausted,
                Some(error) if error > limits[*at].error => Stopped::Error,
                Some(_) => return true,
            };
            results[*at] = Some(steps.reduced(stopped));
            false
        });
        if !open.is_empty() {
            steps.step();
        }
    }
    results.into_iter().flatten().collect()
}
