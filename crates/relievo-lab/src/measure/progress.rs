//! The progress of a measurement.

use std::sync::atomic::{AtomicU64, Ordering};

/// How far one part of a measurement has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// The name of the part.
    pub part: &'static str,
    /// Number of steps that are done; 0 when the part begins.
    pub done: u64,
    /// Number of all steps; `None` if the part has no steps.
    pub of: Option<u64>,
}

/// A function that is called at each step, from the thread that did the step.
pub type Listener<'a> = &'a (dyn Fn(Progress) + Sync);

/// Counts the steps of a part, and calls the listener.
pub(crate) struct Steps<'a> {
    listener: Listener<'a>,
    part: &'static str,
    done: AtomicU64,
    of: u64,
}

impl<'a> Steps<'a> {
    /// Begins a part of `of` steps.
    pub(crate) fn new(listener: Listener<'a>, part: &'static str, of: u64) -> Self {
        listener(Progress { part, done: 0, of: Some(of) });
        Self { listener, part, done: AtomicU64::new(0), of }
    }

    /// Counts one step.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        (self.listener)(Progress { part: self.part, done, of: Some(self.of) });
    }
}

/// Calls the listener with a part that has no steps, and does the work.
pub(crate) fn during<T>(listener: Listener<'_>, part: &'static str, work: impl FnOnce() -> T) -> T {
    listener(Progress { part, done: 0, of: None });
    work()
}
