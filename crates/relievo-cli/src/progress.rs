//! Progress bars, which appear only on a terminal.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use relievo_lab::measure::{Listener, Progress};

/// A bar of `total` steps. indicatif draws nothing if standard error is not a terminal.
pub fn bar(total: u64, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg:18} {wide_bar} {pos}/{len} {eta}");
    let bar = ProgressBar::new(total).with_message(what.to_owned());
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    bar
}

/// A bar of a number of steps that is not known.
pub fn spinner() -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} {spinner} {elapsed}");
    let spinner = ProgressBar::new_spinner();
    spinner.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
    spinner.enable_steady_tick(Duration::from_millis(100));
    spinner
}

/// Runs work that has no steps, and shows meanwhile what is going on and for how long.
pub fn during<T>(what: &'static str, work: impl FnOnce() -> T) -> T {
    let spinner = spinner().with_message(what);
    let done = work();
    spinner.finish_and_clear();
    done
}

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
