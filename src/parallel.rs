//! Maps over all threads: rayon's, and in browsers, where there are no threads, over one.

use std::sync::{Mutex, PoisonError};

/// The values of `of` at 0 to `count` − 1.
pub fn map_range<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    mapped(count, &of)
}

/// The values of `of` at `items`.
pub fn map<I: Sync, T: Send>(items: &[I], of: impl Fn(&I) -> T + Sync) -> Vec<T> {
    map_range(items.len(), |at| of(&items[at]))
}

fn mapped<T: Send>(count: usize, of: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    // Several parts a thread, so that no thread waits long for the last.
    let length = count.div_ceil(16 * threads()).max(1);
    let parts: Vec<Mutex<Vec<T>>> = (0..count.div_ceil(length)).map(|_| Mutex::default()).collect();
    for_each(parts.len(), &|part| {
        let made = (part * length..count.min((part + 1) * length)).map(of).collect();
        *parts[part].lock().unwrap_or_else(PoisonError::into_inner) = made;
    });
    let mut all = Vec::with_capacity(count);
    for part in parts {
        all.append(&mut part.into_inner().unwrap_or_else(PoisonError::into_inner));
    }
    all
}

// With `dyn`, rayon's iterators are compiled once, and not for each closure.
#[cfg(not(target_arch = "wasm32"))]
fn for_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    use rayon::prelude::*;
    (0..count).into_par_iter().for_each(work);
}

#[cfg(target_arch = "wasm32")]
fn for_each(count: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..count).for_each(work);
}

#[cfg(not(target_arch = "wasm32"))]
fn threads() -> usize {
    rayon::current_num_threads()
}

#[cfg(target_arch = "wasm32")]
fn threads() -> usize {
    1
}
