//! How far a measurement is.

use std::sync::atomic::{AtomicU64, Ordering};

/// How far a part of a measurement is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// What is being done, in a word.
    pub part: &'static str,
    /// Steps that are done; 0 when it begins.
    pub done: u64,
    /// Of how many; none of work in one piece.
    pub of: Option<u64>,
}

/// Who hears of it, from whichever thread did a step.
pub type Listener<'a> = &'a (dyn Fn(Progress) + Sync);

/// Counts the steps of a part.
pub(crate) struct Steps<'a> {
    listener: Listener<'a>,
    part: &'static str,
    done: AtomicU64,
    of: u64,
}

impl<'a> Steps<'a> {
    /// A part that begins.
    pub(crate) fn new(listener: Listener<'a>, part: &'static str, of: u64) -> Self {
        listener(Progress { part, done: 0, of: Some(of) });
        Self { listener, part, done: AtomicU64::new(0), of }
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        (self.listener)(Progress { part: self.part, done, of: Some(self.of) });
    }
}

/// Says what is done in one piece, and does it.
pub(crate) fn during<T>(listener: Listener<'_>, part: &'static str, work: impl FnOnce() -> T) -> T {
    listener(Progress { part, done: 0, of: None });
    work()
}
