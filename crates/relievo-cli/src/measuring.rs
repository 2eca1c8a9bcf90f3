//! Shows a measurement's progress as progress bars.

use std::sync::{Mutex, PoisonError};

use indicatif::ProgressBar;
use relievo_lab::measure::{Listener, Progress};

use crate::progress::bar;

/// Runs a measurement and shows its progress, if standard error is a terminal.
pub fn shown<T>(measure: impl FnOnce(Listener<'_>) -> T) -> T {
    let current: Mutex<Option<ProgressBar>> = Mutex::default();
    let measured = measure(&|Progress { part, done, of }| {
        let mut current = current.lock().unwrap_or_else(PoisonError::into_inner);
        match &*current {
            // Several threads report their steps in any order.
            Some(bar) if done > 0 => bar.set_position(bar.position().max(done)),
            _ => {
                clear(&mut current);
                *current = Some(bar(of.unwrap_or(1), part));
            }
        }
    });
    clear(&mut current.lock().unwrap_or_else(PoisonError::into_inner));
    measured
}

fn clear(bar: &mut Option<ProgressBar>) {
    if let Some(bar) = bar.take() {
        bar.finish_and_clear();
    }
}
